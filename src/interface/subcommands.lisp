;;;; The subcommands of the executable.

(in-package #:discrepancy-finder)

(defun command-name ()
  "Return how the user called the executable, for texts that tell what to type."
  (or (uiop:getenvp "DISCREPANCY_FINDER_COMMAND") "discrepancy-finder"))

(defun status-code (result)
  (ecase (result-status result)
    (:certified 0)
    (:discrepancy 1)
    (:undecided 3)))

(define-subcommand "demo" (arguments options)
    (""
     "Run both variants of the paper's Example 1."
     (("seed") :type integer :documentation "seed of the samples (1)"))
  (when arguments
    (usage-problem "demo takes no arguments."))
  (demo :seed (or (getf options :seed) 1) :command (command-name))
  0)

(define-subcommand "find" (arguments options)
    ("PLAN [NAME] --domain DOMAIN [OPTION ...]"
     "Search for a discrepancy along a plan: a file of plans, or a plan's name."
     (("domain") :type string :documentation "name of a domain, or its file or folder")
     (("constraint") :type string :documentation "name of the state constraint")
     (("confidence") :type string :documentation "confidence, between 0 and 1 (0.95)")
     (("rule") :type string
      :documentation "paper, paper-sd, prediction, zero-failure or sound (paper)")
     (("delta") :type string
      :documentation "part of the region that may stay discrepant, for the last two rules (0.05)")
     (("seed") :type integer :documentation "seed of the samples (1)")
     (("sampler") :type string
      :documentation "independent, stratified, sobol or corners (independent)")
     (("budget") :type integer :documentation "largest number of simulations (1000)")
     (("set") :type string :list t :optional t
      :documentation "scene parameter, as name=number; may be repeated")
     (("execution") :type string :documentation "trace or plan (trace)")
     (("compare") :type string :documentation "final or every-step (final)")
     (("save") :type string :documentation "file for the discrepancy"))
  (let ((result (apply #'find-discrepancies (plan-argument arguments)
                       :domain (domain-argument options)
                       :parameters (parameter-arguments (getf options :set))
                       (append
                        (loop for (key name) in '((:constraint "--constraint") (:rule "--rule")
                                                  (:sampler "--sampler")
                                                  (:execution "--execution")
                                                  (:compare "--compare"))
                              for text = (getf options key)
                              when text append (list key (keyword-argument text)))
                        (loop for key in '(:seed :budget)
                              when (getf options key) append (list key (getf options key)))
                        (loop for (key name) in '((:confidence "--confidence")
                                                  (:delta "--delta"))
                              for text = (getf options key)
                              when text append (list key (number-argument text name)))))))
    ;; A discrepancy that cannot be saved is still one.
    (when (result-discrepancy result)
      (handler-case (save-discrepancy (result-discrepancy result) (getf options :save))
        (error (condition) (complain condition))))
    (write-string (result-text result :command (command-name)))
    (status-code result)))

(define-subcommand "explore" (arguments options)
    ("PLAN [NAME] --domain DOMAIN [OPTION ...]"
     "List the traces of a plan on which the state constraint comes true."
     (("domain") :type string :documentation "name of a domain, or its file or folder")
     (("constraint") :type string :documentation "name of the state constraint"))
  (let ((exploration (explore-plan (plan-argument arguments)
                                   :domain (domain-argument options)
                                   :constraint (let ((text (getf options :constraint)))
                                                 (and text (keyword-argument text))))))
    (describe-object exploration *standard-output*)
    (if (exploration-complete-p exploration) 0 3)))

(define-subcommand "simulate" (arguments options)
    ("PLAN [NAME] --domain DOMAIN | --scene SCENE [OPTION ...]"
     "Run a plan concretely, from a given state."
     (("domain") :type string :documentation "name of a domain, or its file or folder")
     (("scene") :type string
      :documentation "file or folder of a scene, to run in without a domain")
     (("state") :type string :list t :optional t
      :documentation "coordinate of a body, as body.axis=number; may be repeated")
     (("set") :type string :list t :optional t
      :documentation "scene parameter, as name=number; may be repeated")
     (("seed") :type integer
      :documentation "draw the scene's tolerances by it (none: the middles of their ranges)")
     (("fidelity") :type string
      :documentation "full, which steps everything, or fast (fast)")
     (("frames") :type string
      :documentation "folder for pictures, before and after each performed designator"))
  (let* ((plan (plan-argument arguments))
         (recorder (and (getf options :frames)
                        (projection:make-frame-recorder (getf options :frames)))))
    (prog1 (print-simulation (unwind-protect (simulate-plan plan options recorder)
                               (when recorder
                                 (projection:abandon-frames recorder))))
      (when recorder
        (format t "~d frames, two pictures each, in ~a~%" (projection:finish-frames recorder)
                (getf options :frames))))))

(define-subcommand "replay" (arguments options)
    ("FILE"
     "Run a stored discrepancy again, and say whether it comes out the same.")
  (unless (= (length arguments) 1)
    (usage-problem "replay takes one file."))
  (let ((result (replay (first arguments))))
    (write-string (replay-text result))
    (ecase (replay-verdict result)
      (:discrepancy 1)
      (:consistent 0)
      ((:left-trace :invalid) 3))))

;;; The script runs these two itself, from the sources, where it understands what follows them.

(define-subcommand "test" (arguments options)
    ("[--long]"
     "Run the test suites; --long adds the long ones.")
  (usage-problem "test is run by the script discrepancy-finder, with --long or nothing after it."))

(define-subcommand "bench" (arguments options)
    (""
     "Print the benchmarks.")
  (usage-problem "bench is run by the script discrepancy-finder, with nothing after it."))
