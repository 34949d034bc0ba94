;;;; The reasoner against brute force on random theories: the same models and the same answers.
;;;;
;;;; A test that fails prints the theory, made as small as its PROBLEM allows (shrinking.lisp).  A
;;;; problem is a function of a theory that returns NIL if the reasoner is right.

(in-package #:discrepancy-finder.tests)

(def-suite differential :in all)
(in-suite differential)

(defun check-problem (few many problem &optional (clauses #'tuned-clauses))
  "Check that PROBLEM, a function of a seed that returns one of a theory, finds nothing wrong with
the theories of the seeds from 1 to FEW, or to MANY if the long tests are run."
  (loop for seed from 1 to (if *long* many few)
        do (let ((text (failure seed (funcall problem seed) (funcall clauses seed))))
             (is (null text) "~a" text))))

;;; Brute force

(defun forced-sets (&rest clauses)
  "Return the models of the theory of CLAUSES by brute force, as lists of atoms."
  (multiple-value-bind (models complete oracle) (forced-models (random-theory clauses))
    (declare (ignore complete))
    (loop for model in models collect (number-atoms model oracle))))

(test brute-force-knows-the-classical-answers
  (flet ((true-in (atom models)
           (count-if (lambda (model) (member atom model :test #'equal)) models)))
    (let ((yale (forced-sets '(:fluents (alive) (loaded)) '(:events (load) (sneeze) (shoot))
                             '(:axioms (initially (and (alive) (not (loaded))))
                               (initiates (load) (loaded) ?time)
                               (implies (holds-at (loaded) ?time)
                                        (terminates (shoot) (alive) ?time))
                               (terminates (shoot) (loaded) ?time))
                             '(:narrative (happens (load) 0) (happens (sneeze) 1)
                               (happens (shoot) 2))
                             '(:completion happens) '(:time 0 3)))
          (turkey (forced-sets '(:fluents (alive) (loaded)) '(:events (load) (spin) (shoot))
                               '(:axioms (initially (and (alive) (not (loaded))))
                                 (initiates (load) (loaded) ?time)
                                 (releases (spin) (loaded) ?time)
                                 (implies (holds-at (loaded) ?time)
                                          (terminates (shoot) (alive) ?time))
                                 (terminates (shoot) (loaded) ?time))
                               '(:narrative (happens (load) 0) (happens (spin) 1)
                                 (happens (shoot) 2))
                               '(:completion happens) '(:time 0 3)))
          (bus (forced-sets '(:events (board) (red) (yellow))
                            '(:axioms (implies (happens (board) ?time)
                                               (or (happens (red) ?time) (happens (yellow) ?time))))
                            '(:narrative (happens (board) 0))
                            '(:completion happens) '(:time 0 1)))
          (inconsistent (forced-sets '(:fluents (f)) '(:events (e))
                                     '(:axioms (initiates (e) (f) ?time) (terminates (e) (f) ?time))
                                     '(:narrative (happens (e) 0)) '(:time 0 1)))
          (sink (forced-sets '(:sorts (height (:range 0 2)))
                             '(:fluents (filling)) '(:non-inertial-fluents (level height))
                             '(:events (tap-on))
                             '(:axioms (initiates (tap-on) (filling) ?time)
                               (implies (and (holds-at (level ?height1) ?time)
                                             (= ?height2 (+ ?height1 ?offset)))
                                        (trajectory (filling) ?time (level ?height2) ?offset))
                               (implies (and (holds-at (level ?height1) ?time)
                                             (holds-at (level ?height2) ?time))
                                        (= ?height1 ?height2))
                               (exists (?height) (holds-at (level ?height) ?time))
                               (initially (and (level 0) (not (filling)))))
                             '(:narrative (happens (tap-on) 0))
                             '(:completion happens) '(:time 0 2))))
      (is (= 1 (length yale)))
      (is (= 1 (true-in '(:holds-at (:alive) 2) yale)))
      (is (= 0 (true-in '(:holds-at (:alive) 3) yale)))
      (is (= 2 (length turkey)))
      (is (= 1 (true-in '(:holds-at (:alive) 3) turkey)))
      (is (= 2 (length bus)) "one bus or the other, by completion of clauses")
      (is (= 1 (true-in '(:happens (:red) 0) bus)))
      (is (null inconsistent))
      (is (= 1 (length sink)))
      (is (= 1 (true-in '(:holds-at (:level 2) 2) sink))))))

;;; The same models

(defun model-atoms (model)
  "Return the list of the atoms that are true in MODEL."
  (destructuring-bind (first . last) (ec:model-horizon model)
    (append (ec:model-literals model)
            (loop for time from first to last
                  append (loop for fluent in (ec:model-fluents model time)
                               collect (list :holds-at fluent time))
                  append (loop for event in (ec:model-events model time)
                               collect (list :happens event time))))))

(defun model-number (atoms oracle)
  "Return ATOMS as an integer, as FORCED-MODELS has models; or the atom that ORACLE does not know."
  (let ((model 0))
    (dolist (atom atoms model)
      (let ((number (gethash atom (oracle-numbers oracle))))
        (if number
            (setf model (logior model (ash 1 number)))
            (return atom))))))

(defun number-atoms (model oracle)
  "Return the list of the atoms that are true in MODEL, an integer."
  (loop for atom across (oracle-atoms oracle)
        for number from 1
        when (logbitp number model) collect atom))

(defun compare-models (expected found oracle)
  "Return what is different between the models EXPECTED, integers, and FOUND, lists of atoms."
  (let* ((found (loop for atoms in found collect (model-number atoms oracle)))
         (unknown (find-if #'consp found))
         (missing (set-difference expected found))
         (wrong (set-difference found expected)))
    (cond (unknown (list :unknown unknown))
          (missing (list :missing (length missing) :of (length expected)
                         (number-atoms (first missing) oracle)))
          (wrong (list :wrong (length wrong) :beside (length expected)
                       (number-atoms (first wrong) oracle)))
          ((/= (length found) (length expected)) (list :twice)))))

(defun disagreement (theory &key (horizon (ec:theory-time-range theory)) where
                              (reasoner theory) (limit *model-limit*))
  "Return NIL if the reasoner finds the models that brute force finds, else what is different: a
list that begins with a keyword.  Return NIL, too, if there are more than LIMIT."
  (multiple-value-bind (expected complete oracle)
      (forced-models theory :horizon horizon :where where :limit limit)
    (when complete
      (multiple-value-bind (models complete)
          (ec:models reasoner :limit (1+ (length expected)) :where where
                              :horizon (list (car horizon) (cdr horizon)))
        (or (compare-models expected (mapcar #'model-atoms models) oracle)
            (and (not complete) (list :incomplete)))))))

(test random-theories-have-the-models-that-brute-force-finds
  (check-problem 300 5000 (constantly #'disagreement)))

(test random-theories-are-not-trivial
  (let ((counts (loop for seed from 1 to 100
                      collect (length (forced-models (random-theory (tuned-clauses seed))
                                                     :limit *model-limit*)))))
    (is (< 5 (count 0 counts)) "inconsistent theories")
    (is (< 50 (count-if (lambda (count) (> count 3)) counts)) "theories with several models")))

(test failures-are-shown-by-small-theories
  (let ((text (failure 1 (lambda (theory)
                           (and (find :e1 (ec:theory-events theory) :key #'first) :has-e1)))))
    (is (search "(:events (e1" text))
    (is (< (count #\Newline text) 5))))

(defun growing-disagreement (theory)
  "Return NIL if a reasoner whose horizon grows step by step finds the right models."
  (destructuring-bind (first . last) (ec:theory-time-range theory)
    (ec:with-reasoner (reasoner theory :horizon (list first first))
      (loop for end from (1+ first) to last
            do (ec:extend-horizon reasoner end)
            thereis (disagreement theory :horizon (cons first end) :reasoner reasoner)))))

(test the-same-models-when-the-horizon-grows
  (check-problem 60 2000 (constantly #'growing-disagreement)))

;;; The same answers

(defun answer-problem (theory reasoner numbers question)
  "Return NIL if REASONER answers QUESTION about THEORY as brute force does, else what is wrong.
NUMBERS are those of the atoms that occur in THEORY."
  (multiple-value-bind (answers complete oracle)
      (forced-models theory :where question :limit *model-limit*)
    (let ((others (forced-models theory :where (list :not question) :limit 1)))
      (cond ((not complete) nil)
            ((not (eq (and answers t) (ec:possible-p reasoner question)))
             (list :possible-p question))
            ((not (eq (null others) (ec:entailed-p reasoner question)))
             (list :entailed-p question))
            ;; Other atoms are open, but no part of models.
            ((subsetp (numbers-in (ground-question oracle question)) numbers)
             (if (eql (length answers) (ec:count-models reasoner :where question))
                 (disagreement theory :where question :reasoner reasoner)
                 (list :count-models question)))))))

(defun inside-horizon-p (question theory)
  "Return true if no event of QUESTION is at the last timepoint or outside of the horizon."
  (destructuring-bind (first . last) (ec:theory-time-range theory)
    (labels ((inside-p (form)
               (or (atom form)
                   (case (first form)
                     (:happens (<= first (third form) (1- last)))
                     ((:holds-at :released-at) (<= first (third form) last))
                     ((:forall :exists) (inside-p (third form)))
                     (t (every #'inside-p (rest form)))))))
      (and (inside-p question)
           (every (lambda (form) (or (not (integerp form)) (<= first form last)))
                  (alexandria:flatten question))))))

(defun answers-problem (theory questions)
  (multiple-value-bind (models complete oracle numbers) (forced-models theory :limit 1)
    (declare (ignore models complete oracle))
    (ec:with-reasoner (reasoner theory)
      (loop for question in questions
            thereis (and (inside-horizon-p question theory)
                         (answer-problem theory reasoner numbers question))))))

(test the-same-answers
  (check-problem 60 1000
                 (lambda (seed)
                   (let* ((vocabulary (seed-vocabulary seed))
                          (questions (loop repeat 5 collect (random-question vocabulary 1))))
                     (lambda (theory) (answers-problem theory questions))))))

(defun consequence-problem (theory)
  "Return NIL if what is certain in THEORY by the reasoner is so by brute force, else what is
wrong."
  (multiple-value-bind (models complete oracle numbers) (forced-models theory :limit *model-limit*)
    (multiple-value-bind (true false open consistent) (ec:consequences theory)
      (labels ((atoms-that (test)
                 (loop for number in numbers
                       for count = (count-if (lambda (model) (logbitp number model)) models)
                       for atom = (aref (oracle-atoms oracle) (1- number))
                       when (and models (funcall test count)) collect atom))
               (all-in-p (atoms others)
                 ;; Whether a fluent is released can be known without being an atom.
                 (subsetp (remove :released-at atoms :key #'first) others :test #'equal))
               (same-p (expected found)
                 (and (all-in-p expected found) (all-in-p found expected))))
        (cond ((not complete) nil)
              ((not (eq consistent (and models t))) :consistent)
              ((not (same-p (atoms-that (lambda (count) (= count (length models)))) true)) :true)
              ((not (same-p (atoms-that (lambda (count) (< 0 count (length models)))) open)) :open)
              ;; An atom that only its completion mentions is false.
              ((not (and (all-in-p (atoms-that #'zerop) false)
                         (not (intersection false (atoms-that #'plusp) :test #'equal))))
               :false))))))

(test the-same-consequences
  (check-problem 60 1000 (constantly #'consequence-problem)))

;;; Minimal models

(defun minimal-sets (models mask)
  "Return those of the MODELS, of which only the bits in MASK count, that include no other."
  (let ((sets (remove-duplicates (mapcar (lambda (model) (logand mask model)) models))))
    (remove-if (lambda (set)
                 (some (lambda (other) (and (/= other set) (= other (logand other set)))) sets))
               sets)))

(defun mask-of (predicates oracle)
  (loop for (name) across (oracle-atoms oracle)
        for number from 1
        when (member name predicates) sum (ash 1 number)))

(defun minimal-models-problem (theory predicates)
  (multiple-value-bind (models complete oracle) (forced-models theory :limit *model-limit*)
    (when complete
      (let* ((mask (mask-of predicates oracle))
             (found (loop for model in (ec:models theory :limit nil :minimize predicates)
                          collect (model-number (model-atoms model) oracle))))
        (cond ((not (subsetp found models)) :no-model)
              ((set-exclusive-or (minimal-sets models mask)
                                 (loop for model in found collect (logand mask model)))
               (list :minimize predicates))
              ((/= (length found) (length (minimal-sets models mask))) :twice))))))

(test the-same-minimal-models
  (check-problem 60 1000
                 (lambda (seed)
                   (let* ((vocabulary (seed-vocabulary seed))
                          (own (append (vocabulary-timed vocabulary)
                                       (vocabulary-static vocabulary)))
                          (predicates (if (or (evenp seed) (null own))
                                          '(:happens)
                                          (keyword-tree (mapcar #'first own)))))
                     (lambda (theory) (minimal-models-problem theory predicates))))))

;;; Plans

(defun positive-numbers (formula positive)
  "Return the atoms that occur positively in the ground FORMULA, or negatively."
  (cond ((integerp formula) (and positive (list formula)))
        ((consp formula)
         (loop for part in (rest formula)
               append (case (first formula)
                        (:not (positive-numbers part (not positive)))
                        (:iff (append (positive-numbers part t) (positive-numbers part nil)))
                        (t (positive-numbers part positive)))))))

(defun narrative-p (axiom)
  "Return true if AXIOM is a fact or an event at a timepoint given by number."
  (let ((form (ec:axiom-formula axiom)))
    (or (and (eq (ec:axiom-label axiom) ec::+facts+) (not (eq (first form) :=)))
        (and (eq (first form) :happens) (integerp (third form))))))

(defun free-events (theory)
  "Return the names of the events that no axiom makes happen; a narrative does not count."
  (multiple-value-bind (oracle sentences)
      ;; A few more timepoints, for axioms that speak of several.
      (make-theory-oracle theory (car (ec:theory-time-range theory))
                          (+ 3 (cdr (ec:theory-time-range theory)))
                          (remove-if #'narrative-p (ec:theory-axioms theory)))
    (let ((caused (loop for (nil . formula) in sentences
                        append (loop for number in (positive-numbers formula t)
                                     for (name event) = (aref (oracle-atoms oracle) (1- number))
                                     when (eq name :happens) collect (first event)))))
      (set-difference (mapcar #'first (ec:theory-events theory)) caused))))

(defun plan-of (model oracle first last)
  "Return the events of MODEL, sorted, for each timepoint a list."
  (loop for time from first below last
        collect (sort (loop for (name event own) in (number-atoms model oracle)
                            when (and (eq name :happens) (= own time)) collect event)
                      #'string< :key #'princ-to-string)))

(defun forced-plans (theory goal minimal)
  "Return the shortest plans for GOAL, and true if they could be found."
  (let ((open-events (free-events theory)))
    ;; The definitions of causal-constraints only look as if they made events happen.
    (when (assoc :started (ec:theory-predicates theory))
      (return-from forced-plans (values nil nil)))
    (destructuring-bind (first . last) (ec:theory-time-range theory)
      (loop for end from first to last
            do (multiple-value-bind (models complete oracle)
                   (forced-models theory :horizon (cons first end) :open-events open-events
                                         :where (at-time goal theory end) :limit 2000)
                 (unless complete (return (values nil nil)))
                 (when models
                   (let ((mask (mask-of '(:happens) oracle)))
                     (return (values (remove-duplicates
                                      (loop for set in (if minimal
                                                           (minimal-sets models mask)
                                                           models)
                                            collect (plan-of set oracle first end))
                                      :test #'equal)
                                     t)))))
            finally (return (values nil t))))))

(defun plans-problem (theory goal minimal)
  (multiple-value-bind (expected complete) (forced-plans theory goal minimal)
    (when complete
      (let ((plans (loop for plan in (ec:abduce theory goal :limit nil :minimal minimal)
                         collect (loop for events in plan
                                       collect (sort (copy-list events) #'string<
                                                     :key #'princ-to-string)))))
        (when (set-exclusive-or expected plans :test #'equal)
          (list :plans goal plans :instead-of expected))))))

(defun clauses-where-not-yet (seed goal)
  "Return the clauses of the random theory of SEED with the fact that GOAL does not hold at first."
  (let* ((clauses (tuned-clauses seed)) (theory (random-theory clauses)))
    (with-facts clauses
      (list (list :not (at-time goal theory (car (ec:theory-time-range theory))))))))

(test the-same-shortest-plans
  (flet ((goal (seed) (random-goal (seed-vocabulary seed))))
    (check-problem 60 1000
                   (lambda (seed)
                     (lambda (theory) (plans-problem theory (goal seed) (evenp seed))))
                   (lambda (seed) (clauses-where-not-yet seed (goal seed))))
    (is (< 5 (loop for seed from 1 to 60
                   count (forced-plans (random-theory (clauses-where-not-yet seed (goal seed)))
                                       (goal seed) t)))
        "goals that can be reached")))
