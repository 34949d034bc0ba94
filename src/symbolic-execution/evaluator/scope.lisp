;;;; Lexical scopes of the evaluator, at the time when a form is made into a closure.
;;;;
;;;; A SCOPE knows where the run-time value of each lexical variable, local function, block and
;;;; tagbody is: frames are simple vectors linked through their element 0, and an address is the
;;;; number of frames to go up and an index.  Macros and declarations are kept in an environment
;;;; object of SBCL's, so that MACROEXPAND-1 sees what it must see.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (scope (:copier nil))
  "FRAMES is a list of lists of keys, innermost first.  A key is a variable's symbol or a list
(:function name), (:block name), (:tags tag*)."
  (frames '() :type list :read-only t)
  (environment nil :read-only t))

(defun extend-scope (scope keys &rest augmentation)
  "Return SCOPE with a new frame of KEYS (none if they are NIL) and with AUGMENTATION, arguments of
AUGMENT-ENVIRONMENT."
  (make-scope :frames (if keys (cons keys (scope-frames scope)) (scope-frames scope))
              :environment (if augmentation
                               (apply #'sb-cltl2:augment-environment
                                      (scope-environment scope) augmentation)
                               (scope-environment scope))))

(defun find-address (scope matches)
  "Return depth and index of the innermost key of SCOPE for which MATCHES is true, or NIL."
  (loop for frame in (scope-frames scope)
        for depth from 0
        for position = (position-if matches frame)
        when position return (values depth (1+ position))))

(declaim (inline frame-up))
(defun frame-up (frame depth)
  (declare (simple-vector frame) (fixnum depth))
  (loop repeat depth do (setf frame (svref frame 0)))
  frame)

(defun frame-reader (depth index)
  (declare (fixnum depth index))
  (case depth
    (0 (lambda (frame) (declare (simple-vector frame)) (svref frame index)))
    (1 (lambda (frame) (declare (simple-vector frame))
         (svref (the simple-vector (svref frame 0)) index)))
    (t (lambda (frame) (svref (frame-up frame depth) index)))))

(defun frame-writer (depth index)
  (declare (fixnum depth index))
  (lambda (frame value) (setf (svref (frame-up frame depth) index) value)))

(defun variable-kind (symbol scope)
  "Return :lexical, :special, :constant, :symbol-macro or NIL (undefined) for SYMBOL in SCOPE."
  (values (sb-cltl2:variable-information symbol (scope-environment scope))))

(defun variable-address (symbol scope)
  (find-address scope (lambda (key) (eq key symbol))))

(defun function-address (name scope)
  (find-address scope (lambda (key)
                        (and (consp key) (eq (first key) :function) (equal (second key) name)))))
