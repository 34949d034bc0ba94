;;;; The operators of the plan language give the same results under symbolic execution as compiled.
;;;;
;;;; Each form depends on the truth values ?p and ?q.  Compiled, it is run for all four pairs of
;;;; them; explored, they are symbolic.  The sets of (?p ?q results) must be the same: so every way
;;;; that a concrete run can take is explored, and no other.

(in-package #:discrepancy-finder.tests)

(def-suite cpl-operators :in all)
(in-suite cpl-operators)

(defvar *results* '()
  "What NOTE-RESULTS was called with.")

(defun note-results (&rest results)
  (pushnew results *results* :test #'equal))

(defparameter *operator-helpers* "
(defun act (flag)
  \"Fail if FLAG is true.\"
  (if flag (fail 'gripper-goal-not-reached) :done))
(def-cram-function act-in-a-task (flag) (act flag))
(def-process-module lever (designator)
  (act (desig-prop-value designator :flag)))
(def-fact-group lever-facts (matching-process-module available-process-module)
  (<- (matching-process-module ?designator lever)
    (desig-prop ?designator (:type :pulling)))
  (<- (available-process-module lever)))
(define-policy no-longer-than (flag)
  \"Ends what it watches if FLAG is true.\"
  (:check flag))
")

(defparameter *operator-forms*
  '("(act ?p)"
    "(with-failure-handling ((gripper-goal-not-reached () (return :failed))) (act ?p))"
    "(with-failure-handling ((gripper-goal-not-reached (failure)
                               (return (if ?q (type-of failure) :no))))
       (act-in-a-task ?p))"
    "(let ((tries 0))
       (with-failure-handling ((plan-failure () (when (< tries 2) (incf tries) (retry))
                                                (return (list :gave-up tries))))
         (act (and ?p (or ?q (< tries 1))))
         (list :done tries)))"
    "(with-retry-counters ((counter 3))
       (with-failure-handling ((plan-failure () (do-retry counter (when ?q (retry)))
                                               (return :gave-up)))
         (act ?p)))"
    "(with-retry-counters ((counter 2))
       (with-failure-handling ((plan-failure ()
                                 (do-retry counter (setf ?q nil) (retry))
                                 (return (get-counter counter))))
         (act (or ?p ?q))))"
    "(seq (act ?p) (act ?q) :last)"
    "(try-in-order (act ?p) (act ?q))"
    "(try-in-order (progn (act ?p) :first) (progn (act ?q) :second) :third)"
    "(try-each-in-order (flag (list ?p ?q)) (act flag))"
    "(try-all (act ?p) (act ?q))"
    "(try-all (progn (sleep 2) (act ?p) :slow) (progn (sleep 1) (act ?q) :fast))"
    "(par (act ?p) (act ?q))"
    "(let ((log '()))
       (with-failure-handling ((plan-failure () (return (reverse (cons :failed log)))))
         (par (progn (push 1 log) (sleep 1) (act ?p) (push 2 log))
              (progn (push 3 log) (sleep 2) (act ?q) (push 4 log))))
       (reverse log))"
    "(let ((sum 0))
       (par-loop (flag (list ?p ?q)) (when flag (incf sum)))
       sum)"
    "(pursue (progn (sleep 2) (act ?p) :slow) (progn (sleep 1) (act ?q) :fast))"
    "(pursue (wait-for (make-fluent :value ?p)) (progn (sleep 1) :waited))"
    "(let ((log '()))
       (partial-order ((:tag one (act ?p) (push 1 log))
                       (:tag two (act ?q) (push 2 log)))
         (:order two one))
       log)"
    "(let ((fluent (make-fluent :value 0)))
       (par (wait-for (fl> fluent 1))
            (progn (when ?p (setf (value fluent) 2))
                   (sleep 1)
                   (setf (value fluent) (if ?q 3 4))))
       (value fluent))"
    "(let ((fluent (make-fluent :value nil)) (count 0))
       (pursue (whenever (fluent) (incf count) (setf (value fluent) nil))
               (progn (sleep 1) (when ?p (setf (value fluent) t))
                      (sleep 1) (when ?q (setf (value fluent) t))
                      (sleep 1)))
       count)"
    "(let ((fluent (make-fluent :value ?p)))
       (value (fl-or fluent (fl-not (fl-eq fluent ?q)))))"
    "(with-tags
       (par (:tag worker (sleep 1) (act ?p))
            (seq (wait-for (task-dead worker)) (act ?q)))
       (value (status worker)))"
    "(let ((log '()))
       (with-tags
         (par (:tag worker (dotimes (i 3) (push i log) (sleep 1)))
              (progn (sleep 1)
                     (when ?p
                       (with-task-suspended (worker) (push :paused log) (sleep 5)
                         (act ?q) (push :on log))))))
       (reverse log))"
    "(let ((log '()))
       (with-tags
         (pursue (:tag worker (dotimes (i 3) (push i log) (sleep 1)))
                 (progn (when ?p (sleep 1)) (suspend worker) (sleep 3)
                        (if ?q (wake-up worker) (evaporate worker)) (sleep 9))))
       (reverse log))"
    "(with-failure-handling ((plan-failure () (return :failed)))
       (unwind-protect (act ?p) (act ?q)))"
    "(handler-case (with-named-policy 'no-longer-than (?p) (sleep 1) :undisturbed)
       (policy-check-condition-met () (if ?q :stopped :halted)))"
    "(with-process-modules-running (lever)
       (with-failure-handling ((plan-failure () (return :failed)))
         (perform (a motion (type pulling) (flag ?p)))))"
    "(with-process-modules-running (lever)
       (let ((log '()))
         (with-failure-handling ((plan-failure () (return (cons :failed log))))
           (par (progn (perform (a motion (type pulling) (flag ?p))) (push 1 log))
                (progn (perform (a motion (type pulling) (flag ?q))) (push 2 log))))
         log))"
    "(let ((action (an action (type acting) (flag ?p))))
       (list (desig-prop-value action :flag)
             (desig-prop-value (copy-designator action :new-description `((:other ,?q))) :other)))"
    "(let* ((first (an object (type cup) (name ?p)))
            (second (an object (type cup) (name ?q))))
       (when ?p (equate first second))
       (list (desig-equal first second) (eq (current-desig first) second)))"
    "(catch 'out (seq (when ?p (throw 'out :thrown)) (act ?q)))"
    "(block out (seq (when ?p (return-from out :out)) (act ?q)))")
  "Forms whose results depend on ?p and ?q.")

(defun operator-plan (form)
  "Return the text of a plan that notes ?p, ?q and what FORM returns, or how it fails or errs."
  (format nil "~a
(def-top-level-cram-function operator-plan (?p ?q)
  (let ((p ?p) (q ?q))
    (multiple-value-call #'discrepancy-finder.tests::note-results p q
      (handler-case ~a
        (plan-failure (failure) (values :failure (type-of failure)))
        (error (condition) (values :error (type-of condition)))))))"
          *operator-helpers* form))

(defun concrete-results (form)
  (setf *results* '())
  (with-file (file (operator-plan form))
    (plan:load-plan file))
  (dolist (p '(t nil))
    (dolist (q '(t nil))
      (funcall 'discrepancy-finder-user::operator-plan p q)))
  *results*)

(defun symbolic-results (form &rest options)
  (setf *results* '())
  (with-file (file (operator-plan form))
    (plan:load-plan file)
    (let ((exploration (apply #'symbolic:explore-plan 'discrepancy-finder-user::operator-plan
                              :domain :lamps :constraint 'anything
                              :arguments '((?p boolean) (?q boolean)) options)))
      (is-true (symbolic:exploration-complete-p exploration) "~a~%~{~a~%~}" form
               (symbolic:exploration-gaps exploration))))
  *results*)

(test operators-give-the-same-results
  (make-lamp-domain)
  (dolist (form *operator-forms*)
    (let ((concrete (concrete-results form)))
      (is (= 4 (length concrete)))
      (is (null (find :error concrete :key #'third)) "~a~%errs: ~s" form concrete)
      (is (null (set-exclusive-or concrete (symbolic-results form) :test #'equal))
          "~a~%compiled: ~{~%  ~s~}~%explored: ~{~%  ~s~}" form concrete *results*))))

(test every-order-contains-the-fixed-one
  "With interleavings the results of the fixed order are among those of the others."
  (make-lamp-domain)
  (dolist (form '("(par (act ?p) (act ?q))"
                  "(pursue (progn (act ?p) 1) (progn (act ?q) 2))"
                  "(try-all (progn (act ?p) 1) (progn (act ?q) 2))"))
    (is (null (set-difference (concrete-results form) (symbolic-results form :interleavings t)
                              :test #'equal))
        "~a" form)))

(test orders-show-other-results
  "Who is first in a PURSUE depends on the order."
  (make-lamp-domain)
  (is (alexandria:set-equal
       '((t t 1) (t t 2) (nil nil 1) (nil nil 2) (t nil 1) (t nil 2) (nil t 1) (nil t 2))
       (symbolic-results "(pursue 1 2)" :interleavings t) :test #'equal)))
