;;;; Metering: how many simulations a piece of work made, and how long they and Z3 took.
;;;;
;;;; A search wants to know what its phases cost, also those in which other parts of the system run
;;;; simulations and solvers of their own.  Within WITH-METER the execution of samples and the
;;;; checks of Z3, in whatever context of this thread, add to a METER; a sample that is not valid
;;;; costs time, but is no simulation.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (meter (:copier nil))
  "The number of SIMULATIONS, the SECONDS that the simulator took, and the SOLVER-SECONDS spent
inside of Z3's checks."
  (simulations 0 :type (integer 0))
  (seconds 0d0 :type double-float)
  (solver-seconds 0d0 :type double-float))

(setf (documentation 'make-meter 'function)
      "Return a new meter, for WITH-METER."
      (documentation 'meter-simulations 'function)
      "Return the number of simulations that a meter has counted.")

(defvar *meter* nil
  "The METER that counts simulations, or NIL.")

(defmacro with-meter ((meter) &body body)
  "Evaluate BODY and let METER count its simulations and the time of its checks, but for what
another meter counts."
  `(let ((*meter* ,meter) (z3:*on-check* #'count-check))
     ,@body))

(defun count-simulation ()
  (when *meter*
    (incf (meter-simulations *meter*))))

(defun count-check (seconds)
  (incf (meter-solver-seconds *meter*) seconds))

(defun call-timed (function)
  "Return what FUNCTION returns; the time it takes is the simulator's."
  (let ((start (foreign:monotonic-seconds)))
    (unwind-protect (funcall function)
      (when *meter*
        (incf (meter-seconds *meter*) (- (foreign:monotonic-seconds) start))))))
