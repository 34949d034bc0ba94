;;;; Models: what can be true at the timepoints of a horizon.
;;;;
;;;; As in the Discrete Event Calculus Reasoner an atom that no clause mentions is no variable: it
;;;; is not counted, and it is false.  Entry points: MODELS, COUNT-MODELS.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (model (:constructor make-model (reasoner-theory horizon encoder values numbers))
                  (:copier nil))
  "A model of a theory: made by MODELS."
  (reasoner-theory nil :type theory :read-only t)
  (horizon nil :type cons :read-only t)
  (encoder nil :type encoder :read-only t)
  (values #* :type simple-bit-vector :read-only t)
  (numbers nil :type hash-table :read-only t))

(setf (documentation 'model-horizon 'function)
      "Return (first . last), the timepoints of a model.")

(defun model-theory (model)
  "Return the theory of a model."
  (model-reasoner-theory model))

(defmethod print-object ((model model) stream)
  (print-unreadable-object (model stream :type t)
    (destructuring-bind (first . last) (model-horizon model)
      (format stream "~a~{ ~a~}" (name-text (theory-name (model-theory model)))
              (loop for time from first below last
                    append (loop for event in (model-events model time)
                                 collect (format nil "~d:~a" time (atom-text event))))))))

(defun model-bit (model kind number time)
  "Return true if the atom of KIND with NUMBER at TIME is true in MODEL."
  (let* ((encoder (model-encoder model))
         (code (atom-literal encoder kind number time)))
    (if (integerp code)
        (let ((variable (encoder-variable encoder code 0)) (values (model-values model)))
          (and (< variable (length values)) (= 1 (sbit values variable))))
        code)))

(defun check-model-time (model time)
  (check-type time integer)
  (destructuring-bind (first . last) (model-horizon model)
    (unless (<= first time last)
      (error 'outside-horizon :time time :horizon (model-horizon model)))))

(defun true-members (model kind atoms time)
  (check-model-time model time)
  (loop for atom across atoms
        for number from 0
        when (model-bit model kind number time) collect atom))

(defun model-fluents (model time)
  "Return the list of the ground fluents that hold in MODEL at TIME.  Signals OUTSIDE-HORIZON."
  (true-members model :fluent (ground-theory-fluents (encoder-ground (model-encoder model))) time))

(defun model-events (model time)
  "Return the list of the ground events that happen in MODEL at TIME.  Signals OUTSIDE-HORIZON."
  (if (eql time (cdr (model-horizon model)))
      '()
      (true-members model :event (ground-theory-events (encoder-ground (model-encoder model)))
                    time)))

(defun model-number (model fluent time)
  "Return the number that the numeric FLUENT, a list of symbols, has in MODEL at TIME: a rational, a
Z3:ALGEBRAIC-NUMBER, or NIL if no axiom speaks of it.  Other models may have others.  Signals
UNKNOWN-ATOM, OUTSIDE-HORIZON."
  (check-model-time model time)
  (let ((ground (encoder-ground (model-encoder model))))
    (values (gethash (cons (or (gethash (atom-keywords fluent)
                                        (ground-theory-numeric-index ground))
                               (error 'unknown-atom :atom fluent :kind "numeric fluent"
                                                    :theory (theory-name (model-theory model))))
                           time)
                     (model-numbers model)))))

(defun model-literals (model)
  "Return the list of the other true atoms of MODEL: (:released-at fluent time) and atoms of the
theory's own predicates."
  (let* ((encoder (model-encoder model)) (ground (encoder-ground encoder))
         (statics (atom-table-atoms (ground-theory-statics ground)))
         (predicates (atom-table-atoms (ground-theory-predicates ground))))
    (destructuring-bind (first . last) (model-horizon model)
      (append
       (loop for number below (encoder-static-count encoder)
             when (model-bit model :static number 0) collect (aref statics number))
       (loop for time from first to last
             append (loop for fluent across (ground-theory-fluents ground)
                          for number from 0
                          when (model-bit model :released number time)
                            collect (list :released-at fluent time))
             append (loop for number below (encoder-predicate-count encoder)
                          when (model-bit model :predicate number time)
                            collect (predicate-atom (model-theory model)
                                                    (aref predicates number) time)))))))

;;; Enumeration

(defun current-values (reasoner)
  "Return the values of the propositional variables that occur, and the numbers, after a check that
found a model."
  (let* ((values (z3:literal-values (reasoner-clause-set reasoner)))
         (occurring (reasoner-occurring reasoner))
         (result (make-array (length occurring) :element-type 'bit :initial-element 0)))
    (replace result values)
    (values (bit-and result occurring result) (current-numbers reasoner))))

(defun atom-variables (reasoner)
  "Return the list of the variables that stand for atoms and occur."
  (loop for variable from 1 below (length (reasoner-occurring reasoner))
        when (and (= 1 (sbit (reasoner-occurring reasoner) variable))
                  (variable-atom reasoner variable))
          collect variable))

(defun blocking-clause (values variables)
  "Return the clause that excludes the VALUES of VARIABLES, as a vector of literals."
  (let ((clause (make-array (1+ (length variables)) :element-type 'fixnum :initial-element 0)))
    (loop for variable in variables
          for position from 0
          do (setf (aref clause position)
                   (if (= 1 (sbit values variable)) (- variable) variable)))
    clause))

(defun call-with-question (function reasoner forms)
  "Call FUNCTION while the list FORMS of formulas is asserted."
  (let* ((propositions (loop for form in forms collect (question-proposition reasoner form)))
         (solver (reasoner-solver reasoner)))
    (z3:push-scope solver)
    (unwind-protect (progn (dolist (proposition propositions)
                             (z3:solver-assert solver proposition))
                           (funcall (the function function)))
      (z3:pop-scope solver))))

(defmacro with-question ((reasoner &rest forms) &body body)
  "Evaluate BODY while FORMS, formulas or NIL for none, are asserted."
  `(call-with-question (lambda () ,@body) ,reasoner (remove nil (list ,@forms))))

(defun map-models (function reasoner limit minimize &key (complete t))
  "Call FUNCTION with the values and the numbers of each model, LIMIT (or NIL) at most.  Return true
if there are no more; with COMPLETE false it is not tried to find out after LIMIT models.  MINIMIZE
is :ALL for all models, or a list of variables for those that are minimal in them.  Models that
differ in numbers only are one."
  (let ((clause-set (reasoner-clause-set reasoner))
        (variables (atom-variables reasoner))
        (count 0))
    (loop
      (when (and (eql count limit) (not complete))
        (return nil))
      (unless (eq (z3:check-literals clause-set '()) :sat)
        (return t))
      (when (eql count limit)
        (return nil))
      (multiple-value-bind (values numbers) (current-values reasoner)
        (when (listp minimize)
          (multiple-value-setq (values numbers)
            (minimal-values reasoner values numbers minimize)))
        (incf count)
        (funcall (the function function) values numbers)
        (z3:assert-clauses clause-set
                           (if (listp minimize)
                               (excluding-clause values minimize)
                               (blocking-clause values variables)))))))

;;; Minimal models

(defun minimized-predicates (theory minimize)
  "Return MINIMIZE, a predicate or a list of them, as keywords.  Signals THEORY-ERROR."
  (loop for name in (if (listp minimize) minimize (list minimize))
        for keyword = (name-keyword name)
        unless (or (member keyword '(:happens :holds-at :released-at))
                   (assoc keyword (theory-predicates theory)))
          do (theory-problem theory nil nil "there is no predicate ~a to minimize"
                             (name-text name))
        collect keyword))

(defun minimized-variables (reasoner predicates)
  "Return the list of the variables of the atoms of PREDICATES."
  (remove-if-not (lambda (variable)
                   (member (first (variable-atom reasoner variable)) predicates))
                 (atom-variables reasoner)))

(defun excluding-clause (values minimized)
  "Return the clause that one of the MINIMIZED variables that are true in VALUES is false."
  (coerce (append (loop for variable in minimized
                        when (= 1 (sbit values variable)) collect (- variable))
                  (list 0))
          '(simple-array fixnum (*))))

(defun minimal-values (reasoner values numbers minimized)
  "Return the values and the numbers of a model in which no proper subset of the true MINIMIZED
variables of VALUES could be true instead."
  (let ((solver (reasoner-solver reasoner)) (clause-set (reasoner-clause-set reasoner)))
    (z3:push-scope solver)
    (unwind-protect
         (loop
           (z3:assert-clauses clause-set
                              (coerce (loop for variable in minimized
                                            when (= 0 (sbit values variable))
                                              append (list (- variable) 0))
                                      '(simple-array fixnum (*))))
           (z3:assert-clauses clause-set (excluding-clause values minimized))
           (if (eq (z3:check-literals clause-set '()) :sat)
               (multiple-value-setq (values numbers) (current-values reasoner))
               (return (values values numbers))))
      (z3:pop-scope solver))))

;;; Queries

(defun models (theory &key horizon (limit 10) where minimize (complete t))
  "Return the list of at most LIMIT (NIL: all) models of THEORY, a theory, its name or a reasoner,
and true if there are no more; with COMPLETE false it is not tried to find out after LIMIT models.
HORIZON is as for MAKE-REASONER; WHERE is a formula with timepoints by number that the models
satisfy.  MINIMIZE is a list of predicates, happens or the theory's own: only one model is returned
for each set of their true atoms of which no part would do (circumscription, where predicate
completion is weaker).  Signals THEORY-ERROR, NO-HORIZON."
  (check-type limit (or null unsigned-byte))
  (let ((models '()))
    (with-reasoner-of (reasoner theory :horizon horizon)
      (let ((complete
              (with-question (reasoner where)
                (map-models (lambda (values numbers)
                              (push (make-model (reasoner-theory reasoner)
                                                (reasoner-horizon reasoner)
                                                (reasoner-encoder reasoner) values numbers)
                                    models))
                            reasoner limit
                            (if minimize
                                (minimized-variables
                                 reasoner
                                 (minimized-predicates (reasoner-theory reasoner) minimize))
                                :all)
                            :complete complete))))
        (values (nreverse models) complete)))))

(defun count-models (theory &key horizon limit where)
  "Return the number of models of THEORY, LIMIT at most, and true if there are no more.  The
arguments are those of MODELS.  Signals THEORY-ERROR, NO-HORIZON."
  (check-type limit (or null unsigned-byte))
  (let ((count 0))
    (with-reasoner-of (reasoner theory :horizon horizon)
      (let ((complete (with-question (reasoner where)
                        (map-models (lambda (values numbers)
                                      (declare (ignore values numbers))
                                      (incf count))
                                    reasoner limit :all))))
        (values count complete)))))
