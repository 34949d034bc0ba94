;;;; Targets: samples where the results of earlier rounds predict the worst.
;;;;
;;;; Samples are drawn in rounds of +ROUND+.  The first round is blind; in later ones every second
;;;; sample lies near the corner of the initial region at which a linear regression, over all
;;;; samples of the earlier rounds, predicts a final parameter nearest to its bounds or beyond.
;;;; The several targets of a round take the worst predictions in turn, and lie between the corner
;;;; and a random point, so that no two are the same.  How many samples are blind, and where these
;;;; are, does not depend on any result.  Each start of a trace (starts.lisp) has a regression of
;;;; its own.

(in-package #:discrepancy-finder.discrepancy)

(defconstant +round+ 8
  "The number of samples in a round.")

(defstruct (aim (:constructor make-aim (region regression)) (:copier nil))
  "Where the targets of a start with the PARAMETER-REGION REGION lie: REGRESSION is over the samples
of earlier rounds, FRESH are the values (initial . final) of the present one, newest first; CORNERS
are the predicted-worst ones for the present round."
  (region nil :read-only t)
  (regression nil :read-only t)
  (fresh '() :type list)
  (corners '() :type list))

(defstruct (targeting (:constructor %make-targeting (aims)) (:copier nil))
  "The AIMS of the starts of a trace, a vector.  POSITION counts the draws, COUNT those that were
targets."
  (aims #() :type simple-vector :read-only t)
  (position 0 :type (integer 0))
  (count 0 :type (integer 0)))

(defun make-targeting (regions)
  "Return a new TARGETING for samples from the PARAMETER-REGIONs REGIONS, one for each start."
  (%make-targeting
   (map 'simple-vector
        (lambda (region)
          (make-aim region (make-regression (length (parameter-region-initial-bounds region))
                                            (length (parameter-region-final-bounds region)))))
        regions)))

(defun targeting-aim (targeting start)
  (svref (targeting-aims targeting) start))

(defun note-values (targeting start initial final)
  "Keep the vectors INITIAL and FINAL of a sample of START, a number, for the rounds to come."
  (push (cons initial final) (aim-fresh (targeting-aim targeting start))))

(defun begin-round (targeting)
  "Let the samples of the round that ends have a say in the next one."
  (loop for aim across (targeting-aims targeting)
        do (loop for (initial . final) in (reverse (shiftf (aim-fresh aim) '()))
                 do (add-observation (aim-regression aim) initial final))
           (setf (aim-corners aim) (worst-corners (aim-regression aim) (aim-region aim)))))

(defun next-origin (targeting)
  "Return how the next sample is to be drawn, :BLIND or :TARGETED."
  (if (null targeting)
      :blind
      (multiple-value-bind (round place) (floor (targeting-position targeting) +round+)
        (when (and (zerop place) (plusp round))
          (begin-round targeting))
        (incf (targeting-position targeting))
        (if (and (plusp round) (oddp place)) :targeted :blind))))

(defun between (point corner part bounds)
  "Return the list of the coordinates that lie on the way from POINT to CORNER, vectors, at PART of
it; the upper ends of BOUNDS are not reached."
  (loop for value across point
        for end across corner
        for (min . max) across bounds
        for mixed = (+ value (* part (- end value)))
        collect (max min (below-bound mixed min max))))

(defun with-drawn-values (parameters values)
  "Return the list of the values of PARAMETERS of which those that are not fixed have VALUES."
  (loop for parameter in parameters
        collect (if (fixed-p parameter) (parameter-min parameter) (pop values))))

(defun inside-regions-p (parameters values)
  "Return true if bodies at VALUES of PARAMETERS lie in those regions that are no boxes."
  (loop for parameter in parameters
        always (or (null (parameter-region parameter))
                   (inside-region-p (place-of parameters values (parameter-body parameter))
                                    (parameter-region parameter)))))

(defun random-corner (bounds seed content index)
  (let ((draw 0))
    (map 'vector (lambda (pair)
                   (if (< (unit-float seed content index (+ 8192 (incf draw))) 1/2)
                       (car pair)
                       (cdr pair)))
         bounds)))

(defun next-target (targeting)
  "Return the number of the next target, from 0."
  (1- (incf (targeting-count targeting))))

(defun target-content (content)
  "Return the hash for the draws of targets where CONTENT is that for blind ones."
  (logxor content #x5461726765747321))

(defun target-sample (aim parameters seed content index)
  "Return target INDEX of a search, one of AIM, for PARAMETERS: a function of SEED, CONTENT and the
samples of earlier rounds."
  (let* ((content (target-content content))
         (bounds (parameter-region-initial-bounds (aim-region aim)))
         (corners (aim-corners aim))
         (corner (if corners
                     (nth (mod index (length corners)) corners)
                     (random-corner bounds seed content index)))
         (start (drawn-values (draw-sample parameters seed content index)))
         (spread (* 0.2d0 (expt (unit-float seed content index 8192) 2))))
    ;; The corner of the box around a region that is no box may lie outside of it.
    (loop for part in (list (- 1 spread) 0.75d0 0.5d0 0.25d0 0d0)
          for values = (with-drawn-values parameters (between start corner part bounds))
          when (inside-regions-p parameters values)
            return (make-sample index parameters
                                (coerce values '(simple-array double-float (*))))
          finally (return (draw-sample parameters seed content index)))))
