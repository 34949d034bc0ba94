;;;; What CHECK-THEORY finds, and that it finds nothing where nothing is wrong.

(in-package #:discrepancy-finder.tests)

(def-suite findings :in all)
(in-suite findings)

(defun finding-keys (findings)
  "Return (severity kind subject) of each of FINDINGS."
  (mapcar (lambda (finding)
            (list (ec:finding-severity finding) (ec:finding-kind finding)
                  (ec:finding-subject finding)))
          findings))

(defun check-findings (theory expected horizon)
  (let* ((findings (ec:check-theory theory :horizon horizon)) (found (finding-keys findings)))
    (is (null (set-exclusive-or expected found :test #'equal))
        "expected ~s, found ~s" expected found)
    (is (null (mismatch expected found :test #'equal))
        "in another order: expected ~s, found ~s" expected found)
    (dolist (finding findings findings)
      (is (null (find #\Newline (princ-to-string finding))))
      (is (string/= "" (ec:finding-text finding))))))

(defmacro finds ((&rest expected) &body clauses)
  "Check that CHECK-THEORY finds EXPECTED, each (severity kind subject), in the theory with CLAUSES,
and return the findings."
  `(check-findings (inline-theory ,@clauses) ',expected nil))

(defun finding-words (finding &rest parts)
  (dolist (part parts)
    (is (search part (ec:finding-text finding)) "~s is not in: ~a" part
        (ec:finding-text finding))))

;;; A theory in which nothing is wrong, and its variations

(defmacro lamp-finds ((&rest expected) &body clauses)
  "Check what is found in the theory of a lamp, where nothing is wrong, with CLAUSES."
  `(finds ,expected
     (:fluents (lit) (plugged-in))
     (:events (switch) (plug) (unplug))
     (:axioms (dark-at-first (initially (not (lit))))
              (plugged-at-first (initially (plugged-in)))
              (switching-on (implies (and (holds-at (plugged-in) ?time)
                                          (not (holds-at (lit) ?time)))
                                     (initiates (switch) (lit) ?time)))
              (switching-off (implies (holds-at (lit) ?time) (terminates (switch) (lit) ?time)))
              (plugging (initiates (plug) (plugged-in) ?time))
              (unplugging (terminates (unplug) (plugged-in) ?time))
              (unplugged-is-dark (terminates (unplug) (lit) ?time)))
     ,@clauses))

(test nothing-is-wrong
  (lamp-finds ())
  (lamp-finds () (:time 2 4))
  (lamp-finds () (:narrative (happens (switch) 0)) (:completion happens) (:time 0 4))
  (finds ()))

(test inconsistent-theories
  (let ((finding (first (lamp-finds ((:error :inconsistent :inline))
                          (:axioms (wrong (holds-at (lit) 0)))))))
    (finding-words finding "no model" "dark-at-first" "wrong" "contradict"))
  (let ((finding (first (finds ((:error :inconsistent :inline))
                          (:predicates (p)) (:axioms (never (or))) (:time 0 0)))))
    (finding-words finding "no model" "never")))

(test vacuous-axioms
  (let ((finding (first (lamp-finds ((:warning :vacuous-axiom :odd))
                          (:axioms (odd (implies (and (holds-at (lit) ?time)
                                                      (not (holds-at (plugged-in) ?time)))
                                                 (terminates (switch) (plugged-in) ?time))))))))
    (finding-words finding "odd" "(holds-at (lit) ?time)" "0 to 3"))
  (lamp-finds ((:warning :vacuous-axiom :odd))
    (:axioms (odd (implies (and (happens (switch) ?time) (happens (switch) (- ?time 17)))
                           (holds-at (plugged-in) ?time)))))
  ;; What only compares elements is no condition of a state.
  (lamp-finds ()
    (:sorts (side left right))
    (:axioms (different (implies (= ?side1 ?side2)
                                 (not (and (happens (plug) ?time) (happens (unplug) ?time)))))))
  (finds ((:warning :vacuous-axiom :fall))
    (:fluents (up) (down)) (:events (rise))
    (:axioms (initially (not (up))) (initially (not (down)))
             (initiates (rise) (up) ?time)
             (fall (implies (and (holds-at (up) ?time) (not (holds-at (up) ?time)))
                            (trajectory (up) ?time (down) ?offset)))
             (initiates (rise) (down) ?time)
             (implies (holds-at (down) ?time) (holds-at (up) ?time)))))

(test impossible-events
  (let ((findings (lamp-finds ((:warning :vacuous-axiom :breaking)
                               (:warning :vacuous-axiom :breaks-only-without-plug)
                               (:warning :impossible-event :break))
                    (:events (break))
                    (:axioms (breaking (terminates (break) (lit) ?time))
                             (breaks-only-without-plug
                              (implies (happens (break) ?time)
                                       (and (holds-at (lit) ?time)
                                            (not (holds-at (plugged-in) ?time)))))))))
    (finding-words (third findings) "break" "never" "0 to 3"))
  ;; What an axiom triggers happens if it ever applies.
  (lamp-finds ()
    (:events (beep)) (:fluents (beeped))
    (:axioms (initially (not (beeped)))
             (initiates (beep) (beeped) ?time)
             (beeping (implies (and (holds-at (lit) ?time) (not (holds-at (beeped) ?time)))
                               (happens (beep) ?time))))
    (:completion happens))
  (finds ((:warning :vacuous-axiom :|2|) (:warning :vacuous-axiom :clash)
          (:warning :impossible-event :e) (:note :constant-fluent :f) (:note :unread-fluent :f))
    (:fluents (f)) (:events (e))
    (:axioms (initially (f)) (initiates (e) (f) ?time) (clash (terminates (e) (f) ?time)))))

(test events-without-effect
  (let ((finding (first (lamp-finds ((:warning :missing-effect :wave))
                          (:events (wave))
                          (:axioms (implies (happens (wave) ?time)
                                            (holds-at (lit) ?time)))))))
    (finding-words finding "wave" "changes nothing"))
  ;; An effect on numbers, a trajectory's condition or another event is something, too.
  (lamp-finds ()
    (:events (wave) (charge) (answer))
    (:numeric-fluents (battery))
    (:axioms (assigns (charge) (battery) (+ 1 (value-at (battery) ?time)) ?time)
             (implies (happens (wave) ?time) (happens (answer) ?time))
             (implies (< (value-at (battery) ?time) 3)
                      (initiates (answer) (lit) ?time)))
    (:facts (= (value-at (battery) 0) 1))))

(test constant-unread-and-open-fluents
  (let ((findings (lamp-finds ((:note :constant-fluent :heavy) (:note :unread-fluent :heavy)
                               (:note :unconstrained-fluent :heavy))
                    (:fluents (heavy)))))
    (finding-words (first findings) "heavy" "change")
    (finding-words (second findings) "heavy" "reads")
    (finding-words (third findings) "(heavy)" "true or false at 0"))
  (lamp-finds ((:note :unread-fluent :dusty) (:note :unconstrained-fluent :dusty))
    (:fluents (dusty)) (:events (sweep)) (:axioms (terminates (sweep) (dusty) ?time)))
  (lamp-finds ((:note :unread-fluent :dusty))
    (:fluents (dusty)) (:events (sweep)) (:axioms (terminates (sweep) (dusty) ?time))
    (:facts (holds-at (dusty) 0)))
  ;; Of many atoms only the first are named.
  (let ((finding (first (last (lamp-finds ((:note :unread-fluent :at)
                                           (:note :unconstrained-fluent :at))
                                (:sorts (place (:range 1 9))) (:fluents (at place))
                                (:events (go place)) (:axioms (initiates (go ?place) (at ?place)
                                                                         ?time)))))))
    (finding-words finding "(at 1), (at 2), (at 3)" "6 more"))
  ;; A constraint may fix what nothing says directly.
  (lamp-finds ()
    (:non-inertial-fluents (dark))
    (:axioms (iff (holds-at (dark) ?time) (not (holds-at (lit) ?time))))))

(test read-by-a-state-constraint
  (with-file (file "(define-theory lamp (:fluents (lit)) (:events (switch))
  (:axioms (initially (not (lit))) (initiates (switch) (lit) ?time)))
(define-state-constraint lamp-lit (?time) (holds-at (lit) ?time))")
    (is (null (ec:check-theory (ec:load-theory file))))))

(test completion-without-sentences
  (let ((finding (first (finds ((:note :empty-completion :ab))
                          (:predicates (ab)) (:completion (theta ab))
                          (:fluents (on)) (:events (switch))
                          (:axioms (initially (not (on)))
                                   (implies (and (not (ab)) (not (holds-at (on) ?time)))
                                            (initiates (switch) (on) ?time)))))))
    (finding-words finding "theta" "ab")))

;;; Horizons

(test never-means-within-the-horizon
  "A bell that rings after five steps only."
  (flet ((bell (horizon expected)
           (check-findings
            (ec::parse-theory 'bell
                              '((:sorts (count (:range 0 6)))
                                (:fluents (counted count) (rung)) (:events (tick) (ring))
                                (:axioms (initially (iff (counted ?count) (= ?count 0)))
                                         (initially (not (rung)))
                                         (implies (holds-at (counted ?count) ?time)
                                                  (initiates (tick) (counted (+ ?count 1)) ?time))
                                         (implies (holds-at (counted ?count) ?time)
                                                  (terminates (tick) (counted ?count) ?time))
                                         (initiates (ring) (rung) ?time)
                                         (implies (happens (ring) ?time)
                                                  (and (holds-at (counted 5) ?time)
                                                       (not (holds-at (rung) ?time)))))))
            expected horizon)))
    (bell 7 '())
    (let ((findings (bell 3 '((:warning :vacuous-axiom :|5|) (:warning :vacuous-axiom :|6|)
                              (:warning :impossible-event :ring)
                              (:note :constant-fluent :rung)))))
      (dolist (finding findings)
        (finding-words finding "0 to 3")))))

(test horizons-of-checks
  (let ((theory (inline-theory (:fluents (f)))))
    (is (= 3 (length (ec:check-theory theory))))
    (is (= 3 (length (ec:check-theory theory :horizon '(2 4)))))
    (signals-with (ec:no-horizon "-1") (ec:check-theory theory :horizon -1))
    (signals-with (ec:theory-not-found "no-such-theory") (ec:check-theory 'no-such-theory))))

;;; Positions

(test findings-have-positions
  (with-file (file "(define-theory odd
  (:fluents (f))
  (:events (e)
           (idle))
  (:axioms
   (initially (not (f)))
   (initiates (e) (f) ?time)
   (vacuous
    (implies (and (holds-at (f) ?time) (not (holds-at (f) ?time)))
             (terminates (e) (f) ?time)))))")
    (let ((findings (ec:check-theory (ec:load-theory file))))
      (is (equal '((:warning :vacuous-axiom :vacuous) (:warning :missing-effect :idle))
                 (finding-keys findings)))
      (is (string= (format nil "~a:8" file)
                   (princ-to-string (ec:finding-position (first findings)))))
      (is (uiop:string-prefix-p (format nil "~a:8: warning: axiom vacuous" file)
                                (princ-to-string (first findings))))
      (is (uiop:string-prefix-p (format nil "~a:4: warning: the event idle" file)
                                (princ-to-string (second findings))))))
  (with-file (file "(define-theory wrong (:fluents (f))
 (:axioms (a (initially (f)))
          (b (initially (not (f))))))")
    (is (uiop:string-prefix-p (format nil "~a:2: error: " file)
                              (princ-to-string (first (ec:check-theory (ec:load-theory file))))))))

;;; Good theories

(test the-models-of-the-domains-are-sound
  (is (null (ec:check-theory (ec:load-theory (root-file "models/two-regions/theory.lisp")))))
  (is (equal '((:note :constant-fluent :cereal-on) (:note :constant-fluent :cup-on)
               (:note :unconstrained-fluent :cereal-on))
             (finding-keys (ec:check-theory
                            (ec:load-theory (root-file "models/table-top/theory.lisp")))))
      "nobody carries anything there, and the cereal can be on either side"))

(defun happened-events (models)
  "Return the names of the events that happen in one of MODELS."
  (remove-duplicates
   (loop for model in models
         append (destructuring-bind (first . last) (ec:model-horizon model)
                  (loop for time from first below last
                        append (mapcar #'first (ec:model-events model time)))))))

(defun changed-fluents (models)
  "Return the names of the fluents that change in one of MODELS."
  (remove-duplicates
   (loop for model in models
         append (destructuring-bind (first . last) (ec:model-horizon model)
                  (loop for time from first below last
                        append (mapcar #'first
                                       (set-exclusive-or (ec:model-fluents model time)
                                                         (ec:model-fluents model (1+ time))
                                                         :test #'equal)))))))

(defun false-alarms (theory)
  "Return the findings that the models of THEORY refute."
  (let ((models (ec:models theory)))
    (remove-if-not (lambda (finding)
                     (member (ec:finding-subject finding)
                             (case (ec:finding-kind finding)
                               (:impossible-event (happened-events models))
                               (:constant-fluent (changed-fluents models)))))
                   (ec:check-theory theory))))

(test what-happens-in-a-model-is-not-called-impossible
  (dolist (file (uiop:directory-files (root-file "tests/theories/") "*.lisp"))
    (unless (string= (pathname-name file) "hungry-cat")
      (let ((theory (ec:load-theory file)))
        (is (equal '() (mapcar #'princ-to-string (false-alarms theory))) "~a" file)
        (is (eq (ec:consistent-p theory)
                (not (find :error (ec:check-theory theory) :key #'ec:finding-severity)))
            "~a" file)))))

(test good-scenarios-have-at-most-notes
  "What is warned of in these files is really so: their docstrings say it."
  (dolist (name '("shanahan-circuit" "kitchen-sink" "bank-account-service-fee" "monkey-planning"
                  "stolen-car" "stuffy-room" "telephone" "falling-object" "happy"
                  "carrying-a-book-1" "zoo-one-step" "bus-ride"))
    (let ((findings (ec:check-theory
                     (ec:load-theory (root-file (format nil "tests/theories/~a.lisp" name))))))
      (is (null (remove :note findings :key #'ec:finding-severity)) "~a: ~a" name findings))))

(test axioms-without-instances
  "Each instance has a member of another sort in a place, or a time that is not there."
  (let ((findings (ec:check-theory (ec:parse-e-text "sort agent
sort room
agent A
room B
predicate In(agent,room)
[agent] In(agent,B).
In(A,A).
range time 0 1"))))
    (is (equal '((:warning :no-instance))
               (mapcar (lambda (finding)
                         (list (ec:finding-severity finding) (ec:finding-kind finding)))
                       findings)))
    (finding-words (first findings) "text:7 says nothing")))
