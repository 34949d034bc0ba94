;;;; Candidate edits: what is proposed for known discrepancies, and what their checks come to.

(in-package #:discrepancy-finder.tests)

(def-suite edits :in all)
(in-suite edits)

;;; The parts

(test a-revised-theory-is-a-new-one
  (let* ((theory (symbolic:action-theory-theory (two-regions)))
         (count (length (ec:theory-axioms theory)))
         (revised (ec:revised-theory
                   theory :without '(:move-leaves :pick-up-holds)
                          :with '((:pick-up-holds
                                   (:terminates (:pick-up) (:holding-box) :?time))
                                  (:new (:initiates (:pick-up) (:holding-box) :?time))))))
    (flet ((formula (name theory)
             (let ((axiom (find name (ec:theory-axioms theory) :key #'ec:axiom-name)))
               (and axiom (ec:axiom-formula axiom)))))
      (is (= count (length (ec:theory-axioms theory))))
      (is (= count (length (ec:theory-axioms revised))))
      (is (null (formula :move-leaves revised)))
      (is (equal '(:terminates (:pick-up) (:holding-box) :?time) (formula :pick-up-holds revised)))
      (is (equal '(:initiates (:pick-up) (:holding-box) :?time) (formula :pick-up-holds theory)))
      (is (formula :new revised))
      (is (eq revised (ec:state-constraint-theory
                       (ec:find-state-constraint :box-delivered revised))))
      (is (not (eq revised (ec:find-theory :two-regions))))
      (is (equal '(:put-down-releases)
                 (mapcar #'ec:axiom-name
                         (ec:effect-axioms theory :terminates :put-down :holding-box))))
      (is (equal '(:pick-up-needs-empty-hand :pick-up-needs-box-here)
                 (mapcar #'ec:axiom-name (ec:event-axioms theory :pick-up)))))
    (signals ec:theory-error
      (ec:revised-theory theory :with '((:wrong (:initiates (:fly) (:holding-box) :?time)))))))

(defun revised-conditions (mode)
  "Return the conditions of success and failure of a binding whose requirement is revised by MODE."
  (mapcar #'third
          (symbolic::revised-outcomes
           '((:success (:put-down :r1) (:holding-box) ()) (broken nil (:not (:holding-box)) ())
             (lost nil nil ()))
           '(:put-down :?region) '(:robot-in :?region) '(lost) mode)))

(test revised-requirements
  (is (equal '((:and (:holding-box) (:robot-in :r1)) (:not (:holding-box)) (:not (:robot-in :r1)))
             (revised-conditions :also)))
  (is (equal '((:robot-in :r1) (:not (:holding-box)) (:not (:robot-in :r1)))
             (revised-conditions :instead)))
  (is (equal '((:holding-box) (:not (:holding-box)) t) (revised-conditions :may-fail)))
  (is (equal '((:holding-box) (:not (:holding-box)) (:not (:robot-in :r1)))
             (revised-conditions :unless)))
  (is (equal '(lost nil (:not (:robot-in :r1)) ())
             (third (symbolic::revised-outcomes
                     '((:success (:put-down :r1) t ()) (broken nil nil ()))
                     '(:put-down :?region) '(:robot-in :?region) '(lost) :also)))))

(test truth-in-observed-states
  (let ((theory (symbolic:action-theory-theory (two-regions)))
        (table (discrepancy::state-table '(((:robot-in :r1) . t) ((:robot-in :r2) . nil)
                                           ((:box-in :r1) . nil)))))
    (flet ((truth (formula &rest bindings)
             (discrepancy::formula-truth theory formula table bindings)))
      (is (eq t (truth '(:robot-in :?region) '(:?region . :r1))))
      (is (eq nil (truth '(:robot-in :?region) '(:?region . :r2))))
      (is (eq :unknown (truth '(:holding-box))))
      (is (eq t (truth '(:not (:box-in :r1)))))
      (is (eq nil (truth '(:and (:box-in :r1) (:holding-box)))))
      (is (eq :unknown (truth '(:and (:robot-in :r1) (:holding-box)))))
      (is (eq t (truth '(:or (:robot-in :r1) (:holding-box)))))
      (is (eq t (truth '(:exists (:?region) (:robot-in :?region)))))
      (is (eq :unknown (truth '(:exists (:?region) (:box-in :?region)))))
      (is (eq nil (truth '(:exists (:?region) (:and (:robot-in :?region) (:box-in :?region))))))
      (is (eq t (truth '(:/= :?region1 :?region2) '(:?region1 . :r1) '(:?region2 . :r2)))))))

(defun row-of (&rest true)
  (discrepancy::make-row
   (discrepancy::state-table
    (loop for atom in '((:robot-in :r1) (:robot-in :r2) (:box-in :r1) (:box-in :r2) (:holding-box))
          collect (cons atom (and (member atom true :test #'equal) t))))
   '()))

(test the-shortest-conditions
  (let* ((domain (two-regions))
         (literals (discrepancy::condition-literals domain '()))
         (here (row-of '(:robot-in :r1) '(:box-in :r1)))
         (there (row-of '(:robot-in :r1) '(:box-in :r2)))
         (held (row-of '(:robot-in :r1) '(:box-in :r1) '(:holding-box))))
    (is (equal '(()) (discrepancy::best-conditions domain literals (list here) '())))
    (is (equal '(((:not (:holding-box))))
               (discrepancy::best-conditions domain literals (list here there) (list held))))
    (is (equal '(((:exists (:?region) (:and (:robot-in :?region) (:box-in :?region)))
                  (:not (:holding-box))))
               (mapcar (lambda (condition) (sort (copy-list condition) #'string<
                                                 :key #'prin1-to-string))
                       (discrepancy::best-conditions domain literals (list here)
                                                     (list there held)))))
    (is (null (discrepancy::best-conditions domain literals (list here) (list here))))
    (is (null (discrepancy::best-conditions domain literals (list here) (list held)
                                            :acceptable (constantly nil))))))

;;; Example 1 with an arm that reaches half a metre: the box is sometimes too far away.

(defun runs-with-short-arm (trace)
  "Return runs of TRACE in which the box is picked up, and one in which it is not."
  (values (loop for x in '(1.4 1.5 1.6) collect (run-of trace 0.5 0.5 0 x 0.4 0))
          (run-of trace 0.5 0.5 0 1.9 0.4 0)))

(defun short-arm-discrepancy (trace run)
  (discrepancy::make-discrepancy
   :plan (discrepancy:ensure-plan 'discrepancy-finder-user::move-the-box) :domain (two-regions)
   :trace trace :run run :judgement (discrepancy:judge-run (two-regions) run trace)))

(test what-sometimes-fails-may-fail
  (let ((trace (example-trace)))
    (multiple-value-bind (passing failing) (runs-with-short-arm trace)
      (let* ((edits (discrepancy:candidate-edits (short-arm-discrepancy trace failing)
                                                 :runs (rest passing)))
             (edit (first edits))
             (edited (discrepancy:edited-domain (two-regions) edit)))
        (is (eq :may-fail (discrepancy:edit-kind edit)))
        (is (search "picking-up" (discrepancy:edit-text edit)))
        (is (search "manipulation-pose-unreachable at any time" (discrepancy:edit-text edit)))
        (is (equal "this removes the discrepancy and contradicts none of the 3 runs"
                   (discrepancy::edit-verdict-text edit)))
        ;; The same discrete state passes and fails: no precondition tells them apart.
        (is (notany (lambda (edit)
                      (and (eq :requirement (discrepancy:edit-kind edit))
                           (discrepancy:edit-removes-p edit)
                           (zerop (discrepancy:edit-contradicted edit))))
                    edits))
        (dolist (run (cons failing passing))
          (z3:with-context (context)
            (is (null (discrepancy::first-divergence edited run context)))))
        (is (null (discrepancy:candidate-edits
                   (short-arm-discrepancy trace (first passing)))))))))

(test runs-of-other-traces-check-edits-too
  (let ((trace (example-trace)))
    (multiple-value-bind (passing failing) (runs-with-short-arm trace)
      (let ((discrepancy (discrepancy-of (two-regions) failing trace
                                         :sample (discrepancy::run-sample failing))))
        (setf (discrepancy:discrepancy-other-runs discrepancy)
              (loop for run in passing collect (cons run (discrepancy:judge-run (two-regions) run
                                                                                trace))))
        (is (= 4 (discrepancy:edit-runs (first (discrepancy:candidate-edits discrepancy)))))
        (is (search "candidate edits, checked against 3 runs of other traces, too"
                    (discrepancy:explanation-text
                     (discrepancy:explain-discrepancy discrepancy :max-runs 0))))))))

(test regions-are-not-refined-by-runs-from-other-regions
  "Where the box begins in the other region it is not its coordinate that matters."
  (let* ((trace (example-trace))
         (domain (discrepancy:domain-with-parameters (two-regions) '(:reach 0.5)))
         (far (run-of trace 0.5 0.5 0 1.9 0.4 0))
         (near (run-of trace 0.5 0.5 0 1.5 0.4 0))
         (divergence (discrepancy:judgement-divergence
                      (discrepancy:judge-run domain far trace))))
    (flet ((edits (near)
             (z3:with-context (context)
               (let ((runs (append (make-list 20 :initial-element far)
                                   (make-list 20 :initial-element near))))
                 (discrepancy::region-edits
                  domain (nth 1 (discrepancy::run-transitions domain far)) divergence far runs
                  (loop for run in runs collect (discrepancy::agreement domain run context)))))))
      (is-true (edits near))
      (let ((elsewhere (copy-structure near)))
        ;; Something that the theory does not know of was otherwise.
        (setf (slot-value elsewhere 'discrepancy::initial-state)
              (append (discrepancy:run-initial-state near) '(((:elsewhere) . t))))
        (is (null (edits elsewhere)))))))

(test edits-are-offered-as-far-as-they-are-checked
  (let ((trace (example-trace)))
    (multiple-value-bind (passing failing) (runs-with-short-arm trace)
      (flet ((edits (seconds)
               (mapcar #'discrepancy:edit-text
                       (discrepancy:candidate-edits (short-arm-discrepancy trace failing)
                                                    :runs passing :max-seconds seconds)))
             (checked (deadline)
               (z3:with-context (context)
                 (discrepancy::agreements (two-regions) passing context
                                          (discrepancy::make-memory) deadline))))
        (is (null (edits 0)))
        (is (= 3 (length (checked nil))))
        (is (null (checked (- (foreign:monotonic-seconds) 1))))
        (is-true (edits nil))
        (is (equal (edits nil) (edits 600)))))))

(test a-wrong-edit-is-contradicted
  (let ((trace (example-trace)) (domain (two-regions)))
    (multiple-value-bind (passing failing) (runs-with-short-arm trace)
      (let ((runs (cons failing passing)))
        (flet ((checked (&rest parts)
                 (z3:with-context (context)
                   (discrepancy::checked-edit
                    domain parts
                    (second (discrepancy::run-transitions domain failing)) failing runs
                    (loop for run in runs
                          collect (discrepancy::agreement domain run context))
                    context))))
          (let ((drops (checked :effect
                                '((:drops (:terminates (:move :?region) (:holding-box) :?time)))
                                '())))
            (is (not (discrepancy:edit-removes-p drops)))
            (is (= 3 (discrepancy:edit-contradicted drops)))
            (is (= 4 (discrepancy:edit-runs drops))))
          (is (null (checked :effect '((:x (:terminates (:fly) (:holding-box) :?time))) '()))
              "there is no such event")
          (is (= 4 (discrepancy:edit-contradicted
                    (checked :weaken '() '(:move-arrives))))))))))

(test a-wrong-effect-is-narrowed-or-removed
  (let* ((trace (example-trace))
         (domain (domain-with-theory
                  (two-regions)
                  (ec:revised-theory (symbolic:action-theory-theory (two-regions))
                                     :with '((:move-drops
                                              (:terminates (:move :?region) (:holding-box)
                                               :?time))))))
         (run (run-of trace 0.8 0.5 0 1.5 0.4 0))
         (edits (z3:with-context (context)
                  (discrepancy::edits-for-run domain run (list run) context)))
         (edit (first edits)))
    (is (eq :weaken (discrepancy:edit-kind edit)))
    (is (equal '(:move-drops) (discrepancy:edit-replaced edit)))
    (is (equal "remove the axiom move-drops from the theory" (discrepancy:edit-text edit)))
    (is (discrepancy:edit-removes-p edit))
    (is (zerop (discrepancy:edit-contradicted edit)))))

;;; Regions

(test ranges-around-numbers
  (is (equal '(1.5 3.5 0.5) (discrepancy::range-around '(2 3) '(0 1.0 4.0) 0 10)))
  (is (equal '(1.5 10 0.5) (discrepancy::range-around '(2 3) '(1.0) 0 10)))
  (is (null (discrepancy::range-around '(2 4) '(3) 0 10)))
  (is (null (discrepancy::range-around '(2 4) '() 0 10))))

(test separation-by-chance
  ;; One coordinate, two runs that agree and two others: in 4 of the 6 orders the ones or the others
  ;; stand together; the bound counts two of these twice.
  (is (= 1d0 (discrepancy::separation-chance 1 2 2)))
  (is (< 0.09 (discrepancy::separation-chance 2 5 5) 0.1))
  (is (< (discrepancy::separation-chance 5 20 10) 1d-5)))

(test a-region-is-refined-where-a-coordinate-separates
  (let* ((trace (example-trace))
         (domain (discrepancy:domain-with-parameters (two-regions) '(:reach 0.5)))
         (passing (loop for x in '(1.25 1.4 1.45 1.5 1.6 1.75)
                        for y in '(0.4 0.39 0.402 0.41 0.385 0.4)
                        collect (run-of trace 0.5 0.5 0 x y 0.3)))
         (failing (loop for x in '(1.1 1.12 1.15 1.85 1.9 1.95)
                        for y in '(0.4 0.395 0.39 0.4 0.405 0.41)
                        collect (run-of trace 0.5 0.5 0 x y 0.3)))
         (few (discrepancy:candidate-edits (short-arm-discrepancy trace (first failing))
                                           :runs passing))
         (edits (discrepancy:candidate-edits
                 (short-arm-discrepancy trace (first failing)) :runs (append passing failing)))
         (edit (first edits))
         (range (first (discrepancy:edit-ranges edit))))
    (is (eq :region (discrepancy:edit-kind edit)))
    (is (discrepancy:edit-removes-p edit))
    (is (zerop (discrepancy:edit-contradicted edit)))
    (is (= 12 (discrepancy:edit-runs edit)))
    (is (notany #'discrepancy:edit-ranges few) "one failure tells little of where")
    (is (equal '(:box-x-in-range) (discrepancy::coordinate-range-atom range)))
    (is (< 1.15 (discrepancy::coordinate-range-min range) 1.25))
    (is (< 1.75 (discrepancy::coordinate-range-max range) 1.85))
    (is (search "(:coordinate (box-x-in-range) :body box :axis x :range (1.2000 1.8000))"
                (discrepancy:edit-text edit)))
    ;; The refined domain has traces of both kinds, and samples of each.
    (let* ((edited (discrepancy:edited-domain domain edit))
           (theory (symbolic:action-theory-theory edited)))
      (is (assoc :box-x-in-range (ec:theory-fluents theory)))
      (is (null (assoc :box-x-in-range
                       (ec:theory-fluents (symbolic:action-theory-theory domain)))))
      (let ((result (df:find-discrepancies 'discrepancy-finder-user::move-the-box
                                           :domain edited :constraint :any-action
                                           :traces :every-state :budget 12)))
        (is (find t (discrepancy:result-traces result)
                  :key (lambda (trace-result)
                         (ec:fluent-value
                          (symbolic:trace-initial-state
                           (discrepancy:trace-result-trace trace-result))
                          '(:box-x-in-range)))))
        (is (notany (lambda (discrepancy)
                      (= 1 (discrepancy:divergence-step
                            (discrepancy:judgement-divergence
                             (discrepancy:discrepancy-judgement discrepancy)))))
                    (discrepancy:result-discrepancies result)))))))

(defun coordinate-of-the-box (run axis)
  "Return the parameter of the sample of RUN that is the coordinate AXIS of the box."
  (find-if (lambda (parameter)
             (and (eq :box (discrepancy::parameter-body parameter))
                  (eq axis (discrepancy::parameter-axis parameter))))
           (discrepancy:sample-parameters (discrepancy::run-sample run))))

(test what-decides-by-experiment-refines-a-region
  "Few runs are separated by some coordinate anyhow, but if one was changed alone it decides."
  (let* ((trace (example-trace))
         (failing (run-of trace 0.5 0.5 0 1.9 0.4 0))
         (passing (list (run-of trace 0.5 0.5 0 1.6 0.4 0))))
    (flet ((edits (&optional (deciding (list (cons (coordinate-of-the-box failing :x) 1.6d0))))
             (discrepancy:candidate-edits (short-arm-discrepancy trace failing)
                                          :runs passing :deciding deciding)))
      (is (notany #'discrepancy:edit-ranges (edits '())))
      (is (notany #'discrepancy:edit-ranges
                  (edits (list (cons (coordinate-of-the-box failing :y) 0.4d0)))))
      (let ((edit (first (edits))))
        (is (eq :region (discrepancy:edit-kind edit)))
        (is (equal '(1 1 0 1) (discrepancy:edit-support edit)))
        (is (search "box :axis x :range (1.0000 1.7500)" (discrepancy:edit-text edit)))
        (is (equal (format nil "this removes the discrepancy and contradicts none of the 2 runs; ~
                                in the range 1 of 1 run agrees, outside 0 of 1")
                   (discrepancy::edit-verdict-text edit)))))))

(test outside-of-what-is-safe-it-may-fail
  "How far the box may be away in one direction depends on the other."
  (let* ((trace (example-trace))
         (failing (run-of trace 0.5 0.5 0 1.79 0.41 0))
         (passing (loop for (x y) in '((1.8 0.39) (1.6 0.41) (1.5 0.4) (1.4 0.41))
                        collect (run-of trace 0.5 0.5 0 x y 0)))
         (edits (discrepancy:candidate-edits
                 (short-arm-discrepancy trace failing)
                 :runs passing
                 :deciding (list (cons (coordinate-of-the-box failing :x) 1.6d0))))
         (edit (first edits)))
    (is (eq :region (discrepancy:edit-kind edit)))
    (is (null (discrepancy:edit-sentences edit)) "success is possible everywhere")
    (is (search "box :axis x :range (1.0000 1.6950)" (discrepancy:edit-text edit)))
    (is (search "unless (box-x-in-range)" (discrepancy:edit-text edit)))
    (is (discrepancy:edit-removes-p edit))
    (is (zerop (discrepancy:edit-contradicted edit)))
    (is (equal '(3 3 1 2) (discrepancy:edit-support edit)))
    (is (eq :may-fail (discrepancy:edit-kind (second edits))))
    ;; Inside of the range the refined theory says that it succeeds.
    (let ((edited (discrepancy:edited-domain (two-regions) edit)))
      (z3:with-context (context)
        (is (null (discrepancy::first-divergence edited failing context)))
        (let ((moved (copy-structure failing)))
          (setf (slot-value moved 'discrepancy::sample)
                (discrepancy::run-sample (second passing)))
          (is-true (discrepancy::first-divergence edited moved context)))))))

(test a-fluent-may-depend-on-one-coordinate
  (ec:register-theory (ec:revised-theory
                       (symbolic:action-theory-theory (two-regions))
                       :fluents '((:robot-far-left))))
  (flet ((domain (&rest clause)
           (discrepancy::parse-abstraction
            :two-regions-left `((:extends :two-regions) (:theory :two-regions) ,clause))))
    (unwind-protect
         (let ((domain (domain :coordinate '(robot-far-left) :body 'robot :axis 'x
                                                             :range '(0 0.3))))
           (flet ((far-left-p (x)
                    (and (member '(:robot-far-left)
                                 (discrepancy:observed-fluents
                                  (discrepancy:run-initial-state
                                   (discrepancy:run-plan 'discrepancy-finder-user::move-the-box
                                                         :domain domain
                                                         :state `((robot :x ,x)))))
                                 :test #'equal)
                         t)))
             (is (eq t (far-left-p 0.25)))
             (is (eq nil (far-left-p 0.35))))
           (signals-with (discrepancy:abstraction-error ":axis is needed")
             (domain :coordinate '(robot-far-left) :body 'robot :axis 'w :range '(0 1)))
           (signals-with (discrepancy:abstraction-error "no item cup")
             (domain :coordinate '(robot-far-left) :body 'cup :axis 'x :range '(0 1)))
           (signals-with (discrepancy:abstraction-error "range (min max)")
             (domain :coordinate '(robot-far-left) :body 'robot :axis 'x :range '(1 0))))
      (ec:register-theory (symbolic:action-theory-theory (two-regions))))))
