;;;; Formulas and terms of a .e file, as trees of what is written there.
;;;;
;;;; Formulas and terms are parsed by one grammar of operators, so that it need not be known at a
;;;; parenthesis which of them it holds; RESOLVE-FORMULA in formulas.lisp refuses a sum of formulas.
;;;; From the loosest operator to the tightest: <->, ->, |, &, !, comparisons, + and -, * / and %.
;;;; A quantifier, [x,y] or {x,y}, reaches as far to the right as it can.  A node is an integer or
;;;;   (:name line text)              a variable, a constant, or a symbol without parentheses
;;;;   (:call line text argument*)    a symbol with parentheses
;;;;   (:forall line (text*) body) and (:exists line (text*) body)
;;;;   (operator line operand*)       the operators as in formulas in Lisp

(in-package #:discrepancy-finder.event-calculus)

(defconstant +deepest-nesting+ 1000
  "So many levels a formula may have; all that walks formulas uses the stack.")

(defparameter *infix-operators*
  '(("<->" :iff 1 :right) ("->" :implies 2 :right) ("|" :or 3 :flat) ("&" :and 4 :flat)
    ("=" := 6 :none) ("!=" :/= 6 :none) ("<" :< 6 :none) ("<=" :<= 6 :none) (">" :> 6 :none)
    (">=" :>= 6 :none)
    ("+" :+ 7 :left) ("-" :- 7 :left) ("*" :* 8 :left) ("/" :/ 8 :left) ("%" :mod 8 :left))
  "Sign, operator, precedence, and how a chain associates: :FLAT is one list of all operands.")

(defconstant +not-precedence+ 5)
(defconstant +minus-precedence+ 9)

(defstruct (parser (:constructor make-parser (file text tokens)) (:copier nil))
  "Where reading a text of FILE is: NEXT is the index of the next token, DEPTH the level."
  (file "" :type string :read-only t)
  (text "" :type string :read-only t)
  (tokens #() :type vector :read-only t)
  (next 0 :type fixnum)
  (depth 0 :type fixnum))

(defun peek-token (parser &optional (ahead 0))
  (let ((tokens (parser-tokens parser)))
    (aref tokens (min (+ (parser-next parser) ahead) (1- (length tokens))))))

(defun next-token (parser)
  (prog1 (peek-token parser)
    (incf (parser-next parser))))

(defun previous-token (parser)
  (aref (parser-tokens parser) (max 0 (1- (parser-next parser)))))

(defun syntax-problem (parser token control &rest arguments)
  "Signal an E-FILE-ERROR at the line of TOKEN."
  (apply #'e-problem (parser-file parser) (token-line token) control arguments))

(defun expect (parser expected)
  "Signal that EXPECTED, a description, was expected and the next token was found."
  (syntax-problem parser (peek-token parser) "~a was expected, but ~a was found" expected
                  (token-description (peek-token parser))))

(defun next-sign-p (parser &rest signs)
  (apply #'token-of-p (peek-token parser) signs))

(defun accept-sign (parser sign)
  "If the next token is SIGN, skip it and return it."
  (when (next-sign-p parser sign)
    (next-token parser)))

(defun next-name (parser expected)
  "Return the next token, which must be a name; EXPECTED describes it."
  (if (eq (token-kind (peek-token parser)) :name)
      (next-token parser)
      (expect parser expected)))

(defun comma-separated (parser function)
  "Return the list of what FUNCTION, called between commas, returns."
  (loop collect (funcall function)
        while (accept-sign parser ",")))

(defun close-sign (parser sign opening)
  (or (accept-sign parser sign)
      (expect parser (format nil "\"~a\" for the \"~a\" of line ~d" sign (token-text opening)
                             (token-line opening)))))

(defun too-deep (parser token)
  (syntax-problem parser token "a formula is nested in more than ~d levels" +deepest-nesting+))

;;; Operands

(defun integer-value (parser token)
  "Return the integer that TOKEN, which was just read, stands for."
  (let ((point (peek-token parser))
        (decimals (peek-token parser 1))
        (end (+ (token-start token) (length (token-text token)))))
    (when (and (token-of-p point ".") (= (token-start point) end)
               (eq (token-kind decimals) :integer) (= (token-start decimals) (1+ end)))
      (syntax-problem parser token "~a.~a is not an integer" (token-text token)
                      (token-text decimals)))
    (when (> (length (token-text token)) 18)
      (syntax-problem parser token "the number ~a is too large" (token-description token)))
    (parse-integer (token-text token))))

(defun parse-call (parser name)
  "Return the node of NAME, after which a parenthesis opens."
  (let ((opening (next-token parser)))
    (list* :call (token-line name) (token-text name)
           (unless (accept-sign parser ")")
             (prog1 (comma-separated parser (lambda () (parse-expression parser 0)))
               (close-sign parser ")" opening))))))

(defun parse-quantifier (parser opening operator closing-sign)
  (let ((variables (comma-separated
                    parser (lambda () (token-text (next-name parser "a variable"))))))
    (close-sign parser closing-sign opening)
    (list operator (token-line opening) variables (parse-expression parser 0))))

(defun parse-minus (parser minus)
  (if (eq (token-kind (peek-token parser)) :integer)
      (- (integer-value parser (next-token parser)))
      (list :- (token-line minus) 0 (parse-expression parser +minus-precedence+))))

(defun parse-operand (parser)
  (let ((token (peek-token parser)))
    (case (token-kind token)
      (:name
       (next-token parser)
       (if (next-sign-p parser "(")
           (parse-call parser token)
           (list :name (token-line token) (token-text token))))
      (:integer (integer-value parser (next-token parser)))
      (t
       (cond ((accept-sign parser "(")
              (prog1 (parse-expression parser 0)
                (close-sign parser ")" token)))
             ((accept-sign parser "!")
              (list :not (token-line token) (parse-expression parser +not-precedence+)))
             ((accept-sign parser "[") (parse-quantifier parser token :forall "]"))
             ((accept-sign parser "{") (parse-quantifier parser token :exists "}"))
             ((accept-sign parser "-") (parse-minus parser token))
             (t (expect parser "a formula or a term")))))))

;;; Operators

(defun next-infix-operator (parser)
  "Return the entry of *INFIX-OPERATORS* for the next token, or NIL."
  (let ((token (peek-token parser)))
    (and (eq (token-kind token) :sign)
         (assoc (token-text token) *infix-operators* :test #'string=))))

(defun parse-chain (parser left entry)
  "Return the node of LEFT, the operator of ENTRY, which comes next, and the operands after it."
  (destructuring-bind (sign operator precedence association) entry
    (let ((line (token-line (next-token parser))))
      (flet ((operand (least-precedence) (parse-expression parser least-precedence)))
        (ecase association
          (:right (list operator line left (operand precedence)))
          (:left (list operator line left (operand (1+ precedence))))
          (:flat (list* operator line left (operand (1+ precedence))
                        (loop while (accept-sign parser sign)
                              collect (operand (1+ precedence)))))
          (:none
           (prog1 (list operator line left (operand (1+ precedence)))
             (let ((next (next-infix-operator parser)))
               (when (and next (= (third next) precedence))
                 (syntax-problem parser (peek-token parser)
                                 "comparisons in a row must be connected, as in a=b & b=c"))))))))))

(defun parse-expression (parser least-precedence)
  "Return the node of what comes next, up to an operator looser than LEAST-PRECEDENCE."
  (when (> (incf (parser-depth parser)) +deepest-nesting+)
    (too-deep parser (peek-token parser)))
  (let ((left (parse-operand parser)))
    (loop for entry = (next-infix-operator parser)
          while (and entry (>= (third entry) least-precedence))
          do (setf left (parse-chain parser left entry)))
    (decf (parser-depth parser))
    left))

(defun check-depth (parser token node)
  "Check that NODE, which begins at TOKEN, is not too deep, as a long chain such as 1+1+1 is."
  (let ((open (list (cons node 1))))
    (loop while open
          do (destructuring-bind (node . depth) (pop open)
               (when (> depth +deepest-nesting+)
                 (too-deep parser token))
               (dolist (part (cddr node))
                 (when (consp part)
                   (push (cons part (1+ depth)) open)))))))

(defun parse-node (parser)
  "Return the node of the formula that comes next."
  (let* ((token (peek-token parser))
         (node (parse-expression parser 0)))
    (when (consp node)
      (check-depth parser token node))
    node))
