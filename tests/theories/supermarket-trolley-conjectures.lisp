;;;; The supermarket trolley, pushed, then pulled, then both.
;;;;
;;;; Source: E. Mueller, G. Sutcliffe, Reasoning in the event calculus using first-order automated
;;;; theorem proving, 2005: problems CSR015 to CSR023 of the TPTP library; the domain is Shanahan's.
;;;; Expected: 1 model, in which all conjectures hold: forwards at 1; backwards and not forwards at
;;;; 2; spinning, neither forwards nor backwards, at 3.

(define-theory supermarket-trolley-conjectures
  "Push at 0, pull at 1, both at 2."
  (:fluents (forwards) (backwards) (spinning))
  (:events (push) (pull))
  (:axioms
   (push-alone (implies (not (happens (pull) ?time)) (initiates (push) (forwards) ?time)))
   (implies (not (happens (pull) ?time)) (terminates (push) (backwards) ?time))
   (implies (not (happens (pull) ?time)) (terminates (push) (spinning) ?time))
   (pull-alone (implies (not (happens (push) ?time)) (initiates (pull) (backwards) ?time)))
   (implies (not (happens (push) ?time)) (terminates (pull) (forwards) ?time))
   (implies (not (happens (push) ?time)) (terminates (pull) (spinning) ?time))
   (both (implies (happens (push) ?time) (initiates (pull) (spinning) ?time)))
   (implies (happens (push) ?time) (terminates (pull) (forwards) ?time))
   (implies (happens (push) ?time) (terminates (pull) (backwards) ?time)))
  (:facts
   (not (holds-at (forwards) 0))
   (not (holds-at (backwards) 0))
   (not (holds-at (spinning) 0)))
  (:narrative
   (happens (push) 0)
   (happens (pull) 1)
   (happens (push) 2)
   (happens (pull) 2))
  (:completion happens)
  (:time 0 3))
