;;;; Models in the form of the Discrete Event Calculus Reasoner.
;;;;
;;;; For each model: all that holds at the first timepoint, then at each timepoint what has
;;;; changed (+Fluent(Args). and -Fluent(Args).) and which events happen, and in a section P the
;;;; other literals that are true.  Within a timepoint fluents come before events, each kind in
;;;; the order of its text.

(in-package #:discrepancy-finder.event-calculus)

(defun e-atom-text (names atom)
  "Return the text of the ground ATOM, a list, with .e NAMES."
  (with-output-to-string (stream)
    (write-expression (make-layout names nil) atom 0 t stream ", ")))

(defun sorted-lines (lines stream)
  "Print LINES in the order of what follows their signs."
  (format stream "~{~a~%~}"
          (sort lines #'string< :key (lambda (line) (string-left-trim "+-" line)))))

(defun print-timepoint (model names time before stream)
  "Print what is true in MODEL at TIME.  BEFORE is the list of the fluents that held before, or T at
the first timepoint."
  (let ((now (model-fluents model time)))
    (flet ((lines (sign atoms)
             (mapcar (lambda (atom) (format nil "~a~a." sign (e-atom-text names atom))) atoms)))
      (format stream "~d~%" time)
      (sorted-lines (if (eq before t)
                        (lines "" now)
                        (append (lines "+" (set-difference now before :test #'equal))
                                (lines "-" (set-difference before now :test #'equal))))
                    stream)
      (sorted-lines (lines "" (loop for event in (model-events model time)
                                    collect (list :happens event time)))
                    stream))
    now))

(defun timepoint-numbers (model time)
  "Return the list of (numeric-fluent . number) of MODEL at TIME."
  (loop for (name . sorts) in (theory-numeric-fluents (model-theory model))
        nconc (loop for fluent in (ground-terms (model-theory model) name sorts)
                    for number = (model-number model fluent time)
                    when number collect (cons fluent number))))

(defun print-values (model names time stream)
  "Print the numbers of MODEL at TIME that are not those of the timepoint before."
  (let ((before (if (= time (car (model-horizon model)))
                    '()
                    (timepoint-numbers model (1- time)))))
    (sorted-lines (loop for (fluent . number) in (timepoint-numbers model time)
                        unless (equal number (cdr (assoc fluent before :test #'equal)))
                          collect (format nil "~a=~a." (e-atom-text names fluent) number))
                  stream)))

(defun print-e-model (model names stream)
  (destructuring-bind (first . last) (model-horizon model)
    (loop with before = t
          for time from first to last
          do (setf before (print-timepoint model names time before stream))
             (print-values model names time stream)))
  (format stream "P~%")
  (sorted-lines (loop for literal in (model-literals model)
                      collect (format nil "~a." (e-atom-text names literal)))
                stream))

(defun print-e-models (models stream)
  "Print MODELS, a list as MODELS returns it, to STREAM: for each a line \"model N:\", for each
timepoint its number, what holds or changes and which events happen, after a line \"P\" the other
literals that are true; and at the end a line \"N models\".  Names of a theory in Lisp are printed
as WRITE-E-THEORY writes them.  Return MODELS."
  (let ((names nil))
    (loop for model in models
          for number from 1
          do (unless (and names (eq (e-names-theory names) (model-theory model)))
               (setf names (make-e-names (model-theory model))))
             (format stream "model ~d:~%" number)
             (print-e-model model names stream))
    (format stream "~d models~%" (length models))
    models))
