;;;; Output of symbolic values: their texts.
;;;;
;;;; What goes to a stream for people to read shows #<symbolic ...>.  What becomes a string that the
;;;; plan can look at (FORMAT to NIL, output to a string stream) is another matter: there the values
;;;; are decided.  So they are where a directive of FORMAT looks at them.

(in-package #:discrepancy-finder.symbolic-execution)

(defvar *plan-output* nil
  "The stream to which the plan's standard output goes, if that is kept for the user.")

(defun kept-output-p (stream)
  "Return true if what is written to STREAM, as the output functions have it, can be read by the
plan."
  (let ((stream (case stream
                  ((nil) *standard-output*)
                  ((t) *terminal-io*)
                  (t stream))))
    (typecase stream
      (synonym-stream (kept-output-p (symbol-value (synonym-stream-symbol stream))))
      (two-way-stream (kept-output-p (two-way-stream-output-stream stream)))
      (broadcast-stream (some #'kept-output-p (broadcast-stream-streams stream)))
      (t (not (eq stream *plan-output*))))))

(macrolet ((define (&rest names)
             `(progn
                ,@(loop for name in names
                        collect `(define-lifted ,name (any-value &optional stream)
                                   (,name (if (and (symbolic-run-p) (kept-output-p stream))
                                              (decided any-value ,(describe-decision name))
                                              any-value)
                                          stream))))))
  (define princ prin1 print pprint))

(define-lifted (write) (any-value &rest keywords)
  (apply #'write
         (if (and (symbolic-run-p) (kept-output-p (getf keywords :stream)))
             (decided any-value "an argument of write")
             any-value)
         (settled-each keywords "an argument of write")))

(defun plain-directives-p (control)
  "Return true if the format CONTROL only prints its arguments, whatever they are."
  (and (stringp control)
       (loop with index = 0
             for tilde = (position #\~ control :start index)
             while tilde
             do (setf index (position-if-not (lambda (character)
                                               (or (digit-char-p character)
                                                   (find character ",:@+-")))
                                             control :start (1+ tilde)))
             always (and index (find (char-downcase (char control index)) "asw%&~d
"))
             do (incf index))))

(define-lifted (format) (stream control &rest arguments)
  (let ((control (settled control "an argument of format"))
        (stream (settled stream "an argument of format")))
    (apply #'format stream control
           (if (and (symbolic-run-p)
                    (or (null stream) (stringp stream)
                        (not (plain-directives-p control))
                        (kept-output-p (if (eq stream t) nil stream))))
               (loop for argument in arguments
                     collect (decided argument "an argument of format"))
               arguments))))
