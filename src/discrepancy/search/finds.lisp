;;;; What is done with a find: confirm, shrink, explain, store, and go on or not.
;;;;
;;;; A search that keeps going does this for the first discrepancy of each kind, and counts those
;;;; of a known kind.

(in-package #:discrepancy-finder.discrepancy)

(declaim (ftype function shrink-discrepancy explain-discrepancy))

(defun make-find (search trace sample run judgement origin)
  "Return the DISCREPANCY that RUN of SAMPLE is, not yet confirmed."
  (make-discrepancy :plan (search-plan search) :domain (search-domain search)
                    :constraint (search-constraint search)
                    :parameters (search-parameters search)
                    :execution (search-execution search) :compare (search-compare search)
                    :seed (search-seed search) :trace trace :sample sample :run run
                    :judgement judgement :origin origin))

(defun confirm-find (search discrepancy)
  "Run DISCREPANCY a second time, and note whether the bits are the same.  A run that was taken from
the journal is replaced by the second one, also among those of the search."
  (let ((again (in-phase (search :confirm)
                 (simulate search (discrepancy-sample discrepancy)
                           (discrepancy-trace discrepancy))))
        (run (discrepancy-run discrepancy)))
    (setf (discrepancy-confirmed-p discrepancy) (= (run-hash run) (run-hash again)))
    (when (and (discrepancy-confirmed-p discrepancy) (run-journaled-p run))
      (setf (discrepancy-run discrepancy) again
            (discrepancy-runs discrepancy)
            (loop for (own . judgement) in (discrepancy-runs discrepancy)
                  collect (cons (if (eq own run) again own) judgement))))))

(defun remaining-time (search)
  "Return the arguments that keep a phase of SEARCH within the time that is left of its limit."
  (let ((limit (search-time-limit search)))
    (and limit (list :max-seconds (max 0 (- limit (search-seconds search)))))))

(defun examine-find (search discrepancy)
  "Shrink, explain and store DISCREPANCY as far as SEARCH wants that; when it is to end, store."
  (when (and (search-shrinks search) (not **stop-requested**))
    (setf (discrepancy-shrunk discrepancy)
          (in-phase (search :shrink)
            (apply #'shrink-discrepancy discrepancy (remaining-time search)))))
  (when (and (search-explains search) (not **stop-requested**))
    (setf (discrepancy-explanation discrepancy)
          (in-phase (search :explain)
            (apply #'explain-discrepancy discrepancy (remaining-time search)))))
  (when (search-store search)
    (in-phase (search :store) (store-discrepancy discrepancy (search-store search)))))

(defun offer-choices (discrepancy)
  "Signal DISCREPANCY, and return what to do next: :CONTINUE, :NEXT-TRACE or :STOP."
  (restart-case (progn (error 'discrepancy-found :discrepancy discrepancy) :stop)
    (continue-search ()
      :report "Draw more samples of this trace; the discrepancy stays in the result."
      :continue)
    (next-trace ()
      :report "Leave this trace and take the next one; the discrepancy stays in the result."
      :next-trace)
    (accept ()
      :report "End the search and return the result with the discrepancy."
      :stop)))

(defun enough-kinds-p (search)
  "Return true if SEARCH has found as many kinds as it is to find."
  (let ((wanted (search-keep-going search)))
    (or (null wanted)
        (and (integerp wanted) (>= (hash-table-count (search-kinds search)) wanted)))))

(defun what-next (search discrepancy)
  (cond ((eq (search-on-discrepancy search) :signal) (offer-choices discrepancy))
        ((enough-kinds-p search) :stop)
        (t :continue)))

(defun note-known-kind (trace-search known)
  "Count a find of the kind of the discrepancy KNOWN; conclude if there are no others any more."
  (incf (discrepancy-occurrences known))
  (when (> (incf (trace-search-repeated trace-search)) *repetition-limit*)
    (conclude trace-search :discrepancy
              (format nil "~d discrepancies of known kinds in a row"
                      (trace-search-repeated trace-search)))))

(defun runs-of-earlier-traces (search)
  "Return the list of (run . judgement) that SEARCH has kept of the traces it is done with."
  (loop for result in (reverse (search-results search))
        append (trace-result-runs result)))

(defun runs-of-start (trace-search discrepancy)
  "Return the list of (run . judgement) that TRACE-SEARCH has kept, those from the initial state of
DISCREPANCY, and the list of the others."
  (let ((parameters (sample-parameters (discrepancy-sample discrepancy))))
    (loop for entry in (reverse (trace-search-runs trace-search))
          if (eq (sample-parameters (run-sample (car entry))) parameters)
            collect entry into same
          else collect entry into others
          finally (return (values same others)))))

(defun note-new-kind (trace-search discrepancy)
  "Examine and keep DISCREPANCY; conclude if that is what is wanted."
  (let ((search (trace-search-search trace-search)))
    ;; What is kept at once stays if the search is ended meanwhile.
    (multiple-value-bind (same others) (runs-of-start trace-search discrepancy)
      (setf (discrepancy-runs discrepancy) same
            (discrepancy-other-runs discrepancy) (append (runs-of-earlier-traces search) others)))
    (push discrepancy (trace-search-discrepancies trace-search))
    (confirm-find search discrepancy)
    (examine-find search discrepancy)
    (ecase (what-next search discrepancy)
      (:continue nil)
      (:next-trace (conclude trace-search :discrepancy "a discrepancy was found"))
      (:stop (conclude trace-search :discrepancy "a discrepancy was found" t)))))

(defun note-discrepancy (trace-search draw run judgement)
  "Take the discrepancy that RUN of DRAW is into account; conclude if the trace is done with."
  (let* ((search (trace-search-search trace-search))
         (discrepancy (make-find search (drawn-trace draw) (drawn-sample draw) run judgement
                                 (drawn-origin draw)))
         (kind (discrepancy-kind discrepancy))
         (known (gethash kind (search-kinds search))))
    (incf (trace-search-finds trace-search))
    (cond ((and known (search-keep-going search)) (note-known-kind trace-search known))
          (t
           (unless known
             (setf (gethash kind (search-kinds search)) discrepancy))
           (note-new-kind trace-search discrepancy)))))
