;;;; Judgements by both comparisons, and theory and simulation side by side.
;;;;
;;;; The theory of Example 1 gets a box that may end up anywhere when it is put down, so that it
;;;; allows more than one final state; runs are real ones with observations changed by hand.

(in-package #:discrepancy-finder.tests)

(def-suite judgement :in all)
(in-suite judgement)

(defun domain-with-theory (domain theory)
  "Return a domain like DOMAIN, with THEORY."
  (make-instance 'discrepancy:domain
                 :name (symbolic:action-theory-name domain) :theory theory
                 :actions (symbolic:action-theory-actions domain)
                 :scene (discrepancy:domain-scene domain)
                 :regions (discrepancy:domain-regions domain)
                 :observers (discrepancy::domain-observers domain)))

(defun domain-of-a-loose-box ()
  (domain-with-theory
   (two-regions)
   (ec:revised-theory (symbolic:action-theory-theory (two-regions))
                      :with '((put-down-anywhere
                               (releases (put-down ?region1) (box-in ?region2) ?time))))))

(defparameter *box-delivered*
  '(and (exists (?region) (happens (put-down ?region) ?time)) (holds-at (box-in r1) (+ ?time 1))))

(defun trace-of-a-loose-box (domain)
  (first (symbolic:exploration-traces
          (df:explore-plan 'discrepancy-finder-user::move-the-box :domain domain
                                                                  :constraint *box-delivered*))))

(defun changed-state (state changes)
  "Return STATE, a list of (atom . truth), with CHANGES."
  (loop for (atom . truth) in state
        for change = (assoc atom changes :test #'equal)
        collect (if change change (cons atom truth))))

(defun changed-run (run number &rest changes)
  "Return RUN with CHANGES, a list of (atom . truth), to what was observed after step NUMBER."
  (discrepancy::make-run
   :initial-state (discrepancy:run-initial-state run)
   :steps (loop for step in (discrepancy:run-steps run)
                for count from 0
                collect (discrepancy::make-run-step
                         :designator (discrepancy:run-step-designator step)
                         :outcome (discrepancy:run-step-outcome step)
                         :candidates (discrepancy::run-step-candidates step)
                         :state (if (= count number)
                                    (changed-state (discrepancy:run-step-state step) changes)
                                    (discrepancy:run-step-state step))))))

(defun verdict-steps-of (domain run trace &rest options)
  "Return the verdict on RUN, the step of its divergence and the fluents in it."
  (let* ((judgement (apply #'discrepancy:judge-run domain run trace options))
         (divergence (discrepancy:judgement-divergence judgement)))
    (list* (discrepancy:judgement-verdict judgement)
           (and divergence
                (list (discrepancy:divergence-step divergence)
                      (discrepancy:divergence-fluents divergence))))))

(test exact-judgement-asks-for-the-states-of-the-trace
  (let* ((domain (domain-of-a-loose-box))
         (trace (trace-of-a-loose-box domain))
         (run (run-of trace 0.8 0.5 0 1.5 0.4 0))
         (elsewhere (changed-run run 3 '((:box-in :r1)) '((:box-in :r2) . t))))
    (is (equal '(:consistent) (verdict-steps-of domain run trace)))
    (is (equal '(:consistent) (verdict-steps-of domain run trace :comparison :exact)))
    (is (equal '(:consistent) (verdict-steps-of domain elsewhere trace))
        "the theory lets the box end up in r2")
    (is (equal '(:discrepancy 3 (((:box-in :r1) t nil) ((:box-in :r2) nil t)))
               (verdict-steps-of domain elsewhere trace :comparison :exact)))
    (is (equal '(:discrepancy 3 (((:box-in :r1) t nil) ((:box-in :r2) nil t)))
               (verdict-steps-of (two-regions) elsewhere trace))
        "the original theory does not")
    (is (eq :exact (discrepancy:judgement-comparison
                    (discrepancy:judge-run domain run trace :comparison :exact))))))

(test exact-judgement-of-what-heals
  "A difference in the middle counts only with :every-step."
  (let* ((trace (example-trace))
         (run (changed-run (run-of trace 0.8 0.5 0 1.5 0.4 0) 1 '((:holding-box)))))
    (is (equal '(:consistent 1 (((:holding-box) t nil)))
               (verdict-steps-of (two-regions) run trace :comparison :exact)))
    (is (equal '(:discrepancy 1 (((:holding-box) t nil)))
               (verdict-steps-of (two-regions) run trace
                                 :comparison :exact :compare :every-step)))))

(test a-run-beyond-its-trace-is-judged-exactly-only-along-it
  (let* ((trace (example-trace))
         (short (symbolic:make-execution-trace
                 :plan (symbolic:trace-plan trace)
                 :steps (subseq (symbolic:trace-steps trace) 0 2)
                 :states (subseq (symbolic:trace-states trace) 0 3)))
         (run (run-of trace 0.8 0.5 0 1.5 0.4 0))
         (lost (changed-run run 1 '((:holding-box)))))
    (is (equal '(:consistent) (verdict-steps-of (two-regions) run short :comparison :exact)))
    (is (equal '(:discrepancy 1 (((:holding-box) t nil)))
               (verdict-steps-of (two-regions) lost short :comparison :exact))
        "the state after the trace's last step is the one to compare")
    (is (equal '(:consistent 1 (((:holding-box) t nil)))
               (verdict-steps-of (two-regions) lost short))
        "the run's last state is as the theory says")))

(test what-is-impossible-only-together
  "The theory allows the box in r1 and in r2, but not nowhere: both fluents are named."
  (let* ((domain (domain-of-a-loose-box))
         (trace (trace-of-a-loose-box domain))
         (run (changed-run (run-of trace 0.8 0.5 0 1.5 0.4 0) 3 '((:box-in :r1)) '((:box-in :r2)))))
    (is (equal '(:discrepancy 3 (((:box-in :r1) t nil) ((:box-in :r2) t nil)))
               (verdict-steps-of domain run trace)))))

(test an-exact-judgement-of-another-outcome
  "An outcome that the theory forbids is a discrepancy by either comparison."
  (let* ((trace (example-trace))
         (bad (run-of trace 0.5 0.5 0 1.9 0.4 0)))
    (dolist (comparison '(:consistent :exact))
      (is (equal '(:discrepancy 1 (((:holding-box) t nil)))
                 (verdict-steps-of (two-regions) bad trace :comparison comparison))))))

(test comparisons-of-all-steps
  (let* ((domain (domain-of-a-loose-box))
         (trace (trace-of-a-loose-box domain))
         (run (run-of trace 0.8 0.5 0 1.5 0.4 0)))
    (flet ((verdicts-of (run &rest options)
             (mapcar #'discrepancy:step-comparison-verdict
                     (apply #'discrepancy:step-comparisons domain run trace options)))
           (theory-after (number atom)
             (cdr (assoc atom (discrepancy:step-comparison-theory
                               (nth number (discrepancy:step-comparisons domain run trace)))
                         :test #'equal))))
      (is (equal '(:agrees :agrees :agrees :agrees) (verdicts-of run)))
      (is (eq t (theory-after 2 '(:box-in :r1))))
      (is (eq nil (theory-after 2 '(:box-in :r2))))
      (is (eq :open (theory-after 3 '(:box-in :r1))))
      (is (eq nil (theory-after 3 '(:holding-box))))
      (let ((lost (changed-run run 1 '((:holding-box)))))
        (is (equal '(:agrees :state-forbidden :agrees :agrees) (verdicts-of lost)))
        (is (equal '(((:holding-box) t nil))
                   (discrepancy:step-comparison-fluents
                    (second (discrepancy:step-comparisons domain lost trace)))))))
    (let ((comparisons (discrepancy:step-comparisons
                        (two-regions) (run-of trace 0.5 0.5 0 1.9 0.4 0) trace)))
      (is (equal '(:agrees :outcome-forbidden)
                 (mapcar #'discrepancy:step-comparison-verdict comparisons)))
      (is (equal '(0 1) (mapcar #'discrepancy:step-comparison-number comparisons))))))

(test nothing-is-judged-after-a-forbidden-outcome
  (let* ((trace (example-trace))
         (good (run-of trace 0.8 0.5 0 1.5 0.4 0))
         (bad (run-of trace 0.5 0.5 0 1.9 0.4 0))
         (both (discrepancy::make-run
                :initial-state (discrepancy:run-initial-state bad)
                :steps (append (discrepancy:run-steps bad) (last (discrepancy:run-steps good))))))
    (is (equal '(:agrees :outcome-forbidden :not-judged)
               (mapcar #'discrepancy:step-comparison-verdict
                       (discrepancy:step-comparisons (two-regions) both trace))))))

(test what-the-theory-cannot-tell-apart-is-judged-once
  (let* ((trace (example-trace))
         (run (run-of trace 0.8 0.5 0 1.5 0.4 0))
         (beside (run-of trace 0.8 0.51 0.01 1.52 0.4 0))
         (dropped (changed-run run 2 '((:holding-box))))
         (memory (discrepancy::make-memory)))
    (z3:with-context (context)
      (flet ((judged (run &rest options)
               "The judgement on RUN, and whether Z3 was asked."
               (let ((before (z3:check-count context)))
                 (list (apply #'verdict-steps-of (two-regions) run trace
                              :context context :memory memory options)
                       (< before (z3:check-count context))))))
        (is (equal '((:consistent) t) (judged run)))
        (is (equal '((:consistent) nil) (judged run)))
        (is (equal '((:consistent) nil) (judged beside)))
        ;; Seen by another comparison, or something else seen, is another question.
        (is (equal '((:consistent) t) (judged beside :comparison :exact)))
        (is (equal '((:consistent 2 (((:holding-box) t nil))) t) (judged dropped)))
        (is (equal '((:discrepancy 2 (((:holding-box) t nil))) nil)
                   (judged dropped :compare :every-step)))))))
