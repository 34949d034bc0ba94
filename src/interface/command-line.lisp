;;;; The command line: one function a subcommand, options as data.
;;;;
;;;; MAIN is the toplevel of the executable.  It finds the subcommand, parses its options, and turns
;;;; what happens into an exit status: 0 certified, 1 discrepancy found, 2 error, 3 undecided.
;;;; Every error is one sentence on standard error.

(in-package #:discrepancy-finder)

(define-condition usage-error (error)
  ((message :initarg :message :reader usage-error-message
            :documentation "What is wrong, as a sentence."))
  (:report (lambda (condition stream) (write-string (usage-error-message condition) stream)))
  (:documentation "Signaled when the words of the command line are not understood."))

(defun usage-problem (control &rest arguments)
  (error 'usage-error :message (apply #'format nil control arguments)))

(defstruct (subcommand (:copier nil))
  "FUNCTION is called with the positional arguments (a list) and the options (a property list)."
  (name "" :type string :read-only t)
  (usage "" :type string :read-only t)
  (summary "" :type string :read-only t)
  (options '() :type list :read-only t)
  (function #'identity :type function :read-only t))

(defvar *subcommands* '()
  "The subcommands, in the order of their definition.")

(defmacro define-subcommand (name (arguments options) (usage summary &rest specifications)
                             &body body)
  "Define the subcommand NAME.  USAGE shows its arguments, SUMMARY says what it does,
SPECIFICATIONS are options in the notation of command-line-arguments.  BODY returns the exit
status."
  `(setf *subcommands*
         (append (remove ,name *subcommands* :key #'subcommand-name :test #'string=)
                 (list (make-subcommand :name ,name :usage ,usage :summary ,summary
                                        :options ',specifications
                                        :function (lambda (,arguments ,options)
                                                    (declare (ignorable ,arguments ,options))
                                                    ,@body))))))

;;; Values of options

(defun keyword-argument (text)
  (intern (string-upcase text) :keyword))

(defun number-argument (text name)
  "Return the number written in TEXT, the value of the option NAME."
  (let ((value (ignore-errors (json:parse text))))
    (if (realp value)
        value
        (usage-problem "~a is ~s where a number was expected." name text))))

(defun assignment (text name)
  "Return the parts of TEXT, which is written key=number."
  (let ((position (position #\= text)))
    (unless (and position (plusp position))
      (usage-problem "~a is ~s where name=number was expected." name text))
    (values (subseq text 0 position) (number-argument (subseq text (1+ position)) name))))

(defun parameter-arguments (texts)
  "Return the property list of the scene parameters in TEXTS, each name=number."
  (loop for text in texts
        append (multiple-value-bind (name value) (assignment text "--set")
                 (list (keyword-argument name) value))))

(defun state-arguments (texts)
  "Return the state for RUN-PLAN in TEXTS, each body.axis=number."
  (loop for text in texts
        collect (multiple-value-bind (name value) (assignment text "--state")
                  (let ((dot (position #\. name)))
                    (unless dot
                      (usage-problem "--state is ~s where body.axis=number was expected." text))
                    (list (keyword-argument (subseq name 0 dot))
                          (keyword-argument (subseq name (1+ dot))) value)))))

(defun lisp-file-p (text)
  (uiop:string-suffix-p text ".lisp"))

(defun plan-argument (arguments)
  "Return the symbol of the plan that ARGUMENTS name: a file and, where it defines several
top-level plans, a name; or a name."
  (destructuring-bind (&optional file name &rest more) arguments
    (cond ((null file) (usage-problem "A plan is missing."))
          (more (usage-problem "There are too many arguments: ~{~a~^ ~}." more))
          ((not (lisp-file-p file))
           (plan:plan-name (discrepancy:ensure-plan
                            (intern (string-upcase file) '#:discrepancy-finder-user))))
          (t
           (let* ((plans (plan:load-plan (or (discrepancy:locate-file file) file)))
                  (candidates (if name
                                  (remove name plans :key (lambda (plan)
                                                            (symbol-name (plan:plan-name plan)))
                                                     :test-not #'string-equal)
                                  (remove-if-not #'plan:plan-top-level-p plans))))
             (cond ((null candidates)
                    (usage-problem "~a defines no ~:[top-level plan~;plan named ~:*~a~]."
                                   file name))
                   ((rest candidates)
                    (usage-problem "~a defines several top-level plans, so name one of~
                                    ~{ ~(~a~)~^,~}." file (mapcar #'plan:plan-name candidates)))
                   (t (plan:plan-name (first candidates)))))))))

(defun domain-argument (options)
  "Return the domain that --domain names: a file, a folder with a domain.lisp, or a name."
  (let ((text (or (getf options :domain) (usage-problem "--domain is missing."))))
    (cond ((lisp-file-p text) (discrepancy:load-domain (or (discrepancy:locate-file text) text)))
          ((uiop:directory-exists-p text)
           (discrepancy:load-domain (merge-pathnames "domain.lisp"
                                                     (uiop:ensure-directory-pathname text))))
          (t (discrepancy:ensure-domain (keyword-argument text))))))

;;; Dispatch

(defun print-help (stream)
  (format stream "Usage: discrepancy-finder SUBCOMMAND [OPTION ...]~%~%")
  (dolist (subcommand *subcommands*)
    (format stream "  ~12a ~a~%" (subcommand-name subcommand) (subcommand-summary subcommand)))
  (format stream "  ~12a ~a~%  ~12a ~a~%" "test" "Run the test suites; --long adds the long ones."
          "bench" "Print the benchmarks.")
  (format stream "~%SUBCOMMAND --help shows its options; --version the version.  Exit status: 0 ~
                  certified,~%1 discrepancy found, 2 error, 3 undecided.~%"))

(defun print-subcommand-help (subcommand stream)
  (format stream "Usage: discrepancy-finder ~a ~a~%~a~%" (subcommand-name subcommand)
          (subcommand-usage subcommand) (subcommand-summary subcommand))
  (when (subcommand-options subcommand)
    (terpri stream)
    (arguments:show-option-help (subcommand-options subcommand) :stream stream)))

(defun options-first (words)
  "Return WORDS with the options, each with its value, before the other words.  Every option of the
subcommands takes a value."
  (let ((options '()) (others '()))
    (loop while words
          for word = (pop words)
          do (cond ((not (uiop:string-prefix-p "--" word)) (push word others))
                   ((find #\= word) (push word options))
                   ((null words) (usage-problem "~a needs a value." word))
                   (t (push word options) (push (pop words) options))))
    (append (nreverse options) (nreverse others))))

(defun parse-options (subcommand words)
  (handler-case (arguments:process-command-line-options (subcommand-options subcommand)
                                                        (options-first words))
    (error (condition) (usage-problem "~a" (source:condition-sentence condition)))))

(defun run-subcommand (words)
  "Run the subcommand that WORDS, the words of the command line, call for; return its status."
  (destructuring-bind (&optional (name "--help") &rest words) words
    (cond ((member name '("--help" "-h" "help") :test #'string=)
           (print-help *standard-output*)
           0)
          ((string= name "--version")
           (format t "discrepancy-finder ~a~%" (version))
           0)
          (t
           (let ((subcommand (find name *subcommands* :key #'subcommand-name :test #'string=)))
             (unless subcommand
               (usage-problem "There is no subcommand ~a; see discrepancy-finder --help." name))
             (if (member "--help" words :test #'string=)
                 (progn (print-subcommand-help subcommand *standard-output*) 0)
                 (multiple-value-bind (options arguments) (parse-options subcommand words)
                   (funcall (subcommand-function subcommand) arguments options))))))))

(defun complain (condition)
  (format *error-output* "discrepancy-finder: ~a.~%"
          (string-right-trim "." (source:condition-sentence condition))))

(defun call-with-exit-status (function)
  "Call FUNCTION, which returns an exit status; return that, or the status that an error means."
  (handler-case (funcall function)
    (sb-sys:interactive-interrupt () (format *error-output* "interrupted~%") 130)
    ;; As if the signal of the broken pipe had ended the process.
    (sb-int:broken-pipe () 141)
    (z3:solver-unknown (condition) (complain condition) 3)
    (serious-condition (condition) (complain condition) 2)))

(defun main ()
  "Run the command line of the executable and leave the process with the exit status."
  (sb-ext:disable-debugger)
  (setf *default-pathname-defaults* #p""
        *read-default-float-format* 'double-float)
  (let ((status (call-with-exit-status
                 (lambda ()
                   (foreign:open-libraries)
                   (discrepancy:use-data-directories (image-directories))
                   (prog1 (run-subcommand (rest sb-ext:*posix-argv*))
                     (finish-output))))))
    (sb-ext:exit :code status :abort t)))
