;;;; The plan language: failures, designators as plans see them, plans and their sources, the task
;;;; tree.
;;;;
;;;; What each operator does in its corner cases is shown, and tested, by docs/plan-language.md.

(in-package #:discrepancy-finder.tests)

(def-suite plan-language :in all)
(in-suite plan-language)

(defvar *events* '()
  "What plans of these tests note, the last first.  Its global value: tasks see no other.")

(defun note-event (event)
  (push event *events*)
  event)

(defun events-of (function)
  "Call FUNCTION and return the list of the events that it notes."
  (setf *events* '())
  (funcall function)
  (reverse *events*))

;;; Failures

(test a-handler-that-ends-normally-declines
  "The next matching clause and then the outer form have their turn, in order."
  (let ((log '()))
    (is (eq :outer
            (plan:with-failure-handling
                ((plan:plan-failure () (push :outer log) (return :outer)))
              (plan:with-failure-handling
                  ((plan:navigation-low-level-failure (e) (push (type-of e) log))
                   (plan:gripper-low-level-failure () (push :never log))
                   (plan:plan-failure () (push :second log)))
                (plan:fail 'plan:navigation-goal-not-reached)))))
    (is (equal '(plan:navigation-goal-not-reached :second :outer) (reverse log)))))

(test handlers-run-before-unwinding
  (let ((log '()))
    (plan:with-failure-handling
        ((plan:plan-failure () (push :handler log) (return)))
      (unwind-protect (plan:fail)
        (push :cleanup log)))
    (is (equal '(:handler :cleanup) (reverse log)))))

(test retry-begins-the-body-again
  (let ((tries 0))
    (is (equal '(:done 3)
               (multiple-value-list
                (plan:with-retry-counters ((again 5))
                  (plan:with-failure-handling
                      ((plan:simple-plan-failure ()
                         (plan:do-retry again
                           (plan:retry))))
                    (when (< (incf tries) 3) (plan:fail "try ~d" tries))
                    (values :done tries))))))))

(test n-retries-are-n-plus-1-attempts
  (let ((attempts 0))
    (signals plan:simple-plan-failure
      (plan:with-retry-counters ((again 3))
        (plan:with-failure-handling
            ((plan:plan-failure () (plan:do-retry again (plan:retry))))
          (incf attempts)
          (plan:fail))))
    (is (= 4 attempts))))

(test retry-counters
  (plan:with-retry-counters ((outer 1))
    (let ((outer-variable :untouched))
      (plan:with-retry-counters ((inner (1+ 1)))
        (is (eq :taken (plan:do-retry inner :taken)))
        (is (= 1 (plan:get-counter inner)))
        (is (eq :taken (plan:do-retry outer :taken)))
        (is (null (plan:do-retry outer :taken)))
        (plan:reset-counter outer)
        (is (= 1 (plan:get-counter outer))))
      (is (eq :untouched outer-variable)))))

(test a-class-may-be-an-or-of-classes
  (is (eq :caught
          (plan:with-failure-handling
              (((or plan:gripper-closed-completely plan:perception-object-not-found) ()
                (return :caught)))
            (plan:fail 'plan:perception-object-not-found)))))

(test a-failure-in-a-handler-goes-to-outer-forms-only
  (is (eq 'plan:gripper-goal-not-reached
          (plan:with-failure-handling
              ((plan:plan-failure (e) (return (type-of e))))
            (plan:with-failure-handling
                ((plan:navigation-low-level-failure ()
                   (plan:fail 'plan:gripper-goal-not-reached))
                 (plan:gripper-low-level-failure () (return :sibling)))
              (plan:fail 'plan:navigation-pose-unreachable))))))

(test plan-failure-is-no-error
  (is (subtypep 'plan:plan-failure 'serious-condition))
  (is (not (subtypep 'plan:plan-failure 'error)))
  (signals plan:plan-failure (ignore-errors (plan:fail))))

(test fail-takes-all-forms-of-arguments
  (is (string= "Plan failure." (report-of 'plan:simple-plan-failure (lambda () (plan:fail)))))
  (is (string= "no 3" (report-of 'plan:simple-plan-failure (lambda () (plan:fail "no ~d" 3)))))
  (is (search "too far" (report-of 'plan:manipulation-pose-unreachable
                                   (lambda ()
                                     (plan:fail 'plan:manipulation-pose-unreachable
                                                :description "too far")))))
  (let ((condition (make-condition 'plan:gripper-closed-completely)))
    (is (eq condition (handler-case (plan:fail condition)
                        (plan:plan-failure (found) found))))))

(test retry-outside-of-a-handler-is-an-error
  (signals plan:malformed-plan-form (apply 'plan:retry '()))
  (signals-with (plan:malformed-plan-form "nowhere" "with-retry-counters")
    (macroexpand-1 '(plan:do-retry nowhere (plan:retry))))
  (signals-with (plan:malformed-plan-form "list of clauses")
    (macroexpand-1 '(plan:with-failure-handling (plan:plan-failure) (plan:fail)))))

;;; Designators

(test designators
  (let* ((pose (geometry:make-pose 1 2 3))
         (?pose pose)
         (?type :box)
         (designator (plan:a motion (type going) (pose ?pose) (via first) (speed 2)
                                  (via (left right)) (object (plan:an object (type ?type))))))
    (is (eq :motion (plan:designator-class-keyword designator)))
    (is (eq :going (plan:desig-prop-value designator :type)))
    (is (eq pose (plan:desig-prop-value designator :pose)))
    (is (eql 2 (plan:desig-prop-value designator :speed)))
    (is (equal '(:first (:left :right)) (plan:desig-prop-values designator :via)))
    (is (eq :box (plan:desig-prop-value (plan:desig-prop-value designator :object) :type)))
    (is (null (plan:desig-prop-value designator :nothing)))
    (let ((?arm nil))
      (is (equal '(:type :speed)
                 (mapcar #'first (plan:properties
                                  (plan:a motion (type going) (when ?arm (arm ?arm))
                                          (when (not ?arm) (speed 1))))))))
    (is (null (plan:desig-prop-value nil :type)))
    (is (string= "(an action (type grasping))"
                 (princ-to-string (plan:an action (type grasping)))))
    (let ((location (plan:a location (pose ?pose))))
      (is (eq pose (plan:designated-pose location))))))

(test malformed-designators
  (signals-with (desig:malformed-designator "after the article")
    (macroexpand-1 '(plan:a thing)))
  (signals-with (desig:malformed-designator "(key value)")
    (macroexpand-1 '(plan:a motion type))))

;;; Plans and performing

(defclass recorder () ((performed :initform '() :accessor performed)))

(defmethod plan:perform-with ((recorder recorder) designator position)
  (push (cons (plan:desig-prop-value designator :type) position) (performed recorder))
  (plan:desig-prop-value designator :type))

(defparameter *plan-text* "
(def-cram-function helper (?x)
  \"Helps.\"
  (perform (a motion (type ?x))))

(def-top-level-cram-function a-plan-of-the-tests (&optional (?x :going))
  (helper ?x)
  (seq (perform (a motion (type looking)))))
")

(test plans-keep-their-source
  (with-file (file *plan-text*)
    (let* ((plans (plan:load-plan file))
           (plan (second plans))
           (recorder (make-instance 'recorder)))
      (is (equal '("HELPER" "A-PLAN-OF-THE-TESTS")
                 (mapcar (lambda (plan) (symbol-name (plan:plan-name plan))) plans)))
      (is (string= "Helps." (plan:plan-documentation (first plans))))
      (is-true (plan:plan-top-level-p plan))
      (is (not (plan:plan-top-level-p (first plans))))
      (is (= 6 (source:source-position-line (plan:plan-position plan))))
      (is (eq :looking (plan:with-executive (recorder) (funcall (plan:plan-name plan)))))
      (is (equal '(:going :looking) (mapcar #'car (reverse (performed recorder)))))
      (is (equal '(4 8) (mapcar (lambda (entry) (source:source-position-line (cdr entry)))
                                (reverse (performed recorder))))
          "the compiled plan knows where its performs are"))))

(test performing-needs-a-top-level
  (signals plan:not-in-top-level (plan:perform (plan:a motion (type going)))))

(test top-levels-are-not-nested
  (is (equal '(1 2) (multiple-value-list (plan:top-level (values 1 2)))))
  (signals-with (plan:nested-top-level "cannot be nested")
    (plan:top-level (plan:top-level 1))))

(test unknown-plans-are-named
  (signals-with (plan:plan-not-found "no-such-plan") (plan:find-plan 'no-such-plan)))

;;; The task tree

(plan:def-cram-function fetch-something (what)
  (note-event (list :fetch what))
  (plan:sleep* 1/10)
  (when (eql what 3) (plan:fail 'plan:gripper-goal-not-reached))
  what)

(plan:def-cram-function lay-table (cups &key (table :kitchen-table))
  (plan:par (fetch-something cups) (fetch-something table))
  (plan:with-failure-handling ((plan:plan-failure () (return :without)))
    (fetch-something 3)))

(defun laid-table ()
  "Return the root of the task tree of a plan."
  (plan:named-top-level (:name :tree) (lay-table 1) (lay-table 2 :table :desk))
  (plan:get-top-level-task-tree :tree))

(test nodes-of-the-task-tree
  (let* ((root (laid-table))
         (calls (plan:task-tree-node-children root))
         (first-call (first calls)))
    (is (null (plan:task-tree-node-parent root)))
    (is (eq root (plan:task-tree-node-parent first-call)))
    (is (equal '((lay-table) (plan:top-level :tree)) (plan:task-tree-node-path first-call)))
    (is (equal '((:call 2) (lay-table) (plan:top-level :tree))
               (plan:task-tree-node-path (second calls))))
    (is (equal '((1 :kitchen-table) (2 :desk)) (mapcar #'plan:task-tree-node-parameters calls)))
    (is (equal '((:without) (:without)) (mapcar #'plan:task-tree-node-result calls)))
    (is (equal '(:succeeded :succeeded)
               (mapcar (lambda (node) (plan:value (plan:task-tree-node-status-fluent node)))
                       calls)))
    (is (equal '(lay-table (cups &key (table :kitchen-table)))
               (subseq (plan:task-tree-node-code first-call) 0 2)))
    (destructuring-bind (one two failed) (plan:task-tree-node-children first-call)
      (is (equal '((fetch-something cups) (fetch-something table))
                 (mapcar #'plan:task-tree-node-code (list one two))))
      (is (equal '(((1)) ((:kitchen-table)))
                 (loop for branch in (list one two)
                       collect (mapcar #'plan:task-tree-node-parameters
                                       (plan:task-tree-node-children branch)))))
      (is (equal '(3) (plan:task-tree-node-parameters failed)))
      (is (typep (plan:task-tree-node-result failed) 'plan:gripper-goal-not-reached))
      (is (eq :failed (plan:value (plan:task-tree-node-status-fluent failed)))))))

(test the-task-tree-flattened
  (let* ((root (laid-table))
         (nodes (plan:flatten-task-tree root)))
    (is (= 13 (length nodes)))
    (is (eq root (first nodes)))
    (is (= 13 (length (remove-duplicates (mapcar #'plan:task-tree-node-path nodes)
                                         :test #'equal)))
        "paths are unique")
    (is (loop for node in (rest nodes)
              always (< (position (plan:task-tree-node-parent node) nodes)
                        (position node nodes))))))

(test tasks-are-printed-in-one-line
  (let ((task (plan:task-tree-node-task (first (plan:task-tree-node-children (laid-table))))))
    (is (search "lay-table succeeded" (princ-to-string task)))
    (is (null (find #\Newline (princ-to-string task))))
    (is (null (find #\Newline (princ-to-string (laid-table)))))))
