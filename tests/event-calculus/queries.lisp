;;;; Questions: what is possible, what follows, which events lead to a goal; and questions that have
;;;; no answer.

(in-package #:discrepancy-finder.tests)

(def-suite queries :in all)
(in-suite queries)

(defparameter *robot*
  '((:sorts (place hall kitchen cellar))
    (:fluents (at place) (box-at place) (carrying))
    (:events (go place) (lift) (drop) (wave))
    (:axioms
     (one-thing-at-a-time (implies (and (happens ?event1 ?time) (happens ?event2 ?time))
                                   (= ?event1 ?event2)))
     (arriving (initiates (go ?place) (at ?place) ?time))
     (leaving (implies (/= ?place1 ?place2) (terminates (go ?place1) (at ?place2) ?time)))
     (stay-away (implies (happens (go ?place) ?time) (not (holds-at (at ?place) ?time))))
     (carrying-along (implies (holds-at (carrying) ?time)
                              (initiates (go ?place) (box-at ?place) ?time)))
     (carrying-away (implies (and (holds-at (carrying) ?time) (/= ?place1 ?place2))
                             (terminates (go ?place1) (box-at ?place2) ?time)))
     (lifting (initiates (lift) (carrying) ?time))
     (lift-here (implies (happens (lift) ?time)
                         (and (not (holds-at (carrying) ?time))
                              (exists (?place) (and (holds-at (at ?place) ?time)
                                                    (holds-at (box-at ?place) ?time))))))
     (dropping (terminates (drop) (carrying) ?time))
     (drop-what (implies (happens (drop) ?time) (holds-at (carrying) ?time)))
     (one-place (implies (and (holds-at (at ?place1) ?time) (holds-at (at ?place2) ?time))
                         (= ?place1 ?place2)))
     (box-in-one-place (implies (and (holds-at (box-at ?place1) ?time)
                                     (holds-at (box-at ?place2) ?time))
                                (= ?place1 ?place2))))
    (:facts (iff (holds-at (at ?place) 0) (= ?place hall))
            (not (holds-at (carrying) 0))
            (holds-at (box-at kitchen) 0)))
  "A robot that carries a box between places.  Events are open.")

(defparameter *stairs*
  '((:predicates (stairs))
    (:axioms (cellar-has-stairs
              (implies (and (happens (go cellar) ?time) (holds-at (carrying) ?time)) (stairs)))))
  "Without stairs nothing can be carried to the cellar.")

(defun robot (&rest clauses)
  (ec::parse-theory 'robot (append *robot* clauses)))

;;; What can be, what must be

(test possible-and-entailed
  (let ((theory (robot '(:time 0 3))))
    (is-true (ec:consistent-p theory))
    (is-true (ec:possible-p theory '(holds-at (carrying) 2)))
    (is-false (ec:possible-p theory '(holds-at (carrying) 1)))
    (is (equal '(t t) (multiple-value-list (ec:entailed-p theory '(not (holds-at (carrying) 1))))))
    (is (equal '(nil t) (multiple-value-list (ec:entailed-p theory '(holds-at (carrying) 2)))))
    (is-true (ec:entailed-p theory '(implies (holds-at (carrying) 2)
                                     (and (happens (go kitchen) 0) (happens (lift) 1)))))
    (is-true (ec:entailed-p theory '(exists (?place) (holds-at (at ?place) 3))))
    (is-true (ec:entailed-p theory '(forall (?place ?time)
                                     (implies (happens (go ?place) ?time)
                                              (not (holds-at (at ?place) ?time))))))
    (is-true (ec:possible-p theory '(and)))
    (is-false (ec:possible-p theory '(or))))
  (let ((contradiction (robot '(:facts (holds-at (at cellar) 0)) '(:time 0 1))))
    (is-false (ec:consistent-p contradiction))
    (is-false (ec:possible-p contradiction '(and)))
    (is (equal '(t nil) (multiple-value-list (ec:entailed-p contradiction '(or))))
        "the second value says that everything follows from a contradiction")))

(test a-theory-its-name-or-a-reasoner-is-asked
  (let ((theory (ec:register-theory (robot))))
    (ec:with-reasoner (reasoner theory :horizon 2)
      (dolist (asked (list theory 'robot :robot))
        (is (= (ec:count-models reasoner) (ec:count-models asked :horizon 2)))
        (is-true (ec:possible-p asked '(happens (lift) 1) :horizon 2))))))

(test models-and-their-numbers
  (let ((theory (robot '(:time 0 1))))
    (multiple-value-bind (models complete) (ec:models theory)
      (is (= 4 (length models)) "wait, wave, go to the kitchen, go to the cellar")
      (is-true complete)
      (is (null (set-exclusive-or '(() ((:wave)) ((:go :kitchen)) ((:go :cellar)))
                                  (mapcar (lambda (model) (ec:model-events model 0)) models)
                                  :test #'equal)))
      (dolist (model models)
        (is (eq theory (ec:model-theory model)))
        (is (equal '(0 . 1) (ec:model-horizon model)))
        (is (equal '((:at :hall) (:box-at :kitchen)) (ec:model-fluents model 0)))
        (is (equal '() (ec:model-events model 1)) "nothing happens at the last timepoint")
        (signals-with (ec:event-calculus-error "2") (ec:model-fluents model 2))))
    (is (equal '(3 nil) (multiple-value-list (ec:count-models theory :limit 3))))
    (is (equal '(4 t) (multiple-value-list (ec:count-models theory :limit 4))))
    (is (equal '(4 t) (multiple-value-list (ec:count-models theory))))
    (is (equal '(2 nil) (multiple-value-bind (models complete) (ec:models theory :limit 2)
                          (list (length models) complete))))
    (is (equal '(() nil) (multiple-value-list (ec:models theory :limit 0))))
    (is (= 2 (ec:count-models theory :where '(exists (?place) (happens (go ?place) 0)))))
    (is (= 0 (ec:count-models theory :where '(holds-at (carrying) 1))))
    (is (= 2 (length (ec:models theory :where '(not (holds-at (at hall) 1))))))))

(test minimized-predicates
  (let ((theory (robot '(:predicates (stairs))
                       '(:axioms (guard (implies (not (stairs))
                                         (not (happens (go cellar) ?time)))))
                       '(:time 0 1))))
    (flet ((minimal (predicates &rest options)
             (mapcar (lambda (model) (list (ec:model-events model 0) (ec:model-literals model)))
                     (apply #'ec:models theory :minimize predicates options))))
      (is (equal '((() ())) (minimal '(happens stairs))))
      (is (equal '((((:go :cellar)) ((:stairs))))
                 (minimal '(happens stairs) :where '(happens (go cellar) 0))))
      (is (equal '((() ())) (minimal '(happens) :where '(not (stairs)))))
      (is (null (set-exclusive-or '((((:go :kitchen))) (((:go :cellar))))
                                  (mapcar (lambda (entry) (list (first entry)))
                                          (minimal '(happens) :where '(not (holds-at (at hall) 1))))
                                  :test #'equal))))
    (signals-with (ec:theory-error "nothing-of-the-kind")
      (ec:models theory :minimize '(nothing-of-the-kind)))))

;;; Consequences

(test consequences-of-a-narrative
  (multiple-value-bind (true false open consistent)
      (ec:consequences (robot '(:narrative (happens (go kitchen) 0) (happens (lift) 1))
                              '(:completion happens) '(:time 0 3)))
    (is-true consistent)
    (is (equal '() open))
    (is (subsetp '((:holds-at (:at :kitchen) 1) (:holds-at (:carrying) 3) (:happens (:lift) 1)
                   (:holds-at (:box-at :kitchen) 3))
                 true :test #'equal))
    (is (subsetp '((:holds-at (:at :hall) 3) (:holds-at (:carrying) 1) (:happens (:lift) 2)
                   (:happens (:wave) 0))
                 false :test #'equal))
    (is (null (intersection true false :test #'equal)))))

(test postdiction-from-observations
  (multiple-value-bind (true false open)
      (ec:consequences (robot '(:time 0 2)) :where '(holds-at (carrying) 2))
    (is (subsetp '((:happens (:go :kitchen) 0) (:happens (:lift) 1) (:holds-at (:at :kitchen) 2))
                 true :test #'equal))
    (is (subsetp '((:happens (:wave) 0) (:holds-at (:at :cellar) 1)) false :test #'equal))
    (is (equal '() open)))
  (multiple-value-bind (true false open)
      (ec:consequences (robot '(:time 0 2)) :where '(holds-at (at cellar) 2))
    (is (subsetp '((:holds-at (:at :cellar) 2) (:holds-at (:box-at :kitchen) 2)) true
                 :test #'equal))
    (is (member '(:happens (:lift) 0) false :test #'equal))
    (is (subsetp '((:happens (:go :cellar) 0) (:happens (:go :cellar) 1)
                   (:happens (:go :kitchen) 0) (:happens (:wave) 1))
                 open :test #'equal))))

(test consequences-of-a-contradiction
  (is (equal '(nil nil nil nil)
             (multiple-value-list (ec:consequences (robot '(:time 0 1))
                                                   :where '(holds-at (carrying) 1))))))

(test consequences-agree-with-entailment
  (let ((theory (robot '(:narrative (happens (go kitchen) 0)) '(:time 0 2))))
    (multiple-value-bind (true false open) (ec:consequences theory)
      (is (plusp (length open)))
      (dolist (atom true) (is-true (ec:entailed-p theory atom) "~a" atom))
      (dolist (atom false) (is-true (ec:entailed-p theory (list 'not atom)) "~a" atom))
      (dolist (atom open)
        (is-true (ec:possible-p theory atom) "~a" atom)
        (is-true (ec:possible-p theory (list 'not atom)) "~a" atom)))))

;;; Plans

(defun plan-texts (plan)
  (mapcar (lambda (events) (mapcar #'ec:atom-text events)) plan))

(defmacro plans-for (goal (&rest options) length &rest plans)
  "Check that the plans for GOAL have LENGTH steps and are PLANS, each a list of events."
  `(multiple-value-bind (found length) (ec:abduce (apply #'robot *stairs*) ',goal ,@options)
     (is (eql ,length length) "~a steps" length)
     (is (null (set-exclusive-or ',(loop for plan in plans
                                         collect (mapcar (lambda (event) (and event (list event)))
                                                         plan))
                                 (mapcar #'plan-texts found)
                                 :test #'equal))
         "~s" (mapcar #'plan-texts found))))

(test plans
  (plans-for (at hall) (:horizon 5) 0 ())
  (plans-for (at cellar) (:horizon 5) 1 ("(go cellar)"))
  (plans-for (carrying) (:horizon 5) 2 ("(go kitchen)" "(lift)"))
  (plans-for (and (box-at hall) (not (carrying)) (at cellar)) (:horizon 8) 5
    ("(go kitchen)" "(lift)" "(go hall)" "(drop)" "(go cellar)")))

(test plans-for-goals-with-quantifiers
  (plans-for (exists (?place) (and (at ?place) (box-at ?place))) (:horizon 5) 1 ("(go kitchen)"))
  (plans-for (forall (?place) (iff (at ?place) (box-at ?place))) (:horizon 5) 1 ("(go kitchen)"))
  (plans-for (exists (?place) (and (box-at ?place) (/= ?place kitchen))) (:horizon 5 :limit nil) 3
    ("(go kitchen)" "(lift)" "(go hall)") ("(go kitchen)" "(lift)" "(go cellar)"))
  (plans-for (or (at cellar) (carrying)) (:horizon 5) 1 ("(go cellar)"))
  (plans-for (implies (at hall) (carrying)) (:horizon 5 :limit 5) 1
    ("(go cellar)") ("(go kitchen)"))
  (plans-for (not (exists (?place) (at ?place))) (:horizon 3) nil))

(test a-limit-of-plans
  (plans-for (not (at hall)) (:horizon 5 :limit nil) 1 ("(go kitchen)") ("(go cellar)"))
  (is (= 1 (length (ec:abduce (robot) '(not (at hall)) :horizon 5))))
  (is (= 2 (length (ec:abduce (robot) '(not (at hall)) :horizon 5 :limit 2))))
  ;; Nothing happens without need.
  (plans-for (at hall) (:horizon 5 :shortest 2 :limit nil) 2 (nil nil)))

(test unreachable-goals
  (plans-for (and (at hall) (at cellar)) (:horizon 4) nil)
  (plans-for (carrying) (:horizon 1) nil)
  (plans-for (carrying) (:horizon 2) 2 ("(go kitchen)" "(lift)"))
  (is (null (ec:abduce (robot '(:facts (holds-at (carrying) 0))) '(at hall) :horizon 3))
      "a contradiction has no plan"))

(test plans-with-conditions
  (plans-for (carrying) (:horizon 5 :where '(not (happens (go kitchen) 0))) 3
    (nil "(go kitchen)" "(lift)"))
  (plans-for (box-at cellar) (:horizon 6 :where '(not (stairs))) nil)
  (plans-for (at cellar) (:horizon 5 :where '(happens (wave) 2)) 3
    ("(go cellar)" nil "(wave)"))
  (plans-for (at cellar) (:horizon 5 :where '(and (holds-at (at hall) 2) (happens (wave) 1))) 3
    (nil "(wave)" "(go cellar)"))
  (signals-with (ec:event-calculus-error "9")
    (ec:abduce (robot) '(at cellar) :horizon 5 :where '(happens (wave) 9))))

(test plans-from-a-later-time
  (is (equal '(((("(go cellar)"))) 1)
             (multiple-value-bind (plans length)
                 (ec:abduce (ec::parse-theory 'later
                                              (append (remove :facts *robot* :key #'first)
                                                      '((:facts (holds-at (at hall) 3)
                                                         (holds-at (box-at kitchen) 3)))))
                            '(at cellar) :horizon '(3 6))
               (list (mapcar #'plan-texts plans) length)))))

(test plans-around-a-narrative
  "What the narrative says happens, and the rest is free although happens is completed."
  (let ((theory (robot '(:narrative (sure (happens (go cellar) 1))) '(:completion happens))))
    (is (equal '(((("(go kitchen)") ("(go cellar)") ("(go kitchen)") ("(lift)"))) 4)
               (multiple-value-bind (plans length)
                   (ec:abduce theory '(carrying) :horizon 6 :where '(holds-at (at kitchen) 1))
                 (list (mapcar #'plan-texts plans) length))))))

(test triggered-events-are-not-chosen
  "The bell rings when the door is opened, and at no other time."
  (let ((theory (inline-theory
                  (:fluents (open) (heard)) (:events (push) (ring))
                  (:axioms (initiates (push) (open) ?time)
                           (initiates (ring) (heard) ?time)
                           (trigger (implies (and (holds-at (open) ?time)
                                                  (not (holds-at (heard) ?time)))
                                             (happens (ring) ?time))))
                  (:facts (not (holds-at (open) 0)) (not (holds-at (heard) 0)))
                  (:completion happens))))
    (is (equal '(((((:push)) ((:ring)))) 2)
               (multiple-value-list (ec:abduce theory '(heard) :horizon 4))))))

(test goals-that-are-malformed
  (let ((theory (robot)))
    (signals-with (ec:theory-error "the goal" "attic") (ec:abduce theory '(at attic) :horizon 3))
    (signals-with (ec:theory-error "the goal" "?place" "unbound")
      (ec:abduce theory '(at ?place) :horizon 3))
    (signals-with (ec:theory-error "the goal" "holds-at")
      (ec:abduce theory '(holds-at (at hall) 3) :horizon 3))
    (signals-with (ec:theory-error "the goal" "5") (ec:abduce theory 5 :horizon 3))
    (signals-with (ec:no-horizon "robot" "horizon") (ec:abduce theory '(at hall)))))

;;; Errors

(test questions-need-a-horizon
  (let ((theory (robot)))
    (dolist (question (list (lambda () (ec:models theory))
                            (lambda () (ec:count-models theory))
                            (lambda () (ec:consistent-p theory))
                            (lambda () (ec:possible-p theory '(and)))
                            (lambda () (ec:entailed-p theory '(and)))
                            (lambda () (ec:consequences theory))
                            (lambda () (ec:why theory '(and)))
                            (lambda () (ec:make-reasoner theory))))
      (signals-with (ec:no-horizon "Theory robot" "horizon must be given") (funcall question)))
    (dolist (horizon '(-1 1.5 "3" (3 1) (1) (a b) (0 1 . 2) x #\3))
      (signals-with (ec:no-horizon "no horizon") (ec:models theory :horizon horizon)))))

(test timepoints-outside-of-the-horizon
  "Nothing is known of them; in quantifiers they are left out."
  (let ((theory (robot '(:time 0 3))))
    (dolist (form '((holds-at (carrying) 4) (not (holds-at (carrying) 4)) (holds-at (carrying) -1)
                    (released-at (carrying) 9) (happens (wave) 7) (not (happens (wave) 7))
                    (stopped-in 0 (carrying) 9)
                    (exists (?place) (holds-at (at ?place) 4))
                    (implies (holds-at (carrying) 1) (holds-at (carrying) (+ 3 1)))))
      (signals-with (ec:event-calculus-error "0 to 3") (ec:possible-p theory form))
      (signals-with (ec:event-calculus-error "0 to 3") (ec:entailed-p theory form))
      (signals-with (ec:event-calculus-error "0 to 3") (ec:models theory :where form)))
    (signals-with (ec:event-calculus-error "last timepoint, 3" "(wave)")
      (ec:possible-p theory '(happens (wave) 3)))
    (is-true (ec:entailed-p theory '(forall (?time)
                                     (implies (happens (lift) ?time)
                                              (holds-at (carrying) (+ ?time 1))))))
    (is-true (ec:possible-p theory '(exists (?time) (holds-at (carrying) (+ ?time 1)))))
    (is-true (ec:possible-p theory '(holds-at (carrying) 4) :horizon 4))))

(test malformed-questions-of-every-kind
  (let ((theory (robot '(:time 0 2))))
    (dolist (question (list (lambda (form) (ec:possible-p theory form))
                            (lambda (form) (ec:entailed-p theory form))
                            (lambda (form) (ec:models theory :where form))
                            (lambda (form) (ec:count-models theory :where form))
                            (lambda (form) (ec:consequences theory :where form))))
      (signals-with (ec:theory-error "the question" "(carrying)") (funcall question '(carrying)))
      (signals-with (ec:theory-error "the question" "5") (funcall question 5))
      (signals-with (ec:theory-error "the question" "?time" "unbound")
        (funcall question '(holds-at (carrying) ?time)))
      (signals-with (ec:theory-error "the question" "initiates")
        (funcall question '(initiates (lift) (carrying) 0))))
    (signals error (ec:models theory :limit -1))
    (signals error (ec:models theory :limit 'many))))
