;;;; The subcommand find: a search, its report on standard output, as JSON and as a page.

(in-package #:discrepancy-finder)

(defun status-code (result)
  (ecase (result-status result)
    (:certified 0)
    (:discrepancy 1)
    (:undecided 3)))

(defun store-argument (options)
  "Return the folder of the store that OPTIONS name, or NIL."
  (let ((text (getf options :store)))
    (cond ((null text) "discrepancies/")
          ((string= text "none") nil)
          ((string= text "")
           (usage-problem "--store is empty where a folder or none was expected."))
          (t text))))

(defun search-options (options)
  "Return the arguments for FIND-DISCREPANCIES that OPTIONS of the subcommand find mean."
  (append
   (loop for key in '(:constraint :rule :sampler :execution :compare :comparison :traces)
         for text = (getf options key)
         when text append (list key (keyword-argument text)))
   (loop for key in '(:seed :budget :resume)
         when (getf options key) append (list key (getf options key)))
   (loop for (key name) in '((:confidence "--confidence") (:delta "--delta")
                             (:seconds "--seconds"))
         for text = (getf options key)
         when text append (list key (number-argument text name)))
   (list :parameters (parameter-arguments (getf options :set))
         :targets (getf options :targets)
         :keep-going (getf options :keep-going)
         :store (store-argument options)
         :shrink (not (getf options :no-shrink))
         :explain (not (getf options :no-explain)))))

(defun write-result-json (result file)
  "Write RESULT as JSON to FILE, or, if that is \"-\", to standard output."
  (let ((text (json:encode (discrepancy:result-json result) :pretty t)))
    (if (string= file "-")
        (write-line text)
        (discrepancy:write-file-whole file (format nil "~a~%" text)))))

(defun check-writable (file option)
  "Signal an error if FILE, the value of OPTION, cannot be written: a search may take hours.  A pipe
or a device is left alone."
  (when (or (string= file "") (and (string= file "-") (string/= option "--json")))
    (usage-problem "~a is ~s where the name of a file was expected." option file))
  (let* ((path (source:native-path file))
         (there (ignore-errors (probe-file path))))
    (when (if there
              (member (sb-impl::native-file-kind (source:native-name there)) '(:file :directory))
              (string/= file "-"))
      (handler-case
          (progn (close (open path :direction :output :if-exists :append
                                   :if-does-not-exist :create))
                 (unless there (uiop:delete-file-if-exists path)))
        ((or stream-error file-error) ()
          (usage-problem "~a: it cannot be written." file))))))

(defun check-files (options)
  "Signal an error if a file cannot be written that OPTIONS name."
  (loop for (key name) in '((:save "--save") (:json "--json") (:report "--report"))
        when (getf options key) do (check-writable (getf options key) name)))

(defun call-complaining-of-warnings (function)
  "Call FUNCTION; its warnings are sentences on standard error, as errors are."
  (handler-bind ((warning (lambda (condition)
                            (complain condition)
                            (muffle-warning condition))))
    (funcall function)))

(defun deliver-result (result options)
  "Print RESULT, write the files that OPTIONS name, and return the exit status.  What cannot be
written is complained about, but a discrepancy is still one."
  (flet ((write-or-complain (function)
           (handler-case (progn (funcall function) t)
             (error (condition) (complain condition) nil))))
    (let ((written
            (list (or (null (getf options :save)) (null (result-discrepancy result))
                      (write-or-complain
                       (lambda ()
                         (save-discrepancy (result-discrepancy result) (getf options :save)))))
                  (or (null (getf options :json))
                      (write-or-complain
                       (lambda () (write-result-json result (getf options :json)))))
                  (or (null (getf options :report))
                      (write-or-complain
                       (lambda ()
                         (write-report result (getf options :report)
                                       :command (command-name))))))))
      (unless (equal (getf options :json) "-")
        (write-string (result-text result :command (command-name))))
      (if (or (every #'identity written) (result-discrepancy result))
          (status-code result)
          2))))

(define-subcommand "find" (arguments options)
    ("PLAN [NAME] --domain DOMAIN [OPTION ...]"
     "Search for a discrepancy along a plan: a file of plans, or a plan's name."
     (("domain") :type string :documentation "name of a domain, or its file or folder")
     (("constraint") :type string
      :documentation "name of the state constraint (the theory's only one)")
     (("confidence") :type string :documentation "confidence, between 0 and 1 (0.95)")
     (("rule") :type string
      :documentation "paper, paper-sd, prediction, zero-failure or sound (paper)")
     (("delta") :type string
      :documentation "part of the region that may stay discrepant, for the last two rules (0.05)")
     (("seed") :type integer :documentation "seed of the samples (1)")
     (("sampler") :type string
      :documentation "independent, stratified, sobol or corners (independent)")
     (("targets") :type boolean :optional t
      :documentation "draw every second sample where a discrepancy is likely")
     (("budget") :type integer :documentation "largest number of simulations (1000)")
     (("seconds") :type string :documentation "longest time in seconds (no limit)")
     (("keep-going") :type boolean :optional t
      :documentation "collect several kinds of discrepancies")
     (("set") :type string :list t :optional t
      :documentation "scene parameter, as name=number; may be repeated")
     (("execution") :type string :documentation "trace or plan (trace)")
     (("compare") :type string :documentation "final or every-step (final)")
     (("comparison") :type string
      :documentation "consistent with the theory, or exact: as in the trace (consistent)")
     (("traces") :type string
      :documentation "last: one trace a path, or every-state: one for each initial state (last)")
     (("store") :type string
      :documentation "folder of discrepancies, retried first, or none (discrepancies/)")
     (("resume") :type string
      :documentation "journal: what is in it is not simulated again, what is new is added")
     (("no-shrink") :type boolean :optional t :documentation "do not look for the smallest case")
     (("no-explain") :type boolean :optional t :documentation "do not look for reasons")
     (("save") :type string :documentation "file for the first discrepancy")
     (("json") :type string :documentation "file for the result as JSON; - is standard output")
     (("report") :type string :documentation "file for the result as an HTML page"))
  (let* ((plan (plan-argument arguments))
         (domain (domain-argument options))
         (search-options (search-options options)))
    (check-files options)
    (deliver-result (call-with-progress
                     (lambda (progress)
                       (call-complaining-of-warnings
                        (lambda ()
                          (apply #'find-discrepancies plan :domain domain :progress progress
                                 search-options)))))
                    options)))
