;;;; Explanations: the sentences of a theory that a claim rests on, and the derivation in words.
;;;;
;;;; EXPLAINS checks a claim of a theory whose axioms all have names: the explanation names those
;;;; that are expected, the claim does not follow without any one of them, and it follows from them
;;;; alone.  The words are checked for the commonest reasons.

(in-package #:discrepancy-finder.tests)

(def-suite why :in all)
(in-suite why)

(defun named-axioms (clauses)
  "Return the names of the axioms in CLAUSES, in order."
  (loop for (key . entries) in clauses
        when (member key '(:axioms :facts :narrative)) append (mapcar #'first entries)))

(defun without-axioms (clauses names)
  "Return CLAUSES without the axioms that have one of NAMES."
  (loop for (key . entries) in clauses
        collect (cons key (if (member key '(:axioms :facts :narrative))
                              (remove-if (lambda (entry) (member (first entry) names)) entries)
                              entries))))

(defun follows-p (clauses formula)
  "Return true if FORMULA is true in all models of the theory with CLAUSES; NIL stands for a
contradiction."
  (let ((theory (ec::parse-theory 'inline clauses)))
    (if formula
        (nth-value 0 (ec:entailed-p theory formula))
        (not (ec:consistent-p theory)))))

(defun explanation-of (clauses formula)
  (let ((theory (ec::parse-theory 'inline clauses)))
    (if formula (ec:why theory formula) (ec:why-inconsistent theory))))

(defun same-names-p (names others)
  (null (set-exclusive-or names others :test #'string=)))

(defun check-explanation (clauses formula expected)
  (let* ((explanation (explanation-of clauses formula))
         (named (and explanation (ec:explanation-axioms explanation)))
         (needed (remove-if-not (lambda (name) (member name named :test #'string=))
                                (named-axioms clauses))))
    (is-true explanation "~a is not explained" formula)
    (is (same-names-p expected named) "~a rests on ~a, not on ~a" formula expected named)
    (is (= (length needed) (length named)) "~a are no axioms of the theory" named)
    (dolist (name needed)
      (is-false (follows-p (without-axioms clauses (list name)) formula)
                "~a follows without ~a" formula name))
    (is-true (follows-p (without-axioms clauses (set-difference (named-axioms clauses) needed))
                        formula)
             "~a does not follow from ~a alone" formula needed)
    explanation))

(defmacro explains (clauses formula &rest expected)
  "Check that the explanation of FORMULA in the theory with CLAUSES rests on the axioms EXPECTED."
  `(check-explanation ,clauses ',formula ',expected))

(defun says (explanation &rest parts)
  "Check that each of PARTS is in one of the sentences of EXPLANATION, a line each."
  (let ((sentences (and explanation (ec:explanation-sentences explanation))))
    (dolist (sentence sentences)
      (is (char= #\. (char sentence (1- (length sentence)))) "no full stop: ~a" sentence)
      (is (null (find #\Newline sentence)) "several lines: ~a" sentence))
    (dolist (part parts)
      (is (some (lambda (sentence) (search part sentence)) sentences)
          "~s is in none of~{~%  ~a~}" part sentences))))

(defun does-not-say (explanation &rest parts)
  (dolist (part parts)
    (is (notany (lambda (sentence) (search part sentence)) (ec:explanation-sentences explanation))
        "~s is in~{~%  ~a~}" part (ec:explanation-sentences explanation))))

;;; One robot and one box

(defparameter *box*
  '((:sorts (region r1 r2))
    (:fluents (holding-box) (robot-in region) (box-in region) (dusty))
    (:events (pick-up) (put-down) (move region) (sweep))
    (:axioms (pick-up-holds (initiates (pick-up) (holding-box) ?time))
             (put-down-frees (terminates (put-down) (holding-box) ?time))
             (move-arrives (initiates (move ?region) (robot-in ?region) ?time))
             (move-leaves (implies (/= ?region1 ?region2)
                                   (terminates (move ?region1) (robot-in ?region2) ?time)))
             (box-carried (implies (holds-at (holding-box) ?time)
                                   (initiates (move ?region) (box-in ?region) ?time)))
             (box-taken-away (implies (and (holds-at (holding-box) ?time) (/= ?region1 ?region2))
                                      (terminates (move ?region1) (box-in ?region2) ?time)))
             (pick-up-here (implies (and (happens (pick-up) ?time)
                                         (holds-at (robot-in ?region) ?time))
                                    (holds-at (box-in ?region) ?time)))
             (sweep-cleans (terminates (sweep) (dusty) ?time)))
    (:facts (robot-at-first (holds-at (robot-in r1) 0)) (not-in-r2 (not (holds-at (robot-in r2) 0)))
            (box-at-first (holds-at (box-in r1) 0)) (box-not-in-r2 (not (holds-at (box-in r2) 0)))
            (empty-hand (not (holds-at (holding-box) 0))) (dust (holds-at (dusty) 0)))
    (:time 0 6))
  "A robot that can carry a box.  Nothing is said of what happens.")

(defun box (&rest narrative)
  "Return the clauses of the box with a NARRATIVE of (name event time), and nothing else happening."
  (append *box*
          (list (cons :narrative (loop for (name event time) in narrative
                                       collect `(,name (happens ,event ,time)))))
          '((:completion happens))))

(test an-effect
  "The example of what an explanation is to say."
  (let ((explanation (explains (box '(picked (pick-up) 2)) (holds-at (holding-box) 3)
                       picked pick-up-holds)))
    (says explanation "(holding-box) is true at 3 because (pick-up) initiates" "at 2 "
          "(axiom pick-up-holds)" "and nothing terminates it"
          "(pick-up) happens at 2 because of axiom picked")
    (is (= 2 (length (ec:explanation-sentences explanation))))))

(test persistence
  (let ((explanation (explains (box '(picked (pick-up) 0)) (holds-at (holding-box) 5)
                       picked pick-up-holds)))
    (says explanation "(holding-box) is true at 5 because (pick-up) initiates" "at 0 "
          "and nothing terminates it")
    (is (= 2 (length (ec:explanation-sentences explanation)))
        "the timepoints between are not told one by one"))
  (says (explains (box) (not (holds-at (holding-box) 6)) empty-hand)
        "(holding-box) is false at 6 because" "at 0" "axiom empty-hand" "and nothing initiates it")
  (says (explains (box) (holds-at (dusty) 4) dust)
        "(dusty) is true at 4 because" "at 0" "axiom dust" "nothing terminates it"))

(test conditional-effects
  (let ((explanation (explains (box '(picked (pick-up) 0) '(moved (move r2) 1))
                         (holds-at (box-in r2) 2)
                       picked pick-up-holds moved box-carried)))
    (says explanation "(box-in r2) is true at 2 because (move r2) initiates" "(axiom box-carried)"
          "(holding-box) is true at 1"))
  (explains (box '(picked (pick-up) 0) '(moved (move r2) 1) '(put (put-down) 3))
      (holds-at (box-in r2) 6)
    picked pick-up-holds moved box-carried)
  (explains (box '(moved (move r2) 1)) (holds-at (box-in r1) 3) box-at-first empty-hand))

(test what-is-terminated
  (says (explains (box '(picked (pick-up) 0) '(put (put-down) 2)) (not (holds-at (holding-box) 4))
          put put-down-frees)
        "(put-down) terminates" "at 2 " "nothing initiates it")
  (explains (box '(moved (move r2) 3)) (not (holds-at (robot-in r1) 5)) moved move-leaves))

;;; One feature at a time

(test preconditions
  (let ((explanation
          (explains '((:fluents (door-open)) (:events (leave) (open) (wave))
                      (:axioms (must-be-open (implies (happens (leave) ?time)
                                                      (holds-at (door-open) ?time)))
                               (opening (initiates (open) (door-open) ?time))
                               (never-at-first (not (happens (open) 0))))
                      (:facts (shut (not (holds-at (door-open) 0))))
                      (:time 0 3))
              (not (happens (leave) 1))
            must-be-open never-at-first shut)))
    (says explanation "(leave) does not happen at 1 because (door-open) is false at 1"
          "axiom must-be-open"
          "(door-open) is false at 1 because (door-open) is false at 0"
          "since (open) does not happen at 0")))

(test triggers
  (let ((explanation
          (explains '((:fluents (hot) (running)) (:events (heat) (start) (stop))
                      (:axioms (heating (initiates (heat) (hot) ?time))
                               (starting (initiates (start) (running) ?time))
                               (fan (implies (and (holds-at (hot) ?time)
                                                  (not (holds-at (running) ?time)))
                                             (happens (start) ?time))))
                      (:facts (cold (not (holds-at (hot) 0))) (off (not (holds-at (running) 0))))
                      (:narrative (heated (happens (heat) 0)))
                      (:completion happens) (:time 0 4))
              (happens (start) 1)
            heating heated cold off fan)))
    (says explanation "(start) happens at 1 because" "(hot) is true at 1" "(axiom fan)"
          "(running) is false at 1 because (running) is false at 0"
          "since (start) does not happen at 0")))

(test state-constraints-in-explanations
  (says (explains '((:sorts (place hall garden)) (:non-inertial-fluents (outside))
                    (:fluents (at place)) (:events (go place))
                    (:axioms (arriving (initiates (go ?place) (at ?place) ?time))
                             (one-place (implies (and (holds-at (at ?place1) ?time)
                                                      (holds-at (at ?place2) ?time))
                                                 (= ?place1 ?place2)))
                             (meaning (iff (holds-at (outside) ?time)
                                           (holds-at (at garden) ?time))))
                    (:narrative (going (happens (go hall) 0)))
                    (:time 0 2))
            (not (holds-at (outside) 1))
          arriving one-place meaning going)
        "(at garden) is false at 1 because (at hall) is true at 1 (axiom one-place)"
        "(outside) is false at 1 because (at garden) is false at 1 (axiom meaning)"))

(test completed-events
  (let ((clauses '((:fluents (lit)) (:events (switch) (wind))
                   (:axioms (switching (initiates (switch) (lit) ?time)))
                   (:facts (dark (not (holds-at (lit) 0))))
                   (:narrative (late (happens (switch) 2)))
                   (:completion happens) (:time 0 4))))
    (says (explains clauses (not (happens (switch) 1)))
          "(switch) does not happen at 1 because no axiom makes it")
    (explains clauses (not (happens (wind) 2)))
    (says (explains clauses (not (holds-at (lit) 2)) dark)
          "(lit) is false at 2 because" "nothing initiates it")))

(test completion-of-abnormality
  (says (explains '((:sorts (bird tweety opus)) (:predicates (penguin bird) (ab bird) (flies bird))
                    (:axioms (exception :label theta (implies (penguin ?bird) (ab ?bird)))
                             (default (implies (not (ab ?bird)) (flies ?bird))))
                    (:facts (opus-only (iff (penguin ?bird) (= ?bird opus))))
                    (:completion (theta ab)) (:time 0 0))
            (flies tweety)
          default opus-only)
        "(flies tweety) is true because (ab tweety) is false (axiom default)"
        "(ab tweety) is false because no axiom makes it so, since (penguin tweety) is false"))

(test releases-and-determining-fluents
  (let ((clauses '((:fluents (heads)) (:non-inertial-fluents (lands-heads)) (:events (toss) (flip))
                   (:axioms (free (releases (toss) (heads) ?time))
                            (seen (implies (holds-at (lands-heads) ?time)
                                           (holds-at (heads) (+ ?time 1))))
                            (turned (implies (holds-at (heads) ?time)
                                             (terminates (flip) (heads) ?time))))
                   (:facts (lands (holds-at (lands-heads) 1)) (tails (not (holds-at (heads) 0))))
                   (:narrative (tossed (happens (toss) 1)) (flipped (happens (flip) 2)))
                   (:completion happens) (:time 0 4))))
    (explains clauses (holds-at (heads) 2) lands seen)
    (explains clauses (not (holds-at (heads) 4)) lands seen flipped turned)
    (explains clauses (not (released-at (heads) 3)) flipped turned lands seen))
  (explains '((:fluents (heads)) (:events (toss))
              (:axioms (free (releases (toss) (heads) ?time)))
              (:narrative (tossed (happens (toss) 1))) (:time 0 3))
      (released-at (heads) 3)
    free tossed))

(test trajectories
  (let* ((clauses '((:sorts (height (:range 0 9))) (:fluents (rising) (height height))
                    (:events (start) (stop))
                    (:axioms (starting (initiates (start) (rising) ?time))
                             (stopping (terminates (stop) (rising) ?time))
                             (freeing (releases (start) (height ?height) ?time))
                             (one-height (implies (and (holds-at (height ?height1) ?time)
                                                       (holds-at (height ?height2) ?time))
                                                  (= ?height1 ?height2)))
                             (climb (implies (and (holds-at (height ?height1) ?time)
                                                  (= ?height2 (+ ?height1 ?offset)))
                                             (trajectory (rising) ?time (height ?height2)
                                                         ?offset))))
                    (:facts (ground (holds-at (height 0) 0)) (still (not (holds-at (rising) 0))))
                    (:narrative (started (happens (start) 0)) (stopped (happens (stop) 4)))
                    (:completion happens) (:time 0 5)))
         (explanation (explains clauses (holds-at (height 3) 3) starting climb ground started)))
    (says explanation "(height 3) is true at 3 because (start) initiates" "(axiom starting)"
          "(height 0) is true at 0" "nothing terminates (rising) until 3" "axiom climb")
    (explains clauses (not (holds-at (height 0) 3)) starting climb ground started one-height)))

(test exclusions
  (says (explains '((:events (push) (pull)) (:narrative (pushed (happens (push) 1)))
                    (:mutex (push pull)) (:time 0 2))
            (not (happens (pull) 1))
          pushed)
        "(pull) does not happen at 1 because (push) happens at 1")
  (explains '((:events (push) (pull) (wait))
              (:axioms (no-push (not (happens (push) ?time)))
                       (no-pull (not (happens (pull) ?time))))
              (:xor (push pull wait)) (:time 0 2))
      (happens (wait) 0)
    no-push no-pull)
  (says (explains '((:fluents (open) (shut)) (:xor (open shut))
                    (:facts (closed (not (holds-at (open) 0)))) (:time 0 0))
            (holds-at (shut) 0)
          closed)
        "(open) is false at 0, and one of them must")
  (explains '((:events (push) (pull))
              (:axioms (single (implies (and (happens ?event1 ?time) (happens ?event2 ?time))
                                        (= ?event1 ?event2))))
              (:narrative (pushed (happens (push) 1))) (:time 0 2))
      (not (happens (pull) 1))
    pushed single))

(test postdiction
  "What must have happened, since nothing else explains what was seen."
  (let ((explanation
          (explains '((:fluents (parked)) (:events (park) (steal))
                      (:axioms (parking (initiates (park) (parked) ?time))
                               (stealing (terminates (steal) (parked) ?time)))
                      (:facts (gone (not (holds-at (parked) 2))))
                      (:narrative (left (happens (park) 0)))
                      (:time 0 2))
              (happens (steal) 1)
            parking left gone)))
    (says explanation
          "(steal) happens at 1 because" "(parked) is true at 1" "(parked) is false at 2" "else")
    (does-not-say explanation "and nothing changes it")))

(test interval-conditions
  (explains '((:fluents (tap-open)) (:predicates (interrupted)) (:events (turn-off))
              (:axioms (closing (terminates (turn-off) (tap-open) ?time))
                       (meaning (iff (interrupted) (stopped-in 0 (tap-open) 3))))
              (:narrative (turned (happens (turn-off) 1))) (:completion happens) (:time 0 4))
      (interrupted)
    closing meaning turned))

(test causal-constraints-in-explanations
  (let ((explanation
          (ec:why (ec::parse-theory
                   'inline '((:extends causal-constraints) (:fluents (closed) (lit))
                             (:events (close) (flash))
                             (:axioms (closing (initiates (close) (closed) ?time))
                                      (trigger :label delta (implies (initiated (closed) ?time)
                                                                     (happens (flash) ?time))))
                             (:narrative (closed :label delta (happens (close) 0)))
                             (:completion (delta happens)) (:time 0 1)))
                  '(happens (flash) 0))))
    (is (subsetp '(:trigger :closed :closing :started-or-holding :initiated-if-started-only)
                 (ec:explanation-axioms explanation)))
    (says explanation "(flash) happens at 0 because" "(axiom trigger)")))

(test dated-effects
  "Each timepoint at which the fluent persists is named."
  (let ((explanation
          (explains '((:fluents (lit)) (:events (switch))
                      (:axioms (first-time-only (implies (= ?time 1)
                                                         (initiates (switch) (lit) ?time))))
                      (:facts (dark (not (holds-at (lit) 0))))
                      (:completion happens) (:time 0 3))
              (not (holds-at (lit) 3))
            dark)))
    (loop for time from 0 to 2
          do (is (find (format nil "from ~d to ~d" time (1+ time))
                       (ec:explanation-core explanation)
                       :key #'second :test #'search)))))
