;;;; Interleavings: pruned orders show the same as all orders, with fewer paths.

(in-package #:discrepancy-finder.tests)

(def-suite interleavings :in all)
(in-suite interleavings)

(defparameter *switch-theory* "
(define-theory switches
  (:sorts (switch a b c))
  (:fluents (on switch) (jammed switch) (power))
  (:events (press switch) (jam switch) (copy switch switch) (inspect switch))
  (:axioms
   (press-on (implies (and (not (holds-at (on ?switch) ?time)))
                      (initiates (press ?switch) (on ?switch) ?time)))
   (press-off (implies (holds-at (on ?switch) ?time)
                       (terminates (press ?switch) (on ?switch) ?time)))
   (jam-jams (initiates (jam ?switch) (jammed ?switch) ?time))
   (copy-on (implies (holds-at (on ?switch1) ?time)
                     (initiates (copy ?switch1 ?switch2) (on ?switch2) ?time)))
   (copy-off (implies (and (not (holds-at (on ?switch1) ?time)) (holds-at (on ?switch2) ?time))
                      (terminates (copy ?switch1 ?switch2) (on ?switch2) ?time)))
   (not-a-and-b (not (and (holds-at (on b) ?time) (holds-at (jammed c) ?time))))
   (power-on (holds-at (power) ?time))))
(define-state-constraint powered (?time) (holds-at (power) ?time))
(define-state-constraint a-without-c (?time)
  (and (holds-at (on a) ?time) (not (holds-at (on c) ?time))))
(define-state-constraint pressed-a (?time)
  (and (happens (press a) ?time) (holds-at (on a) (+ ?time 1))))
(define-state-constraint quiet (?time)
  (and (holds-at (on a) ?time) (holds-at (on a) (+ ?time 1))))
")

(defparameter *switch-actions* "
(define-action (motion pressing) (switch)
  (:domain switches)
  (:event (press switch))
  (:requires (not (jammed switch)))
  (:failure gripper-goal-not-reached :event (jam switch)))
(define-action (motion reading) (switch)
  (:domain switches)
  (:event (inspect switch))
  (:returns (truth-of (on switch))))
(define-action (motion jamming) (switch)
  (:domain switches)
  (:event (jam switch)))
(define-action (motion copying) (from to)
  (:domain switches)
  (:event (copy from to)))
")

(defclass switch-domain (symbolic:action-theory) ())

(defun make-switches ()
  (with-file (file *switch-theory*)
    (symbolic:register-action-theory
     (make-instance 'switch-domain :name :switches :theory (ec:load-theory file))))
  (with-file (file *switch-actions*)
    (plan:load-plan file)))

(defun explore-switches (text interleavings &rest options &key (constraint 'powered)
                         &allow-other-keys)
  (with-file (file text)
    (plan:load-plan file)
    (apply #'symbolic:explore-plan 'discrepancy-finder-user::switch-plan :domain :switches
           :interleavings interleavings :constraint constraint
           (alexandria:remove-from-plist options :constraint))))

(defun step-key (step)
  (format nil "~a ~a" (symbolic:step-designator step) (symbolic:step-text step)))

(defun outcomes-of-traces (exploration)
  "Return the set of (initial state, final state, steps in some fixed order) of the traces."
  (remove-duplicates
   (loop for trace in (symbolic:exploration-traces exploration)
         collect (list (ec:state-fluents (symbolic:trace-initial-state trace))
                       (ec:state-fluents (symbolic:trace-final-state trace))
                       (sort (mapcar #'step-key (symbolic:trace-steps trace)) #'string<)))
   :test #'equal))

(defun check-pruning (text &rest options)
  "Check that pruned exploration of the plan in TEXT finds what complete exploration finds, and
return the numbers of their paths."
  (let* ((all (apply #'explore-switches text :all options))
         (pruned (apply #'explore-switches text t options))
         (expected (outcomes-of-traces all))
         (found (outcomes-of-traces pruned)))
    (is-true (symbolic:exploration-complete-p all))
    (is-true (symbolic:exploration-complete-p pruned))
    (is (null (set-exclusive-or expected found :test #'equal))
        "~a~%differ in ~{~%  ~s~}" text (set-exclusive-or expected found :test #'equal))
    (is (<= (symbolic:exploration-paths pruned) (symbolic:exploration-paths all)))
    (values (symbolic:exploration-paths pruned) (symbolic:exploration-paths all))))

(defparameter *handled* "(with-failure-handling ((gripper-goal-not-reached () (return)))~%~a)")

(test independent-branches-are-explored-in-one-order
  (make-switches)
  (is (equal '(1 20)
             (multiple-value-list (check-pruning "
(def-top-level-cram-function switch-plan ()
  (par (perform (a motion (type copying) (from a) (to a)))
       (perform (a motion (type copying) (from c) (to c)))))"))))
  (multiple-value-bind (pruned all)
      (check-pruning "
(def-top-level-cram-function switch-plan ()
  (par (progn (perform (a motion (type copying) (from a) (to a)))
              (perform (a motion (type copying) (from a) (to a))))
       (perform (a motion (type copying) (from c) (to c)))))")
    (is (= 1 pruned))
    (is (< 20 all))))

(test what-shares-a-fluent-is-explored-in-both-orders
  (make-switches)
  (dolist (second '("(type copying) (from a) (to b)" ; looks at what the other changes
                    "(type copying) (from b) (to a)" ; changes the same
                    ))
    (let ((exploration (explore-switches (format nil "
(def-top-level-cram-function switch-plan ()
  (par (perform (a motion (type pressing) (switch a)))
       (perform (a motion ~a))))" second)
                                         t)))
      (is (= 2 (length (remove-duplicates
                        (loop for trace in (symbolic:exploration-traces exploration)
                              for steps = (symbolic:trace-steps trace)
                              when (every (lambda (step) (eq :success (symbolic:step-outcome step)))
                                          steps)
                                collect (mapcar #'symbolic:step-event steps))
                        :test #'equal)))
          "~a" second)))
  (is (< 3 (check-pruning "
(def-top-level-cram-function switch-plan ()
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (par (perform (a motion (type pressing) (switch a)))
         (perform (a motion (type jamming) (switch a))))))"))
      "one requires that the other does not happen")
  (is (< 3 (check-pruning "
(def-top-level-cram-function switch-plan ()
  (par (perform (a motion (type pressing) (switch a)))
       (when (perform (a motion (type reading) (switch a)))
         (perform (a motion (type copying) (from c) (to c))))))"))
      "what perform returns is looked at")
  (is (= 2 (check-pruning "
(def-top-level-cram-function switch-plan ()
  (par (perform (a motion (type jamming) (switch c)))
       (perform (a motion (type copying) (from a) (to b)))))"))
      "they share a state constraint"))

(test what-shares-a-variable-is-explored-in-both-orders
  (make-switches)
  (flet ((paths (one other)
           (check-pruning (format nil "
(def-top-level-cram-function switch-plan ()
  (let ((x 1) (y 2))
    (par (progn ~a (perform (a motion (type copying) (from a) (to a))))
         (progn ~a (when (= x 1) (perform (a motion (type copying) (from c) (to c))))))
    y))" one other))))
    (is (= 1 (paths "(list x)" "(list x)")))
    (is (= 1 (paths "(setf y 3)" "(list x)")))
    (is (< 1 (paths "(setf x 3)" "(list x)")))
    (is (= 1 (paths "(let ((z 1)) (setf z x))" "(let ((z 1)) (incf z))")))
    (is (< 1 (paths "(some-function-that-may-do-anything)" "nil")))))

(defun discrepancy-finder-user::some-function-that-may-do-anything ()
  nil)

(test the-explored-constraint-is-shared
  "An order counts in which it comes true in between."
  (make-switches)
  (check-pruning "
(def-top-level-cram-function switch-plan ()
  (par (perform (a motion (type pressing) (switch a)))
       (perform (a motion (type pressing) (switch c)))))" :constraint 'a-without-c)
  (dolist (constraint '(pressed-a quiet))
    (check-pruning "
(def-top-level-cram-function switch-plan ()
  (par (perform (a motion (type copying) (from b) (to a)))
       (perform (a motion (type copying) (from c) (to c)))))" :constraint constraint)))

(test orders-of-pursue-and-try-all
  (make-switches)
  (dolist (operator '("pursue" "try-all" "par"))
    (check-pruning (format nil "
(def-top-level-cram-function switch-plan ()
  (with-failure-handling ((plan-failure () (return)))
    (~a (progn (perform (a motion (type pressing) (switch a)))
               (perform (a motion (type pressing) (switch a))))
        (perform (a motion (type copying) (from c) (to c))))
    (perform (a motion (type copying) (from c) (to b)))))" operator))))

(test orders-of-nested-branches
  (make-switches)
  (check-pruning "
(def-top-level-cram-function switch-plan ()
  (par (par (perform (a motion (type copying) (from a) (to b)))
            (perform (a motion (type copying) (from c) (to c))))
       (perform (a motion (type copying) (from b) (to a)))))"))

(test the-order-of-paths-does-not-matter
  "Runs note the orders that their own turns ask for, so that nothing depends on who comes first."
  (make-switches)
  (let* ((text "
(def-top-level-cram-function switch-plan ()
  (with-failure-handling ((plan-failure () (return)))
    (pursue (progn (perform (a motion (type pressing) (switch a)))
                   (perform (a motion (type copying) (from a) (to b))))
            (perform (a motion (type copying) (from b) (to a))))))")
         (expected (outcomes-of-traces (explore-switches text :all))))
    (dolist (order '(:depth-first :breadth-first :random :coverage))
      (is (null (set-exclusive-or expected
                                  (outcomes-of-traces (explore-switches text t :order order))
                                  :test #'equal))
          "~a" order))))

;;; Random plans

(defun random-switch (state)
  (elt #("a" "b" "c") (random 3 state)))

(defun random-switching (state)
  (case (random 4 state)
    (0 (format nil *handled* (format nil "(perform (a motion (type pressing) (switch ~a)))"
                                     (random-switch state))))
    (1 (format nil "(perform (a motion (type jamming) (switch ~a)))" (random-switch state)))
    (2 (format nil "(perform (a motion (type pressing) (switch ~a)))" (random-switch state)))
    (t (format nil "(perform (a motion (type copying) (from ~a) (to ~a)))"
               (random-switch state) (random-switch state)))))

(defun random-branch (state count value)
  (format nil "(progn ~{~a~^ ~} ~a)"
          (loop repeat count
                collect (case (random 6 state)
                          (0 (format nil "(progn (setf x (not x)) ~a)" (random-switching state)))
                          (1 (format nil "(if x ~a)" (random-switching state)))
                          (t (random-switching state))))
          value))

(defun random-parallel-plan (state)
  (format nil "
(def-top-level-cram-function switch-plan ()
  (let ((x nil))
    (list x)
    (with-failure-handling ((plan-failure () (return)))
      (if (eql 1 (~a ~a~%          ~a))
          ~a
          (perform (a motion (type jamming) (switch b)))))))"
          (elt #("par" "par" "pursue" "try-all") (random 4 state))
          (random-branch state (1+ (random 2 state)) 1) (random-branch state (random 2 state) 2)
          (random-switching state)))

(test pruning-loses-nothing-on-random-plans
  (make-switches)
  (let ((state (sb-ext:seed-random-state 1)) (pruned 0) (all 0))
    (dotimes (i 50)
      (multiple-value-bind (fewer paths) (check-pruning (random-parallel-plan state))
        (incf pruned fewer)
        (incf all paths)))
    (is (< pruned all) "~d paths instead of ~d" pruned all)))

(test what-a-fluent-of-the-plan-shows-depends-on-the-order
  "One branch sets it twice, the other may look at it between."
  (make-lamp-domain)
  (flet ((outputs (interleavings)
           (remove-duplicates
            (mapcar #'symbolic:trace-output
                    (symbolic:exploration-traces
                     (explore-text "
(def-top-level-cram-function lamp-plan ()
  (let ((f (make-fluent :value 0)))
    (par (progn (perform (a motion (type smashing) (lamp a)))
                (setf (value f) 1)
                (perform (a motion (type smashing) (lamp a)))
                (setf (value f) 2))
         (progn (wait-for (> f 0))
                (perform (a motion (type smashing) (lamp b)))
                (princ (value f))))))"
                                   :constraint 'anything :interleavings interleavings
                                   :traces :every-state)))
            :test #'equal)))
    (is (alexandria:set-equal (outputs :all) (outputs t) :test #'equal))
    (is (= 2 (length (outputs t))))))
