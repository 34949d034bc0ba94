(in-package #:discrepancy-finder.bullet)

(define-condition bullet-error (error)
  ((operation :initarg :operation :reader bullet-error-operation
              :documentation "The symbol that names the function that was called.")
   (reason :initarg :reason :reader bullet-error-reason
           :documentation "What was wrong with the call, as a string that names the thing."))
  (:report (lambda (condition stream)
             (format stream "~(~a~) failed: ~a." (bullet-error-operation condition)
                     (bullet-error-reason condition))))
  (:documentation "Signaled when a call makes no sense: a closed world, a malformed shape, a number
that is not finite, a body of another world.  The world is as it was before the call."))

(defun fail (operation control &rest arguments)
  "Signal a BULLET-ERROR of OPERATION with the reason that CONTROL and ARGUMENTS format."
  ;; What is wrong may be anything, a circular list or one of a million points.
  (let ((*print-circle* t) (*print-length* 40) (*print-level* 4) (*print-readably* nil))
    (error 'bullet-error :operation operation :reason (apply #'format nil control arguments))))

(defun check-length (sequence operation)
  "Signal that OPERATION got SEQUENCE if that is a list without an end."
  (when (and (listp sequence) (not (ignore-errors (list-length sequence))))
    (fail operation "~s is no proper list" sequence)))

(defun described (thing)
  "Return the string that THING is, or that it formats if it is a list of a control string and its
arguments: for what need be named only if it is wrong."
  (if (consp thing) (apply #'format nil thing) thing))
