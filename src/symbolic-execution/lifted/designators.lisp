;;;; Designators: the values of their properties are handed on as they are, their keys are decided.
;;;;
;;;; What resolves a designator is opaque: everything in it is decided then.  Chains and solutions
;;;; of designators that existed before the run are as before after it.

(in-package #:discrepancy-finder.symbolic-execution)

(defun settled-properties (properties)
  "Return PROPERTIES, a list of (key value*) or a designator, with no symbolic value but the values
of properties."
  (let ((properties (settled-sequence properties "the properties of a designator")))
    (when (and (listp properties) (symbolic-run-p))
      (dolist (property properties)
        (when (and (consp property) (symbolic-value-p (car property)))
          (note-place (car property))
          (setf (car property) (settled (car property) "a key of a designator")))))
    properties))

(defun note-designator (designator)
  "Note that DESIGNATOR and its chain are to be as they are after the run."
  (when (and *path* (typep designator 'plan:designator))
    (dolist (member (discrepancy-finder.designators:get-equal-designators designator))
      (dolist (slot '(discrepancy-finder.designators:parent
                      discrepancy-finder.designators:successor
                      discrepancy-finder.designators:effective
                      discrepancy-finder.designators:timestamp
                      discrepancy-finder.designators:data
                      discrepancy-finder.designators::solutions))
        (note-slot member slot)))))

(define-transparent plan:make-designator (type any-properties &optional parent)
  (note-designator parent)
  (plan:make-designator (settled type "the class of a designator")
                        (settled-properties any-properties)
                        (settled parent "a designator")))

(define-transparent discrepancy-finder.designators:make-quantified-designator
    (type any-properties quantifier)
  (discrepancy-finder.designators:make-quantified-designator
   (settled type "the class of a designator") (settled-properties any-properties)
   (settled quantifier "a quantifier")))

(define-transparent plan:desig-prop-value (designator key))
(define-transparent plan:desig-prop-values (designator key))
(define-transparent plan:current-desig (designator))
(define-transparent plan:first-desig (designator))
(define-transparent plan:newest-effective-designator (designator))
(define-transparent plan:desig-equal (designator other))
(define-transparent plan:designator-class-keyword (designator))

(define-transparent plan:copy-designator (designator &key new-description)
  (plan:copy-designator (settled designator "a designator")
                        :new-description (settled-properties new-description)))

(define-transparent plan:merge-desig-descriptions (any-old any-new)
  (plan:merge-desig-descriptions (settled-properties any-old) (settled-properties any-new)))

(define-transparent discrepancy-finder.designators:update-designator-properties (any-new any-old)
  (discrepancy-finder.designators:update-designator-properties (settled-properties any-new)
                                                               (settled-properties any-old)))

(define-transparent (plan:equate) (parent successor)
  (let ((parent (settled parent "a designator")) (successor (settled successor "a designator")))
    (note-designator parent)
    (note-designator successor)
    (plan:equate parent successor)))

;;; What resolves them, or makes others equal to them

(macrolet ((define (&rest names)
             `(progn
                ,@(loop for name in names
                        collect `(define-transparent (,name) (&rest arguments)
                                   (mapc #'note-designator arguments)
                                   (call-opaque #',name arguments ,(describe-decision name)))))))
  (define plan:reference plan:next-solution plan:designated-pose
    discrepancy-finder.designators:designator-groundings
    discrepancy-finder.designators:extend-designator-properties
    discrepancy-finder.designators:make-effective-designator))
