;;;; Deciding symbolic values: which of several is it on this path?
;;;;
;;;; TRUTH decides whether a value is true, SETTLED what it is.  A finite choice is decided
;;;; completely.  Numbers that can have many values are decided for the first *NUMBER-LIMIT* of
;;;; them, in an order that depends on the path alone, and the exploration is not complete then.

(in-package #:discrepancy-finder.symbolic-execution)

(defparameter *number-limit* 32
  "So many values of a symbolic number are explored where compiled code must know it.")

(defun note-known (value known)
  "Note that the symbolic VALUE is KNOWN on the path; return KNOWN."
  (setf (symbolic-value-path value) *path*
        (symbolic-value-known value) known))

(defun decide-proposition (proposition description)
  "Return T or NIL, whether PROPOSITION is true, by a decision."
  (if (z3:term-p proposition)
      (decide *path* description
              (list (cons t proposition) (cons nil (z3:negation proposition)))
              :exhaustive t)
      proposition))

(defun truth (value description)
  "Return VALUE, or T or NIL by a decision if it is symbolic."
  (cond ((not (symbolic-value-p value)) value)
        ((known-p value) (and (symbolic-value-known value) t))
        (t (let ((truth (decide-proposition (truth-proposition value) description)))
             (when (or (null truth) (symbolic-boolean-p value))
               (note-known value truth))
             truth))))

(defun settled (value description)
  "Return VALUE, or what it is by a decision if it is symbolic.  What it is made of is not looked
at."
  (cond ((not (symbolic-value-p value)) value)
        ((known-p value) (symbolic-value-known value))
        (t (etypecase value
             (symbolic-boolean (truth value description))
             (symbolic-element
              (note-known value (decide *path* description (symbolic-element-choices value)
                                        :exhaustive t)))
             (symbolic-number (note-known value (settled-number value description)))))))

;;; Numbers

(defun type-bounds (type)
  "Return the least and the greatest number of TYPE, a specifier such as (integer 0 3); NIL where
there is none."
  (if (consp type)
      (destructuring-bind (&optional (low '*) (high '*)) (rest type)
        (values (and (rationalp low) low) (and (rationalp high) high)))
      (values nil nil)))

(defun settled-number (number description)
  (let ((term (symbolic-number-term number)))
    (multiple-value-bind (low high) (type-bounds (symbolic-number-type number))
      (cond ((not (integer-term-p term)) (settled-real number description))
            ((and low high (< (- high low) *number-limit*))
             (decide *path* description
                     (loop for value from low to high
                           collect (cons value (z3:equals term value)))
                     :exhaustive t))
            (t (settled-integer term description))))))

(defun integer-term-p (term)
  (eq (z3:sort-kind (z3:term-sort term)) :integer))

(defun settled-integer (term description)
  "Decide for a value of the integer TERM, the values nearest to 0 first."
  (let ((path *path*))
    (decide path description (lambda () (integer-options path term description)))))

(defun integer-options (path term description)
  "Return the options for the values of the integer TERM, and true if these are all."
  (let ((options '()) (more nil) (solver (path-solver path)))
    (z3:push-scope solver)
    (unwind-protect
         (loop repeat (1+ *number-limit*)
               for value = (nearest-integer path term)
               while value
               do (push (cons value (z3:equals term value)) options)
                  (z3:solver-assert solver (z3:negation (z3:equals term value))))
      (z3:pop-scope solver))
    (when (> (length options) *number-limit*)
      (pop options)
      (setf more t))
    (when more
      (note-limit path (format nil "other values of a number than the first ~d, at ~a"
                               *number-limit* description)))
    (values (nreverse options) (not more))))

(defun nearest-integer (path term)
  "Return the possible value of the integer TERM on PATH that is nearest to 0, the positive one of
two, or NIL."
  (flet ((within-p (bound)
           (possible-p path (z3:conjunction (list (z3:less-or-equal (- bound) term)
                                                  (z3:less-or-equal term bound))))))
    (when (eq (z3:check (path-solver path)) :sat)
      (let ((low -1) (high 0))
        ;; No value is within LOW, one is within HIGH.
        (loop until (within-p high)
              do (setf low high
                       high (if (zerop high) 1 (* 2 high))))
        (loop until (= (- high low) 1)
              do (let ((middle (floor (+ low high) 2)))
                   (if (within-p middle)
                       (setf high middle)
                       (setf low middle))))
        (if (possible-p path (z3:equals term high)) high (- high))))))

(defun settled-real (number description)
  "Return a value of the real NUMBER: the one with the least denominator, and of these the one
nearest to 0.  The exploration is not complete unless it is the only one."
  (let ((path *path*))
    (decide path description
            (lambda ()
              (let* ((term (symbolic-number-term number))
                     (value (simplest-rational path term)))
                (when value
                  (let ((equal (z3:equals term value)))
                    (when (possible-p path (z3:negation equal))
                      (note-limit path (format nil "other values of a number than ~a, at ~a"
                                               value description)))
                    (list (cons value equal)))))))))

(defparameter *largest-denominator* 64
  "Values with greater denominators are not looked for.")

(defun simplest-rational (path term)
  "Return the possible value of the real TERM on PATH with the least denominator, and of these the
one nearest to 0; if none has a small one what Z3 finds first.  NIL if there is none."
  (let ((solver (path-solver path)))
    (when (eq (z3:check solver) :sat)
      (loop for denominator from 1 to *largest-denominator*
            for product = (z3:product (list denominator term))
            when (possible-p path (z3:integral product))
              do (z3:push-scope solver)
                 (return
                   (unwind-protect
                        (progn (z3:solver-assert solver (z3:integral product))
                               (/ (nearest-integer path (z3:real-to-integer product))
                                  denominator))
                     (z3:pop-scope solver)))
            finally (z3:check solver)
                    (let ((value (z3:model-value solver term)))
                      (return (if (rationalp value)
                                  value
                                  (rational (z3:algebraic-number-lower value)))))))))
