;;;; Tests of the layer z3: threads, lives of contexts and solvers, interrupts, other processes.

(in-package #:discrepancy-finder.tests)

(in-suite z3)

;;; Threads and lives

(test two-contexts-in-two-threads
  (flet ((work ()
           (loop repeat 30
                 collect (with-z3 (context solver)
                           (assert-pigeonhole solver 5)
                           (list (z3:check solver) (z3:check-count context))))))
    (let ((threads (loop repeat 2 collect (sb-thread:make-thread #'work))))
      (dolist (thread threads)
        (let ((answers (sb-thread:join-thread thread)))
          (is (= 30 (count '(:unsat 1) answers :test #'equal))))))))

(test one-thread-at-a-time
  (with-z3 (context solver :timeout 60)
    (assert-pigeonhole solver 11)
    (let* ((main sb-thread:*current-thread*)
           (answer nil)
           (other (sb-thread:make-thread
                   (lambda ()
                     (loop until (plusp (z3:check-count context)) do (sleep 1/100))
                     (setf answer
                           (list (handler-case (z3:check solver)
                                   (z3:z3-error (condition) (z3:z3-error-code condition)))
                                 (handler-case (z3:close-context context)
                                   (z3:z3-error (condition) (z3:z3-error-code condition)))))
                     (sb-thread:interrupt-thread main (lambda () (throw 'out :interrupted)))))))
      (is (eq :interrupted (catch 'out (z3:check solver))))
      (sb-thread:join-thread other)
      (is (equal '(:busy-context :busy-context) answer)))))

(test many-lives
  (dotimes (life 100)
    (z3:with-context (context)
      (dotimes (i 20)
        (let ((solver (z3:make-solver context)))
          (z3:solver-assert solver (z3:variable context "p"))
          (unless (eq :sat (z3:check solver))
            (fail "A check of life ~d was wrong." life))
          (when (evenp i)
            (z3:close-solver solver))))))
  (pass))

(test dropped-contexts-are-deleted
  (let ((before (length z3::**open-contexts**)))
    (dotimes (i 50)
      (z3:check (z3:make-solver (z3:make-context))))
    ;; The collector is conservative and calls finalizers when it likes.
    (is (loop repeat 200
                thereis (progn (sb-ext:gc :full t)
                               (z3:with-context (context)
                                 (z3:variable context "p"))
                               (< (length z3::**open-contexts**) (+ before 10)))
              do (sleep 1/20)))))

(test solvers-leave-nothing-behind
  (if *long*
      (flet ((lives (count)
               (z3:with-context (context)
                 (loop repeat count
                       do (z3:with-released-terms (context)
                            (z3:with-solver (solver context)
                              (assert-pigeonhole solver 3)
                              (z3:check solver)
                              (z3:check solver (list (z3:variable context "p")))))))
               (sb-ext:gc :full t)
               (resident-megabytes)))
        (let ((before (lives 2000)))
          (is (< (- (lives 20000) before) 20))))
      (skip "Run with *LONG* true.")))

;;; Interruption

(defun after-a-moment (function)
  "Call FUNCTION in another thread, a little later, with the current thread as its argument."
  (let ((thread sb-thread:*current-thread*))
    (sb-thread:make-thread (lambda () (sleep 3/10) (funcall function thread)))))

(test interrupts-end-a-check
  (dolist (logic '("QF_FD" nil))
    (with-z3 (context solver :logic logic :timeout 60)
      (z3:push-scope solver)
      (assert-pigeonhole solver 11)
      (after-a-moment (lambda (thread)
                        (sb-thread:interrupt-thread thread (lambda () (throw 'out :thrown)))))
      (is (eq :thrown (catch 'out (z3:check solver))))
      (is (eq :timeout (handler-case (sb-ext:with-timeout 3/10 (z3:check solver))
                         (sb-ext:timeout () :timeout))))
      (after-a-moment (lambda (thread)
                        (sb-thread:interrupt-thread thread (lambda () (throw 'out :thrown)))))
      (let ((p (z3:variable context "p")))
        ;; An assumption that is no literal has a scope of its own, which must not be left open.
        (is (eq :thrown (catch 'out
                          (z3:check solver (list (z3:disjunction
                                                  (list p (z3:variable context "q"))))))))
        (z3:pop-scope solver)
        (signals-z3-error :index-out-of-bounds (z3:pop-scope solver))
        (is (eq :sat (z3:check solver (list p))))
        (is (eq t (z3:model-value solver p)))))))

(test interrupts-that-return-repeat-the-check
  (with-z3 (context solver)
    (assert-pigeonhole solver 8)
    (let* ((interrupts 0)
           (timer (sb-ext:make-timer (lambda () (incf interrupts))
                                     :thread sb-thread:*current-thread*)))
      (sb-ext:schedule-timer timer 1/50 :repeat-interval 1/50)
      (unwind-protect (is (eq :unsat (z3:check solver)))
        (sb-ext:unschedule-timer timer))
      (is (plusp interrupts))
      (is (> (z3:check-count context) 1)))))

(test terminated-threads-leave-a-check
  (z3:with-context (context)
    (let ((thread (sb-thread:make-thread
                   (lambda ()
                     (z3:with-solver (solver context :timeout 60)
                       (assert-pigeonhole solver 11)
                       (z3:check solver))))))
      (loop until (plusp (z3:check-count context)) do (sleep 1/100))
      (sb-thread:terminate-thread thread)
      (is (eq :gone (sb-thread:join-thread thread :default :gone)))
      (z3:with-solver (solver context)
        (is (eq :sat (z3:check solver)))))))

;;; Other processes

(defun start-lisp (forms &rest arguments)
  "Start another SBCL with this layer loaded (unless ARGUMENTS name a core) that evaluates FORMS;
return the process, whose output is a stream."
  (let ((source (uiop:with-temporary-file (:stream file :pathname pathname :keep t :type "lisp")
                  (with-standard-io-syntax
                    (let ((*package* (find-package '#:keyword)))
                      (dolist (form (append
                                     (unless arguments
                                       `((require :asdf)
                                         (asdf:load-asd
                                          ,(namestring
                                            (asdf:system-source-file "discrepancy-finder")))
                                         (asdf:load-system "discrepancy-finder/z3")
                                         (defpackage #:discrepancy-finder.tests (:use #:cl))
                                         ,(get 'assert-pigeonhole 'source)))
                                     forms))
                        (print form file))))
                  pathname)))
    (values (sb-ext:run-program sb-ext:*runtime-pathname*
                                (append arguments
                                        (list "--noinform" "--no-sysinit" "--no-userinit"
                                              "--disable-debugger" "--load"
                                              (namestring source)))
                                :wait nil :output :stream :error nil)
            source)))

(defun run-lisp (forms &rest arguments)
  "Do as START-LISP does, wait, and return the exit code."
  (multiple-value-bind (process source) (apply #'start-lisp forms arguments)
    (loop while (read-line (sb-ext:process-output process) nil))
    (sb-ext:process-wait process)
    (sb-ext:process-close process)
    (delete-file source)
    (sb-ext:process-exit-code process)))

(test sigint-reaches-lisp
  (multiple-value-bind (process source)
      (start-lisp
       '((z3:with-context (context)
           (z3:with-solver (solver context :timeout 60)
             (assert-pigeonhole solver 11)
             (write-line "checking")
             (finish-output)
             (handler-case (z3:check solver)
               (z3:solver-unknown ()
                 (sb-ext:exit :code 3))
               (sb-sys:interactive-interrupt ()
                 (z3:with-solver (other context)
                   (sb-ext:exit :code (if (eq :sat (z3:check other)) 42 4)))))))))
    (is (loop for line = (read-line (sb-ext:process-output process) nil)
              while line
                thereis (string= line "checking")))
    (sleep 1/2)
    (sb-ext:process-kill process sb-unix:sigint)
    (sb-ext:process-wait process)
    (is (= 42 (sb-ext:process-exit-code process)))
    (sb-ext:process-close process)
    (delete-file source)))

(test images-hold-no-context
  (uiop:with-temporary-file (:pathname core :type "core")
    (run-lisp `((defvar cl-user::*context* (z3:make-context))
                (z3:with-solver (solver cl-user::*context*)
                  (z3:check solver)
                  (sb-ext:save-lisp-and-die ,(namestring core)))))
    (is (= 42 (run-lisp
               '((sb-ext:exit
                  :code (handler-case (z3:variable cl-user::*context* "p")
                          (z3:z3-error ()
                            (z3:close-context cl-user::*context*)
                            (z3:with-context (context)
                              (z3:with-solver (solver context)
                                (if (eq :sat (z3:check solver)) 42 4)))))))
               "--core" (namestring core))))))
