;;;; Where the worst is to be expected: corners at which a regression predicts trouble.
;;;;
;;;; WORST-CORNERS is the entry point.

(in-package #:discrepancy-finder.statistics)

(defun worst-corner (solution varying bounds low-p)
  "Return the corner of BOUNDS at which the linear function with the coefficients SOLUTION of the
inputs VARYING, and the intercept last, is least if LOW-P is true, else greatest; and its value
there.  Inputs that do not vary are in the middle."
  (let ((corner (map '(simple-array double-float (*))
                     (lambda (pair) (/ (+ (car pair) (cdr pair)) 2)) bounds))
        (value (aref solution (length varying))))
    (loop for input in varying
          for number from 0
          for b = (aref solution number)
          for (min . max) = (aref bounds input)
          do (setf (aref corner input) (if (eq (plusp b) low-p) min max))
             (incf value (* b (aref corner input))))
    (values corner value)))

(defun worst-corners (regression region)
  "Return the list of the corners (vectors) of the initial parameters of the PARAMETER-REGION REGION
at which REGRESSION, with an intercept, predicts a final parameter nearest to one of its bounds,
measured by the spread of its residuals, or farthest beyond it; the worst first, one for each bound.
NIL if the observations do not suffice."
  (let ((bands (and (plusp (regression-count regression)) (fit-bands regression)))
        (varying (sort (copy-list (regression-varying regression)) #'<))
        (bounds (parameter-region-initial-bounds region)))
    (when (and bands (plusp (band-freedom (first bands))))
      (flet ((scale (band)
               (max 1d-12 (sqrt (/ (band-residual-sum band) (band-freedom band))))))
        (mapcar #'cdr
                (stable-sort
                 (loop for band in bands
                       for (min . max) across (parameter-region-final-bounds region)
                       nconc (loop for low-p in '(t nil)
                                   collect (multiple-value-bind (corner value)
                                               (worst-corner (band-solution band) varying bounds
                                                             low-p)
                                             (cons (/ (if low-p (- value min) (- max value))
                                                      (scale band))
                                                   corner))))
                 #'< :key #'car))))))
