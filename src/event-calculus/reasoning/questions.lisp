;;;; Formulas with timepoints by number, as propositions of a reasoner.

(in-package #:discrepancy-finder.event-calculus)

(defun formula-proposition (reasoner formula
                            &key (literal-term (lambda (literal)
                                                 (z3:clause-set-term
                                                  (reasoner-clause-set reasoner) literal))))
  "Return the proposition of the ground FORMULA, whose times are timepoints; LITERAL-TERM returns
the term of a propositional variable."
  (let ((encoder (reasoner-encoder reasoner)))
    (labels ((convert (formula)
               (if (atom formula)
                   formula
                   (case (first formula)
                     (:and (z3:conjunction (mapcar #'convert (rest formula))))
                     (:or (z3:disjunction (mapcar #'convert (rest formula))))
                     (:not (z3:negation (convert (second formula))))
                     (:iff (z3:equivalence (convert (second formula)) (convert (third formula))))
                     (:compare (comparison-proposition reasoner (rest formula) 0))
                     (t (let ((code (atom-literal encoder (first formula) (second formula)
                                                  (or (third formula) 0))))
                          (if (integerp code)
                              (funcall (the function literal-term)
                                       (encoder-variable encoder code 0))
                              code)))))))
      (convert formula))))

(defun constant-time (term)
  "Return the integer that TERM is, as one or as arithmetic of such, or NIL."
  (cond ((integerp term) term)
        ((and (consp term) (member (first term) '(:+ :- :*)))
         (let ((parts (mapcar #'constant-time (rest term))))
           (and (every #'identity parts)
                (fold-arithmetic (first term) parts))))))

(defun map-question-times (function theory form)
  "Call FUNCTION with each timepoint that FORM, a checked question, gives by number, and the event
that is to happen then, or NIL."
  (labels ((look (form)
             (when (consp form)
               (loop for term in (rest form)
                     for sort in (or (argument-sorts theory form) (mapcar (constantly nil)
                                                                          (rest form)))
                     for time = (and (eq sort :time) (constant-time term))
                     do (if time
                            (funcall (the function function) time
                                     (and (eq (first form) :happens) (second form)))
                            (look term))))))
    (look form)))

(defun check-question-times (theory form horizon)
  "Signal OUTSIDE-HORIZON if FORM, a checked question, gives a timepoint outside of HORIZON."
  (map-question-times (lambda (time event)
                        (unless (<= (car horizon) time (if event (1- (cdr horizon)) (cdr horizon)))
                          (error 'outside-horizon :time time :horizon horizon :event event)))
                      theory form))

(defun question-formula (reasoner form &key (blame "the question"))
  "Return the ground formula of FORM, a formula with timepoints by number.  Signals THEORY-ERROR,
OUTSIDE-HORIZON."
  (let* ((theory (reasoner-theory reasoner))
         (horizon (reasoner-horizon reasoner))
         (ground (encoder-ground (reasoner-encoder reasoner)))
         (checked (parse-formula form theory :kind :query :blame blame)))
    (check-question-times theory checked horizon)
    (prog1 (ground-formula ground checked :horizon horizon)
      ;; Atoms of predicates that no axiom mentions have no variables yet.
      (let ((encoder (reasoner-encoder reasoner)))
        (unless (and (= (encoder-predicate-count encoder)
                        (length (atom-table-atoms (ground-theory-predicates ground))))
                     (= (encoder-static-count encoder)
                        (length (atom-table-atoms (ground-theory-statics ground)))))
          (build reasoner))))))

(defun question-proposition (reasoner form)
  "Return the proposition of FORM, a formula with timepoints by number.  Signals THEORY-ERROR,
OUTSIDE-HORIZON."
  (formula-proposition reasoner (question-formula reasoner form)))
