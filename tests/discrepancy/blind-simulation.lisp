;;;; Simulation without a trace: the whole state space, and when it ends.

(in-package #:discrepancy-finder.tests)

(def-suite blind-simulation :in all)
(in-suite blind-simulation)

(defun short-arm-domain ()
  "Return the domain of Example 1 with an arm that reaches 0.5 m."
  (discrepancy:domain-with-parameters (discrepancy:ensure-domain :two-regions) '(:reach 0.5d0)))

(test what-is-observed-at-the-beginning-is-left-open
  "What cannot be observed there is as the theory has it."
  (let ((domain (discrepancy:ensure-domain :kitchen)))
    (is (equal '(:robot-starts-at-its-start :hands-start-empty :drawers-start-closed
                 :spoon-starts-in-a-drawer :others-start-on-the-workspace)
               (mapcar #'ec:axiom-name (discrepancy::beginnings domain))))
    (let ((theory (symbolic:action-theory-theory
                   (discrepancy::domain-beginning-anywhere domain))))
      (is (= 54 (length (ec:theory-axioms theory))))
      (is-true (find :arms-start-parked (ec:theory-axioms theory) :key #'ec:axiom-name)))
    (is (= 59 (length (ec:theory-axioms (symbolic:action-theory-theory domain))))
        "the domain itself stays as it is")))

(defun blind-ranges (choice)
  "Return the list of the alternatives of CHOICE, each a list of (name min max)."
  (loop for (nil . parameters) in choice
        collect (loop for parameter in parameters
                      collect (list (discrepancy:parameter-name parameter)
                                    (discrepancy:parameter-min parameter)
                                    (discrepancy:parameter-max parameter)))))

(test blind-samples-cover-the-whole-state-space
  "The abstraction draws the spoon in the middle of its drawer; a blind sample has it anywhere."
  (let* ((choices (discrepancy::initial-choices (discrepancy:ensure-domain :kitchen)))
         (ranges (mapcar #'blind-ranges choices))
         (ways (list (- pi) pi)))
    (is (equal '(6 2 2 2 5 2 2 2) (mapcar #'length choices))
        "places of the robot, surfaces of each item, drawers for the spoon, joints")
    (is (equal `(("robot.x" -0.8d0 -0.7d0) ("robot.y" -0.05d0 0.05d0) ("robot.yaw" ,@ways))
               (first (first ranges))))
    (destructuring-bind (on-the-workspace on-the-table in-drawer-1 &rest others) (fifth ranges)
      (is (= 2 (length others)))
      (is (equal '("spoon.z" 0.98d0 0.98d0) (assoc "spoon.z" on-the-workspace :test #'string=))
          "it falls onto the workspace, which is higher than the table")
      (is (equal '("spoon.z" 0.7645d0 0.7645d0) (assoc "spoon.z" on-the-table :test #'string=)))
      (is (equal `(("spoon.x" -2.4d0 -1.5d0) ("spoon.y" -0.85d0 -0.35d0)
                   ("spoon.z" 0.6105d0 0.6105d0) ("spoon.yaw" ,@ways))
                 in-drawer-1)))
    (is (equal '((("drawer_1_joint" 0.3d0 0.4d0)) (("drawer_1_joint" 0d0 0d0)))
               (sixth ranges)))))

(test blind-initial-states-are-of-all-kinds
  "Of 12 simulations in the kitchen some begin with the spoon on a surface and in a drawer, drawers
open and shut, the robot in several places; and each begins where it was drawn."
  (let* ((domain (discrepancy::domain-beginning-anywhere (discrepancy:ensure-domain :kitchen)))
         (plan (with-file (file "(def-top-level-cram-function idle-in-the-kitchen () nil)")
                 (plan:plan-name (first (plan:load-plan file)))))
         (states (loop with index = 0
                       repeat 12
                       collect (multiple-value-bind (run judgement number)
                                   (discrepancy::next-blind-run domain plan 1 index)
                                 (is (eq :consistent (discrepancy:judgement-verdict judgement)))
                                 (setf index (1+ number))
                                 (discrepancy:observed-fluents
                                  (discrepancy:run-initial-state run))))))
    (flet ((seen (&rest pattern)
             (loop for state in states
                   append (remove-if-not (lambda (atom)
                                           (eql (mismatch pattern atom) (length pattern)))
                                         state))))
      (is (= 12 (length (seen :robot-at)) (length (seen :on :bowl))
             (+ (length (seen :on :spoon)) (length (seen :in :spoon)))))
      (is (plusp (length (seen :on :spoon))))
      (is (plusp (length (seen :in :spoon))))
      (is (< 0 (length (seen :open)) 36))
      (is (= 2 (length (remove-duplicates (seen :on :bowl) :test #'equal))))
      (is (<= 3 (length (remove-duplicates (seen :robot-at) :test #'equal)))))))

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
