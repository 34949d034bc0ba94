(in-package #:discrepancy-finder.foreign)

(defmacro with-c-float-traps (&body body)
  "Evaluate BODY with the float traps that C libraries expect: none.  SBCL keeps its own traps on
during a foreign call, so that a harmless 0/0 inside of a library would be a SIGFPE.  Costs half a
microsecond: wrap it around an entry point, once, and not around each call."
  `(sb-int:with-float-traps-masked (:invalid :divide-by-zero :overflow :underflow :inexact)
     ,@body))
