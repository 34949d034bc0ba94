;;;; Lazy lists: lists whose elements are computed when they are asked for, and once.
;;;;
;;;; A lazy list is NIL or a cons whose first element is there and whose rest is a lazy list or a
;;;; DELAYED one.  So an ordinary list is a lazy list, too, NULL says whether a lazy list is empty,
;;;; and CAR is its first element; for the rest LAZY-CDR is needed.  LAZY-LIST makes one.

(in-package #:discrepancy-finder.prolog)

(defstruct (delayed (:constructor make-delayed (function)) (:copier nil))
  "The rest of a lazy list: FUNCTION returns it; then VALUE is the rest and FUNCTION is NIL."
  (function nil :type (or null function))
  (value nil))

(defmethod print-object ((delayed delayed) stream)
  (print-unreadable-object (delayed stream)
    (write-string "..." stream)))

(defun force (delayed)
  "Return the lazy list that DELAYED stands for, computing it if that has not been done.  A
non-local exit out of the computation leaves DELAYED as it is."
  ;; The computation may return another delayed list: the loop spares the control stack.
  (let ((pending '())
        (list delayed))
    (loop while (delayed-p list)
          do (let ((function (delayed-function list)))
               (cond (function
                      (push list pending)
                      (setf list (funcall function)))
                     (t (setf list (delayed-value list))))))
    (dolist (each pending list)
      (setf (delayed-value each) list
            (delayed-function each) nil))))

(declaim (inline forced))
(defun forced (list)
  "Return the lazy LIST as NIL or a cons."
  (if (delayed-p list) (force list) list))

(defmacro lazy-cons (first rest)
  "Return a lazy list of the value of FIRST and the elements of the lazy list REST, a form that is
evaluated when the rest is asked for."
  `(cons ,first (make-delayed (lambda () ,rest))))

(defmacro lazy-list ((&rest variables) &body body)
  "Return the lazy list that BODY generates.  VARIABLES are (name initial-value), the generator's
state.  The value of BODY is the list: (cont value new-value*) for a list that begins with value and
goes on with BODY when it is asked for, with the new values of the variables in their order;
(next new-value*) for BODY evaluated again, without an element; (fin) for the end, which is NIL;
or another lazy list.  A variable for which there is no new value keeps its value."
  (let* ((generator (gensym "GENERATOR"))
         (element (gensym "ELEMENT"))
         (names (loop for variable in variables
                      collect (if (consp variable) (first variable) variable)))
         (new-values (loop for name in names collect (gensym (string name))))
         (optional (loop for name in names
                         for new-value in new-values collect (list new-value name))))
    `(labels ((,generator ,names
                (flet ((cont (,element &optional ,@optional)
                         (lazy-cons ,element (,generator ,@new-values)))
                       (next (&optional ,@optional)
                         (make-delayed (lambda () (,generator ,@new-values))))
                       (fin ()
                         nil))
                  (declare (ignorable #'cont #'next #'fin))
                  ,@body)))
       (forced (,generator ,@(loop for variable in variables
                                   collect (if (consp variable) (second variable) nil)))))))

(macrolet ((outside (name arguments text)
             `(defun ,name (&rest arguments)
                ,text
                (declare (ignore arguments))
                (error "(~(~a~)~a) stands outside of LAZY-LIST." ',name ,arguments))))
  (outside cont " value new-value*" "Inside LAZY-LIST, return the list that begins with the first of
ARGUMENTS and goes on with the others as new values of the variables.  Anywhere else this is an
error.")
  (outside next " new-value*" "Inside LAZY-LIST, return the list that its body generates with
ARGUMENTS as new values of the variables.  Anywhere else this is an error.")
  (outside fin "" "Inside LAZY-LIST, return the empty list.  Anywhere else this is an error."))

(defun lazy-list-p (object)
  "Return true if OBJECT is a lazy list; ordinary lists are."
  (or (listp object) (delayed-p object)))

(defun lazy-car (list)
  "Return the first element of the lazy LIST, or NIL if it is empty."
  (car (forced list)))

(defun lazy-cdr (list)
  "Return the rest of the lazy LIST after its first element, which is NIL or a cons: its first
element is computed by this."
  (let ((cell (forced list)))
    (if (delayed-p (cdr cell))
        (setf (cdr cell) (force (cdr cell)))
        (cdr cell))))

(defun lazy-skip (n list)
  "Return the lazy LIST without its first N elements, which are computed."
  (let ((rest (forced list)))
    (loop repeat n while rest do (setf rest (lazy-cdr rest)))
    rest))

(defun lazy-elt (list n)
  "Return element N, counted from 0, of the lazy LIST, or NIL if there is none."
  (car (lazy-skip n list)))

(defun force-ll (list)
  "Return LIST with all its elements computed, as an ordinary list."
  (let ((start (forced list)))
    (loop for rest = start then (lazy-cdr rest) while rest)
    start))

(defmacro lazy-dolist ((variable list &optional result) &body body)
  "Evaluate BODY, in a block named NIL, with VARIABLE bound to each element of the lazy LIST in
turn; return the value of RESULT.  An element is computed after BODY is done with the one before."
  (let ((rest (gensym "REST")))
    `(do ((,rest (forced ,list) (lazy-cdr ,rest)))
         ((null ,rest) ,result)
       (let ((,variable (car ,rest)))
         ,@body))))
