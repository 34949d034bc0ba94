;;;; The evaluator on concrete programs, against SBCL's compiler and against SBCL's own interpreter.
;;;;
;;;; The goals: at most 60 times the time of compiled code, and no more than that of sb-eval.
;;;; Rounds of evaluator and compiled code take turns; times are of the processor.

(in-package #:discrepancy-finder.bench)

(defparameter *evaluator-programs*
  '(("(fib 25)"
     (labels ((fib (n) (if (< n 2) n (+ (fib (- n 1)) (fib (- n 2)))))) (fib 25)))
    ("million hash writes"
     (let ((table (make-hash-table)))
       (dotimes (i 1000000 (hash-table-count table))
         (setf (gethash (mod i 1000) table) i))))
    ("sorting 100 000 conses"
     (let ((list '()) (number 1))
       (dotimes (i 100000)
         (setq number (mod (+ (* number 1103515245) 12345) 2147483648))
         (push (cons number i) list))
       (caar (sort list (lambda (one other) (< (car one) (car other))))))))
  "Programs of the speed goals, with their names.")

(defun processor-seconds (function)
  "Return the processor time (s) that FUNCTION takes."
  (let ((start (get-internal-run-time)))
    (funcall function)
    (/ (- (get-internal-run-time) start)
       (float internal-time-units-per-second 1d0))))

(defun compiled-program (form)
  (handler-bind ((warning #'muffle-warning))
    (compile nil `(lambda () ,form))))

(defun compare-evaluator (form &key (rounds 7))
  "Return the median time (s) of FORM in the evaluator, and how many times as long as compiled code
and as SBCL's interpreter it takes."
  (let ((compiled (compiled-program form))
        (ours '()) (theirs '()))
    (funcall compiled)
    (loop repeat rounds
          do (push (processor-seconds (lambda () (symbolic:evaluate form))) ours)
             (push (/ (processor-seconds (lambda () (loop repeat 5 do (funcall compiled)))) 5)
                   theirs))
    (values (median ours)
            (median (mapcar #'/ ours theirs))
            (/ (median ours)
               (processor-seconds (lambda ()
                                    (let ((sb-ext:*evaluator-mode* :interpret))
                                      (eval form))))))))

(defun print-evaluator-benchmarks (stream)
  "Run the benchmarks of the evaluator and print their figures to STREAM."
  (loop for (name form) in *evaluator-programs*
        do (multiple-value-bind (seconds to-compiled to-interpreted) (compare-evaluator form)
             (format stream "evaluator, ~23a~6,1f ms, ~,1f times compiled code (goal 60), ~,2f ~
                             times sb-eval (goal 1)~%"
                     name (* 1d3 seconds) to-compiled to-interpreted))))
