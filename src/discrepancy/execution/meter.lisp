;;;; Metering: how many simulations a piece of work made, and how long they took.
;;;;
;;;; A search wants to know what its phases cost, also those in which other parts of the system run
;;;; simulations of their own.  Within WITH-METER the execution of samples adds to a METER; a sample
;;;; that is not valid costs time, but is no simulation.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (meter (:copier nil))
  "The number of SIMULATIONS and the SECONDS that the simulator took."
  (simulations 0 :type (integer 0))
  (seconds 0d0 :type double-float))

(setf (documentation 'make-meter 'function)
      "Return a new meter, for WITH-METER."
      (documentation 'meter-simulations 'function)
      "Return the number of simulations that a meter has counted.")

(defvar *meter* nil
  "The METER that counts simulations, or NIL.")

(defmacro with-meter ((meter) &body body)
  "Evaluate BODY and let METER count its simulations, but for those that another meter counts."
  `(let ((*meter* ,meter)) ,@body))

(defun count-simulation ()
  (when *meter*
    (incf (meter-simulations *meter*))))

(defun call-timed (function)
  "Return what FUNCTION returns; the time it takes is the simulator's."
  (let ((start (foreign:monotonic-seconds)))
    (unwind-protect (funcall function)
      (when *meter*
        (incf (meter-seconds *meter*) (- (foreign:monotonic-seconds) start))))))
