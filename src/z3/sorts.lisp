;;;; Sorts: what terms stand for.
;;;;
;;;; There are truth values, integers, reals, and enumerations, whose elements are a few strings.  A
;;;; sort belongs to its context, which holds one reference to it; asking twice for a sort gives the
;;;; same object.  The constants of a sort are Lisp objects: T and NIL, integers, rationals, and the
;;;; names of elements.

(in-package #:discrepancy-finder.z3)

(deftype handles () '(simple-array (unsigned-byte 64) (*)))

(defun make-handles (count)
  (make-array count :element-type '(unsigned-byte 64) :initial-element 0))

(defstruct (sort (:constructor make-sort (context pointer kind name elements constructors))
                 (:copier nil))
  "A sort of Z3: made by BOOLEAN-SORT, INTEGER-SORT, REAL-SORT, ENUMERATION-SORT."
  (context nil :type context :read-only t)
  (pointer 0 :type (unsigned-byte 64) :read-only t)
  (kind :boolean :type (member :boolean :integer :real :enumeration) :read-only t)
  (name "" :type string :read-only t)
  ;; The names of an enumeration's elements and the addresses of their declarations.
  (elements '() :type list :read-only t)
  (constructors '() :type list :read-only t))

(setf (documentation 'sort-p 'function)
      "Return true if its argument is a SORT."
      (documentation 'sort-context 'function)
      "Return the context of a sort."
      (documentation 'sort-kind 'function)
      "Return what a sort is: :BOOLEAN, :INTEGER, :REAL or :ENUMERATION."
      (documentation 'sort-name 'function)
      "Return the name of a sort, a string; that of the first three kinds is SMT-LIB's."
      (documentation 'sort-elements 'function)
      "Return the list of the names, strings, of the elements of an enumeration; NIL for others.")

(defmethod print-object ((sort sort) stream)
  (print-unreadable-object (sort stream :type t)
    (format stream "~a~@[ of ~{~a~^, ~}~]" (sort-name sort) (sort-elements sort))))

;;; Sorts of truth values and numbers

(defun make-built-in-sort (context kind)
  (let ((address (calling-z3 (pointer context)
                   (let ((address (ecase kind
                                    (:boolean (z3-mk-bool-sort pointer))
                                    (:integer (z3-mk-int-sort pointer))
                                    (:real (z3-mk-real-sort pointer)))))
                     (z3-inc-ref pointer address)
                     address))))
    (make-sort context address kind
               (ecase kind (:boolean "Bool") (:integer "Int") (:real "Real"))
               '() '())))

(defun built-in-sort (context kind)
  (or (find kind (context-sorts context) :key #'sort-kind)
      (let ((sort (make-built-in-sort context kind)))
        (push sort (context-sorts context))
        sort)))

(declaim (inline boolean-sort))
(defun boolean-sort (context)
  "Return the sort of truth values in CONTEXT.  Its constants are T and NIL."
  (the sort (or (context-boolean context)
                (setf (context-boolean context) (make-built-in-sort context :boolean)))))

(defun integer-sort (context)
  "Return the sort of integers, of any size, in CONTEXT.  Its constants are Lisp's integers."
  (built-in-sort context :integer))

(defun real-sort (context)
  "Return the sort of real numbers in CONTEXT.  Its constants are Lisp's rationals."
  (built-in-sort context :real))

;;; Enumerations

(defun make-enumeration (context name elements)
  (let* ((count (length elements))
         (names (make-handles count)) (constructors (make-handles count))
         (testers (make-handles count)))
    (flet ((make-symbol-of (text)
             (with-encoded-text (octets text)
               (calling-z3 (pointer context)
                 (z3-mk-string-symbol pointer octets)))))
      (map-into names #'make-symbol-of elements)
      (let* ((symbol (make-symbol-of name))
             (address (calling-z3 (pointer context)
                        (sb-sys:with-pinned-objects (names constructors testers)
                          (let ((sort (z3-mk-enumeration-sort
                                       pointer symbol count (sb-sys:vector-sap names)
                                       (sb-sys:vector-sap constructors)
                                       (sb-sys:vector-sap testers))))
                            (unless (zerop sort)
                              (z3-inc-ref pointer sort)
                              (loop for constructor across constructors
                                    do (z3-inc-ref pointer constructor)))
                            sort)))))
        (make-sort context address :enumeration name elements (coerce constructors 'list))))))

(defun enumeration-sort (context name &optional (elements '() elements-p))
  "Return the sort of CONTEXT named by the string NAME, whose constants are the strings in the list
ELEMENTS, different ones and at least one.  Without ELEMENTS the sort must have been made before.
Signals Z3-ERROR, e.g. if NAME has other elements."
  (check-type name string)
  (let ((known (find-if (lambda (sort)
                          (and (eq (sort-kind sort) :enumeration) (string= (sort-name sort) name)))
                        (context-sorts context))))
    (cond ((and known (or (not elements-p) (equal elements (sort-elements known)))) known)
          (known (misuse :invalid-argument "the sort ~s has the elements ~{~s~^, ~} already"
                         name (sort-elements known)))
          ((null elements) (misuse :invalid-argument "the sort ~s needs an element" name))
          ((notevery #'stringp elements)
           (misuse :invalid-argument "the element ~s of ~s is no string"
                   (find-if-not #'stringp elements) name))
          ((/= (length elements) (length (remove-duplicates elements :test #'string=)))
           (misuse :invalid-argument "the sort ~s has an element twice" name))
          (t (let ((sort (make-enumeration context (copy-seq name)
                                           (mapcar #'copy-seq elements))))
               (push sort (context-sorts context))
               sort)))))

;;; Constants

(defun fits-p (constant sort)
  "Return true if the Lisp object CONSTANT is a constant of SORT."
  (ecase (sort-kind sort)
    (:boolean (typep constant 'boolean))
    (:integer (integerp constant))
    (:real (rationalp constant))
    (:enumeration (and (stringp constant)
                       (member constant (sort-elements sort) :test #'string=)
                       t))))

(defun kind-text (kind)
  "Return KIND, of a sort or of several, in words."
  (ecase kind
    (:boolean "a truth value")
    (:integer "an integer")
    (:real "a real")
    (:enumeration "an element of an enumeration")
    (:number "a number")))

(defun sort-text (sort)
  "Return what a term of SORT is, in words."
  (if (eq (sort-kind sort) :enumeration)
      (format nil "an element of ~s" (sort-name sort))
      (kind-text (sort-kind sort))))
