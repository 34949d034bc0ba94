;;;; Recorded actions: what a run has performed, as data that can be performed again without a plan.
;;;;
;;;; Shrinking (shrink.lisp) leaves out some of the actions of a run, which no plan would do.  A
;;;; RECORDED-ACTION holds the DESCRIPTION of a designator, in which other descriptions, poses,
;;;; numbers and names may occur, and nothing that belongs to one run.  PERFORM-ACTIONS makes new
;;;; designators of them: an object that an action before has detected is described by what was
;;;; detected this time.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (description (:copier nil))
  "What a designator of CLASS, a keyword, says: PROPERTIES is a list of (key value*)."
  (class nil :type keyword :read-only t)
  (quantifier :a :type keyword :read-only t)
  (properties '() :type list :read-only t))

(defstruct (recorded-action (:copier nil))
  "A performed action or motion: its DESCRIPTION, its TEXT, and where the plan performs it."
  (description nil :type description :read-only t)
  (text "" :type string :read-only t)
  (position nil :read-only t))

(setf (documentation 'recorded-action-text 'function)
      "Return the text of a recorded action, as that of a step of a trace.")

(defmethod print-object ((action recorded-action) stream)
  (print-unreadable-object (action stream :type t)
    (write-string (recorded-action-text action) stream)))

;;; From designators

(defun described (value)
  "Return VALUE, a designator or a value in one, with descriptions in the place of designators."
  (typecase value
    (plan:designator
     (make-description :class (plan:designator-class-keyword value)
                       :quantifier (desig:quantifier value)
                       :properties (described (plan:properties value))))
    (cons (cons (described (car value)) (described (cdr value))))
    (t value)))

;;; To designators

(defun detected-in-place (object detected)
  "Return the one of DETECTED, designators of objects, the last one first, that OBJECT, a
designator, describes by its name or else by its type; or OBJECT itself."
  (flet ((same-p (key)
           (let ((value (plan:desig-prop-value object key)))
             (and value
                  (find value detected
                        :key (lambda (other) (plan:desig-prop-value other key)))))))
    (or (same-p :name) (same-p :type) object)))

(defun designator-of (value detected)
  "Return VALUE, a description or a value in one, with new designators in the place of descriptions;
the objects in it are those of DETECTED, where these have them."
  (typecase value
    (description
     (let ((designator (desig:make-quantified-designator
                        (description-class value)
                        (designator-of (description-properties value) detected)
                        (description-quantifier value))))
       (if (typep designator 'plan:object-designator)
           (detected-in-place designator detected)
           designator)))
    (cons (cons (designator-of (car value) detected) (designator-of (cdr value) detected)))
    (t value)))

(defun detecting-p (action)
  "Return true if ACTION is a motion that detects something."
  (let ((description (recorded-action-description action)))
    (and (eq (description-class description) :motion)
         (eq (second (assoc :type (description-properties description))) :detecting))))

(defun perform-actions (actions)
  "Perform the RECORDED-ACTIONs ACTIONS, one after the other; what fails is over, and the next one
follows.  To be called in a top-level."
  (let ((detected '()))
    (dolist (action actions)
      (let* ((detecting (detecting-p action))
             (designator (designator-of (recorded-action-description action)
                                        (if detecting '() detected)))
             (result (handler-case (plan:perform designator (recorded-action-position action))
                       (plan:plan-failure () nil))))
        (when detecting
          (setf detected (append (remove-if-not (lambda (object)
                                                  (typep object 'plan:object-designator))
                                                (if (listp result) result (list result)))
                                 detected)))))))
