;;;; The boundary: how little has to change for theory and simulation to agree.
;;;;
;;;; From the smallest case each parameter alone is led to its ordinary value and to the ends of its
;;;; range.  If the sample there passes, the interval between it and the failing one is halved, on a
;;;; grid of round numbers, a thousandth of the range or finer.  The nearest boundary, in parts of
;;;; the ranges, is kept; others are only looked for nearer than that.  If no parameter alone makes
;;;; a difference, blind samples are drawn until one passes, and the way to that is halved.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (boundary (:copier nil))
  "Two samples side by side, FAILING with the discrepancy and PASSING without it.  They differ in
PARAMETER alone, or, if that is NIL, in several."
  (parameter nil :type (or null parameter) :read-only t)
  (failing nil :type sample :read-only t)
  (passing nil :type sample :read-only t))

(setf (documentation 'boundary-parameter 'function)
      "Return the PARAMETER in which the two samples of a boundary differ, or NIL if in several."
      (documentation 'boundary-failing 'function)
      "Return the SAMPLE of a boundary that shows the discrepancy."
      (documentation 'boundary-passing 'function)
      "Return the SAMPLE of a boundary that passes.")

(defun changed-values (boundary)
  "Return a list of (parameter failing-value passing-value) for what differs between the samples of
BOUNDARY."
  (let ((failing (boundary-failing boundary))
        (passing (boundary-passing boundary)))
    (loop for number in (differing-numbers failing passing)
          collect (list (nth number (sample-parameters failing))
                        (aref (sample-values failing) number)
                        (aref (sample-values passing) number)))))

(defun boundary-text (boundary)
  "Return a text that tells between which values the discrepancy of BOUNDARY ends."
  (format nil "~:{~a is ~,vf with the discrepancy, ~,vf without~:^; ~}"
          (loop for (parameter failing passing) in (changed-values boundary)
                for digits = (max 4 (min 12 (decimals failing)) (min 12 (decimals passing)))
                collect (list (parameter-name parameter) digits failing digits passing))))

(defmethod print-object ((boundary boundary) stream)
  (print-unreadable-object (boundary stream :type t)
    (write-string (boundary-text boundary) stream)))

;;; Ways: a function of 0 <= n <= steps that returns the sample there

(defun grid-step (parameter)
  "Return the greatest power of ten, a rational, that is at most a thousandth of the range of
PARAMETER."
  (let ((range (- (rational (parameter-max parameter)) (rational (parameter-min parameter)))))
    (loop for power from 6 downto -12
          for step = (expt 10 power)
          when (<= (* 1000 step) (* range 1000001/1000000)) return step
          finally (return step))))

(defun way-along (sample number end)
  "Return a function that returns the sample so many grid steps from SAMPLE towards the value END of
its parameter NUMBER, and the number of steps."
  (let* ((parameter (nth number (sample-parameters sample)))
         (value (aref (sample-values sample) number))
         (step (grid-step parameter))
         (start (round (rational value) step))
         (steps (- (truncate (rational end) step) start))
         (sign (signum steps)))
    (values (lambda (n)
              (if (zerop n)
                  sample
                  (sample-with-value sample number (float (* step (+ start (* sign n))) 1d0))))
            (abs steps))))

(defun way-between (sample other)
  "Return a function that returns the sample so many thousandths on the way from SAMPLE to OTHER,
and 1000."
  (values (lambda (n)
            (if (= n 1000)
                other
                (sample-with sample (loop for value across (sample-values sample)
                                          for other-value across (sample-values other)
                                          collect (+ value (* n 1/1000 (- other-value value)))))))
          1000))

(defun halve (shrinker way failing passing)
  "Return numbers of steps on WAY, as near to each other as it goes, the first one of a sample with
the discrepancy, the second one of a sample that passes; at first these are FAILING and PASSING."
  (loop until (= (- passing failing) 1)
        do (let ((middle (floor (+ failing passing) 2)))
             (ecase (attempt shrinker :sample (funcall way middle))
               (:same (setf failing middle))
               (:passing (setf passing middle))
               ((:other :unknown) (return)))))
  (values failing passing))

(defun range-ends (parameter)
  "Return the first and the last value that a sample can have for PARAMETER, on its grid."
  (let ((step (grid-step parameter))
        (max (rational (parameter-max parameter))))
    (list (float (* step (ceiling (rational (parameter-min parameter)) step)) 1d0)
          (float (* step (if (possible-p parameter (parameter-max parameter))
                             (floor max step)
                             (1- (ceiling max step))))
                 1d0))))

(defun boundary-along (shrinker sample number end within)
  "Return the boundary on the way from SAMPLE to the value END of parameter NUMBER, and its distance
in parts of the range, if it is less than WITHIN; else NIL."
  (let* ((parameter (nth number (sample-parameters sample)))
         (range (- (rational (parameter-max parameter)) (rational (parameter-min parameter)))))
    (multiple-value-bind (way steps) (way-along sample number end)
      (let ((far (min steps (1- (ceiling (* within range) (grid-step parameter))))))
        (when (and (plusp far)
                   (eq (attempt shrinker :sample (funcall way far)) :passing))
          (multiple-value-bind (failing passing) (halve shrinker way 0 far)
            (values (make-boundary :parameter parameter :failing (funcall way failing)
                                   :passing (funcall way passing))
                    (/ (* passing (grid-step parameter)) range))))))))

(defun nearest-boundary-along (shrinker sample numbers)
  "Return the nearest boundary from SAMPLE along one of the parameters NUMBERS, or NIL."
  (let ((scene (domain-scene (discrepancy-domain (shrinker-best shrinker))))
        (nearest nil)
        (within 2))
    (dolist (number numbers nearest)
      (let ((parameter (nth number (sample-parameters sample))))
        (dolist (end (cons (ordinary-value scene parameter) (range-ends parameter)))
          (multiple-value-bind (boundary distance)
              (boundary-along shrinker sample number end within)
            (when boundary
              (setf nearest boundary
                    within distance))))))))

(defun passing-sample (shrinker attempts)
  "Return a blind sample of the best case of SHRINKER that passes, or NIL if none of so many
ATTEMPTS does."
  (let* ((best (shrinker-best shrinker))
         (content (content-hash (symbolic:trace-text (discrepancy-trace best)))))
    (loop for index below attempts
          for sample = (draw-sample (sample-parameters (discrepancy-sample best))
                                    (discrepancy-seed best) content index)
          when (eq (attempt shrinker :sample sample) :passing) return sample)))

(defun boundary-between (shrinker sample)
  "Return the boundary between SAMPLE and one that passes, or NIL; the values that make no
difference stay as in SAMPLE."
  (let ((passing (passing-sample shrinker 20)))
    (when passing
      (let* ((numbers (smallest-list (differing-numbers sample passing)
                                     (lambda (numbers)
                                       (eq (attempt shrinker
                                                    :sample (mixed-sample passing sample numbers))
                                           :passing))))
             (near (mixed-sample passing sample numbers)))
        (multiple-value-bind (way steps) (way-between sample near)
          (multiple-value-bind (last first) (halve shrinker way 0 steps)
            (make-boundary :parameter (and (null (rest numbers))
                                           (nth (first numbers) (sample-parameters sample)))
                           :failing (funcall way last) :passing (funcall way first))))))))

(defun find-boundary (shrinker)
  "Return the BOUNDARY nearest to the best case of SHRINKER, or NIL if none is found."
  (let* ((best (shrinker-best shrinker))
         (sample (discrepancy-sample best))
         (mattering (mattering-numbers best))
         (others (loop for parameter in (sample-parameters sample)
                       for number from 0
                       unless (or (member number mattering) (fixed-p parameter))
                         collect number)))
    (or (nearest-boundary-along shrinker sample (append mattering others))
        (boundary-between shrinker sample))))
