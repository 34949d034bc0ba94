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
      (is (eq theory (ec:find-theory :two-regions)))
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
                                                 :runs passing))
             (edit (first edits))
             (edited (discrepancy:edited-domain (two-regions) edit)))
        (is (eq :may-fail (discrepancy:edit-kind edit)))
        (is (search "picking-up" (discrepancy:edit-text edit)))
        (is (search "manipulation-pose-unreachable at any time" (discrepancy:edit-text edit)))
        (is (equal "this removes the discrepancy and contradicts none of the 4 runs"
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
