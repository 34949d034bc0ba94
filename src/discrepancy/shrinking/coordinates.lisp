;;;; Shrinking a sample: which coordinates matter, and round numbers for them.
;;;;
;;;; Each parameter has an ordinary value: a tolerance the one that the scene has undrawn, a
;;;; coordinate the middle of its range.  As many parameters as possible get theirs; those that are
;;;; left matter, and are rounded as far as the discrepancy stays.

(in-package #:discrepancy-finder.discrepancy)

(defun rounded (value decimals)
  "Return the double float VALUE rounded to so many DECIMALS."
  (let ((scale (expt 10 decimals)))
    (float (/ (round (* (rational value) scale)) scale) 1d0)))

(defun decimals (value)
  "Return the number of decimals, at most 17, with which VALUE is written."
  (or (loop for decimals from 0 below 17
            when (= value (rounded value decimals)) return decimals)
      17))

(defun possible-p (parameter value)
  "Return true if a sample may have VALUE for PARAMETER."
  (and (<= (parameter-min parameter) value)
       (if (or (tolerance-p parameter) (fixed-p parameter))
           (<= value (parameter-max parameter))
           (< value (parameter-max parameter)))))

(defun middle-value (parameter)
  "Return a round number near the middle of the range of PARAMETER."
  (let* ((min (parameter-min parameter))
         (max (parameter-max parameter))
         (middle (/ (+ min max) 2)))
    (or (loop for decimals from 0 to 6
              for value = (rounded middle decimals)
              when (and (possible-p parameter value)
                        (<= (abs (- value middle)) (* 1/10 (- max min))))
                return value)
        middle)))

(defun ordinary-value (scene parameter)
  "Return the value that PARAMETER has where nothing depends on it."
  (let ((own (and (tolerance-p parameter)
                  (projection:scene-parameter scene (parameter-axis parameter)))))
    (cond ((fixed-p parameter) (parameter-min parameter))
          ((and own (possible-p parameter own)) own)
          (t (middle-value parameter)))))

(defun sample-with (sample values)
  "Return SAMPLE with VALUES, a list."
  (make-sample nil (sample-parameters sample)
               (coerce values '(simple-array double-float (*)))))

(defun sample-with-value (sample number value)
  "Return SAMPLE with VALUE for its parameter NUMBER."
  (let ((values (coerce (sample-values sample) 'list)))
    (sample-with sample (append (subseq values 0 number) (list value)
                                (nthcdr (1+ number) values)))))

(defun mixed-sample (sample other numbers)
  "Return SAMPLE with the values of OTHER for the parameters that are not in the list NUMBERS."
  (sample-with sample (loop for value across (sample-values sample)
                            for other-value across (sample-values other)
                            for number from 0
                            collect (if (member number numbers) value other-value))))

(defun ordinary-sample (scene sample)
  "Return SAMPLE with the ordinary values of all parameters."
  (sample-with sample (loop for parameter in (sample-parameters sample)
                            collect (ordinary-value scene parameter))))

(defun differing-numbers (sample other)
  "Return the numbers of the parameters for which SAMPLE and OTHER have different values."
  (loop for value across (sample-values sample)
        for other-value across (sample-values other)
        for number from 0
        unless (= value other-value) collect number))

(defun mattering-numbers (discrepancy)
  "Return the numbers of the parameters for which the sample of DISCREPANCY does not have the
ordinary value."
  (let ((sample (discrepancy-sample discrepancy)))
    (differing-numbers sample
                       (ordinary-sample (domain-scene (discrepancy-domain discrepancy)) sample))))

(defun shrink-coordinates (shrinker)
  "Give ordinary values to the parameters of the best case of SHRINKER that do not matter."
  (let* ((sample (discrepancy-sample (shrinker-best shrinker)))
         (ordinary (ordinary-sample (domain-scene (discrepancy-domain (shrinker-best shrinker)))
                                    sample)))
    (flet ((improve-p (numbers)
             (improve shrinker :sample (mixed-sample sample ordinary numbers))))
      (or (improve-p '())
          (smallest-list (differing-numbers sample ordinary) #'improve-p)))))

(defun round-values (parameter value decimals)
  "Return the possible values of PARAMETER with so many DECIMALS next to VALUE, the nearest one
first, but none that is farther away than a tenth of the range."
  (let* ((near (/ (- (parameter-max parameter) (parameter-min parameter)) 10))
         (step (expt 10 (- decimals)))
         (nearest (rounded value decimals))
         (other (rounded (if (> nearest value) (- nearest step) (+ nearest step)) decimals)))
    (remove-if-not (lambda (round)
                     (and (possible-p parameter round) (<= (abs (- round value)) near)))
                   (list nearest other))))

(defun round-coordinate (shrinker number)
  "Round the value of the parameter NUMBER of the best case as far as the discrepancy stays."
  (let* ((sample (discrepancy-sample (shrinker-best shrinker)))
         (value (aref (sample-values sample) number)))
    (loop for decimals from 0 below (min 6 (decimals value))
          do (dolist (round (round-values (nth number (sample-parameters sample)) value decimals))
               (when (improve shrinker :sample (sample-with-value sample number round))
                 (return-from round-coordinate))))))

(defun round-coordinates (shrinker)
  "Round the values of the best case of SHRINKER that matter: all at once to three decimals, then
each alone."
  (let ((sample (discrepancy-sample (shrinker-best shrinker))))
    (improve shrinker
             :sample (sample-with sample
                                  (loop for parameter in (sample-parameters sample)
                                        for value across (sample-values sample)
                                        for round = (rounded value 3)
                                        collect (if (possible-p parameter round) round value))))
    (dolist (number (mattering-numbers (shrinker-best shrinker)))
      (round-coordinate shrinker number))))
