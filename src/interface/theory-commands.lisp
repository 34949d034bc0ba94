;;;; The subcommands about theories: their models, and what is to be said of them.

(in-package #:discrepancy-finder)

(defun theory-file-argument (arguments command)
  "Return the theory in the file that ARGUMENTS name: `.e' files are in the language of the Discrete
Event Calculus Reasoner, others hold define-theory."
  (unless (= (length arguments) 1)
    (usage-problem "~a takes one file." command))
  (let ((file (first arguments)))
    (if (string-equal (pathname-type (source:native-path file)) "e")
        (ec:load-e-theory file)
        (ec:load-theory file))))

(defun horizon-option (theory options)
  "Return the value of --horizon in OPTIONS, which THEORY may need."
  (let ((last (getf options :horizon)))
    (unless (or last (ec:theory-time-range theory))
      (usage-problem "~@[~a: ~]theory ~(~a~) says nothing of timepoints: give the last one by ~
                      --horizon."
                     (ec:theory-file theory) (ec:theory-name theory)))
    (when (and last (minusp last))
      (usage-problem "--horizon takes a timepoint, not ~d." last))
    last))

(define-subcommand "reason" (arguments options)
    ("FILE [--all] [--horizon N]"
     "Print the models of a theory, at most 10: a .e file, or a .lisp file with define-theory."
     (("all") :type boolean :optional t :documentation "print all models")
     (("horizon") :type integer :documentation "last timepoint (the theory's own)"))
  (let* ((theory (theory-file-argument arguments "reason"))
         (limit (if (getf options :all) nil 10)))
    (multiple-value-bind (models complete)
        (telling ("looking for models")
          (ec:models theory :limit limit :horizon (horizon-option theory options)))
      (ec:print-e-models models *standard-output*)
      (unless complete
        (format *error-output* "There are more models; --all prints them.~%"))))
  0)

(define-subcommand "check-theory" (arguments options)
    ("FILE [--horizon N]"
     "Say what looks wrong in a theory: contradictions, axioms and events that do nothing."
     (("horizon") :type integer
      :documentation "last timepoint (the theory's own, or 3, or 8 if there are warnings at 3)"))
  (let* ((theory (theory-file-argument arguments "check-theory"))
         (findings (telling ("checking the theory")
                     (ec:check-theory theory :horizon (getf options :horizon)))))
    (format t "~{~a~%~}~d finding~:p in ~a~%" findings (length findings) (ec:counts-text theory))
    (if (find :note findings :key #'ec:finding-severity :test-not #'eq) 1 0)))
