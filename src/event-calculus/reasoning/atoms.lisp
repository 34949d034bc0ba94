;;;; What the propositional variables of a reasoner stand for.

(in-package #:discrepancy-finder.event-calculus)

(defun predicate-atom (theory key time)
  "Return the atom of the theory's own predicate whose KEY, without the time, is at TIME."
  (let* ((sorts (rest (assoc (first key) (theory-predicates theory))))
         (place (position :time sorts)))
    (append (subseq key 0 (1+ place)) (list time) (nthcdr (1+ place) key))))

(defun atom-of-code (encoder code time)
  "Return the ground atom of the positive CODE relative to TIME, such as (:holds-at (:f) 3), or NIL
if it is an auxiliary one."
  (let* ((ground (encoder-ground encoder))
         (fluents (encoder-fluent-count encoder))
         (events (encoder-event-count encoder))
         (number (code-atom code)))
    (if (global-code-p code)
        (let ((statics (atom-table-atoms (ground-theory-statics ground))))
          (and (<= 1 number (encoder-static-count encoder))
               (aref statics (1- number))))
        (let ((time (+ time (code-distance code))))
          (cond ((< number fluents)
                 (list :holds-at (svref (ground-theory-fluents ground) number) time))
                ((< (decf number fluents) fluents)
                 (list :released-at (svref (ground-theory-fluents ground) number) time))
                ((< (decf number fluents) events)
                 (list :happens (svref (ground-theory-events ground) number) time))
                ((< (decf number events) (encoder-predicate-count encoder))
                 (predicate-atom (ground-theory-theory ground)
                                 (aref (atom-table-atoms (ground-theory-predicates ground)) number)
                                 time)))))))

(defun variable-code (encoder variable)
  "Return the code and the time of the propositional VARIABLE."
  (let ((rest (- variable (encoder-global-size encoder))))
    (if (minusp rest)
        (values variable 0)
        (multiple-value-bind (step atom) (floor rest (encoder-step-size encoder))
          (values (make-code atom 0) (+ step (car (encoder-horizon encoder))))))))

(defun variable-atom (reasoner variable)
  "Return the ground atom that the propositional VARIABLE stands for, or NIL."
  (let ((encoder (reasoner-encoder reasoner)))
    (multiple-value-bind (code time) (variable-code encoder variable)
      (atom-of-code encoder code time))))

(defun variable-text (reasoner variable)
  (let ((atom (variable-atom reasoner variable)))
    (if atom (atom-text atom) (format nil "aux ~d" variable))))
