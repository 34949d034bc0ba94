;;;; Tests of the domain table-top: the plan of the paper's Figure 1 in both executions.

(in-package #:discrepancy-finder.tests)

(def-suite table-top :in all)
(in-suite table-top)

(defparameter *find-object* 'discrepancy-finder-user::find-object)

(defun outcomes-of (run)
  (loop for step in (discrepancy:run-steps run)
        collect (list (plan:desig-prop-value (discrepancy:run-step-designator step) :type)
                      (discrepancy:run-step-outcome step))))

(defun find-object-from (state &rest options)
  (apply #'df:run-plan *find-object* :domain :table-top :state state options))

(test figure-1-runs-concretely
  (let ((run (find-object-from '())))
    (is (eq :finished (discrepancy:run-ending run)))
    (is (equal '((:going :success) (:looking :success) (:detecting :success)) (outcomes-of run))))
  (let ((run (find-object-from '((cereal :x 1.5)))))
    (is (eq :finished (discrepancy:run-ending run)))
    (is (equal '((:going :success) (:looking :success)
                 (:detecting plan:perception-object-not-found)
                 (:going :success) (:looking :success) (:detecting :success))
               (outcomes-of run)))
    (is (search "0.0 % of cereal"
                (discrepancy:run-step-failure (third (discrepancy:run-steps run))))))
  (let ((run (find-object-from '((cereal :x 1.5)) :arguments '(:cup))))
    (is (eq :finished (discrepancy:run-ending run)))
    (is (= 3 (length (discrepancy:run-steps run)))))
  (let ((run (find-object-from '() :parameters '(:camera-range 0.2))))
    (is (eq 'plan:perception-object-not-found (discrepancy:run-ending run)))
    (is (= 6 (length (discrepancy:run-steps run))) "it gives up after both sides"))
  (let ((run (find-object-from '((cereal :x 0.4 :y 0.75) (cup :x 0.4 :y 0.85)) :arguments '(:cup))))
    (is (eq 'plan:perception-object-not-found (discrepancy:run-ending run))
        "the cereal hides the cup")))

(defun find-object-traces ()
  (symbolic:exploration-traces (df:explore-plan *find-object* :domain :table-top)))

(test figure-1-runs-symbolically
  (let ((exploration (df:explore-plan *find-object* :domain :table-top)))
    (is-true (df:exploration-complete-p exploration))
    (is (equal '(((:cereal-on :left) ((:go :left) (:look :left) (:detect :cereal)))
                 ((:cereal-on :right) ((:go :left) (:look :left) nil
                                       (:go :right) (:look :right) (:detect :cereal))))
               (loop for trace in (df:exploration-traces exploration)
                     collect (list (find :cereal-on (ec:state-fluents
                                                     (symbolic:trace-initial-state trace))
                                         :key #'first)
                                   (mapcar #'symbolic:step-event
                                           (symbolic:trace-steps trace))))))))

(defun verdicts (trace count &rest parameters)
  "Return the verdicts on COUNT samples of TRACE, and the failures of the discrepant runs."
  (let ((domain (discrepancy:domain-with-parameters (discrepancy:ensure-domain :table-top)
                                                    parameters))
        (failures '()))
    (values
     (loop for index below count
           for sample = (discrepancy:draw-sample (discrepancy:initial-parameters domain trace)
                                                 1 7 index)
           for run = (discrepancy:execute-sample domain *find-object* sample :trace trace)
           for verdict = (discrepancy:judgement-verdict (discrepancy:judge-run domain run trace))
           do (is (eq :valid (discrepancy:run-validity run)))
              (when (eq verdict :discrepancy)
                (push (discrepancy:run-step-outcome (first (last (discrepancy:run-steps run))))
                      failures))
           collect verdict)
     (remove-duplicates failures))))

(test theory-and-simulation-agree-with-a-camera-that-sees-one-side
  (dolist (trace (find-object-traces))
    (is (equal '(:consistent) (remove-duplicates (verdicts trace 40))))))

(test a-narrow-camera-sees-less-than-the-theory
  (multiple-value-bind (verdicts outcomes)
      (verdicts (first (find-object-traces)) 40 :camera-field-of-view 0.9)
    (is (member :discrepancy verdicts))
    (is (equal '(plan:perception-object-not-found) outcomes))))

(test a-wide-camera-sees-more-than-the-theory
  (multiple-value-bind (verdicts outcomes)
      (verdicts (second (find-object-traces)) 40 :camera-field-of-view 2)
    (is (member :discrepancy verdicts))
    (is (equal '(:success) outcomes) "it sees the other side of the table")))

(test the-search-finds-what-a-narrow-camera-misses
  (let ((result (df:find-discrepancies *find-object* :domain :table-top :seed 1
                                       :parameters '(:camera-field-of-view 0.9))))
    (is (eq :discrepancy (df:result-status result)))
    (is (search "detecting" (df:result-text result)))))

(test a-find-keeps-what-was-seen-of-earlier-traces
  "With a wide camera the first trace agrees, and the second does not."
  (let* ((result (df:find-discrepancies *find-object* :domain :table-top :seed 1
                                        :parameters '(:camera-field-of-view 2)))
         (discrepancy (df:result-discrepancy result)))
    (is (= 2 (df:result-iterations result)))
    (is-true (discrepancy:discrepancy-other-runs discrepancy))
    (is (equal (discrepancy:trace-result-runs (first (discrepancy:result-traces result)))
               (discrepancy:discrepancy-other-runs discrepancy)))))
