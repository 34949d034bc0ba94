;;;; Exploration: all paths of a plan, by replay.
;;;;
;;;; An EXPLORATION hands out traces one by one (NEXT-TRACE).  It keeps a stack of prefixes; for
;;;; each it runs the plan again from the start, repeating the prefix's decisions, and pushes the
;;;; alternatives met behind it.  Between runs everything is as before: writes to global variables
;;;; are undone, random state and gensym counter are the same, output is dropped.  EXPLORE-PLAN
;;;; collects all traces.

(in-package #:discrepancy-finder.symbolic-execution)

(defclass exploration ()
  ((plan :initarg :plan :reader exploration-plan :documentation "The plan, a PLAN.")
   (domain :initarg :domain :reader exploration-domain :documentation "The ACTION-THEORY.")
   (constraint :initarg :constraint :reader exploration-constraint
               :documentation "The STATE-CONSTRAINT.")
   (arguments :initarg :arguments :reader exploration-arguments
              :documentation "List of (parameter type), in the order of the lambda list.")
   (max-paths :initarg :max-paths :reader exploration-max-paths)
   (max-steps :initarg :max-steps :reader exploration-max-steps)
   (max-jumps :initarg :max-jumps :reader exploration-max-jumps)
   (schedules :initarg :schedules :reader exploration-schedules)
   (context :initarg :context :reader exploration-context)
   (solver :initarg :solver :reader exploration-solver)
   (formula :initarg :formula :reader exploration-formula
            :documentation "The constraint's ground formula.")
   (pending :initform (list '()) :accessor exploration-pending
            :documentation "The prefixes still to be run.")
   (seen :initform (make-hash-table :test 'equal) :reader exploration-seen
         :documentation "The texts of the traces handed out.")
   (traces :initform '() :accessor exploration-found)
   (paths :initform 0 :accessor exploration-paths
          :documentation "The number of runs.")
   (dead-ends :initform 0 :accessor exploration-dead-ends
              :documentation "The number of paths that end because the theory allows no outcome.")
   (gaps :initform '() :accessor exploration-gaps
         :documentation "What was not explored: a list of sentences.")
   (consistent :initform t :accessor exploration-consistent-p
               :documentation "False if the theory allows no initial state at all.")
   (time :initform 0d0 :accessor exploration-time))
  (:documentation "A search for the traces of a plan on which a state constraint comes true."))

(defun exploration-traces (exploration)
  "Return the list of the traces that EXPLORATION has found so far, in order."
  (reverse (exploration-found exploration)))

(defun exploration-checks (exploration)
  "Return the number of questions that EXPLORATION has put to Z3."
  (z3:check-count (exploration-context exploration)))

(defun exploration-seconds (exploration)
  "Return the seconds spent in EXPLORATION so far, and of them the seconds in Z3."
  (values (exploration-time exploration)
          (z3:check-seconds (exploration-context exploration))))

(defun exploration-complete-p (exploration)
  "Return true if EXPLORATION has run every path and nothing was cut off."
  (and (null (exploration-pending exploration)) (null (exploration-gaps exploration))))

(defmethod print-object ((exploration exploration) stream)
  (print-unreadable-object (exploration stream :type t)
    (format stream "of ~(~a~): ~d trace~:p on ~d path~:p, ~:[incomplete~;complete~]"
            (plan:plan-name (exploration-plan exploration))
            (length (exploration-found exploration)) (exploration-paths exploration)
            (exploration-complete-p exploration))))

(defmethod describe-object ((exploration exploration) stream)
  (format stream "~a~%" exploration)
  (loop for trace in (exploration-traces exploration)
        for number from 1
        do (format stream "  trace ~d: initially~{ ~a~}~%" number
                   (mapcar #'ec:atom-text (ec:state-fluents (trace-initial-state trace))))
           (loop for step in (trace-steps trace)
                 do (format stream "    ~a: ~a~%" (step-designator step) (step-text step)))
           (format stream "    finally~{ ~a~}~%"
                   (mapcar #'ec:atom-text (ec:state-fluents (trace-final-state trace)))))
  (format stream "  ~d dead end~:p, ~d check~:p by Z3~{~%  not explored: ~a~}~%"
          (exploration-dead-ends exploration) (exploration-checks exploration)
          (exploration-gaps exploration)))

(defun symbolic-arguments (plan arguments)
  "Return ARGUMENTS, a list of (parameter type), in the order of PLAN's lambda list.  Signals
UNSUPPORTED-FORM for another type than boolean and for parameters that do not fit."
  (let ((required (alexandria:parse-ordinary-lambda-list (plan:plan-lambda-list plan))))
    (unless (and (listp arguments) (every #'consp arguments) (every #'symbolp
                                                                    (mapcar #'first arguments)))
      (error 'unsupported-form :form arguments
                               :reason "a list of (parameter type) was expected"))
    (unless (alexandria:set-equal required (mapcar #'first arguments) :test #'string=)
      (error 'unsupported-form
             :form (list* (plan:plan-name plan) (plan:plan-lambda-list plan))
             :reason (format nil "it needs a type for each of its required parameters, and got~
                                  ~:[ none~;~:*~{ ~(~a~)~^,~}~]" (mapcar #'first arguments))))
    (loop for parameter in required
          for (nil type) = (assoc parameter arguments :test #'string=)
          do (unless (and (symbolp type) (string= type "BOOLEAN"))
               (error 'unsupported-form :form (list parameter type)
                                        :reason "only parameters of type boolean can be symbolic"))
          collect (list parameter type))))

(defun make-exploration (plan domain &key constraint arguments (max-paths 10000) (max-steps 1000)
                                       (max-jumps 1000000) (schedules :one))
  "Return an EXPLORATION of the plan named PLAN (a symbol) in DOMAIN (an ACTION-THEORY or its name).
CONSTRAINT is a state constraint or its name; with NIL the theory's only one.  ARGUMENTS is a list
of (parameter boolean).  MAX-PATHS, MAX-STEPS (performs on a path) and MAX-JUMPS (iterations of
loops and retries on a path) bound the search.  SCHEDULES is :ONE, tasks that run in parallel take
turns in one fixed order, or :ALL, every order is a path of its own.  Signals PLAN-NOT-FOUND,
DOMAIN-NOT-FOUND, STATE-CONSTRAINT-NOT-FOUND, UNSUPPORTED-FORM."
  (let* ((plan (plan:find-plan plan))
         (domain (if (typep domain 'action-theory) domain (find-action-theory domain)))
         (constraint (if (ec:state-constraint-p constraint)
                         constraint
                         (ec:find-state-constraint constraint (action-theory-theory domain))))
         (arguments (symbolic-arguments plan arguments))
         (formula (ec:ground-formula (action-theory-ground domain)
                                     (ec:state-constraint-formula constraint)))
         (context (z3:make-context)))
    (make-instance 'exploration
                   :plan plan :domain domain :constraint constraint :arguments arguments
                   :max-paths max-paths :max-steps max-steps :max-jumps max-jumps
                   :schedules schedules
                   :formula formula
                   :context context
                   :solver (make-path-solver context (action-theory-ground domain)))))

(defun close-exploration (exploration)
  "Release the Z3 context of EXPLORATION; its traces stay."
  (z3:close-context (exploration-context exploration)))

(defun call-plan (plan function arguments doom)
  "Call FUNCTION with ARGUMENTS for the plan named PLAN.  An error that the plan does not handle is
signaled as PLAN-BROKE, where the plan's top-level is left, after the function DOOM was called with
that condition."
  (handler-bind ((error (lambda (condition)
                          (let ((final (if (typep condition
                                                  '(or symbolic-execution-error z3:z3-error
                                                    z3:solver-unknown plan:plan-error))
                                           condition
                                           (make-condition 'plan-broke :plan plan
                                                                       :error condition))))
                            (funcall doom final)
                            (unless (eq final condition)
                              (error final))))))
    (if (plan:plan-top-level-p (plan:find-plan plan))
        (apply function arguments)
        (plan:ensure-top-level (lambda () (apply function arguments)) plan))))

(defun run-plan-on (path function arguments)
  "Call FUNCTION, the interpreted plan, with ARGUMENTS on PATH and note how the run ends.  Signals
NONDETERMINISTIC-PLAN if the plan ends before it has met all decisions of the prefix."
  (setf (path-handlers path) (plan:current-handlers))
  (let ((*random-state* (sb-ext:seed-random-state 0))
        (*gensym-counter* 0)
        (*standard-output* (make-broadcast-stream))
        (*path* path))
    (unwind-protect
         (catch path
           (plan:with-executive (path)
             (handler-case (progn (call-plan (path-plan path) function arguments
                                             (lambda (condition) (doom path condition)))
                                  (unless (path-fatal path)
                                    (setf (path-ending path) :finished)))
               (plan:plan-failure (failure)
                 (unless (path-fatal path)
                   (setf (path-ending path) (type-of failure)))))))
      (undo-writes path)))
  ;; A cleanup form may have replaced the unwinding by a way out of its own.
  (when (path-fatal path)
    (error (path-fatal path)))
  (when (path-prefix path)
    (error 'nondeterministic-plan
           :plan (path-plan path) :found "its end"
           :expected (decision-description (first (path-prefix path))))))

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

(defun run-path (exploration prefix)
  "Run the plan of EXPLORATION along PREFIX and return the trace of that path, or NIL."
  (let* ((context (exploration-context exploration))
         (solver (exploration-solver exploration))
         (domain (exploration-domain exploration))
         (state (ec:symbolic-state (action-theory-ground domain) context))
         (propositions (loop for (parameter) in (exploration-arguments exploration)
                             collect (z3:variable context (format nil "argument ~a" parameter))))
         (path (make-path :plan (plan:plan-name (exploration-plan exploration)) :domain domain
                          :solver solver :prefix prefix :states (list state)
                          :symbolic-p (and propositions t)
                          :max-steps (exploration-max-steps exploration)
                          :schedules (exploration-schedules exploration)
                          :jumps-left (exploration-max-jumps exploration))))
    (loop for (nil . proposition) in (ec:initial-conditions state)
          do (assume path proposition))
    (unless (or prefix (eq (z3:check solver) :sat))
      (setf (exploration-consistent-p exploration) nil))
    (when (exploration-consistent-p exploration)
      (run-plan-on path (interpreted-plan (exploration-plan exploration))
                   (mapcar #'make-symbolic-boolean propositions))
      ;; The deepest decision comes first: depth-first.
      (setf (exploration-pending exploration)
            (append (path-alternatives path) (exploration-pending exploration)))
      (note-limits exploration path)
      (case (path-ending path)
        (:dead-end (incf (exploration-dead-ends exploration)))
        (:too-many-steps
         (note-gap exploration "paths of more than ~d steps" (exploration-max-steps exploration)))
        (:too-many-jumps
         (note-gap exploration "paths of more than ~d iterations"
                   (exploration-max-jumps exploration))))
      (path-trace path (exploration-formula exploration)
                  (ec:state-constraint-span (exploration-constraint exploration))
                  propositions))))

(defun next-path (exploration)
  "Run the next pending path of EXPLORATION and return its trace, or NIL.  If the run is left by an
error or an interrupt the path stays pending."
  (let ((start (foreign:monotonic-seconds))
        (solver (exploration-solver exploration))
        (prefix (pop (exploration-pending exploration)))
        (done nil))
    (z3:push-scope solver)
    (unwind-protect
         (multiple-value-prog1
             (z3:with-released-terms ((exploration-context exploration))
               (run-path exploration prefix))
           (incf (exploration-paths exploration))
           (setf done t))
      (unless done
        (push prefix (exploration-pending exploration)))
      (z3:pop-scope solver)
      (incf (exploration-time exploration) (- (foreign:monotonic-seconds) start)))))

(defun next-trace (exploration)
  "Return the next trace of EXPLORATION, or NIL if there are no more.  No trace is handed out
twice.  Signals NONDETERMINISTIC-PLAN, UNSUPPORTED-FORM, SOLVER-UNKNOWN and what the plan signals."
  (loop while (exploration-pending exploration)
        do (when (>= (exploration-paths exploration) (exploration-max-paths exploration))
             (note-gap exploration "paths beyond the first ~d"
                       (exploration-max-paths exploration))
             (return nil))
           (let ((trace (next-path exploration)))
             (when (and trace (not (gethash (trace-text trace) (exploration-seen exploration))))
               (setf (gethash (trace-text trace) (exploration-seen exploration)) t)
               (push trace (exploration-found exploration))
               (return trace)))))

(defun explore-plan (plan &rest options &key domain constraint arguments max-paths max-steps
                                          max-jumps schedules)
  "Return an EXPLORATION that has found every trace of PLAN in DOMAIN and holds no foreign memory.
The options are those of MAKE-EXPLORATION."
  (declare (ignore constraint arguments max-paths max-steps max-jumps schedules))
  (let ((exploration (apply #'make-exploration plan domain (alexandria:remove-from-plist
                                                            options :domain))))
    (unwind-protect (loop while (next-trace exploration))
      (close-exploration exploration))
    exploration))
