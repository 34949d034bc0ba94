;;;; Theories: a description of a world in the Discrete Event Calculus, as data.
;;;;
;;;; A THEORY is made by MAKE-CHECKED-THEORY from declarations and axioms, whatever language they
;;;; were written in: define-theory.lisp reads the one in Lisp, the folder e-files the one of the
;;;; Discrete Event Calculus Reasoner.  What does not fit together is a THEORY-PROBLEM.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (axiom (:copier nil))
  "A sentence of a theory; its free variables are universally quantified."
  (name nil :type symbol :read-only t)
  (label nil :type (or null keyword) :read-only t)
  (formula nil :type list :read-only t)
  (position nil :type (or null source:source-position) :read-only t))

(setf (documentation 'axiom-name 'function)
      "Return the name of an axiom, a keyword."
      (documentation 'axiom-label 'function)
      "Return the label of an axiom, a keyword that completion declarations may name, or NIL."
      (documentation 'axiom-formula 'function)
      "Return the formula of an axiom, a tree of keywords and integers."
      (documentation 'axiom-position 'function)
      "Return the source position of an axiom, or NIL.")

(defmethod print-object ((axiom axiom) stream)
  (print-unreadable-object (axiom stream :type t)
    (format stream "~a" (name-text (axiom-name axiom)))))

(defconstant +facts+ :|(:facts)|
  "The label of the facts of a theory in Lisp, which no .e file can write: they are never
completed.")

(defstruct (theory (:copier nil))
  "A description of a world.  Predicates, fluents and events are (name argument-sort*), functions
((name argument-sort*) value-sort)."
  (name nil :type keyword :read-only t)
  (documentation nil :type (or null string) :read-only t)
  (syntax :lisp :type (member :lisp :e) :read-only t)
  (file nil :type (or null string) :read-only t)
  (extended-files '() :type list :read-only t)
  (sorts '() :type list :read-only t)
  (predicates '() :type list :read-only t)
  (extensions '() :type list :read-only t)
  (functions '() :type list :read-only t)
  (fluents '() :type list :read-only t)
  (numeric-fluents '() :type list :read-only t)
  (non-inertial '() :type list :read-only t)
  (manual-release '() :type (or (eql t) list) :read-only t)
  (events '() :type list :read-only t)
  (axioms '() :type list :read-only t)
  (completions '() :type list :read-only t)
  (exclusions '() :type list :read-only t)
  (time-range nil :type (or null cons) :read-only t)
  (offset-range nil :type (or null cons) :read-only t)
  (options '() :type list :read-only t)
  (state-constraints '() :type list)
  (elements (make-hash-table :test 'eq) :type hash-table :read-only t)
  (element-tables (make-hash-table :test 'eq) :type hash-table :read-only t)
  (extension-tables (make-hash-table :test 'eq) :type hash-table :read-only t))

(setf (documentation 'theory-name 'function)
      "Return the name of a theory, a keyword."
      (documentation 'theory-documentation 'function)
      "Return the documentation string of a theory, or NIL."
      (documentation 'theory-syntax 'function)
      "Return the language that a theory was written in, :LISP or :E; it decides how names print."
      (documentation 'theory-file 'function)
      "Return the name of the file that a theory was read from, or NIL."
      (documentation 'theory-sorts 'function)
      "Return the list of the sorts that a theory declares."
      (documentation 'theory-predicates 'function)
      "Return the predicates of a theory: a list of (name argument-sort*)."
      (documentation 'theory-extensions 'function)
      "Return the predicates of a theory that are given as tables: a list of (name tuple*)."
      (documentation 'theory-functions 'function)
      "Return the functions of a theory: a list of ((name argument-sort*) value-sort)."
      (documentation 'theory-fluents 'function)
      "Return the fluents of a theory: a list of (name argument-sort*)."
      (documentation 'theory-numeric-fluents 'function)
      "Return the fluents of a theory that have a number as their value: a list of (name
argument-sort*)."
      (documentation 'theory-non-inertial 'function)
      "Return the names of the fluents of a theory that are not subject to inertia."
      (documentation 'theory-manual-release 'function)
      "Return the names of the fluents of a theory that may be released at the first timepoint, or T
for all."
      (documentation 'theory-events 'function)
      "Return the events of a theory: a list of (name argument-sort*)."
      (documentation 'theory-axioms 'function)
      "Return the list of the axioms of a theory."
      (documentation 'theory-completions 'function)
      "Return what is completed in a theory: a list of (label predicate), where the label is NIL for
all axioms."
      (documentation 'theory-exclusions 'function)
      "Return what excludes each other in a theory: a list of (:mutex name*) and (:xor name*)."
      (documentation 'theory-time-range 'function)
      "Return (first . last), the timepoints that a theory speaks of by default, or NIL."
      (documentation 'theory-offset-range 'function)
      "Return (lowest . highest) of the sort OFFSET of a theory, or NIL."
      (documentation 'theory-options 'function)
      "Return what a theory's file says to a reasoner, a property list."
      (documentation 'theory-state-constraints 'function)
      "Return the list of the state constraints of a theory.")

(defun theory-files (theory)
  "Return the list of the names of the files that THEORY and what it extends were read from."
  (remove nil (cons (theory-file theory) (theory-extended-files theory))))

(defun theory-counts (theory)
  "Return the size of THEORY: the list of the numbers of its sorts, predicates of its own, fluents,
events and axioms."
  (mapcar #'length (list (theory-sorts theory) (theory-predicates theory)
                         (theory-fluents theory) (theory-events theory)
                         (theory-axioms theory))))

(defun counts-text (theory)
  "Return the size of THEORY in words, such as 1 sort, 3 fluents, 3 events, 17 axioms; predicates of
its own are left out where there are none."
  (destructuring-bind (sorts predicates fluents events axioms) (theory-counts theory)
    (format nil "~d sort~:p, ~[~:;~:*~d predicate~:p, ~]~d fluent~:p, ~d event~:p, ~d axiom~:p"
            sorts predicates fluents events axioms)))

(defmethod print-object ((theory theory) stream)
  (print-unreadable-object (theory stream :type t)
    (format stream "~a: ~a" (name-text (theory-name theory)) (counts-text theory))))

(defvar *theory-file* nil
  "The path of the theory's file that is being read, or NIL: names of others are relative to it.")

(defvar *theories* (make-hash-table :test 'eq)
  "The theory of each name, a keyword.")

(defun find-theory (name)
  "Return the THEORY named by the symbol NAME.  Signals THEORY-NOT-FOUND."
  (or (and (symbolp name) (gethash (name-keyword name) *theories*))
      (error 'theory-not-found :name name)))

(defun register-theory (theory)
  "Make THEORY the one that FIND-THEORY returns for its name, and return it."
  (setf (gethash (theory-name theory) *theories*) theory))

;;; Problems

(defvar *places* (make-hash-table :test 'eq :weakness :key :synchronized t)
  "The source position of lists and sorts of a theory that were made of lists in a file.")

(defvar *place* nil
  "The source position of what is in work, for problems that have none of their own, or NIL.")

(defun place-of (thing)
  "Return the source position of THING, a list that was read or was made of one, a sort or an axiom,
or NIL."
  (cond ((axiom-p thing) (axiom-position thing))
        ((or (consp thing) (element-sort-p thing))
         (or (gethash thing *places*) (source:form-position thing)))))

(defun note-position (thing position)
  "Let PLACE-OF return POSITION for THING.  Return THING."
  (setf (gethash thing *places*) position)
  thing)

(defun note-place (thing origin)
  "Let PLACE-OF return for THING what it returns for ORIGIN, or the place in work.  Return THING."
  (let ((place (or (place-of origin) *place*)))
    (if place (note-position thing place) thing)))

(defun latest (things)
  "Return the one of THINGS that stands last in its file, or the last one."
  (flet ((line (thing)
           (let ((place (place-of thing)))
             (if place (source:source-position-line place) 0))))
    (reduce (lambda (one other) (if (> (line one) (line other)) one other)) things)))

(defmacro with-place ((thing) &body body)
  "Evaluate BODY, in which problems lie at THING unless they say better."
  `(let ((*place* (or (place-of ,thing) *place*))) ,@body))

(defvar *written-clauses* '()
  "The clauses of the theory in work as they were written, a property list.")

(defun theory-problem (theory axiom form control &rest arguments)
  "Signal a THEORY-ERROR.  THEORY is a theory or its name, AXIOM an axiom, a string or NIL."
  (let ((*exact-names* (and (theory-p theory) (eq (theory-syntax theory) :e))))
    (error 'theory-error
           :theory (if (theory-p theory) (theory-name theory) theory)
           :exact-names *exact-names*
           :axiom (if (axiom-p axiom)
                      (format nil "axiom ~a" (name-text (axiom-name axiom)))
                      axiom)
           :position (or (place-of form) (place-of axiom) *place*)
           :form form
           :reason (apply #'format nil control arguments))))

;;; Vocabulary

(defun theory-sort (theory name)
  "Return the sort of THEORY named NAME, a keyword, built-in ones included, or NIL."
  (find-sort (theory-sorts theory) name))

(defun theory-subsort-p (theory name ancestor)
  (subsort-p (theory-sorts theory) name ancestor))

(defun theory-numeric-p (theory name)
  (numeric-sort-p (theory-sorts theory) name))

(defun variable-sort (theory variable)
  "Return the name of VARIABLE's sort in THEORY: its name, or that without trailing digits."
  (let ((full (name-keyword (make-symbol (subseq (symbol-name variable) 1)))))
    (if (theory-sort theory full)
        full
        (variable-sort-name variable))))

(defun extension-table (theory name)
  "Return the table of the tuples for which the predicate NAME of THEORY is true, or NIL if the
predicate is not given as a table."
  (let ((extension (assoc name (theory-extensions theory)))
        (tables (theory-extension-tables theory)))
    (when extension
      (or (gethash name tables)
          (let ((table (make-term-table)))
            (dolist (tuple (rest extension))
              (setf (gethash tuple table) t))
            (setf (gethash name tables) table))))))

(defun find-function (theory name)
  (find name (theory-functions theory) :key #'caar))

(defun reified-symbol (theory name)
  "Return the sort whose terms the symbol NAME builds in THEORY and its declaration (name
argument-sort*), or NIL."
  (dolist (sort (theory-sorts theory))
    (let ((declaration (assoc name (sort-terms sort))))
      (when declaration
        (return (values (sort-name sort) declaration))))))

;;; Elements

(defvar *horizon* nil
  "The range (first . last) of timepoints in question, or NIL for the theory's own.")

(defconstant +most-instances+ 1000000
  "The number of elements that a sort, or instances that a fluent, an event or a term, may have.")

(defun check-size (theory name size what)
  "Check that the number SIZE of the elements or instances, WHAT, of NAME is no absurd one."
  (when (> size +most-instances+)
    (theory-problem theory nil nil "~a has ~d ~a, more than ~d" (name-text name) size what
                    +most-instances+)))

(defun sort-size (theory name)
  "Return the number of the elements of the sort named NAME in THEORY."
  (let ((range (sort-bounds theory name)))
    (if range
        (- (1+ (cdr range)) (car range))
        (length (sort-elements theory name)))))

(defun ground-terms (theory name argument-sorts)
  "Return the list of all (NAME element*)."
  (let ((tuples '(())))
    (check-size theory name
                (reduce #'* argument-sorts :key (lambda (sort) (sort-size theory sort)))
                "instances")
    (dolist (elements (loop for sort in (reverse argument-sorts)
                            collect (sort-elements theory sort)))
      (setf tuples (loop for element in elements
                         nconc (loop for tuple in tuples collect (cons element tuple)))))
    (loop for tuple in tuples collect (cons name tuple))))

(defun ground-symbols (theory declarations sort)
  "Return the ground terms of DECLARATIONS, without those that have arguments of SORT themselves."
  (loop for (name . sorts) in declarations
        unless (member sort sorts) nconc (ground-terms theory name sorts)))

(defun integers (theory name range)
  "Return the elements of the sort NAME, the integers of RANGE."
  (check-size theory name (- (1+ (cdr range)) (car range)) "elements")
  (loop for i from (car range) to (cdr range) collect i))

(defun compute-elements (theory name)
  (let ((sort (theory-sort theory name)))
    (cond ((null sort) '())
          ((sort-range sort) (integers theory name (sort-range sort)))
          ((eq name :fluent) (ground-symbols theory (theory-fluents theory) :fluent))
          ((eq name :event) (ground-symbols theory (theory-events theory) :event))
          (t (remove-duplicates
              (append (sort-constants sort)
                      (ground-symbols theory (sort-terms sort) name)
                      (loop for other in (theory-sorts theory)
                            when (member name (sort-parents other))
                              append (sort-elements theory (sort-name other))))
              :test #'equal :from-end t)))))

(defun sort-elements (theory sort)
  "Return the list of the elements of SORT, a symbol, in THEORY, and true; or NIL and NIL if THEORY
has no such sort.  Elements are keywords, integers, and lists for terms such as (:b-on :cat)."
  (let ((name (name-keyword sort)))
    (case name
      ((:time :offset)
       (let ((bounds (sort-bounds theory name)))
         (values (and bounds (integers theory name bounds)) t)))
      (t (multiple-value-bind (elements known) (gethash name (theory-elements theory))
           (cond (known (values elements t))
                 ((theory-sort theory name)
                  (values (setf (gethash name (theory-elements theory))
                                (compute-elements theory name))
                          t))
                 (t (values '() nil))))))))

(defun sort-table (theory name)
  "Return the table of the elements of the sort named NAME in THEORY, which is not one of integers."
  (let ((tables (theory-element-tables theory)))
    (or (gethash name tables)
        (let ((table (make-term-table)))
          (dolist (element (sort-elements theory name))
            (setf (gethash element table) t))
          (setf (gethash name tables) table)))))

(defun sort-bounds (theory name)
  "Return the range of the integers of the sort named NAME in THEORY, or NIL if there is none."
  (let ((horizon (or *horizon* (theory-time-range theory))))
    (case name
      (:time horizon)
      (:offset (or (theory-offset-range theory)
                   (and horizon (cons 1 (- (cdr horizon) (car horizon))))))
      (t (let ((sort (theory-sort theory name)))
           (and sort (sort-range sort)))))))

(defun element-of-sort-p (theory element sort)
  "Return true if ELEMENT, ground, belongs to the sort named SORT in THEORY."
  (if (integerp element)
      (let ((bounds (sort-bounds theory sort)))
        (if bounds
            (<= (car bounds) element (cdr bounds))
            (and (member sort '(:time :offset :integer)) t)))
      (and (gethash element (sort-table theory sort)) t)))
