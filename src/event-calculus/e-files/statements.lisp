;;;; The statements of a .e file.
;;;;
;;;; READ-STATEMENTS returns a text as a list of statements, whose names are still strings and
;;;; mean nothing yet.  A declaration ends with its line, unless a comma stands there, a formula
;;;; at its full stop.  A word such as "range" is a keyword only where a statement begins and a
;;;; name follows.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (statement (:constructor make-statement (kind data file line)) (:copier nil))
  "What a .e file says at a line.  KIND and DATA are one of
  :load (path)                  :option (key value)          :ignore (name)
  :sort (name parent reified)   :range (sort low high)       :integer (sort integer)
  :constant (sort name again)   :symbol (sort name (argument-sort*) value-sort)
  :noninertial (name)           :manualrelease (name)        :completion (label name)
  :mutex (name*)                :xor (name*)                 :formula (label node)
where the sort of a :SYMBOL may be \"predicate\", \"function\", \"fluent\" or \"event\"."
  (kind nil :type keyword :read-only t)
  (data '() :type list :read-only t)
  (file "" :type string :read-only t)
  (line 1 :type (integer 1) :read-only t))

(defmethod print-object ((statement statement) stream)
  (print-unreadable-object (statement stream)
    (format stream "~a:~d ~(~a~)" (statement-file statement) (statement-line statement)
            (statement-kind statement))))

(defun statement-here (parser token kind &rest data)
  (make-statement kind data (parser-file parser) (token-line token)))

(defun end-declaration (parser)
  "Check that the line ends after a declaration; a full stop is allowed."
  (accept-sign parser ".")
  (let ((next (peek-token parser)))
    (unless (or (eq (token-kind next) :end)
                (> (token-line next) (token-line (previous-token parser))))
      (expect parser "the end of the line"))))

(defun rest-of-line (parser)
  "Return what stands before the end of the line or a comment, and skip it."
  (let* ((text (parser-text parser))
         (first (peek-token parser))
         (line (token-line (previous-token parser))))
    (if (or (eq (token-kind first) :end) (> (token-line first) line))
        ""
        (let ((end (or (position-if (lambda (character)
                                      (or (line-break-p character) (char= character #\;)))
                                    text :start (token-start first))
                       (length text))))
          (loop until (>= (token-start (peek-token parser)) end)
                do (next-token parser))
          (string-right-trim '(#\Space #\Tab) (subseq text (token-start first) end))))))

;;; Declarations

(defun parse-sorts (parser reified)
  "A parent after a colon is that of all names since the last one with a parent."
  (let ((pending '())
        (statements '()))
    (flet ((finish (parent)
             (dolist (token (nreverse pending))
               (push (statement-here parser token :sort (token-text token) parent reified)
                     statements))
             (setf pending '())))
      (comma-separated
       parser (lambda ()
                (push (next-name parser "the name of a sort") pending)
                (when (accept-sign parser ":")
                  (finish (token-text (next-name parser "the name of a sort"))))))
      (finish nil))
    (nreverse statements)))

(defun parse-argument-sorts (parser)
  "Return the list of the names in parentheses, if any."
  (let ((opening (accept-sign parser "(")))
    (when (and opening (not (accept-sign parser ")")))
      (prog1 (comma-separated
              parser (lambda () (token-text (next-name parser "the name of a sort"))))
        (close-sign parser ")" opening)))))

(defun parse-symbols (parser kind)
  "Return the statements for the predicates, functions, fluents or events that come next."
  (comma-separated
   parser (lambda ()
            (let ((name (next-name parser (format nil "the name of ~a ~a"
                                                  (if (string= kind "event") "an" "a") kind))))
              (statement-here parser name :symbol kind (token-text name)
                              (parse-argument-sorts parser)
                              (when (string= kind "function")
                                (unless (accept-sign parser ":")
                                  (expect parser "\":\" and the sort of the function's values"))
                                (token-text (next-name parser "the name of a sort"))))))))

(defun signed-integer (parser)
  (let ((minus (accept-sign parser "-")))
    (unless (eq (token-kind (peek-token parser)) :integer)
      (expect parser "an integer"))
    (let ((value (integer-value parser (next-token parser))))
      (if minus (- value) value))))

(defun parse-elements (parser sort)
  "Return the statements for the constants, integers and term symbols that are declared of SORT."
  (let ((again (and (accept-sign parser "!") t)))
    (comma-separated
     parser (lambda ()
              (let ((token (peek-token parser)))
                (cond ((not (eq (token-kind token) :name))
                       (statement-here parser token :integer sort (signed-integer parser)))
                      ((token-of-p (peek-token parser 1) "(")
                       (next-token parser)
                       (statement-here parser token :symbol sort (token-text token)
                                       (parse-argument-sorts parser) nil))
                      (t
                       (next-token parser)
                       (statement-here parser token :constant sort (token-text token) again))))))))

(defun parse-range (parser token)
  (let* ((sort (token-text (next-name parser "the name of a sort")))
         (low (signed-integer parser))
         (high (signed-integer parser)))
    (when (> low high)
      (syntax-problem parser token "the range of ~a is empty: ~d is greater than ~d" sort low high))
    (list (statement-here parser token :range sort low high))))

(defun parse-completions (parser)
  (comma-separated
   parser (lambda ()
            (let ((first (next-name parser "a label or a predicate"))
                  (second (peek-token parser)))
              (if (and (eq (token-kind second) :name) (= (token-line second) (token-line first)))
                  (statement-here parser first :completion (token-text first)
                                  (token-text (next-token parser)))
                  (statement-here parser first :completion nil (token-text first)))))))

(defun parse-names (parser kind)
  "Return a statement of KIND for each of the names that come next."
  (comma-separated
   parser (lambda ()
            (let ((name (next-name parser "a name")))
              (statement-here parser name kind (token-text name))))))

(defun parse-exclusion (parser token kind)
  (list (apply #'statement-here parser token kind
               (comma-separated
                parser (lambda () (token-text (next-name parser "a name")))))))

;;; Statements

(defun keyword-token-p (parser token)
  "Return true if TOKEN, which is next in PARSER, is a keyword: if it is followed by its object."
  (let ((next (peek-token parser 1))
        (text (token-text token)))
    (cond ((or (string= text "load") (string= text "option"))
           ;; Alone in its line it is a keyword whose object was forgotten.
           (or (member (token-kind next) '(:name :strange :end))
               (> (token-line next) (token-line token))
               (token-of-p next "/" ".")))
          ((string= text "reified") (string= (token-text next) "sort"))
          ((member text '("sort" "predicate" "function" "fluent" "event" "range" "noninertial"
                          "manualrelease" "completion" "mutex" "xor" "ignore")
                   :test #'string=)
           (eq (token-kind next) :name)))))

(defun parse-directive (parser token)
  "Return the statements that begin with TOKEN, a keyword."
  (next-token parser)
  (let ((keyword (token-text token)))
    (flet ((keyword-p (&rest names) (member keyword names :test #'string=)))
      (cond ((keyword-p "load")
             (let ((path (rest-of-line parser)))
               (when (string= path "")
                 (syntax-problem parser token "the name of a file was expected after \"load\""))
               (list (statement-here parser token :load path))))
            ((keyword-p "option")
             (let ((key (rest-of-line parser)))
               (list (apply #'statement-here parser token :option
                            (option-words parser token key)))))
            ((keyword-p "sort") (parse-sorts parser nil))
            ((keyword-p "reified")
             (next-token parser)
             (parse-sorts parser t))
            ((keyword-p "predicate" "function" "fluent" "event") (parse-symbols parser keyword))
            ((keyword-p "range") (parse-range parser token))
            ((keyword-p "completion") (parse-completions parser))
            ((keyword-p "mutex") (parse-exclusion parser token :mutex))
            ((keyword-p "xor") (parse-exclusion parser token :xor))
            ((keyword-p "noninertial") (parse-names parser :noninertial))
            ((keyword-p "manualrelease") (parse-names parser :manualrelease))
            (t (parse-names parser :ignore))))))

(defun option-words (parser token text)
  "Return the option's name and its value, which may be empty, from TEXT."
  (let ((end (or (position-if #'white-space-p text) (length text))))
    (when (zerop end)
      (syntax-problem parser token "the name of an option was expected after \"option\""))
    (list (subseq text 0 end) (string-trim '(#\Space #\Tab) (subseq text end)))))

(defun parse-formula-statement (parser token)
  "Return the statement of the formula that comes next, at TOKEN, with its label."
  (let ((label (when (and (eq (token-kind token) :name) (token-of-p (peek-token parser 1) ":"))
                 (next-token parser)
                 (next-token parser)
                 (token-text token))))
    (let ((node (parse-node parser)))
      (unless (accept-sign parser ".")
        (syntax-problem parser (previous-token parser)
                        "\".\" was expected after the formula of line ~d, but ~a was found"
                        (token-line token) (token-description (peek-token parser))))
      (list (statement-here parser token :formula label node)))))

(defun parse-statement (parser)
  "Return the list of the statements that the next one in PARSER stands for."
  (let ((token (peek-token parser))
        (next (peek-token parser 1)))
    (flet ((declaration (statements)
             (end-declaration parser)
             statements))
      (cond ((not (eq (token-kind token) :name)) (parse-formula-statement parser token))
            ((keyword-token-p parser token) (declaration (parse-directive parser token)))
            ((or (member (token-kind next) '(:name :integer))
                 (and (token-of-p next "!") (eq (token-kind (peek-token parser 2)) :name)))
             (next-token parser)
             (declaration (parse-elements parser (token-text token))))
            (t (parse-formula-statement parser token))))))

(defun read-statements (text file)
  "Return the list of the statements in TEXT; FILE names it in errors.  Signals E-FILE-ERROR."
  (let ((parser (make-parser file text (tokenize text))))
    (loop until (eq (token-kind (peek-token parser)) :end)
          append (parse-statement parser))))
