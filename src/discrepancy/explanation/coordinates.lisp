;;;; Which coordinates matter, and between which values.
;;;;
;;;; From the runs that a search has made, the one that agrees with the theory and is nearest to the
;;;; failing one is taken.  PROBES, further runs from the failing sample with some coordinates
;;;; changed, first find a smallest set of coordinates that have to be changed for theory and
;;;; simulation to agree, then halve the way between what fails and what agrees, and try the other
;;;; end of the range.  What is left of the budget goes to the other coordinates, one at a time.
;;;; Probes are the same in every call.
;;;; Entry point: FIND-INFLUENCES.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (influence (:copier nil))
  "That PARAMETERS, changed together and nothing else, decide: with the values FAILING, nearest to
the boundary, the discrepancy shows, with AGREEING theory and simulation agree.  HERE are the values
in the discrepancy's own sample.  SEEN is what the search had seen of a single parameter: its range
in the runs that agree and in those that do not, each (count least greatest), or NIL."
  (parameters '() :type list :read-only t)
  (failing '() :type list :read-only t)
  (agreeing '() :type list :read-only t)
  (here '() :type list :read-only t)
  (seen '() :type list :read-only t))

(setf (documentation 'influence-parameters 'function)
      "Return the list of the PARAMETERs that decide together, as a rule one."
      (documentation 'influence-failing 'function)
      "Return the list of the values of the parameters of an influence, nearest to the boundary,
with which the discrepancy shows."
      (documentation 'influence-agreeing 'function)
      "Return the list of the values of the parameters of an influence with which theory and
simulation agree.")

(defmethod print-object ((influence influence) stream)
  (print-unreadable-object (influence stream :type t)
    (format stream "~{~a~^, ~}" (mapcar #'parameter-name (influence-parameters influence)))))

;;; Probes

(defclass prober ()
  ((discrepancy :initarg :discrepancy :reader prober-discrepancy)
   (context :initarg :context :reader prober-context :documentation "A Z3 context.")
   (memory :initform (make-memory) :reader prober-memory)
   (seen :initarg :seen :initform '() :reader prober-seen
         :documentation "The (run . judgement) of the search.")
   (left :initarg :left :accessor prober-left :documentation "The number of runs left.")
   (deadline :initarg :deadline :reader prober-deadline
             :documentation "The time (s) when there are no more runs, or NIL.")
   (known :initform (make-hash-table :test 'equalp) :reader prober-known
          :documentation "What came of the values that were tried.")
   (runs :initform '() :accessor prober-runs
         :documentation "The (run . judgement) of the valid runs, newest first."))
  (:documentation "The runs around a discrepancy, and how many more there may be."))

(defun same-kind-p (discrepancy run judgement)
  "Return true if JUDGEMENT on RUN finds a discrepancy of the same kind as DISCREPANCY: theory and
simulation part first at the same kind of action, in the same predicate or failure."
  (flet ((kind (run judgement)
           (let* ((divergence (judgement-divergence judgement))
                  (step (nth (divergence-step divergence) (run-steps run))))
             (list (divergence-kind divergence)
                   (plan:desig-prop-value (run-step-designator step) :type)
                   (if (eq (divergence-kind divergence) :outcome)
                       (run-step-outcome step)
                       (first (first (first (divergence-fluents divergence)))))))))
    (and (eq (judgement-verdict judgement) :discrepancy)
         (equal (kind run judgement)
                (kind (discrepancy-run discrepancy) (discrepancy-judgement discrepancy))))))

(defun agreeing-p (judgement)
  (not (eq (judgement-verdict judgement) :discrepancy)))

(defun exhausted-prober-p (prober)
  (or (<= (prober-left prober) 0)
      (and (prober-deadline prober)
           (> (foreign:monotonic-seconds) (prober-deadline prober)))))

(defun run-probe (prober values)
  "Run the sample with VALUES, a vector, and return :AGREES, :FAILS or :OTHER."
  (let* ((discrepancy (prober-discrepancy prober))
         (trace (discrepancy-trace discrepancy))
         (sample (make-sample (sample-index (discrepancy-sample discrepancy))
                              (sample-parameters (discrepancy-sample discrepancy)) values))
         (run (run-case discrepancy :sample sample)))
    (decf (prober-left prober))
    (if (eq (run-validity run) :valid)
        (let ((judgement (judge-run (discrepancy-domain discrepancy) run trace
                                    :compare (discrepancy-compare discrepancy)
                                    :comparison (judgement-comparison
                                                 (discrepancy-judgement discrepancy))
                                    :context (prober-context prober)
                                    :memory (prober-memory prober))))
          (push (cons run judgement) (prober-runs prober))
          (cond ((agreeing-p judgement) :agrees)
                ((same-kind-p discrepancy run judgement) :fails)
                (t :other)))
        :other)))

(defun probe (prober values)
  "Return what comes of VALUES: :AGREES, :FAILS, :OTHER (no valid sample, another discrepancy), or
NIL if there may be no more runs."
  (or (gethash values (prober-known prober))
      (and (not (exhausted-prober-p prober))
           (setf (gethash values (prober-known prober)) (run-probe prober values)))))

;;; Values

(defun failing-values (prober)
  (sample-values (discrepancy-sample (prober-discrepancy prober))))

(defun prober-parameters (prober)
  (sample-parameters (discrepancy-sample (prober-discrepancy prober))))

(defun mixed-values (prober numbers others fraction)
  "Return the failing values, of which those with NUMBERS are moved towards OTHERS by FRACTION."
  (let ((values (copy-seq (failing-values prober))))
    (dolist (number numbers values)
      (setf (aref values number)
            (+ (* (- 1 fraction) (aref values number)) (* fraction (aref others number)))))))

(defun sample-distance (prober values)
  "Return how far VALUES are from the failing ones, each coordinate measured by its range."
  (loop for parameter in (prober-parameters prober)
        for one across (failing-values prober)
        for other across values
        unless (fixed-p parameter)
          sum (expt (/ (- one other) (- (parameter-max parameter) (parameter-min parameter))) 2)))

(defun nearest-agreeing-values (prober runs)
  "Return the values nearest to the failing ones among those of RUNS, a list of (run . judgement),
with which theory and simulation agree; or NIL."
  (let ((best nil) (least nil))
    (loop for (run . judgement) in runs
          for values = (and (run-sample run) (sample-values (run-sample run)))
          when (and values (agreeing-p judgement)
                    (= (length values) (length (failing-values prober))))
            do (let ((distance (sample-distance prober values)))
                 (when (or (null least) (< distance least))
                   (setf best values least distance))))
    best))

(defun free-numbers (prober)
  "Return the numbers of the parameters that have more than one value."
  (loop for parameter in (prober-parameters prober)
        for number from 0
        unless (fixed-p parameter) collect number))

(defun values-with (prober number value)
  "Return the failing values but for coordinate NUMBER, which has VALUE."
  (let ((values (copy-seq (failing-values prober))))
    (setf (aref values number) value)
    values))

(defun range-end (parameter upper-p)
  "Return the least or greatest value that PARAMETER can have in a sample."
  (let ((min (parameter-min parameter)) (max (parameter-max parameter)))
    ;; The upper bound belongs to the next region.
    (if upper-p (- max (* 1d-6 (- max min))) min)))

(defun moved-values (prober number place)
  "Return the failing values with coordinate NUMBER at PLACE of its range: in the :MIDDLE, at the
:FAR end or at the :NEAR one."
  (let* ((parameter (nth number (prober-parameters prober)))
         (middle (/ (+ (parameter-min parameter) (parameter-max parameter)) 2))
         (low-p (< (aref (failing-values prober) number) middle)))
    (values-with prober number (ecase place
                                 (:middle middle)
                                 (:far (range-end parameter low-p))
                                 (:near (range-end parameter (not low-p)))))))

(defun probe-beyond (prober number value)
  "Try the end of the range of coordinate NUMBER on the other side of VALUE, which agrees: how far
that goes is evidence for edits."
  (probe prober (values-with prober number
                             (range-end (nth number (prober-parameters prober))
                                        (< (aref (failing-values prober) number) value)))))

;;; A smallest set of coordinates

(defun chunks (list size)
  (loop while list
        collect (loop repeat size while list collect (pop list))))

(defun smallest-change (prober numbers others)
  "Return a part of NUMBERS that has to be changed to the values in OTHERS for theory and simulation
to agree; all of NUMBERS are enough.  No part of it can be left out, as far as the runs go."
  (loop with size = (ceiling (length numbers) 2)
        do (dolist (chunk (chunks numbers size))
             (let ((rest (set-difference numbers chunk)))
               (when (and rest (eq (probe prober (mixed-values prober rest others 1)) :agrees))
                 (setf numbers (remove-if-not (lambda (number) (member number rest)) numbers)))))
        until (or (= size 1) (null (rest numbers)))
        do (setf size (max 1 (min (floor size 2) (floor (length numbers) 2)))))
  (sort (copy-list numbers) #'<))

(defparameter *most-together* 3
  "So many coordinates at most count as deciding together if the runs did not suffice to leave out
more.")

(defparameter *halvings* 6
  "So often the way between a failing and an agreeing value is halved.")

(defun seen-ranges (prober number)
  "Return the ranges of coordinate NUMBER in the runs of the search that agree and in those that do
not, each (count least greatest), or NIL if there are none of either."
  (let ((agreeing '()) (failing '()))
    (loop for (run . judgement) in (prober-seen prober)
          when (run-sample run)
            do (let ((value (aref (sample-values (run-sample run)) number)))
                 (if (agreeing-p judgement)
                     (push value agreeing)
                     (push value failing))))
    (and agreeing failing
         (loop for values in (list agreeing failing)
               collect (list (length values) (reduce #'min values) (reduce #'max values))))))

(defun boundary-influence (prober numbers others)
  "Return the influence of the coordinates with NUMBERS, which agree at the values in OTHERS."
  (let ((fails 0d0) (agrees 1d0))
    (loop repeat *halvings*
          for middle = (/ (+ fails agrees) 2)
          do (case (probe prober (mixed-values prober numbers others middle))
               (:agrees (setf agrees middle))
               (:fails (setf fails middle))
               ;; Something else lies in between, or there are no more runs.
               (t (return))))
    (when (and (null (rest numbers))
               (body-coordinate-p (nth (first numbers) (prober-parameters prober))))
      (probe-beyond prober (first numbers) (aref others (first numbers))))
    (flet ((values-at (fraction)
             (let ((values (mixed-values prober numbers others fraction)))
               (loop for number in numbers collect (aref values number)))))
      (make-influence :parameters (loop for number in numbers
                                        collect (nth number (prober-parameters prober)))
                      :seen (and (null (rest numbers)) (seen-ranges prober (first numbers)))
                      :here (values-at 0) :failing (values-at fails)
                      :agreeing (values-at agrees)))))

;;; One coordinate at a time

(defun single-influences (prober numbers)
  "Return the influences of the coordinates among NUMBERS that decide when they are moved alone, to
the middle or an end of their range."
  (let ((influences '()))
    (dolist (place '(:middle :far :near))
      (dolist (number numbers)
        (let ((values (moved-values prober number place)))
          (when (and (not (assoc number influences)) (eq (probe prober values) :agrees))
            (push (cons number (boundary-influence prober (list number) values)) influences)))))
    (mapcar #'cdr (sort influences #'< :key #'car))))

(defun separation (runs number)
  "Return how well a threshold for coordinate NUMBER tells the runs of RUNS, a list of (run .
judgement), that agree from the others: the largest part of them that one threshold sorts right."
  (let* ((entries (sort (loop for (run . judgement) in runs
                              when (run-sample run)
                                collect (cons (aref (sample-values (run-sample run)) number)
                                              (agreeing-p judgement)))
                        #'< :key #'car))
         (total (length entries))
         (good (count t entries :key #'cdr))
         (best (max good (- total good)))
         (below 0))
    (loop for (nil . agrees) in entries
          for seen from 1
          do (when agrees (incf below))
             ;; those that agree on one side, the others on the other
             (let ((right (+ below (- (- total seen) (- good below)))))
               (setf best (max best right (- total right)))))
    (if (plusp total) (/ best total) 0)))

;;; Entry point

(defun find-influences (discrepancy runs &key (max-runs 30) max-seconds context)
  "Return the list of the INFLUENCEs on DISCREPANCY, the list of (run . judgement) of the valid runs
that were made to find them, and the number of all these runs, at most MAX-RUNS, begun within
MAX-SECONDS.  RUNS is a list of (run . judgement) of valid runs of the same trace, CONTEXT a Z3
context."
  (let* ((prober (make-instance 'prober
                                :discrepancy discrepancy :context context :seen runs
                                :left max-runs
                                :deadline (and max-seconds
                                               (+ (foreign:monotonic-seconds) max-seconds))))
         (numbers (stable-sort (free-numbers prober) #'>
                               :key (lambda (number) (separation runs number))))
         (others (nearest-agreeing-values prober runs))
         (decisive '()))
    (setf (gethash (failing-values prober) (prober-known prober)) :fails)
    (when others
      (setf decisive (smallest-change
                      prober
                      (remove-if (lambda (number)
                                   (= (aref others number) (aref (failing-values prober) number)))
                                 (reverse numbers))
                      others)))
    (when (and (exhausted-prober-p prober) (> (length decisive) *most-together*))
      ;; There were too few runs to leave out those that do not matter.
      (setf decisive '()))
    (let ((influences (append
                       (and decisive (list (boundary-influence prober decisive others)))
                       (single-influences prober (if (rest decisive)
                                                     numbers
                                                     (set-difference numbers decisive))))))
      (values influences (nreverse (prober-runs prober)) (- max-runs (prober-left prober))))))
