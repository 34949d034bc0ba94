(in-package #:discrepancy-finder.z3)

(defun one-line (text)
  "Return TEXT, in Z3's words, with its lines joined."
  (substitute #\Space #\Newline (string-right-trim '(#\Newline) text)))

(define-condition z3-error (error)
  ((code :initarg :code :reader z3-error-code
         :documentation "A keyword.  Z3's own: :sort-error :index-out-of-bounds :invalid-argument
:parser-error :no-parser :invalid-pattern :out-of-memory :file-access-error :internal-fatal
:invalid-usage :reference-error :exception.  Of this layer: :closed-context :busy-context
:closed-solver :other-context :released-term :no-model :no-core :closed-clause-set
:division-by-zero :missing-function.")
   (message :initarg :message :reader z3-error-message
            :documentation "A string: what went wrong, in Z3's words or in ours."))
  (:report (lambda (condition stream)
             (format stream "Z3: ~a."
                     (string-right-trim "." (one-line (z3-error-message condition))))))
  (:documentation "Signaled when Z3 refuses a call, and when a context, a term or a solver is used
in a way that Z3 would answer with a crash."))

(define-condition solver-unknown (error)
  ((solver :initarg :solver :reader solver-unknown-solver
           :documentation "The solver that was asked.")
   (reason :initarg :reason :reader solver-unknown-reason
           :documentation "Z3's reason, as a string, e.g. \"timeout\"."))
  (:report (lambda (condition stream)
             (format stream "The solver cannot tell whether its assertions are satisfiable (~a)."
                     (one-line (solver-unknown-reason condition)))))
  (:documentation "Signaled by CHECK when Z3 answers `unknown', which is never read as unsat.
Restarts: RETRY-WITH-TIMEOUT (one argument, seconds) and TREAT-AS-SAT (no argument)."))

(defun misuse (code message &rest arguments)
  "Signal a Z3-ERROR of CODE; MESSAGE is a format control for ARGUMENTS."
  (error 'z3-error :code code :message (apply #'format nil message arguments)))
