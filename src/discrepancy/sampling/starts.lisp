;;;; Starts: the discrete initial states of a trace that samples are drawn from.
;;;;
;;;; Where a trace's path leaves something open of its initial state, such as where a body lies that
;;;; no step is about, there are several, each a trace of its own with the same steps: the trace and
;;;; its alternatives.  Which one a sample is of is drawn as its coordinates are: each is as likely,
;;;; a pure function of seed, trace content and index.  STARTS-OF is the entry point.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (start (:copier nil))
  "An initial state that samples are drawn from, that of TRACE, with the initial PARAMETERS and the
final ones, OUTPUTS.  RESTING are the bodies that do not change their regions, CONTENT is the hash
of TRACE.  ACCEPTED and REJECTED count the samples that were valid and those that were not."
  (number 0 :type (integer 0) :read-only t)
  (trace nil :read-only t)
  (parameters '() :type list :read-only t)
  (outputs '() :type list :read-only t)
  (resting '() :type list :read-only t)
  (content 0 :type (unsigned-byte 64) :read-only t)
  (accepted 0 :type (integer 0))
  (rejected 0 :type (integer 0)))

(defmethod print-object ((start start) stream)
  (print-unreadable-object (start stream :type t)
    (format stream "~d:~{ ~a~}" (1+ (start-number start))
            (mapcar #'ec:atom-text
                    (ec:state-fluents (symbolic:trace-initial-state (start-trace start)))))))

(defun start-of (domain trace number)
  "Return the START with NUMBER that TRACE of DOMAIN has.  Signals SAMPLING-ERROR."
  (make-start :number number :trace trace
              :parameters (initial-parameters domain trace)
              :outputs (final-parameters domain trace)
              :resting (resting-bodies domain trace)
              :content (content-hash (symbolic:trace-text trace))))

(defun starts-of (domain trace)
  "Return the vector of the STARTs of TRACE of DOMAIN, and the number of its initial states that
have none, because they cannot be sampled.  Signals SAMPLING-ERROR if that is so of all."
  (let ((starts '()) (number 0) (first nil) (failed 0))
    (dolist (trace (cons trace (symbolic:trace-alternatives trace)))
      (handler-case (push (start-of domain trace number) starts)
        (sampling-error (condition)
          (setf first (or first condition))
          (incf failed))
        (:no-error (starts)
          (declare (ignore starts))
          (incf number))))
    (when (null starts)
      (error first))
    (values (coerce (reverse starts) 'simple-vector) failed)))

(defun parameter-bounds (parameters)
  (map 'vector (lambda (parameter)
                 (cons (parameter-min parameter) (parameter-max parameter)))
       parameters))

(defun start-region (start)
  "Return the PARAMETER-REGION of START: what rules and targets know of it."
  (make-parameter-region (parameter-bounds (remove-if #'fixed-p (start-parameters start)))
                         (final-bounds (start-outputs start) (start-resting start))))

(defconstant +start-draw+ #xd0000000
  "The number of the draw that tells which start a sample is of; those for coordinates are less.")

(defun pick-start (starts seed content index)
  "Return the one of STARTS that sample INDEX is of."
  (if (= 1 (length starts))
      (svref starts 0)
      (svref starts (floor (* (length starts)
                              (unit-float seed content index +start-draw+))))))

(defparameter *start-rejection-limit* 50
  "So many rejected samples without a valid one mean that an initial state is not met.")

(defun never-met-p (start starts)
  "Return true if it seems that no sample of START, one of several STARTS, is valid."
  (and (< 1 (length starts))
       (zerop (start-accepted start))
       (>= (start-rejected start) *start-rejection-limit*)))

;;; Draws

(defstruct (draw (:constructor make-draw (sample origin start)) (:conc-name drawn-) (:copier nil))
  "A SAMPLE of START; its ORIGIN is :BLIND or :TARGETED."
  (sample nil :type sample :read-only t)
  (origin :blind :type (member :blind :targeted) :read-only t)
  (start nil :type start :read-only t))

(defun drawn-trace (draw)
  "Return the trace that DRAW is a sample of, from its initial state."
  (start-trace (drawn-start draw)))

(defun drawn-blindly-p (draw)
  (eq (drawn-origin draw) :blind))
