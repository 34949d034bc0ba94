;;;; Reasoners that are asked several times, grow, are closed, run out of time, or are asked in
;;;; several threads at once.

(in-package #:discrepancy-finder.tests)

(def-suite reasoners :in all)
(in-suite reasoners)

(test a-reasoner-is-asked-many-times
  (ec:with-reasoner (reasoner (robot) :horizon 3)
    (let ((count (ec:count-models reasoner)))
      (is (< 10 count))
      (is (equal '(:at :hall) (first (ec:model-fluents (first (ec:models reasoner)) 0))))
      (is-true (ec:possible-p reasoner '(holds-at (carrying) 3)))
      (is (> count (ec:count-models reasoner :where '(holds-at (carrying) 3))))
      (ec:consequences reasoner :where '(holds-at (carrying) 2))
      (ec:models reasoner :minimize '(happens))
      (signals ec:theory-error (ec:possible-p reasoner '(holds-at (flying) 1)))
      (is (= count (ec:count-models reasoner)) "no question leaves anything behind")
      (is (search "robot, timepoints 0 to 3" (prin1-to-string reasoner)))
      (is (eq :robot (ec:theory-name (ec:reasoner-theory reasoner)))))))

(test atoms-that-no-axiom-mentions
  (ec:with-reasoner (reasoner (inline-theory (:sorts (s a)) (:predicates (p s) (q s time))
                                             (:fluents (f)) (:time 0 1)))
    (is-true (ec:possible-p reasoner '(and (p a) (not (q a 1)))))
    (is-false (ec:possible-p reasoner '(and (p a) (not (p a)))))
    (is-false (ec:entailed-p reasoner '(q a 0)))
    (is (= 2 (ec:count-models reasoner)))
    (is (= 2 (ec:count-models reasoner :where '(p a))))))

(test growing-horizons
  "A reasoner that has grown, or shrunk, is like a new one."
  (dolist (theory (list (robot)
                        ;; Here an axiom compares timepoints, so that all is made anew.
                        (robot '(:axioms (late (implies (happens (lift) ?time) (> ?time 1)))))
                        ;; Here there are as many alarms as timepoints.
                        (robot '(:fluents (alarm-at time)) '(:events (set-alarm time))
                               '(:axioms (implies (happens (set-alarm ?time1) ?time)
                                                  (< ?time ?time1))
                                 (initiates (set-alarm ?time1) (alarm-at ?time1) ?time))
                               '(:facts (not (holds-at (alarm-at ?time1) 0))))))
    (ec:with-reasoner (reasoner theory :horizon 1)
      (dolist (last '(2 3 1 2 0 3))
        (is (eq reasoner (ec:extend-horizon reasoner last)))
        (is (equal (cons 0 last) (ec:reasoner-horizon reasoner)))
        (is (equal (multiple-value-list (ec:count-models theory :horizon last))
                   (multiple-value-list (ec:count-models reasoner))))
        (is (eq (ec:possible-p theory '(exists (?time) (holds-at (carrying) ?time)) :horizon last)
                (ec:possible-p reasoner '(exists (?time) (holds-at (carrying) ?time))))))
      (signals error (ec:extend-horizon reasoner 'x))
      (signals ec:no-horizon (ec:extend-horizon reasoner -1))
      (is (equal '(0 . 3) (ec:reasoner-horizon reasoner)) "what failed has changed nothing"))))

(test a-horizon-that-is-not-the-reasoners
  (ec:with-reasoner (reasoner (robot) :horizon 2)
    (signals error (ec:models reasoner :horizon 7))
    (is-true (ec:models reasoner :horizon 2))))

(test closed-reasoners
  (let ((reasoner (ec:make-reasoner (robot) :horizon 2)))
    (is-true (ec:consistent-p reasoner))
    (ec:close-reasoner reasoner)
    (ec:close-reasoner reasoner)
    (dolist (question (list (lambda () (ec:models reasoner))
                            (lambda () (ec:possible-p reasoner '(holds-at (carrying) 1)))
                            (lambda () (ec:consequences reasoner))
                            (lambda () (ec:extend-horizon reasoner 3))))
      (signals-with (error "closed") (funcall question)))
    (is (equal '(0 . 2) (ec:reasoner-horizon reasoner)))
    (is (search "robot" (prin1-to-string reasoner)))))

(test with-reasoner-closes-what-is-left
  (let ((left nil))
    (is (equal '(1 2) (multiple-value-list (ec:with-reasoner (reasoner (robot) :horizon 1)
                                             (setf left reasoner)
                                             (values 1 2)))))
    (signals-with (error "closed") (ec:models left))
    (catch 'out (ec:with-reasoner (reasoner (robot) :horizon 1)
                  (setf left reasoner)
                  (throw 'out nil)))
    (signals-with (error "closed") (ec:models left))))

(test assumptions-and-open-events
  (let ((theory (robot '(:completion happens))))
    (ec:with-reasoner (reasoner theory :horizon 2 :assumptions '((holds-at (carrying) 2)))
      (is (equal '(0 t) (multiple-value-list (ec:count-models reasoner)))))
    (ec:with-reasoner (reasoner theory :horizon 2 :assumptions '((holds-at (carrying) 2))
                                       :open-events '(:go :lift))
      (is (= 1 (ec:count-models reasoner)))
      (is-true (ec:entailed-p reasoner '(happens (lift) 1))))
    (signals-with (ec:theory-error "flying")
      (ec:make-reasoner theory :horizon 2 :assumptions '((holds-at (flying) 2))))
    (signals-with (ec:theory-error "dance") (ec:make-reasoner theory :horizon 2
                                                                     :open-events '(dance)))))

;;; Time, threads, seeds

(defun pigeons (count)
  "Return the theory of COUNT pigeons in one hole less, which Z3 needs long to refute."
  (ec::parse-theory
   'pigeons `((:sorts (pigeon (:range 1 ,count)) (hole (:range 2 ,count)))
              (:fluents (in pigeon hole))
              (:axioms (exists (?hole) (holds-at (in ?pigeon ?hole) 0))
                       (implies (and (holds-at (in ?pigeon1 ?hole) 0)
                                     (holds-at (in ?pigeon2 ?hole) 0))
                                (= ?pigeon1 ?pigeon2)))
              (:time 0 0))))

(test running-out-of-time
  "Unknown is never taken for no."
  (is-false (ec:consistent-p (pigeons 5)))
  (ec:with-reasoner (reasoner (pigeons 14) :timeout 0.02)
    (dolist (question (list (lambda () (ec:consistent-p reasoner))
                            (lambda () (ec:models reasoner))
                            (lambda () (ec:count-models reasoner))
                            (lambda () (ec:possible-p reasoner '(holds-at (in 1 2) 0)))
                            (lambda () (ec:entailed-p reasoner '(holds-at (in 1 2) 0)))
                            (lambda () (ec:consequences reasoner))))
      (signals-with (z3:solver-unknown "timeout") (funcall question)))
    ;; What is easy is still answered.
    (is-false (ec:possible-p reasoner '(forall (?hole) (not (holds-at (in 1 ?hole) 0)))))
    ;; Who will not wait may go on as if there were a model.
    (is-true (handler-bind ((z3:solver-unknown
                              (lambda (condition)
                                (invoke-restart (find-restart 'z3:treat-as-sat condition)))))
               (ec:consistent-p reasoner)))))

(test interrupted-reasoners-stay-usable
  (ec:with-reasoner (reasoner (pigeons 14))
    (dotimes (round 2)
      (is (eq :interrupted (handler-case (sb-ext:with-timeout 0.1 (ec:consistent-p reasoner))
                             (sb-ext:timeout () :interrupted))))
      (is (eq :interrupted (handler-case (sb-ext:with-timeout 0.1 (ec:models reasoner))
                             (sb-ext:timeout () :interrupted))))
      (is-false (ec:possible-p reasoner '(forall (?hole) (not (holds-at (in 1 ?hole) 0))))))))

(test an-interrupted-growth-is-not-half-a-theory
  "The answers after an interruption are those of the old or of the new horizon."
  (let ((theory (robot)))
    (ec:with-reasoner (reasoner theory :horizon 2)
      (dotimes (round 8)
        (handler-case (sb-ext:with-timeout (* 0.002 (1+ round))
                        (ec:extend-horizon reasoner 2)
                        (ec:extend-horizon reasoner 40))
          (sb-ext:timeout ()))
        (let ((last (cdr (ec:reasoner-horizon reasoner))))
          (is (member last '(2 40)))
          (is-true (ec:possible-p reasoner `(and (holds-at (at cellar) ,(1- last))
                                                 (holds-at (at hall) ,last))))
          (is-false (ec:possible-p reasoner `(and (holds-at (at cellar) ,last)
                                                  (holds-at (at hall) ,last))))
          (is-false (ec:possible-p reasoner `(and (holds-at (carrying) ,(1- last))
                                                  (not (happens (drop) ,(1- last)))
                                                  (not (holds-at (carrying) ,last))))))))))

(test two-reasoners-in-two-threads
  (let* ((theory (robot))
         (expected (ec:count-models theory :horizon 3))
         (threads (loop for number below 3
                        collect (sb-thread:make-thread
                                 (lambda ()
                                   (ec:with-reasoner (reasoner theory :horizon 3)
                                     (loop repeat 5
                                           collect (ec:count-models reasoner)
                                           collect (ec:count-models theory :horizon 3))))))))
    (dolist (thread threads)
      (is (equal (make-list 10 :initial-element expected) (sb-thread:join-thread thread))))))

(defun model-lists (theory &rest options)
  "Return all that the first models of THEORY say, in their order."
  (let ((reasoner (apply #'ec:make-reasoner theory options)))
    (unwind-protect (loop for model in (ec:models reasoner :limit 30)
                          collect (loop for time from 0 to 3
                                        collect (ec:model-fluents model time)
                                        collect (ec:model-events model time)))
      (ec:close-reasoner reasoner))))

(test the-same-models-in-the-same-order
  (let ((theory (robot '(:time 0 3))))
    (dolist (seed '(nil 1 7))
      (is (equal (model-lists theory :seed seed) (model-lists theory :seed seed))))
    (is (equal (model-lists theory) (model-lists (robot '(:time 0 3))))
        "nor does it matter when the theory was defined")
    (flet ((plans (seed) (ec:abduce theory '(box-at hall) :horizon 6 :limit 5 :seed seed)))
      (is (equal (plans 3) (plans 3))))))
