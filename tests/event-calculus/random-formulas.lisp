;;;; Random formulas over a small vocabulary.
;;;;
;;;; Free variables are universally quantified, so a variable can stand wherever its sort fits, and
;;;; also, by way of subsorts and arithmetic, where it does not always fit.  The same dice give the
;;;; same formulas with every Lisp.  Entry points: RANDOM-VOCABULARY, RANDOM-FORMULA.

(in-package #:discrepancy-finder.tests)

;;; Dice

(defstruct (dice (:constructor make-dice (state)) (:copier nil))
  (state 0 :type (unsigned-byte 64)))

(defun roll (dice sides)
  "Return a number from 0 below SIDES (splitmix64)."
  (let ((mask (1- (expt 2 64))))
    (flet ((mix (z shift factor) (logand mask (* factor (logxor z (ash z (- shift)))))))
      (let ((z (setf (dice-state dice)
                     (logand mask (+ (dice-state dice) #x9e3779b97f4a7c15)))))
        (mod (ash (mix (mix z 30 #xbf58476d1ce4e5b9) 27 #x94d049bb133111eb) -32) sides)))))

(defun chance (dice percent)
  (< (roll dice 100) percent))

(defun pick (dice list)
  (nth (roll dice (length list)) list))

(defun pick-by-weight (dice entries)
  "Return the second of one of ENTRIES, a list of (weight thing)."
  (let ((rest (roll dice (reduce #'+ entries :key #'first))))
    (loop for (weight thing) in entries
          do (decf rest weight)
             (when (minusp rest) (return thing)))))

(defun some-of (dice percent list)
  "Return LIST without some members; each stays with the given chance."
  (loop for member in list when (chance dice percent) collect member))

;;; Vocabulary

(defstruct (vocabulary (:copier nil))
  "What random formulas may mention.  Each list has entries (name sort*)."
  (dice nil :type dice :read-only t)
  (fluents '() :type list :read-only t)
  (non-inertial '() :type list :read-only t)
  (events '() :type list :read-only t)
  (timed '() :type list :read-only t)
  (causal '() :type list :read-only t)
  (static '() :type list :read-only t)
  (functions '() :type list :read-only t)
  (last 2 :type integer :read-only t))

(defparameter *random-sorts*
  '((object b) (agent (:parent object) a) (level (:range 0 1)) (belief (:terms (of agent))))
  "Two objects, one of them an agent.")

(defun random-vocabulary (dice)
  (let ((entries '(() () (object) (agent) (level))))
    (flet ((symbols (prefix most &optional (sorts entries))
             (loop for index from 1 to (1+ (roll dice most))
                   collect (cons (intern (format nil "~a~d" prefix index)
                                         '#:discrepancy-finder.tests)
                                 (pick dice sorts)))))
      (make-vocabulary :dice dice
                       :fluents (symbols "F" 3)
                       :non-inertial (and (chance dice 35) (symbols "N" 1))
                       :events (symbols "E" 3 (if (chance dice 90)
                                                  entries
                                                  '((object) (object level))))
                       :timed (and (chance dice 40)
                                   (symbols "AB" 1 '((time) (object time) (time agent))))
                       :causal (and (chance dice 5)
                                    '((started fluent time) (stopped fluent time)
                                      (initiated fluent time) (terminated fluent time)))
                       :static (and (chance dice 25)
                                    (symbols "P" 1 '((object) (level) (fluent) (belief)
                                                     (time time))))
                       :functions (and (chance dice 20) '(((size object) level)))
                       :last (pick dice '(1 2 2 2 3))))))

;;; Terms

(defun random-level (vocabulary)
  (let ((dice (vocabulary-dice vocabulary)))
    (pick-by-weight dice `((3 0) (3 1) (6 ?level) (2 ?level1)
                           (2 (+ ?level 1)) (2 (- ?level 1)) (1 (- 1 ?level)) (1 (* ?level 2))
                           (1 (mod (+ ?level 1) 2)) (1 (/ 1 ?level)) (1 (+ 1 1))
                           ,@(and (vocabulary-functions vocabulary)
                                  '((2 (size a)) (2 (size ?object))))))))

(defun random-time (vocabulary times)
  "Return a time of one of the kinds TIMES: :now, :near, :two, :number."
  (let ((dice (vocabulary-dice vocabulary)))
    (ecase (pick dice times)
      (:now '?time)
      (:near (pick dice '(?time (+ ?time 1) (+ 1 ?time) (- ?time 1) (+ ?time 2))))
      (:two (pick dice '(?time1 ?time2)))
      (:number (roll dice (1+ (vocabulary-last vocabulary)))))))

(defun random-argument (vocabulary sort times)
  (let ((dice (vocabulary-dice vocabulary)))
    (ecase sort
      (object (pick dice '(a b ?object ?object ?object1 ?agent)))
      (agent (pick dice '(a ?agent ?agent ?object)))
      (level (random-level vocabulary))
      (time (random-time vocabulary times))
      (fluent (if (chance dice 50) '?fluent (random-fluent vocabulary)))
      (belief (pick dice '(?belief (of a) (of ?agent) (of ?object)))))))

(defun random-atom (vocabulary declarations &optional (times '(:now)))
  (destructuring-bind (name . sorts) (pick (vocabulary-dice vocabulary) declarations)
    (cons name (loop for sort in sorts collect (random-argument vocabulary sort times)))))

(defun random-fluent (vocabulary &key (non-inertial 30))
  (if (and (vocabulary-non-inertial vocabulary) (chance (vocabulary-dice vocabulary) non-inertial))
      (random-atom vocabulary (vocabulary-non-inertial vocabulary))
      (random-atom vocabulary (vocabulary-fluents vocabulary))))

(defun random-event (vocabulary)
  (if (chance (vocabulary-dice vocabulary) 5)
      '?event
      (random-atom vocabulary (vocabulary-events vocabulary))))

;;; Formulas

(defun random-comparison (vocabulary)
  (let ((dice (vocabulary-dice vocabulary)))
    (if (chance dice 50)
        (list (pick dice '(= /=)) (pick dice '(?object ?object1 a))
              (pick dice '(?object ?agent a b)))
        (let ((levels (list (random-level vocabulary) (random-level vocabulary)))
              (operator (pick dice '(:equal /= < <= > >=))))
          ;; By itself (= (size a) 1) would be the value of the function.
          (if (eq operator :equal)
              (list 'not (cons '/= levels))
              (cons operator levels))))))

(defun random-atomic-formula (vocabulary times kinds)
  "Return an atomic formula: a comparison, or of one of KINDS: :holds, :happens, :predicate, :rare."
  (let* ((dice (vocabulary-dice vocabulary))
         (predicates (append (vocabulary-timed vocabulary) (vocabulary-causal vocabulary)
                             (vocabulary-static vocabulary))))
    (flet ((moment () (random-time vocabulary times))
           (holds () (list 'holds-at (if (chance dice 4) '?fluent (random-fluent vocabulary))
                           (random-time vocabulary times))))
      (case (if (chance dice 6) :comparison (pick dice kinds))
        (:comparison (random-comparison vocabulary))
        (:happens (list 'happens (random-event vocabulary) (moment)))
        (:predicate (if predicates
                        (random-atom vocabulary predicates times)
                        (holds)))
        (:rare (case (roll dice 4)
                 (0 (list 'released-at (random-fluent vocabulary) (moment)))
                 (1 (list (pick dice '(stopped-in started-in clipped declipped))
                          (if (chance dice 50) 0 (moment)) (random-fluent vocabulary) (moment)))
                 (t (holds))))
        (t (holds))))))

(defun random-formula (vocabulary depth &key (times '(:now)) (kinds '(:holds)))
  "Return a formula with operators nested to DEPTH at most."
  (let ((dice (vocabulary-dice vocabulary)))
    (flet ((part () (random-formula vocabulary (1- depth) :times times :kinds kinds)))
      (ecase (if (plusp depth)
                 (pick-by-weight dice '((8 :atom) (5 not) (5 and) (5 or) (2 implies) (2 iff)
                                        (3 exists) (3 forall)))
                 (pick dice '(:atom not)))
        (:atom (random-atomic-formula vocabulary times kinds))
        (not (list 'not (if (plusp depth)
                            (part)
                            (random-atomic-formula vocabulary times kinds))))
        ((and or) (list* (if (chance dice 50) 'and 'or)
                         (loop repeat (+ 2 (roll dice 2)) collect (part))))
        (implies (list 'implies (part) (part)))
        (iff (list 'iff (part) (part)))
        ((exists forall)
         (list (if (chance dice 50) 'exists 'forall)
               (pick dice '((?object) (?agent) (?level) (?object ?level) (?object1) (?belief)
                            (?fluent) (?event)))
               (part)))))))

(defun random-condition (vocabulary &rest options)
  (apply #'random-formula vocabulary (pick (vocabulary-dice vocabulary) '(0 0 0 1 1 2)) options))

(defun guarded (vocabulary head &rest options)
  "Return HEAD with a random condition, or without."
  (let ((dice (vocabulary-dice vocabulary)))
    (if (chance dice 30)
        head
        (list 'implies (apply #'random-condition vocabulary options) head))))
