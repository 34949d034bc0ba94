;;;; Designators as text.
;;;;
;;;; PRINC writes a designator as the form that would make it, in lower case: (a motion (type
;;;; going)).  Traces and reports show it so.  PRIN1 writes #<A MOTION (TYPE GOING)>, on one line.

(in-package #:discrepancy-finder.designators)

(defgeneric description-text (value)
  (:documentation "Return the text of VALUE, a designator or a value in one, in lower case and on
one line.  Other layers add methods for their poses.")
  (:method (value) (princ-to-string value))
  (:method ((value symbol)) (string-downcase value))
  (:method ((value cons))
    (format nil "(~a)" (elements-text value)))
  (:method ((value pose))
    (format nil "~,3f ~,3f ~,3f" (pose-x value) (pose-y value) (pose-z value)))
  (:method ((designator designator))
    (format nil "(~a ~(~a~)~{ ~a~})"
            (article designator) (designator-class-keyword designator)
            (loop for (key . values) in (properties designator)
                  collect (format nil "(~(~a~)~{ ~a~})"
                                  key (mapcar #'description-text values))))))

(defun elements-text (elements)
  "Return the text of the elements of the list ELEMENTS, which may end in a dotted one."
  (format nil "~a~@[ ~a~]" (description-text (first elements))
          (cond ((null (rest elements)) nil)
                ((consp (rest elements)) (elements-text (rest elements)))
                (t (format nil ". ~a" (description-text (rest elements)))))))

(defun article (designator)
  (if (eq (quantifier designator) :a)
      (if (member (designator-class-keyword designator) '(:action :object)) "an" "a")
      (string-downcase (quantifier designator))))

(defun write-readably (value stream)
  "Write VALUE, a designator or a value in one, to STREAM in CRAM's way: names in upper case without
packages, strings in quotes."
  (typecase value
    (designator (write-char #\( stream)
                (write-inside value stream)
                (write-char #\) stream))
    (symbol (write-string (string-upcase value) stream))
    (cons (write-char #\( stream)
          (loop for (element . rest) on value
                do (write-readably element stream)
                   (when rest
                     (write-char #\Space stream)
                     (unless (consp rest)
                       (write-string ". " stream)
                       (write-readably rest stream))))
          (write-char #\) stream))
    ((or string character number) (prin1 value stream))
    (t (write-string (description-text value) stream))))

(defun write-inside (designator stream)
  (format stream "~a ~a" (quantifier designator) (designator-class-keyword designator))
  (dolist (property (properties designator))
    (write-char #\Space stream)
    (write-readably property stream)))

(defmethod print-object ((designator designator) stream)
  (let ((*print-pretty* nil) (*print-circle* nil))
    (cond ((not (slot-boundp designator 'description)) (call-next-method))
          (*print-escape*
           (write-string (with-output-to-string (text)
                           (write-string "#<" text)
                           (write-inside designator text)
                           (write-char #\> text))
                         stream))
          (t (write-string (description-text designator) stream)))))
