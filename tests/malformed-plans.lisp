;;;; Plans that are not well-formed: the error names the form and, in a file, plan, file and line.

(in-package #:discrepancy-finder.tests)

(def-suite malformed-plans :in all)
(in-suite malformed-plans)

(test malformed-forms-are-named
  (dolist (form '((plan:with-failure-handling 3 1)
                  (plan:with-failure-handling (plan:plan-failure) 1)
                  (plan:with-failure-handling ((3 () 1)) 2)
                  (plan:with-failure-handling (("x" () 1)) 2)
                  (plan:with-failure-handling (((or) () 1)) 2)
                  (plan:with-failure-handling (((or 3) () 1)) 2)
                  (plan:with-failure-handling (((and a b) () 1)) 2)
                  (plan:with-failure-handling ((nil () 1)) 2)
                  (plan:with-failure-handling ((plan:plan-failure (3) 1)) 2)
                  (plan:with-failure-handling ((plan:plan-failure (t) 1)) 2)
                  (plan:with-failure-handling ((plan:plan-failure (a b) 1)) 2)
                  (plan:with-retry-counters c 1)
                  (plan:with-retry-counters (c) 1)
                  (plan:with-retry-counters ((c 1 2)) 1)
                  (plan:with-retry-counters ((3 1)) 1)
                  (plan:do-retry 3 (plan:retry))
                  (plan:get-counter 3)
                  (plan:make-policy p () (:chek t))
                  (plan:partial-order (1 2) (:after a b))
                  (plan:def-cram-function 3 ())
                  (plan:def-cram-function plan:par ())
                  (plan:def-goal (:never ?x) 1)
                  (:tag a 1)))
    (is (eq :refused (handler-case (macroexpand-1 form)
                       (plan:malformed-plan-form () :refused)))
        "~s is accepted" form)))

(test malformed-arguments-are-named
  (signals-with (plan:malformed-plan-form "class of a condition") (plan:fail 3))
  (signals-with (plan:malformed-plan-form "class of a condition") (plan:fail 'no-such-failure))
  (signals-with (desig:malformed-designator "(key value*)") (plan:make-designator :action 3))
  (signals-with (desig:malformed-designator "(key value*)") (plan:make-designator :action '(3))))

(defun loading-sentence (text)
  "Return what LOAD-PLAN says is wrong with a file that holds TEXT."
  (with-file (file text)
    (handler-case (progn (plan:load-plan file) nil)
      (source:source-error (condition) (princ-to-string condition)))))

(test a-file-with-a-malformed-form-is-refused-when-it-is-loaded
  "Not when the plan gets there."
  (let ((sentence (loading-sentence "
(def-cram-function careless (x)
  (with-retry-counters ((again 1))
    (do-retry once-more (retry))))")))
    (is (search ":2: In (DO-RETRY ONCE-MORE (RETRY)) of the plan careless" sentence) "~a" sentence)
    (is (search ":4" sentence) "~a" sentence))
  (is (search "clauses" (loading-sentence "
(def-cram-function careless (x)
  (with-failure-handling (plan-failure) 3))")))
  (is (search "enclosing with-tags" (loading-sentence "(defun careless () (:tag a 1))"))))

(test plans-are-those-of-their-functions
  "A function that was defined anew in another way has no stale source."
  (with-file (file "(def-top-level-cram-function changing () :old)")
    (plan:load-plan file)
    (let ((name (find-symbol "CHANGING" '#:discrepancy-finder-user)))
      (is (eq name (plan:plan-name (plan:find-plan name))))
      (handler-bind ((warning #'muffle-warning))
        (setf (fdefinition name) (lambda () :new)))
      (signals-with (plan:plan-not-found "no plan with a source") (plan:find-plan name)))))

(test recursion-without-end-in-a-branch-is-an-error
  (let ((plan:*strand-limit* 100))
    (labels ((deeper ()
               (plan:call-in-task 'deeper '(deeper) (lambda () (1+ (deeper))))))
      (signals-with (plan:too-many-tasks "deeper" "100")
        (plan:top-level (plan:par 1 (1+ (deeper)))))))
  (is (= 0 (busy-threads))))
