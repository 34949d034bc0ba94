;;;; Text in and out of Z3: UTF-8 with a final zero byte.
;;;;
;;;; A name may be any Lisp string.  So that different names stay different and can be read back,
;;;; the character of code 0 is written as the two bytes C0 80, which no other character gives, and
;;;; lone surrogates, which SBCL allows in strings, as three bytes like their neighbours.  The empty
;;;; string is written as the two bytes C1 80, since to Z3 the empty name is no name.

(in-package #:discrepancy-finder.z3)

(deftype octets () '(simple-array (unsigned-byte 8) (*)))

(declaim (inline octet-count))
(defun octet-count (code)
  (cond ((zerop code) 2) ((< code #x80) 1) ((< code #x800) 2) ((< code #x10000) 3) (t 4)))

(defun encode (text)
  "Return a fresh vector of the octets of the string TEXT and a zero."
  (let ((text (coerce text 'simple-string)) (size 1))
    (declare (fixnum size))
    (when (zerop (length text))
      (return-from encode (coerce '(#xC1 #x80 0) 'octets)))
    (macrolet ((with-string-type (&body body)
                 `(etypecase text
                    ((simple-array character (*)) ,@body)
                    (simple-string ,@body))))
      (with-string-type
        (loop for character across text do (incf size (octet-count (char-code character)))))
      (let ((octets (make-array size :element-type '(unsigned-byte 8) :initial-element 0))
            (position 0))
        (declare (fixnum position))
        (flet ((put (octet)
                 (setf (aref octets position) octet)
                 (incf position)))
          (declare (inline put))
          (with-string-type
            (loop for character across text
                  for code of-type (unsigned-byte 21) = (char-code character)
                  for count = (octet-count code)
                  do (if (= count 1)
                         (put code)
                         (loop initially (put (logior (ldb (byte 8 0) (ash #xF00 (- count)))
                                                      (ash code (* -6 (1- count)))))
                               for shift of-type (integer -12 12) from (* 6 (- count 2)) downto 0
                                 by 6
                               do (put (logior #x80 (ldb (byte 6 0) (ash code (- shift))))))))))
        octets))))

(defmacro with-encoded-text ((pointer text) &body body)
  "Evaluate BODY with POINTER bound to the address of the string TEXT as C has it."
  (let ((octets (gensym "OCTETS")))
    `(let ((,octets (encode ,text)))
       (sb-sys:with-pinned-objects (,octets)
         (let ((,pointer (sb-sys:vector-sap ,octets)))
           ,@body)))))

(defun decode (address)
  "Return the string whose octets stand at ADDRESS and end before a zero; \"\" at address 0."
  (if (zerop address)
      ""
      (let ((sap (sb-sys:int-sap address)) (position 0))
        (flet ((next ()
                 (prog1 (sb-sys:sap-ref-8 sap position) (incf position))))
          (with-output-to-string (text)
            (loop for octet = (next)
                  until (zerop octet)
                  do (let ((tail (cond ((< octet #xC0) 0) ((< octet #xE0) 1) ((< octet #xF0) 2)
                                       (t 3)))
                           (code octet))
                       (when (plusp tail)
                         (setf code (ldb (byte (- 6 tail) 0) octet))
                         (loop repeat tail
                               do (setf code (logior (ash code 6) (ldb (byte 6 0) (next))))))
                       (unless (= octet #xC1)
                         (write-char (code-char code) text)))))))))
