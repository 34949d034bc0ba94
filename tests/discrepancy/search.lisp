(in-package #:discrepancy-finder.tests)

(def-suite search :in all)
(in-suite search)

(defun find-in-example (reach &rest options)
  (apply #'df:find-discrepancies 'discrepancy-finder-user::move-the-box :domain :two-regions
         :parameters (list :reach reach) options))

(defun example-trace ()
  (first (symbolic:exploration-traces
          (df:explore-plan 'discrepancy-finder-user::move-the-box :domain :two-regions))))

(defun run-of (trace reach &rest values)
  "Run TRACE from the sample with VALUES (robot.x, robot.yaw, box.x, box.y, box.yaw)."
  (let ((domain (discrepancy:domain-with-parameters (two-regions) (list :reach reach))))
    (discrepancy:execute-sample
     domain 'discrepancy-finder-user::move-the-box
     (discrepancy::make-sample 0 (discrepancy:initial-parameters domain trace)
                               (map 'vector (lambda (value) (float value 1d0)) values))
     :trace trace)))

(test samples-are-a-pure-function-of-seed-trace-and-index
  (let* ((parameters (discrepancy:initial-parameters (two-regions) (example-trace))))
    (is (equal '("robot.x" "robot.yaw" "box.x" "box.y" "box.yaw")
               (mapcar #'discrepancy:parameter-name parameters)))
    (flet ((values-of (seed content index)
             (coerce (discrepancy:sample-values
                      (discrepancy:draw-sample parameters seed content index))
                     'list)))
      (is (equal (values-of 1 2 3) (values-of 1 2 3)))
      (is (not (equal (values-of 1 2 3) (values-of 2 2 3))))
      (is (not (equal (values-of 1 2 3) (values-of 1 3 3))))
      (is (not (equal (values-of 1 2 3) (values-of 1 2 4))))
      (dotimes (index 200)
        (loop for value in (values-of 7 7 index) for parameter in parameters
              do (is (<= (discrepancy:parameter-min parameter) value))
                 (is (< value (discrepancy:parameter-max parameter))))))))

(test a-sample-that-is-not-the-traces-initial-state-is-rejected
  (let ((trace (example-trace)))
    (is (eq :valid (discrepancy:run-validity (run-of trace 0.8 0.5 0 1.5 0.4 0))))
    (is (search "(box-in r1)" (discrepancy:run-validity (run-of trace 0.8 0.5 0 0.5 0.4 0))))
    (is (search "(robot-in r1)" (discrepancy:run-validity (run-of trace 0.8 1.5 0 1.5 0.4 0))))
    (is (search "penetrate" (discrepancy:run-validity (run-of trace 0.8 0.5 0.7 1.5 0.4 0)))
        "turned by 0.7 rad the base stands in the bench")
    (is (null (discrepancy:run-steps (run-of trace 0.8 1.5 0 1.5 0.4 0))))))

(test judgements
  (let* ((trace (example-trace))
         (good (run-of trace 0.5 0.5 0 1.5 0.4 0))
         (bad (run-of trace 0.5 0.5 0 1.9 0.4 0))
         (judgement (discrepancy:judge-run (two-regions) bad trace))
         (divergence (discrepancy:judgement-divergence judgement)))
    (is (eq :consistent (discrepancy:judgement-verdict
                         (discrepancy:judge-run (two-regions) good trace))))
    (is (eq :trace-done (discrepancy:run-ending good)))
    (is (eq :left-trace (discrepancy:run-ending bad)))
    (is (eq :discrepancy (discrepancy:judgement-verdict judgement)))
    (is (= 1 (discrepancy:divergence-step divergence)))
    (is (eq :outcome (discrepancy:divergence-kind divergence)))
    (is (equal '(((:holding-box) t nil)) (discrepancy:divergence-fluents divergence)))))

(test what-the-theory-allows-is-no-discrepancy
  "A failure that the theory allows leaves the trace."
  (let* ((trace (example-trace))
         (bad (run-of trace 0.5 0.5 0 1.9 0.4 0))
         (steps (discrepancy:run-steps bad))
         (allowed (symbolic::make-outcome :name 'plan:manipulation-pose-unreachable
                                          :event nil :condition t))
         (lenient (discrepancy::make-run
                   :initial-state (discrepancy:run-initial-state bad)
                   :steps (list (first steps)
                                (discrepancy::make-run-step
                                 :designator (discrepancy:run-step-designator (second steps))
                                 :outcome 'plan:manipulation-pose-unreachable
                                 :candidates (list allowed)
                                 :state (discrepancy:run-step-state (second steps)))))))
    (is (eq :left-trace (discrepancy:judgement-verdict
                         (discrepancy:judge-run (two-regions) lenient trace))))))

(test a-divergence-that-heals-counts-only-if-asked-for
  "Give the run of a box in r2 a wrong observation in the middle."
  (let* ((trace (example-trace))
         (run (run-of trace 0.8 0.5 0 1.5 0.4 0))
         (steps (discrepancy:run-steps run))
         (wrong (discrepancy::make-run
                 :initial-state (discrepancy:run-initial-state run)
                 :steps (cons (discrepancy::make-run-step
                               :designator (discrepancy:run-step-designator (first steps))
                               :candidates (discrepancy::run-step-candidates (first steps))
                               :state (discrepancy:run-initial-state run))
                              (rest steps))))
         (final (discrepancy:judge-run (two-regions) wrong trace))
         (every-step (discrepancy:judge-run (two-regions) wrong trace :compare :every-step)))
    (is (eq :consistent (discrepancy:judgement-verdict final)))
    (is (eq :discrepancy (discrepancy:judgement-verdict every-step)))
    (dolist (judgement (list final every-step))
      (let ((divergence (discrepancy:judgement-divergence judgement)))
        (is (= 0 (discrepancy:divergence-step divergence)))
        (is (eq :state (discrepancy:divergence-kind divergence)))
        (is (equal '(((:robot-in :r1) nil t) ((:robot-in :r2) t nil))
                   (discrepancy:divergence-fluents divergence)))))))

(test the-two-verdicts-of-example-1
  (let ((certified (find-in-example 0.8 :seed 1))
        (found (find-in-example 0.5 :seed 1)))
    (is (eq :certified (df:result-status certified)))
    (is (= 1 (df:result-iterations certified)))
    (is (null (df:result-discrepancy certified)))
    (is (eq :discrepancy (df:result-status found)))
    (is-true (discrepancy:discrepancy-confirmed-p (df:result-discrepancy found)))
    (let ((values (discrepancy:sample-values
                   (discrepancy:discrepancy-sample (df:result-discrepancy found)))))
      (is (> (sqrt (+ (expt (- (aref values 2) 1.5) 2) (expt (aref values 3) 2))) 0.5)
          "the box is out of reach from x = 1.5"))
    (is (search "2 simulations, seed 1" (prin1-to-string found)))))

(test every-seed-ends-by-physics
  "With an arm of 0.8 m no seed finds anything; with one of 0.5 m what is found is out of reach."
  (loop for seed from 2 to (if *long* 200 6)
        do (is (eq :certified (df:result-status (find-in-example 0.8 :seed seed))))
           (let ((result (find-in-example 0.5 :seed seed)))
             (is (member (df:result-status result) '(:certified :discrepancy)))
             (dolist (discrepancy (df:result-discrepancies result))
               (is (= 1 (discrepancy:divergence-step
                         (discrepancy:judgement-divergence
                          (df:discrepancy-judgement discrepancy)))))))))

(test restarts-of-discrepancy-found
  (flet ((search-with (restart)
           (let ((signaled 0))
             (values (handler-bind ((df:discrepancy-found
                                      (lambda (condition)
                                        (declare (ignore condition))
                                        (incf signaled)
                                        (invoke-restart restart))))
                       (find-in-example 0.5 :seed 1 :on-discrepancy :signal :budget 40))
                     signaled))))
    (multiple-value-bind (result signaled) (search-with 'df:accept)
      (is (= 1 signaled (length (df:result-discrepancies result)))))
    (multiple-value-bind (result signaled) (search-with 'df:next-trace)
      (is (= 1 signaled (length (df:result-discrepancies result)))))
    (multiple-value-bind (result signaled) (search-with 'df:continue-search)
      (is (< 1 signaled))
      (is (= signaled (length (df:result-discrepancies result))))
      (is (eq :discrepancy (df:result-status result))))))

(test impossible-arguments-are-named
  (signals-with (df:invalid-confidence "1.5") (find-in-example 0.8 :confidence 1.5))
  (signals-with (df:invalid-confidence "which 0 does") (find-in-example 0.8 :confidence 0))
  (signals-with (df:invalid-confidence "1") (find-in-example 0.8 :confidence 1))
  (signals-with (df:unknown-confidence-rule "magic" "paper")
    (find-in-example 0.8 :rule :magic))
  (signals-with (df:invalid-argument "seed" "-1") (find-in-example 0.8 :seed -1))
  (signals-with (df:invalid-argument "budget" "0") (find-in-example 0.8 :budget 0))
  (signals-with (df:invalid-argument "max-paths") (find-in-example 0.8 :max-paths 'a))
  (signals-with (df:invalid-argument "constraint") (find-in-example 0.8 :constraint 5))
  (signals-with (df:invalid-argument "plan" "move")
    (df:find-discrepancies "move-the-box" :domain :two-regions))
  (signals df:impossible-parameter
    (df:find-discrepancies 'discrepancy-finder-user::move-the-box :domain :two-regions
                                                                  :parameters '((reach 0.5))))
  (is (eq :certified (df:result-status (find-in-example 0.8 :rule 'paper))))
  (signals-with (df:invalid-argument "traces" ":every-state") (find-in-example 0.8 :traces :all))
  (signals-with (df:invalid-argument "execution") (find-in-example 0.8 :execution :quickly))
  (dolist (rule '(:paper :paper-sd :prediction))
    (signals-with (df:invalid-argument "delta" (string-downcase rule))
      (find-in-example 0.8 :rule rule :delta 0.1)))
  (signals-with (df:state-constraint-not-found "nowhere")
    (find-in-example 0.8 :constraint 'nowhere))
  (signals-with (df:plan-not-found "no-such-plan")
    (df:find-discrepancies 'no-such-plan :domain :two-regions))
  (signals-with (df:domain-not-found "no-such-domain")
    (df:find-discrepancies 'discrepancy-finder-user::move-the-box :domain :no-such-domain)))

(test a-budget-leaves-the-search-undecided
  (let ((result (find-in-example 0.8 :budget 2)))
    (is (eq :undecided (df:result-status result)))
    (is (search "budget of 2" (df:result-reason result)))))

(test a-run-that-does-not-end-certifies-nothing
  (let ((discrepancy::*step-limit* 3))
    (let ((result (find-in-example 0.8 :execution :plan)))
      (is (eq :undecided (df:result-status result)))
      (is (search "did not end within 3 steps" (df:result-reason result))))
    (is (eq :undecided (df:result-status (find-in-example 0.8 :execution :trace)))))
  (is (eq :certified (df:result-status (find-in-example 0.8 :execution :plan)))))

(test running-a-plan-from-a-state
  (let ((run (df:run-plan 'discrepancy-finder-user::move-the-box
                          :domain :two-regions :state '((:box :x 1.3 :y 0.41)))))
    (is (= 4 (length (df:run-steps run))))
    (is (equal '((:robot-in :r1) (:box-in :r1))
               (discrepancy:observed-fluents (df:run-final-state run))))
    (dolist (state '(((:box :w 1.3)) ((:box . 3)) (:box :x 3) 5))
      (signals df:invalid-argument
        (df:run-plan 'discrepancy-finder-user::move-the-box :domain :two-regions :state state)))
    (signals df:unknown-body
      (df:run-plan 'discrepancy-finder-user::move-the-box :domain :two-regions
                                                          :state '((:bench :x 1.3))))))

(test one-of-several-fitting-outcomes-is-enough
  "Two failure clauses of the same class, of which the second one applies: no discrepancy."
  (let* ((trace (example-trace))
         (bad (run-of trace 0.5 0.5 0 1.9 0.4 0))
         (steps (discrepancy:run-steps bad)))
    (flet ((verdict (&rest conditions)
             (discrepancy:judgement-verdict
              (discrepancy:judge-run
               (two-regions)
               (discrepancy::make-run
                :initial-state (discrepancy:run-initial-state bad)
                :steps (list (first steps)
                             (discrepancy::make-run-step
                              :designator (discrepancy:run-step-designator (second steps))
                              :candidates (loop for condition in conditions
                                                collect (symbolic::make-outcome
                                                         :name 'plan:manipulation-pose-unreachable
                                                         :condition condition))
                              :state (discrepancy:run-step-state (second steps)))))
               trace))))
      (is (eq :discrepancy (verdict nil nil)))
      (is (eq :left-trace (verdict nil t)))
      (is (eq :left-trace (verdict t nil))))))

(defparameter *odd-plans* "
(def-top-level-cram-function tidy-plan ()
  (unwind-protect (drive-to (make-pose (+ 1.2 (random 0.5)) 0 0))
    (drive-to (make-pose 0.5 0 0))))
(def-top-level-cram-function endless-plan ()
  (loop (drive-to (make-pose 0.5 0 0))))
(def-top-level-cram-function careless-plan ()
  (handler-case (perform (a motion (type dancing))) (error () nil)))
(def-top-level-cram-function broken-plan ()
  (unwind-protect (error \"boom\")
    (drive-to (make-pose 0.6 0 0))
    (return-from broken-plan :quietly)))
(def-top-level-cram-function dividing-plan (x)
  (handler-case (/ 1d0 x) (division-by-zero () (drive-to (make-pose 1.5 0 0)))))
")

(test plans-with-odd-habits
  (discrepancy:ensure-plan 'discrepancy-finder-user::move-the-box)
  (with-file (file *odd-plans*)
    (plan:load-plan file)
    (flet ((run-odd (name &rest arguments)
             (df:run-plan (find-symbol name '#:discrepancy-finder-user)
                          :domain :two-regions :arguments arguments)))
      (is (= (df:run-hash (run-odd "TIDY-PLAN")) (df:run-hash (run-odd "TIDY-PLAN")))
          "random numbers are the same in every run")
      (let ((discrepancy::*step-limit* 5))
        (is (eq :too-many-steps (discrepancy:run-ending (run-odd "ENDLESS-PLAN")))))
      (signals symbolic:action-problem (run-odd "CARELESS-PLAN"))
      (signals-with (symbolic:plan-broke "boom") (run-odd "BROKEN-PLAN"))
      (is (= 1 (length (df:run-steps (run-odd "DIVIDING-PLAN" 0d0))))
          "the plan has the float traps of Lisp")
      (signals df:invalid-argument (run-odd "DIVIDING-PLAN")))))
