;;;; A search in progress: what was asked for, what it has cost, and why it may have to end.
;;;;
;;;; A search goes through PHASES, of which IN-PHASE measures the cost.  It ends before its time
;;;; when a budget is used up, or when it is interrupted: REQUEST-STOP asks for that from anywhere,
;;;; also from the handler of a signal; the restart STOP-SEARCH does it at once.  Either way the
;;;; result holds what was found.

(in-package #:discrepancy-finder.discrepancy)

(defclass search-state ()
  ((plan :initarg :plan :reader search-plan)
   (domain :initarg :domain :reader search-domain)
   (constraint :initarg :constraint :reader search-constraint)
   (parameters :initarg :parameters :reader search-parameters)
   (rule :initarg :rule :reader search-rule)
   (rule-name :initarg :rule-name :reader search-rule-name)
   (seed :initarg :seed :reader search-seed)
   (sampler :initarg :sampler :reader search-sampler)
   (targets :initarg :targets :reader search-targets)
   (budget :initarg :budget :reader search-budget)
   (time-limit :initarg :seconds :reader search-time-limit)
   (execution :initarg :execution :reader search-execution)
   (compare :initarg :compare :reader search-compare)
   (comparison :initarg :comparison :reader search-comparison)
   (keep-going :initarg :keep-going :reader search-keep-going)
   (shrink :initarg :shrink :reader search-shrinks)
   (explain :initarg :explain :reader search-explains)
   (store :initarg :store :reader search-store)
   (journal :initarg :journal :initform nil :reader search-journal)
   (progress :initarg :progress :reader search-progress)
   (on-discrepancy :initarg :on-discrepancy :reader search-on-discrepancy)
   (context :initarg :context :reader search-context)
   (memory :initform (make-memory) :reader search-memory)
   (phases :initform (make-phases) :reader search-phases)
   (meter :initform (make-meter) :reader search-meter)
   (iteration :initform 0 :accessor search-iteration
              :documentation "The number of the trace that is being sampled, from 1.")
   (started :initform (foreign:monotonic-seconds) :reader search-started)
   (kinds :initform (make-hash-table :test #'equal) :reader search-kinds
          :documentation "From the kinds that were found to the first discrepancy of each.")
   (reused :initform '() :accessor search-reused :documentation "Newest first.")
   (results :initform '() :accessor search-results :documentation "Newest first.")
   (stopped :initform nil :accessor search-stopped
            :documentation "Why the search ends before its time, as a clause, or NIL."))
  (:documentation "A search in progress."))

;;; Phases

(defun phase-of (search name)
  (find name (search-phases search) :key #'phase-name))

(defun call-in-phase (search name function)
  (let* ((phase (phase-of search name))
         (meter (search-meter search))
         (simulations (meter-simulations meter))
         (simulation-seconds (meter-seconds meter))
         (start (foreign:monotonic-seconds)))
    ;; The progress of those two is told after each sample.
    (unless (member name '(:generate :target))
      (report-search search name))
    (unwind-protect (with-meter (meter) (funcall function))
      (incf (phase-seconds phase) (- (foreign:monotonic-seconds) start))
      (incf (phase-simulations phase) (- (meter-simulations meter) simulations))
      (incf (phase-simulation-seconds phase) (- (meter-seconds meter) simulation-seconds)))))

(defmacro in-phase ((search name) &body body)
  "Evaluate BODY and charge what it costs to the phase NAME of SEARCH.  Phases do not nest."
  `(call-in-phase ,search ,name (lambda () ,@body)))

(defun search-simulations (search &optional (phases '(:reuse :generate :target :confirm)))
  "Return the number of simulations in PHASES, by default those that look for discrepancies."
  (loop for name in phases
        sum (phase-simulations (phase-of search name))))

;;; The end

(sb-ext:defglobal **stop-requested** nil
  "True if searches are to end as soon as they can.")

(defun request-stop ()
  "Let every search that is in progress end after the simulation it is at, and return what it has
found.  May be called from the handler of a signal, or by another thread."
  (setf **stop-requested** t))

(defun stop-search (&optional condition)
  "Invoke the restart of this name, which ends a search at once: FIND-DISCREPANCIES returns what was
found so far.  Return NIL if there is no search."
  (let ((restart (find-restart 'stop-search condition)))
    (when restart
      (invoke-restart restart))))

(defun search-seconds (search)
  (- (foreign:monotonic-seconds) (search-started search)))

(defun end-reason (search)
  "Return why SEARCH is to end now, as a clause, or NIL."
  (let ((budget (search-budget search)) (limit (search-time-limit search)))
    (cond ((search-stopped search))
          (**stop-requested** "the search was interrupted")
          ((>= (search-simulations search '(:reuse :generate :target)) budget)
           (format nil "the budget of ~d simulation~:p is used up" budget))
          ((and limit (>= (search-seconds search) limit))
           (format nil "the time of ~a s is used up" (number-text limit))))))

;;; Progress

(defun report-search (search phase &key verdict (rejected 0))
  "Tell the user's function how far SEARCH is, if there is one."
  (when (search-progress search)
    (funcall (search-progress search)
             :phase phase :trace (search-iteration search) :rejected rejected :verdict verdict
             :simulations (search-simulations search)
             :discrepancies (hash-table-count (search-kinds search))
             :seconds (search-seconds search))))
