(in-package #:discrepancy-finder.tests)

(def-suite exploration :in all)
(in-suite exploration)

(defvar *runs* 0
  "Counts calls of a compiled function, which are not undone.")

(defclass lamp-domain (symbolic:action-theory) ())

(defparameter *lamp-theory* "
(define-theory lamps
  (:sorts (lamp a b))
  (:fluents (lit lamp) (broken lamp))
  (:events (toggle lamp) (smash lamp))
  (:axioms
   (toggle-on (implies (and (not (holds-at (lit ?lamp) ?time))
                            (not (holds-at (broken ?lamp) ?time)))
                       (initiates (toggle ?lamp) (lit ?lamp) ?time)))
   (toggle-off (implies (holds-at (lit ?lamp) ?time) (terminates (toggle ?lamp) (lit ?lamp) ?time)))
   (smash-breaks (initiates (smash ?lamp) (broken ?lamp) ?time))
   (smash-darkens (terminates (smash ?lamp) (lit ?lamp) ?time))
   (broken-is-dark (not (and (holds-at (lit ?lamp) ?time) (holds-at (broken ?lamp) ?time))))))
(define-state-constraint lamp-a-lit (?time)
  (and (happens (toggle a) ?time) (holds-at (lit a) (+ ?time 1))))
(define-state-constraint anything (?time)
  (exists (?lamp) (or (happens (toggle ?lamp) ?time) (happens (smash ?lamp) ?time))))
")

(defun make-lamp-domain ()
  (with-file (file *lamp-theory*)
    (symbolic:register-action-theory
     (make-instance 'lamp-domain :name :lamps :theory (ec:load-theory file)))
    (symbolic:define-action (motion toggling) (lamp)
      (:domain lamps)
      (:event (toggle lamp))
      (:requires (not (broken lamp)))
      (:failure plan:gripper-goal-not-reached :event (smash lamp)))
    (symbolic:define-action (motion smashing) (lamp)
      (:domain lamps)
      (:event (smash lamp)))
    (symbolic:find-action-theory :lamps)))

(defun explore-text (text &rest options)
  "Define the plan in TEXT, which is named lamp-plan, and explore it."
  (make-lamp-domain)
  (with-file (file text)
    (plan:load-plan file)
    (apply #'symbolic:explore-plan 'discrepancy-finder-user::lamp-plan :domain :lamps options)))

(defun step-outcomes (exploration)
  (loop for trace in (symbolic:exploration-traces exploration)
        collect (mapcar #'symbolic:step-outcome (symbolic:trace-steps trace))))

(defun initial-fluents (exploration)
  (loop for trace in (symbolic:exploration-traces exploration)
        collect (ec:state-fluents (symbolic:trace-initial-state trace))))

(test outcomes-that-the-theory-allows-are-decisions
  "Lamp a may be broken or not; only the path on which it is not lights it."
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan ()
  (with-failure-handling ((gripper-goal-not-reached () (return :broken)))
    (perform (a motion (type toggling) (lamp a)))))" :constraint 'lamp-a-lit)))
    (is-true (symbolic:exploration-complete-p exploration))
    (is (= 2 (symbolic:exploration-paths exploration)))
    (is (equal '((:success)) (step-outcomes exploration)))
    (is (equal '(()) (initial-fluents exploration)) "the least initial state: everything false")
    (let ((step (first (symbolic:trace-steps
                        (first (symbolic:exploration-traces exploration))))))
      (is (equal '(:toggle :a) (symbolic:step-event step)))
      (is (= 4 (source:source-position-line (symbolic:step-position step)))))))

(test a-failure-with-an-event-has-effects
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan ()
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (perform (a motion (type toggling) (lamp a)))))" :constraint 'anything)))
    (is (equal '((:success) (plan:gripper-goal-not-reached)) (step-outcomes exploration)))
    (is (equal '(() ((:broken :a))) (initial-fluents exploration)))
    (is (equal '(((:lit :a)) ((:broken :a)))
               (loop for trace in (symbolic:exploration-traces exploration)
                     collect (ec:state-fluents (symbolic:trace-final-state trace)))))))

(test what-happened-before-constrains-what-can-happen
  "After smashing a toggling a can only fail, and no path is a dead end."
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan ()
  (perform (a motion (type smashing) (lamp a)))
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (perform (a motion (type toggling) (lamp a)))))" :constraint 'anything)))
    (is (equal '((:success plan:gripper-goal-not-reached)) (step-outcomes exploration)))
    (is (= 1 (symbolic:exploration-paths exploration)))
    (is (= 0 (symbolic:exploration-dead-ends exploration)))))

(test symbolic-arguments-branch
  "Each boolean argument is decided where it is tested, and the trace has its value."
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan (?first ?second)
  (let ((opposite (not ?second)))
    (if (and ?first opposite)
        (perform (a motion (type toggling) (lamp a)))
        (when ?first (perform (a motion (type smashing) (lamp b)))))))"
                                   :constraint 'anything
                                   :arguments '((?first boolean) (?second boolean)))))
    (is (equal '((t t) (t nil))
               (sort (remove-duplicates
                      (mapcar #'symbolic:trace-arguments (symbolic:exploration-traces exploration))
                      :test #'equal)
                     (lambda (one other) (and (second one) (not (second other)))))))
    (is (= 4 (symbolic:exploration-paths exploration))
        "toggling, its failure, smashing, nothing")))

(test compiled-code-never-sees-a-symbolic-value
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan (?flag)
  (let ((seen (list ?flag)))
    (sxhash (first seen))
    (perform (a motion (type toggling) (lamp a)))))"
                                   :constraint 'lamp-a-lit :arguments '((?flag boolean)))))
    (is (equal '((t) (nil))
               (mapcar #'symbolic:trace-arguments (symbolic:exploration-traces exploration))))))

(test symbolic-values-do-not-hide-in-lists-functions-and-specials
  "Each of these must branch on the flag although compiled code looks at it."
  (dolist (form '("(find-if (lambda (x) (declare (ignore x)) ?flag) '(1 2))"
                  "(flet ((all (&rest flags) (every #'identity flags))) (all ?flag t))"
                  "(let ((discrepancy-finder.tests::*special* ?flag))
                     (discrepancy-finder.tests::special-true-p))"
                  "(progn (setq discrepancy-finder.tests::*special* ?flag)
                          (discrepancy-finder.tests::special-true-p))"
                  "(funcall (lambda (x) (if x 1 nil)) ?flag)"
                  "(let ((x (list 1 ?flag))) (second x))"))
    (let ((exploration (explore-text (format nil "
(def-top-level-cram-function lamp-plan (?flag)
  (if ~a
      (perform (a motion (type toggling) (lamp a)))
      (perform (a motion (type smashing) (lamp a)))))" form)
                                     :constraint 'anything :arguments '((?flag boolean)))))
      (is (equal '((:smash nil) (:smash t) (:toggle t))
                 (sort (loop for trace in (symbolic:exploration-traces exploration)
                             for step = (first (symbolic:trace-steps trace))
                             collect (list (first (symbolic:step-event step))
                                           (first (symbolic:trace-arguments trace))))
                       #'string< :key #'princ-to-string))
          "~a" form)
      (is (eq :global *special*)))))

(defun special-true-p ()
  (and *special* (not (eq *special* :global))))

(test what-is-wrong-with-a-domain-is-not-the-plans-to-handle
  (signals symbolic:action-problem
    (explore-text "
(def-top-level-cram-function lamp-plan ()
  (handler-case (perform (a motion (type singing)))
    (error () nil)))" :constraint 'anything)))

(test an-interrupted-path-stays-pending
  (setf *runs* 0)
  (make-lamp-domain)
  (with-file (file "
(def-top-level-cram-function lamp-plan ()
  (when (= 1 (discrepancy-finder.tests::count-a-run)) (error \"once\"))
  (perform (a motion (type smashing) (lamp a))))")
    (plan:load-plan file)
    (let ((exploration (symbolic:make-exploration 'discrepancy-finder-user::lamp-plan :lamps
                                                  :constraint 'anything)))
      (unwind-protect
           (progn
             (signals-with (symbolic:plan-broke "lamp-plan" "once")
               (symbolic:next-trace exploration))
             (is (not (symbolic:exploration-complete-p exploration)))
             (is-true (symbolic:next-trace exploration))
             (is (null (symbolic:next-trace exploration)))
             (is-true (symbolic:exploration-complete-p exploration)))
        (symbolic:close-exploration exploration)))))

(test a-plan-that-performs-something-else-is-reported-with-its-places
  (setf *runs* 0)
  (signals-with (symbolic:nondeterministic-plan ":4: (a motion (type smashing) (lamp b))"
                                                ":3: (a motion (type toggling) (lamp a))")
    (explore-text "
(def-top-level-cram-function lamp-plan ()
  (if (= 1 (discrepancy-finder.tests::count-a-run)) (perform (a motion (type toggling) (lamp a)))
      (perform (a motion (type smashing) (lamp b)))))" :constraint 'anything)))

(test a-replay-that-ends-early-is-reported
  (setf *runs* 0)
  (signals-with (symbolic:nondeterministic-plan "its end")
    (explore-text "
(def-top-level-cram-function lamp-plan (?flag)
  (when (= 1 (discrepancy-finder.tests::count-a-run))
    (when ?flag (perform (a motion (type toggling) (lamp a))))))"
                  :constraint 'anything :arguments '((?flag boolean)))))

(defun call-and-smash (function)
  "A compiled function with a cleanup form that performs something."
  (unwind-protect (funcall function)
    (let ((?lamp :a))
      (plan:perform (plan:a motion (type smashing) (lamp ?lamp))))))

(test cleanup-forms-of-compiled-code-perform-nothing-on-an-abandoned-path
  (flet ((traces (body)
           (length (symbolic:exploration-traces
                    (explore-text (format nil "
(def-top-level-cram-function lamp-plan ()
  (discrepancy-finder.tests::call-and-smash (lambda () ~a)))" body)
                                  :constraint 'anything :max-jumps 100)))))
    (is (= 1 (traces "nil")) "a path that is not abandoned ends with the smash")
    (is (= 0 (traces "(loop)")))))

(test a-plan-may-return-from-itself
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan ()
  (perform (a motion (type smashing) (lamp a)))
  (return-from lamp-plan)
  (perform (a motion (type smashing) (lamp b))))" :constraint 'anything)))
    (is (equal '((:success)) (step-outcomes exploration)))))

(test paths-come-depth-first
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan (?one ?two)
  (if ?one 1 2)
  (if ?two 1 2)
  (perform (a motion (type smashing) (lamp a))))"
                                   :constraint 'anything
                                   :arguments '((?one boolean) (?two boolean)))))
    (is (equal '((t t) (t nil) (nil t) (nil nil))
               (mapcar #'symbolic:trace-arguments (symbolic:exploration-traces exploration))))))

(test action-bindings-are-checked-when-they-are-defined
  (make-lamp-domain)
  (flet ((define (&rest clauses)
           (eval `(symbolic:define-action (motion testing) (lamp) (:domain lamps) ,@clauses))))
    (signals-with (symbolic:action-problem "motion testing" "no event polish")
      (define '(:event (polish lamp))))
    (signals-with (symbolic:action-problem "toggle takes 1 argument, not 2")
      (define '(:event (toggle lamp lamp))))
    (signals-with (symbolic:action-problem "no-such-class is no plan failure")
      (define '(:event (toggle lamp)) '(:failure no-such-class)))
    (signals symbolic:action-problem
      (define '(:event (toggle lamp)) '(:failure plan:plan-failure :event (polish lamp)))))
  (flet ((expand (&rest clauses)
           (macroexpand-1 `(symbolic:define-action (motion testing) () ,@clauses))))
    (signals-with (plan:malformed-plan-form ":domain") (expand '(:event (toggle a))))
    (signals-with (plan:malformed-plan-form "one of :domain") (expand '(:effect (toggle a))))
    (signals-with (plan:malformed-plan-form "one of :domain") (expand 'event))
    (signals-with (plan:malformed-plan-form "one thing after :event")
      (expand '(:domain lamps) '(:event (toggle a) (toggle b))))))

(defvar *counter* 0
  "A global that plans of the tests write to.")

(test writes-to-globals-are-undone-between-paths
  (setf *counter* 0)
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan (?flag)
  (incf discrepancy-finder.tests::*counter*)
  (if ?flag
      (incf discrepancy-finder.tests::*counter* 10)
      (incf discrepancy-finder.tests::*counter* 20))
  (when (< discrepancy-finder.tests::*counter* 22)
    (perform (a motion (type smashing) (lamp a)))))"
                                   :constraint 'anything :arguments '((?flag boolean)))))
    (is (= 2 (length (symbolic:exploration-traces exploration))))
    (is (= 0 *counter*))))

(defun count-a-run ()
  (incf *runs*))

(test a-plan-that-decides-differently-is-reported
  (setf *runs* 0)
  (signals-with (symbolic:nondeterministic-plan "lamp-plan" "not deterministic")
    (explore-text "
(def-top-level-cram-function lamp-plan (?flag)
  (if (= 1 (discrepancy-finder.tests::count-a-run))
      (if ?flag (perform (a motion (type toggling) (lamp a))) 1)
      (if (not ?flag) (perform (a motion (type smashing) (lamp a))) 2)))"
                  :constraint 'anything :arguments '((?flag boolean)))))

(test the-last-instance-of-the-constraint-cuts-the-trace
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan ()
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (perform (a motion (type toggling) (lamp a)))
    (perform (a motion (type toggling) (lamp a)))
    (perform (a motion (type smashing) (lamp b)))))" :constraint 'lamp-a-lit)))
    ;; Lit at the first toggle if it was dark, at the second if it was lit.
    (is (member '(:success :success) (step-outcomes exploration) :test #'equal))
    (is (notany (lambda (outcomes) (> (length outcomes) 2)) (step-outcomes exploration)))))

(test bounds-make-an-exploration-incomplete
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan ()
  (dotimes (i 6)
    (with-failure-handling ((gripper-goal-not-reached () (return)))
      (perform (a motion (type toggling) (lamp a)))
      (perform (a motion (type toggling) (lamp b))))))" :constraint 'anything :max-paths 2)))
    (is (not (symbolic:exploration-complete-p exploration)))
    (is (search "first 2" (first (symbolic:exploration-gaps exploration)))))
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan ()
  (loop (perform (a motion (type smashing) (lamp a)))))" :constraint 'anything :max-steps 5)))
    (is (not (symbolic:exploration-complete-p exploration)))
    (is (equal '("paths of more than 5 steps") (symbolic:exploration-gaps exploration)))))

(test abandoning-a-path-runs-no-cleanup-of-the-plan
  (setf *runs* 0)
  (explore-text "
(def-top-level-cram-function lamp-plan ()
  (unwind-protect (loop (perform (a motion (type smashing) (lamp a))))
    (discrepancy-finder.tests::count-a-run)))" :constraint 'anything :max-steps 3)
  (is (= 0 *runs*)))

(test designators-without-a-meaning-are-named
  (signals-with (symbolic:action-problem "(a motion (type singing))" "lamps" "no action binding")
    (explore-text "(def-top-level-cram-function lamp-plan ()
  (perform (a motion (type singing))))" :constraint 'anything))
  (signals-with (symbolic:unsupported-form "LAMP-PLAN" "type for each")
    (explore-text "(def-top-level-cram-function lamp-plan (x) x)" :constraint 'anything))
  (signals-with (symbolic:unknown-argument-type "parameter x" "tuple" "lamp")
    (explore-text "(def-top-level-cram-function lamp-plan (x) x)" :constraint 'anything
                  :arguments '((x tuple)))))

(test example-1-has-one-trace
  (let* ((exploration (df:explore-plan 'discrepancy-finder-user::move-the-box :domain :two-regions))
         (trace (first (symbolic:exploration-traces exploration))))
    (is-true (symbolic:exploration-complete-p exploration))
    (is (= 1 (length (symbolic:exploration-traces exploration))))
    (is (equal '((:robot-in :r1) (:box-in :r2))
               (ec:state-fluents (symbolic:trace-initial-state trace))))
    (is (equal '((:move :r2) (:pick-up) (:move :r1) (:put-down :r1))
               (mapcar #'symbolic:step-event (symbolic:trace-steps trace))))
    (is (equal '((:robot-in :r1) (:box-in :r1))
               (ec:state-fluents (symbolic:trace-final-state trace))))))

(test a-plan-that-loops-without-performing-is-cut-off
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan ()
  (perform (a motion (type smashing) (lamp a)))
  (loop))" :constraint 'anything :max-jumps 1000)))
    (is (equal '("paths of more than 1000 iterations") (symbolic:exploration-gaps exploration)))
    (is (equal '((:success)) (step-outcomes exploration))))
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan ()
  (with-failure-handling ((plan-failure () (retry)))
    (fail)))" :constraint 'anything :max-jumps 1000)))
    (is (not (symbolic:exploration-complete-p exploration)))))

(test an-error-is-not-forgotten-over-a-cleanup-form
  "Neither an interpreted nor a compiled cleanup form that performs something hides it."
  (signals-with (symbolic:action-problem "dancing")
    (explore-text "
(defun tidy (?lamp)
  (unwind-protect (perform (a motion (type dancing)))
    (perform (a motion (type smashing) (lamp ?lamp)))))
(def-top-level-cram-function lamp-plan () (tidy :a))" :constraint 'anything))
  (signals-with (symbolic:plan-broke "boom")
    (explore-text "
(def-top-level-cram-function lamp-plan ()
  (unwind-protect (error \"boom\")
    (perform (a motion (type smashing) (lamp a)))
    (perform (a motion (type smashing) (lamp a)))))" :constraint 'anything))
  (signals-with (symbolic:plan-broke "boom")
    (explore-text "
(defun leave-quietly ()
  (block quiet (unwind-protect (error \"boom\") (return-from quiet))))
(def-top-level-cram-function lamp-plan () (leave-quietly))" :constraint 'anything)))

(test long-and-circular-lists-are-no-matter
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan (?flag)
  (let ((long (make-list 300000)) (round (list 1 2)))
    (setf (cddr round) round)
    (when (and (= 300000 (length long)) (eql 1 (third round)) ?flag)
      (perform (a motion (type smashing) (lamp a))))))"
                                   :constraint 'anything :arguments '((?flag boolean)))))
    (is (= 1 (length (symbolic:exploration-traces exploration))))))
