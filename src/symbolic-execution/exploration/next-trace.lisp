;;;; The next trace of an exploration: run paths until one has a trace.
;;;;
;;;; Entry points: NEXT-TRACE, EXPLORE-PLAN.

(in-package #:discrepancy-finder.symbolic-execution)

(defparameter *oracle-load* 100000
  "After so many new options Z3 is given a new context, so that old terms need no memory.")

(defun note-gap (exploration control &rest arguments)
  (pushnew (apply #'format nil control arguments) (exploration-gaps exploration)
           :test #'string=))

(defun note-limits (exploration path)
  "Note what the theory says and progression along PATH does not."
  (dolist (text (path-limits path))
    (note-gap exploration "~a" text))
  (loop for (axiom . reason) in (ec:state-limits (first (path-states path)))
        do (note-gap exploration "what ~a says: ~a"
                     (if (typep axiom 'ec:axiom)
                         (format nil "axiom ~a" (ec:name-text (ec:axiom-name axiom)))
                         (ec:formula-text axiom))
                     reason)))

(defun note-ending (exploration path)
  "Note what a bound has cut off PATH."
  (case (path-ending path)
    (:dead-end (incf (exploration-dead-ends exploration)))
    (:too-many-steps
     (note-gap exploration "paths of more than ~d step~:p" (exploration-max-steps exploration)))
    (:too-many-jumps
     (note-gap exploration "paths of more than ~d iteration~:p"
               (exploration-max-jumps exploration)))
    (:out-of-time (note-time exploration))))

(defun note-time (exploration)
  (note-gap exploration "what takes more than ~f seconds" (exploration-max-seconds exploration)))

(defun note-unknowns (exploration unknowns)
  (when (plusp unknowns)
    (note-gap exploration "whether everything that was taken for possible is so: Z3 could not ~
                           answer every question")))

;;; Runs

(defun visible-formula (exploration)
  "Return the ground formula that says which steps of EXPLORATION traces depend on, or :ANY."
  (if (and (not (eq (exploration-constraint exploration) :any-action))
           (eq (exploration-mode exploration) :last))
      (exploration-formula exploration)
      :any))

(defun exploration-span (exploration)
  "Return how many steps an instance of the constraint of EXPLORATION takes."
  (let ((constraint (exploration-constraint exploration)))
    (if (eq constraint :any-action) 1 (ec:state-constraint-span constraint))))

(defun current-initial-state (exploration)
  "Return the symbolic initial state in the present context of EXPLORATION."
  (let* ((oracle (exploration-oracle exploration))
         (known (exploration-initial-state exploration)))
    (if (eql (car known) (oracle-epoch oracle))
        (cdr known)
        (let ((ground (action-theory-ground (exploration-domain exploration))))
          (dolist (argument (current-arguments exploration))
            (dolist (proposition (argument-conditions argument))
              (oracle-assume oracle proposition)))
          (multiple-value-bind (state consistent) (initial-state-of oracle ground)
            (setf (exploration-consistent-p exploration) consistent
                  (exploration-initial-state exploration) (cons (oracle-epoch oracle) state))
            state)))))

(defun current-arguments (exploration)
  "Return new symbolic arguments in the present context of EXPLORATION."
  (make-arguments (exploration-types exploration)
                  (action-theory-theory (exploration-domain exploration))
                  (oracle-context (exploration-oracle exploration))))

(defun deadline (exploration)
  "Return when EXPLORATION has to end, on the monotonic clock, or NIL."
  (let ((seconds (exploration-max-seconds exploration)))
    (and seconds
         (+ (foreign:monotonic-seconds) (- (float seconds 1d0) (exploration-time exploration))))))

(defun make-run-path (exploration prefix)
  "Return a path for a run of EXPLORATION along PREFIX, a list of decisions."
  (let ((oracle (exploration-oracle exploration)))
    (retract-to-depth oracle (shared-depth oracle prefix))
    (make-path :plan (plan:plan-name (exploration-plan exploration))
               :domain (exploration-domain exploration)
               :oracle oracle :prefix prefix :repeated (length prefix)
               :states (list (current-initial-state exploration))
               :symbolic-p (and (exploration-types exploration) t)
               :max-steps (exploration-max-steps exploration)
               :interleavings (exploration-interleavings exploration)
               :schedule (new-schedule (exploration-domain exploration)
                                       (exploration-interleavings exploration)
                                       (visible-formula exploration)
                                       (exploration-span exploration)
                                       (exploration-uses exploration))
               :file-output (exploration-file-output exploration)
               :keep-errors (exploration-keep-errors exploration)
               :deadline (deadline exploration)
               :jumps-left (exploration-max-jumps exploration))))

(defun run-along (exploration prefix)
  "Run the plan of EXPLORATION along PREFIX, a reversed list of decisions, and return the RUN, or
NIL if there is no path."
  (let ((path (make-run-path exploration (reverse prefix)))
        (arguments (current-arguments exploration))
        (frontier (exploration-frontier exploration))
        (*recorder* (exploration-recorder exploration)))
    (when (exploration-consistent-p exploration)
      (when (and *recorder* (null prefix))
        (note-beginning *recorder* (action-theory-ground (exploration-domain exploration))))
      (let ((output (run-plan-on path (interpreted-plan (exploration-plan exploration))
                                 (mapcar #'argument-value arguments))))
        (note-races path)
        (cond ((eq (path-ending path) :out-of-time)
               (add-prefix frontier prefix))
              (t (note-run frontier (path-decisions path))
                 (add-prefixes frontier (path-alternatives path))))
        (incf (exploration-steps exploration) (length (path-steps path)))
        (note-limits exploration path)
        (note-ending exploration path)
        (make-finished-run :path path :arguments arguments :output output
                           :formula (exploration-formula exploration)
                           :span (exploration-span exploration)
                           :atoms (exploration-alternatives exploration)
                           :first-p (null (exploration-found exploration)))))))

(defun call-timed (exploration function)
  "Call FUNCTION; add the time to that of EXPLORATION, and note which questions Z3 left open."
  (let ((start (foreign:monotonic-seconds))
        (unknowns (oracle-unknowns (exploration-oracle exploration))))
    (unwind-protect (funcall function)
      (note-unknowns exploration
                     (- (oracle-unknowns (exploration-oracle exploration)) unknowns))
      (incf (exploration-time exploration) (- (foreign:monotonic-seconds) start)))))

(defun prepare-oracle (exploration)
  "Give Z3 a new context if it holds too much, or is in doubt."
  (let ((oracle (exploration-oracle exploration)))
    (when (or (null (oracle-context oracle)) (> (oracle-load oracle) *oracle-load*))
      (renew-oracle oracle))))

(defun run-next-path (exploration)
  "Run the next pending path of EXPLORATION and return its RUN, or NIL.  If the run is left by an
error or an interrupt the path stays pending."
  (let* ((frontier (exploration-frontier exploration))
         (prefix (next-prefix frontier))
         (done nil))
    (unwind-protect
         (multiple-value-prog1 (progn (prepare-oracle exploration)
                                      (run-along exploration prefix))
           (incf (exploration-paths exploration))
           (setf done t))
      (unless done
        (close-oracle (exploration-oracle exploration))
        (add-prefix frontier prefix)))))

(defun traces-of-run (exploration run)
  "Return a function that returns the next trace of RUN, or NIL."
  (path-traces run (exploration-mode exploration)))

(defun traces-of-next-path (exploration)
  "Run the next path of EXPLORATION and let it be the source of traces."
  (let ((run (run-next-path exploration)))
    (setf (exploration-run exploration) run
          (exploration-source exploration)
          (and run (traces-of-run exploration run)))))

(defun note-missed (exploration run)
  "Note it if Z3 found no state for a trace of RUN."
  (when (and run (run-missed run))
    (note-gap exploration "a path for which Z3 found no initial state")))

(defun next-trace-of-path (exploration)
  "Return the next trace of the path that was run last, or NIL if there is none."
  (let* ((source (exploration-source exploration))
         (trace (and source (funcall (the function source)))))
    (unless trace
      (setf (exploration-source exploration) nil)
      (note-missed exploration (shiftf (exploration-run exploration) nil)))
    trace))

(defun new-trace-p (exploration trace)
  "Return true if TRACE was not handed out before, and note that it is now."
  (let ((key (trace-key trace)) (seen (exploration-seen exploration)))
    (and (not (gethash key seen))
         (setf (gethash key seen) t))))

;;; Entry points

(defun bound-reached-p (exploration)
  "Return true, and note the gap, if EXPLORATION may run no more paths."
  (let ((seconds (exploration-max-seconds exploration)))
    (cond ((>= (exploration-paths exploration) (exploration-max-paths exploration))
           (note-gap exploration "paths beyond the first ~d" (exploration-max-paths exploration))
           t)
          ((and seconds (>= (exploration-time exploration) seconds))
           (note-time exploration)
           t))))

(defun report-progress (exploration)
  (let ((progress (exploration-progress exploration)) (now (foreign:monotonic-seconds)))
    (when progress
      (unless (exploration-reported exploration)
        (setf (exploration-reported exploration) now))
      (when (>= (- now (exploration-reported exploration)) 1)
        (setf (exploration-reported exploration) now)
        (funcall progress exploration)))))

(defun next-trace (exploration)
  "Return the next trace of EXPLORATION, or NIL if there are no more, or a bound is reached.  No
trace is handed out twice.  Signals NONDETERMINISTIC-PLAN, UNSUPPORTED-FORM, PLAN-BROKE and what
else the plan signals."
  (loop
    (report-progress exploration)
    (let ((trace (call-timed exploration (lambda () (next-trace-of-path exploration)))))
      (cond ((null trace)
             (when (or (frontier-empty-p (exploration-frontier exploration))
                       (bound-reached-p exploration))
               (return nil))
             (call-timed exploration (lambda () (traces-of-next-path exploration))))
            ((new-trace-p exploration trace)
             (push trace (exploration-found exploration))
             (return trace))))))

(defun stop-exploring (&optional condition)
  "Invoke the restart of this name, which ends the work of EXPLORE-PLAN or VERIFY-PLAN: what was
found is returned, with a gap.  Return NIL if there is none."
  (let ((restart (find-restart 'stop-exploring condition)))
    (when restart
      (invoke-restart restart))))

(defun explore-all (exploration next)
  "Call NEXT with EXPLORATION until it returns NIL, and close it; offer STOP-EXPLORING meanwhile."
  (unwind-protect
       (restart-case (loop while (funcall next exploration))
         (stop-exploring ()
           :report "Explore no more paths; keep what was found."
           (note-gap exploration "what comes after an interruption")))
    (close-exploration exploration)))

(defun explore-plan (plan &rest options &key domain &allow-other-keys)
  "Return an EXPLORATION that has found every trace of PLAN in DOMAIN and holds no foreign memory.
The options are those of MAKE-EXPLORATION.  While it is at work, e.g. in the debugger after C-c, the
restart STOP-EXPLORING returns what was found so far."
  (let ((exploration (apply #'make-exploration plan domain
                            (alexandria:remove-from-plist options :domain))))
    (explore-all exploration #'next-trace)
    exploration))
