;;;; Which traces an exploration hands out, and traces as values.

(in-package #:discrepancy-finder.tests)

(def-suite traces :in all)
(in-suite traces)

(defun trace-summaries (exploration)
  "Return the initial fluents, the events and the arguments of each trace."
  (loop for trace in (symbolic:exploration-traces exploration)
        collect (list (ec:state-fluents (symbolic:trace-initial-state trace))
                      (mapcar #'symbolic:step-event (symbolic:trace-steps trace))
                      (symbolic:trace-arguments trace))))

(defun summaries-of (text &rest options)
  (trace-summaries (apply #'explore-text text options)))

(defparameter *toggle-twice* "
(def-top-level-cram-function lamp-plan ()
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (perform (a motion (type toggling) (lamp a)))
    (perform (a motion (type smashing) (lamp b)))
    (perform (a motion (type toggling) (lamp a)))))")

;;; Rules

(test every-instance-is-a-trace
  (is (equal '((() ((:toggle :a)) ()))
             (remove-if-not (lambda (summary) (= 1 (length (second summary))))
                            (summaries-of *toggle-twice* :constraint 'lamp-a-lit
                                                         :traces :every-instance))))
  (is (equal '((() ((:toggle :a)) ())
               (((:lit :a)) ((:toggle :a) (:smash :b) (:toggle :a)) ()))
             (summaries-of *toggle-twice* :constraint 'lamp-a-lit :traces :every-instance)))
  (is (equal '((((:lit :a)) ((:toggle :a) (:smash :b) (:toggle :a)) ()))
             (summaries-of *toggle-twice* :constraint 'lamp-a-lit))
      "by default one trace a path"))

(test any-action-ends-a-trace
  (let ((summaries (summaries-of *toggle-twice* :constraint :any-action)))
    (is (equal '(((:toggle :a))
                 ((:toggle :a) (:smash :b))
                 ((:toggle :a) (:smash :b) (:toggle :a))
                 ((:smash :a)))
               (mapcar #'second summaries)))))

(test the-first-instance-is-the-only-one-of-its-path
  "Both paths begin with a step, of which the first path gives the trace."
  (is (equal '(((:toggle :a)) ((:smash :a)))
             (mapcar #'second (summaries-of *toggle-twice* :constraint :any-action
                                                           :traces :first-instance))))
  (is (equal '(((:smash :b)))
             (mapcar #'second (summaries-of "
(def-top-level-cram-function lamp-plan ()
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (perform (a motion (type smashing) (lamp b)))
    (perform (a motion (type toggling) (lamp a)))))"
                                            :constraint :any-action :traces :first-instance)))
      "a path whose first instance an earlier one had gives none"))

(test every-state-is-a-trace
  "Of the nine states of two lamps a is broken in three; lit by the first toggle it is dark."
  (let* ((text "
(def-top-level-cram-function lamp-plan ()
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (perform (a motion (type toggling) (lamp a)))))")
         (states (mapcar #'first (summaries-of text :constraint 'lamp-a-lit
                                                    :traces :every-state))))
    (is (equal '(() ((:broken :b)) ((:lit :b))) states) "the least first")
    (is (= 9 (length (summaries-of text :constraint '(exists (?lamp)
                                                      (or (happens (toggle ?lamp) ?time)
                                                       (happens (smash ?lamp) ?time)))
                                        :traces :every-state))))))

(test every-state-has-its-own-last-instance
  "Dark lamps are lit after the first toggle, lit ones after the second."
  (is (null (set-exclusive-or
             '((() 1) (((:broken :b)) 1) (((:lit :b)) 1)
               (((:lit :a)) 3) (((:lit :a) (:broken :b)) 3) (((:lit :a) (:lit :b)) 3))
             (loop for (initial events) in (summaries-of *toggle-twice* :constraint 'lamp-a-lit
                                                                        :traces :every-state)
                   collect (list initial (length events)))
             :test #'equal))))

(test states-come-on-demand
  (make-lamp-domain)
  (with-file (file *toggle-twice*)
    (plan:load-plan file)
    (let ((exploration (symbolic:make-exploration 'discrepancy-finder-user::lamp-plan :lamps
                                                  :constraint 'lamp-a-lit
                                                  :traces :every-state)))
      (unwind-protect
           (progn
             (is-true (symbolic:next-trace exploration))
             (is (= 1 (symbolic:exploration-paths exploration)))
             (is-false (symbolic:exploration-complete-p exploration))
             (is (= 5 (loop while (symbolic:next-trace exploration) count t)))
             (is-true (symbolic:exploration-complete-p exploration)))
        (symbolic:close-exploration exploration)))))

(test constraints-may-be-written-in-the-call
  (is (equal (summaries-of *toggle-twice* :constraint 'lamp-a-lit)
             (summaries-of *toggle-twice* :constraint '(and (happens (toggle a) ?time)
                                                        (holds-at (lit a) (+ ?time 1))))))
  (is (equal '((((:lit :a)) ((:toggle :a) (:smash :b) (:toggle :a)) ()))
             (summaries-of *toggle-twice*
                           :constraint '(and (holds-at (lit a) ?time)
                                         (not (holds-at (lit a) (+ ?time 1)))
                                         (not (holds-at (lit a) (+ ?time 2)))
                                         (holds-at (lit a) (+ ?time 3)))))
      "several timepoints")
  (signals-with (ec:theory-error "shine") 
    (explore-text *toggle-twice* :constraint '(holds-at (shine a) ?time))))

(test no-trace-twice
  "Which way the first decision goes makes no difference to anyone."
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan ()
  (let ((seen (perform (a motion (type peeping) (lamp b)))))
    (if seen 1 2)
    (perform (a motion (type smashing) (lamp a)))))
(define-action (motion peeping) (lamp)
  (:domain lamps) (:event (smash lamp)) (:returns (truth-of (lit a))))"
                                   :constraint 'anything)))
    (is (= 2 (symbolic:exploration-paths exploration)))
    (is (= 2 (length (symbolic:exploration-traces exploration)))))
  (is (= 1 (length (summaries-of "
(def-top-level-cram-function lamp-plan (?one)
  (perform (a motion (type smashing) (lamp a)))
  (if ?one (print 1) (print 2)))"
                                 :constraint 'anything :arguments '((?one boolean))
                                 :traces :every-instance)))
      "the same prefix of two paths"))

;;; Arguments

(test arguments-of-all-types-have-least-values
  (is (equal '((() ((:toggle :a)) (:a 0 nil 2)))
             (summaries-of "
(def-top-level-cram-function lamp-plan (?lamp ?n ?flag ?m)
  (declare (ignore ?n))
  (when (and (< 1 ?m) (not ?flag))
    (perform (a motion (type toggling) (lamp ?lamp)))))"
                           :constraint 'lamp-a-lit
                           :arguments '((?lamp lamp) (?n (integer -2 3)) (?flag boolean)
                                        (?m (integer 0 9)))))))

(test optional-and-keyword-arguments
  (let ((text "
(def-top-level-cram-function lamp-plan (?one &optional (?two :none) &key ?three (?four :none))
  (format t \"~a ~a ~a ~a\" (if ?one 1 0) (case ?two ((t nil) 2) (t ?two)) (if ?three 1 0) ?four)
  (perform (a motion (type smashing) (lamp a))))"))
    (is (equal '("1 2 1 NONE" "1 2 0 NONE")
               (subseq (mapcar #'symbolic:trace-output
                               (symbolic:exploration-traces
                                (explore-text text :constraint 'anything
                                                   :arguments '((?three boolean) (?two boolean)
                                                                (?one boolean)))))
                       0 2)))
    (is (equal '(t t :?three t)
               (third (first (summaries-of text :constraint 'anything
                                                :arguments '((?one boolean) (?two boolean)
                                                             (?three boolean)))))))
    (signals-with (symbolic:unsupported-form "got none for ?two")
      (explore-text text :constraint 'anything
                         :arguments '((?one boolean) (?three boolean))))
    (is (equal '("1 NONE 0 NONE" "0 NONE 0 NONE")
               (mapcar #'symbolic:trace-output
                       (symbolic:exploration-traces
                        (explore-text text :constraint 'anything
                                           :arguments '((?one boolean)))))))
    (signals-with (symbolic:unsupported-form "LAMP-PLAN" "none for" "?one")
      (explore-text text :constraint 'anything :arguments '((?two boolean))))
    (signals-with (symbolic:unsupported-form "LAMP-PLAN" "no parameter" "?five")
      (explore-text text :constraint 'anything :arguments '((?one boolean) (?five boolean))))))

;;; Traces as values

(defparameter *deciding-plan* "
(def-top-level-cram-function lamp-plan (?lamp ?n)
  (princ \"hello\")
  (if (< ?n 2)
      (perform (a motion (type smashing) (lamp ?lamp)))
      (print 2))
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (perform (a motion (type toggling) (lamp a)))))")

(defun deciding-traces ()
  (symbolic:exploration-traces
   (explore-text *deciding-plan* :constraint :any-action
                                 :arguments '((?lamp lamp) (?n (integer 0 3))))))

(test decisions-have-their-places
  (let* ((trace (first (last (deciding-traces))))
         (decisions (symbolic:trace-decisions trace)))
    (is-true decisions)
    (let ((first (first decisions)))
      (is (search ":4: (if" (symbolic:taken-text first)) "~s" first)
      (is (equal "NIL" (symbolic:taken-choice first)))
      (is (= 0 (symbolic:taken-time first))))
    (is (every #'source:source-position-line
               (mapcar #'symbolic:step-position (symbolic:trace-steps trace))))
    (is (search "hello" (symbolic:trace-output trace)))
    (is (eq :finished (symbolic:trace-ending trace)))))

(test traces-go-through-json
  (let ((traces (deciding-traces)))
    (is (< 3 (length traces)))
    (dolist (trace traces)
      (let* ((text (symbolic:trace-to-json trace))
             (copy (symbolic:trace-from-json text :lamps)))
        (is (symbolic:trace= trace copy))
        (is (equal text (symbolic:trace-to-json copy)))
        (is (equal (mapcar #'ec:state-fluents (symbolic:trace-states trace))
                   (mapcar #'ec:state-fluents (symbolic:trace-states copy))))))
    (is (= (length traces) (length (remove-duplicates traces :test #'symbolic:trace=))))))

(test open-states-go-through-json
  "What a toss has given is in the text, although the theory does not say."
  (dolist (trace (symbolic:exploration-traces (explore-coins 'coin-paid "
(def-top-level-cram-function coin-plan ()
  (perform (a motion (type tossing) (coin c1)))
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (perform (a motion (type paying) (coin c1)))))")))
    (let ((copy (symbolic:trace-from-json (symbolic:trace-to-json trace) :coins)))
      (is (equal (mapcar #'ec:state-fluents (symbolic:trace-states trace))
                 (mapcar #'ec:state-fluents (symbolic:trace-states copy)))))))

(test arguments-go-through-json
  (dolist (argument '(t nil 0 -17 1/3 :cup car "text"))
    (is (equal argument (symbolic:argument-from-json
                         (json:parse (json:encode (symbolic:argument-to-json argument)))))))
  (signals symbolic:invalid-trace (symbolic:argument-to-json '(1 2)))
  (signals symbolic:invalid-trace (symbolic:argument-from-json :null)))

(test texts-that-are-no-traces-are-refused
  (let ((text (symbolic:trace-to-json (first (deciding-traces)))))
    (flet ((changed (old new)
             (is (search old text) "~s" old)
             (symbolic:trace-from-json (replaced text old new) :lamps)))
      (signals json:json-error (symbolic:trace-from-json "{" :lamps))
      (signals-with (symbolic:invalid-trace "format") (changed "trace 1" "trace 99"))
      (signals-with (symbolic:invalid-trace "no event (crash a)")
        (changed "\"(smash a)\"" "\"(crash a)\""))
      (signals-with (symbolic:invalid-trace "does not allow" "step 1")
        (changed "\"(broken a)\"" "\"(broken b)\""))
      (signals-with (symbolic:invalid-trace "no symbol NO-SUCH")
        (changed "\"LAMP-PLAN\"" "\"NO-SUCH\""))
      (is (null (find-symbol "NO-SUCH" '#:discrepancy-finder-user))))))

(test designators-of-steps-show-what-was-decided
  (is (equal '(("(a motion (type smashing) (lamp a))") ("(a motion (type smashing) (lamp b))"))
             (loop for trace in (symbolic:exploration-traces
                                 (explore-text "
(def-top-level-cram-function lamp-plan (?lamp)
  (perform (a motion (type smashing) (lamp ?lamp))))"
                                               :constraint 'anything :arguments '((?lamp lamp))))
                   collect (mapcar #'symbolic:step-designator (symbolic:trace-steps trace))))))
