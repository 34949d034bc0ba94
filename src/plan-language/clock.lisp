;;;; Time as plans see it: never the wall's.
;;;;
;;;; A clock is any object with methods on CLOCK-TIME and LET-TIME-PASS: a projection is one, its
;;;; time passes by simulation.  Without one a plan has a VIRTUAL-CLOCK, on which time passes only
;;;; when everything waits, and then at once.

(in-package #:discrepancy-finder.plan-language)

(defgeneric clock-time (clock)
  (:documentation "Return the time of CLOCK in s, a double float."))

(defgeneric let-time-pass (clock seconds)
  (:documentation "Let the time of CLOCK go on by SECONDS, or by a little more."))

(defclass virtual-clock ()
  ((seconds :initform 0d0 :accessor clock-seconds :type double-float))
  (:documentation "A clock that begins at 0 and goes on when it is told to."))

(defmethod clock-time ((clock virtual-clock))
  (clock-seconds clock))

(defmethod let-time-pass ((clock virtual-clock) seconds)
  (incf (clock-seconds clock) (float seconds 1d0)))

(defgeneric executive-clock (executive)
  (:documentation "Return the clock of plans that EXECUTIVE performs, or NIL if it has none: then
they get a VIRTUAL-CLOCK.")
  (:method (executive) (declare (ignore executive)) nil))
