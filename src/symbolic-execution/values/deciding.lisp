;;;; Deciding symbolic values: which of several is it on this path?
;;;;
;;;; TRUTH decides whether a value is true, SETTLED what it is.  A finite choice is decided
;;;; completely, and so is a number with few possible values.  Of an integer with many the first
;;;; *NUMBER-LIMIT* are taken, of a real one, by an order that depends on the path alone; and the
;;;; exploration is not complete then.

(in-package #:discrepancy-finder.symbolic-execution)

(defparameter *number-limit* 32
  "So many values of a symbolic number are explored where compiled code must know it.")

(defun note-known (value known)
  "Note that the symbolic VALUE is KNOWN on the path; return KNOWN."
  (setf (symbolic-value-path value) *path*
        (symbolic-value-known value) known))

(defun decided-before (path proposition)
  "Return :TRUE or :FALSE if a decision on PATH says so of the term PROPOSITION, else NIL."
  (let ((negation (z3:negation proposition)))
    (loop for decision in (path-decisions path)
          for decided = (decision-proposition decision)
          when (z3:term-p decided)
            do (cond ((z3:term-equal decided proposition) (return :true))
                     ((z3:term-equal decided negation) (return :false))))))

(defun decide-proposition (proposition description)
  "Return T or NIL, whether PROPOSITION is true, by a decision unless that was decided before."
  (if (z3:term-p proposition)
      (let ((path *path*))
        (case (decided-before path proposition)
          (:true t)
          (:false nil)
          (t (decide path description
                     (list (cons t proposition) (cons nil (z3:negation proposition)))
                     :exhaustive t))))
      proposition))

(defun remaining-choices (element)
  "Return those of the choices of the symbolic ELEMENT that no decision on the path excludes."
  (let ((choices (symbolic-element-choices element)) (path *path*))
    (flet ((only (object)
             (note-known element object)
             (return-from remaining-choices (list (cons object t)))))
      (if (and path (path-decisions path))
          (let ((remaining '()))
            (dolist (choice choices)
              (case (decided-before path (cdr choice))
                (:true (only (car choice)))
                (:false)
                (t (push choice remaining))))
            (when (and remaining (null (rest remaining)))
              (only (car (first remaining))))
            (nreverse remaining))
          choices))))

(defun decide-choice (element description)
  "Return what the symbolic ELEMENT is, by a decision unless that is known from others."
  (let ((choices (remaining-choices element)))
    (if (rest choices)
        (decide *path* description choices :exhaustive t)
        (car (first choices)))))

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
              (note-known value (decide-choice value description)))
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
  (let ((term (symbolic-number-term number)) (path *path*))
    (multiple-value-bind (low high) (type-bounds (symbolic-number-type number))
      (decide path description
              (lambda ()
                (if (and (integer-term-p term) low high (< (- high low) *number-limit*))
                    (value-options term (loop for value from low to high collect value))
                    (let ((values (all-values path term)))
                      (cond ((listp values) (value-options term values))
                            ((integer-term-p term) (integer-options path term description))
                            (t (real-options path term description))))))))))

(defun value-options (term values)
  "Return the options for VALUES, the only possible ones of the numeric TERM, and true."
  (values (loop for value in values collect (cons value (z3:equals term value)))
          t))

(defun all-values (path term)
  "Return the possible values of the numeric TERM on PATH in ascending order, or :MANY if they are
more than *NUMBER-LIMIT*."
  (let ((solver (path-solver path)) (oracle (path-oracle path)) (values '()))
    (z3:push-scope solver)
    (unwind-protect
         (loop repeat *number-limit*
               do (case (ask oracle)
                    (:unsat (return (sort values #'<)))
                    (:unknown (return :many)))
                  (let ((value (z3:model-value solver term)))
                    (unless (rationalp value)
                      (return :many))
                    (push value values)
                    (z3:solver-assert solver (z3:negation (z3:equals term value))))
               finally (return (if (eq (ask oracle) :unsat) (sort values #'<) :many)))
      (z3:pop-scope solver))))

(defun integer-term-p (term)
  (eq (z3:sort-kind (z3:term-sort term)) :integer))

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
    (unless (eq (ask (path-oracle path)) :unsat)
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

(defun real-options (path term description)
  "Return a list of one option for the real TERM, which has many values: the one with the least
denominator, and of these the one nearest to 0."
  (let ((value (simplest-rational path term)))
    (note-limit path (format nil "other values of a number than ~a, at ~a" value description))
    (and value (list (cons value (z3:equals term value))))))

(defparameter *largest-denominator* 64
  "Values with greater denominators are not looked for.")

(defun simplest-rational (path term)
  "Return the possible value of the real TERM on PATH with the least denominator, and of these the
one nearest to 0; if none has a small one what Z3 finds first.  NIL if there is none."
  (let ((solver (path-solver path)))
    (unless (eq (ask (path-oracle path)) :unsat)
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
