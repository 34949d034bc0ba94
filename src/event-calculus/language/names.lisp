;;;; Names and ground atoms.
;;;;
;;;; The names of a theory are compared by their characters, whatever package they were read in, so
;;;; that a theory can be used from any package: inside the layer they are keywords.  A ground atom
;;;; is a list of keywords, integers and such lists, (:robot-in :r1), never a concatenated string,
;;;; so that different atoms cannot be mistaken for each other.  In texts a name without lower-case
;;;; letters is printed in lower case; others stand between bars, as Lisp prints them.

(in-package #:discrepancy-finder.event-calculus)

;;; Tables

(defun term-hash (term)
  "Return a hash of all of TERM.  That of EQUAL tables looks at the first four elements of a list
only."
  (declare (optimize speed (safety 1)))
  (if (consp term)
      (let ((hash 17))
        (declare (type (unsigned-byte 62) hash))
        (loop while (consp term)
              do (setf hash (sb-int:mix hash (the (unsigned-byte 62) (term-hash (pop term))))))
        (sb-int:mix hash (sxhash term)))
      (sxhash term)))

(defun same-term-p (p q)
  (equal p q))

(sb-ext:define-hash-table-test same-term-p term-hash)

(defun make-term-table ()
  "Return a hash table whose keys are atoms, terms, formulas or lists of numbers."
  (make-hash-table :test 'same-term-p))

;;; Texts

(defun plain-name-p (string)
  (and (plusp (length string))
       (notany (lambda (character)
                 (or (lower-case-p character)
                     (find character "()|\\\"'`,;# ")
                     (not (graphic-char-p character))))
               string)))

(defun name-text (name)
  "Return the text for NAME, a symbol: in lower case if that can be read back."
  (let ((string (symbol-name name)))
    (cond
      (*exact-names* string)
      ((plain-name-p string) (string-downcase string))
      (t
       (with-output-to-string (stream)
         (write-char #\| stream)
         (loop for character across string
               do (when (find character "|\\") (write-char #\\ stream))
                  (write-char character stream))
         (write-char #\| stream))))))

(defun term-text (term)
  (etypecase term
    (integer (princ-to-string term))
    (symbol (name-text term))
    (cons (atom-text term))))

(defun atom-text (atom)
  "Return the text of the ground atom ATOM, a list of symbols, integers and such lists, such as
\"(robot-in r1)\"."
  (format nil "(~{~a~^ ~})" (mapcar #'term-text atom)))

(defun text-atom (text candidates)
  "Return the ground atom among the list CANDIDATES whose text is TEXT, or NIL."
  (find text candidates :key #'atom-text :test #'string=))

(defun atom-keywords (term)
  "Return TERM, an atom of symbols of any package, with keywords in their place."
  (typecase term
    (null nil)
    (symbol (name-keyword term))
    (cons (cons (atom-keywords (car term)) (atom-keywords (cdr term))))
    (t term)))

;;; Variables are symbols whose name begins with a question mark.  A variable's sort is its name
;;; without the question mark and trailing digits.

(defun variable-p (thing)
  (and (symbolp thing)
       (let ((name (symbol-name thing)))
         (and (> (length name) 1) (char= (char name 0) #\?)))))

(defun variable-sort-name (variable)
  (or (get variable 'sort-name)
      (setf (get variable 'sort-name)
            (name-keyword
             (make-symbol (string-right-trim "0123456789" (subseq (symbol-name variable) 1)))))))

(defun time-variable-p (thing)
  (and (variable-p thing) (eq (variable-sort-name thing) :time)))

(defun proper-list-p (thing)
  "Return true if THING is a list that ends with NIL."
  (loop with slow = thing
        for step from 0
        while (consp thing)
        do (setf thing (cdr thing))
           (when (oddp step) (setf slow (cdr slow)))
           (when (and (consp thing) (eq thing slow))
             (return nil))
        finally (return (null thing))))

(defun circular-list-p (thing)
  (and (consp thing)
       (handler-case (null (list-length thing))
         (type-error () nil))))

(defconstant +longest-text+ 1000
  "The number of atoms and lists that FORMULA-TEXT prints.")

(defun as-read-p (form)
  "Return true if FORM, a tree, has a symbol that is no keyword: it is as a user wrote it."
  (let ((budget +longest-text+))
    (labels ((look (form depth)
               (cond ((or (minusp (decf budget)) (> depth 100)) nil)
                     ((consp form) (or (look (car form) (1+ depth)) (look (cdr form) depth)))
                     (t (and form (symbolp form) (not (keywordp form)))))))
      (look form 0))))

(defun formula-text (form &optional (as-read (as-read-p form)))
  "Return the text of FORM, a tree of symbols and numbers, on one line.  In what is inside of a
theory all names are keywords, and are printed without a colon; AS-READ is true for what a user
wrote, whose keywords keep it."
  (let ((budget +longest-text+))
    (with-output-to-string (stream)
      (labels ((write-list (form depth)
                 (write-char #\( stream)
                 (when (circular-list-p form)
                   (setf form (list (car form) '|...|)))
                 (loop for first = t then nil
                       while (and (consp form) (plusp budget))
                       do (unless first (write-char #\Space stream))
                          (write-form (pop form) (1+ depth)))
                 (when form
                   (write-string " . " stream)
                   (write-form form (1+ depth)))
                 (write-char #\) stream))
               (write-form (form depth)
                 (cond ((or (minusp (decf budget)) (> depth 100)) (write-string "..." stream))
                       ((null form) (write-string "()" stream))
                       ((eq form '|...|) (write-string "... circular" stream))
                       ((symbolp form)
                        (when (and as-read (keywordp form)) (write-char #\: stream))
                        (write-string (name-text form) stream))
                       ((consp form) (write-list form depth))
                       (t (let ((*print-pretty* nil)) (format stream "~(~s~)" form))))))
        (write-form form 0)))))
