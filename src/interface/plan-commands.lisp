;;;; The subcommands about plans without a search: explore, verify, simulate.

(in-package #:discrepancy-finder)

(define-subcommand "explore" (arguments options)
    ("PLAN [NAME] --domain DOMAIN [OPTION ...]"
     "List the traces of a plan on which the state constraint comes true."
     (("domain") :type string :documentation "name of a domain, or its file or folder")
     (("constraint") :type string :documentation "name of the state constraint"))
  (let ((exploration (telling ("exploring the plan")
                       (explore-plan (plan-argument arguments)
                                     :domain (domain-argument options)
                                     :constraint (let ((text (getf options :constraint)))
                                                   (and text (keyword-argument text)))))))
    (describe-object exploration *standard-output*)
    (if (exploration-complete-p exploration) 0 3)))

(defun property-argument (options)
  "Return the safety property that --property or --never names."
  (let ((property (getf options :property)) (never (getf options :never)))
    (cond ((and property never)
           (usage-problem "--property and --never exclude each other."))
          (never (list :never (keyword-argument never)))
          (property (keyword-argument property))
          (t (usage-problem "A property is missing: --property or --never names it.")))))

(defun review-code (review)
  "Return the exit status of REVIEW: a verdict that is in doubt decides nothing."
  (multiple-value-bind (verdict doubtful) (discrepancy:review-verdict review)
    (ecase verdict
      (:verified (if doubtful 3 0))
      (:counterexample 1)
      (:verified-up-to-bounds 3))))

(define-subcommand "verify" (arguments options)
    ("PLAN [NAME] --domain DOMAIN --property PROPERTY | --never CONSTRAINT [OPTION ...]"
     "Say whether a plan has a safety property on all paths, in the theory."
     (("domain") :type string :documentation "name of a domain, or its file or folder")
     (("property") :type string
      :documentation "name of a state constraint that always holds, or no-failure, or no-error")
     (("never") :type string :documentation "name of a state constraint that never comes true")
     (("max-paths") :type integer :documentation "largest number of paths")
     (("store") :type string
      :documentation "folder of discrepancies that may cast doubt, or none (discrepancies/)"))
  (let ((review (telling ("verifying the plan")
                  (apply #'discrepancy:review-plan (plan-argument arguments)
                         :domain (domain-argument options)
                         :property (property-argument options)
                         :store (store-argument options)
                         (and (getf options :max-paths)
                              (list :max-paths (getf options :max-paths)))))))
    (write-string (discrepancy:review-text review))
    (review-code review)))

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
