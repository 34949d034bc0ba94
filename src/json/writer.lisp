;;;; Writing JSON.
;;;;
;;;; ENCODE is the entry point.  Its text is a function of the value alone, the same with each JSON
;;;; library, so that texts can be hashed and compared: the libraries' own writers round doubles or
;;;; leave control characters as they are.  The text is ASCII: no stream's encoding can harm it.

(in-package #:discrepancy-finder.json)

(defun write-code-unit (code stream)
  (format stream "\\u~(~4,'0x~)" code))

(defun write-text (text stream)
  (write-char #\" stream)
  (loop for character across text
        for code = (char-code character)
        for letter = (cdr (assoc character '((#\" . #\") (#\\ . #\\) (#\Newline . #\n)
                                             (#\Return . #\r) (#\Tab . #\t)
                                             (#\Backspace . #\b) (#\Page . #\f))))
        do (cond (letter
                  (write-char #\\ stream)
                  (write-char letter stream))
                 ((<= 32 code 126)
                  (write-char character stream))
                 ((surrogate-p code)
                  (refuse nil "a string to be written contains a lone surrogate"))
                 ((< code #x10000)
                  (write-code-unit code stream))
                 (t
                  (multiple-value-bind (lead tail) (floor (- code #x10000) #x400)
                    (write-code-unit (+ #xd800 lead) stream)
                    (write-code-unit (+ #xdc00 tail) stream)))))
  (write-char #\" stream))

(defun write-double (number stream)
  ;; The Lisp printer prints the shortest digits that read back to the same bits, and, if double is
  ;; the default format, in the syntax of JSON.
  (when (or (sb-ext:float-infinity-p number) (sb-ext:float-nan-p number))
    (refuse nil "there is no JSON text for an infinity or a NaN"))
  (prin1 number stream))

(defun check-entries (value)
  "Return the list VALUE.  Signal JSON-ERROR unless it stands for an object."
  ;; LIST-LENGTH is NIL for a circular list and signals an error for a dotted one.
  (unless (and (ignore-errors (list-length value))
               (every (lambda (entry) (typep entry '(cons string))) value))
    (refuse nil "a list is not an object, which is a list of strings consed to values"))
  (check-keys value))

(defun scalar-p (value)
  (or (stringp value) (not (typep value '(or list vector)))))

(defun write-json (value stream pretty depth)
  "Write VALUE, which is nested DEPTH deep, on STREAM."
  (labels ((line (depth)
             (when pretty
               (terpri stream)
               (dotimes (i (* 2 depth)) (write-char #\Space stream))))
           (write-elements (elements opening closing one-line write-element)
             (when (>= depth +depth-limit+)
               (refuse nil "arrays and objects are nested deeper than ~d" +depth-limit+))
             (write-char opening stream)
             (let ((first t))
               (map nil (lambda (element)
                          (unless first
                            (write-string (if (and pretty one-line) ", " ",") stream))
                          (unless one-line (line (1+ depth)))
                          (funcall write-element element)
                          (setf first nil))
                    elements)
               (unless (or one-line first) (line depth)))
             (write-char closing stream))
           (write-entry (entry)
             (write-text (car entry) stream)
             (write-string (if pretty ": " ":") stream)
             (write-json (cdr entry) stream pretty (1+ depth))))
    (typecase value
      (string (write-text value stream))
      (vector (write-elements value #\[ #\] (every #'scalar-p value)
                              (lambda (element)
                                (write-json element stream pretty (1+ depth)))))
      (list (write-elements (check-entries value) #\{ #\} nil #'write-entry))
      (integer (princ value stream))
      (double-float (write-double value stream))
      ((member :true :false :null) (write-string (string-downcase value) stream))
      (t (refuse nil "there is no JSON text for ~a" (kind value))))))

(defun encode (value &key pretty)
  "Return the JSON text of VALUE as a string of ASCII characters without a line break at its end.
With PRETTY each entry of an object, and each element of an array that holds arrays or objects, has
a line of its own, indented by two spaces a level; without it the text is one line without spaces.
A double float gets the shortest digits that read back to the same bits.  An array may be any
vector.  Signal JSON-ERROR if VALUE contains what has no JSON text: a NaN, an infinity, a single
float, a ratio, a symbol, a lone surrogate; if a key occurs twice in an object, or if VALUE is
nested deeper than 512."
  (with-output-to-string (stream)
    (with-standard-io-syntax
      (let ((*print-readably* nil) (*read-default-float-format* 'double-float))
        (write-json value stream pretty 0)))))

(defun write-value (value stream &key pretty)
  "Write the text that ENCODE gives for VALUE and PRETTY on STREAM: all of it or, if JSON-ERROR is
signaled, nothing.  Return VALUE."
  (write-string (encode value :pretty pretty) stream)
  value)
