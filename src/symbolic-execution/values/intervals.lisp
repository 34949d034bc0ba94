;;;; Types of symbolic numbers: intervals, so that a small range can be enumerated.
;;;;
;;;; An interval is a list (low high) of rationals, or NIL where there is no bound.

(in-package #:discrepancy-finder.symbolic-execution)

(defun number-interval (value)
  "Return the interval of VALUE, a symbolic number or a rational."
  (if (symbolic-number-p value)
      (multiple-value-list (type-bounds (symbolic-number-type value)))
      (list value value)))

(defun interval-type (integer-p interval)
  "Return the type specifier of the integers, if INTEGER-P, or rationals in INTERVAL."
  (destructuring-bind (low high) interval
    (let ((name (if integer-p 'integer 'rational)))
      (if (or low high)
          (list name (if low (if integer-p (ceiling low) low) '*)
                (if high (if integer-p (floor high) high) '*))
          name))))

(defun interval-sum (one other)
  (mapcar (lambda (a b) (and a b (+ a b))) one other))

(defun interval-negation (interval)
  (destructuring-bind (low high) interval
    (list (and high (- high)) (and low (- low)))))

(defun interval-product (one other)
  (if (and (notany #'null one) (notany #'null other))
      (let ((corners (loop for a in one append (loop for b in other collect (* a b)))))
        (list (reduce #'min corners) (reduce #'max corners)))
      '(nil nil)))

(defun interval-hull (one other)
  (destructuring-bind ((low high) (other-low other-high)) (list one other)
    (list (and low other-low (min low other-low))
          (and high other-high (max high other-high)))))

(defun interval-quotient (interval divisor)
  "Return the interval of the floor, ceiling, truncation or rounding of what is in INTERVAL divided
by DIVISOR, which is positive."
  (destructuring-bind (low high) interval
    (list (and low (floor low divisor)) (and high (ceiling high divisor)))))
