;;;; Unsatisfiable cores: instances of axioms that cannot hold together.
;;;;
;;;; In a tracked reasoner the clauses of each source, the instance of an axiom or of an axiom
;;;; schema of the calculus, hold under a selector.  A GROUND-REASON is a source at a timepoint.
;;;; MINIMAL-CORE drops reasons from Z3's core as long as the rest remains inconsistent.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (ground-reason (:constructor make-ground-reason (source time variable clauses))
                          (:copier nil))
  "An instance of an axiom: its source, the timepoint that the source is relative to, the selector,
and its clauses, lists of propositional literals."
  (source nil :type source :read-only t)
  (time 0 :type fixnum :read-only t)
  (variable 0 :type fixnum :read-only t)
  (clauses '() :type list :read-only t))

(defun source-clauses (encoder source time selector)
  "Return the clauses of SOURCE at TIME without the SELECTOR."
  (let ((clauses '()) (clause '()))
    (loop for index from (source-start source) below (source-end source)
          for literal = (aref (template-literals (source-template source)) index)
          do (if (zerop literal)
                 (progn (push (remove (- selector) (nreverse clause)) clauses)
                        (setf clause '()))
                 (let ((variable (encoder-variable encoder (abs literal) time)))
                   (push (if (minusp literal) (- variable) variable) clause))))
    (nreverse clauses)))

(defun map-reasons (function reasoner)
  "Call FUNCTION with the source, the time and the selector of each instance in REASONER."
  (let* ((encoder (reasoner-encoder reasoner))
         (by-template (make-hash-table :test 'eq)))
    (loop for source across (encoder-sources encoder)
          do (push source (gethash (source-template source) by-template)))
    (loop for (template . time) in (schedule encoder nil (reasoner-horizon reasoner))
          do (dolist (source (reverse (gethash template by-template)))
               (funcall (the function function) source time
                        (encoder-variable encoder (source-code source) time))))))

(defun all-selectors (reasoner)
  (let ((selectors '()))
    (map-reasons (lambda (source time selector)
                   (declare (ignore source time))
                   (push selector selectors))
                 reasoner)
    (nreverse selectors)))

(defun inconsistent-p (reasoner selectors)
  (eq (z3:check-literals (reasoner-clause-set reasoner) selectors) :unsat))

(defun minimal-selectors (reasoner selectors others)
  "Return those of SELECTORS, inconsistent with OTHERS, without any one of which the rest is
consistent with OTHERS."
  (let ((needed '()))
    (loop while selectors
          do (let ((candidate (pop selectors)))
               (if (inconsistent-p reasoner (append needed selectors others))
                   (let ((core (z3:failed-literals (reasoner-clause-set reasoner))))
                     (setf selectors (intersection-in-order selectors core)))
                   (push candidate needed))))
    (nreverse needed)))

(defun few-selectors (reasoner core)
  "Return a minimal core.  First the axioms in CORE are reduced, with all instances of the
calculus's own schemas at hand, so that no axiom stands where a completion would do; then the
schemas."
  (let ((axioms '()) (schemas '()) (in-core (make-hash-table)))
    (dolist (selector core) (setf (gethash selector in-core) t))
    (map-reasons (lambda (source time selector)
                   (declare (ignore time))
                   (cond ((not (source-axiom source)) (push selector schemas))
                         ((gethash selector in-core) (push selector axioms))))
                 reasoner)
    (let ((needed (minimal-selectors reasoner (nreverse axioms) schemas)))
      (append needed
              (if (inconsistent-p reasoner needed)
                  '()
                  (progn
                    (inconsistent-p reasoner (append needed schemas))
                    (minimal-selectors
                     reasoner
                     (intersection-in-order (reverse schemas)
                                            (z3:failed-literals (reasoner-clause-set reasoner)))
                     needed)))))))

(defun intersection-in-order (list others)
  (let ((table (make-hash-table)))
    (dolist (other others) (setf (gethash other table) t))
    (remove-if-not (lambda (element) (gethash element table)) list)))

(defun minimal-core (reasoner)
  "Return the list of the reasons of a minimal core of REASONER, a tracked one, or NIL if what it
holds is consistent."
  (when (inconsistent-p reasoner (all-selectors reasoner))
    (let* ((selectors (few-selectors reasoner
                                     (z3:failed-literals (reasoner-clause-set reasoner))))
           (wanted (make-hash-table))
           (reasons '()))
      (dolist (selector selectors)
        (setf (gethash selector wanted) t))
      (map-reasons (lambda (source time selector)
                     (when (gethash selector wanted)
                       (push (make-ground-reason source (or (source-date source) time) selector
                                                 (source-clauses (reasoner-encoder reasoner) source
                                                                 time selector))
                             reasons)))
                   reasoner)
      (nreverse reasons))))

;;; Derivations

(defstruct (derivation (:constructor make-derivation (literal reason premises)) (:copier nil))
  "That LITERAL, or a contradiction if it is NIL, follows from PREMISES, literals, by REASON."
  (literal nil :type (or null fixnum) :read-only t)
  (reason nil :type ground-reason :read-only t)
  (premises '() :type list :read-only t))

(defun unit-derivations (reasons &optional goal)
  "Derive literals from the clauses of REASONS until they contradict each other or the literal GOAL
is derived.  Return the list of derivations that this rests on, in order, or NIL if unit propagation
does not lead there."
  (let ((derived (make-hash-table))
        (order '())
        (clauses (loop for reason in reasons
                       append (loop for clause in (ground-reason-clauses reason)
                                    collect (cons reason clause)))))
    (flet ((note (literal reason clause)
             (let ((derivation (make-derivation literal reason
                                                (loop for other in clause
                                                      unless (eql other literal)
                                                        collect (- other)))))
               (push derivation order)
               (when literal (setf (gethash literal derived) derivation))
               derivation)))
      (loop
        (let ((progress nil))
          (loop for (reason . clause) in clauses
                do (unless (some (lambda (literal) (gethash literal derived)) clause)
                     (let ((open (remove-if (lambda (literal) (gethash (- literal) derived))
                                            clause)))
                       (case (length open)
                         (0 (note nil reason clause)
                          (return-from unit-derivations
                            (relevant-derivations (first order) derived (reverse order))))
                         (1 (note (first open) reason clause)
                          (when (eql (first open) goal)
                            (return-from unit-derivations
                              (relevant-derivations (first order) derived (reverse order))))
                          (setf progress t))))))
          (unless progress (return nil)))))))

(defun relevant-derivations (last derived order)
  "Return those of the derivations ORDER that LAST rests on, itself included."
  (let ((relevant (make-hash-table :test 'eq)))
    (labels ((mark (derivation)
               (unless (gethash derivation relevant)
                 (setf (gethash derivation relevant) t)
                 (dolist (premise (derivation-premises derivation))
                   (mark (gethash premise derived))))))
      (mark last))
    (remove-if-not (lambda (derivation) (gethash derivation relevant)) order)))
