;;;; Tasks under symbolic execution: parallel branches, fluents, plans that a perform enters.

(in-package #:discrepancy-finder.tests)

(def-suite parallel-exploration :in all)
(in-suite parallel-exploration)

(defun step-texts (exploration)
  "Return for each trace the list of its steps, each as (lamp outcome)."
  (loop for trace in (symbolic:exploration-traces exploration)
        collect (loop for step in (symbolic:trace-steps trace)
                      collect (list (second (symbolic:step-event step))
                                    (symbolic:step-outcome step)))))

(defun only-successes (exploration)
  "Return the orders of the lamps on the traces whose steps all succeed."
  (loop for steps in (step-texts exploration)
        when (every (lambda (step) (eq (second step) :success)) steps)
          collect (mapcar #'first steps)))

(test parallel-branches-perform-one-after-the-other
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan ()
  (par (perform (a motion (type toggling) (lamp a)))
       (progn (perform (a motion (type toggling) (lamp b)))
              (perform (a motion (type toggling) (lamp b))))))" :constraint 'anything)))
    (is-true (symbolic:exploration-complete-p exploration))
    (is (equal '((:a :b :b)) (remove-duplicates (only-successes exploration) :test #'equal)))))

(test all-orders-of-parallel-branches-on-request
  (flet ((orders (interleavings)
           (sort (remove-duplicates
                  (only-successes (explore-text "
(def-top-level-cram-function lamp-plan ()
  (par (perform (a motion (type toggling) (lamp a)))
       (perform (a motion (type toggling) (lamp b)))))"
                                                :constraint 'anything :interleavings interleavings))
                  :test #'equal)
                 #'string< :key #'first)))
    (is (equal '((:a :b)) (orders nil)))
    (is (equal '((:a :b) (:b :a)) (orders t)))))

(test a-failing-branch-ends-the-others
  "The branch that waits never goes on, whichever way the path takes."
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan ()
  (with-failure-handling
      ((gripper-goal-not-reached () (return)))
    (pursue (perform (a motion (type toggling) (lamp a)))
            (progn (sleep 1) (perform (a motion (type smashing) (lamp b)))))))"
                                   :constraint 'anything)))
    (is-true (symbolic:exploration-complete-p exploration))
    (is (null (set-difference (mapcar #'first (apply #'append (step-texts exploration)))
                              '(:a))))
    (is (= 2 (length (remove-duplicates (mapcar (lambda (steps) (second (first steps)))
                                                (step-texts exploration))))))))

(test fluents-order-branches
  (is (equal '((:b :a))
             (remove-duplicates
              (only-successes (explore-text "
(def-top-level-cram-function lamp-plan ()
  (let ((ready (make-fluent :name 'ready)))
    (par (progn (wait-for ready)
                (perform (a motion (type toggling) (lamp a))))
         (progn (perform (a motion (type toggling) (lamp b)))
                (setf (value ready) t)))))" :constraint 'anything))
              :test #'equal))))

(test cleanup-forms-do-not-run-on-abandoned-parallel-paths
  (let ((exploration (explore-text "
(defvar *cleanups* 0)
(def-cram-function careful (?lamp)
  (unwind-protect (loop (perform (a motion (type smashing) (lamp ?lamp))))
    (incf *cleanups*)))
(def-top-level-cram-function lamp-plan ()
  (par (careful :a) (careful :b)))" :constraint 'anything :max-steps 5)))
    (is-true (symbolic:exploration-gaps exploration))
    (is (eql 0 (symbol-value (find-symbol "*CLEANUPS*" '#:discrepancy-finder-user))))))

(defparameter *entering-plan* "
(def-fact-group lamp-actions (action-grounding)
  (<- (action-grounding ?action (switch-both ?first ?second))
    (desig-prop ?action (:type :switching))
    (desig-prop ?action (:first ?first))
    (desig-prop ?action (:second ?second))))
(def-cram-function switch-both (?first ?second)
  (perform (a motion (type toggling) (lamp ?first)))
  (perform (a motion (type toggling) (lamp ?second))))
(def-top-level-cram-function lamp-plan ()
  (perform (an action (type switching) (first b) (second a))))")

(test an-action-without-a-binding-enters-its-plan
  (is (equal '((:b :a))
             (remove-duplicates (only-successes (explore-text *entering-plan*
                                                              :constraint 'anything))
                                :test #'equal))))

(test goals-are-interpreted
  "A symbolic argument passes through a goal: it is decided on where the goal's body looks at it."
  (let ((exploration (explore-text "
(declare-goal achieve-lamp (fact flag))
(def-goal (achieve-lamp (on ?lamp) ?flag)
  (perform (a motion (type smashing) (lamp ?lamp)))
  (if ?flag (perform (a motion (type smashing) (lamp b)))))
(def-top-level-cram-function lamp-plan (flag) (achieve-lamp '(on a) flag))"
                                   :constraint 'anything :arguments '((flag boolean)))))
    (is (= 2 (symbolic:exploration-paths exploration)))
    (is (equal '(1 2) (sort (mapcar #'length (step-texts exploration)) #'<)))))

(test deadlocks-of-plans-are-errors
  (signals-with (plan:deadlock "the fluent never")
    (explore-text "
(def-top-level-cram-function lamp-plan ()
  (par (perform (a motion (type toggling) (lamp a)))
       (wait-for (make-fluent :name 'never))))" :constraint 'anything)))

(test what-is-wrong-with-a-domain-is-signaled-from-branches-too
  "The error crosses from the thread of the branch to the caller, past the plan's handlers."
  (signals-with (symbolic:action-problem "singing")
    (explore-text "
(def-top-level-cram-function lamp-plan ()
  (par (sleep 1)
       (handler-case (perform (a motion (type singing)))
         (error () nil))))" :constraint 'anything)))

(test plans-that-are-no-top-levels-get-one
  (is (equal '((:a))
             (remove-duplicates (only-successes (explore-text "
(def-cram-function lamp-plan ()
  (perform (a motion (type toggling) (lamp a))))" :constraint 'anything))
                                :test #'equal))))

(test values-of-performs-stay-symbolic-through-tasks
  "A plan that hands on an argument through child tasks branches only where it is looked at."
  (let ((exploration (explore-text "
(def-cram-function hand-on (x) x)
(def-top-level-cram-function lamp-plan (flag)
  (let ((same (top-level-free flag)))
    (perform (a motion (type smashing) (lamp a)))
    (when same
      (perform (a motion (type smashing) (lamp b))))))
(def-cram-function top-level-free (x) (seq (hand-on x)))"
                                   :constraint 'anything :arguments '((flag boolean)))))
    (is (= 2 (length (symbolic:exploration-traces exploration))))
    (is (= 2 (symbolic:exploration-paths exploration)))))

(test all-schedules-of-suspended-tasks
  (is-true (symbolic:exploration-complete-p (explore-text "
(def-top-level-cram-function lamp-plan ()
  (with-tags
    (par (:tag a (dotimes (i 2) (sleep 1)))
         (with-task-suspended (a)
           (par (sleep 1) (sleep 2))))))" :constraint 'anything :interleavings t))))

(test writes-of-parallel-branches-are-undone
  "Bindings in branches end in another order than they began."
  (explore-text "
(defvar *written* :before)
(defvar *also* :before)
(def-top-level-cram-function lamp-plan ()
  (setf *also* :after)
  (par (let ((*written* 1)) (setf *written* :l) (sleep 2))
       (progn (sleep 1)
              (let ((*also* 2)) (setf *also* 3) (setf *written* :global) (sleep 3)))))"
                :constraint 'anything)
  (is (equal '(:before :before)
             (mapcar (lambda (name)
                       (symbol-value (find-symbol name '#:discrepancy-finder-user)))
                     '("*WRITTEN*" "*ALSO*")))))
