(in-package #:discrepancy-finder.foreign)

(defconstant +clock-monotonic+ 1
  "Linux's number of the clock that only goes forward.")

(defconstant +clock-thread-cputime+ 3
  "Linux's number of the clock that goes while the calling thread has a processor.")

(declaim (inline monotonic-nanoseconds))
(defun monotonic-nanoseconds ()
  "Return the time (ns, an integer) of a clock that only goes forward.  SBCL's own internal real
time goes in steps of 4 ms."
  (multiple-value-bind (seconds nanoseconds) (sb-unix::clock-gettime +clock-monotonic+)
    (+ (* 1000000000 seconds) nanoseconds)))

(defun monotonic-seconds ()
  "Return the time (s, a double float) of a clock that only goes forward."
  (* 1d-9 (monotonic-nanoseconds)))

(defun processor-seconds ()
  "Return the time (s, a double float) for which the calling thread has had a processor."
  (multiple-value-bind (seconds nanoseconds) (sb-unix::clock-gettime +clock-thread-cputime+)
    (+ seconds (* 1d-9 nanoseconds))))
