;;;; What a plan file may define besides plans: methods, accessors, functions with a state.
;;;;
;;;; Each plan notes what it has found out on a path; the notes of all paths are compared.

(in-package #:discrepancy-finder.tests)

(def-suite plan-files :in all)
(in-suite plan-files)

(defvar *file-notes* '()
  "What the paths of a plan have noted, the last first.")

(defun note-down (thing)
  "Note THING, in which nothing is symbolic any more."
  (push thing *file-notes*)
  nil)

(defun notes-of (text &optional (arguments '((discrepancy-finder-user::?flag boolean))))
  "Return what the paths of the plan lamp-plan in TEXT note, and the exploration."
  (setf *file-notes* '())
  (let ((exploration (explore-text text :constraint 'anything :arguments arguments)))
    (values (reverse *file-notes*) exploration)))

(defmacro is-noted (expected text)
  `(let ((notes (notes-of ,text)))
     (is (equal ',expected notes) "~s was noted" notes)))

(test methods-of-plan-files-are-interpreted
  (is-noted ((:yes :int t) (:no :int nil)) "
(defgeneric chosen (flag n))
(defmethod chosen (flag (n integer)) (if flag (list :yes :int) (list :no :int)))
(defmethod chosen :around (flag n) (append (call-next-method) (list (if flag t nil))))
(def-top-level-cram-function lamp-plan (?flag)
  (discrepancy-finder.tests::note-down (chosen ?flag 1)))")
  (is (= 2 (symbolic:exploration-paths (nth-value 1 (notes-of "
(def-top-level-cram-function lamp-plan (?flag)
  (discrepancy-finder.tests::note-down (chosen ?flag 1)))"))))
      "one decision for both methods"))

(test methods-that-do-not-look-do-not-decide
  (is (= 1 (symbolic:exploration-paths (nth-value 1 (notes-of "
(defgeneric kept (place value))
(defclass shelf () ((content :accessor content :initform nil)))
(defmethod kept ((place shelf) value) (setf (content place) value) place)
(defmethod kept :before ((place shelf) value) (declare (ignore value)) (content place))
(def-top-level-cram-function lamp-plan (?flag)
  (kept (make-instance 'shelf) ?flag)
  (discrepancy-finder.tests::note-down :done))"))))))

(test methods-are-chosen-by-symbolic-arguments
  (is-noted (:true :false) "
(defgeneric by-value (flag))
(defmethod by-value ((flag (cl:eql t))) :true)
(defmethod by-value ((flag null)) :false)
(def-top-level-cram-function lamp-plan (?flag)
  (discrepancy-finder.tests::note-down (by-value ?flag)))"))

(test call-next-method-and-auxiliary-methods-in-order
  (is-noted (((:around :before :primary :base :after) t)
             ((:around :before :primary :base :after) nil)) "
(defvar *steps* '())
(defclass base () ())
(defclass derived (base) ())
(defgeneric do-it (thing flag))
(defmethod do-it ((thing base) flag) (push :base *steps*) (if flag t nil))
(defmethod do-it ((thing derived) flag)
  (push :primary *steps*)
  (if (next-method-p) (call-next-method) :no-next))
(defmethod do-it :before ((thing derived) flag) (declare (ignore flag)) (push :before *steps*))
(defmethod do-it :after ((thing derived) flag) (declare (ignore flag)) (push :after *steps*))
(defmethod do-it :around ((thing derived) flag) (push :around *steps*)
  (call-next-method thing flag))
(def-top-level-cram-function lamp-plan (?flag)
  (let ((value (do-it (make-instance 'derived) ?flag)))
    (discrepancy-finder.tests::note-down (list (reverse *steps*) value))))"))

(test functions-named-by-lists-are-interpreted
  (is-noted (:on :off) "
(defun (setf switched) (value box) (setf (first box) (if value :on :off)))
(def-top-level-cram-function lamp-plan (?flag)
  (let ((box (list nil)))
    (setf (switched box) ?flag)
    (discrepancy-finder.tests::note-down (first box))))"))

(test functions-with-a-state-of-their-own-begin-each-path-with-it
  (is-noted ((1 2 :on) (1 2 :off)) "
(let ((count 0))
  (defun next-count () (incf count))
  (defun reset-count () (setf count 0)))
(flet ((name-of (flag) (if flag :on :off)))
  (defun counted (flag) (list (next-count) (next-count) (name-of flag))))
(def-top-level-cram-function lamp-plan (?flag)
  (discrepancy-finder.tests::note-down (counted ?flag)))")
  (is (= 1 (funcall 'discrepancy-finder-user::next-count)) "compiled code shares the state"))

(test closures-in-globals-begin-each-path-as-they-were
  (is-noted ((1 2 :on) (1 2 :off)) "
(defvar *next* (let ((n 0)) (lambda () (incf n))))
(defparameter *steps* (list (let ((n 0)) (lambda () (incf n 2)))))
(def-top-level-cram-function lamp-plan (?flag)
  (discrepancy-finder.tests::note-down
    (list (funcall *next*) (funcall (first *steps*)) (if ?flag :on :off))))")
  (is (= 1 (funcall (symbol-value 'discrepancy-finder-user::*next*)))))

(test closed-over-lists-and-tables-begin-each-path-as-they-were
  (is-noted ((1 (:a) t) (1 (:a) nil)) "
(let ((table (make-hash-table)) (list '()))
  (defun keep (flag)
    (incf (gethash :count table 0))
    (push :a list)
    (list (gethash :count table) list (if flag t nil))))
(def-top-level-cram-function lamp-plan (?flag)
  (discrepancy-finder.tests::note-down (keep ?flag)))"))

(test definitions-inside-of-plans-are-undone
  (is-noted ((:new t) (:new nil)) "
(defun changed () :old)
(def-top-level-cram-function lamp-plan (?flag)
  (let ((flag (if ?flag t nil)))
    (assert (eq (changed) :old))
    (defun changed () (list :new flag))
    (discrepancy-finder.tests::note-down (changed))))")
  (is (eq :old (funcall 'discrepancy-finder-user::changed))))

(test structures-and-instances-hold-symbolic-values
  (is-noted ((:yes :yes) (:no :no)) "
(defstruct cup full)
(defclass plate () ((dirty :initarg :dirty :reader dirty-p)))
(def-top-level-cram-function lamp-plan (?flag)
  (let ((cup (make-cup :full ?flag)) (plate (make-instance 'plate :dirty ?flag)))
    (discrepancy-finder.tests::note-down
     (list (if (cup-full cup) :yes :no) (if (dirty-p plate) :yes :no)))))"))

(test macros-and-types-of-plan-files
  (is-noted (((1 2) :small :on) ((1 2) :small :off)) "
(defmacro twice-listed (form) `(list ,form (1+ ,form)))
(deftype small-number () '(integer 0 5))
(define-symbol-macro one 1)
(define-condition odd-thing (error) ((flag :initarg :flag :reader odd-flag)))
(def-top-level-cram-function lamp-plan (?flag)
  (discrepancy-finder.tests::note-down
   (list (twice-listed one) (typecase one (small-number :small) (t :big))
         (handler-case (error 'odd-thing :flag ?flag)
           (odd-thing (c) (if (odd-flag c) :on :off))))))"))

(test declared-types-of-symbolic-values-are-decided
  (is-noted (:null :true) "
(def-top-level-cram-function lamp-plan (?flag)
  (discrepancy-finder.tests::note-down
   (handler-case (progn (the null ?flag) :null)
     (type-error () :true))))")
  (is (= 1 (symbolic:exploration-paths (nth-value 1 (notes-of "
(def-top-level-cram-function lamp-plan (?flag)
  (let ((flag (the symbol ?flag)))
    (discrepancy-finder.tests::note-down (consp flag))))"))))))

(test restarts-take-symbolic-values
  (is-noted (:yes :no) "
(def-top-level-cram-function lamp-plan (?flag)
  (discrepancy-finder.tests::note-down
   (restart-case (handler-bind ((error (lambda (c)
                                         (declare (ignore c))
                                         (invoke-restart 'use ?flag))))
                   (error \"no\"))
     (use (flag) (if flag :yes :no)))))"))

(test unwinding-and-jumps-keep-symbolic-values
  (is-noted ((:cleaned :yes) (:cleaned :no)) "
(def-top-level-cram-function lamp-plan (?flag)
  (let* ((log '())
         (flag (block nil
                 (tagbody
                  again
                    (catch 'out
                      (unwind-protect
                           (mapc (lambda (x) (when (= x 2) (return (values ?flag x))))
                                 '(1 2 3))
                        (push :cleaned log)))
                    (go again)))))
    (discrepancy-finder.tests::note-down (append log (list (if flag :yes :no))))))"))
