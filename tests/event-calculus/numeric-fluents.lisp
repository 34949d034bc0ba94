;;;; Numeric fluents: fluents that have a number as their value.
;;;;
;;;; One story is told twice, with a numeric fluent and with a fluent whose argument is of a sort of
;;;; integers, and must have the same models.

(in-package #:discrepancy-finder.tests)

(def-suite numeric-fluents :in all)
(in-suite numeric-fluents)

(defun numbers-of (theory fluent &rest options)
  "Return the numbers that FLUENT has in the only model of THEORY, one a timepoint."
  (let ((models (apply #'ec:models theory :limit 2 options)))
    (is (= 1 (length models)) "~d models" (length models))
    (let ((model (first models)))
      (destructuring-bind (first . last) (ec:model-horizon model)
        (loop for time from first to last collect (ec:model-number model fluent time))))))

;;; Assignment and inertia

(defun account (&rest clauses)
  "Return the theory of two accounts with CLAUSES."
  (ec::parse-theory
   'accounts
   (append '((:sorts (account a b))
             (:numeric-fluents (balance account))
             (:events (deposit account) (halve account) (withdraw account) (join account account)
              (wait))
             (:axioms
              (depositing (assigns (deposit ?account) (balance ?account)
                                   (+ (value-at (balance ?account) ?time) 10) ?time))
              (halving (assigns (halve ?account) (balance ?account)
                                (/ (value-at (balance ?account) ?time) 2) ?time))
              (withdrawing (implies (>= (value-at (balance ?account) ?time) 3)
                                    (assigns (withdraw ?account) (balance ?account)
                                             (- (value-at (balance ?account) ?time) 3) ?time)))
              (filling (implies (/= ?account1 ?account2)
                                (assigns (join ?account1 ?account2) (balance ?account2)
                                         (+ (value-at (balance ?account1) ?time)
                                            (value-at (balance ?account2) ?time))
                                         ?time)))
              (emptying (implies (/= ?account1 ?account2)
                                 (assigns (join ?account1 ?account2) (balance ?account1) 0
                                          ?time))))
             (:facts (a-at-first (= (value-at (balance a) 0) 1))
              (b-at-first (= (value-at (balance b) 0) 0.25))))
           clauses)))

(test numbers-are-assigned-and-persist
  (let ((theory (account '(:narrative (happens (deposit a) 0) (happens (halve a) 1)
                           (happens (withdraw a) 2) (happens (join a b) 3))
                         '(:completion happens) '(:time 0 5))))
    (is (equal '(1 11 11/2 5/2 0 0) (numbers-of theory '(balance a))))
    (is (equal '(1/4 1/4 1/4 1/4 11/4 11/4) (numbers-of theory '(balance b))))))

(test a-condition-on-a-number
  "Of a fourth nobody can take 3."
  (is (equal '(1/4 1/4 41/4 29/4)
             (numbers-of (account '(:narrative (happens (withdraw b) 0) (happens (deposit b) 1)
                                    (happens (withdraw b) 2))
                                  '(:completion happens) '(:time 0 3))
                         '(balance b)))))

(test concurrent-assignments
  "Of the same number is a contradiction, to different ones is not."
  (flet ((theory (&rest narrative)
           (account (cons :narrative narrative) '(:completion happens) '(:time 0 1))))
    (is-false (ec:consistent-p (theory '(happens (deposit a) 0) '(happens (halve a) 0))))
    (is (equal '(1 11) (numbers-of (theory '(happens (deposit a) 0) '(happens (halve b) 0))
                                   '(balance a))))
    ;; Both assign (0 is what the other account has before), and to the same number.
    (is-true (ec:consistent-p (account '(:axioms (assigns (wait) (balance ?account) 11 ?time))
                                       '(:narrative (happens (wait) 0) (happens (deposit a) 0))
                                       '(:completion happens) '(:time 0 1))))))

(test questions-about-numbers
  (let ((theory (account '(:narrative (happens (deposit a) 0) (happens (halve a) 1))
                         '(:completion happens) '(:time 0 3))))
    (always theory
      (= (value-at (balance a) 2) 5.5) (= (value-at (balance a) 3) 11/2)
      (/= (value-at (balance a) 0) (value-at (balance a) 1))
      (< (value-at (balance a) 0) 1.5) (<= (value-at (balance a) 0) 1)
      (> (value-at (balance a) 1) 10.9) (>= (value-at (balance a) 1) 11)
      (not (< (value-at (balance a) 1) 11))
      (= (+ (value-at (balance a) 0) (* 4 (value-at (balance b) 0))) 2)
      (= (- (value-at (balance a) 1)) -11)
      (= (/ (value-at (balance a) 1) 4) 2.75)
      (forall (?time) (> (value-at (balance a) ?time) (value-at (balance b) ?time)))
      (exists (?time) (= (value-at (balance a) ?time) 11))
      (forall (?account) (>= (value-at (balance ?account) 3) 1/4)))
    (is-false (ec:entailed-p theory '(= (value-at (balance a) 2) 5)))
    (is-false (ec:possible-p theory '(> (value-at (balance a) 2) 5.5)))
    (signals-with (ec:event-calculus-error "7")
      (ec:possible-p theory '(= (value-at (balance a) 7) 1)))
    (signals-with (ec:theory-error "(balance c)" "c")
      (ec:possible-p theory '(= (value-at (balance c) 1) 1)))))

(test readers-of-numbers
  (let ((model (first (ec:models (account '(:completion happens) '(:time 0 1))))))
    (is (eql 1/4 (ec:model-number model '(balance b) 1)))
    (is (eql 1 (ec:model-number model '(cl-user::balance #:a) 0)))
    (signals-with (ec:unknown-atom "(balance c)" "numeric fluent")
      (ec:model-number model '(balance c) 0))
    (signals-with (ec:unknown-atom "(deposit a)" "numeric") (ec:model-number model '(deposit a) 0))
    (signals-with (ec:event-calculus-error "2") (ec:model-number model '(balance a) 2))
    (is (equal '() (ec:model-fluents model 0)))
    (is (equal '() (ec:model-literals model)))))

;;; Open events, open numbers

(test events-are-chosen-for-numbers
  (let ((theory (account '(:axioms (implies (and (happens ?event1 ?time) (happens ?event2 ?time))
                                    (= ?event1 ?event2)))
                         '(:time 0 3))))
    (is-true (ec:possible-p theory '(= (value-at (balance a) 3) 7.5)))
    (always theory
      (implies (= (value-at (balance a) 3) 21)
               (not (exists (?time) (happens (halve a) ?time))))
      ;; Nothing that happens makes money.
      (implies (not (exists (?account ?time) (happens (deposit ?account) ?time)))
               (<= (+ (value-at (balance a) 3) (value-at (balance b) 3)) 5/4)))))

(test an-open-number-has-any-value
  (let ((theory (inline-theory (:numeric-fluents (level)) (:events (fill))
                               (:axioms (assigns (fill) (level) 5 ?time)) (:time 0 2))))
    (is (= 4 (ec:count-models theory)) "models that differ in numbers only are one")
    (sometimes theory (= (value-at (level) 0) 7) (< (value-at (level) 2) -1000)
               (= (value-at (level) 0) 1/3))
    (always theory
      (implies (happens (fill) 1) (= (value-at (level) 2) 5))
      (implies (not (exists (?time) (happens (fill) ?time)))
               (= (value-at (level) 2) (value-at (level) 0)))
      (implies (/= (value-at (level) 1) (value-at (level) 2)) (happens (fill) 1)))))

(test released-numbers
  (let ((theory (inline-theory (:numeric-fluents (level)) (:events (shake) (fill))
                               (:axioms (assigns (fill) (level) 5 ?time)
                                        (releases (shake) (level) ?time)
                                        (>= (value-at (level) ?time) 0))
                               (:facts (= (value-at (level) 0) 1))
                               (:narrative (happens (shake) 0) (happens (fill) 2))
                               (:completion happens) (:time 0 4))))
    (is (= 1 (ec:count-models theory)))
    (always theory (= (value-at (level) 0) 1) (= (value-at (level) 3) 5) (= (value-at (level) 4) 5)
      (>= (value-at (level) 2) 0))
    (sometimes theory (= (value-at (level) 1) 77) (= (value-at (level) 2) 1)
      (< (value-at (level) 1) (value-at (level) 2)))))

(test initial-numbers
  "The numbers at the first timepoint are facts."
  (let ((theory (inline-theory (:sorts (tank left right)) (:numeric-fluents (level tank))
                               (:events (fill tank))
                               (:axioms (assigns (fill ?tank) (level ?tank)
                                                 (+ 1 (value-at (level ?tank) ?time)) ?time)
                                        (= (value-at (level left) 5) 3)
                                        (> (value-at (level right) 5) (value-at (level left) 5)))
                               (:narrative (happens (fill left) 5))
                               (:completion happens) (:time 5 6))))
    (always theory (= (value-at (level left) 5) 3) (= (value-at (level left) 6) 4)
      (> (value-at (level right) 6) 3))))

(test a-divisor-is-not-0
  (flet ((theory (&rest facts)
           (ec::parse-theory 'inline `((:numeric-fluents (x)) (:facts ,@facts) (:time 0 0)))))
    (always (theory '(= (/ 1 (value-at (x) 0)) 2)) (= (value-at (x) 0) 1/2))
    (is-false (ec:consistent-p (theory '(= (/ 1 (value-at (x) 0)) 2) '(= (value-at (x) 0) 0))))))

;;; Trajectories

(test numeric-trajectories
  "A stone falls 20 units, faster and faster, until it hits the ground."
  (let ((theory (inline-theory
                  (:numeric-fluents (height)) (:fluents (falling)) (:events (drop) (hit))
                  (:axioms (initiates (drop) (falling) ?time)
                           (releases (drop) (height) ?time)
                           (trajectory (falling) ?time
                                       (= (height) (- (value-at (height) ?time)
                                                      (* 5 ?offset ?offset)))
                                       ?offset)
                           (terminates (hit) (falling) ?time)
                           (assigns (hit) (height) 0 ?time)
                           (implies (and (holds-at (falling) ?time)
                                         (<= (value-at (height) ?time) 0))
                                    (happens (hit) ?time)))
                  (:facts (= (value-at (height) 0) 20) (not (holds-at (falling) 0)))
                  (:narrative (happens (drop) 1))
                  (:completion happens) (:time 0 6))))
    (is (equal '(20 20 15 0 0 0 0) (numbers-of theory '(height))))
    (always theory (happens (hit) 3) (not (holds-at (falling) 4)))))

(test numeric-anti-trajectories
  "While the heater is on it gets warmer, while it is off it cools down."
  (is (equal '(20 20 41/2 21 21/2 7 21/4)
             (numbers-of
              (inline-theory
                (:numeric-fluents (warmth)) (:fluents (on)) (:events (turn-on) (turn-off))
                (:axioms (initiates (turn-on) (on) ?time) (terminates (turn-off) (on) ?time)
                         (releases (turn-on) (warmth) ?time) (releases (turn-off) (warmth) ?time)
                         (trajectory (on) ?time (= (warmth) (+ (value-at (warmth) ?time)
                                                               (* 1/2 ?offset)))
                                     ?offset)
                         (anti-trajectory (on) ?time (= (warmth) (/ (value-at (warmth) ?time)
                                                                    (+ 1 ?offset)))
                                          ?offset))
                (:facts (= (value-at (warmth) 0) 20) (not (holds-at (on) 0)))
                (:narrative (happens (turn-on) 1) (happens (turn-off) 3))
                (:completion happens) (:time 0 6))
              '(warmth)))))

;;; The same story on a sort of integers

(defparameter *counting*
  '((:events (tick) (double) (reset) (beep))
    (:axioms (not (and (happens (tick) ?time) (happens (double) ?time)))
             (implies (happens (reset) ?time)
                      (not (or (happens (tick) ?time) (happens (double) ?time)))))
    (:completion (delta happens))
    (:time 0 3)))

(defun counted-in-numbers (open-events)
  (ec::parse-theory
   'numbers
   (append *counting*
           '((:numeric-fluents (count))
             (:axioms (assigns (tick) (count) (+ (value-at (count) ?time) 1) ?time)
              (assigns (double) (count) (* 2 (value-at (count) ?time)) ?time)
              (assigns (reset) (count) 0 ?time)
              (trigger :label delta (implies (> (value-at (count) ?time) 2)
                                             (happens (beep) ?time))))
             (:facts (= (value-at (count) 0) 1)))
           open-events)))

(defun counted-in-integers (open-events)
  (ec::parse-theory
   'integers
   (append *counting*
           '((:sorts (value (:range 0 64)))
             (:fluents (count value))
             (:axioms (implies (holds-at (count ?value) ?time)
                               (initiates (tick) (count (+ ?value 1)) ?time))
              (implies (holds-at (count ?value) ?time)
                       (terminates (tick) (count ?value) ?time))
              (implies (and (holds-at (count ?value) ?time) (> ?value 0))
                       (initiates (double) (count (* 2 ?value)) ?time))
              (implies (and (holds-at (count ?value) ?time) (> ?value 0))
                       (terminates (double) (count ?value) ?time))
              (initiates (reset) (count 0) ?time)
              (implies (and (holds-at (count ?value) ?time) (> ?value 0))
                       (terminates (reset) (count ?value) ?time))
              (trigger :label delta (implies (and (holds-at (count ?value) ?time) (> ?value 2))
                                             (happens (beep) ?time))))
             (:facts (iff (holds-at (count ?value) 0) (= ?value 1))))
           open-events)))

(defun told-stories (theory value-at)
  "Return, in order, the texts of the models of THEORY: the events of each timepoint, and what the
function VALUE-AT says of the model and each timepoint."
  (sort (loop for model in (ec:models theory :limit nil)
              collect (format nil "~{~a ~a~%~}"
                              (loop for time from 0 to 3
                                    collect (mapcar #'ec:atom-text (ec:model-events model time))
                                    collect (funcall value-at model time))))
        #'string<))

(test numbers-and-integers-tell-the-same
  (let ((narratives '(((:narrative (at-0 :label delta (happens (tick) 0))
                        (at-1 :label delta (happens (double) 1))
                        (at-2 :label delta (happens (tick) 2))))
                      ((:narrative (at-0 :label delta (happens (double) 0))
                        (at-1 :label delta (happens (double) 1))
                        (at-2 :label delta (happens (reset) 2))))
                      ((:narrative (at-0 :label delta (or (happens (tick) 0) (happens (reset) 0)))
                        (at-1 :label delta (or (happens (double) 1) (happens (tick) 1)))
                        (at-2 :label delta (happens (tick) 2)))))))
    (dolist (narrative narratives)
      (let ((numbers (told-stories (counted-in-numbers narrative)
                                   (lambda (model time) (ec:model-number model '(count) time))))
            (integers (told-stories (counted-in-integers narrative)
                                    (lambda (model time)
                                      (second (first (ec:model-fluents model time)))))))
        (is (plusp (length numbers)))
        (is (equal integers numbers) "~a~%and~%~a" integers numbers)))))

;;; Growing horizons, plans, explanations

(test the-horizon-grows
  (ec:with-reasoner (reasoner (inline-theory
                                (:numeric-fluents (count)) (:events (tick))
                                (:axioms
                                 (assigns (tick) (count) (+ 1 (value-at (count) ?time)) ?time)
                                 (happens (tick) ?time))
                                (:facts (= (value-at (count) 0) 0)))
                              :horizon 1)
    (loop for last in '(1 2 3 7 4 5)
          do (ec:extend-horizon reasoner last)
             (is-true (ec:entailed-p reasoner `(= (value-at (count) ,last) ,last)))
             (is-false (ec:possible-p reasoner `(= (value-at (count) ,last) 0)))
             (is (eql last (ec:model-number (first (ec:models reasoner)) '(count) last)))
             (is (= 1 (ec:count-models reasoner))))))

(test plans-for-conditions-on-numbers
  "A pump must fill the tank before the valve can be opened."
  (multiple-value-bind (plans length)
      (ec:abduce (inline-theory (:numeric-fluents (level)) (:fluents (open)) (:events (pump) (turn))
                                (:axioms
                                 (assigns (pump) (level) (+ 4 (value-at (level) ?time)) ?time)
                                 (initiates (turn) (open) ?time)
                                 (implies (happens (turn) ?time)
                                          (>= (value-at (level) ?time) 10)))
                                (:facts (= (value-at (level) 0) 1) (not (holds-at (open) 0)))
                                (:mutex (pump turn)))
                 '(open) :horizon 8)
    (is (= 4 length))
    (is (equal '((((:pump)) ((:pump)) ((:pump)) ((:turn)))) plans))))

(test explanations-with-numbers
  (let* ((theory (account '(:narrative (deposited (happens (deposit a) 0))
                            (taken (happens (withdraw a) 1)))
                          '(:completion happens) '(:time 0 4)))
         (explanation (ec:why theory '(= (value-at (balance a) 3) 8))))
    (is (null (set-exclusive-or '(:a-at-first :deposited :taken :depositing :withdrawing)
                                (ec:explanation-axioms explanation))))
    (is (search "(= (value-at (balance a) 3) 8)" (prin1-to-string explanation)))
    (is-true (search "(deposit a)" (with-output-to-string (stream) (describe explanation stream))))
    (is (equal '(:b-at-first)
               (ec:explanation-axioms (ec:why theory '(= (value-at (balance b) 4) 1/4)))))
    (is (null (ec:why theory '(= (value-at (balance b) 4) 1))))
    (is (null (set-exclusive-or
               '(:a-at-first :deposited :also :depositing :halving)
               (ec:explanation-axioms
                (ec:why-inconsistent
                 (account '(:narrative (deposited (happens (deposit a) 0))
                            (also (happens (halve a) 0)))
                          '(:completion happens) '(:time 0 1)))))))))

(test what-begins-a-numeric-trajectory-is-named
  (let ((theory (inline-theory
                  (:numeric-fluents (height)) (:fluents (rising)) (:events (start))
                  (:axioms (starting (initiates (start) (rising) ?time))
                           (freeing (releases (start) (height) ?time))
                           (climb (trajectory (rising) ?time
                                              (= (height) (+ (value-at (height) ?time) ?offset))
                                              ?offset)))
                  (:facts (ground (= (value-at (height) 0) 0)))
                  (:narrative (started (happens (start) 0)))
                  (:completion happens) (:time 0 3))))
    (is (null (set-exclusive-or '(:starting :climb :ground :started)
                                (ec:explanation-axioms
                                 (ec:why theory '(= (value-at (height) 2) 2))))))))

(test numbers-in-state-formulas
  "In goals and INITIALLY the number is that at the time in question."
  (let ((theory (inline-theory
                  (:numeric-fluents (level)) (:events (fill))
                  (:axioms (empty-at-first (initially (= (value-at (level)) 1)))
                           (filling (assigns (fill) (level) (+ (value-at (level) ?time) 2) ?time)))
                  (:time 0 5))))
    (is (= 1 (ec:model-number (first (ec:models theory :limit 1)) '(level) 0)))
    (is (equal '((((:fill)) ((:fill))))
               (ec:abduce theory '(= (value-at (level)) 5))))
    (is (search "a time cannot stand here"
                (report-of 'ec:theory-error
                           (lambda () (ec:abduce theory '(= (value-at (level) 3) 5))))))
    (is (search "(value-at (level)) was expected"
                (report-of 'ec:theory-error (lambda () (ec:abduce theory '(= (level) 5))))))))
