;;;; The theory language in Lisp: define-theory forms.
;;;;
;;;; (define-theory NAME doc (:sorts ...) (:fluents ...) (:events ...) (:axioms ...) ...) at the
;;;; REPL, or the same form in a file for LOAD-THEORY, which evaluates nothing.  Both go through
;;;; PARSE-THEORY, which takes the clauses apart; MAKE-CHECKED-THEORY does the rest.

(in-package #:discrepancy-finder.event-calculus)

(defparameter *clauses*
  '(:sorts :predicates :functions :fluents :non-inertial-fluents :manual-release :events :axioms
    :numeric-fluents :facts :narrative :completion :mutex :xor :time :offset :extends)
  "The keywords that begin the clauses of a theory.")

(defun normalize (form theory axiom)
  "Return FORM with every symbol made a keyword."
  (typecase form
    (null nil)
    (symbol (name-keyword form))
    (rational form)
    (float (rationalize form))
    (cons (unless (proper-list-p form)
            (theory-problem theory axiom nil "a dotted list is no formula"))
     (mapcar (lambda (part) (normalize part theory axiom)) form))
    (t (theory-problem theory axiom nil "~s is neither a name nor a list" form))))

(defun check-declared-name (theory-name option name entry)
  (when (or (not (symbolp name)) (null name) (variable-p name))
    (theory-problem theory-name option entry "~a cannot be a name" (formula-text name)))
  (when (formula-operator-p name)
    (theory-problem theory-name option entry "~a is a word of the language" (name-text name))))

(defun symbol-declarations (theory-name option entries)
  "Return ENTRIES, what follows the keyword OPTION, checked to be a list of (name name*)."
  (dolist (entry entries (normalize entries theory-name option))
    (unless (and (consp entry) (proper-list-p entry) (every #'symbolp entry))
      (theory-problem theory-name option nil "~a was found where (name ...) was expected"
                      (formula-text entry)))
    (dolist (name entry)
      (check-declared-name theory-name option name entry))))

(defun range-of (theory-name option form numbers)
  "Return NUMBERS, a list of two integers in order, as a pair."
  (unless (and (proper-list-p numbers) (= (length numbers) 2) (every #'integerp numbers)
               (<= (first numbers) (second numbers)))
    (theory-problem theory-name option form "the lowest and the highest integer were expected"))
  (cons (first numbers) (second numbers)))

(defun sort-declaration (theory-name entry)
  "Return the sort that ENTRY, (name element-or-option*), declares."
  (flet ((problem (control &rest arguments)
           (apply #'theory-problem theory-name ":sorts" (and (consp entry) entry)
                  control arguments)))
    (unless (and (consp entry) (proper-list-p entry) (symbolp (first entry)))
      (theory-problem theory-name ":sorts" nil "~a was found where (name ...) was expected"
                      (formula-text entry)))
    (let ((parents '()) (range nil) (terms '()) (constants '()))
      (check-declared-name theory-name ":sorts" (first entry) entry)
      (dolist (part (rest entry))
        (cond ((atom part)
               (check-declared-name theory-name ":sorts" part entry)
               (push (name-keyword part) constants))
              ((not (and (proper-list-p part) (symbolp (first part))))
               (problem "~a is neither an element nor an option" (formula-text part)))
              (t (case (name-keyword (first part))
                   (:parent (setf parents (append parents (normalize (rest part) theory-name
                                                                     ":sorts"))))
                   (:range (setf range (range-of theory-name ":sorts" entry (rest part))))
                   (:terms (setf terms (append terms
                                               (symbol-declarations theory-name ":sorts"
                                                                    (rest part)))))
                   (t (problem "~a was found where an element or one of (:parent ...), (:range ~
                                ...), (:terms ...) was expected"
                               (formula-text part)))))))
      (unless (= (length constants) (length (remove-duplicates constants)))
        (problem "an element stands twice"))
      (let ((name (name-keyword (first entry))))
        (when (digit-char-p (char (symbol-name name) (1- (length (symbol-name name)))))
          (problem "the name of a sort cannot end in a digit"))
        (when (find-sort '() name)
          (problem "~a is a sort of the language" (name-text name)))
        (make-element-sort :name name :parents parents :range range :terms terms
                           :constants (nreverse constants))))))

(defun predicate-declarations (theory-name entries)
  "Return the declarations (name sort*) of the predicates ENTRIES, and a list of (name tuple*) for
those that are given as tables: ((name sort*) tuple*)."
  (let ((tables '()))
    (values
     (symbol-declarations theory-name ":predicates"
                          (loop for entry in entries
                                if (and (consp entry) (consp (first entry)))
                                  do (unless (and (proper-list-p entry)
                                                  (every #'proper-list-p (rest entry))
                                                  (symbolp (first (first entry))))
                                       (theory-problem theory-name ":predicates" entry
                                                       "((name sort ...) (element ...) ...) was ~
                                                        expected"))
                                     (push (normalize (cons (first (first entry)) (rest entry))
                                                      theory-name ":predicates")
                                           tables)
                                  and collect (first entry)
                                else collect entry))
     (nreverse tables))))

(defun function-declarations (theory-name entries)
  (dolist (entry entries (normalize entries theory-name ":functions"))
    (unless (and (consp entry) (proper-list-p entry) (= (length entry) 2) (consp (first entry))
                 (proper-list-p (first entry)) (every #'symbolp (first entry))
                 (symbolp (second entry)))
      (theory-problem theory-name ":functions" (and (consp entry) entry)
                      "~a was found where ((name sort ...) sort) was expected"
                      (formula-text entry)))
    (dolist (name (first entry))
      (check-declared-name theory-name ":functions" name entry))))

;;; Axioms

(defun axiom-entry (theory-name entry)
  "Return the name (or NIL), the label and the formula of an axiom written as ENTRY."
  (if (and (symbolp (first entry)) (consp (rest entry))
           (not (formula-operator-p (first entry))))
      (destructuring-bind (name second &optional (third nil third-p) (fourth nil fourth-p) &rest more)
          entry
        (cond ((and (not third-p) (consp second)) (values name nil second))
              ((and fourth-p (null more) (eq second :label) (symbolp third) third (consp fourth))
               (values name (name-keyword third) fourth))
              ((eq second :label)
               (theory-problem theory-name (format nil "axiom ~a" (name-text name)) entry
                               "(name :label label formula) was expected"))
              (t (values nil nil entry))))
      (values nil nil entry)))

(defun parse-axiom (theory-name entry number label)
  "Return the axiom written as ENTRY: a formula, (name formula), or (name :label label formula)."
  (unless (and (consp entry) (proper-list-p entry))
    (theory-problem theory-name (format nil "axiom ~d" number) (and (consp entry) entry)
                    "~a was found where a formula was expected" (formula-text entry)))
  (multiple-value-bind (given own-label formula) (axiom-entry theory-name entry)
    (let ((name (name-keyword (or given (make-symbol (format nil "~d" number))))))
      (make-axiom :name name :label (or own-label label)
                  :formula (normalize formula theory-name
                                      (format nil "axiom ~a" (name-text name)))
                  :position (source:form-position entry)))))

(defun parse-axioms (theory-name entries first-number label)
  (loop for entry in entries
        for number from first-number
        collect (parse-axiom theory-name entry number label)))

;;; Clauses

(defun name-lists (theory-name option entries)
  (dolist (entry entries (normalize entries theory-name option))
    (unless (and (consp entry) (proper-list-p entry) (every #'symbolp entry))
      (theory-problem theory-name option (and (consp entry) entry)
                      "a list of names was expected"))))

(defun completion-declarations (theory-name entries)
  "Return ENTRIES, predicates or (label predicate), as a list of (label predicate)."
  (loop for entry in entries
        collect (cond ((and entry (symbolp entry)) (list nil (name-keyword entry)))
                      ((and (consp entry) (proper-list-p entry) (= (length entry) 2)
                            (every #'symbolp entry))
                       (normalize entry theory-name ":completion"))
                      (t (theory-problem theory-name ":completion" (and (consp entry) entry)
                                         "a predicate or (label predicate) was expected")))))

(defun clause-options (name clauses position)
  "Return CLAUSES as a property list of keywords and all that follows them."
  (let ((options '()))
    (dolist (clause clauses options)
      (unless (and (consp clause) (proper-list-p clause) (symbolp (first clause))
                   (member (name-keyword (first clause)) *clauses*))
        (error 'theory-error :theory name :position (or (source:form-position clause) position)
                             :reason (format nil "~a was found where one of ~{~(~s~)~^, ~} was ~
                                                  expected"
                                             (formula-text (if (consp clause)
                                                               (first clause)
                                                               clause))
                                             *clauses*)))
      (let ((key (name-keyword (first clause))))
        (setf (getf options key) (append (getf options key) (rest clause)))))))

(defun parse-theory (name clauses &key file position)
  "Return the theory NAME that CLAUSES describe.  Signals THEORY-ERROR."
  (let* ((documentation (and (stringp (first clauses)) (pop clauses)))
         (name (name-keyword name))
         (options (clause-options name clauses position)))
    (flet ((option (key) (getf options key)))
      (let* ((predicates (multiple-value-list
                          (predicate-declarations name (option :predicates))))
             (non-inertial (symbol-declarations name ":non-inertial-fluents"
                                                (option :non-inertial-fluents)))
             (axioms (parse-axioms name (option :axioms) 1 nil))
             (facts (parse-axioms name (option :facts) (1+ (length axioms)) +facts+))
             (narrative (parse-axioms name (option :narrative)
                                      (+ 1 (length axioms) (length facts)) nil)))
        (make-checked-theory
         :name name :documentation documentation :file file
         :extends (mapcar #'find-theory (option :extends))
         :sorts (mapcar (lambda (entry) (sort-declaration name entry)) (option :sorts))
         :predicates (first predicates) :extensions (second predicates)
         :functions (function-declarations name (option :functions))
         :fluents (append (symbol-declarations name ":fluents" (option :fluents)) non-inertial)
         :numeric-fluents (symbol-declarations name ":numeric-fluents" (option :numeric-fluents))
         :non-inertial (mapcar #'first non-inertial)
         :manual-release (if (member t (option :manual-release))
                             t
                             (normalize (option :manual-release) name ":manual-release"))
         :events (symbol-declarations name ":events" (option :events))
         :axioms (append axioms facts narrative)
         :completions (completion-declarations name (option :completion))
         :exclusions (loop for key in '(:mutex :xor)
                           append (loop for names in (name-lists name (format nil "~(~s~)" key)
                                                                 (option key))
                                        collect (cons key names)))
         :time-range (and (option :time) (range-of name ":time" (option :time) (option :time)))
         :offset-range (and (option :offset)
                            (range-of name ":offset" (option :offset) (option :offset))))))))

(defmacro define-theory (&whole form name &body clauses)
  "Define the theory NAME.  CLAUSES are an optional documentation string and any number of
  (:sorts (name element* [(:parent sort*)] [(:range low high)] [(:terms (name sort*)*)])*),
  (:predicates (name sort*)-or-((name sort*) tuple*)*), (:functions ((name sort*) value-sort)*), (:fluents (name sort*)*),
  (:non-inertial-fluents (name sort*)*), (:numeric-fluents (name sort*)*), (:events (name sort*)*),
  (:axioms axiom*), (:facts axiom*),
  (:narrative axiom*), (:completion predicate-or-(label predicate)*), (:mutex (name*)*),
  (:xor (name*)*), (:manual-release name*), (:time first last), (:offset low high),
  (:extends theory*).
An axiom is a formula, (name formula) or (name :label label formula).  Variables are named by their
sort, ?region1, and universally quantified where free; ?time is a timepoint.  docs/theories.md has
the formulas.  Signals THEORY-ERROR when evaluated."
  `(register-theory (parse-theory ',name ',clauses :position (source:form-position ',form))))

(defun load-theory (file)
  "Read FILE, which holds one DEFINE-THEORY form and any number of DEFINE-STATE-CONSTRAINT forms,
define them, and return the theory.  Nothing in the file is evaluated.  Signals SOURCE-ERROR and
THEORY-ERROR, which name file and line."
  (let ((theory nil))
    (dolist (form (source:read-source file :package '#:discrepancy-finder.event-calculus) theory)
      (let ((operator (and (consp form) (symbolp (first form)) (name-keyword (first form)))))
        (flet ((problem (reason)
                 (error 'source:source-error
                        :file (source:native-name file) :reason reason
                        :line (let ((position (and (consp form) (source:form-position form))))
                                (and position (source:source-position-line position))))))
          (case operator
            (:define-theory
             (when theory (problem "a second theory in one file"))
             (unless (and (consp (rest form)) (symbolp (second form)) (second form))
               (problem "define-theory needs a name"))
             (setf theory (register-theory
                           (parse-theory (second form) (cddr form) :file (source:native-name file)
                                         :position (source:form-position form)))))
            (:define-state-constraint
             (unless theory (problem "a state constraint before its theory"))
             (unless (and (consp (rest form)) (symbolp (second form)))
               (problem "define-state-constraint needs a name"))
             (register-state-constraint theory (parse-state-constraint theory (rest form))))
            (t (problem (format nil "~a was found where define-theory or define-state-constraint ~
                                     was expected"
                                (formula-text (if operator (first form) form)))))))))
    (or theory
        (error 'source:source-error :file (source:native-name file)
                                    :reason "no define-theory in it"))))
