;;;; Numbers in Z3: one real a numeric fluent and timepoint.

(in-package #:discrepancy-finder.event-calculus)

(defun number-term (reasoner term time)
  "Return the Z3 term of the ground TERM, whose times are relative to TIME."
  (labels ((convert (term)
             (if (rationalp term)
                 term
                 (case (first term)
                   (:value (value-term reasoner (second term) (+ time (third term))))
                   (:+ (z3:sum (mapcar #'convert (rest term))))
                   (:* (z3:product (mapcar #'convert (rest term))))
                   (:- (if (cddr term)
                           (z3:difference (convert (second term)) (convert (third term)))
                           (z3:difference 0 (convert (second term)))))
                   (:/ (z3:quotient (convert (second term)) (convert (third term))))))))
    (convert term)))

(defun value-term (reasoner numeric time)
  "Return the Z3 variable for the value of NUMERIC at TIME."
  (let ((key (cons numeric time)) (table (reasoner-numbers reasoner)))
    (or (gethash key table)
        (setf (gethash key table)
              (let ((ground (encoder-ground (reasoner-encoder reasoner))))
                (z3:variable (reasoner-context reasoner)
                             (atom-text (list :value-at
                                              (svref (ground-theory-numerics ground) numeric)
                                              time))
                             (z3:real-sort (reasoner-context reasoner))))))))

(defun divisors (term)
  "Return the divisors in the ground TERM that are no numbers."
  (when (consp term)
    (append (and (eq (first term) :/) (consp (third term)) (list (third term)))
            (unless (eq (first term) :value)
              (mapcan #'divisors (copy-list (rest term)))))))

(defun comparison-proposition (reasoner comparison time)
  "Return the proposition of COMPARISON, (operator term term), relative to TIME.  Where something is
divided by 0 it is false."
  (destructuring-bind (operator left right) comparison
    (flet ((convert (term) (number-term reasoner term time)))
      (let ((p (convert left)) (q (convert right)))
        (z3:conjunction
         (cons (ecase operator
                 (:= (z3:equals p q))
                 (:< (z3:less p q))
                 (:<= (z3:less-or-equal p q)))
               (loop for divisor in (append (divisors left) (divisors right))
                     collect (z3:negation (z3:equals (convert divisor) 0)))))))))

(defun assert-comparisons (reasoner template time used)
  "Tie the comparisons of TEMPLATE at TIME to their atoms, where clauses USED have them."
  (loop for (code . comparison) in (template-comparisons template)
        for variable = (encoder-variable (reasoner-encoder reasoner) code time)
        do (unless (zerop (sbit used variable))
             (z3:solver-assert (reasoner-solver reasoner)
                               (z3:equivalence
                                (z3:clause-set-term (reasoner-clause-set reasoner) variable)
                                (comparison-proposition reasoner comparison time))))))

(defun current-numbers (reasoner)
  "Return a table from (numeric . time) to the numbers of the model that the last check found."
  (let ((table (make-term-table)))
    (maphash (lambda (key term)
               (setf (gethash key table) (z3:model-value (reasoner-solver reasoner) term)))
             (reasoner-numbers reasoner))
    table))
