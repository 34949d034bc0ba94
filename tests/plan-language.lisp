(in-package #:discrepancy-finder.tests)

(def-suite plan-language :in all)
(in-suite plan-language)

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
