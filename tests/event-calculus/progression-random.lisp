;;;; Progression against the bounded engine: on the scenarios of tests/theories/, and on random
;;;; theories.
;;;;
;;;; Both engines are given the same theory and the same events; the pairs of initial and final
;;;; states that they allow must be the same.  Where progression says that it is not exact it may
;;;; allow more, never less.  Entry point: COMPARE-ENGINES.

(in-package #:discrepancy-finder.tests)

(def-suite progression-random :in all)
(in-suite progression-random)

;;; Pairs of states, as integers with a bit for each fluent

(defun allowed-tables (solver propositions known)
  "Return the sorted list of the truth tables of PROPOSITIONS that the assertions of SOLVER allow.
KNOWN has a truth value, or :OPEN, for each of the first of them."
  (let ((tables '()))
    (flet ((literal (proposition value)
             (if value proposition (z3:negation proposition))))
      (loop for proposition in propositions
            for value in known
            unless (eq value :open)
              do (z3:solver-assert solver (literal proposition value)))
      (loop while (eq (z3:check solver) :sat)
            do (let ((values (loop for proposition in propositions
                                   collect (z3:model-value solver proposition))))
                 (push (reduce (lambda (bits value) (+ (* 2 bits) (if value 1 0))) values
                               :initial-value 0)
                       tables)
                 (z3:solver-assert solver
                                   (z3:disjunction
                                    (loop for proposition in propositions
                                          for value in values
                                          collect (literal proposition (not value))))))))
    (sort tables #'<)))

(defun happens-labels (clauses)
  "Return the labels under which the theory of CLAUSES completes happens."
  (loop for entry in (rest (assoc :completion clauses))
        when (eq entry 'happens) collect nil
        when (equal (last (if (listp entry) entry (list nil))) '(happens)) collect (first entry)))

(defun with-events (clauses events first)
  "Return CLAUSES of a theory in which EVENTS, a list for each timepoint from FIRST on, happen and
nothing else but what is triggered."
  (let ((labels (happens-labels clauses)))
    (append
     `((:narrative
        ,@(loop for group in events
                for time from first
                append (loop for event in group
                             append (loop for label in (or labels '(nil))
                                          collect (list (gensym "GIVEN-") :label (or label 'given)
                                                        `(happens ,event ,time))))))
       ,@(unless labels '((:completion happens))))
     clauses)))

(defun bounded-tables (theory last known)
  "Return the tables of the states at the first timepoint and at LAST that the bounded engine allows
for THEORY."
  (let ((first (first-timepoint theory)))
    (ec:with-reasoner (reasoner theory :horizon (list first last))
      (allowed-tables (ec::reasoner-solver reasoner)
                      (loop for time in (list first last)
                            append (loop for atom across (ec:ground-theory-fluents
                                                          (ec:ground theory))
                                         collect (ec::question-proposition
                                                  reasoner `(:holds-at ,atom ,time))))
                      known))))

(defun first-timepoint (theory)
  (let ((range (ec:theory-time-range theory)))
    (if range (car range) 0)))

(defun assume-all (solver conditions)
  (loop for (nil . proposition) in conditions
        do (z3:solver-assert solver proposition)))

(defun progressed-tables (theory events known)
  "Return the tables that progression of THEORY along EVENTS allows, and true if it says that they
are exact."
  (let ((ground (ec:ground theory)))
    (z3:with-context (context)
      (z3:with-solver (solver context)
        (let* ((initial (ec:symbolic-state ground context)) (state initial))
          (assume-all solver (ec:initial-conditions initial))
          (dolist (group events)
            (multiple-value-bind (next conditions)
                (ec:progress state (loop for event in group collect (ec:find-event ground event)))
              (assume-all solver conditions)
              (setf state next)))
          (values (allowed-tables solver
                                  (concatenate 'list (ec:state-values initial)
                                               (ec:state-values state))
                                  known)
                  (ec:state-exact-p state)))))))

(defun compare-tables (bounded progressed exact)
  "Return :EXACT, :MORE (progression allows more, and says so), :INCONSISTENT (nothing is allowed),
or a text that says how the tables differ."
  (cond ((and (equal bounded progressed) (null bounded)) :inconsistent)
        ((and (equal bounded progressed) exact) :exact)
        ((and (not exact) (subsetp bounded progressed)) :more)
        (t (format nil "missing ~d, too many ~d~:[~;, though exact~], of ~d"
                   (length (set-difference bounded progressed))
                   (length (set-difference progressed bounded)) exact (length bounded)))))

;;; The scenarios, whose theories have the events

(defun compare-engines-on-file (file)
  "Do as COMPARE-TABLES does for the theory in FILE; return NIL if its events are open."
  (let ((theory (ec:load-theory file)))
    (when (find :happens (ec:theory-completions theory) :key #'second)
      (let* ((first (first-timepoint theory))
             (last (cdr (ec:theory-time-range theory))))
        (multiple-value-bind (progressed exact)
            (progressed-tables theory (make-list (- last first) :initial-element '()) '())
          (compare-tables (bounded-tables theory last '()) progressed exact))))))

;;; Random theories

(defun compare-engines (clauses events known)
  "Do as COMPARE-TABLES does for the theory of CLAUSES with EVENTS, of whose initial state the truth
values KNOWN are given; a text has all of these."
  (multiple-value-bind (progressed exact)
      (progressed-tables (random-theory clauses) events known)
    (let ((result (compare-tables (bounded-tables-with clauses events known) progressed exact)))
      (if (stringp result)
          (format nil "~a~%~a~%~s~%~s" result (clauses-text clauses) events known)
          result))))

(defun bounded-tables-with (clauses events known)
  (let ((first (first-timepoint (random-theory clauses))))
    (bounded-tables (random-theory (with-events clauses events first))
                    (+ first (length events)) known)))

(defun random-events (dice ground length)
  "Return LENGTH lists of ground events, of one mostly."
  (let ((events (coerce (ec:ground-theory-events ground) 'list)))
    (loop repeat length
          collect (remove-duplicates
                   (loop repeat (pick dice '(0 1 1 1 1 2)) collect (pick dice events))
                   :test #'equal))))

(defun consistent-clauses (clauses events known dice)
  "Return CLAUSES without axioms that make the theory inconsistent with EVENTS and KNOWN."
  (loop until (bounded-tables-with clauses events known)
        do (setf clauses (or (without-one-axiom clauses dice) (return clauses))))
  clauses)

(defun random-problem (seed)
  "Return the clauses of the random theory of SEED, made consistent for six seeds of seven, random
events, and what is known of the first state."
  (let* ((clauses (random-theory-clauses seed))
         (dice (make-dice (- (expt 2 62) seed)))
         (ground (ec:ground (random-theory clauses)))
         (events (random-events dice ground (1+ (roll dice 3))))
         (known (loop repeat (length (ec:ground-theory-fluents ground))
                      collect (pick dice '(t nil nil :open :open)))))
    (values (if (zerop (mod seed 7))
                clauses
                (consistent-clauses clauses events known dice))
            events known)))

(defun compare-engines-on (seed)
  "Do as COMPARE-ENGINES does with the random problem of SEED; a text is of the smallest theory on
which the engines differ.  A theory that is malformed is :MALFORMED."
  (multiple-value-bind (clauses events known)
      (handler-case (random-problem seed)
        (ec:theory-error () (return-from compare-engines-on :malformed)))
    (flet ((compare (clauses)
             (handler-case (compare-engines clauses events known)
               (ec:theory-error () :malformed))))
      (let ((result (compare clauses)))
        (if (stringp result)
            (format nil "Seed ~d: ~a" seed
                    (compare (shrunk clauses (lambda (clauses) (stringp (compare clauses))))))
            result)))))

;;; Tests

(test engines-agree-on-random-theories
  (let ((exact 0) (seeds (if *long* 1500 150)))
    (loop for seed from 1 to seeds
          do (let ((result (compare-engines-on seed)))
               (is (not (stringp result)) "~a" result)
               (when (eq result :exact) (incf exact))))
    (is (< (* 6/10 seeds) exact) "only ~d of ~d theories were consistent and exact" exact seeds)))

(test engines-agree-on-the-scenarios
  (let ((exact 0))
    (dolist (file (uiop:directory-files (root-file "tests/theories/") "*.lisp"))
      (let ((result (compare-engines-on-file file)))
        (is (not (stringp result)) "~a: ~a" (pathname-name file) result)
        (when (eq result :exact) (incf exact))))
    (is (<= 45 exact) "progression was exact for ~d scenarios only" exact)))
