;;;; The theory language in Lisp: define-theory forms.
;;;;
;;;; (define-theory NAME doc (:sorts ...) (:fluents ...) (:events ...) (:axioms ...) ...) at the
;;;; REPL, or the same form in a file for LOAD-THEORY, which evaluates nothing.  Both go through
;;;; PARSE-THEORY, which takes the clauses apart (clauses.lisp has the declarations) and leaves the
;;;; rest to MAKE-CHECKED-THEORY.

(in-package #:discrepancy-finder.event-calculus)

(defparameter *clauses*
  '(:sorts :predicates :functions :fluents :non-inertial-fluents :manual-release :events :axioms
    :numeric-fluents :facts :narrative :completion :mutex :xor :time :offset :extends :without)
  "The keywords that begin the clauses of a theory.")

;;; Axioms

(defun axiom-entry (theory-name entry unary)
  "Return the name (or NIL), the label and the formula of an axiom written as ENTRY.  UNARY are the
names of the predicates with one argument: (predicate (function term)) is no axiom with a name."
  (if (and (symbolp (first entry)) (consp (rest entry))
           (not (formula-operator-p (first entry)))
           (not (member (name-keyword (first entry)) unary)))
      (destructuring-bind (name second &optional (third nil third-p) (fourth nil fourth-p)
                           &rest more)
          entry
        (cond ((and (not third-p) (consp second)) (values name nil second t))
              ((and fourth-p (null more) (eq second :label) (symbolp third) third (consp fourth))
               (values name (name-keyword third) fourth t))
              ((eq second :label)
               (theory-problem theory-name (format nil "axiom ~a" (name-text name)) entry
                               "(name :label label formula) was expected"))
              (t (values nil nil entry nil))))
      (values nil nil entry nil)))

(defun parse-axiom (theory-name entry number label unary)
  "Return the axiom written as ENTRY: a formula, (name formula), or (name :label label formula)."
  (unless (and (consp entry) (proper-list-p entry))
    (theory-problem theory-name (format nil "axiom ~d" number) nil
                    "~a was found where a formula was expected" (written-text entry)))
  (multiple-value-bind (given own-label formula named) (axiom-entry theory-name entry unary)
    (when (and named (or (null given) (variable-p given)))
      (theory-problem theory-name (format nil "axiom ~d" number) nil "~a cannot be a name"
                      (written-text given)))
    (let ((name (name-keyword (if named given (make-symbol (format nil "~d" number))))))
      (make-axiom :name name :label (or own-label label)
                  :formula (normalize formula theory-name
                                      (format nil "axiom ~a" (name-text name)))
                  :position (place-of entry)))))

(defun parse-axioms (theory-name clauses first-number label unary)
  (let ((number (1- first-number)))
    (map-entries (lambda (entry) (parse-axiom theory-name entry (incf number) label unary))
                 clauses)))

(defun unary-predicates (own extended)
  "Return the names of the predicates with one argument among the declarations OWN and those of the
theories EXTENDED."
  (loop for (name . sorts) in (append own (mapcan (lambda (theory)
                                                    (copy-list (theory-predicates theory)))
                                                  (copy-list extended)))
        when (= (length sorts) 1) collect name))

;;; Theories

(defun clause-options (name clauses)
  "Return CLAUSES as a property list of keywords and their clauses."
  (let ((options '()))
    (dolist (clause clauses options)
      (flet ((problem (control &rest arguments)
               (apply #'theory-problem name nil nil control arguments)))
        (with-place (clause)
          (cond ((and clause (symbolp clause))
                 (problem "~a was found where a clause such as (~0@*~a ...) was expected"
                          (written-text clause)))
                ((and (consp clause) (not (proper-list-p clause)))
                 (problem "a clause such as (:fluents ...) cannot be a dotted or circular list: it ~
                           begins with ~a"
                          (written-text (first clause))))
                ((not (and (consp clause) (symbolp (first clause))
                           (member (name-keyword (first clause)) *clauses*)))
                 (problem "~a was found where one of ~{~(~s~)~^, ~} was expected"
                          (written-text (if (consp clause) (first clause) clause))
                          *clauses*)))))
      (let ((key (name-keyword (first clause))))
        (setf (getf options key) (append (getf options key) (list clause)))))))

(defun check-theory-name (name)
  (unless (and name (symbolp name))
    (theory-problem name nil nil "~a cannot be the name of a theory" (written-text name))))

(defun own-fluents (name inertial non-inertial)
  "Return the declarations of fluents INERTIAL and NON-INERTIAL in one list."
  (loop for declaration in non-inertial
        do (when (assoc (first declaration) inertial)
             (theory-problem name ":non-inertial-fluents" declaration
                             "~a is declared as an inertial fluent, too"
                             (name-text (first declaration)))))
  (append inertial non-inertial))

(defun parse-theory (name clauses &key file position)
  "Return the theory NAME that CLAUSES describe.  Signals THEORY-ERROR."
  (let ((*place* (or position *place*)))
    (check-theory-name name)
    (unless (proper-list-p clauses)
      (theory-problem name nil nil "a list of clauses was expected, no dotted or circular one"))
    (let* ((documentation (and (stringp (first clauses)) (pop clauses)))
           (name (name-keyword name))
           (options (clause-options name clauses))
           (*written-clauses* options))
      (labels ((option (key) (getf options key))
               (symbols (key) (symbol-declarations name (format nil "~(~s~)" key) (option key)))
               (range (key)
                 (when (option key)
                   (with-place ((first (option key)))
                     (range-of name (format nil "~(~s~)" key) (entries-of (option key))
                               (entries-of (option key)))))))
        (let* ((whole (extended-theories name (option :extends)))
               (without (without-names name (option :without) whole))
               (extended (mapcar (lambda (theory) (theory-without theory without)) whole))
               (predicates (multiple-value-list
                            (predicate-declarations name (option :predicates))))
               (unary (unary-predicates (first predicates) extended))
               (non-inertial (symbols :non-inertial-fluents))
               (inherited (length (inherited-axioms extended)))
               (axioms (parse-axioms name (option :axioms) (+ 1 inherited) nil unary))
               (facts (parse-axioms name (option :facts) (+ 1 inherited (length axioms)) +facts+
                                    unary))
               (narrative (parse-axioms name (option :narrative)
                                        (+ 1 inherited (length axioms) (length facts)) nil
                                        unary))
               (manual-release (name-declarations name ":manual-release"
                                                  (option :manual-release) "fluent")))
          (inherit-state-constraints
           (make-checked-theory
            :name name :documentation documentation :file file
            :extends extended
            :sorts (map-entries (lambda (entry) (sort-declaration name entry)) (option :sorts))
            :predicates (first predicates) :extensions (second predicates)
            :functions (function-declarations name (option :functions))
            :fluents (own-fluents name (symbols :fluents) non-inertial)
            :numeric-fluents (symbols :numeric-fluents)
            :non-inertial (mapcar #'first non-inertial)
            :manual-release (or (and (member :t manual-release) t) manual-release)
            :events (symbols :events)
            :axioms (append axioms facts narrative)
            :completions (completion-declarations name (option :completion))
            :exclusions (loop for key in '(:mutex :xor)
                              append (exclusion-declarations name key (option key)))
            :time-range (range :time)
            :offset-range (range :offset))
           extended))))))

(defmacro define-theory (&whole form name &body clauses)
  "Define the theory NAME.  CLAUSES are an optional documentation string and any number of
  (:sorts (name element* [(:parent sort*)] [(:range low high)] [(:terms (name sort*)*)])*),
  (:predicates (name sort*)-or-((name sort*) tuple*)*), (:functions ((name sort*) value-sort)*),
  (:fluents (name sort*)*), (:non-inertial-fluents (name sort*)*),
  (:numeric-fluents (name sort*)*), (:events (name sort*)*),
  (:axioms axiom*), (:facts axiom*), (:narrative axiom*),
  (:completion predicate-or-(label predicate)*), (:mutex (name*)*),
  (:xor (name*)*), (:manual-release name*), (:time first last), (:offset low high),
  (:extends theory-or-\"file\"*), (:without name*).
An axiom is a formula, (name formula) or (name :label label formula).  Variables are named by their
sort, ?region1, and universally quantified where free; ?time is a timepoint.  docs/theories.md has
the formulas.  Signals THEORY-ERROR when evaluated."
  `(register-theory (parse-theory ',name ',clauses :position (source:form-position ',form))))

(defun load-theory (file)
  "Read FILE, which holds one DEFINE-THEORY form and any number of DEFINE-STATE-CONSTRAINT forms,
define them, and return the theory.  Nothing in the file is evaluated.  Signals SOURCE-ERROR and
THEORY-ERROR, which name file and line."
  (let ((theory nil)
        (*theory-file* (source:native-path (source:native-name file))))
    (dolist (form (source:read-source file :package '#:discrepancy-finder.event-calculus) theory)
      (let ((operator (and (consp form) (symbolp (first form)) (name-keyword (first form))))
            (position (or (place-of form)
                          ;; (quote form), where only the form is a list in the file
                          (and (consp form) (proper-list-p form) (some #'place-of form)))))
        (flet ((problem (control &rest arguments)
                 (error 'source:source-error
                        :file (source:native-name file)
                        :reason (apply #'format nil control arguments)
                        :line (and position (source:source-position-line position)))))
          (when (and operator (not (proper-list-p form)))
            (problem "the form ~a ... is a dotted list" (name-text (first form))))
          (case operator
            (:define-theory
             (when theory (problem "a second theory in one file"))
             (unless (and (consp (rest form)) (symbolp (second form)) (second form))
               (problem "define-theory needs a name"))
             (setf theory (register-theory
                           (parse-theory (second form) (cddr form) :file (source:native-name file)
                                         :position position))))
            (:define-state-constraint
             (unless theory (problem "a state constraint before its theory"))
             (unless (and (consp (rest form)) (symbolp (second form)) (second form))
               (problem "define-state-constraint needs a name"))
             (with-place (form)
               (register-state-constraint theory (parse-state-constraint theory (rest form)))))
            (t (problem "~a was found where define-theory or define-state-constraint was expected"
                        (formula-text (if operator (first form) form))))))))
    (or theory
        (error 'source:source-error :file (source:native-name file)
                                    :reason "no define-theory in it"))))
