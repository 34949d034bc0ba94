;;;; Operators on fluents: networks.
;;;;
;;;; (fl< a 3) is a fluent if one of its arguments is one, and else the plain truth value.  The
;;;; operators of CL that have a meaning for fluents exist under their CL names, too: package
;;;; DISCREPANCY-FINDER.CPL exports them instead of CL's, as CRAM's package CPL does.

(in-package #:discrepancy-finder.plan-language)

(defun make-net (name function arguments)
  (make-instance 'fluent-net :name name :function function :arguments arguments))

(defun fl-apply (function &rest arguments)
  "Apply FUNCTION to ARGUMENTS, of which the last is a list.  With fluents among them return a
fluent of the result, else the result."
  (let ((arguments (apply #'list* arguments)))
    (if (some #'fluentp arguments)
        (make-net (if (symbolp function) function nil) function arguments)
        (apply function arguments))))

(defun fl-funcall (function &rest arguments)
  "Call FUNCTION with ARGUMENTS.  With fluents among them return a fluent of the result, else the
result."
  (fl-apply function arguments))

(defmacro define-fluent-operators (&rest operators)
  "Define functions on fluents; an operator is (name (shadowing-name) function)."
  `(progn
     ,@(loop for (name shadowing function) in operators
             for documentation = (format nil "Return (~(~a~) ARGUMENTS), or a fluent of it if a ~
                                              fluent is among ARGUMENTS."
                                         function)
             append (loop for symbol in (cons name shadowing)
                          collect `(defun ,symbol (&rest arguments)
                                     ,documentation
                                     (declare (dynamic-extent arguments))
                                     (if (some #'fluentp arguments)
                                         (make-net ',function ',function (copy-list arguments))
                                         (apply #',function arguments)))))))

(define-fluent-operators
  (fl< (discrepancy-finder.cpl:<) <)
  (fl> (discrepancy-finder.cpl:>) >)
  (fl= (discrepancy-finder.cpl:=) =)
  (fl+ (discrepancy-finder.cpl:+) +)
  (fl- (discrepancy-finder.cpl:-) -)
  (fl* (discrepancy-finder.cpl:*) *)
  (fl/ (discrepancy-finder.cpl:/) /)
  (fl-eq (discrepancy-finder.cpl:eq) eq)
  (fl-eql (discrepancy-finder.cpl:eql) eql)
  (fl-not (discrepancy-finder.cpl:not) not))

(defun all-true (&rest values)
  (loop for (value . more) on values
        unless value return nil
        unless more return value
        finally (return t)))

(defun one-true (&rest values)
  (some #'identity values))

(defun fl-and (&rest arguments)
  "Return the last of ARGUMENTS if the values of all are true, else NIL; or a fluent of that.  A
function: all arguments are evaluated."
  (if (some #'fluentp arguments)
      (make-net 'and #'all-true arguments)
      (apply #'all-true arguments)))

(defun fl-or (&rest arguments)
  "Return the first true value of ARGUMENTS, or NIL; or a fluent of that.  A function: all arguments
are evaluated."
  (if (some #'fluentp arguments)
      (make-net 'or #'one-true arguments)
      (apply #'one-true arguments)))

(defun fl-pulsed (fluent &key (handle-missed-pulses :once))
  "The same as PULSED."
  (pulsed fluent :handle-missed-pulses handle-missed-pulses))

(defun fl-value-changed (fluent &key (test #'eql) (key #'identity))
  "Return a fluent that is true when what the function KEY makes of the value of FLUENT is another
one, by the function TEST, than when a task last waited for it."
  (make-instance 'changed-fluent :name (fluent-name fluent) :origin fluent :key key :test test
                                 :last (funcall key (value fluent))))

;;; The symbols of package CPL also stand where those of CL do: as the REPL's variables and in
;;; types.

(define-symbol-macro discrepancy-finder.cpl:* *)
(define-symbol-macro discrepancy-finder.cpl:+ +)
(define-symbol-macro discrepancy-finder.cpl:- -)
(define-symbol-macro discrepancy-finder.cpl:/ /)

(deftype discrepancy-finder.cpl:not (type)
  "The same as the type specifier CL:NOT."
  `(not ,type))

(deftype discrepancy-finder.cpl:eql (object)
  "The same as the type specifier CL:EQL."
  `(eql ,object))
