;;;; Chains of designators that describe the same.
;;;;
;;;; EQUATE appends a designator to the chain of another: (equate a b) says that B describes what A
;;;; does, and is younger.  A plan keeps A; (current-desig a) returns the youngest of the chain,
;;;; FIRST-DESIG the oldest.  Two designators are the same, DESIG-EQUAL, if they are in one chain;
;;;; equal descriptions do not make them so.

(in-package #:discrepancy-finder.designators)

(defgeneric on-equate-designators (successor parent)
  (:method-combination progn)
  (:documentation "Called by EQUATE with the two designators after they were chained; does nothing
itself.  Methods have the qualifier PROGN, so that each subscriber is called.")
  (:method progn (successor parent)
    (declare (ignore successor parent))))

(defun current-desig (designator)
  "Return the youngest designator in the chain of DESIGNATOR; NIL for NIL."
  (and designator
       (loop for younger = (successor designator)
             while younger do (setf designator younger)
             finally (return designator))))

(defun first-desig (designator)
  "Return the oldest designator in the chain of DESIGNATOR; NIL for NIL."
  (and designator
       (loop for older = (parent designator)
             while older do (setf designator older)
             finally (return designator))))

(defun desig-equal (first second)
  "Return true if the designators FIRST and SECOND are in one chain.  Anything else, NIL included,
is equal to no designator."
  (and (typep first 'designator) (typep second 'designator)
       (eq (first-desig first) (first-desig second))))

(defun get-equal-designators (designator)
  "Return the list of the designators in the chain of DESIGNATOR, the oldest first."
  (loop for member = (first-desig designator) then (successor member)
        while member collect member))

(defun newest-effective-designator (designator)
  "Return the youngest effective designator in the chain of DESIGNATOR, or NIL if none is."
  (loop for member = (current-desig designator) then (parent member)
        while member
        when (effective member) return member))

(defun equate (parent successor)
  "Append the chain of the designator SUCCESSOR to the chain of the designator PARENT, call
ON-EQUATE-DESIGNATORS and return SUCCESSOR.  Signals DESIGNATOR-ERROR if they are in one chain."
  (when (desig-equal parent successor)
    (designator-error successor "~a is already equated to ~a." successor parent))
  (let ((youngest (current-desig parent))
        (oldest (first-desig successor)))
    (setf (slot-value youngest 'successor) oldest
          (slot-value oldest 'parent) youngest))
  (on-equate-designators successor parent)
  successor)

;;; Time

(defparameter *timestamp-function*
  (let ((count 0))
    (lambda () (incf count)))
  "A function of no arguments that returns the time at which a designator becomes effective.  By
default it counts its calls; a run of a plan binds it to the clock of the run.")

(defun mark-effective (designator)
  "Note that what DESIGNATOR describes was found, and when that was first."
  (unless (timestamp designator)
    (setf (slot-value designator 'timestamp) (funcall *timestamp-function*)))
  (setf (slot-value designator 'effective) t)
  designator)
