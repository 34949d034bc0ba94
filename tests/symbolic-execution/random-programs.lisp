;;;; Random programs: the evaluator must do with them what SBCL's compiler does.
;;;;
;;;; A program computes with integers.  A form is made from a number of levels that are left; what
;;;; may be used in it (variables, functions, blocks, tags to throw to) is a WORLD.  Loops are
;;;; bounded, functions call only functions that were there before: every program ends.

(in-package #:discrepancy-finder.tests)

(def-suite random-programs :in all)
(in-suite random-programs)

(defstruct world
  "What is visible: lists of names; functions are (name . number of arguments)."
  (variables '()) (functions '()) (blocks '()) (catches '()) (restarts '()))

(defvar *name-number* 0)

(defun fresh-name (prefix)
  (alexandria:symbolicate prefix (princ-to-string (incf *name-number*))))

(defun with-in-world (world &key variable function block catch restart)
  (let ((world (copy-world world)))
    (when variable (push variable (world-variables world)))
    (when function (push function (world-functions world)))
    (when block (push block (world-blocks world)))
    (when catch (push catch (world-catches world)))
    (when restart (push restart (world-restarts world)))
    world))

(defun pick-one (list)
  (nth (random (length list)) list))

(defun some-leaf (world)
  (if (and (world-variables world) (< (random 4) 3))
      (pick-one (world-variables world))
      (- (random 20) 5)))

(defun some-body (world depth)
  (loop repeat (1+ (random 3)) collect (some-form world depth)))

(defparameter *form-makers* '()
  "The functions that make a form of world and depth.")

(defmacro define-form-maker (name (world depth) &body body)
  `(progn (defun ,name (,world ,depth) (declare (ignorable ,world ,depth)) ,@body)
          (setf *form-makers* (adjoin ',name *form-makers*))))

(defun some-form (world depth)
  "Return a random form whose value is an integer, with DEPTH levels at most."
  (if (or (<= depth 0) (zerop (random 8)))
      (some-leaf world)
      (or (funcall (pick-one *form-makers*) world (1- depth))
          (some-leaf world))))

(define-form-maker some-arithmetic (world depth)
  (let ((one (some-form world depth)) (other (some-form world depth)))
    ;; Numbers must not grow beyond all bounds.
    (if (zerop (random 6))
        `(* (mod ,one 1000) (mod ,other 1000))
        `(,(pick-one '(+ - min max logand logxor)) ,one ,other))))

(define-form-maker some-quotient (world depth)
  `(quotient ',(pick-one '(floor truncate mod rem))
             ,(some-form world depth) ,(some-form world depth)))

(defun quotient (function dividend divisor)
  "Call FUNCTION; the compiler, which leaves out divisions by zero whose value is not needed, cannot
know of it."
  (values (funcall function dividend divisor)))

(define-form-maker some-test (world depth)
  `(,(pick-one '(if if when-else)) ,(some-truth world depth)
    ,(some-form world depth) ,(some-form world depth)))

(defmacro when-else (test then else)
  `(cond (,test ,then) (t ,else)))

(defun some-truth (world depth)
  (case (random 5)
    (0 `(and ,(some-truth world (1- depth)) ,(some-truth world (- depth 2))))
    (1 `(or (evenp ,(some-form world depth)) (plusp ,(some-leaf world))))
    (2 `(not (zerop ,(some-form world depth))))
    (t `(,(pick-one '(< > = /= eql)) ,(some-form world depth) ,(some-leaf world)))))

(define-form-maker some-case (world depth)
  `(case (mod ,(some-form world depth) 4)
     (0 ,@(some-body world depth)) ((1 2) ,(some-form world depth))
     (t ,(some-form world depth))))

(define-form-maker some-let (world depth)
  (let ((name (fresh-name 'v)) (other (fresh-name 'w)))
    `(,(pick-one '(let let*)) ((,name ,(some-form world depth)) (,other ,(some-leaf world)))
      ,@(some-body (with-in-world (with-in-world world :variable name) :variable other) depth)
      (+ ,name ,other))))

(define-form-maker some-special (world depth)
  (let ((inner (with-in-world world :variable '*special-number*)))
    `(let ((*special-number* ,(some-form world depth))) ,@(some-body inner depth))))

(defvar *special-number* 1)

(define-form-maker some-setq (world depth)
  (let ((variable (and (world-variables world) (pick-one (world-variables world)))))
    (and variable
         `(,(pick-one '(setq incf decf setf)) ,variable ,(some-form world depth)))))

(define-form-maker some-print (world depth)
  `(progn (princ ,(some-form world depth)) (princ " ") ,(some-leaf world)))

(define-form-maker some-loop (world depth)
  (let* ((i (fresh-name 'i)) (sum (fresh-name 's))
         (inner (with-in-world (with-in-world world :variable sum) :block nil))
         (body (some-body inner depth)))
    (case (random 4)
      (0 `(let ((,sum 0)) (dotimes (,i ,(random 4) ,sum) (incf ,sum ,i) (progn ,@body))))
      (1 `(let ((,sum 0)) (dolist (,i '(1 2 3) ,sum) (setq ,sum (+ ,sum ,i)) (progn ,@body))))
      (2 `(let ((,sum 1)) (loop for ,i from 1 to 3 do (progn ,@body) sum (+ ,i ,sum))))
      (t `(do ((,i 0 (1+ ,i)) (,sum 0 (+ ,sum ,i))) ((>= ,i 3) ,sum) (progn ,@body))))))

(define-form-maker some-tagbody (world depth)
  (let ((n (fresh-name 'n)) (again (fresh-name 'again)) (end (fresh-name 'end)))
    `(let ((,n 0))
       (tagbody
          ,again
          (incf ,n)
          (when ,(some-truth world depth) (go ,end))
          (progn ,(some-form world depth))
          ,(if (zerop (random 2))
               `(when (< ,n 3) (go ,again))
               `(mapc (lambda (x) (when (< (+ x ,n) 4) (go ,again))) '(1 2)))
          ,end)
       ,n)))

(define-form-maker some-block (world depth)
  (let ((name (fresh-name 'block)))
    `(block ,name ,@(some-body (with-in-world world :block name) depth))))

(define-form-maker some-return (world depth)
  (and (world-blocks world)
       `(return-from ,(pick-one (world-blocks world)) ,(some-form world depth))))

(define-form-maker some-catch (world depth)
  (let ((tag (fresh-name 'tag)))
    `(catch ',tag ,@(some-body (with-in-world world :catch tag) depth))))

(define-form-maker some-throw (world depth)
  (and (world-catches world)
       `(if ,(some-truth world depth)
            (throw ',(pick-one (world-catches world)) ,(some-form world depth))
            ,(some-leaf world))))

(define-form-maker some-protection (world depth)
  `(unwind-protect ,(some-form world depth) ,@(some-body world depth)))

(define-form-maker some-function (world depth)
  (let* ((name (fresh-name 'f)) (x (fresh-name 'x)) (y (fresh-name 'y))
         (inner (with-in-world (with-in-world world :variable x) :variable y)))
    `(,(pick-one '(flet labels)) ((,name (,x &optional (,y ,(some-form world 1)))
                               ,@(some-body (with-in-world inner :block name) depth)))
      ,@(some-body (with-in-world world :function (cons name 1)) depth))))

(define-form-maker some-call (world depth)
  (let ((function (and (world-functions world) (first (pick-one (world-functions world))))))
    (and function
         (pick-one (list `(,function ,(some-form world depth))
                     `(,function ,(some-form world depth) ,(some-leaf world))
                     `(funcall #',function ,(some-form world depth))
                     `(reduce #'+ (mapcar #',function (list 1 2 ,(some-leaf world)))))))))

(define-form-maker some-lambda (world depth)
  (let* ((x (fresh-name 'x)) (inner (with-in-world world :variable x)))
    (pick-one (list `(funcall (lambda (,x) ,@(some-body inner depth)) ,(some-form world depth))
                `(apply #'+ (mapcar (lambda (,x) ,@(some-body inner depth)) (list 1 2)))
                `((lambda (&key (,x ,(some-form world 1))) ,@(some-body inner depth))
                  ,@(and (zerop (random 2))
                         `(,(intern (symbol-name x) :keyword) ,(some-form world depth))))))))

(define-form-maker some-counter (world depth)
  (let ((n (fresh-name 'n)) (f (fresh-name 'f)))
    `(let* ((,n ,(some-leaf world)) (,f (lambda () (incf ,n ,(some-form world 1)))))
       (funcall ,f) ,@(some-body (with-in-world world :variable n) depth)
       (+ ,n (funcall ,f)))))

(define-form-maker some-values (world depth)
  (let ((a (fresh-name 'a)) (b (fresh-name 'b)))
    `(multiple-value-bind (,a ,b)
         ,(pick-one (list `(values ,(some-form world depth) ,(some-form world depth))
                      `(floor ,(some-form world depth) 3)))
       (setq ,a (+ ,a ,b))
       ,@(some-body (with-in-world (with-in-world world :variable a) :variable b) depth))))

(define-form-maker some-handler (world depth)
  (pick-one (list `(handler-case ,(some-form world depth)
                 (division-by-zero () ,(some-form world depth)))
              `(handler-case (error "~a" ,(some-form world depth))
                 (error (e) (princ e) ,(some-leaf world)))
              `(or (ignore-errors ,(some-form world depth)) ,(some-leaf world)))))

(define-form-maker some-restart (world depth)
  (let ((name (fresh-name 'restart)) (x (fresh-name 'x)))
    `(restart-case ,(some-form (with-in-world world :restart name) depth)
       (,name (,x) ,(some-form (with-in-world world :variable x) depth)))))

(define-form-maker some-invocation (world depth)
  (and (world-restarts world)
       `(if ,(some-truth world depth)
            (invoke-restart ',(pick-one (world-restarts world)) ,(some-leaf world))
            ,(some-leaf world))))

(define-form-maker some-macro (world depth)
  (let ((m (fresh-name 'm)) (s (fresh-name 's)) (v (fresh-name 'v)))
    (pick-one (list `(macrolet ((,m (x) `(+ ,x ,x))) (,m ,(some-form world depth)))
                `(let ((,v (list ,(some-form world depth) 2)))
                   (symbol-macrolet ((,s (car ,v)))
                     ,@(some-body (with-in-world world :variable s) depth)
                     (reduce #'+ ,v)))))))

(defun some-program (seed)
  "Return the random program with the number SEED."
  (let ((*random-state* (sb-ext:seed-random-state seed)) (*name-number* 0))
    (let ((a (fresh-name 'a)))
      `(let ((,a ,(random 10)))
         (list ,(some-form (make-world :variables (list a)) (+ 4 (mod seed 2))) ,a)))))

(defun size-of (form)
  (if (consp form) (+ (size-of (car form)) (size-of (cdr form))) 1))

(test random-programs-do-what-they-do-compiled
  (loop for seed from 1 to 300
        do (let ((mismatch (program-mismatch (some-program seed))))
             (is (null mismatch) "program ~d: ~a" seed mismatch))))

(test random-programs-are-not-trivial
  (is (< 100 (loop for seed from 1 to 300
                   count (< 60 (size-of (some-program seed)))))))
