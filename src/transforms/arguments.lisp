;;;; What all types of this layer share: checking what they are made of, and printing.

(in-package #:discrepancy-finder.transforms)

(defun unsuitable (value role expected)
  (error 'unsuitable-value :value value :role role :expected expected))

(defun finite-float-p (value)
  (not (or (sb-ext:float-infinity-p value) (sb-ext:float-nan-p value))))

(defun finite-double (value role)
  "Return the real VALUE as a double float, a single float by the decimal that it prints as.
Signals UNSUITABLE-VALUE, with the string ROLE, if it is no finite real number."
  (if (typecase value
        (float (finite-float-p value))
        (rational (<= (abs value) (rational most-positive-double-float))))
      (geometry:decimal-double value)
      (unsuitable value role "a finite real number")))

(defun ensure-kind (value class role)
  "Return VALUE if it is an instance of CLASS; else signal UNSUITABLE-VALUE."
  (if (typep value class)
      value
      (unsuitable value role (format nil "a ~(~a~)" class))))

(defmacro define-component (name kinds documentation)
  "Define the generic function NAME that reads a part of instances.  For anything else it signals
UNSUITABLE-VALUE; KINDS, a string, says what it reads."
  `(defgeneric ,name (thing)
     (:documentation ,documentation)
     (:method (thing)
       (unsuitable thing ,(format nil "what ~(~a~) is asked of" name) ,kinds))))

(defun print-value (thing stream &rest parts)
  "Print THING unreadably by the name of its class and the PARTS, with ~a.
Where the printer is pretty each part has a line of its own, as CRAM users know it; where not, as in
reports of conditions, all is one line."
  (print-unreadable-object (thing stream)
    (write-string (symbol-name (class-name (class-of thing))) stream)
    (dolist (part parts)
      (if *print-pretty*
          (format stream "~%   ~a" part)
          (format stream " ~a" part)))))
