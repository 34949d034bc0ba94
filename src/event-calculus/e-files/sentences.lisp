;;;; Formulas of a theory as text of a .e file.
;;;;
;;;; SENTENCE-LINES returns a sentence as lines.  Parentheses stand only where the precedences of
;;;; the operators (expressions.lisp) need them.  A formula that does not fit in a line is broken
;;;; after its outermost connective, and so on for its parts.

(in-package #:discrepancy-finder.event-calculus)

(defconstant +text-width+ 96
  "So many characters may stand in a line of a formula that can be broken.")

(defstruct (layout (:constructor make-layout (names axiom)) (:copier nil))
  "For what text is written: NAMES are the .e names, AXIOM is to blame in errors, or NIL."
  (names nil :type e-names :read-only t)
  (axiom nil :type (or null axiom) :read-only t))

(defun unwritable (theory axiom control &rest arguments)
  "Signal an E-FILE-ERROR: a thing in THEORY cannot be said in a .e file."
  (e-problem nil nil "Theory ~a cannot be written as a .e file~@[, axiom ~a~]: ~?"
             (name-text (theory-name theory)) (and axiom (name-text (axiom-name axiom)))
             control arguments))

(defun infix-entry (operator)
  (find operator *infix-operators* :key #'second))

(defun simplified (form)
  "Return FORM, of no or one operand where the language needs two, in another way."
  (flet ((fold (operator) (reduce (lambda (left right) (list operator left right)) (rest form))))
    (case (first form)
      ((:and :or)
       (case (length (rest form))
         (0 (if (eq (first form) :and) '(:= 0 0) '(:= 0 1)))
         (1 (second form))
         (t form)))
      ((:+ :*) (if (= (length form) 3) form (fold (first form))))
      (:- (if (= (length form) 2) (list :- 0 (second form)) form))
      (t form))))

;;; On one line

(defun write-arguments (layout arguments stream separator)
  (write-char #\( stream)
  (loop for (argument . more) on arguments
        do (write-expression layout argument 0 t stream separator)
           (when more (write-string separator stream)))
  (write-char #\) stream))

(defun write-quantifier (layout form stream)
  "Write the variables of FORM, (quantifier variables formula)."
  (let ((forall (eq (first form) :forall)))
    (format stream "~:[{~;[~]~{~a~^,~}~:[}~;]~] " forall
            (mapcar (lambda (variable) (e-variable-name (layout-names layout) variable))
                    (second form))
            forall)))

(defun operand-precedences (entry)
  "Return the least precedence of the first operand of the operator of ENTRY and of the others."
  (destructuring-bind (sign operator precedence association) entry
    (declare (ignore sign operator))
    (ecase association
      (:left (values precedence (1+ precedence)))
      (:right (values (1+ precedence) precedence))
      ((:none :flat) (values (1+ precedence) (1+ precedence))))))

(defun parenthesized-p (form least tail)
  "Return true if FORM needs parentheses as an operand that must bind as tightly as LEAST.  TAIL is
true where nothing follows that a quantifier could reach."
  (let ((entry (and (consp form) (infix-entry (first form)))))
    (cond ((integerp form) (and (minusp form) (>= least 8)))
          ((atom form) nil)
          ((member (first form) '(:forall :exists)) (not tail))
          ((eq (first form) :not) (> least +not-precedence+))
          (entry (< (third entry) least)))))

(defun write-infix (layout form tail stream)
  (let ((entry (infix-entry (first form))))
    (unless (>= (length form) 3)
      (unwritable (e-names-theory (layout-names layout)) (layout-axiom layout)
                  "~a has one operand" (formula-text form)))
    (multiple-value-bind (first others) (operand-precedences entry)
      (write-expression layout (second form) first nil stream)
      (loop for (operand . more) on (cddr form)
            do (format stream (if (< (third entry) +not-precedence+) " ~a " "~a") (first entry))
               (write-expression layout operand others (and tail (null more)) stream)))))

(defun write-expression (layout form least tail stream &optional (separator ","))
  "Write FORM, a formula or a term, on one line; LEAST and TAIL are as in PARENTHESIZED-P, SEPARATOR
stands between arguments."
  (let ((form (if (consp form) (simplified form) form))
        (names (layout-names layout)))
    (cond ((parenthesized-p form least tail)
           (write-char #\( stream)
           (write-expression layout form 0 t stream separator)
           (write-char #\) stream))
          ((integerp form) (format stream "~d" form))
          ((variable-p form) (write-string (e-variable-name names form) stream))
          ((atom form) (write-string (e-name names :constant form) stream))
          ((member (first form) '(:forall :exists))
           (write-quantifier layout form stream)
           (write-expression layout (third form) 0 tail stream))
          ((eq (first form) :not)
           (write-char #\! stream)
           (write-expression layout (second form) +not-precedence+ tail stream))
          ((infix-entry (first form)) (write-infix layout form tail stream))
          (t (write-string (e-name names :symbol (first form)) stream)
             (write-arguments layout (rest form) stream separator)))))

;;; On several lines

(defun add-around (lines before after)
  "Return LINES with the strings BEFORE and AFTER at the beginning and at the end."
  (let ((lines (cons (concatenate 'string before (first lines)) (rest lines))))
    (append (butlast lines)
            (list (concatenate 'string (first (last lines)) after)))))

(defun indented (lines)
  "Return LINES, the first one excepted, moved by a space, as after an opening parenthesis."
  (cons (first lines)
        (mapcar (lambda (line) (concatenate 'string " " line)) (rest lines))))

(defun connective-lines (layout form tail)
  "Return the lines of FORM, broken after each of its outermost connectives."
  (let* ((entry (infix-entry (first form)))
         (sign (concatenate 'string " " (first entry))))
    (multiple-value-bind (first others) (operand-precedences entry)
      (append (add-around (expression-lines layout (second form) first nil) "" sign)
              (loop for (operand . more) on (cddr form)
                    append (add-around (expression-lines layout operand others
                                                         (and tail (null more)))
                                       "" (if more sign "")))))))

(defun expression-lines (layout form least tail)
  "Return FORM as a list of lines, one if it fits; LEAST and TAIL are as in PARENTHESIZED-P."
  (let ((text (with-output-to-string (stream)
                (write-expression layout form least tail stream)))
        (form (if (consp form) (simplified form) form)))
    (cond ((or (<= (length text) +text-width+) (atom form)) (list text))
          ((parenthesized-p form least tail)
           (indented (add-around (expression-lines layout form 0 t) "(" ")")))
          ((member (first form) '(:forall :exists))
           (cons (string-right-trim " " (with-output-to-string (stream)
                                          (write-quantifier layout form stream)))
                 (expression-lines layout (third form) 0 tail)))
          ((eq (first form) :not)
           (indented (add-around (expression-lines layout (second form) +not-precedence+ tail)
                                 "!" "")))
          ((member (first form) '(:and :or :implies :iff)) (connective-lines layout form tail))
          (t (list text)))))

(defun at-first-timepoint (theory form)
  "Return FORM, a formula over fluents that stand for themselves, with HOLDS-AT around them."
  (labels ((walk (form)
             (cond ((member (first form) '(:forall :exists))
                    (list (first form) (second form) (walk (third form))))
                   ((member (first form) *connectives*)
                    (cons (first form) (mapcar #'walk (rest form))))
                   ((assoc (first form) (theory-fluents theory))
                    (list :holds-at form (if (theory-time-range theory)
                                             (car (theory-time-range theory))
                                             0)))
                   (t form))))
    (walk form)))

(defun sentence-lines (names axiom label)
  "Return the lines of AXIOM with LABEL, a string or NIL, up to the full stop."
  (let* ((formula (axiom-formula axiom))
         (sentence (if (eq (first formula) :initially)
                       (at-first-timepoint (e-names-theory names) (second formula))
                       formula))
         (variables (free-variables sentence)))
    (add-around (expression-lines (make-layout names axiom)
                                  (if variables (list :forall variables sentence) sentence)
                                  0 t)
                (if label (format nil "~a: " label) "")
                ".")))
