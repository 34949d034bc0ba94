;;;; JSON values, and reading them.
;;;;
;;;; How JSON stands for Lisp objects:
;;;;
;;;;   {"a": 1}   list of conses (string . value), in the order of the text; {} is NIL
;;;;   [1, 2]     simple vector; [] is #()
;;;;   "text"     simple string
;;;;   1   1.0    integer, double float; a number with a point or an exponent is a double float
;;;;   true false null    :true :false :null
;;;;
;;;; PARSE is the entry point.  This file alone knows which library does the work: cl-json if it was
;;;; loaded when the file was compiled, else yason; the system definition sees to one of them.
;;;; The library gets only what CHECK-SYNTAX has accepted and turns it into Lisp objects.

(in-package #:discrepancy-finder.json)

(eval-when (:compile-toplevel :load-toplevel :execute)
  (defparameter *cl-json*
    (if (and (find-package "JSON") (find-symbol "BIND-CUSTOM-VARS" "JSON")) '(:and) '(:or))
    "The feature expression that is true if the library is cl-json."))

(defun library-name ()
  "Return the name of the JSON library that was compiled in: \"yason\" or \"cl-json\"."
  #+#.discrepancy-finder.json::*cl-json* "cl-json"
  #-#.discrepancy-finder.json::*cl-json* "yason")

;;; What both libraries share

(defun finish-number (number)
  ;; Where float traps are masked the reader makes an infinity of 1e999, and no error.
  (if (and (floatp number) (sb-ext:float-infinity-p number))
      (refuse nil "a number is beyond the range of a double float")
      number))

(defun check-keys (object)
  "Return OBJECT, a list of conses.  Signal JSON-ERROR if two keys are equal."
  (let ((seen (make-hash-table :test #'equal)))
    (loop for (key) in object
          do (when (gethash key seen)
               (refuse nil "the key ~s occurs twice in an object" key))
             (setf (gethash key seen) t))
    object))

;;; yason: as it is, it reads single floats and makes NIL of null, false and [].

#-#.discrepancy-finder.json::*cl-json*
(defun convert (value)
  "Return the JSON value for VALUE, which yason made."
  (etypecase value
    (number (finish-number value))
    (string (coerce value 'simple-string))
    (vector (map 'simple-vector #'convert value))
    (list (check-keys (loop for (key . element) in (reverse value)
                            collect (cons (coerce key 'simple-string) (convert element)))))
    ((eql yason:true) :true)
    ((eql yason:false) :false)
    ((eql :null) :null)))

#-#.discrepancy-finder.json::*cl-json*
(defun library-parse (text)
  (convert (yason:parse text :object-as :alist :json-arrays-as-vectors t
                             :json-booleans-as-symbols t :json-nulls-as-keyword t)))

;;; cl-json: its handlers fill a stack of our own, one list for each array, object or string that is
;;; not yet closed, so that neither its defaults nor a user's settings matter.

#+#.discrepancy-finder.json::*cl-json*
(defun join-surrogates (characters)
  "Return the string of the list CHARACTERS, in which a character may be a pair of surrogates."
  (coerce (loop while characters
                for code = (char-code (pop characters))
                collect (if (lead-surrogate-p code)
                            (code-char (+ #x10000 (ash (- code #xd800) 10)
                                          (- (char-code (pop characters)) #xdc00)))
                            (code-char code)))
          'simple-string))

#+#.discrepancy-finder.json::*cl-json*
(defun library-parse (text)
  (let ((open '()))
    (flet ((begin () (push '() open))
           (add (element) (push element (first open)))
           (finish () (nreverse (pop open)))
           (number-value (token) (finish-number (read-from-string token))))
      (json:bind-custom-vars
          (:integer #'number-value
           :real #'number-value
           :boolean (lambda (token)
                      (cond ((string= token "true") :true)
                            ((string= token "false") :false)
                            (t :null)))
           :beginning-of-array #'begin
           :array-member #'add
           :end-of-array (lambda () (coerce (finish) 'simple-vector))
           :beginning-of-object #'begin
           :object-key #'add
           :object-value #'add
           :end-of-object (lambda ()
                            (check-keys (loop for (key element) on (finish) by #'cddr
                                              collect (cons key element))))
           :beginning-of-string #'begin
           :string-char #'add
           :end-of-string (lambda () (join-surrogates (finish)))
           :internal-decoder #'json:decode-json)
        (json:decode-json-from-string text)))))

;;; Reading

(defun parse (text)
  "Return the JSON value that the string TEXT holds; the header of this file says which Lisp object
stands for which JSON.  A number too close to zero for a double float is read as zero.
Signal JSON-ERROR if TEXT is not exactly one JSON value by RFC 8259, if a key occurs twice in an
object, if a number is beyond the range of a double float or longer than 2000 characters, or if
arrays and objects are nested deeper than 512."
  (check-syntax text)
  (with-standard-io-syntax
    (let ((*read-eval* nil) (*print-readably* nil) (*read-default-float-format* 'double-float))
      (handler-case (library-parse text)
        (reader-error ()
          (refuse nil "a number is beyond the range of a double float"))))))

;;; Objects

(defun object (&rest keys-and-values)
  "Return the JSON object with KEYS-AND-VALUES, alternating strings and JSON values, in this order.
Signal JSON-ERROR if two keys are equal."
  (check-keys (loop for (key value) on keys-and-values by #'cddr
                    collect (cons key value))))

(defun get-key (object key &optional (default nil default-p))
  "Return the value of the string KEY in the JSON object OBJECT.  Without the key return DEFAULT if
it is given, else signal JSON-ERROR, which names KEY; also if OBJECT is not a JSON object."
  (unless (listp object)
    (refuse nil "the key ~s is sought in ~a, which is not an object" key (kind object)))
  (let ((entry (assoc key object :test #'string=)))
    (cond (entry (cdr entry))
          (default-p default)
          (t (refuse nil "the key ~s is missing" key)))))

(defun kind (value)
  "Return a phrase for people that says what the JSON value VALUE is."
  (typecase value
    (list "an object")
    (string "a string")
    (vector "an array")
    (single-float "a single float")
    (ratio "a ratio")
    (number "a number")
    ((member :true :false :null) (string-downcase value))
    (t (format nil "an object of type ~(~a~)" (type-of value)))))
