;;;; Small theories in the place of large ones on which a test fails.
;;;;
;;;; A PROBLEM is a function of a theory that returns NIL or what is wrong, a keyword or a list that
;;;; begins with one.  Entry point: FAILURE.

(in-package #:discrepancy-finder.tests)

(defun simpler-forms (form)
  "Return formulas that are simpler than FORM: its parts, and FORM with a part made simpler."
  (if (and (consp form)
           (member (first form) '(and or not implies iff forall exists initially)))
      (let ((parts (if (member (first form) '(forall exists)) (cddr form) (rest form))))
        (append (remove-if-not #'consp (and (not (eq (first form) 'initially)) parts))
                (and (member (first form) '(and or)) (cddr parts)
                     (loop for part in parts collect (remove part form :count 1)))
                (loop for part in parts
                      append (loop for simpler in (simpler-forms part)
                                   collect (substitute simpler part form :count 1)))))
      '()))

(defun simpler-entries (key entry)
  "Return what could stand for ENTRY in the clause KEY: a list of lists of entries."
  (case key
    ((:axioms :narrative :facts)
     (let ((formula (first (last entry))))
       (cons '()
             (if (member :label entry)
                 (cons (list formula)
                       (loop for simpler in (simpler-forms formula)
                             collect (list (append (butlast entry) (list simpler)))))
                 (mapcar #'list (simpler-forms entry))))))
    (:offset '())
    (:time (and (integerp entry) (> entry 1) (list (list (1- entry)))))
    ((:mutex :xor) (cons '() (and (rest entry) (list (list (rest entry)) (list (butlast entry))))))
    (t '(()))))

(defun simpler-clauses (clauses)
  "Return lists of clauses that are a bit simpler than CLAUSES."
  (loop for clause in clauses
        for (key . entries) = clause
        unless (eq key :time)
          append (list (remove clause clauses))
        append (loop for rest on entries
                     append (loop for replacement in (simpler-entries key (first rest))
                                  collect (substitute
                                           (cons key (append (ldiff entries rest) replacement
                                                             (rest rest)))
                                           clause clauses)))))

(defun shrunk (clauses failing-p)
  "Return clauses for which FAILING-P, a predicate, is as true as for CLAUSES, but as few and as
simple as can be had by leaving out parts."
  (loop for simpler = (find-if failing-p (simpler-clauses clauses))
        while simpler
        do (setf clauses simpler))
  clauses)

(defun clauses-text (clauses)
  (let ((*package* (find-package '#:discrepancy-finder.tests)) (*print-right-margin* 100))
    (format nil "(define-theory random~{~%  ~(~s~)~})" clauses)))

(defun refusal-p (error)
  "Return true if ERROR says that an effect is defined by itself."
  (search "depend on it" (princ-to-string error)))

(defun problem-with (clauses problem)
  "Return what PROBLEM finds wrong with the theory of CLAUSES, or NIL; a theory that the reasoner
refuses, because an effect depends on itself, is not wrong."
  (let ((theory (random-theory clauses)))
    (handler-case (funcall problem theory)
      (error (error)
        (unless (refusal-p error)
          (list :error (princ-to-string error)))))))

(defun failure (seed problem &optional (clauses (tuned-clauses seed)))
  "Return NIL if PROBLEM finds nothing wrong with the random theory of SEED, or with the one of
CLAUSES, else a text with the smallest theory with which the same is wrong."
  (flet ((kind (clauses)
           (let ((found (handler-case (problem-with clauses problem)
                          (ec:theory-error () nil))))
             (if (consp found) (first found) found))))
    (let ((found (problem-with clauses problem)))
      (when found
        (let* ((kind (kind clauses))
               (smallest (shrunk clauses (lambda (clauses) (eq (kind clauses) kind)))))
          (format nil "Seed ~d: ~s~%~a" seed (problem-with smallest problem)
                  (clauses-text smallest)))))))
