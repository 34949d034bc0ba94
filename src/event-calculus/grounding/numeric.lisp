;;;; Numeric fluents in conditions: comparisons that depend on the state.
;;;;
;;;; (value-at FLUENT TIME), in a state formula (value-at FLUENT), is the number that a numeric
;;;; fluent has.  A comparison of terms with
;;;; such values is an atom of its own, (:compare operator term term); Z3 sees one real a fluent and
;;;; timepoint.  What is constant is folded here.

(in-package #:discrepancy-finder.event-calculus)

(defun fold-arithmetic (operator terms)
  "Return the ground term (OPERATOR . TERMS), evaluated if all are numbers."
  (if (every #'rationalp terms)
      (ecase operator
        (:+ (reduce #'+ terms))
        (:- (apply #'- terms))
        (:* (reduce #'* terms))
        (:/ (apply #'/ terms)))
      (cons operator terms)))

(defun compile-number (compilation term)
  "Return a function that returns the ground term of TERM, a number where it is constant."
  (cond ((not (mentions-value-p term))
         (let ((value (compile-term compilation term))
               (drop (dropper compilation)))
           (declare (type function value drop))
           (environment-lambda (environment)
             (let ((number (funcall value environment)))
               (if (rationalp number) number (funcall drop))))))
        ((eq (first term) :value-at)
         (compile-timed :value (compile-numeric compilation (second term))
                        (if (third term)
                            (compile-time compilation (third term))
                            (compile-constant 0))))
        (t (when (eq (first term) :mod)
             (theory-problem (compilation-theory compilation) nil term
                             "there is no remainder of the value of a numeric fluent"))
         (let ((operator (first term))
               (parts (mapcar (lambda (part) (compile-number compilation part)) (rest term)))
               (drop (dropper compilation)))
           (declare (type function drop))
           (environment-lambda (environment)
             (let ((terms (loop for part of-type function in parts
                                collect (funcall part environment))))
               (when (and (eq operator :/) (eql (second terms) 0))
                 (funcall drop))
               (fold-arithmetic operator terms)))))))

(defun fold-comparison (operator left right)
  "Return the ground formula that compares the ground terms LEFT and RIGHT."
  (if (and (rationalp left) (rationalp right))
      (ecase operator (:= (= left right)) (:< (< left right)) (:<= (<= left right)))
      (list :compare operator left right)))

(defun compile-numeric-comparison (compilation form)
  (let ((operator (first form))
        (left (compile-number compilation (second form)))
        (right (compile-number compilation (third form))))
    (declare (type function left right))
    (environment-lambda (environment)
      (let ((p (funcall left environment)) (q (funcall right environment)))
        (ecase operator
          ((:= :< :<=) (fold-comparison operator p q))
          (:/= (fold-not (fold-comparison := p q)))
          (:> (fold-comparison :< q p))
          (:>= (fold-comparison :<= q p)))))))
