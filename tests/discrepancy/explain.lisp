;;;; Explanations: why the theory says so, which coordinates decide, in words and as JSON.
;;;;
;;;; The runs are those of Example 1 with an arm that reaches 0.5 m, and runs with observations
;;;; changed by hand.

(in-package #:discrepancy-finder.tests)

(def-suite explain :in all)
(in-suite explain)

(defun discrepancy-of (domain run trace &key sample (comparison :consistent))
  "Return the discrepancy that RUN of TRACE is in DOMAIN."
  (discrepancy::make-discrepancy
   :plan (plan:find-plan 'discrepancy-finder-user::move-the-box) :domain domain
   :trace trace :run run :sample sample
   :judgement (discrepancy:judge-run domain run trace :comparison comparison)))

(defun side-of (discrepancy key)
  (getf (discrepancy::theory-side discrepancy) key))

(defun reasons-of (discrepancy)
  "Return the sentences why the theory claims what it claims after the step of DISCREPANCY."
  (let ((event (side-of discrepancy :event)))
    (loop for claim in (side-of discrepancy :claims)
          append (discrepancy::claim-texts claim event)
          append (discrepancy::origin-texts claim))))

(defun found-in-example (seed)
  (df:result-discrepancy (find-in-example 0.5 :seed seed)))

(test what-persists-is-called-inertia
  "The box is lost while the robot drives: nothing in the theory lets go of it."
  (let* ((trace (example-trace))
         (run (changed-run (run-of trace 0.8 0.5 0 1.5 0.4 0) 2 '((:holding-box))))
         (discrepancy (discrepancy-of (two-regions) run trace)))
    (is (equal '("(holding-box) persists by inertia through (move r1): no axiom terminates it."
                 "(holding-box) is true since step 2, (pick-up) (axiom pick-up-holds).")
               (reasons-of discrepancy)))
    (is (equal '((:inertia :holding-box :move t)) (side-of discrepancy :grounds)))))

(test what-an-axiom-brings-about-is-named
  (let* ((trace (example-trace))
         (run (changed-run (run-of trace 0.8 0.5 0 1.5 0.4 0) 0
                           '((:robot-in :r2)) '((:robot-in :r1) . t)))
         (discrepancy (discrepancy-of (two-regions) run trace)))
    (is (equal '((:axiom :move-leaves) (:axiom :move-arrives)) (side-of discrepancy :grounds)))
    (is (some (lambda (text) (search "(move r2) initiates (robot-in r2) at 0 (axiom move-arrives)"
                                     text))
              (reasons-of discrepancy)))))

(test a-conditional-effect-names-its-condition-and-since-when
  (let* ((trace (example-trace))
         (run (changed-run (run-of trace 0.8 0.5 0 1.5 0.4 0) 2
                           '((:box-in :r1)) '((:box-in :r2) . t)))
         (discrepancy (discrepancy-of (two-regions) run trace)))
    (is (member '(:axiom :move-carries-there) (side-of discrepancy :grounds) :test #'equal))
    (is (every #'discrepancy::claim-axioms (side-of discrepancy :claims)))
    (is (member "(holding-box) is true since step 2, (pick-up) (axiom pick-up-holds)."
                (reasons-of discrepancy) :test #'string=))))

(test what-is-claimed-only-together-is-one-claim
  (let* ((domain (domain-of-a-loose-box))
         (trace (trace-of-a-loose-box domain))
         (run (changed-run (run-of trace 0.8 0.5 0 1.5 0.4 0) 3 '((:box-in :r1)) '((:box-in :r2))))
         (discrepancy (discrepancy-of domain run trace)))
    (is (equal '((((:box-in :r1) . t) ((:box-in :r2) . t)))
               (mapcar #'discrepancy::claim-fluents (side-of discrepancy :claims))))
    (is (equal '((:axiom :box-somewhere)) (side-of discrepancy :grounds)))))

(test what-is-left-open-is-said-to-be
  "By exact comparison a run may differ from the trace where the theory claims nothing."
  (let* ((domain (domain-of-a-loose-box))
         (trace (trace-of-a-loose-box domain))
         (run (changed-run (run-of trace 0.8 0.5 0 1.5 0.4 0) 3
                           '((:box-in :r1)) '((:box-in :r2) . t)))
         (discrepancy (discrepancy-of domain run trace :comparison :exact)))
    (is (equal '() (side-of discrepancy :grounds)))
    (is (search "leaves it open" (first (reasons-of discrepancy))))))

(test an-outcome-that-the-theory-forbids
  (let* ((discrepancy (found-in-example 1))
         (explanation (discrepancy:explain-discrepancy discrepancy :max-runs 0))
         (text (discrepancy:explanation-text explanation)))
    (is (equal '((:binding :action :picking-up)) (discrepancy:explanation-grounds explanation)))
    (is (= 1 (discrepancy:explanation-step explanation)))
    (dolist (part '("the theory forbids that step 2"
                    "By the action binding it can end so only where (and (not (holding-box)) "
                    "(robot-in r2) is true since step 1, (move r2) (axiom move-arrives)."
                    "(box-in r2) is true from the beginning."
                    "the theory would have said that (holding-box) is true after step 2"
                    "(axiom pick-up-holds)"))
      (is (search part text) "~s is not in ~a" part text))
    (is (null (search "of-the-run" text)) "names that tell the run are shown: ~a" text)
    (is (null (search "in-the-run" text)) "names that tell the run are shown: ~a" text)
    (signals-with (discrepancy:invalid-argument "max-runs")
      (discrepancy:explain-discrepancy discrepancy :max-runs -1))
    (signals-with (discrepancy:invalid-argument "max-seconds" "a number of seconds")
      (discrepancy:explain-discrepancy discrepancy :max-seconds "1"))))

(test an-event-that-the-theory-forbids
  "Success is forbidden by a precondition: the robot picks up a box that is not there."
  (let* ((trace (example-trace))
         (run (run-of trace 0.8 0.5 0 1.5 0.4 0))
         (there (changed-run run 0 '((:box-in :r2)) '((:box-in :r1) . t)))
         (started (discrepancy::make-run
                   :initial-state (changed-state (discrepancy:run-initial-state run)
                                                 '(((:box-in :r2)) ((:box-in :r1) . t)))
                   :steps (discrepancy:run-steps there)))
         (domain (domain-with-theory
                  (two-regions)
                  (ec:revised-theory (symbolic:action-theory-theory (two-regions))
                                     :without '(:box-starts-in-r2))))
         ;; The binding asks for nothing, so that the theory alone forbids it.
         (free (discrepancy::make-run
                :initial-state (discrepancy:run-initial-state started)
                :steps (loop for step in (discrepancy:run-steps started)
                             collect (discrepancy::make-run-step
                                      :designator (discrepancy:run-step-designator step)
                                      :candidates
                                      (list (symbolic::make-outcome
                                             :name :success :condition t
                                             :event (discrepancy::seen-event step)))
                                      :state (discrepancy:run-step-state step)))))
         (discrepancy (discrepancy-of domain free trace)))
    (is (eq :outcome (side-of discrepancy :kind)))
    (is (equal '((:binding :action :picking-up) (:axiom :pick-up-needs-box-here))
               (remove '(:axiom :box-in-one-region) (side-of discrepancy :grounds)
                       :test #'equal)))))

(test an-outcome-that-the-binding-does-not-have
  (let* ((trace (example-trace))
         (bad (run-of trace 0.5 0.5 0 1.9 0.4 0))
         (run (discrepancy::make-run
               :sample (discrepancy::run-sample bad)
               :initial-state (discrepancy:run-initial-state bad)
               :steps (loop for step in (discrepancy:run-steps bad)
                            for first = t then nil
                            collect (if first
                                        step
                                        (discrepancy::make-run-step
                                         :designator (discrepancy:run-step-designator step)
                                         :outcome 'plan:manipulation-low-level-failure
                                         :state (discrepancy:run-step-state step))))))
         (discrepancy (discrepancy-of (two-regions) run trace
                                      :sample (discrepancy::run-sample bad)))
         (text (discrepancy:explanation-text
                (discrepancy:explain-discrepancy discrepancy :runs (list run) :max-runs 0))))
    (is (search "The action binding has no such outcome: it has success, manipulation-pose-unr"
                text))))

;;; Coordinates

(defun influence-on (explanation name)
  "Return the influence of the parameter called NAME alone in EXPLANATION, or NIL."
  (find-if (lambda (influence)
             (equal (list name) (mapcar #'discrepancy:parameter-name
                                        (discrepancy:influence-parameters influence))))
           (discrepancy:explanation-influences explanation)))

(test the-coordinates-that-decide-are-those-of-the-box
  "The arm reaches 0.5 m from x = 1.5 m: the boundaries are on that circle."
  (let* ((discrepancy (found-in-example 1))
         (explanation (discrepancy:explain-discrepancy discrepancy :max-runs 60))
         (values (discrepancy:sample-values (discrepancy:discrepancy-sample discrepancy))))
    (is (null (influence-on explanation "robot.x")))
    (is (null (influence-on explanation "box.yaw")))
    (flet ((distance (x y) (sqrt (+ (expt (- x 1.5) 2) (expt y 2)))))
      (let ((influence (influence-on explanation "box.x")))
        (is-true influence)
        (is (< 0.5 (distance (first (discrepancy:influence-failing influence)) (aref values 3))))
        (is (< 0.47 (distance (first (discrepancy:influence-agreeing influence)) (aref values 3))
               0.505))))
    (is (<= (discrepancy:explanation-probes explanation) 60))))

(test probes-are-few-and-the-same-every-time
  (let ((discrepancy (found-in-example 1)))
    (flet ((told (count)
             (discrepancy:explanation-text
              (discrepancy:explain-discrepancy discrepancy :max-runs count))))
      (is (string= (told 20) (told 20)))
      (is (= 3 (discrepancy:explanation-probes
                (discrepancy:explain-discrepancy discrepancy :max-runs 3))))
      (is (null (discrepancy:explanation-influences
                 (discrepancy:explain-discrepancy discrepancy :max-runs 0)))))))

(test explanations-keep-to-their-time
  (let ((explanation (discrepancy:explain-discrepancy (found-in-example 1) :max-seconds 0)))
    (is (zerop (discrepancy:explanation-probes explanation)))
    (is (null (discrepancy:explanation-edits explanation)))
    (is-true (discrepancy:explanation-grounds explanation))))

(test what-z3-does-for-explanations-is-metered
  (let ((meter (discrepancy::make-meter)) (checks 0))
    (let ((discrepancy (found-in-example 1)))
      (discrepancy::with-meter (meter)
        (discrepancy:explain-discrepancy discrepancy :max-runs 0)))
    (is (zerop (discrepancy::meter-simulations meter)))
    (is (plusp (discrepancy::meter-solver-seconds meter)))
    ;; Checks are counted in whatever context, and only where it was asked for.
    (flet ((ask (context)
             (z3:with-solver (solver context)
               (z3:check solver (list (z3:variable context "p"))))))
      (z3:with-context (one)
        (z3:with-context (other)
          (let ((z3:*on-check* (lambda (seconds)
                                 (is (typep seconds '(double-float 0d0)))
                                 (incf checks))))
            (ask one)
            (ask other)
            (ask other))
          (ask one))))
    (is (= 3 checks))))

(test runs-around-a-first-failure-refine-its-region
  "Where the search has seen nothing but the failure, what the further runs show is offered."
  (let* ((trace (example-trace))
         (domain (discrepancy:domain-with-parameters (two-regions) '(:reach 0.5)))
         (bad (run-of trace 0.5 0.5 0 1.9 0.4 0))
         (explanation (discrepancy:explain-discrepancy
                       (discrepancy-of domain bad trace :sample (discrepancy::run-sample bad))
                       :runs '()))
         (edit (first (discrepancy:explanation-edits explanation))))
    (is (eq :region (discrepancy:edit-kind edit)))
    ;; The arm reaches from 1.2 m to 1.8 m; that the other end of the region is out of its reach
    ;; was tried, too.
    (let ((range (first (discrepancy:edit-ranges edit))))
      (is (eq :x (discrepancy::coordinate-range-axis range)))
      (is (< 1.2 (discrepancy::coordinate-range-min range) 1.5
             (discrepancy::coordinate-range-max range) 1.81)))
    (is-true (discrepancy:edit-removes-p edit))
    (is (zerop (discrepancy:edit-contradicted edit)))
    (destructuring-bind (agreeing number agreeing-outside outside)
        (discrepancy:edit-support edit)
      (is (plusp number))
      (is (= agreeing number))
      (is (< agreeing-outside outside))
      (is (<= (+ number outside) (discrepancy:edit-runs edit))))))

(test the-nearest-run-that-agrees-is-where-to-begin
  "From a run that agrees and differs in all coordinates, those that do not matter are left out."
  (let* ((trace (example-trace))
         (bad (run-of trace 0.5 0.3 0 1.95 0.4 1))
         (good (run-of trace 0.5 0.7 0.01 1.6 0.39 0))
         (domain (discrepancy:domain-with-parameters (two-regions) '(:reach 0.5)))
         (discrepancy (discrepancy-of domain bad trace :sample (discrepancy::run-sample bad)))
         (explanation (discrepancy:explain-discrepancy discrepancy :runs (list good)
                                                                   :max-runs 40))
         (influence (first (discrepancy:explanation-influences explanation))))
    (is (equal '("box.x") (mapcar #'discrepancy:parameter-name
                                  (discrepancy:influence-parameters influence))))
    (is (< 1.6 (first (discrepancy:influence-agreeing influence))
           (first (discrepancy:influence-failing influence)) 1.95))
    (is (search "Of the 2 runs of this trace 1 agrees"
                (discrepancy:explanation-text explanation)))))

(test a-smallest-change-of-several-coordinates
  "Two coordinates that have to change together, among five."
  (let ((prober (make-instance 'discrepancy::prober :left 100 :deadline nil :context nil
                                                    :discrepancy nil))
        (probes 0))
    (flet ((agrees-p (numbers) (incf probes) (subsetp '(1 4) numbers)))
      (let ((numbers '(0 1 2 3 4)))
        ;; what was tried stands in the table of the prober
        (loop for mask below 32
              for subset = (loop for number in numbers
                                 when (logbitp number mask) collect number)
              for values = (map 'vector (lambda (number) (if (member number subset) 1d0 0d0))
                                numbers)
              do (setf (gethash values (discrepancy::prober-known prober))
                       (if (agrees-p subset) :agrees :fails)))
        (setf (slot-value prober 'discrepancy::discrepancy)
              (discrepancy::make-discrepancy
               :sample (discrepancy::make-sample 0 '() (make-array 5 :initial-element 0d0))))
        (is (equal '(1 4) (discrepancy::smallest-change
                           prober numbers (make-array 5 :initial-element 1d0))))))
    (is (= 32 probes))))

;;; JSON

(test explanations-as-json-say-what-the-text-says
  (let* ((explanation (discrepancy:explain-discrepancy (found-in-example 1) :max-runs 20))
         (object (json:parse (json:encode (discrepancy:explanation-json explanation))))
         (text (discrepancy:explanation-text explanation)))
    (is (= 2 (json:get-key object "step")))
    (is (string= "outcome" (json:get-key object "kind")))
    (is (plusp (length (json:get-key object "coordinates"))))
    (loop for coordinate across (json:get-key object "coordinates")
          do (is (search (json:get-key coordinate "text") text)))
    (loop for claim across (json:get-key object "claims")
          do (loop for reason across (json:get-key claim "reasons")
                   do (is (search reason text))))
    (loop for edit across (json:get-key object "edits")
          do (is (search (json:get-key edit "text") text)))))
