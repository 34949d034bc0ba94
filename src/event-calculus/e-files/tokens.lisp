;;;; The words of a .e file: names, integers and signs.
;;;;
;;;; A comment goes from a semicolon to the end of its line.  TOKENIZE turns a text into the
;;;; vector of its tokens.  A character that begins no token becomes a token of the kind :STRANGE,
;;;; which the parser refuses where it stands, because the rest of a line after LOAD or OPTION may
;;;; hold any character.  Lines end with line feed, carriage return, or both.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (token (:constructor make-token (kind text start line)) (:copier nil))
  "A word of a .e file: its characters, the offset and the line where it begins."
  (kind :end :type (member :name :integer :sign :strange :end) :read-only t)
  (text "" :type string :read-only t)
  (start 0 :type unsigned-byte :read-only t)
  (line 1 :type (integer 1) :read-only t))

(defmethod print-object ((token token) stream)
  (print-unreadable-object (token stream :type t)
    (format stream "~s in line ~d" (token-text token) (token-line token))))

(defparameter *signs*
  '("<->" "->" "!=" "<=" ">=" "(" ")" "[" "]" "{" "}" "," "." ":" "!" "&" "|" "=" "<" ">" "+" "-"
    "*" "/" "%")
  "The signs of the language, each before those that it begins with.")

(defun line-break-p (character)
  (or (char= character #\Newline) (char= character #\Return)))

(defun white-space-p (character)
  (or (line-break-p character)
      (find character '(#\Space #\Tab #\Page #\No-break_space #\Zero_width_no-break_space))))

(defun decimal-digit-p (character)
  (char<= #\0 character #\9))

(defun name-character-p (character)
  (or (alpha-char-p character) (decimal-digit-p character) (char= character #\_)))

(defun sign-at (text start)
  "Return the sign that stands in TEXT at START, or NIL."
  (find-if (lambda (sign)
             (let ((end (+ start (length sign))))
               (and (<= end (length text)) (string= sign text :start2 start :end2 end))))
           *signs*))

(defun token-at (text start line)
  "Return the token that begins in TEXT at START, which is not white space."
  (let ((first (char text start)))
    (flet ((run (kind predicate)
             (let ((end (or (position-if-not predicate text :start start) (length text))))
               (make-token kind (subseq text start end) start line))))
      (cond ((alpha-char-p first) (run :name #'name-character-p))
            ((decimal-digit-p first) (run :integer #'decimal-digit-p))
            ((sign-at text start) (make-token :sign (sign-at text start) start line))
            (t (make-token :strange (string first) start line))))))

(defun tokenize (text)
  "Return the vector of the tokens of TEXT; the last one is of the kind :END."
  (let ((tokens (make-array 100 :adjustable t :fill-pointer 0))
        (line 1)
        (offset 0))
    (loop while (< offset (length text))
          do (let ((character (char text offset)))
               (cond ((char= character #\;)
                      (setf offset (or (position-if #'line-break-p text :start offset)
                                       (length text))))
                     ((white-space-p character)
                      (incf offset)
                      (when (and (line-break-p character)
                                 (not (and (char= character #\Return) (< offset (length text))
                                           (char= (char text offset) #\Newline))))
                        (incf line)))
                     (t (let ((token (token-at text offset line)))
                          (vector-push-extend token tokens)
                          (incf offset (length (token-text token))))))))
    (vector-push-extend (make-token :end "" (length text) line) tokens)
    tokens))

(defun token-description (token)
  "Return TOKEN as it appears in the text of an error."
  (let ((text (token-text token)))
    (cond ((eq (token-kind token) :end) "the end of the file")
          ((> (length text) 60) (format nil "\"~a...\"" (subseq text 0 60)))
          ((every #'graphic-char-p text) (format nil "\"~a\"" text))
          (t (format nil "the character ~a" (char-name (char text 0)))))))

(defun token-of-p (token &rest signs)
  "Return true if TOKEN is one of SIGNS."
  (and (eq (token-kind token) :sign)
       (member (token-text token) signs :test #'string=)
       t))
