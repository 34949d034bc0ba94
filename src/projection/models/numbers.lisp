;;;; Numbers in the attributes of elements.
;;;;
;;;; A number is decimal, with an optional fraction and exponent, as in -1.5e-3.  It becomes the
;;;; double float nearest to it.  One that is too large for that is refused; one that is too small
;;;; is 0.

(in-package #:discrepancy-finder.projection)

(defun decimal-parts (text)
  "Return sign, digits and exponent of the decimal number TEXT: its value is sign * digits * 10 ^
exponent.  Return NIL if it is none."
  (let ((position 0) (digits 0) (count 0) (exponent 0) (sign 1))
    (labels ((peek () (and (< position (length text)) (char text position)))
             (accept (characters)
               (and (peek) (find (peek) characters) (prog1 (peek) (incf position))))
             (digits (function)
               (loop for digit = (and (peek) (char< (peek) #\:) (digit-char-p (peek)))
                     while digit
                     do (funcall function digit)
                        (incf position)))
             (digit (digit)
               (setf digits (+ (* 10 digits) digit))
               (incf count)))
      (when (eql (accept "+-") #\-) (setf sign -1))
      (digits #'digit)
      (when (accept ".")
        (digits (lambda (digit) (digit digit) (decf exponent))))
      (when (plusp count)
        (when (accept "eE")
          (let ((sign (if (eql (accept "+-") #\-) -1 1)) (value nil))
            ;; More digits than these make no difference.
            (digits (lambda (digit)
                      (setf value (min 1000000 (+ (* 10 (or value 0)) digit)))))
            (if value
                (incf exponent (* sign value))
                (return-from decimal-parts nil))))
        (and (= position (length text))
             (list sign digits exponent))))))

(defun number-in (text element)
  "Return the decimal number written in TEXT, an attribute of ELEMENT, as a double float."
  (destructuring-bind (sign digits exponent)
      (or (and (<= (length text) 1000) (decimal-parts text))
          (urdf-problem element "~s is no number" text))
    (let ((size (+ exponent (integer-length digits))))
      (cond ((zerop digits) 0d0)
            ((< size -3000) 0d0)
            ((> size 5000) (urdf-problem element "the number ~a is too large" text))
            (t (let ((value (* sign digits (expt 10 exponent))))
                 (cond ((> (abs value) (rational most-positive-double-float))
                        (urdf-problem element "the number ~a is too large" text))
                       ((< (abs value) (rational least-positive-normalized-double-float)) 0d0)
                       (t (float value 1d0)))))))))

(defun words (text)
  (remove "" (uiop:split-string text :separator '(#\Space #\Newline #\Tab #\Return))
          :test #'string=))

(defun numbers-in (text count element)
  "Return the list of the COUNT numbers written in TEXT, an attribute of ELEMENT."
  (let ((numbers (loop for word in (words text) collect (number-in word element))))
    (unless (= (length numbers) count)
      (urdf-problem element "~s does not hold ~d numbers" text count))
    numbers))

(defun number-attribute (element name &optional default)
  "Return the attribute NAME of ELEMENT, a number; without DEFAULT it must be there."
  (let ((text (if default (attribute element name) (required-attribute element name))))
    (if text
        (number-in (string-trim '(#\Space #\Newline #\Tab #\Return) text) element)
        default)))

(defun positive-attribute (element name)
  "Return the attribute NAME of ELEMENT, a length above 0."
  (positive (number-attribute element name) element))

(defun positive (number element)
  (cond ((not (plusp number)) (urdf-problem element "a size of ~a" number))
        ((> number 1d6) (urdf-problem element "a size of ~a, more than a million metres" number))
        (t number)))

(defun natural-attribute (element name)
  "Return the attribute NAME of ELEMENT, which is not below 0; 0 if it is absent."
  (let ((number (number-attribute element name 0d0)))
    (if (minusp number)
        (urdf-problem element "the ~a of <~a> is ~a, below 0" name (xml-element-name element)
                      number)
        number)))

(defun origin-of (element)
  "Return the pose that the <origin> of ELEMENT gives, the identity without one."
  (let ((origin (child element "origin")))
    (if origin
        (destructuring-bind ((x y z) (roll pitch yaw))
            (list (numbers-in (attribute origin "xyz" "0 0 0") 3 origin)
                  (numbers-in (attribute origin "rpy" "0 0 0") 3 origin))
          (dolist (number (list x y z roll pitch yaw))
            (when (> (abs number) 1d6)
              (urdf-problem origin "the number ~a in <origin> is too large" number)))
          (make-pose x y z :roll roll :pitch pitch :yaw yaw))
        (identity-pose))))
