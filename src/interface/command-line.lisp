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

(defun command-name ()
  "Return how the user called the executable, for texts that tell what to type."
  (or (uiop:getenvp "DISCREPANCY_FINDER_COMMAND") "discrepancy-finder"))

;;; Values of options

(defun keyword-argument (text)
  (intern (string-upcase text) :keyword))

(defun number-argument (text name)
  "Return the number written in TEXT, the value of the option NAME."
  (let ((value (ignore-errors (json:parse (if (uiop:string-prefix-p "." text)
                                              (concatenate 'string "0" text)
                                              text)))))
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
  (let ((parameters '()))
    (dolist (text texts parameters)
      (multiple-value-bind (name value) (assignment text "--set")
        (let ((key (keyword-argument name)))
          (when (getf parameters key)
            (usage-problem "--set gives ~a twice." name))
          (setf parameters (append parameters (list key value))))))))

(defun state-arguments (texts)
  "Return the state for RUN-PLAN in TEXTS, each body.axis=number."
  (loop for text in texts
        collect (multiple-value-bind (name value) (assignment text "--state")
                  (let ((dot (position #\. name)))
                    (unless dot
                      (usage-problem "--state is ~s where body.axis=number was expected." text))
                    (list (keyword-argument (subseq name 0 dot))
                          (keyword-argument (subseq name (1+ dot))) value)))))

(defun file-argument-p (text)
  "Return true if TEXT is the name of a file and not of a plan or domain."
  (or (find #\/ text)
      (uiop:string-suffix-p (string-downcase text) ".lisp")
      (and (string/= text "") (uiop:file-exists-p (uiop:parse-native-namestring text)))))

(defun plans-named (plans name)
  "Return those of PLANS that the text NAME names."
  (remove name plans :key (lambda (plan) (symbol-name (plan:plan-name plan)))
                     :test-not #'string-equal))

(defun plan-among (plans file name)
  "Return the one of PLANS, which FILE defines, that NAME means; NIL means the only top-level one."
  (let ((candidates (if name
                        (plans-named plans name)
                        (remove-if-not #'plan:plan-top-level-p plans))))
    (cond ((null candidates)
           (usage-problem "~a defines no ~:[top-level plan~;plan named ~:*~a~]." file name))
          ((rest candidates)
           (usage-problem "~a defines several top-level plans, so name one of~{ ~(~a~)~^,~}."
                          file (mapcar #'plan:plan-name candidates)))
          (t (plan:plan-name (first candidates))))))

(defun plans-of-file (file)
  "Return the list of the plans that FILE, an argument, defines."
  (plan:load-plan (or (discrepancy:locate-file file) file)))

(defun plan-argument (arguments)
  "Return the symbol of the plan that ARGUMENTS name: a file and, where it defines several
top-level plans, a name; or a name."
  (destructuring-bind (&optional file name &rest more) arguments
    (cond ((null file) (usage-problem "A plan is missing."))
          (more (usage-problem "There are too many arguments: ~{~a~^ ~}." more))
          ((file-argument-p file)
           (plan-among (plans-of-file file) file name))
          (name (usage-problem "There is an argument too many: ~a." name))
          (t (plan:plan-name (discrepancy:ensure-plan
                              (intern (string-upcase file) '#:discrepancy-finder-user)))))))

(defun plan-arguments (arguments)
  "Return the list of the symbols of the plans that ARGUMENTS name, each as for PLAN-ARGUMENT; after
a file there may be the names of several of its plans."
  (when (null arguments)
    (usage-problem "A plan is missing."))
  (loop with rest = arguments
        for argument = (pop rest)
        append (if (file-argument-p argument)
                   (let ((plans (plans-of-file argument)))
                     (loop for name in (or (loop while (and rest (plans-named plans (first rest)))
                                                 collect (pop rest))
                                           '(nil))
                           collect (plan-among plans argument name)))
                   (list (plan-argument (list argument))))
        while rest))

(defun domain-argument (options)
  "Return the domain that --domain names: a file, a folder with a domain.lisp, or a name."
  (let* ((text (or (getf options :domain) (usage-problem "--domain is missing.")))
         (in-folder (discrepancy:locate-file (format nil "~a/domain.lisp"
                                                     (string-right-trim "/" text)))))
    (cond (in-folder (discrepancy:load-domain in-folder))
          ((file-argument-p text)
           (discrepancy:load-domain (or (discrepancy:locate-file text) text)))
          (t (discrepancy:ensure-domain (keyword-argument text))))))

;;; Dispatch

(defun print-help (stream)
  (format stream "Usage: discrepancy-finder SUBCOMMAND [OPTION ...]~%~%")
  (dolist (subcommand *subcommands*)
    (format stream "  ~12a ~a~%" (subcommand-name subcommand) (subcommand-summary subcommand)))
  (format stream "~%SUBCOMMAND --help shows its options; --version the version.  Exit status: 0 ~
                  certified,~%1 discrepancy found, 2 error, 3 undecided.~%"))

(defun print-subcommand-help (subcommand stream)
  (format stream "Usage: discrepancy-finder ~a ~a~%~a~%" (subcommand-name subcommand)
          (subcommand-usage subcommand) (subcommand-summary subcommand))
  (when (subcommand-options subcommand)
    (terpri stream)
    (arguments:show-option-help (subcommand-options subcommand) :stream stream)))

(defun option-named (word subcommand)
  "Return the specification of the option WORD of SUBCOMMAND, or NIL."
  (find (subseq word 2) (subcommand-options subcommand) :key #'caar :test #'string=))

(defun flag-p (subcommand word)
  "Return true if WORD is an option of SUBCOMMAND that takes no value."
  (let ((option (option-named word subcommand)))
    (and option (eq (getf (rest option) :type) 'boolean))))

(defun options-first (subcommand words)
  "Return WORDS with the options, each with its value, before the other words."
  (let ((options '()) (others '()))
    (loop while words
          for word = (pop words)
          do (cond ((not (uiop:string-prefix-p "--" word)) (push word others))
                   ((or (find #\= word) (flag-p subcommand word)) (push word options))
                   ((not (option-named word subcommand))
                    (usage-problem "There is no option ~a; see discrepancy-finder ~a --help."
                                   word (subcommand-name subcommand)))
                   ((null words) (usage-problem "~a needs a value." word))
                   (t (push word options) (push (pop words) options))))
    (append (nreverse options) (nreverse others))))

(defun parse-options (subcommand words)
  (handler-case (arguments:process-command-line-options (subcommand-options subcommand)
                                                        (options-first subcommand words))
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
             (if (intersection '("--help" "-h") words :test #'string=)
                 (progn (print-subcommand-help subcommand *standard-output*) 0)
                 (multiple-value-bind (options arguments) (parse-options subcommand words)
                   (funcall (subcommand-function subcommand) arguments options))))))))

(defun complain (condition)
  (format *error-output* "discrepancy-finder: ~a.~%"
          (string-right-trim "." (source:condition-sentence condition))))

(defun leave (status)
  "End the process with STATUS at once."
  (sb-ext:exit :code status :abort t))

(defun interrupted (condition)
  "End the process after C-c, without unwinding: no cleanup form of a plan has a say."
  (declare (ignore condition))
  (format *error-output* "~&interrupted~%")
  (finish-output *error-output*)
  (leave 130))

(defun call-with-exit-status (function)
  "Call FUNCTION, which returns an exit status; return that, or the status that an error means."
  (handler-case (handler-bind ((sb-sys:interactive-interrupt #'interrupted))
                  (funcall function))
    ;; As if the signal of the broken pipe had ended the process.
    (sb-int:broken-pipe () 141)
    (z3:solver-unknown (condition) (complain condition) 3)
    (serious-condition (condition) (complain condition) 2)))

(defun terminate (&rest signal)
  (declare (ignore signal))
  (leave 143))

(defun refuse-to-exit ()
  "Called when something else than MAIN ends the process: a plan, say.  It has no verdict to give."
  (ignore-errors
   (format *error-output* "discrepancy-finder: a plan or domain file ended the process.~%")
   (finish-output *error-output*))
  (leave 2))

(defun main ()
  "Run the command line of the executable and leave the process with the exit status."
  (sb-ext:disable-debugger)
  (sb-sys:enable-interrupt sb-unix:sigterm #'terminate)
  (push #'refuse-to-exit sb-ext:*exit-hooks*)
  (setf *default-pathname-defaults* #p""
        *read-default-float-format* 'double-float)
  (leave (call-with-exit-status
          (lambda ()
            (foreign:open-libraries)
            (discrepancy:use-data-directories (image-directories))
            (prog1 (run-subcommand (rest sb-ext:*posix-argv*))
              (finish-output))))))
