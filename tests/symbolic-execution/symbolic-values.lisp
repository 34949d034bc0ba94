;;;; Symbolic values: printing, what they are made of, deciding them, symbolic arguments.

(in-package #:discrepancy-finder.tests)

(in-suite symbolic-values)

(defun call-on-a-path (function &key limit)
  "Call FUNCTION with a context of Z3 on a new path without decisions, with arithmetic; return its
values.  LIMIT is *NUMBER-LIMIT* then."
  (let ((oracle (symbolic::open-oracle
                 (symbolic::make-oracle :make-solver (lambda (context)
                                                       (z3:make-solver context :logic nil))))))
    (unwind-protect
         (let ((symbolic::*path* (symbolic::make-path :plan 'none :domain (make-lamp-domain)
                                                      :oracle oracle :symbolic-p t
                                                      :jumps-left 1000))
               (symbolic:*number-limit* (or limit symbolic:*number-limit*)))
           (catch symbolic::*path*
             (funcall function (symbolic::oracle-context oracle))))
      (symbolic::close-oracle oracle))))

(defun symbolic-argument (name type context)
  "Return a symbolic argument and assume its conditions on the path."
  (multiple-value-bind (value propositions)
      (symbolic:make-symbolic-argument name type nil context)
    (dolist (proposition propositions value)
      (symbolic::oracle-assume (symbolic::path-oracle symbolic::*path*) proposition))))

(defun alternatives ()
  (length (symbolic::path-alternatives symbolic::*path*)))

(test printing-of-symbolic-values
  (call-on-a-path
   (lambda (context)
     (flet ((text (type) (princ-to-string (symbolic-argument '?x type context))))
       (is (string= "#<symbolic |argument ?x|>" (text 'boolean)))
       (is (string= "#<symbolic |argument ?x|>" (text '(integer 0 3))))
       (is (string= "#<symbolic :a or nil>" (text '(member :a nil))))
       (is (eq :only (symbolic-argument '?x '(member :only) context)))))))

(test values-that-are-known-are-plain
  (call-on-a-path
   (lambda (context)
     (let ((p (z3:variable context "p")))
       (is (eq t (symbolic::symbolic-boolean t)))
       (is (null (symbolic::symbolic-boolean nil)))
       (is (eql 3 (symbolic::symbolic-number 3 'integer)))
       (is (eq :a (symbolic::symbolic-element (list (cons :a p) (cons :a (z3:negation p))))))
       (is (symbolic::symbolic-boolean-p
            (symbolic::symbolic-element (list (cons nil p) (cons t (z3:negation p))))))
       (is (= 2 (length (symbolic:symbolic-element-choices
                         (symbolic::symbolic-element
                          (list (cons :a p) (cons :b nil) (cons :c (z3:negation p))))))))))))

(test what-was-decided-is-known
  (call-on-a-path
   (lambda (context)
     (let ((element (symbolic-argument '?x '(member :a :b :c) context))
           (flag (symbolic-argument '?y 'boolean context)))
       (is (eq :a (symbolic::settled element "first")))
       (is (eq :a (symbolic::settled element "second")))
       (is (eq t (symbolic::truth element "third")))
       (is (= 2 (alternatives)))
       (is (eq t (symbolic::truth flag "fourth")))
       (is (eq t (symbolic::settled flag "fifth")))
       (is (= 3 (alternatives)))
       (is (null (symbolic::truth-proposition
                  (funcall (symbolic:lifted-function 'eq) element :b))))))))

(test everything-inside-is-decided
  (call-on-a-path
   (lambda (context)
     (let* ((x (symbolic-argument '?x '(integer 4 5) context))
            (table (make-hash-table)) (circle (list x nil x))
            (vector (vector x (list circle)))
            (matrix (make-array '(1 2) :initial-element x))
            (filled (make-array 3 :fill-pointer 1 :initial-element x))
            (point (make-point :px x)) (thing (make-instance 'thing :weight x))
            (boxed (make-instance 'thing :weight (list x)))
            (condition (make-condition 'simple-error :format-arguments (list x)))
            (motion (plan:make-designator :motion `((:type :going) (:speed ,x)))))
       (setf (cdddr circle) circle
             (second circle) vector
             (gethash :k table) x
             (gethash boxed table) circle)
       (let ((all (list circle vector matrix filled point thing table condition motion)))
         (is (eq all (symbolic::decided all "everything"))))
       (is (= 1 (alternatives)))
       (is (eql 4 (first circle)))
       (is (eql 4 (third circle)))
       (is (eq circle (cdddr circle)))
       (is (eql 4 (svref vector 0)))
       (is (eql 4 (aref matrix 0 1)))
       (is (eql 4 (aref filled 2)) "behind the fill pointer, too")
       (is (eql 4 (point-px point)))
       (is (eql 4 (thing-weight thing)))
       (is (equal '(4) (thing-weight boxed)) "inside of a key")
       (is (eql 4 (gethash :k table)))
       (is (equal '(4) (simple-condition-format-arguments condition)))
       (is (eql 4 (plan:desig-prop-value motion :speed)))
       (symbolic::undo-writes symbolic::*path*)
       (is (eql 4 (first circle)) "who keeps it finds no symbolic value later")))))

(test unbounded-numbers-are-decided-up-to-a-limit
  (call-on-a-path
   (lambda (context)
     (let ((x (symbolic-argument '?x 'integer context)))
       (is (eql 0 (symbolic::settled x "x")))
       (is (= 2 (alternatives)) "1 and -1")
       (is (search "the first 3" (first (symbolic::path-limits symbolic::*path*))))))
   :limit 3)
  (call-on-a-path
   (lambda (context)
     (let ((x (symbolic-argument '?x 'integer context)))
       (symbolic::oracle-assume (symbolic::path-oracle symbolic::*path*)
                                (z3:less 1000000 (symbolic:symbolic-number-term x)))
       (is (eql 1000001 (symbolic::settled x "x")) "the nearest to 0")))
   :limit 3)
  (call-on-a-path
   (lambda (context)
     (let ((x (symbolic-argument '?x 'integer context)))
       (symbolic::oracle-assume (symbolic::path-oracle symbolic::*path*)
                                (z3:equals (z3:product (list (symbolic:symbolic-number-term x)
                                                             (symbolic:symbolic-number-term x)))
                                           49))
       (is (eql -7 (symbolic::settled x "x")) "few possible ones are all of them, in order")
       (is (= 1 (alternatives)))
       (is (null (symbolic::path-limits symbolic::*path*)))))
   :limit 3))

(test reals-are-decided-for-the-simplest-one
  (flet ((value (low high)
           (call-on-a-path
            (lambda (context)
              (values (symbolic::settled (symbolic-argument '?x `(real ,low ,high) context) "x")
                      (length (symbolic::path-limits symbolic::*path*)))))))
    (is (equal '(0 1) (multiple-value-list (value -5 5))))
    (is (equal '(-2 1) (multiple-value-list (value '* -2))))
    (is (equal '(3 1) (multiple-value-list (value 5/2 10))))
    (is (equal '(1/2 1) (multiple-value-list (value 1/3 2/3))))
    (is (equal '(2/5 0) (multiple-value-list (value 2/5 2/5))) "the only one")))

(test types-of-arguments
  (let ((theory (symbolic:action-theory-theory (make-lamp-domain))))
    (z3:with-context (context)
      (flet ((argument (type) (symbolic:make-symbolic-argument '?x type theory context)))
        (is (equal '(:a :b) (mapcar #'car (symbolic:symbolic-element-choices (argument 'lamp)))))
        (is (equal '(:a :b) (mapcar #'car (symbolic:symbolic-element-choices (argument :lamp)))))
        (is (equal '(1 "b") (mapcar #'car (symbolic:symbolic-element-choices
                                           (argument '(member 1 "b"))))))
        (is (equal '(integer 1 *) (symbolic:symbolic-number-type (argument '(integer 1 *)))))
        (is (eq 'rational (symbolic:symbolic-number-type (argument 'real))))
        (dolist (type '(nothing (integer 3 1) (integer 0) (integer 0 1/2) (member) 7 nil "lamp"
                        (real a b)))
          (let ((condition (handler-case (progn (argument type) nil)
                             (symbolic:unknown-argument-type (condition) condition))))
            (is (typep condition 'symbolic:unknown-argument-type) "~s" type)
            (is (eq '?x (symbolic:unknown-argument-type-parameter condition)))
            (is (equal '(:lamp) (symbolic:unknown-argument-type-sorts condition)))
            (is (equal type (symbolic:unknown-argument-type-type condition)))
            (is (search "lamp" (princ-to-string condition)))))))))

(test concrete-values-of-arguments
  (z3:with-context (context)
    (dolist (case '((boolean nil) ((integer 3 3) 3) ((real 1/2 1/2) 1/2) ((member :a) :a)))
      (destructuring-bind (type expected) case
        (multiple-value-bind (value propositions concrete)
            (symbolic:make-symbolic-argument '?x type nil context)
          (declare (ignore value))
          (z3:with-solver (solver context :logic nil)
            (dolist (proposition propositions) (z3:solver-assert solver proposition))
            (when (eq type 'boolean)
              (z3:solver-assert solver (z3:negation (z3:variable context "argument ?x"))))
            (is (eq :sat (z3:check solver)))
            (is (eql expected
                     (funcall concrete (lambda (term) (z3:model-value solver term)))))))))))

(test output-shows-the-text-of-symbolic-values
  "What goes to the plan's output decides nothing; a string that the plan gets does."
  (call-on-a-path
   (lambda (context)
     (let* ((x (symbolic-argument '?x '(member :a :b) context))
            (output (make-string-output-stream))
            (*standard-output* output) (symbolic::*plan-output* output))
       (symbolic:evaluate `(progn (princ ',x) (format t " ~a ~s~%" ',x 1) (print ',x)))
       (is (= 0 (alternatives)))
       (is (search "#<symbolic :a or :b> #<symbolic :a or :b> 1" (get-output-stream-string output)))
       (is (string= "a" (symbolic:evaluate `(format nil "~(~a~)" ',x))))
       (is (= 1 (alternatives)))))))

(test kinds-of-functions
  (is (eq :lifted (symbolic:function-kind '+)))
  (is (eq :lifted (symbolic:function-kind 'discrepancy-finder.cpl:+)))
  (is (eq :lifted (symbolic:function-kind 'find-if)))
  (is (eq :transparent (symbolic:function-kind 'cons)))
  (is (eq :transparent (symbolic:function-kind '(setf aref))))
  (is (eq :transparent (symbolic:function-kind 'point-px)))
  (is (eq :transparent (symbolic:function-kind '(setf point-px))))
  (is (eq :transparent (symbolic:function-kind 'thing-weight)))
  (is (eq :opaque (symbolic:function-kind 'compiled-type)))
  (is (eq :opaque (symbolic:function-kind 'no-such-function-anywhere)))
  (is (eql 3 (funcall (symbolic:lifted-function '+) 1 2))))
