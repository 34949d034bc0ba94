;;;; Action bindings: requirements, failures with effects, what perform returns, symbolic
;;;; properties, and what is wrong with a binding.

(in-package #:discrepancy-finder.tests)

(def-suite define-action :in all)
(in-suite define-action)

(defclass kitchen-domain (symbolic:action-theory) ())

(defparameter *kitchen-theory* "
(define-theory toy-kitchen
  (:sorts (thing cup bowl) (place shelf table door))
  (:fluents (location thing place) (detected thing) (robot-at place) (blocked place))
  (:events (detect thing) (go place) (stop-halfway place) (drop thing place))
  (:axioms
   (going-arrives (initiates (go ?place) (robot-at ?place) ?time))
   (going-leaves (implies (and (holds-at (robot-at ?place1) ?time) (/= ?place1 ?place2))
                          (terminates (go ?place2) (robot-at ?place1) ?time)))
   (stopping-at-the-door (initiates (stop-halfway ?place) (robot-at door) ?time))
   (stopping-leaves (implies (and (holds-at (robot-at ?place) ?time) (/= ?place door))
                             (terminates (stop-halfway ?place1) (robot-at ?place) ?time)))
   (detecting-sees (implies (exists (?place) (and (holds-at (robot-at ?place) ?time)
                                                  (holds-at (location ?thing ?place) ?time)))
                            (initiates (detect ?thing) (detected ?thing) ?time)))
   (dropping-moves (initiates (drop ?thing ?place) (location ?thing ?place) ?time))
   (dropping-takes (implies (and (holds-at (location ?thing ?place1) ?time)
                                 (/= ?place1 ?place2))
                            (terminates (drop ?thing ?place2) (location ?thing ?place1) ?time)))
   (one-place-each (implies (and (holds-at (location ?thing ?place1) ?time)
                                 (/= ?place1 ?place2))
                            (not (holds-at (location ?thing ?place2) ?time))))
   (nothing-at-the-door (not (holds-at (location ?thing door) ?time)))
   (robot-somewhere (exists (?place) (holds-at (robot-at ?place) ?time)))
   (robot-in-one-place (implies (and (holds-at (robot-at ?place1) ?time) (/= ?place1 ?place2))
                                (not (holds-at (robot-at ?place2) ?time))))))
(define-state-constraint anything (?time) (exists (?place) (holds-at (robot-at ?place) ?time)))
(define-state-constraint stopped (?time)
  (and (happens (stop-halfway table) ?time) (holds-at (robot-at door) (+ ?time 1))))
")

(defparameter *kitchen-actions* "
(define-action (motion going) (?target)
  (:domain toy-kitchen)
  (:event (go ?target))
  (:requires (not (blocked ?target)))
  (:failure navigation-goal-not-reached
            :event (stop-halfway ?target) :initargs (:location ?target))
  (:failure navigation-pose-unreachable
            :when (and (blocked ?target) (robot-at door))))
(define-action (motion detecting) (object)
  (:domain toy-kitchen)
  (:event (detect (desig-prop-value object :type)))
  (:returns (let ((?type (desig-prop-value object :type)))
              (let ((?place (value-of (location (desig-prop-value object :type) ?place) ?place))
                    (?seen (truth-of (detected ?type))))
                (an object (type ?type) (location ?place) (name ?seen))))))
(define-action (action dropping) (object place)
  (:domain toy-kitchen)
  (:event (drop object place)))
")

(defun make-kitchen ()
  (with-file (file *kitchen-theory*)
    (symbolic:register-action-theory
     (make-instance 'kitchen-domain :name :toy-kitchen :theory (ec:load-theory file))))
  (with-file (file *kitchen-actions*)
    (plan:load-plan file))
  (symbolic:find-action-theory :toy-kitchen))

(defun explore-kitchen (text &rest options)
  "Define the plan in TEXT, which is named kitchen-plan, and explore it."
  (make-kitchen)
  (with-file (file text)
    (plan:load-plan file)
    (apply #'symbolic:explore-plan 'discrepancy-finder-user::kitchen-plan :domain :toy-kitchen
           options)))

(defun step-lists (exploration)
  "Return for each trace the list of its steps, each (outcome event-name element*)."
  (loop for trace in (symbolic:exploration-traces exploration)
        collect (loop for step in (symbolic:trace-steps trace)
                      collect (cons (symbolic:step-outcome step) (symbolic:step-event step)))))

(test failures-have-events-and-conditions-of-their-own
  (let ((exploration (explore-kitchen "
(def-top-level-cram-function kitchen-plan ()
  (with-failure-handling ((navigation-low-level-failure () (return)))
    (perform (a motion (type going) (target table)))))" :constraint 'anything)))
    (is-true (symbolic:exploration-complete-p exploration))
    (is (equal '(((:success :go :table))
                 ((plan:navigation-goal-not-reached :stop-halfway :table))
                 ((plan:navigation-pose-unreachable)))
               (step-lists exploration)))
    (is (equal '((:robot-at :door) (:robot-at :door))
               (loop for trace in (rest (symbolic:exploration-traces exploration))
                     collect (find :robot-at (ec:state-fluents (symbolic:trace-final-state trace))
                                   :key #'first)))
        "the first failure moves the robot to the door, the second is possible only there"))
  (is (equal '(((plan:navigation-goal-not-reached :stop-halfway :table)))
             (step-lists (explore-kitchen "
(def-top-level-cram-function kitchen-plan ()
  (with-failure-handling ((navigation-low-level-failure () (return)))
    (perform (a motion (type going) (target table)))))" :constraint 'stopped)))))

(test failures-have-slots
  "The handler finds the place in the failure and goes there."
  (is (member '((plan:navigation-goal-not-reached :stop-halfway :table)
                (:success :drop :cup :table))
              (step-lists (explore-kitchen "
(def-top-level-cram-function kitchen-plan ()
  (with-failure-handling
      ((navigation-low-level-failure (failure)
         (let ((?place (navigation-failure-location failure)))
           (when ?place
             (perform (an action (type dropping) (object cup) (place ?place)))))
         (return)))
    (perform (a motion (type going) (target table)))))" :constraint 'anything))
              :test #'equal)))

(test perform-returns-what-the-theory-says
  "The place of the cup is unknown: every place that it can have is a path, and nowhere."
  (let ((exploration (explore-kitchen "
(def-top-level-cram-function kitchen-plan ()
  (let* ((?cup (perform (a motion (type detecting) (object (an object (type cup))))))
         (?place (desig-prop-value ?cup :location)))
    (case ?place
      ((:shelf :table)
       (perform (an action (type dropping) (object bowl) (place ?place))))
      ((nil) nil)
      (t (error \"The theory does not allow ~a.\" ?place)))))" :constraint 'anything)))
    (is-true (symbolic:exploration-complete-p exploration))
    (is (alexandria:set-equal
         '(((:success :detect :cup)) ((:success :detect :cup) (:success :drop :bowl :shelf))
           ((:success :detect :cup) (:success :drop :bowl :table)))
         (step-lists exploration) :test #'equal))
    (dolist (trace (symbolic:exploration-traces exploration))
      (when (rest (symbolic:trace-steps trace))
        (is (member (list :location :cup
                          (third (symbolic:step-event (second (symbolic:trace-steps trace)))))
                    (ec:state-fluents (symbolic:trace-initial-state trace))
                    :test #'equal))))))

(test truth-of-asks-for-the-state-after-the-action
  (flet ((outcomes (place)
           (remove-duplicates
            (step-lists (explore-kitchen (format nil "
(def-top-level-cram-function kitchen-plan ()
  (perform (an action (type dropping) (object cup) (place table)))
  (perform (a motion (type going) (target ~a)))
  (let ((cup (perform (a motion (type detecting) (object (an object (type cup)))))))
    (when (desig-prop-value cup :name)
      (perform (an action (type dropping) (object cup) (place shelf))))))" place)
                                         :constraint 'anything))
            :test #'equal)))
    (is (member '((:success :drop :cup :table) (:success :go :table) (:success :detect :cup)
                  (:success :drop :cup :shelf))
                (outcomes "table") :test #'equal))
    (is (notany (lambda (steps) (and (= 3 (length steps)) (eq :success (first (third steps)))))
                (outcomes "table"))
        "at the table the cup is seen in any case")))

(test symbolic-properties-are-decided-before-an-event-is-made-of-them
  "An element that perform returned is the target of the next motion."
  (let ((exploration (explore-kitchen "
(def-top-level-cram-function kitchen-plan ()
  (let* ((cup (perform (a motion (type detecting) (object (an object (type cup))))))
         (?place (desig-prop-value cup :location)))
    (when ?place
      (with-failure-handling ((navigation-low-level-failure () (return)))
        (perform (a motion (type going) (target ?place)))))))" :constraint 'anything)))
    (is (subsetp '(((:success :detect :cup) (:success :go :shelf))
                   ((:success :detect :cup) (:success :go :table)))
                 (step-lists exploration) :test #'equal))
    (is (notany (lambda (steps) (member :door (alexandria:flatten steps)))
                (step-lists exploration)))))

(defparameter *fetching* "
(def-fact-group kitchen-groundings (action-grounding)
  (<- (action-grounding ?action (fetch-from ?place))
    (desig-prop ?action (:type :fetching))
    (desig-prop ?action (:location ?place))
    (lisp-pred keywordp ?place)))
(def-cram-function fetch-from (?place)
  (perform (an action (type dropping) (object bowl) (place ?place))))
(def-top-level-cram-function kitchen-plan ()
  (let* ((cup (perform (a motion (type detecting) (object (an object (type cup))))))
         (?place (desig-prop-value cup :location)))
    (when ?place
      (perform (an action (type fetching) (location ?place))))))")

(test groundings-run-on-symbolic-designators
  "An action without a binding is resolved by Prolog rules, for each place that the cup can have."
  (is (alexandria:set-equal
       '(((:success :detect :cup)) ((:success :detect :cup) (:success :drop :bowl :shelf))
         ((:success :detect :cup) (:success :drop :bowl :table)))
       (step-lists (explore-kitchen *fetching* :constraint 'anything)) :test #'equal)))

(test types-of-designators-may-be-symbolic
  "What is performed depends on where the cup is; each type is a path."
  (let ((steps (step-lists (explore-kitchen "
(def-top-level-cram-function kitchen-plan (?on-the-shelf)
  (let ((?type (find ?on-the-shelf '(t nil))) (?bowl (an object (type bowl))))
    (with-failure-handling ((navigation-low-level-failure () (return)))
      (perform (a motion (type detecting) (object ?bowl)))
      (let ((?type (if ?type :going :detecting)))
        (perform (a motion (type ?type) (target table) (object ?bowl)))))))"
                                            :constraint 'anything
                                            :arguments '((?on-the-shelf boolean))))))
    (is (member '((:success :detect :bowl) (:success :go :table)) steps :test #'equal))
    (is (member '((:success :detect :bowl) (:success :detect :bowl)) steps :test #'equal))))

(defparameter *generated-locations* "
(defun poses-at (designator)
  (case (desig-prop-value designator :on)
    (:shelf (list (make-pose 1 1 0)))
    (:table (list (make-pose 2 1 0) (make-pose 2 2 0)))))
(desig:register-location-generator 5 poses-at \"Poses on furniture.\")
(def-top-level-cram-function kitchen-plan ()
  (let* ((cup (perform (a motion (type detecting) (object (an object (type cup))))))
         (?place (desig-prop-value cup :location)))
    (when ?place
      (let* ((location (a location (on ?place)))
             (second (and (reference location) (next-solution location)))
             (?where (if (= 1 (pose-x (reference location))) :shelf :table)))
        (perform (an action (type dropping) (object bowl) (place ?where)))
        (when second
          (perform (an action (type dropping) (object cup) (place ?where))))))))")

(test location-generators-run-on-symbolic-designators
  "There is a second pose on the table, not on the shelf."
  (unwind-protect
       (is (alexandria:set-equal
            '(((:success :detect :cup)) ((:success :detect :cup) (:success :drop :bowl :shelf))
              ((:success :detect :cup) (:success :drop :bowl :table)
               (:success :drop :cup :table)))
            (step-lists (explore-kitchen *generated-locations* :constraint 'anything))
            :test #'equal))
    (discrepancy-finder.designators:delete-location-generator-function
     'discrepancy-finder-user::poses-at)))

;;; What is wrong

(defun define-in-kitchen (&rest clauses)
  (make-kitchen)
  (eval `(symbolic:define-action (motion testing) (?thing place)
           (:domain toy-kitchen) ,@clauses)))

(test clauses-are-checked-by-the-theory
  "Each sentence names the action, the clause and what was expected."
  (macrolet ((wrong ((&rest parts) &rest clauses)
               `(signals-with (symbolic:action-problem "motion testing" ,@parts)
                  (define-in-kitchen ,@(loop for clause in clauses collect `',clause)))))
    (wrong ("(:event (polish cup))" "no event polish") (:event (polish cup)))
    (wrong ("(:event (go cup))" "cup" "place") (:event (go cup)))
    (wrong ("go takes 1 argument, not 2") (:event (go table ?thing)))
    (wrong ("?other is neither a property") (:event (go ?other)))
    (wrong ("(robot-at table)" "no event robot-at") (:event (robot-at table)))
    (wrong ("(:requires (near table))" "near") (:event (go table)) (:requires (near table)))
    (wrong ("(:requires (go table))" "event") (:event (go table)) (:requires (go table)))
    (wrong ("location takes 2 arguments, not 1")
           (:event (go table)) (:requires (location cup)))
    (wrong ("(:requires (location cup cup))" "place")
           (:event (go table)) (:requires (location cup cup)))
    (wrong ("?x is neither a property") (:event (go table)) (:requires (location cup ?x)))
    (wrong ("no-such-failure is no plan failure")
           (:event (go table)) (:failure no-such-failure))
    (wrong ("no event polish")
           (:event (go table)) (:failure plan:plan-failure :event (polish cup)))
    (wrong ("near") (:event (go table)) (:failure plan:plan-failure :when (near table)))
    (wrong ("takes no initarg :speed")
           (:event (go table))
           (:failure plan:navigation-goal-not-reached :initargs (:speed 1)))
    (wrong ("(value-of (location cup shelf) ?place)" "?place must occur once")
           (:event (go table)) (:returns (symbolic:value-of (location cup shelf) ?place)))
    (wrong ("a variable such as ?place")
           (:event (go table)) (:returns (symbolic:value-of (location cup shelf) shelf)))
    (wrong ("near") (:event (go table)) (:returns (list (symbolic:truth-of (near table)))))))

(test clauses-have-shapes
  (flet ((expand (&rest clauses)
           (macroexpand-1 `(symbolic:define-action (motion testing) (place) (:domain toy-kitchen)
                             ,@clauses))))
    (signals-with (plan:malformed-plan-form "exactly one clause (:event") (expand))
    (signals-with (plan:malformed-plan-form "exactly one clause (:event")
      (expand '(:event (go place)) '(:event (go place))))
    (signals-with (plan:malformed-plan-form "at most one clause (:returns")
      (expand '(:event (go place)) '(:returns 1) '(:returns 2)))
    (signals-with (plan:malformed-plan-form "EVENT GO" "one thing after :event")
      (expand '(:event go)))
    (signals-with (plan:malformed-plan-form "one thing after :failure" ":when formula")
      (expand '(:event (go place)) '(:failure plan:plan-failure :unless (blocked place))))
    (signals-with (plan:malformed-plan-form "one thing after :requires")
      (expand '(:event (go place)) '(:requires))))
  (signals-with (plan:malformed-plan-form "(motion type) or (action type)")
    (macroexpand-1 '(symbolic:define-action (object cup) () (:domain toy-kitchen))))
  (signals-with (plan:malformed-plan-form "a list of variables, the properties, each once")
    (macroexpand-1 '(symbolic:define-action (motion testing) (:place) (:domain toy-kitchen)))))

(test errors-in-bindings-name-file-and-line
  (make-kitchen)
  (with-file (file "
(define-action (motion testing) (place)
  (:domain toy-kitchen)
  (:event (go place))
  (:requires (near place)))")
    (signals-with (symbolic:action-problem
                   ":5: The action motion testing, (:requires (near place))")
      (plan:load-plan file))))

(test what-is-computed-is-checked-when-it-is-performed
  (signals-with (symbolic:action-problem "(a motion (type going) (target cup))" "(go cup)"
                                         "kitchen-plan")
    (explore-kitchen "(def-top-level-cram-function kitchen-plan ()
  (perform (a motion (type going) (target cup))))" :constraint 'anything))
  (signals-with (symbolic:action-problem "?target" "no element")
    (explore-kitchen "(def-top-level-cram-function kitchen-plan ()
  (perform (a motion (type going) (target \"table\"))))" :constraint 'anything)))

(test region-of-and-its-kin-stand-in-define-action-only
  (signals-with (plan:malformed-plan-form "an enclosing define-action")
    (macroexpand-1 '(symbolic:value-of (location cup ?place) ?place)))
  (signals-with (plan:malformed-plan-form "an enclosing define-action")
    (macroexpand-1 '(symbolic:truth-of (detected cup)))))
