;;;; Theories: a description of a world in the Discrete Event Calculus, as data.
;;;;
;;;; (define-theory NAME doc (:sorts ...) (:fluents ...) (:events ...) (:axioms ...)) at the REPL,
;;;; or the same form in a file for LOAD-THEORY, which evaluates nothing.  Both go through
;;;; PARSE-THEORY.  The axioms' formulas are checked by formula.lisp.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (axiom (:copier nil))
  "A sentence of a theory; its free variables are universally quantified."
  (name nil :type symbol :read-only t)
  (formula nil :type list :read-only t)
  (position nil :type (or null source:source-position) :read-only t))

(setf (documentation 'axiom-name 'function)
      "Return the name of an axiom, a keyword."
      (documentation 'axiom-formula 'function)
      "Return the formula of an axiom, a tree of keywords.")

(defmethod print-object ((axiom axiom) stream)
  (print-unreadable-object (axiom stream :type t)
    (format stream "~a" (name-text (axiom-name axiom)))))

(defstruct (theory (:copier nil))
  "A description of a world: sorts are (name element*), fluents and events (name argument-sort*)."
  (name nil :type keyword :read-only t)
  (documentation nil :type (or null string) :read-only t)
  (sorts '() :type list :read-only t)
  (fluents '() :type list :read-only t)
  (events '() :type list :read-only t)
  (axioms '() :type list)
  (state-constraints '() :type list)
  (file nil :type (or null string) :read-only t))

(setf (documentation 'theory-name 'function)
      "Return the name of a theory, a keyword."
      (documentation 'theory-documentation 'function)
      "Return the documentation string of a theory, or NIL."
      (documentation 'theory-sorts 'function)
      "Return the sorts of a theory: a list of (name element*)."
      (documentation 'theory-fluents 'function)
      "Return the fluents of a theory: a list of (name argument-sort*)."
      (documentation 'theory-events 'function)
      "Return the events of a theory: a list of (name argument-sort*)."
      (documentation 'theory-axioms 'function)
      "Return the list of the axioms of a theory."
      (documentation 'theory-state-constraints 'function)
      "Return the list of the state constraints of a theory."
      (documentation 'theory-file 'function)
      "Return the name of the file that a theory was read from, or NIL.")

(defmethod print-object ((theory theory) stream)
  (print-unreadable-object (theory stream :type t)
    (format stream "~a: ~d sort~:p, ~d fluent~:p, ~d event~:p, ~d axiom~:p"
            (name-text (theory-name theory)) (length (theory-sorts theory))
            (length (theory-fluents theory)) (length (theory-events theory))
            (length (theory-axioms theory)))))

(defvar *theories* (make-hash-table :test 'eq)
  "The theory of each name, a keyword.")

(defun find-theory (name)
  "Return the THEORY named by the symbol NAME.  Signals THEORY-NOT-FOUND."
  (or (gethash (name-keyword name) *theories*)
      (error 'theory-not-found :name name)))

(defun sort-elements (theory sort)
  "Return the list of the elements of SORT, a symbol, in THEORY, and true; or NIL and NIL if THEORY
has no such sort."
  (let ((entry (assoc (name-keyword sort) (theory-sorts theory))))
    (values (rest entry) (and entry t))))

;;; Parsing

(defun theory-problem (theory axiom form control &rest arguments)
  "Signal a THEORY-ERROR.  THEORY is a theory or its name, AXIOM an axiom, a string or NIL."
  (error 'theory-error
         :theory (if (theory-p theory) (theory-name theory) theory)
         :axiom (if (axiom-p axiom)
                    (format nil "axiom ~a" (name-text (axiom-name axiom)))
                    axiom)
         :position (if (axiom-p axiom)
                       (axiom-position axiom)
                       (and (consp form) (source:form-position form)))
         :form form
         :reason (apply #'format nil control arguments)))

(defun normalize (form theory axiom)
  "Return FORM with every symbol made a keyword."
  (typecase form
    (null nil)
    (symbol (name-keyword form))
    (integer form)
    (cons (unless (proper-list-p form)
            (theory-problem theory axiom nil "a dotted list is no formula"))
     (mapcar (lambda (part) (normalize part theory axiom)) form))
    (t (theory-problem theory axiom nil "~s is neither a name nor a list" form))))

(defun check-declared-name (theory-name option name entry)
  (when (or (null name) (variable-p name))
    (theory-problem theory-name option entry "~a cannot be a name" (formula-text name)))
  (when (formula-operator-p name)
    (theory-problem theory-name option entry "~a is a word of the language" (name-text name))))

(defun declarations (theory-name option entries)
  "Return ENTRIES, what follows the keyword OPTION, checked to be a list of (name name*)."
  (let ((names '()))
    (dolist (entry entries (normalize entries theory-name option))
      (unless (and (consp entry) (proper-list-p entry) (every #'symbolp entry))
        (theory-problem theory-name option nil "~a was found where (name ...) was expected"
                        (formula-text entry)))
      (dolist (name entry)
        (check-declared-name theory-name option name entry))
      (when (member (name-keyword (first entry)) names)
        (theory-problem theory-name option entry "~a is declared twice" (name-text (first entry))))
      (push (name-keyword (first entry)) names))))

(defun sort-declarations (theory-name entries)
  "The same for sorts, whose elements must differ and whose names cannot end in a digit, since
variables are told apart by digits."
  (let ((sorts (declarations theory-name ":sorts" entries)))
    (loop for (name . elements) in sorts
          do (unless (= (length elements) (length (remove-duplicates elements)))
               (theory-problem theory-name ":sorts" (cons name elements) "an element stands twice"))
             (when (digit-char-p (char (symbol-name name) (1- (length (symbol-name name)))))
               (theory-problem theory-name ":sorts" (cons name elements)
                               "the name of a sort cannot end in a digit"))
             (when (eq name :time)
               (theory-problem theory-name ":sorts" (cons name elements)
                               "time is the sort of ?time")))
    sorts))

(defun parse-axiom (theory-name entry number)
  "Return the axiom written as ENTRY: a formula, or (name formula)."
  (unless (and (consp entry) (proper-list-p entry))
    (theory-problem theory-name (format nil "axiom ~d" number) (and (consp entry) entry)
                    "~a was found where a formula was expected" (formula-text entry)))
  (let ((named (and (symbolp (first entry)) (= (length entry) 2) (consp (second entry))
                    (not (formula-operator-p (first entry))))))
    (let ((name (if named
                    (name-keyword (first entry))
                    (name-keyword (make-symbol (format nil "~d" number))))))
      (make-axiom :name name
                  :formula (normalize (if named (second entry) entry) theory-name
                                      (format nil "axiom ~a" (name-text name)))
                  :position (source:form-position entry)))))

(defun check-signatures (theory)
  (loop for (option declarations) in `((":fluents" ,(theory-fluents theory))
                                       (":events" ,(theory-events theory)))
        do (loop for (name . sorts) in declarations
                 do (dolist (sort sorts)
                      (unless (nth-value 1 (sort-elements theory sort))
                        (theory-problem theory option (cons name sorts)
                                        "there is no sort ~a" (name-text sort)))))))

(defun parse-theory (name clauses &key file position)
  "Return the theory NAME that CLAUSES describe.  Signals THEORY-ERROR."
  (let* ((documentation (and (stringp (first clauses)) (pop clauses)))
         (name (name-keyword name))
         (known '(:sorts :fluents :events :axioms))
         (options '()))
    (dolist (clause clauses)
      (unless (and (consp clause) (proper-list-p clause) (symbolp (first clause))
                   (member (name-keyword (first clause)) known))
        (error 'theory-error :theory name :position (or (source:form-position clause) position)
                             :reason (format nil "~a was found where one of ~{~(~s~)~^, ~} was ~
                                                  expected"
                                             (formula-text (if (consp clause)
                                                               (first clause)
                                                               clause))
                                             known)))
      (let ((key (name-keyword (first clause))))
        (setf (getf options key) (append (getf options key) (rest clause)))))
    (let* ((theory (make-theory :name name :documentation documentation
                                :sorts (sort-declarations name (getf options :sorts))
                                :fluents (declarations name ":fluents" (getf options :fluents))
                                :events (declarations name ":events" (getf options :events))
                                :file file))
           (axioms (loop for entry in (getf options :axioms)
                         for number from 1
                         collect (parse-axiom name entry number))))
      (check-signatures theory)
      (loop for (axiom . others) on axioms
            do (check-axiom theory axiom)
               (when (find (axiom-name axiom) others :key #'axiom-name)
                 (theory-problem theory axiom nil "another axiom has the same name")))
      (setf (theory-axioms theory) axioms)
      theory)))

(defun register-theory (theory)
  (setf (gethash (theory-name theory) *theories*) theory))

(defmacro define-theory (&whole form name &body clauses)
  "Define the theory NAME.  CLAUSES are an optional documentation string and (:sorts (name
element*)*), (:fluents (name sort*)*), (:events (name sort*)*), (:axioms axiom*).  An axiom is a
formula or (name formula).  Variables are named by their sort, ?region1, and universally quantified
where free; ?time is the timepoint.  Formulas: holds-at, happens, initiates, terminates, initially,
and, or, not, implies, iff, forall, exists, =, /=.  Signals THEORY-ERROR when evaluated."
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
