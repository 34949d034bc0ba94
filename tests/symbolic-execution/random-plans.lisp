;;;; Soundness and completeness of exploration: random plans, run symbolically once and concretely
;;;; from every initial state, with all arguments and all outcomes that the theory allows.
;;;;
;;;; A run is described by its SIGNATURE: what it prints (a mark in each branch, and at the end the
;;;; globals that it has changed), its steps with events and outcomes, and how it ends.  Concretely
;;;; the compiled plan runs with an executive that knows one concrete state and tries the outcomes
;;;; by a script.

(in-package #:discrepancy-finder.tests)

(def-suite random-plans :in all)
(in-suite random-plans)

(defclass gadget-domain (symbolic:action-theory) ())

(defparameter *gadget-theory* "
(define-theory gadgets
  (:sorts (item a b) (spot p q))
  (:fluents (ready item) (jammed item) (alarm) (at spot))
  (:events (press item) (shake item) (jam item) (walk spot))
  (:axioms
   (press-starts (implies (not (holds-at (ready ?item) ?time))
                          (initiates (press ?item) (ready ?item) ?time)))
   (press-stops (implies (holds-at (ready ?item) ?time)
                         (terminates (press ?item) (ready ?item) ?time)))
   (jam-jams (initiates (jam ?item) (jammed ?item) ?time))
   (jam-stops (terminates (jam ?item) (ready ?item) ?time))
   (shake-frees (implies (not (holds-at (alarm) ?time))
                         (terminates (shake ?item) (jammed ?item) ?time)))
   (shake-wakes (implies (holds-at (at q) ?time) (initiates (shake ?item) (alarm) ?time)))
   (walk-arrives (initiates (walk ?spot) (at ?spot) ?time))
   (walk-leaves (implies (/= ?spot1 ?spot2) (terminates (walk ?spot1) (at ?spot2) ?time)))
   (jammed-is-not-ready (not (and (holds-at (ready ?item) ?time)
                                  (holds-at (jammed ?item) ?time))))
   (somewhere (or (holds-at (at p) ?time) (holds-at (at q) ?time)))
   (not-everywhere (not (and (holds-at (at p) ?time) (holds-at (at q) ?time))))
   (no-walk-to-where-one-is (implies (happens (walk ?spot) ?time)
                                     (not (holds-at (at ?spot) ?time))))))
(define-state-constraint gadget-ready (?time) (holds-at (ready a) ?time))
")

(defparameter *gadget-actions* "
(define-action (motion pressing) (item)
  (:domain gadgets)
  (:event (press item))
  (:requires (not (jammed item)))
  (:failure gripper-goal-not-reached :when (not (alarm)) :event (jam item))
  (:failure navigation-goal-not-reached :when (and (alarm) (jammed item))))
(define-action (motion shaking) (item)
  (:domain gadgets)
  (:event (shake item))
  (:returns (truth-of (jammed item))))
(define-action (motion walking) (spot)
  (:domain gadgets)
  (:event (walk spot))
  (:failure navigation-goal-not-reached :when (at spot))
  (:returns (value-of (at ?spot) ?spot)))
(define-action (motion looking) (item)
  (:domain gadgets)
  (:event (jam item))
  (:requires (jammed item))
  (:failure navigation-goal-not-reached :when (not (jammed item)) :event (press item))
  (:returns (truth-of (or (ready item) (alarm)))))
")

(defun load-gadgets ()
  (with-file (file *gadget-theory*)
    (symbolic:register-action-theory
     (make-instance 'gadget-domain :name :gadgets :theory (ec:load-theory file))))
  (with-file (file *gadget-actions*)
    (plan:load-plan file))
  (symbolic:find-action-theory :gadgets))

;;; Random plans

(defvar *tally* 0 "A global that random plans change.")
(defvar *notes* (make-hash-table) "An object that random plans change.")

(defun random-of (&rest choices)
  (elt choices (random (length choices))))

(defvar *mark* 0 "The number of the last mark.")

(defun mark ()
  `(princ ,(format nil "~d " (incf *mark*))))

(defun random-item ()
  (random-of 'a 'b 'a 'b '?item))

(defun random-gadget-perform ()
  (random-of `(perform (a motion (type pressing) (item ,(random-item))))
             `(perform (a motion (type pressing) (item ,(random-item))))
             `(perform (a motion (type shaking) (item ,(random-item))))
             `(perform (a motion (type walking) (spot ,(random-of 'p 'q))))
             `(perform (a motion (type looking) (item ,(random-item))))))

(defun random-test (depth)
  (if (and (plusp depth) (zerop (random 3)))
      `(,(random-of 'and 'or) ,(random-test (1- depth)) ,(random-test (1- depth)))
      (random-of '?flag '(not ?flag) '(eq ?item :a) `(< ?count ,(1+ (random 2)))
                 '(evenp discrepancy-finder.tests::*tally*) '(eql ?count 1)
                 '(gethash :key discrepancy-finder.tests::*notes*)
                 `(handler-case ,(random-gadget-perform) (plan-failure () ?flag))
                 `(eq :p (perform (a motion (type walking) (spot ,(random-of 'p 'q))))))))

(defun random-gadget-body (depth)
  (loop repeat (1+ (random 2)) collect (random-gadget-form depth)))

(defun random-gadget-form (depth)
  (if (zerop depth)
      (random-of (random-gadget-perform) (mark) '(incf discrepancy-finder.tests::*tally*))
      (let ((depth (1- depth)))
        (ecase (random (if (symbolic:lifted-function 'sb-kernel:%puthash) 11 9))
          ((0 1 2) `(if ,(random-test 1)
                        (progn ,(mark) ,@(random-gadget-body depth))
                        (progn ,(mark) ,@(random-gadget-body depth))))
          ((3 4) `(with-failure-handling
                      ((,(random-of 'plan-failure 'gripper-goal-not-reached
                                    'navigation-goal-not-reached)
                        () ,(mark) (return)))
                    ,@(random-gadget-body depth)))
          (5 `(with-retry-counters ((tries 1))
                (with-failure-handling
                    ((plan-failure ()
                       ,(mark)
                       (do-retry tries (retry))
                       (return)))
                  ,@(random-gadget-body depth))))
          (6 `(dotimes (i ,(random-of 2 '?count)) ,@(random-gadget-body (min depth 1))))
          (7 `(let ((value ,(random-test 1)))
                (unless value ,(mark) ,@(random-gadget-body depth))
                (when value (incf discrepancy-finder.tests::*tally* 2))))
          (8 `(block leave
                (unwind-protect (when ,(random-test 0) (return-from leave))
                  ,(mark))
                ,@(random-gadget-body depth)))
          ((9 10) `(setf (gethash ,(random-of :key :other) discrepancy-finder.tests::*notes*)
                         ,(random-test 0)))))))

(defun random-plan-text (seed)
  "Return the text of the plan random-plan, a function of SEED."
  (let ((*random-state* (sb-ext:seed-random-state seed)) (*mark* 0)
        (*package* (find-package '#:discrepancy-finder.tests))
        (*print-pretty* nil) (*print-circle* nil) (*print-length* nil) (*print-level* nil))
    (remove-package-prefix
     (prin1-to-string
      `(def-top-level-cram-function random-plan (?flag ?item ?count)
         ,@(loop repeat (+ 2 (random 2)) collect (random-gadget-form 2))
         ,@(and (zerop (random 2)) (list (random-gadget-perform)))
         (princ "end ")
         (princ *tally*)
         (when (gethash :key *notes*) (princ " key")))))))

(defun remove-package-prefix (text)
  "Globals of the tests are written with their package; all other symbols are read in the user's."
  (let ((text (replaced text "*TALLY*" "discrepancy-finder.tests::*tally*")))
    (replaced text "*NOTES*" "discrepancy-finder.tests::*notes*")))

(defun replaced (text old new)
  "Return TEXT with NEW in the place of each OLD."
  (with-output-to-string (out)
    (loop for start = 0 then (+ position (length old))
          for position = (search old text :start2 start)
          do (write-string text out :start start :end position)
          while position
          do (write-string new out))))

;;; Concrete runs

(defclass concrete-executive ()
  ((domain :initarg :domain :reader executive-domain)
   (state :initarg :state :accessor executive-state)
   (script :initarg :script :accessor executive-script
           :documentation "For each perform the number of the outcome among the allowed ones.")
   (taken :initform '() :accessor executive-taken
          :documentation "(number . how many were allowed), the last perform first.")
   (steps :initform '() :accessor executive-steps))
  (:documentation "An executive of one concrete state."))

(defun allowed-outcomes (domain state designator)
  "Return a list of (outcome . state after it) for the outcomes that are allowed in STATE."
  (loop for outcome in (symbolic:action-outcomes domain designator)
        for (next conditions) = (multiple-value-list
                                 (symbolic:outcome-transition domain state outcome))
        when (every (lambda (condition) (eq (cdr condition) t)) conditions)
          collect (cons outcome next)))

(defmethod plan:perform-with ((executive concrete-executive) designator position)
  (declare (ignore position))
  (let* ((allowed (allowed-outcomes (executive-domain executive) (executive-state executive)
                                    designator))
         (number (or (pop (executive-script executive)) 0)))
    (when (null allowed) (plan:leave-plan executive :dead-end))
    (push (cons number (length allowed)) (executive-taken executive))
    (destructuring-bind (outcome . next) (nth number allowed)
      (setf (executive-state executive) next)
      (push (list (symbolic:outcome-event outcome) (symbolic:outcome-name outcome))
            (executive-steps executive))
      (if (eq (symbolic:outcome-name outcome) :success)
          (symbolic::outcome-value outcome next)
          (plan:fail (symbolic:outcome-name outcome))))))

(defun call-from-scratch (function)
  "Call FUNCTION with the globals of random plans as they are between runs."
  (setf *tally* 0)
  (clrhash *notes*)
  (unwind-protect (funcall function)
    (setf *tally* 0)
    (clrhash *notes*)))

(defun concrete-run (domain state arguments script)
  "Run the compiled plan and return its signature and what the executive has taken."
  (let* ((executive (make-instance 'concrete-executive :domain domain :state state
                                                       :script script))
         (ending :finished)
         (output (with-output-to-string (*standard-output*)
                   (call-from-scratch
                    (lambda ()
                      (setf ending
                            (catch executive
                              (handler-case
                                  (plan:with-executive (executive)
                                    (apply 'discrepancy-finder-user::random-plan arguments)
                                    :finished)
                                (plan:plan-failure (failure) (type-of failure))))))))))
    (values (list output (reverse (executive-steps executive)) ending)
            (executive-taken executive))))

(defun next-script (taken)
  "Return the script after the one that has TAKEN these outcomes, or NIL if it was the last one."
  (loop for ((number . count) . earlier) on taken
        when (< (1+ number) count)
          return (reverse (cons (1+ number) (mapcar #'car earlier)))))

(defun map-initial-states (function domain)
  "Call FUNCTION with each concrete initial state of DOMAIN that its theory allows."
  (let* ((ground (symbolic:action-theory-ground domain))
         (fluents (coerce (ec:ground-theory-fluents ground) 'list)))
    (dotimes (bits (expt 2 (length fluents)))
      (let ((state (ec:concrete-state ground
                                      (lambda (atom)
                                        (logbitp (position atom fluents :test #'equal) bits)))))
        (when (every (lambda (condition) (eq (cdr condition) t)) (ec:initial-conditions state))
          (funcall function state))))))

(defun concrete-signatures (domain)
  "Return a table whose keys are the signatures of all concrete runs, and their number."
  (let ((signatures (make-hash-table :test 'equal)) (runs 0))
    (map-initial-states
     (lambda (state)
       (dolist (flag '(t nil))
         (dolist (item '(:a :b))
           (dotimes (count 3)
             (loop for script = '() then (next-script taken)
                   for (signature taken) = (multiple-value-list
                                            (concrete-run domain state (list flag item count)
                                                          script))
                   do (incf runs)
                      (setf (gethash signature signatures) t)
                   while (next-script taken))))))
     domain)
    (values signatures runs)))

;;; Symbolic runs

(defun trace-signature (trace)
  (list (symbolic:trace-output trace)
        (loop for step in (symbolic:trace-steps trace)
              collect (list (symbolic:step-event step) (symbolic:step-outcome step)))
        (symbolic:trace-ending trace)))

(defun whole-traces (&rest options)
  "Return the traces of all paths of the plan as a whole, and the exploration."
  (let ((exploration (apply #'symbolic:make-exploration 'discrepancy-finder-user::random-plan
                            :gadgets :constraint :any-action
                                     :arguments '((?flag boolean) (?item item)
                                                  (?count (integer 0 2)))
                                     options)))
    (unwind-protect
         (values (loop until (symbolic::frontier-empty-p
                              (symbolic::exploration-frontier exploration))
                       append (symbolic::whole-trace (symbolic::run-next-path exploration)))
                 exploration)
      (symbolic:close-exploration exploration))))

(defun repeats-path-p (domain trace)
  "Return true if the plan, run concretely from the initial state of TRACE with its arguments and
outcomes, goes the same way."
  (let* ((ground (symbolic:action-theory-ground domain))
         (true (ec:state-fluents (symbolic:trace-initial-state trace)))
         (wanted (trace-signature trace))
         (state (ec:concrete-state ground (lambda (atom)
                                            (and (member atom true :test #'equal) t)))))
    (loop for script = '() then (next-script taken)
          for (signature taken) = (multiple-value-list
                                   (concrete-run domain state (symbolic:trace-arguments trace)
                                                 script))
          when (equal signature wanted) return t
          while (next-script taken))))

(defun plan-disagreement (domain seed)
  "Return NIL if the plan of SEED has the same paths symbolically and concretely, else a text; and
the numbers of paths and of concrete runs."
  (with-file (file (random-plan-text seed))
    (let ((*error-output* (make-broadcast-stream)))
      (handler-bind ((warning #'muffle-warning)) (plan:load-plan file))))
  (call-from-scratch
   (lambda ()
     (multiple-value-bind (traces exploration) (whole-traces)
       (multiple-value-bind (concrete runs) (concrete-signatures domain)
         (let ((symbolic (make-hash-table :test 'equal)))
           (dolist (trace traces)
             (setf (gethash (trace-signature trace) symbolic) t))
           (values
            (cond ((/= (length traces) (symbolic:exploration-paths exploration))
                   "a path without a state")
                  ((loop for signature being the hash-keys of concrete
                         unless (gethash signature symbolic)
                           return (format nil "not explored: ~s" signature)))
                  ((loop for signature being the hash-keys of symbolic
                         unless (gethash signature concrete)
                           return (format nil "not possible: ~s" signature)))
                  ((notevery (lambda (trace) (repeats-path-p domain trace)) traces)
                   "a model that goes another way"))
            (length traces) runs)))))))

(test random-plans-have-the-paths-that-brute-force-finds
  (let ((domain (load-gadgets)) (count (if *long* 300 150)) (paths 0) (runs 0))
    (dotimes (seed count)
      (multiple-value-bind (disagreement path-count run-count) (plan-disagreement domain seed)
        (incf paths path-count)
        (incf runs run-count)
        (is (null disagreement) "plan ~d: ~a~%~a" seed disagreement (random-plan-text seed))))
    (is (< (* 10 count) paths))
    (is (< (* 160 count) runs))))

(test random-plans-in-any-order-with-a-forgetful-oracle
  "Orders, and contexts of Z3 that are given up all the time, change nothing."
  (load-gadgets)
  (dotimes (seed (if *long* 20 10))
    (with-file (file (random-plan-text seed))
      (let ((*error-output* (make-broadcast-stream)))
        (handler-bind ((warning #'muffle-warning)) (plan:load-plan file))))
    (flet ((keys (&rest options)
             (call-from-scratch
              (lambda ()
                (mapcar (lambda (trace) (list* (trace-signature trace)
                                               (symbolic::trace-key trace)))
                        (apply #'whole-traces options)))))
           (same-p (some others)
             (null (set-exclusive-or some others :test #'equal))))
      (let ((expected (keys)))
        (is-true (same-p expected (keys :order :breadth-first)))
        (is-true (same-p expected (keys :order :random :seed seed)))
        (is-true (same-p expected (keys :order :coverage)))
        (let ((symbolic::*oracle-load* 3))
          (is (equal expected (keys)))
          (is-true (same-p expected (keys :order :breadth-first))))))))
