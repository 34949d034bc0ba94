;;;; The subcommands about discrepancies: replay a stored one, say why it is one, make it smaller;
;;;; and refine a theory by those that are found.

(in-package #:discrepancy-finder)

(defun file-argument (arguments command)
  "Return the only one of ARGUMENTS, the file of COMMAND."
  (unless (= (length arguments) 1)
    (usage-problem "~a takes one file." command))
  (first arguments))

(defun verdict-code (result)
  "Return the exit status that a REPLAY-RESULT means."
  (ecase (replay-verdict result)
    (:discrepancy 1)
    (:consistent 0)
    ((:left-trace :invalid) 3)))

(define-subcommand "replay" (arguments options)
    ("FILE [--step]"
     "Run a stored discrepancy again, theory and simulation side by side."
     (("step") :type boolean :optional t
      :documentation "stop after each action: Enter goes on, c goes on to the end"))
  (let* ((step (getf options :step))
         (*query-io* (if step
                         (make-two-way-stream *standard-input* *standard-output*)
                         *query-io*))
         (file (file-argument arguments "replay"))
         (result (if step
                     (replay file :step t)
                     (telling ("replaying") (replay file)))))
    (write-string (replay-text result :steps (not step)))
    (verdict-code result)))

(defun call-with-replayed (function arguments command)
  "Replay the file that ARGUMENTS name.  If the discrepancy shows again, call FUNCTION with it and
print the text that it returns, else the replay.  Return the exit status."
  (let* ((result (telling ("replaying") (replay (file-argument arguments command))))
         (discrepancy (discrepancy:replay-discrepancy result)))
    (write-string (if discrepancy
                      (funcall function discrepancy)
                      (replay-text result)))
    (verdict-code result)))

(define-subcommand "explain" (arguments options)
    ("FILE [--runs N]"
     "Say why a stored discrepancy is one, and what to do about it."
     (("runs") :type integer :documentation "largest number of simulations (30)"))
  (call-with-replayed
   (lambda (discrepancy)
     (let ((explanation (telling ("explaining")
                          (discrepancy:explain-discrepancy
                           discrepancy :max-runs (or (getf options :runs) 30)))))
       (concatenate 'string (discrepancy-text discrepancy :command (command-name))
                    (discrepancy:explanation-text explanation))))
   arguments "explain"))

(define-subcommand "shrink" (arguments options)
    ("FILE [--runs N] [--seconds S] [--save FILE]"
     "Look for the smallest case of a stored discrepancy."
     (("runs") :type integer :documentation "largest number of simulations (300)")
     (("seconds") :type string :documentation "longest time in seconds (60)")
     (("save") :type string :documentation "file for the smallest case"))
  (call-with-replayed
   (lambda (discrepancy)
     (let* ((seconds (if (getf options :seconds)
                         (number-argument (getf options :seconds) "--seconds")
                         60))
            (shrinking (telling ("shrinking")
                         (discrepancy:shrink-discrepancy discrepancy
                                                         :max-runs (or (getf options :runs) 300)
                                                         :max-seconds seconds))))
       (when (getf options :save)
         (save-discrepancy (discrepancy:shrinking-discrepancy shrinking) (getf options :save)))
       (discrepancy:shrinking-text shrinking :command (command-name))))
   arguments "shrink"))

(define-subcommand "refine" (arguments options)
    ("PLAN [NAME ...] ... --domain DOMAIN [OPTION ...]"
     "Find discrepancies and apply the best edit until none is found."
     (("domain") :type string :documentation "name of a domain, or its file or folder")
     (("constraint") :type string :documentation "name of the state constraint (any-action)")
     (("edits") :type integer :documentation "largest number of edits (50)")
     (("seed") :type integer :documentation "seed of the samples (1)")
     (("set") :type string :list t :optional t
      :documentation "scene parameter, as name=number; may be repeated"))
  (let* ((plans (plan-arguments arguments))
         (domain (domain-argument options))
         (edits 0)
         (arguments (append (loop for key in '(:edits :seed)
                                  when (getf options key)
                                    append (list key (getf options key)))
                            (and (getf options :constraint)
                                 (list :constraint
                                       (keyword-argument (getf options :constraint))))))
         (refinement (telling ((lambda () (format nil "refining, ~d edit~:p" edits)))
                       (apply #'refine-theory plans
                              :domain domain
                              :parameters (parameter-arguments (getf options :set))
                              :progress (lambda (step) (declare (ignore step)) (incf edits))
                              arguments))))
    (write-string (discrepancy:refinement-text refinement))
    (ecase (discrepancy:refinement-status refinement)
      (:refined 0)
      (:undecided 3))))
