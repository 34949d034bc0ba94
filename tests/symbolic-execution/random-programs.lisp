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

(defvar *counter* 0)

(defun fresh-name (prefix)
  (alexandria:symbolicate prefix (princ-to-string (incf *counter*))))

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

(defun random-leaf (world)
  (if (and (world-variables world) (< (random 4) 3))
      (pick-one (world-variables world))
      (- (random 20) 5)))

(defun random-body (world depth)
  (loop repeat (1+ (random 3)) collect (random-form world depth)))

(defparameter *random-makers* '()
  "The functions that make a form of world and depth.")

(defmacro define-random-form (name (world depth) &body body)
  `(progn (defun ,name (,world ,depth) (declare (ignorable ,world ,depth)) ,@body)
          (setf *random-makers* (adjoin ',name *random-makers*))))

(defun random-form (world depth)
  "Return a random form whose value is an integer, with DEPTH levels at most."
  (if (or (<= depth 0) (zerop (random 8)))
      (random-leaf world)
      (or (funcall (pick-one *random-makers*) world (1- depth))
          (random-leaf world))))

(define-random-form random-arithmetic (world depth)
  `(,(pick-one '(+ - * min max logand logxor)) ,(random-form world depth) ,(random-form world depth)))

(define-random-form random-quotient (world depth)
  `(quotient ',(pick-one '(floor truncate mod rem))
             ,(random-form world depth) ,(random-form world depth)))

(defun quotient (function dividend divisor)
  "Call FUNCTION; the compiler, which leaves out divisions by zero whose value is not needed, cannot
know of it."
  (values (funcall function dividend divisor)))

(define-random-form random-test (world depth)
  `(,(pick-one '(if if when-else)) ,(random-truth world depth)
    ,(random-form world depth) ,(random-form world depth)))

(defmacro when-else (test then else)
  `(cond (,test ,then) (t ,else)))

(defun random-truth (world depth)
  (case (random 5)
    (0 `(and ,(random-truth world (1- depth)) ,(random-truth world (- depth 2))))
    (1 `(or (evenp ,(random-form world depth)) (plusp ,(random-leaf world))))
    (2 `(not (zerop ,(random-form world depth))))
    (t `(,(pick-one '(< > = /= eql)) ,(random-form world depth) ,(random-leaf world)))))

(define-random-form random-case (world depth)
  `(case (mod ,(random-form world depth) 4)
     (0 ,@(random-body world depth)) ((1 2) ,(random-form world depth))
     (t ,(random-form world depth))))

(define-random-form random-let (world depth)
  (let ((name (fresh-name 'v)) (other (fresh-name 'w)))
    `(,(pick-one '(let let*)) ((,name ,(random-form world depth)) (,other ,(random-leaf world)))
      ,@(random-body (with-in-world (with-in-world world :variable name) :variable other) depth)
      (+ ,name ,other))))

(define-random-form random-special (world depth)
  (let ((inner (with-in-world world :variable '*special-number*)))
    `(let ((*special-number* ,(random-form world depth))) ,@(random-body inner depth))))

(defvar *special-number* 1)

(define-random-form random-setq (world depth)
  (let ((variable (and (world-variables world) (pick-one (world-variables world)))))
    (and variable
         `(,(pick-one '(setq incf decf setf)) ,variable ,(random-form world depth)))))

(define-random-form random-print (world depth)
  `(progn (princ ,(random-form world depth)) (princ " ") ,(random-leaf world)))

(define-random-form random-loop (world depth)
  (let* ((i (fresh-name 'i)) (sum (fresh-name 's))
         (inner (with-in-world (with-in-world world :variable sum) :block nil))
         (body (random-body inner depth)))
    (case (random 4)
      (0 `(let ((,sum 0)) (dotimes (,i ,(random 4) ,sum) (incf ,sum ,i) (progn ,@body))))
      (1 `(let ((,sum 0)) (dolist (,i '(1 2 3) ,sum) (setq ,sum (+ ,sum ,i)) (progn ,@body))))
      (2 `(let ((,sum 1)) (loop for ,i from 1 to 3 do (progn ,@body) sum (+ ,i ,sum))))
      (t `(do ((,i 0 (1+ ,i)) (,sum 0 (+ ,sum ,i))) ((>= ,i 3) ,sum) (progn ,@body))))))

(define-random-form random-tagbody (world depth)
  (let ((n (fresh-name 'n)) (again (fresh-name 'again)) (end (fresh-name 'end)))
    `(let ((,n 0))
       (tagbody
          ,again
          (incf ,n)
          (when ,(random-truth (with-in-world world :variable n) depth) (go ,end))
          (progn ,(random-form world depth))
          ,(if (zerop (random 2))
               `(when (< ,n 3) (go ,again))
               `(mapc (lambda (x) (when (< (+ x ,n) 4) (go ,again))) '(1 2)))
          ,end)
       ,n)))

(define-random-form random-block (world depth)
  (let ((name (fresh-name 'block)))
    `(block ,name ,@(random-body (with-in-world world :block name) depth))))

(define-random-form random-return (world depth)
  (and (world-blocks world)
       `(return-from ,(pick-one (world-blocks world)) ,(random-form world depth))))

(define-random-form random-catch (world depth)
  (let ((tag (fresh-name 'tag)))
    `(catch ',tag ,@(random-body (with-in-world world :catch tag) depth))))

(define-random-form random-throw (world depth)
  (and (world-catches world)
       `(if ,(random-truth world depth)
            (throw ',(pick-one (world-catches world)) ,(random-form world depth))
            ,(random-leaf world))))

(define-random-form random-protection (world depth)
  `(unwind-protect ,(random-form world depth) ,@(random-body world depth)))

(define-random-form random-function (world depth)
  (let* ((name (fresh-name 'f)) (x (fresh-name 'x)) (y (fresh-name 'y))
         (inner (with-in-world (with-in-world world :variable x) :variable y)))
    `(,(pick-one '(flet labels)) ((,name (,x &optional (,y ,(random-form world 1)))
                               ,@(random-body (with-in-world inner :block name) depth)))
      ,@(random-body (with-in-world world :function (cons name 1)) depth))))

(define-random-form random-call (world depth)
  (let ((function (and (world-functions world) (first (pick-one (world-functions world))))))
    (and function
         (pick-one (list `(,function ,(random-form world depth))
                     `(,function ,(random-form world depth) ,(random-leaf world))
                     `(funcall #',function ,(random-form world depth))
                     `(reduce #'+ (mapcar #',function (list 1 2 ,(random-leaf world)))))))))

(define-random-form random-lambda (world depth)
  (let* ((x (fresh-name 'x)) (inner (with-in-world world :variable x)))
    (pick-one (list `(funcall (lambda (,x) ,@(random-body inner depth)) ,(random-form world depth))
                `(apply #'+ (mapcar (lambda (,x) ,@(random-body inner depth)) (list 1 2)))
                `((lambda (&key (,x ,(random-form world 1))) ,@(random-body inner depth))
                  ,@(and (zerop (random 2))
                         `(,(intern (symbol-name x) :keyword) ,(random-form world depth))))))))

(define-random-form random-counter (world depth)
  (let ((n (fresh-name 'n)) (f (fresh-name 'f)))
    `(let* ((,n ,(random-leaf world)) (,f (lambda () (incf ,n ,(random-form world 1)))))
       (funcall ,f) ,@(random-body (with-in-world world :variable n) depth)
       (+ ,n (funcall ,f)))))

(define-random-form random-values (world depth)
  (let ((a (fresh-name 'a)) (b (fresh-name 'b)))
    `(multiple-value-bind (,a ,b)
         ,(pick-one (list `(values ,(random-form world depth) ,(random-form world depth))
                      `(floor ,(random-form world depth) 3)))
       (setq ,a (+ ,a ,b))
       ,@(random-body (with-in-world (with-in-world world :variable a) :variable b) depth))))

(define-random-form random-handler (world depth)
  (pick-one (list `(handler-case ,(random-form world depth)
                 (division-by-zero () ,(random-form world depth)))
              `(handler-case (error "~a" ,(random-form world depth))
                 (error (e) (princ e) ,(random-leaf world)))
              `(or (ignore-errors ,(random-form world depth)) ,(random-leaf world)))))

(define-random-form random-restart (world depth)
  (let ((name (fresh-name 'restart)) (x (fresh-name 'x)))
    `(restart-case ,(random-form (with-in-world world :restart name) depth)
       (,name (,x) ,(random-form (with-in-world world :variable x) depth)))))

(define-random-form random-invocation (world depth)
  (and (world-restarts world)
       `(if ,(random-truth world depth)
            (invoke-restart ',(pick-one (world-restarts world)) ,(random-leaf world))
            ,(random-leaf world))))

(define-random-form random-macro (world depth)
  (let ((m (fresh-name 'm)) (s (fresh-name 's)) (v (fresh-name 'v)))
    (pick-one (list `(macrolet ((,m (x) `(+ ,x ,x))) (,m ,(random-form world depth)))
                `(let ((,v (list ,(random-form world depth) 2)))
                   (symbol-macrolet ((,s (car ,v)))
                     ,@(random-body (with-in-world world :variable s) depth)
                     (reduce #'+ ,v)))))))

(defun random-lisp-program (seed)
  "Return the random program with the number SEED."
  (let ((*random-state* (sb-ext:seed-random-state seed)) (*counter* 0))
    (let ((a (fresh-name 'a)))
      `(let ((,a ,(random 10)))
         (list ,(random-form (make-world :variables (list a)) (+ 4 (mod seed 2))) ,a)))))

(defun size-of (form)
  (if (consp form) (+ (size-of (car form)) (size-of (cdr form))) 1))

(test random-programs-do-what-they-do-compiled
  (loop for seed from 1 to 300
        do (let ((mismatch (program-mismatch (random-lisp-program seed))))
             (is (null mismatch) "program ~d: ~a" seed mismatch))))

(test random-programs-are-not-trivial
  (is (< 100 (loop for seed from 1 to 300
                   count (< 60 (size-of (random-lisp-program seed)))))))
