;;;; For the subcommand simulate: a plan run concretely, in a domain or in a scene alone, with
;;;; pictures.

(in-package #:discrepancy-finder)

(defun fidelity-argument (options)
  (let ((text (getf options :fidelity)))
    (cond ((null text) :fast)
          ((string-equal text "full") :full)
          ((string-equal text "fast") :fast)
          (t (usage-problem "--fidelity is ~s where full or fast was expected." text)))))

(defun scene-argument (options)
  "Return the name of the file of the scene that --scene names: a file, or a folder with a
scene.lisp."
  (let ((text (getf options :scene)))
    (when (getf options :domain)
      (usage-problem "--scene and --domain exclude each other: a domain has a scene."))
    (or (discrepancy:locate-file (format nil "~a/scene.lisp" (string-right-trim "/" text)))
        (discrepancy:locate-file text)
        (usage-problem "There is no scene ~a: --scene takes a file, or a folder with a scene.lisp."
                       text))))

(defun simulate-plan (plan options recorder)
  "Run PLAN as OPTIONS say; return the run.  RECORDER, or NIL, records frames."
  (apply (if (getf options :scene) #'discrepancy:run-in-scene #'run-plan)
         plan
         (append (and (getf options :scene) (list (scene-argument options)))
                 (and (null (getf options :scene)) (list :domain (domain-argument options)))
                 (list :state (state-arguments (getf options :state))
                       :parameters (parameter-arguments (getf options :set))
                       :seed (getf options :seed)
                       :fidelity (fidelity-argument options)
                       :observer (and recorder (projection:frame-observer recorder))))))

(defun print-simulation (run)
  "Print RUN and return the exit status."
  (multiple-value-bind (text ending)
      (if (typep run 'discrepancy:scene-run)
          (values (discrepancy:scene-run-text run) (discrepancy:scene-run-ending run))
          (values (discrepancy:run-text run) (discrepancy:run-ending run)))
    (write-string text)
    (if (eq ending :finished) 0 3)))
