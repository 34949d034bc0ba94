;;;; Reading .e files: the language of Mueller's Discrete Event Calculus Reasoner.
;;;;
;;;; LOAD-E-THEORY reads a file as a THEORY; nothing in it is evaluated.  The way of a text:
;;;; tokens (tokens.lisp), statements (statements.lisp, expressions.lisp), those of the loaded
;;;; files in their places (files.lisp), what they declare (vocabulary.lisp), their formulas
;;;; (formulas.lisp), and here the theory of it all.

(in-package #:discrepancy-finder.event-calculus)

;;; Options

(defparameter *e-options*
  '("debug" "encoding" "finalstatefile" "manualrelease" "modeldiff" "renaming" "showpred" "solver"
    "timediff" "tmpfilerm" "trajectory" "weighted")
  "The options that the Discrete Event Calculus Reasoner knows.")

(defun option-value (statement key value)
  "Return the VALUE, a string, of the option KEY as it is kept in a theory.  Options that change
what a file means must have a value that has a meaning here."
  (flet ((known-p (&rest names) (member key names :test #'string=))
         (wrong (expected)
           (statement-problem statement "the value of the option ~a is ~a, not \"~a\"" key expected
                              value)))
    (let ((parsed (cond ((string= value "on") t)
                        ((string= value "off") nil)
                        ((and (plusp (length value)) (< (length value) 19)
                              (every #'decimal-digit-p value))
                         (parse-integer value))
                        (t value))))
      (cond ((and (known-p "encoding") (not (member parsed '(2 3)))) (wrong "2 or 3"))
            ((and (known-p "manualrelease" "trajectory") (stringp parsed)) (wrong "on or off"))
            ((and (known-p "weighted") parsed) (wrong "off: weighted sentences are not supported"))
            (t parsed)))))

(defun e-options (statements)
  "Return the property list of the options that STATEMENTS set, the last value of each, by name."
  (let ((options '()))
    (dolist (statement statements)
      (case (statement-kind statement)
        (:option
         (destructuring-bind (key value) (statement-data statement)
           (if (member key *e-options* :test #'string=)
               (setf (getf options (e-sort-keyword key)) (option-value statement key value))
               (warn 'e-file-warning :file (statement-file statement)
                                     :line (statement-line statement)
                                     :reason (format nil "there is no option ~a" key)))))
        (:foundation
         (let ((name (first (statement-data statement))))
           (cond ((string= name "DEC.e") (setf (getf options :dec) t))
                 ((string= name "ECTraj.e")
                  (setf (getf options :ectraj) t
                        (getf options :trajectory) t)))))))
    (loop for key in (sort (loop for key in options by #'cddr collect key) #'string<)
          append (list key (getf options key)))))

;;; Declarations

(defun e-sorts (vocabulary)
  (flet ((signature (symbol)
           (cons (e-name-keyword (declared-symbol-name symbol))
                 (mapcar #'e-sort-keyword (declared-symbol-arguments symbol)))))
    (loop for sort in (reverse (vocabulary-sorts vocabulary))
          for name = (declared-sort-name sort)
          collect (make-element-sort
                   :name (e-sort-keyword name)
                   :parents (loop for (parent) in (declared-sort-parents sort)
                                  collect (e-sort-keyword parent))
                   :range (integers-range sort)
                   :constants (mapcar #'e-name-keyword (reverse (declared-sort-constants sort)))
                   :terms (loop for symbol in (reverse (vocabulary-symbols vocabulary))
                                when (string= (declared-symbol-sort symbol) name)
                                  collect (signature symbol))))))

(defun e-symbols (vocabulary sort)
  "Return the declarations of the symbols of SORT, such as \"fluent\", for a theory."
  (loop for symbol in (reverse (vocabulary-symbols vocabulary))
        for signature = (cons (e-name-keyword (declared-symbol-name symbol))
                              (mapcar #'e-sort-keyword (declared-symbol-arguments symbol)))
        when (and (string= (declared-symbol-sort symbol) sort)
                  (not (and (string= sort "predicate")
                            (standard-predicate vocabulary (declared-symbol-name symbol)))))
          collect (let ((statement (declared-symbol-statement symbol)))
                    (note-position (if (declared-symbol-value symbol)
                                       (list signature
                                             (e-sort-keyword (declared-symbol-value symbol)))
                                       signature)
                                   (source:make-source-position (statement-file statement)
                                                                (statement-line statement))))))

(defun check-declared-symbol (vocabulary statement name &rest sorts)
  (unless (some (lambda (sort) (find-declared-symbol vocabulary name sort)) sorts)
    (statement-problem statement "there is no ~{~a~^ or ~} ~a" sorts name)))

(defun statements-of (statements &rest kinds)
  (remove-if-not (lambda (statement) (member (statement-kind statement) kinds)) statements))

(defun e-fluent-names (vocabulary statements kind)
  "Return the fluents that the statements of KIND name."
  (remove-duplicates
   (loop for statement in (statements-of statements kind)
         for (name) = (statement-data statement)
         do (check-declared-symbol vocabulary statement name "fluent")
         collect (e-name-keyword name))
   :from-end t))

(defun e-completions (vocabulary statements)
  (remove-duplicates
   (loop for statement in (statements-of statements :completion)
         for (label predicate) = (statement-data statement)
         do (unless (or (standard-predicate vocabulary predicate)
                        (find-declared-symbol vocabulary predicate "predicate"))
              (statement-problem statement "there is no predicate ~a to complete" predicate))
         collect (list (and label (e-name-keyword label))
                       (e-predicate-keyword vocabulary predicate)))
   :test #'equal :from-end t))

(defun check-one-kind (vocabulary statement)
  "Check that the names in STATEMENT are all events or all fluents."
  (destructuring-bind (first . others) (statement-data statement)
    (flet ((event-p (name) (find-declared-symbol vocabulary name "event")))
      (dolist (name others)
        (unless (eq (null (event-p first)) (null (event-p name)))
          (statement-problem statement
                             "~a is ~:[a fluent~;an event~] and ~a ~:[a fluent~;an event~]"
                             first (event-p first) name (event-p name)))))))

(defun e-exclusions (vocabulary statements)
  (loop for statement in (statements-of statements :mutex :xor)
        collect (cons (statement-kind statement)
                      (loop for name in (statement-data statement)
                            do (check-declared-symbol vocabulary statement name "event" "fluent")
                            collect (e-name-keyword name)))
        do (check-one-kind vocabulary statement)))

(defun check-e-names (vocabulary)
  "Check that no name looks like a word of theories in Lisp when it is a keyword."
  (dolist (symbol (reverse (vocabulary-symbols vocabulary)))
    (let* ((name (declared-symbol-name symbol))
           (keyword (e-name-keyword name)))
      (when (or (formula-operator-p keyword) (standard-e-name keyword))
        (statement-problem (declared-symbol-statement symbol)
                           "~a cannot be declared: it is a word of theories in Lisp" name)))))

;;; Axioms

(defun axiom-names ()
  "Return a function that returns for a file and a line a name that it has not returned before."
  (let ((counts (make-hash-table :test 'equal)))
    (lambda (file line)
      (let* ((name (format nil "~a:~d" (subseq file (1+ (or (position #\/ file :from-end t) -1)))
                           line))
             (count (incf (gethash name counts 0))))
        (e-name-keyword (if (= count 1) name (format nil "~a.~d" name count)))))))

(defun e-axioms (vocabulary statements)
  "Return the axioms that the :FORMULA statements among STATEMENTS state, without those that mention
a symbol that is to be ignored."
  (let ((ignored (loop for statement in (statements-of statements :ignore)
                       collect (first (statement-data statement))))
        (name (axiom-names)))
    (loop for statement in (statements-of statements :formula)
          for (label node) = (statement-data statement)
          for file = (statement-file statement)
          for line = (statement-line statement)
          unless (node-mentions-p node ignored)
            collect (make-axiom :name (funcall name file line)
                                :label (and label (e-name-keyword label))
                                :formula (resolve-sentence (make-resolver vocabulary file)
                                                           (node-line node line) node)
                                :position (source:make-source-position file line)))))

;;; Theories

(defun statements-theory (statements name &optional file)
  "Return the theory NAME, a keyword, that STATEMENTS describe."
  (let* ((vocabulary (collect-vocabulary statements))
         (options (e-options statements)))
    (check-e-names vocabulary)
    (make-checked-theory
     :name name :syntax :e :file file
     :extends (when (foundation-loaded-p vocabulary "ECCausal.e")
                (list (find-theory :causal-constraints)))
     :sorts (e-sorts vocabulary)
     :predicates (e-symbols vocabulary "predicate")
     :functions (e-symbols vocabulary "function")
     :fluents (e-symbols vocabulary "fluent")
     :events (e-symbols vocabulary "event")
     :non-inertial (e-fluent-names vocabulary statements :noninertial)
     :manual-release (or (getf options :manualrelease)
                         (e-fluent-names vocabulary statements :manualrelease))
     :axioms (e-axioms vocabulary statements)
     :completions (e-completions vocabulary statements)
     :exclusions (e-exclusions vocabulary statements)
     :time-range (vocabulary-time-range vocabulary)
     :offset-range (vocabulary-offset-range vocabulary)
     :options options)))

(defun parse-e-text (text &key (name "text"))
  "Return the theory that TEXT, a string in the language of .e files, describes, without
registering it.  NAME, a string or symbol, names the theory and stands for the file in errors.
Files to load are looked for from the current folder.  Signals E-FILE-ERROR and THEORY-ERROR."
  (let ((name (string name)))
    (statements-theory (expand-loads (read-statements text name) (uiop:getcwd)
                                     (make-hash-table :test 'equal))
                       (e-name-keyword name))))

(defun read-e-theory (file)
  "Return the theory that FILE, in the language of the Discrete Event Calculus Reasoner, describes,
without registering it.  Nothing is evaluated.  The theory's name is a keyword with the characters
of the file's name without its type.  Signals E-FILE-ERROR and THEORY-ERROR, which name file and
line, and warns by E-FILE-WARNING."
  (let ((path (source:native-path file))
        (name (source:native-name file)))
    (statements-theory (e-file-statements path name (make-hash-table :test 'equal))
                       (e-name-keyword (pathname-name path)) name)))

(defun load-e-theory (file)
  "Read FILE as READ-E-THEORY does, make the theory known to FIND-THEORY, and return it."
  (register-theory (read-e-theory file)))
