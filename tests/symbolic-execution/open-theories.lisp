;;;; Symbolic execution with theories that leave something open: coins that fall, events that are
;;;; triggered, axioms about all times to come.

(in-package #:discrepancy-finder.tests)

(def-suite open-theories :in all)
(in-suite open-theories)

(defclass coin-domain (symbolic:action-theory) ())

(defparameter *coin-theory* "
(define-theory coins
  (:sorts (coin c1 c2))
  (:fluents (heads coin) (lamp) (paid coin))
  (:events (toss coin) (pay coin) (light))
  (:axioms
   (releases (toss ?coin) (heads ?coin) ?time)
   (initiates (pay ?coin) (paid ?coin) ?time)
   (initiates (light) (lamp) ?time)
   (both-heads-light
    (implies (and (holds-at (heads c1) ?time) (holds-at (heads c2) ?time)
                  (not (holds-at (lamp) ?time)))
             (happens (light) ?time)))~@[
   ~a~]))
(define-state-constraint coin-paid (?time)
  (exists (?coin) (happens (pay ?coin) ?time)))
(define-state-constraint lamp-lit (?time)
  (holds-at (lamp) (+ ?time 1)))
(define-state-constraint lit-by-itself (?time)
  (happens (light) ?time))
")

(defun load-coin-plan (text &optional axiom)
  "Define the domain, with AXIOM as one more of the theory, and the plan coin-plan in TEXT."
  (with-file (file (format nil *coin-theory* axiom))
    (symbolic:register-action-theory
     (make-instance 'coin-domain :name :coins :theory (ec:load-theory file))))
  (symbolic:define-action (motion tossing) (coin)
    (:domain coins)
    (:event (toss coin)))
  (symbolic:define-action (motion paying) (coin)
    (:domain coins)
    (:event (pay coin))
    (:requires (heads coin))
    (:failure plan:gripper-goal-not-reached))
  (with-file (file text)
    (plan:load-plan file)))

(defun explore-coins (constraint text &optional axiom)
  (load-coin-plan text axiom)
  (symbolic:explore-plan 'discrepancy-finder-user::coin-plan :domain :coins
                                                             :constraint constraint))

(defun trace-fluents (exploration)
  "Return the true fluents of all states of the traces of EXPLORATION."
  (loop for trace in (symbolic:exploration-traces exploration)
        collect (mapcar #'ec:state-fluents (symbolic:trace-states trace))))

(test states-of-a-trace-are-those-that-its-path-allows
  "What a toss gives is decided by what happens later; what stays released then is tails."
  (let ((exploration (explore-coins 'coin-paid "
(def-top-level-cram-function coin-plan ()
  (perform (a motion (type tossing) (coin c2)))
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (perform (a motion (type paying) (coin c2)))))")))
    (is (= 2 (symbolic:exploration-paths exploration)))
    (is-true (symbolic:exploration-complete-p exploration))
    (is (equal '((() ((:heads :c2)) ((:paid :c2)))) (trace-fluents exploration)))))

(test triggered-events-are-part-of-a-trace
  (let ((exploration (explore-coins 'lit-by-itself "
(def-top-level-cram-function coin-plan ()
  (perform (a motion (type tossing) (coin c1)))
  (perform (a motion (type tossing) (coin c2))))")))
    ;; The last instance of the constraint is at the second step: both coins show heads before it,
    ;; and the first one after it as the toss of the other leaves it.
    (is (equal '((((:heads :c2)) ((:heads :c1) (:heads :c2)) ((:lamp))))
               (trace-fluents exploration)))
    (is (equal '(((:toss :c2) . t) ((:light) . t))
               (ec:state-happenings (symbolic:trace-final-state
                                     (first (symbolic:exploration-traces exploration))))))))

(test traces-are-functions-of-their-paths
  "Paths that are run in another order give the same traces."
  (load-coin-plan "
(def-top-level-cram-function coin-plan ()
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (perform (a motion (type paying) (coin c1))))
  (perform (a motion (type tossing) (coin c1)))
  (perform (a motion (type tossing) (coin c2)))
  (perform (a motion (type tossing) (coin c1))))")
  (flet ((traces (&rest options)
           (sort (mapcar (lambda (trace)
                           (princ-to-string (mapcar #'ec:state-fluents
                                                    (symbolic:trace-states trace))))
                         (symbolic:exploration-traces
                          (apply #'symbolic:explore-plan 'discrepancy-finder-user::coin-plan
                                 :domain :coins :constraint 'lamp-lit options)))
                 #'string<)))
    (is (< 1 (length (traces))))
    (is (equal (traces) (traces :order :breadth-first)))
    (is (equal (traces) (traces :order :coverage)))
    (dotimes (seed 5)
      (is (equal (traces) (traces :order :random :seed seed))))))

(test what-progression-cannot-judge-is-a-gap
  (let ((exploration (explore-coins 'coin-paid "
(def-top-level-cram-function coin-plan ()
  (perform (a motion (type paying) (coin c1))))"
                                    "(payday (exists (?time) (holds-at (paid c2) ?time)))")))
    (is (equal '("what axiom payday says: it speaks of all timepoints to come")
               (symbolic:exploration-gaps exploration)))
    (is-false (symbolic:exploration-complete-p exploration))))

(test states-along-steps
  (explore-coins 'coin-paid "(def-top-level-cram-function coin-plan () 1)")
  (let ((ground (symbolic:action-theory-ground (symbolic:find-action-theory :coins))))
    (flet ((along (fluents &rest events)
             (flet ((answer (context)
                      (multiple-value-bind (states refused)
                          (symbolic:states-along
                           ground fluents
                           (loop for event in events
                                 collect (symbolic:make-trace-step :event event))
                           :context context)
                        (or refused (mapcar #'ec:state-fluents states)))))
               (z3:with-context (context)
                 ;; What was asked before in the same context makes no difference.
                 (is (equal (answer nil) (answer context)))
                 (is (equal (answer nil) (answer context))))
               (answer nil))))
      (is (equal '(() () ((:paid :c1))) (along '() '(:toss :c1) '(:pay :c1))))
      (is (equal '(((:heads :c1) (:heads :c2)) ((:heads :c1) (:heads :c2) (:lamp)))
                 (along '((:heads :c1) (:heads :c2)) nil))))))
