;;;; Ways out of a block or a tagbody.
;;;;
;;;; RETURN-FROM and GO are cheap where every form between them and their target hands on the value
;;;; it gets, as the forms of a loop's body do: they return a JUMP, and its target sees it.  In the
;;;; last form of a block, RETURN-FROM is nothing at all.  From anywhere else - out of an argument
;;;; or out of a closure - it is a THROW to an object that the target made when it was entered; once
;;;; the target has been left nobody catches that, which is a CONTROL-ERROR.
;;;;
;;;; While a form is analyzed *EXITS* are the targets that would see a jump returned by it, *TAILS*
;;;; the blocks whose values are its values.

(in-package #:discrepancy-finder.symbolic-execution)

(defvar *exits* '()
  "The exits whose forms see a jump that the form being analyzed returns.")

(defvar *tails* '()
  "The exits of blocks whose values are the values of the form being analyzed.")

(defvar *jumps* 0
  "The number of forms analyzed so far that return jumps.")

(defstruct (exit (:copier nil))
  "What is known of a block or tagbody: LAYOUT is that of the frame around it, SEEN is true if forms
return jumps to it, PLACE is where its tag is if there are throws to it, CONTEXT the function in
which it is."
  (layout nil :read-only t)
  (context nil :read-only t)
  (seen nil)
  (place nil))

(declaim (sb-ext:freeze-type exit))

(defstruct (jump (:constructor make-jump (exit segment)) (:copier nil))
  "What a form returns instead of a value to leave for EXIT: to a SEGMENT of a tagbody, or out of a
block, with the list of its values as second value."
  (exit nil :type exit :read-only t)
  (segment 0 :type fixnum :read-only t))

(declaim (sb-ext:freeze-type jump))

(defun analyze-statement (form scope)
  "Return the code of FORM, where its values are of no interest, and whether it may return a jump."
  (let ((jumps *jumps*) (*tails* '()))
    (let ((code (analyze-form form scope)))
      (values code (/= jumps *jumps*)))))
