;;;; Refinements as text: the history, and the theory that it has led to.

(in-package #:discrepancy-finder.discrepancy)

(defun write-edit (edit stream)
  "Write what EDIT changes, a line for each part, and what its check came to."
  (loop for part in (edit-parts edit)
        do (format stream "  -> ~a~%" part))
  (format stream "     (~a)~%" (edit-verdict-text edit)))

(defun write-parting (discrepancy stream)
  "Write where theory and simulation part in DISCREPANCY, a line for each thing."
  (let* ((divergence (judgement-divergence (discrepancy-judgement discrepancy)))
         (step (nth (divergence-step divergence) (run-steps (discrepancy-run discrepancy)))))
    (format stream "step ~d of ~(~a~)~%     ~a~%" (1+ (divergence-step divergence))
            (plan:plan-name (discrepancy-plan discrepancy)) (run-step-designator step))
    (when (eq (divergence-kind divergence) :outcome)
      (format stream "     ends in ~(~a~), which the theory forbids~%" (run-step-outcome step)))
    (loop for (atom theory simulation) in (divergence-fluents divergence)
          do (format stream "     ~a is ~:[false~;true~] in the theory, ~:[false~;true~] in the ~
                             simulation~%"
                     (ec:atom-text atom) theory simulation))))

(defun refinement-step-text (step number)
  "Return what STEP, the one with NUMBER of a refinement, was about: a text of several lines."
  (let ((edit (refinement-step-edit step)))
    (with-output-to-string (stream)
      (format stream "~3d. " number)
      (write-parting (refinement-step-discrepancy step) stream)
      (if edit
          (write-edit edit stream)
          (format stream "     -> none of ~d candidate edit~:p will do~%"
                  (length (refinement-step-alternatives step)))))))

(defun learned-axioms (refinement)
  "Return the axioms of the refined theory that it did not begin with."
  (let ((old (ec:theory-axioms (symbolic:action-theory-theory
                                (refinement-initial-domain refinement)))))
    (remove-if (lambda (axiom)
                 (find axiom old :test (lambda (one other)
                                         (and (eq (ec:axiom-name one) (ec:axiom-name other))
                                              (equal (ec:axiom-formula one)
                                                     (ec:axiom-formula other))))))
               (ec:theory-axioms (symbolic:action-theory-theory
                                  (refinement-domain refinement))))))

(defun formula-conjuncts (formula)
  (cond ((eq formula t) '())
        ((eq (first formula) :and) (rest formula))
        (t (list formula))))

(defun superseded-p (old new)
  "Return true if the requirement OLD says nothing more beside the later NEW."
  (and (eq (requirement-class old) (requirement-class new))
       (eq (requirement-type old) (requirement-type new))
       (or (eq (requirement-mode new) :instead)
           (and (eq (requirement-mode old) (requirement-mode new))
                (subsetp (formula-conjuncts (requirement-formula old))
                         (formula-conjuncts (requirement-formula new)) :test #'equal)))))

(defun last-requirements (refinement)
  "Return the requirements of REFINEMENT that no later one supersedes."
  (let ((requirements '()))
    (dolist (step (refinement-steps refinement) (reverse requirements))
      (dolist (requirement (and (refinement-step-edit step)
                                (edit-requirements (refinement-step-edit step))))
        (setf requirements (cons requirement
                                 (remove-if (lambda (old) (superseded-p old requirement))
                                            requirements)))))))

(defun refinement-text (refinement)
  "Return the history of REFINEMENT, a REFINEMENT, and what the theory says in the end: a text of
several lines."
  (with-output-to-string (stream)
    (format stream "~(~a~) after ~d edit~:p and ~d simulation~:p: ~a~%"
            (refinement-status refinement) (length (refinement-steps refinement))
            (refinement-simulations refinement) (refinement-reason refinement))
    (loop for step in (refinement-steps refinement)
          for number from 1
          do (write-string (refinement-step-text step number) stream))
    (format stream "the theory in the end, beside what it began with:~%")
    (dolist (axiom (learned-axioms refinement))
      (format stream "  (~a ~a)~%" (ec:name-text (ec:axiom-name axiom))
              (ec:formula-text (ec:axiom-formula axiom))))
    (dolist (requirement (last-requirements refinement))
      (format stream "  ~a~%" (requirement-text requirement)))))
