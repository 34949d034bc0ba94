;;;; Random small theories, as clauses of DEFINE-THEORY.
;;;;
;;;; A theory has a vocabulary of a few ground fluents, events and predicates, and axioms of the
;;;; kinds that the Discrete Event Calculus knows, each made by a function below.  The same seed
;;;; gives the same theory with every Lisp.  Entry points: TUNED-CLAUSES, RANDOM-THEORY.

(in-package #:discrepancy-finder.tests)

;;; Axioms, of one kind each

(defun effect-head (vocabulary)
  (let ((dice (vocabulary-dice vocabulary)))
    (list (pick-by-weight dice '((5 initiates) (4 terminates) (2 releases)))
          (random-event vocabulary)
          (random-fluent vocabulary :non-inertial 3)
          '?time)))

(defun random-effect (vocabulary)
  (let* ((dice (vocabulary-dice vocabulary))
         (head (effect-head vocabulary))
         (head (if (chance dice 8) (list 'and head (effect-head vocabulary)) head)))
    (pick-by-weight
     dice
     `((10 ,(guarded vocabulary head))
       (3 ,(guarded vocabulary head :kinds '(:holds :happens)))
       (2 ,(guarded vocabulary head :kinds '(:holds :predicate :predicate)))
       (2 ,(guarded vocabulary head :kinds '(:holds :rare :rare)))
       (1 ,(guarded vocabulary head :times '(:near :now)))
       (1 ,(subst (random-time vocabulary '(:near)) '?time (guarded vocabulary head)))
       (1 ,(subst (random-time vocabulary '(:number)) '?time (guarded vocabulary head)))))))

(defun random-precondition (vocabulary)
  (list 'implies (list 'happens (random-event vocabulary) '?time)
        (random-condition vocabulary :kinds '(:holds :holds :predicate))))

(defun random-trigger (vocabulary)
  (let ((times (if (chance (vocabulary-dice vocabulary) 80) '(:now) '(:near))))
    (list 'implies (random-condition vocabulary :kinds '(:holds :holds :predicate :happens))
          (list 'happens (random-event vocabulary) (random-time vocabulary times)))))

(defun random-hierarchy (vocabulary)
  "An event that other events at the same time are part of, in one direction or in both."
  (flet ((event () (list 'happens (random-event vocabulary) '?time)))
    (let ((dice (vocabulary-dice vocabulary)))
      (list (if (chance dice 60) 'implies 'iff)
            (if (chance dice 70) (event) (list 'and (event) (random-condition vocabulary)))
            (pick-by-weight dice `((5 (or ,(event) ,(event)))
                                   (2 (and ,(event) ,(random-condition vocabulary)))
                                   (1 ,(event))
                                   (1 (exists (?object ?level) ,(event)))))))))

(defun random-constraint (vocabulary)
  (flet ((holds () (list 'holds-at (random-fluent vocabulary :non-inertial 70) '?time)))
    (let ((dice (vocabulary-dice vocabulary)))
      (pick-by-weight
       dice
       `((4 (iff ,(holds) ,(random-condition vocabulary)))
         (1 (exists (?object) ,(holds)))
         (1 (forall (?level ?agent) ,(holds)))
         (1 (implies (and ,(holds) ,(holds)) (= ?object ?object1)))
         (1 (not (and ,(holds) ,(holds))))
         (2 ,(random-formula vocabulary 2)))))))

(defun random-sentence (vocabulary)
  "A sentence about several timepoints, or of any form."
  (let* ((dice (vocabulary-dice vocabulary)) (kinds '(:holds :holds :happens :predicate :rare)))
    (flet ((formula (depth &rest times)
             (random-formula vocabulary depth :kinds kinds :times times)))
      (pick-by-weight
       dice
       `((4 (implies ,(formula 1 :near) ,(formula 1 :near)))
         (3 (implies (and (,(pick dice '(< <= =)) ?time1 ?time2) ,(formula 1 :two))
                     ,(formula 1 :two)))
         (1 (implies (and (= ?time2 (+ ?time1 1)) ,(formula 1 :two)) ,(formula 1 :two)))
         (1 (implies (happens ,(random-event vocabulary) ?time1)
                     (exists (?time2) (and (< ?time1 ?time2) ,(formula 1 :two)))))
         (1 ,(formula 2 :now :number))
         (3 ,(formula 3 :now)))))))

(defun random-fact (vocabulary number)
  "Return a named fact: without a name (p (f)) would be taken for the axiom (f) named p."
  (let ((atom (random-atomic-formula vocabulary '(:number) '(:holds :holds :happens :predicate))))
    (list (intern (format nil "FACT-~d" number) '#:discrepancy-finder.tests)
          (if (chance (vocabulary-dice vocabulary) 50) atom (list 'not atom)))))

(defun random-trajectory (vocabulary)
  (let ((dice (vocabulary-dice vocabulary)))
    (destructuring-bind (kind . head)
        (list (if (chance dice 65) 'trajectory 'anti-trajectory)
              (random-fluent vocabulary :non-inertial 3) '?time (random-fluent vocabulary)
              (pick dice '(?offset ?offset ?offset 1 2)))
      (let ((body (guarded vocabulary (cons kind head))))
        (if (chance dice 40)
            `(implies (= ?level2 (,(pick dice '(+ -)) ?level ?offset))
                      ,(subst '?level2 '?level1 body))
            body)))))

(defun random-default (vocabulary)
  "A sentence that makes an abnormality predicate true."
  (if (vocabulary-timed vocabulary)
      (list 'implies (random-condition vocabulary :kinds '(:holds :predicate))
            (random-atom vocabulary (vocabulary-timed vocabulary)
                         (if (chance (vocabulary-dice vocabulary) 80) '(:now) '(:near))))
      (random-sentence vocabulary)))

(defun random-effect-reader (vocabulary)
  "A sentence that is about what events would do."
  (let* ((dice (vocabulary-dice vocabulary))
         (event (random-event vocabulary))
         (effect (list (pick dice '(initiates terminates releases))
                       event (random-fluent vocabulary :non-inertial 3) '?time))
         (condition (random-condition vocabulary :kinds '(:holds :happens :predicate))))
    (pick-by-weight dice `((3 (implies (and (happens ,event ?time) ,effect) ,condition))
                           (1 (implies ,effect ,condition))
                           (1 (iff ,condition (and (happens ,event ?time) (not ,effect))))))))

(defun random-axiom (vocabulary)
  "Return an axiom of a random kind."
  (let ((axiom (funcall (pick-by-weight (vocabulary-dice vocabulary)
                                        '((12 random-effect) (3 random-precondition)
                                          (3 random-trigger) (3 random-hierarchy)
                                          (4 random-constraint) (3 random-sentence)
                                          (2 random-trajectory) (2 random-default)
                                          (1 random-effect-reader)))
                        vocabulary)))
    ;; The axiom (p (f)) would be taken for the axiom (f) named p.
    (if (assoc (first axiom) (vocabulary-static vocabulary))
        (list 'and axiom)
        axiom)))

(defun random-axioms (vocabulary)
  (loop repeat (+ 4 (roll (vocabulary-dice vocabulary) 6)) collect (random-axiom vocabulary)))

;;; Theories

(defun tree-mentions-p (name tree)
  (if (consp tree)
      (some (lambda (part) (tree-mentions-p name part)) tree)
      (eq name tree)))

(defun labelled (dice label axioms)
  "Return AXIOMS, the first and most of the others named and with LABEL."
  (loop for axiom in axioms
        for number from 1
        collect (if (or (= number 1) (chance dice 75))
                    (list (intern (format nil "~a-~d" label number) '#:discrepancy-finder.tests)
                          :label label axiom)
                    axiom)))

(defun random-completion (vocabulary axioms)
  "Return AXIOMS, some with labels, and the completion declarations for them."
  (let ((dice (vocabulary-dice vocabulary))
        (completions '()))
    (flet ((complete (name label choices)
             (flet ((head-p (axiom)
                      (and (member (first axiom) '(implies iff))
                           (tree-mentions-p name (third axiom)))))
               (ecase (pick dice choices)
                 ((nil))
                 (:all (push name completions))
                 (:label (let ((chosen (remove-if-not #'head-p axioms)))
                           (when chosen
                             (push (list label name) completions)
                             (setf axioms (append (remove-if #'head-p axioms)
                                                  (labelled dice label chosen))))))))))
      (complete 'happens 'delta '(nil nil nil :all :all :all :all :label :label))
      (when (vocabulary-timed vocabulary)
        (complete (first (first (vocabulary-timed vocabulary))) 'theta
                  '(nil nil :all :all :label :label :label))))
    (values axioms completions)))

(defun state-formula (form vocabulary)
  "Return FORM, a formula about ?time, with fluents that stand for themselves."
  (cond ((atom form) form)
        ((eq (first form) 'holds-at)
         (if (consp (second form)) (second form) (random-fluent vocabulary)))
        (t (mapcar (lambda (part) (state-formula part vocabulary)) form))))

(defun random-initial-condition (vocabulary)
  (let ((timeless (remove-if (lambda (declaration) (member 'time declaration))
                             (vocabulary-static vocabulary)))
        (formula (state-formula (random-formula vocabulary 2) vocabulary)))
    (list 'initially
          (if (and timeless (chance (vocabulary-dice vocabulary) 30))
              (list 'implies formula (random-atom vocabulary timeless))
              formula))))

(defun random-theory-clauses (seed)
  "Return the clauses of the random theory of SEED."
  (let* ((dice (make-dice seed))
         (vocabulary (random-vocabulary dice))
         (first (pick dice '(0 0 0 1)))
         (event-names (mapcar #'first (vocabulary-events vocabulary)))
         (fluent-names (mapcar #'first (vocabulary-fluents vocabulary))))
    (labels ((often (percent things) (and (chance dice percent) things))
             (names (percent list) (remove nil (often percent (list (some-of dice 70 list))))))
      (multiple-value-bind (axioms completions)
          (random-completion vocabulary (random-axioms vocabulary))
        (remove
         nil
         `((:extends ,@(and (vocabulary-causal vocabulary) '(causal-constraints)))
           (:sorts ,@*random-sorts*)
           (:fluents ,@(vocabulary-fluents vocabulary))
           (:non-inertial-fluents ,@(vocabulary-non-inertial vocabulary))
           (:events ,@(vocabulary-events vocabulary))
           (:predicates ,@(vocabulary-timed vocabulary) ,@(vocabulary-static vocabulary))
           (:functions ,@(vocabulary-functions vocabulary))
           (:manual-release ,@(often 25 (some-of dice 60 fluent-names)))
           (:completion ,@completions)
           (:mutex ,@(names 25 event-names) ,@(names 5 fluent-names))
           (:xor ,@(names 7 event-names))
           (:axioms ,@axioms
                    ,@(often 15 '((implies (and (happens ?event1 ?time) (happens ?event2 ?time))
                                           (= ?event1 ?event2))))
                    ,@(often 40 (list (random-initial-condition vocabulary))))
           (:narrative ,@(loop repeat (roll dice 3)
                               collect (list 'happens
                                             (random-atom vocabulary (vocabulary-events vocabulary))
                                             (+ first (roll dice (vocabulary-last vocabulary))))))
           (:facts ,@(loop for number from 1 to (roll dice 4)
                           collect (random-fact vocabulary number))
                   ,@(and (vocabulary-functions vocabulary) '((= (size a) 1) (= (size b) 0))))
           (:time ,first ,(+ first (vocabulary-last vocabulary)))
           (:offset ,@(often 10 '(1 1))))
         :test (lambda (nothing clause) (declare (ignore nothing)) (null (rest clause))))))))

;;; Tuning

(defparameter *model-limit* 100
  "Theories with more models are given more facts.")

(defun random-theory (clauses)
  (ec::parse-theory 'random clauses))

(defun with-facts (clauses facts)
  (let ((clause (find :facts clauses :key #'first)))
    (if clause
        (substitute (append clause facts) clause clauses)
        (append clauses (list (cons :facts facts))))))

(defun model-facts (model oracle dice)
  "Return a few facts that are true in MODEL."
  (loop repeat 3
        for number = (1+ (roll dice (length (oracle-atoms oracle))))
        for atom = (aref (oracle-atoms oracle) (1- number))
        ;; The conjunction keeps (p (f)) from being taken for the axiom (f) named p.
        collect (if (logbitp number model) (list 'and atom) (list 'not atom))))

(defun without-one-axiom (clauses dice)
  "Return CLAUSES without an axiom that has no label, or NIL if there is none."
  (let ((candidates (loop for (key . entries) in clauses
                          when (member key '(:axioms :facts :narrative))
                            append (remove-if (lambda (entry) (member :label entry)) entries))))
    (and candidates
         (let ((axiom (pick dice candidates)))
           (loop for clause in clauses collect (remove axiom clause :test #'eq))))))

(defun tuned-clauses (seed)
  "Return the clauses of the random theory of SEED, with facts from one of its models if it has more
than *MODEL-LIMIT* models, and, mostly, without some axioms if it has none."
  (let ((clauses (random-theory-clauses seed))
        (dice (make-dice (- (expt 2 63) seed)))
        (inconsistent (zerop (mod seed 7))))
    (loop
      (multiple-value-bind (models complete oracle)
          (forced-models (random-theory clauses) :limit *model-limit*)
        (cond ((not complete)
               (setf clauses (with-facts clauses (model-facts (pick dice models) oracle dice))))
              ((or models inconsistent) (return clauses))
              (t (setf clauses (or (without-one-axiom clauses dice)
                                   (return clauses)))))))))

;;; Questions

(defun seed-vocabulary (seed)
  "Return the vocabulary of the random theory of SEED."
  (random-vocabulary (make-dice seed)))

(defun keyword-tree (form)
  (cond ((consp form) (mapcar #'keyword-tree form))
        ((and form (symbolp form)) (intern (symbol-name form) :keyword))
        (t form)))

(defun closed (formula)
  "Return FORMULA in keywords, with its free variables bound by a quantifier."
  (let* ((formula (keyword-tree formula))
         (variables (unbound-variables formula)))
    (if variables (list :forall variables formula) formula)))

(defun random-question (vocabulary depth)
  "Return a formula with timepoints by number."
  (closed (random-formula vocabulary depth :times '(:number)
                                           :kinds '(:holds :holds :happens :predicate))))

(defun random-goal (vocabulary)
  "Return a closed state formula."
  (closed (state-formula (random-formula vocabulary 1) vocabulary)))
