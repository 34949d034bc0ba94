;;;; Values of functions, which sentences such as (= (distance r1 r2) 3) give.
;;;;
;;;; A value may be given by other values, so the sentences are tried again until nothing is new.
;;;; What no sentence gives a value has none: an instance of a quantifier that needs it is dropped.
;;;; Entry point: GROUND-VALUES.

(in-package #:discrepancy-finder.event-calculus)

(defun mentions-function-p (theory term)
  (and (consp term)
       (or (and (find-function theory (first term)) t)
           (some (lambda (part) (mentions-function-p theory part)) (rest term)))))

(defun value-clause-parts (head)
  "Return the condition of the head of a clause of kind :VALUE, the term that applies the function,
and the term for the value."
  (destructuring-bind (condition application value)
      (if (eq (first head) :implies)
          (cons (second head) (rest (third head)))
          (cons t (rest head)))
    (values condition application value)))

(defun depends-on-values-p (theory head)
  "Return true if the value that HEAD gives may depend on other values."
  (multiple-value-bind (condition application value) (value-clause-parts head)
    (or (mentions-function-p theory value)
        (and (consp condition) (mentions-function-p theory condition))
        (some (lambda (term) (mentions-function-p theory term)) (rest application)))))

(defun note-value (ground axiom key value sources)
  "Let KEY, (function element*), have VALUE, as AXIOM says.  Return true if that is new.  SOURCES is
a table from keys to axioms.  Signals THEORY-ERROR."
  (let* ((theory (ground-theory-theory ground))
         (table (ground-theory-function-values ground))
         (sort (second (find-function theory (first key))))
         (source (gethash key sources)))
    (cond ((null source)
           (unless (or (eq (theory-syntax theory) :e) (element-of-sort-p theory value sort))
             (theory-problem theory axiom nil "~a is ~a, which is no element of ~a" (atom-text key)
                             (formula-text value) (sort-text theory sort)))
           (setf (gethash key sources) axiom
                 (gethash key table) value)
           t)
          ((not (equal value (gethash key table)))
           (theory-problem theory axiom nil "~a is ~a, but ~a by axiom ~a" (atom-text key)
                           (formula-text value) (formula-text (gethash key table))
                           (name-text (axiom-name source)))))))

(defun ground-value (ground axiom head sources)
  "Note the values that HEAD, of a clause of kind :VALUE of AXIOM, gives.  Return true if one is
new."
  (let* ((theory (ground-theory-theory ground))
         (head (strip-quantifiers head))
         (new nil))
    (multiple-value-bind (condition application value) (value-clause-parts head)
      (call-with-instances
       ground axiom (free-variables head) nil (and (consp condition) (conditions-of condition))
       (lambda (compilation)
         (let ((key (compile-symbol-term compilation application
                                         (first (find-function theory (first application)))))
               (value (compile-term compilation value))
               (condition (if (consp condition)
                              (compile-formula compilation condition)
                              (constantly t))))
           (declare (type function key value condition))
           (lambda (environment)
             (when (and (funcall condition environment)
                        (note-value ground axiom (funcall key environment)
                                    (funcall value environment) sources))
               (setf new t)))))))
    new))

(defun ground-values (ground clauses)
  "Note the values of functions that CLAUSES, (axiom kind condition head), give in GROUND.  Signals
THEORY-ERROR if they contradict each other."
  (let ((theory (ground-theory-theory ground))
        (clauses (remove :value clauses :key #'second :test-not #'eq))
        (sources (make-term-table)))
    (loop while (plusp (count-if (lambda (clause)
                            (ground-value ground (first clause) (fourth clause) sources))
                                    clauses))
          do (setf clauses (remove-if-not (lambda (clause)
                                            (depends-on-values-p theory (fourth clause)))
                                          clauses))
          while clauses)))

(defun missing-values (ground declaration)
  "Return the list of the (function element*) of DECLARATION, (name sort*), that have no value in
GROUND, and the number of all."
  (let ((keys (ground-terms (ground-theory-theory ground) (first declaration)
                            (rest declaration))))
    (values (remove-if (lambda (key)
                         (nth-value 1 (gethash key (ground-theory-function-values ground))))
                       keys)
            (length keys))))

(defun check-values (theory)
  "Check that the values of functions that THEORY gives do not contradict each other."
  (let ((clauses (loop for axiom in (theory-axioms theory)
                       nconc (loop for clause in (axiom-clauses axiom theory)
                                   when (eq (first clause) :value)
                                     collect (cons axiom clause)))))
    (when clauses
      (let ((*relative* t) (*span* (cons 0 0)))
        (ground-values (make-empty-ground-theory theory) clauses)))))
