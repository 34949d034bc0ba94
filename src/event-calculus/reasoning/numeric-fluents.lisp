;;;; Numeric fluents in clauses: inertia, assignment and release of numbers.
;;;;
;;;; The value at t + 1 is the one that an event assigns at t, or that at t unless the fluent is
;;;; released: DEC5 to DEC12 with a number in the place of a truth value.  Each equation is an atom
;;;; of its own, which the solver ties to one real a fluent and timepoint.

(in-package #:discrepancy-finder.event-calculus)

(defun numeric-effects (ground numeric kind time)
  "Return the effects of KIND on NUMERIC at any timepoint, with TIME also those at TIME only."
  (remove-if-not (lambda (effect)
                   (and (eq (effect-kind effect) kind)
                        (or (null (effect-time effect)) (eql (effect-time effect) time))))
                 (svref (ground-theory-effects-on-numeric ground) numeric)))

(defun encode-numeric-fluent (encoder numeric template time absolute)
  "Add what changes and what keeps the value of NUMERIC between TIME and the next timepoint."
  (let* ((ground (encoder-ground encoder))
         (now (list :value numeric time))
         (next (list :value numeric (1+ time)))
         (released (atom-literal encoder :number-released numeric time))
         (released-next (atom-literal encoder :number-released numeric (1+ time))))
    (flet ((effects (kind) (numeric-effects ground numeric kind (and absolute time)))
           (premise (effect) (negated (dated-effect-formula effect time)))
           (equation (left right) (formula-literal encoder (list :compare := left right) 0)))
      (dolist (effect (effects :assigns))
        (with-source (encoder template absolute :effect effect)
          (assert-formula encoder (premise effect) 0
                          (list (equation next (shift-formula (effect-term effect)
                                                              (effect-shift effect time)))))
          (assert-formula encoder (premise effect) 0 (list (- released-next)))))
      (dolist (effect (effects :releases))
        (with-source (encoder template absolute :effect effect)
          (assert-formula encoder (premise effect) 0 (list released-next))))
      (flet ((literals (kind)
               (loop for effect in (effects kind)
                     collect (formula-literal encoder (dated-effect-formula effect time) 0))))
        (with-source (encoder template absolute :numeric-inertia numeric)
          (add-clause encoder (list* released-next (equation next now) (literals :assigns)))
          (add-clause encoder (list* (- released) released-next (literals :assigns)))
          (add-clause encoder (list* released (- released-next) (literals :releases))))))))

(defun encode-numeric-fluents (encoder)
  (let ((ground (encoder-ground encoder)) (horizon (encoder-horizon encoder)))
    (dotimes (numeric (encoder-numeric-count encoder))
      (if (some #'effect-time (svref (ground-theory-effects-on-numeric ground) numeric))
          (loop for time from (car horizon) below (cdr horizon)
                do (encode-numeric-fluent encoder numeric (encoder-absolute encoder) time t))
          (encode-numeric-fluent encoder numeric (find-template encoder 0 1) 0 nil))
      (with-source (encoder (encoder-initial encoder) t :number-not-released numeric)
        (add-clause encoder (list (- (atom-literal encoder :number-released numeric 0))))))))
