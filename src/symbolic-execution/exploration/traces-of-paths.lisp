;;;; From paths to traces: where a state constraint comes true on a path, and from which state.
;;;;
;;;; What is handed out (the option :TRACES of an exploration):
;;;;   :LAST             one trace a path, cut after the last time at which the constraint holds
;;;;   :EVERY-INSTANCE   each prefix of a path that ends in an instance; what holds on the path
;;;;                     later is not asked for
;;;;   :FIRST-INSTANCE   only the shortest of them on each path
;;;;   :EVERY-STATE      as :LAST, from every initial state, the least first
;;;; A path may go on to a failure, or to where the theory allows nothing.  What the path leaves
;;;; open of the initial state may be asked for, too: a trace has ALTERNATIVES then.  Entry point:
;;;; PATH-TRACES.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (finished-run (:conc-name run-) (:copier nil))
  "A run that is over: its PATH, the symbolic ARGUMENTS, what it has printed, and what is looked
for on it: the ground FORMULA of a state constraint over SPAN steps, and alternatives that differ
in ATOMS.  FIRST-P is true while no earlier run had a trace."
  (path nil :type path :read-only t)
  (arguments '() :type list :read-only t)
  (output "" :type string :read-only t)
  (formula nil :read-only t)
  (span 0 :type (integer 0) :read-only t)
  (atoms '() :type list :read-only t)
  (first-p nil :type boolean :read-only t)
  (missed nil :type boolean))             ; whether Z3 found no state where there may be one

(defun run-oracle (run) (path-oracle (run-path run)))

(defun instances (run)
  "Return a list of (time . proposition) for the timepoints at which the constraint of RUN may
hold, the last first."
  (loop for states on (reverse (path-states (run-path run)))
        for time from 0
        while (nthcdr (run-span run) states)
        for proposition = (ec:holds (run-formula run)
                                       (subseq states 0 (1+ (run-span run))))
        when proposition collect (cons time proposition) into instances
        finally (return (nreverse instances))))

(defun depth-at (path step-count)
  "Return how many decisions PATH has made when it has made STEP-COUNT steps."
  (if (zerop step-count)
      0
      (elt (path-step-depths path) (- (length (path-steps path)) step-count))))

(defun decisions-before (path step-count)
  "Return the TRACE-DECISIONs that PATH makes up to the step STEP-COUNT."
  (let ((depth (depth-at path step-count)) (depths (reverse (path-step-depths path))))
    (loop for decision in (reverse (path-decisions path))
          for number from 1 to depth
          do (loop while (and depths (> number (first depths))) do (pop depths))
          unless (eql number (first depths))
            collect (make-trace-decision
                     :text (decision-description decision)
                     :choice (prin1-to-string (decision-value decision))
                     :time (- (length (path-steps path)) (length depths))))))

(defun make-trace (run length arguments states)
  (let ((path (run-path run)))
    (make-execution-trace
     :plan (path-plan path) :arguments arguments :states states
     :steps (subseq (reverse (path-steps path)) 0 length)
     :decisions (decisions-before path length)
     :ending (path-ending path) :output (run-output run))))

(defmacro with-oracle-scope ((oracle) &body body)
  "Evaluate BODY in a scope of the solver of ORACLE of its own."
  (let ((solver (gensym "SOLVER")))
    `(let ((,solver (oracle-solver ,oracle)))
       (z3:push-scope ,solver)
       (multiple-value-prog1 (progn ,@body)
         (z3:pop-scope ,solver)))))

(defun least-trace (run length &optional note)
  "Return the trace of the first LENGTH steps of RUN with the least arguments from the least initial
state that the solver allows, or NIL if it finds none.  NOTE is called with the assignment."
  (let* ((assignment (make-assignment (run-oracle run)))
         (arguments (run-arguments run))
         (states (subseq (reverse (path-states (run-path run))) 0 (1+ length))))
    (or (catch assignment
          (fix-states assignment (mapcan #'argument-terms (copy-list arguments)) states)
          (when note (funcall note assignment))
          (make-trace run length (concrete-arguments assignment arguments)
                      (concrete-states-of assignment states)))
        (progn (setf (run-missed run) t)
               nil))))

;;; Alternatives

(defparameter *alternatives-wanted* 63
  "A trace has at most so many alternatives.")

(defun other-values (run trace)
  "Return the proposition that one of the atoms of RUN is initially another than in TRACE."
  (let ((initial (first (last (path-states (run-path run))))))
    (z3:disjunction
     (loop for atom in (run-atoms run)
           for proposition = (ec:fluent-value initial atom)
           when (z3:term-p proposition)
             collect (if (ec:fluent-value (trace-initial-state trace) atom)
                         (z3:negation proposition)
                         proposition)))))

(defun another-trace-p (run others)
  "Hold that the atoms of RUN are others than in the first of OTHERS, its traces found so far, in
the open scope of the solver.  Return true if there may be such a trace."
  (let ((oracle (run-oracle run)) (difference (other-values run (first others))))
    (and difference
         (progn (assert-all oracle (list difference))
                (not (eq (ask oracle) :unsat))))))

(defun trace-and-alternatives (run length)
  "Return the trace of the first LENGTH steps of RUN from the least initial state that the solver
allows, with its alternatives; or NIL if it finds none."
  (let ((oracle (run-oracle run)))
    (flet ((next-least ()
             (with-oracle-scope (oracle) (least-trace run length))))
      (with-oracle-scope (oracle)
        (let* ((trace (next-least)) (found (and trace (list trace))))
          (loop while (and found (another-trace-p run found))
                do (let ((other (and (<= (length found) *alternatives-wanted*) (next-least))))
                     (unless other
                       (setf (trace-more-p trace) t)
                       (return))
                     (push other found)))
          (when found
            (setf (trace-alternatives trace) (rest (reverse found))))
          trace)))))

(defun last-trace (run)
  "Return the list of the trace of RUN that ends with its last instance; or NIL."
  (loop for (time . proposition) in (instances run)
        when (possible-p (run-path run) proposition)
          do (let ((oracle (run-oracle run)))
               (return (with-oracle-scope (oracle)
                         (assert-all oracle (list proposition))
                         (let ((trace (trace-and-alternatives run (+ time (run-span run)))))
                           (and trace (list trace))))))))

(defun prefix-traces (run)
  "Return the traces of the prefixes of RUN that end in an instance, the shortest first, but for
those that an earlier run with the same beginning had."
  (let ((traces '()) (path (run-path run)) (oracle (run-oracle run)))
    (loop for (time . proposition) in (instances run)
          for length = (+ time (run-span run))
          for depth = (depth-at path length)
          do (when (< depth (path-repeated path)) (return))
             (retract-to-depth oracle depth)
             (with-oracle-scope (oracle)
               (assert-all oracle (list proposition))
               (unless (eq (ask oracle) :unsat)
                 (let ((trace (trace-and-alternatives run length)))
                   (when trace (push trace traces))))))
    traces))

(defun first-trace (run)
  "Return the list of the trace of RUN that ends with its first instance; or NIL, also if an earlier
run with the same beginning had it."
  (let ((path (run-path run)) (oracle (run-oracle run)) (first nil) (repeated nil))
    (loop for instance in (instances run)
          for (time . proposition) = instance
          for depth = (depth-at path (+ time (run-span run)))
          for repeated-p = (< depth (path-repeated path))
          do (when (and repeated-p (run-first-p run)) (return)) ; then there was no instance
             (retract-to-depth oracle depth)
             (when (possible-p path proposition)
               (setf first instance
                     repeated repeated-p)))
    (when (and first (not repeated))
      (destructuring-bind (time . proposition) first
        (with-oracle-scope (oracle)
          (assert-all oracle (list proposition))
          (let ((trace (trace-and-alternatives run (+ time (run-span run)))))
            (and trace (list trace))))))))

(defun whole-trace (run)
  "Return the list of the trace of RUN as a whole."
  (let ((oracle (run-oracle run)))
    (with-oracle-scope (oracle)
      (let ((trace (trace-and-alternatives run (length (path-steps (run-path run))))))
        (and trace (list trace))))))

;;; Every state

(defun difference-from (run assignment)
  "Return the proposition that the initial state of RUN, or an argument, is another than by
ASSIGNMENT."
  (z3:disjunction
   (loop for term in (append (mapcan #'argument-terms (copy-list (run-arguments run)))
                             (state-terms (first (last (path-states (run-path run))))))
         for value = (term-value assignment term)
         when (z3:term-p term)
           collect (cond ((not (proposition-p term)) (z3:negation (z3:equals term value)))
                         (value (z3:negation term))
                         (t term)))))

(defun state-source (run)
  "Return a function that returns the next trace of RUN, each from another initial state, and NIL
after the last one.  The solver must not be used otherwise meanwhile."
  (let* ((oracle (run-oracle run)) (solver (oracle-solver oracle))
         (instances (instances run)) (proposition nil) (length nil) (scopes 0))
    (labels ((hold (proposition)
               (z3:push-scope solver)
               (incf scopes)
               (z3:solver-assert solver proposition))
             (release (count)
               (z3:pop-scope solver count)
               (decf scopes count))
             (next-instance ()
               "Go on to the states in which the constraint holds last at an earlier time."
               (when length
                 (release 1)
                 (hold (z3:negation proposition)))
               (if instances
                   (let ((instance (pop instances)))
                     (setf proposition (cdr instance)
                           length (+ (car instance) (run-span run)))
                     (hold proposition)
                     t)
                   (progn (release scopes)
                          nil)))
             (next-state ()
               (let* ((difference nil)
                      (trace (with-oracle-scope (oracle)
                               (and (not (eq (ask oracle) :unsat))
                                    (least-trace
                                     run length
                                     (lambda (assignment)
                                       (setf difference
                                             (difference-from run assignment))))))))
                 (when trace
                   (z3:solver-assert solver difference)
                   trace))))
      (lambda ()
        (loop
          (let ((trace (and length (next-state))))
            (when trace (return trace))
            (unless (next-instance)
              (setf length nil)
              (return nil))))))))

(defun path-traces (run mode)
  "Return a function that returns the next trace of RUN by the rules of MODE, or NIL."
  (if (eq mode :every-state)
      (state-source run)
      (let ((traces (ecase mode
                      (:last (last-trace run))
                      (:first-instance (first-trace run))
                      (:every-instance (prefix-traces run)))))
        (lambda () (pop traces)))))
