;;;; Functions of characters, strings, symbols and numbers that change nothing: of a guarded choice
;;;; they are a guarded choice.

(in-package #:discrepancy-finder.symbolic-execution)

(defun chosen-values (function arguments description)
  "Return what FUNCTION, which changes nothing, returns for ARGUMENTS.  If it fails for one of the
objects that a symbolic argument may be the arguments are decided."
  (let ((arguments (mapcar #'current arguments)))
    (cond ((notany #'symbolic-value-p arguments) (apply (the function function) arguments))
          ((some #'symbolic-number-p arguments)
           (apply (the function function) (settled-each arguments description)))
          (t (let ((value (handler-case (apply-to-choices function arguments description)
                            (error () '%failed))))
               (if (eq value '%failed)
                   (apply (the function function) (settled-each arguments description))
                   value))))))

(macrolet ((define (&rest names)
             `(progn
                ,@(loop for name in names
                        collect `(define-lifted ,name (&rest arguments)
                                   (declare (dynamic-extent arguments))
                                   (if (some #'symbolic-value-p arguments)
                                       (chosen-values #',name (copy-list arguments)
                                                      ,(describe-decision name))
                                       (apply #',name arguments)))))))
  (define char= char/= char< char> char<= char>= char-equal char-not-equal char-lessp char-greaterp
    char-upcase char-downcase char-code code-char char-int char-name digit-char digit-char-p
    alpha-char-p alphanumericp upper-case-p lower-case-p both-case-p graphic-char-p
    string= string/= string< string> string<= string>= string-equal string-not-equal string-lessp
    string-greaterp symbol-name symbol-package string
    gcd lcm expt isqrt sqrt logand logior logxor lognot ash integer-length logbitp signum
    numerator denominator float rational))

;;; Of symbolic numbers

(define-lifted (rationalize) (number)
  (if (symbolic-number-p number)
      number
      (rationalize (settled number "an argument of rationalize"))))

(define-lifted realpart (number)
  (if (symbolic-number-p number) number (realpart (settled number "an argument of realpart"))))
