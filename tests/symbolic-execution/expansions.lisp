;;;; What the macros of Common Lisp expand into, the evaluator must know.
;;;;
;;;; For every external macro of COMMON-LISP there are sample forms.  They are expanded as the
;;;; evaluator does it, at every depth, and an operator on the way that is neither a function nor
;;;; known to the evaluator is a failure: one more thing of SBCL's own to be interpreted.

(in-package #:discrepancy-finder.tests)

(def-suite expansions :in all)
(in-suite expansions)

(defparameter *sample-forms*
  '((and (f) (g)) (assert (f) (x) "~a" 1) (case x (1 2) ((a b) 3) (t 4)) (ccase x (1 2) (a 3))
    (check-type x integer "an integer") (cond ((f)) ((g) 1) (t 2)) (ctypecase x (integer 1))
    (decf (car x) 2) (declaim (special *x*)) (define-compiler-macro sample-f (x) `(g ,x))
    (defclass sample-class (sample-super) ((a :initarg :a :initform (f) :accessor sample-a-of))
      (:default-initargs :a (f)) (:documentation "x"))
    (defconstant sample-constant 1)
    (defgeneric sample-generic (x &key) (:method ((x integer) &key) x))
    (define-condition sample-c (error) ((a :initform (f) :reader sample-r)) (:report (lambda (c s)
      (f c s))))
    (define-method-combination sample-combination :operator +)
    (define-modify-macro sample-m (&rest x) f) (define-setf-expander sample-s (x) (f x))
    (define-symbol-macro sample-sm (f))
    (defmacro sample-macro (x &optional (y (f)) &body b) `(g ,x ,y ,@b))
    (defmethod sample-generic :around ((x (eql (f))) &key (k (f))) (call-next-method))
    (defpackage #:sample-package (:use #:cl)) (defparameter *sample* (f) "x")
    (defsetf sample-f (x &optional y) (z) `(g ,x ,y ,z)) (defsetf sample-f sample-g)
    (defstruct (sample-struct (:include structure-object)) a (b (f) :type fixnum))
    (deftype sample-type (&optional (x (f))) (g x)) (defun sample-f (x &key (y (f))) "x" (g x y))
    (defvar *sample* (f))
    (destructuring-bind (a (b &optional (c (f))) &rest r &key d) (f) (g a b c r d))
    (do ((x (f) (g x)) (y)) ((f x) (g)) a (f)) (do* ((x (f) (g x))) ((f x) (g)) (f))
    (do-all-symbols (s (f)) (g s)) (do-external-symbols (s (f) (g)) (f s))
    (do-symbols (s (f)) (g s)) (dolist (x (f) (g)) (f x)) (dotimes (i (f) (g)) (f i))
    (ecase x (1 2) ((a b) 3)) (etypecase x (integer 1) (list 2)) (formatter "~a ~{~s~}")
    (handler-bind ((error (lambda (c) (f c)))) (g))
    (handler-case (f) (error (c) (g c)) (warning () 1) (:no-error (a) a)) (ignore-errors (f))
    (in-package :cl-user) (incf (gethash (f) (g) 0) 2) (lambda (x) x) (loop (f))
    (loop for x in (f) for i from 0 when (g x) collect (f x) else sum i into s finally (return s))
    (loop for k being the hash-keys of (f) using (hash-value v) do (g k v))
    (loop named a with x = 1 while (f x) do (loop-finish) append (g))
    (loop for s being the symbols of (f) thereis (g s))
    (loop for x across (f) for y = 1 then (g y) maximize x minimize y)
    (multiple-value-bind (a b) (f) (g a b)) (multiple-value-list (f))
    (multiple-value-setq (a b) (f)) (nth-value (f) (g)) (or (f) (g)) (pop (car x))
    (pprint-logical-block (s (f) :prefix "(") (pprint-exit-if-list-exhausted) (pprint-pop) (f))
    (print-unreadable-object (x s :type t :identity (f)) (g)) (prog ((a (f)) b) c (g))
    (prog* ((a (f)) b) c (g)) (prog1 (f) (g)) (prog2 (f) (g) 1) (psetf a (f) (car b) (g))
    (psetq a (f) b (g)) (push (f) (car x)) (pushnew (f) (car x) :test #'g) (remf (car x) (f))
    (restart-bind ((r (lambda () (f)) :report-function #'g)) (g))
    (restart-case (error "x") (r (x) :report "x" :interactive f :test g (f x)))
    (block nil (return (f))) (rotatef (car x) (cdr y) (aref (f) (g)))
    (setf (car x) (f) (gethash 1 (g)) 2 (values a (cdr b)) (f)) (shiftf (car x) (f y) (g))
    (step (f)) (time (f)) (trace) (untrace)
    (typecase x (integer (f)) ((or null string) (g)) (t 1)) (unless (f) (g)) (when (f) (g))
    (with-accessors ((a f)) (g) (setf a 1)) (with-compilation-unit (:override (f)) (g))
    (with-condition-restarts (f) (g) (f)) (with-hash-table-iterator (n (f)) (n))
    (with-input-from-string (s (f) :index i :start 1) (g s))
    (with-open-file (s (f) :direction :output) (g s)) (with-open-stream (s (f)) (g s))
    (with-output-to-string (s) (f s)) (with-output-to-string (s (f)) (g s))
    (with-package-iterator (n (f) :internal) (n)) (with-simple-restart (r "x" (f)) (g))
    (with-slots (a (b c)) (f) (setf a (g b))) (with-standard-io-syntax (f)))
  "Forms with every macro of Common Lisp.")

(defparameter *macros-of-other-macros*
  '(call-method loop-finish pprint-exit-if-list-exhausted pprint-pop)
  "Macros that have a meaning only inside of others.")

(defun mentioned-p (symbol tree)
  (cond ((eq symbol tree) t)
        ((consp tree) (or (mentioned-p symbol (car tree)) (mentioned-p symbol (cdr tree))))))

(test every-macro-of-common-lisp-has-a-sample
  (do-external-symbols (symbol '#:common-lisp)
    (when (and (macro-function symbol) (not (special-operator-p symbol))
               (not (member symbol *macros-of-other-macros*)))
      (is (find symbol *sample-forms* :test #'mentioned-p) "There is no sample of ~a." symbol))))

(defun strange-operators (form)
  "Return what the evaluator does not understand in FORM, at any depth: a list of texts."
  (let* ((symbolic::*callees* (make-hash-table :test 'equal))
         (strange '())
         (symbolic::*problem-observer* (lambda (condition)
                                         (push (princ-to-string condition) strange))))
    (handler-bind ((warning #'muffle-warning))
      (symbolic::analyze form (symbolic::make-scope)))
    (loop for name in (alexandria:hash-table-keys symbolic::*callees*)
          unless (or (fboundp name) (ours-p name))
            do (push (format nil "~s is no function" name) strange))
    strange))

(defun ours-p (name)
  (eq (symbol-package (if (consp name) (second name) name))
      (find-package '#:discrepancy-finder.tests)))

(test every-expansion-is-understood
  (dolist (form *sample-forms*)
    (let ((strange (strange-operators form)))
      (is (null strange) "~s: ~{~a~^, ~}" form strange))))

(test strange-operators-are-found
  (is (= 1 (length (strange-operators '(let ((x 1)) (list (sb-c::%within-cleanup x)))))))
  (is (= 1 (length (strange-operators '(block a (return-from b))))))
  (is (= 1 (length (strange-operators '(let ((x 1)) (cl-user::no-such-function-at-all x)))))))
