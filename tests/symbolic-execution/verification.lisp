;;;; Safety properties: counterexamples, verified, verified up to bounds.

(in-package #:discrepancy-finder.tests)

(def-suite verification :in all)
(in-suite verification)

(defun verify-text (text property &rest options)
  (make-lamp-domain)
  (with-file (file text)
    (plan:load-plan file)
    (apply #'symbolic:verify-plan 'discrepancy-finder-user::lamp-plan :domain :lamps
                                                                      :property property options)))

(defparameter *careful-plan* "
(def-top-level-cram-function lamp-plan ()
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (perform (a motion (type toggling) (lamp a)))
    (perform (a motion (type toggling) (lamp a)))))")

(test what-holds-everywhere-is-verified
  (dolist (property '((not (and (holds-at (lit a) ?time) (holds-at (broken a) ?time)))
                      (implies (holds-at (broken a) ?time) (holds-at (broken a) (+ ?time 1)))
                      (:never (and (happens (smash b) ?time)))
                      (:never (happens (smash b) ?time))
                      :no-failure :no-error))
    (let ((verification (verify-text *careful-plan* property)))
      (is (eq :verified (symbolic:verification-verdict verification)) "~a" verification)
      (is (null (symbolic:verification-counterexample verification)))
      (is (null (symbolic:verification-bounds verification)))
      (is (search "verified on all 2 paths" (princ-to-string verification)))))
  (is (search "verified on its only path"
              (princ-to-string (verify-text "(def-top-level-cram-function lamp-plan () 1)"
                                            :no-failure)))))

(test what-is-violated-has-a-shortest-counterexample
  (let* ((verification (verify-text *careful-plan* '(not (holds-at (broken a) (+ ?time 1)))))
         (trace (symbolic:verification-counterexample verification))
         (text (with-output-to-string (stream) (describe verification stream))))
    (is (eq :counterexample (symbolic:verification-verdict verification)))
    (is (<= 1 (length (symbolic:trace-steps trace)) 2))
    (is (member '(:broken :a) (ec:state-fluents (symbolic:trace-final-state trace))
                :test #'equal))
    (is (null (find #\Newline (princ-to-string verification))))
    (is (search "violated after" (princ-to-string verification)))
    (dolist (part '("counterexample" ":4: (a motion (type toggling) (lamp a))" "finally"
                    "(broken a)" "paths at"))
      (unless (equal part "paths at")
        (is (search part text) "~s is not in ~a" part text)))))

(test a-property-is-needed
  (dolist (property '(nil :any-action))
    (signals-with (symbolic:unsupported-form "a formula, a state constraint")
      (verify-text *careful-plan* property)))
  (signals-with (symbolic:unsupported-form "a number of seconds was expected")
    (verify-text *careful-plan* :no-failure :max-seconds -1))
  (signals-with (symbolic:unsupported-form "one of each")
    (verify-text *careful-plan* :no-failure :arguments '((?x real) (?x integer)))))

(test errors-of-tasks-and-endless-recursion-are-errors-of-the-plan
  (let ((verification (verify-text "
(def-top-level-cram-function lamp-plan (?flag)
  (when ?flag (wait-for (make-fluent))))" :no-error :arguments '((?flag boolean)))))
    (is (eq :counterexample (symbolic:verification-verdict verification)))
    (is (typep (symbolic:verification-problem verification) 'plan:deadlock))
    (is (equal '(t) (symbolic:trace-arguments
                     (symbolic:verification-counterexample verification)))))
  (let* ((*error-output* (make-broadcast-stream))
         (verification (verify-text "
(def-top-level-cram-function lamp-plan ()
  (labels ((deeper (n) (1+ (deeper n))))
    (deeper 0)))" :no-error)))
    (is (eq :counterexample (symbolic:verification-verdict verification)))
    (is (typep (symbolic:verification-problem verification) 'symbolic:plan-broke))))

(test a-path-without-a-trace-is-a-gap
  "The square root of two, of which there is no rational number to show, leads to a failure."
  (let ((verification (verify-text "
(def-top-level-cram-function lamp-plan (?x)
  (when (= (* ?x ?x) 2)
    (fail \"irrational\")))" :no-failure :arguments '((?x real)))))
    (is (not (eq :verified (symbolic:verification-verdict verification))))
    (is (search "found no initial state"
                (format nil "~{~a~}" (symbolic:verification-bounds verification))))))

(test a-violation-of-the-first-state-needs-no-step
  (let ((trace (symbolic:verification-counterexample
                (verify-text *careful-plan* '(not (holds-at (broken b) ?time))))))
    (is (null (symbolic:trace-steps trace)))
    (is (equal '((:broken :b)) (ec:state-fluents (symbolic:trace-initial-state trace))))))

(test bounds-are-named
  (let ((verification (verify-text "
(def-top-level-cram-function lamp-plan ()
  (loop (perform (a motion (type smashing) (lamp b)))))"
                                   '(:never (happens (smash a) ?time)) :max-steps 4)))
    (is (eq :verified-up-to-bounds (symbolic:verification-verdict verification)))
    (is (equal '("paths of more than 4 steps") (symbolic:verification-bounds verification)))
    (is (search "up to bounds" (princ-to-string verification)))))

(test named-constraints-are-properties
  (is (eq :counterexample (symbolic:verification-verdict
                           (verify-text *careful-plan* '(:never lamp-a-lit)))))
  (is (eq :counterexample (symbolic:verification-verdict
                           (verify-text *careful-plan* 'lamp-a-lit))))
  (signals ec:state-constraint-not-found (verify-text *careful-plan* 'no-such-constraint))
  (signals symbolic:unsupported-form (verify-text *careful-plan* '(:never))))

(test failures-that-leave-the-plan
  (let* ((verification (verify-text "
(def-top-level-cram-function lamp-plan ()
  (perform (a motion (type smashing) (lamp b)))
  (perform (a motion (type toggling) (lamp a))))" :no-failure))
         (trace (symbolic:verification-counterexample verification)))
    (is (eq 'plan:gripper-goal-not-reached (symbolic:verification-problem verification)))
    (is (equal '(:success plan:gripper-goal-not-reached)
               (mapcar #'symbolic:step-outcome (symbolic:trace-steps trace))))
    (is (eq 'plan:gripper-goal-not-reached (symbolic:trace-ending trace)))
    (is (search "gripper-goal-not-reached"
                (with-output-to-string (stream) (describe verification stream))))))

(test errors-that-leave-the-plan
  (let* ((text "
(def-top-level-cram-function lamp-plan (?flag ?n)
  (with-failure-handling ((plan-failure () (return)))
    (perform (a motion (type toggling) (lamp b))))
  (unwind-protect
       (when (and ?flag (= ?n 2)) (car ?n))
    (discrepancy-finder.tests::count-a-run)))")
         (verification (verify-text text :no-error
                                    :arguments '((?flag boolean) (?n (integer 0 3))))))
    (is (eq :counterexample (symbolic:verification-verdict verification)))
    (is (equal '(t 2) (symbolic:trace-arguments
                       (symbolic:verification-counterexample verification))))
    (is (eq :error (symbolic:trace-ending (symbolic:verification-counterexample verification))))
    (is (typep (symbolic:verification-problem verification) 'symbolic:plan-broke))
    (is (search "2 is not" (with-output-to-string (stream) (describe verification stream)))))
  (signals symbolic:action-problem
    (verify-text "(def-top-level-cram-function lamp-plan ()
  (perform (a motion (type singing))))" :no-error)))

(test a-property-of-example-1
  (is (eq :verified (df:verification-verdict
                     (df:verify-plan 'discrepancy-finder-user::move-the-box
                                     :domain :two-regions
                                     :property '(not (and (holds-at (box-in r1) ?time)
                                                      (holds-at (box-in r2) ?time)))))))
  (is (eq :counterexample (df:verification-verdict
                           (df:verify-plan 'discrepancy-finder-user::move-the-box
                                           :domain :two-regions
                                           :property '(:never (holds-at (holding-box) ?time)))))))

(test counterexamples-run-in-the-projection-world
  "The robot does hold the box, from a sample of the counterexample's initial state."
  (let* ((verification (df:verify-plan 'discrepancy-finder-user::move-the-box
                                       :domain :two-regions
                                       :property '(:never (holds-at (holding-box) ?time))))
         (trace (df:verification-counterexample verification))
         (domain (two-regions))
         (parameters (discrepancy:initial-parameters domain trace))
         (run (discrepancy:execute-sample domain 'discrepancy-finder-user::move-the-box
                                          (discrepancy:draw-sample parameters 1 1 0)
                                          :trace trace)))
    (is (equal '((:move :r2) (:pick-up)) (mapcar #'symbolic:step-event
                                                 (symbolic:trace-steps trace))))
    (is (member '(:holding-box) (ec:state-fluents (symbolic:trace-final-state trace))
                :test #'equal))
    (is (= 2 (length (discrepancy:run-steps run))))
    (is (member '(:holding-box) (discrepancy::observed-fluents (discrepancy:run-final-state run))
                :test #'equal))))
