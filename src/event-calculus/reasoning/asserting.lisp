;;;; From templates to the solver.
;;;;
;;;; The propositional variable of a timeless atom is its code; those of timepoint t begin at
;;;; global size + (t - first timepoint) * step size.  SCHEDULE says which templates are to be
;;;; copied for which timepoints when a horizon grows, ADD-TO-SOLVER does it.

(in-package #:discrepancy-finder.event-calculus)

(declaim (inline code-variable))
(defun code-variable (code time first-time global-size step-size)
  "Return the propositional variable of the positive CODE relative to TIME."
  (declare (type (unsigned-byte 48) code) (type fixnum time first-time)
           (type (unsigned-byte 24) global-size step-size))
  (if (global-code-p code)
      code
      (the fixnum (+ global-size (code-atom code)
                     (the fixnum (* (the fixnum (- (+ time (code-distance code)) first-time))
                                    step-size))))))

(defun encoder-variable (encoder code time)
  (code-variable code time (car (encoder-horizon encoder)) (encoder-global-size encoder)
                 (encoder-step-size encoder)))

(defun copy-template (template encoder time output position occurring)
  "Write the clauses of TEMPLATE relative to TIME into the vector OUTPUT from POSITION on; mark
their variables in OCCURRING.  Return the position after them."
  (declare (type (simple-array fixnum (*)) output) (type fixnum position time)
           (type simple-bit-vector occurring) (optimize speed (safety 1)))
  (let ((first-time (car (encoder-horizon encoder)))
        (global-size (encoder-global-size encoder))
        (step-size (encoder-step-size encoder)))
    (declare (type (unsigned-byte 24) global-size step-size) (type fixnum first-time))
    (sb-kernel:with-array-data ((literals (template-literals template)) (start) (end))
      (declare (ignore start end) (type (simple-array fixnum (*)) literals))
      (dotimes (index (fill-pointer (template-literals template)) position)
        (let ((literal (aref literals index)))
          (setf (aref output position)
                (if (zerop literal)
                    0
                    (let ((variable (code-variable (abs literal) time first-time global-size
                                                   step-size)))
                      (setf (sbit occurring variable) 1)
                      (if (minusp literal) (- variable) variable))))
          (incf position))))))

(defconstant +most-literals+ 30000000
  "So many literals may the clauses of a horizon have.")

(defun check-literal-count (encoder horizon)
  "Signal THEORY-ERROR if the clauses for HORIZON would exhaust the heap."
  (let ((count (* (+ 1 (- (cdr horizon) (car horizon)))
                  (loop for template in (encoder-templates encoder)
                        sum (fill-pointer (template-literals template))))))
    (when (> count +most-literals+)
      (theory-problem (ground-theory-theory (encoder-ground encoder)) nil nil
                      "the timepoints ~d to ~d need some ~d literals, more than ~d"
                      (car horizon) (cdr horizon) count +most-literals+))))

(defun schedule (encoder from horizon)
  "Return a list of (template . time): the clauses to be added when the last timepoint grows from
FROM, NIL for none so far, to that of HORIZON."
  (destructuring-bind (first . last) horizon
    (append
     (unless from
       (list (cons (encoder-initial encoder) first)
             (cons (encoder-absolute encoder) 0)))
     (loop for template in (reverse (encoder-templates encoder))
           append (loop for time from (max (- first (template-first template))
                                           (if from
                                               (1+ (- from (template-last template)))
                                               most-negative-fixnum))
                          to (- last (template-last template))
                        collect (cons template time))))))

(defun grow-bits (bits size)
  (if (< (length bits) size)
      (replace (make-array (max size (* 2 (length bits))) :element-type 'bit :initial-element 0)
               bits)
      bits))

(defun clauses-of-jobs (encoder jobs occurring)
  "Return the clauses of JOBS, as SCHEDULE names them; mark their variables in OCCURRING."
  (let ((output (make-array (loop for (template) in jobs
                                  sum (fill-pointer (template-literals template)))
                            :element-type 'fixnum))
        (position 0))
    (loop for (template . time) in jobs
          do (setf position (copy-template template encoder time output position occurring)))
    output))

(defun map-exclusions (function encoder jobs)
  "Call FUNCTION with each list of variables of which JOBS say that at most one is true."
  (loop for (template . time) in jobs
        do (dolist (codes (template-exclusions template))
             (funcall (the function function)
                      (loop for code in codes collect (encoder-variable encoder code time))))))

(defun used-variables (clauses size)
  "Return a bit for each variable below SIZE: whether it is in CLAUSES."
  (let ((bits (make-array size :element-type 'bit :initial-element 0)))
    (loop for literal across (the (simple-array fixnum (*)) clauses)
          do (setf (sbit bits (abs literal)) 1))
    bits))

(defun add-to-solver (reasoner from horizon)
  "Assert the clauses that SCHEDULE names."
  (check-literal-count (reasoner-encoder reasoner) horizon)
  (let* ((encoder (reasoner-encoder reasoner))
         (jobs (schedule encoder from horizon))
         (size (+ (encoder-global-size encoder)
                  (* (+ 1 (- (cdr horizon) (car horizon))) (encoder-step-size encoder))))
         (occurring (grow-bits (reasoner-occurring reasoner) size))
         (clauses (clauses-of-jobs encoder jobs occurring)))
    (unless (reasoner-tracked reasoner)
      (setf (values clauses (reasoner-truths reasoner))
            (simplify-clauses clauses (reasoner-truths reasoner) size)))
    (z3:assert-clauses (reasoner-clause-set reasoner) clauses)
    (let ((used (used-variables clauses size)))
      (loop for (template . time) in jobs
            do (assert-comparisons reasoner template time used)))
    (map-exclusions (lambda (variables)
                      (dolist (variable variables)
                        (setf (sbit occurring variable) 1))
                      (z3:assert-at-most (reasoner-clause-set reasoner) variables 1))
                    encoder jobs)
    (setf (reasoner-occurring reasoner) occurring)))
