;;;; Simulation without a trace: the whole state space, and when it ends.

(in-package #:discrepancy-finder.tests)

(def-suite blind-simulation :in all)
(in-suite blind-simulation)

(defun short-arm-domain ()
  "Return the domain of Example 1 with an arm that reaches 0.5 m."
  (discrepancy:domain-with-parameters (discrepancy:ensure-domain :two-regions) '(:reach 0.5d0)))

(test the-initial-states-are-those-of-the-theory
  (let ((states (discrepancy:allowed-initial-states (discrepancy:ensure-domain :kitchen))))
    (is (= 3 (length states)))
    (dolist (drawer '(:drawer-1 :drawer-2 :drawer-3))
      (is (= 1 (count-if (lambda (state)
                           (equal (discrepancy:observed-fluents state)
                                  `((:robot-at :start) (:on :bowl :workspace)
                                    (:on :cereal :workspace) (:on :milk :workspace)
                                    (:in :spoon ,drawer))))
                         states))))))

(test blind-samples-cover-the-whole-state-space
  "The abstraction draws the spoon in the middle of its drawer; a blind sample has it anywhere."
  (let* ((domain (discrepancy:ensure-domain :kitchen))
         (state (first (discrepancy:allowed-initial-states domain)))
         (parameters (discrepancy::whole-state-parameters domain state)))
    (flet ((range (name)
             (let ((parameter (find name parameters :key #'discrepancy:parameter-name
                                                    :test #'string=)))
               (list (discrepancy:parameter-min parameter)
                     (discrepancy:parameter-max parameter)))))
      (is (equal '(-0.85d0 -0.35d0) (range "spoon.y")))
      (is (equal (list (- pi) pi) (range "robot.yaw")))
      (is (equal '(-1d0 1d0) (range "bowl.y")))
      (is (equal '(0.8835d0 0.8835d0) (range "bowl.z")))
      (is (equal '(0d0 0d0) (range "drawer_1_joint")))
      (is (equal '(15d0 35d0) (range "grip-force"))))))

(test blind-simulation-finds-what-is-frequent
  "An arm of 0.5 m does not reach the box from everywhere: a random simulation meets that soon."
  (let* ((kind (discrepancy:discrepancy-kind
                (discrepancy:result-discrepancy
                 (discrepancy:find-discrepancies 'discrepancy-finder-user::move-the-box
                                                 :domain (short-arm-domain) :seed 1))))
         (result (discrepancy:simulate-blindly 'discrepancy-finder-user::move-the-box
                                               :domain (short-arm-domain) :kinds (list kind)
                                               :budget 100))
         (again (discrepancy:simulate-blindly 'discrepancy-finder-user::move-the-box
                                              :domain (short-arm-domain) :kinds (list kind)
                                              :budget 100)))
    (is (equal kind (discrepancy:discrepancy-kind
                     (discrepancy:blind-result-discrepancy result))))
    (is (= 1 (cdr (assoc kind (discrepancy:blind-result-kinds result) :test #'equal))))
    (is (<= 1 (discrepancy:blind-result-simulations result) 100))
    (is (= (discrepancy:blind-result-simulations result)
           (discrepancy:blind-result-simulations again)))))

(test blind-simulation-ends-with-its-budget
  (let* ((calls '())
         (result (discrepancy:simulate-blindly 'discrepancy-finder-user::move-the-box
                                               :domain (short-arm-domain)
                                               :kinds '((:no-such :kind)) :budget 7
                                               :progress (lambda (number)
                                                           (push number calls)))))
    (is (null (discrepancy:blind-result-discrepancy result)))
    (is (= 7 (discrepancy:blind-result-simulations result)))
    (is (equal '(7 6 5 4 3 2 1) calls))))
