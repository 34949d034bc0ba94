;;;; Sorts: the finite sets that variables range over.
;;;;
;;;; A sort has elements of its own and those of its subsorts; or it is a range of integers; or its
;;;; elements are terms, (b-on cat shelf).  FLUENT and EVENT are the sorts of the ground fluents and
;;;; events, TIME and OFFSET are integers whose range is the horizon of a question, INTEGER has no
;;;; elements: it is for values of functions and for arithmetic.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (element-sort (:conc-name sort-) (:copier nil))
  "A sort of a theory."
  (name nil :type keyword :read-only t)
  (parents '() :type list :read-only t)
  (range nil :type (or null cons) :read-only t)
  (constants '() :type list :read-only t)
  (terms '() :type list :read-only t))

(setf (documentation 'sort-name 'function)
      "Return the name of a sort, a keyword."
      (documentation 'sort-parents 'function)
      "Return the names of the sorts that a sort's elements belong to, too."
      (documentation 'sort-range 'function)
      "Return (lowest . highest) of a sort of integers, or NIL."
      (documentation 'sort-constants 'function)
      "Return the elements, keywords, that a sort declares itself."
      (documentation 'sort-terms 'function)
      "Return the symbols (name argument-sort*) whose ground terms are elements of a sort.")

(defmethod print-object ((sort element-sort) stream)
  (print-unreadable-object (sort stream :type t)
    (format stream "~a~@[ of ~{~a~^, ~}~]~@[ ~{~d..~d~}~]~@[ ~{~a~^ ~}~]"
            (name-text (sort-name sort)) (mapcar #'name-text (sort-parents sort))
            (and (sort-range sort) (list (car (sort-range sort)) (cdr (sort-range sort))))
            (mapcar #'name-text (sort-constants sort)))))

(defparameter *built-in-sorts*
  (list (make-element-sort :name :integer)
        (make-element-sort :name :time :parents '(:integer))
        (make-element-sort :name :offset :parents '(:integer))
        (make-element-sort :name :fluent)
        (make-element-sort :name :event))
  "The sorts that every theory has.")

(defun find-sort (sorts name)
  "Return the sort named NAME among the list SORTS and the built-in ones, or NIL."
  (or (find name sorts :key #'sort-name)
      (find name *built-in-sorts* :key #'sort-name)))

(defun subsort-p (sorts name ancestor)
  "Return true if the sort named NAME is ANCESTOR or below it."
  (labels ((below (name seen)
             (or (eq name ancestor)
                 (unless (member name seen)
                   (let ((sort (find-sort sorts name)))
                     (and sort
                          (some (lambda (parent) (below parent (cons name seen)))
                                (sort-parents sort))))))))
    (below name '())))

(defun numeric-sort-p (sorts name)
  "Return true if the elements of the sort named NAME are integers."
  (let ((sort (find-sort sorts name)))
    (and sort (or (sort-range sort) (subsort-p sorts name :integer)) t)))
