;;;; Explanations of what is certain in random theories: it follows from the axioms that they name.

(in-package #:discrepancy-finder.tests)

(def-suite why-random :in all)
(in-suite why-random)

(defun entry-parts (entry)
  "Return the label, or NIL, and the formula of ENTRY, an axiom as DEFINE-THEORY has it."
  (cond ((eq (second entry) :label) (values (third entry) (fourth entry)))
        ((and (symbolp (first entry)) (consp (second entry)) (null (cddr entry))
              (not (ec::formula-operator-p (first entry))))
         (values nil (second entry)))
        (t (values nil entry))))

(defun with-names (clauses)
  "Return CLAUSES with every axiom named."
  (let ((number 0))
    (flet ((named (entry)
             (multiple-value-bind (label formula) (entry-parts entry)
               (let ((name (intern (format nil "AXIOM-~d" (incf number)) :keyword)))
                 (if label (list name :label label formula) (list name formula))))))
      (loop for (key . entries) in clauses
            collect (cons key (if (member key '(:axioms :facts :narrative))
                                  (mapcar #'named entries)
                                  entries))))))

(defun value-names (clauses)
  "Return the names of the axioms in CLAUSES that give a function, SIZE, a value."
  (loop for (key . entries) in clauses
        when (member key '(:axioms :facts))
          append (loop for (name formula) in entries
                       when (and (consp formula) (eq (first formula) '=) (consp (second formula))
                                 (eq (first (second formula)) 'size))
                         collect name)))

(defun certain-claims (theory)
  "Return formulas that are true in all models of THEORY, or (NIL) if it has no model."
  (multiple-value-bind (true false open consistent) (ec:consequences theory)
    (declare (ignore open))
    (if consistent
        (append true (mapcar (lambda (atom) (list 'not atom)) false))
        '(nil))))

(defun explanation-problem (clauses claim)
  "Return what is wrong with the explanation of CLAIM in the theory with CLAUSES, or NIL."
  (let* ((explanation (explanation-of clauses claim))
         (all (named-axioms clauses))
         (named (and explanation (ec:explanation-axioms explanation)))
         (needed (append (value-names clauses) named)))
    (cond ((null explanation) "it is not explained")
          ((set-difference named (mapcar #'ec:axiom-name
                                         (ec:theory-axioms (ec::parse-theory 'inline clauses))))
           "it rests on what is no axiom")
          ((find-if (lambda (sentence) (or (find #\Newline sentence) (search "NIL" sentence)))
                    (ec:explanation-sentences explanation))
           "a sentence is odd")
          ((not (follows-p (without-axioms clauses (set-difference all needed :test #'string=))
                           claim))
           (format nil "it does not follow from ~a alone" named)))))

(test explanations-of-what-is-certain
  (loop for seed from 1 to (if *long* 1000 60)
        for clauses = (with-names (tuned-clauses seed))
        ;; Effects that depend on themselves are refused.
        for claims = (handler-case (certain-claims (ec::parse-theory 'inline clauses))
                       (ec:theory-error () '()))
        do (loop for number from 1 to (if claims 3 0)
                 for claim = (nth (mod (* 7919 (+ number seed)) (length claims)) claims)
                 for problem = (explanation-problem clauses claim)
                 do (is (null problem) "seed ~d, ~a: ~a" seed claim problem))))
