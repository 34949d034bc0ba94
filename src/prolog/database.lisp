;;;; The database: facts by predicate, predicates by the symbols that name them.
;;;;
;;;; A CLAUSE is a fact ready for use: its head and its goals are templates, in which SLOTs stand
;;;; for variables.  A FACT-GROUP owns the facts of one DEF-FACT-GROUP.  A PREDICATE is built in or
;;;; has the clauses of several groups; an index by number of arguments and by first argument says
;;;; which clauses may fit a goal.  Lists of clauses are never changed, so a proof that is going on
;;;; does not see what is defined meanwhile.

(in-package #:discrepancy-finder.prolog)

(defstruct (slot (:constructor make-slot (index name)) (:copier nil))
  "The place of a variable in a template: its number in the environment of a proof step."
  (index 0 :type (integer 0) :read-only t)
  (name nil :type symbol :read-only t))

(defstruct (constant (:constructor make-constant (value)) (:copier nil))
  "A list without variables in a template."
  (value nil :read-only t))

(defstruct (clause (:copier nil))
  "A fact.  PARAMETERS and GOALS are templates with SIZE slots.  ARITY is NIL if the head ends in a
variable for the other arguments.  KEY is that of the first argument, see TERM-KEY."
  (parameters nil :read-only t)
  (goals '() :type list :read-only t)
  (size 0 :type (integer 0) :read-only t)
  (arity 0 :type (or null (integer 0)) :read-only t)
  (key '%any :read-only t))

(defstruct (fact-group (:constructor make-fact-group (name number)) (:copier nil))
  "A group of facts.  NUMBER says how many groups were defined before; EXTENDABLE are the names of
the predicates that other groups may extend; PREDICATES are those that have facts of the group."
  (name nil :type symbol :read-only t)
  (number 0 :type (integer 0) :read-only t)
  (extendable '() :type list)
  (predicates '() :type list))

(defmethod print-object ((group fact-group) stream)
  (print-unreadable-object (group stream :type t)
    (format stream "~(~a~)" (fact-group-name group))))

(defstruct (predicate (:constructor make-predicate (name)) (:copier nil))
  "What is known of the name of a predicate, for all numbers of arguments.  Also a kind of
documentation: (documentation name 'predicate) returns that of the predicate NAME."
  (name nil :type symbol :read-only t)
  ;; of a predicate that is built in, see DEFINE-CONTROL
  (control nil :type (or null function))
  (lambda-list '() :type list)
  (documentation nil :type (or null string))
  ;; an alist of fact groups, in their order, and lists of clauses; replaced, never changed
  (sections '() :type list)
  ;; the sections for which it holds and an alist of numbers of arguments and buckets
  (index '() :type list))

(defmethod print-object ((predicate predicate) stream)
  (print-unreadable-object (predicate stream :type t)
    (format stream "~(~s~)" (predicate-name predicate))))

(defstruct (bucket (:constructor make-bucket (clauses table default)) (:copier nil))
  "CLAUSES: all for one number of arguments.  TABLE: which of them may fit a key, if there are many;
DEFAULT: which may fit a key that is not in TABLE."
  (clauses '() :type list :read-only t)
  (table nil :type (or null hash-table) :read-only t)
  (default '() :type list :read-only t))

(defvar *fact-groups* (make-hash-table :test 'eq :synchronized t)
  "The fact groups by name.")

(defvar *predicates* (make-hash-table :test 'eq :synchronized t)
  "The predicates by name.  A name has its predicate on its property list as well, which is
faster.")

(defvar *database-lock* (sb-thread:make-mutex :name "fact groups")
  "Held while a fact group is defined.")

(declaim (inline find-predicate))
(defun find-predicate (name)
  "Return the predicate NAME or NIL."
  (get name '%predicate))

(defun ensure-predicate (name)
  "Return the predicate NAME, a new one if there is none."
  (or (find-predicate name)
      (setf (gethash name *predicates*)
            (setf (get name '%predicate) (make-predicate name)))))

(defun extendable-p (name)
  "Return true if a fact group lists NAME as a predicate that others may extend."
  (sb-ext:with-locked-hash-table (*fact-groups*)
    (loop for group being the hash-values of *fact-groups*
            thereis (member name (fact-group-extendable group) :test #'eq))))

;;; Templates

(defun make-template (form variable-slot)
  "Return FORM as a template.  VARIABLE-SLOT is a function that returns the slot of a variable."
  (cond ((is-unnamed-var form) '%anything)
        ((is-var form) (funcall variable-slot form))
        ((atom form) form)
        ((not (some-leaf #'is-var form)) (make-constant form))
        (t (cons (make-template (car form) variable-slot)
                 (make-template (cdr form) variable-slot)))))

(defun term-key (term)
  "Return an object by which the index finds clauses whose first argument may unify with TERM, or
%ANY if all may.  Different keys never unify."
  (let ((target (deref term)))
    (typecase target
      (symbol target)
      (cons '%cons)
      (rational target)
      (float (if (or (sb-ext:float-infinity-p target) (sb-ext:float-nan-p target))
                 '%any
                 (rational target)))
      ((or character string) target)
      (t '%any))))

(defun template-key (template)
  (typecase template
    ((or slot (eql %anything)) '%any)
    (constant '%cons)
    (t (term-key template))))

(declaim (inline keys-fit-p))
(defun keys-fit-p (key other)
  (or (eql key other) (eq key '%any) (eq other '%any)
      (and (stringp key) (stringp other) (string= key other))))

(defun make-fact (head goals)
  "Return the clause for the fact HEAD if GOALS."
  (let ((slots '()))
    (flet ((slot (variable)
             (or (find variable slots :key #'slot-name)
                 (first (push (make-slot (length slots) variable) slots)))))
      (let* ((parameters (make-template (rest head) #'slot))
             (goals (loop for goal in goals collect (make-template goal #'slot)))
             (first-parameter (if (consp (rest head))
                                  (make-template (second head) #'slot)
                                  '%anything)))
        (make-clause :parameters parameters :goals goals :size (length slots)
                     :arity (if (null (cdr (last head))) (length (rest head)) nil)
                     :key (template-key first-parameter))))))

;;; The index

(defparameter *small-bucket* 8
  "A predicate with at most this many clauses needs no table.")

(defun index-table (clauses)
  "Return a table that has for each key of CLAUSES the list of those that may fit it, and the list
of those that fit any key."
  (let ((table (make-hash-table :test 'equal))
        (default '()))
    (dolist (clause (reverse clauses))
      (let ((key (clause-key clause)))
        (cond ((eq key '%any)
               (push clause default)
               (loop for each being the hash-keys of table
                     do (push clause (gethash each table))))
              (t (setf (gethash key table)
                       (cons clause (gethash key table default)))))))
    (values table default)))

(defun clauses-bucket (clauses)
  (multiple-value-bind (table default)
      (if (> (length clauses) *small-bucket*)
          (index-table clauses)
          (values nil clauses))
    (make-bucket clauses table default)))

(defun predicate-bucket (predicate arity)
  "Return the bucket of PREDICATE for ARITY arguments."
  (let* ((sections (predicate-sections predicate))
         (index (predicate-index predicate))
         (buckets (and (eq (car index) sections) (cdr index))))
    (or (cdr (assoc arity buckets))
        (let ((bucket (clauses-bucket
                       (loop for (nil . clauses) in sections
                             append (remove-if-not (lambda (clause)
                                                     (member (clause-arity clause)
                                                             (list nil arity)))
                                                   clauses)))))
          (setf (predicate-index predicate) (list* sections (acons arity bucket buckets)))
          bucket))))

(defun candidates (bucket key)
  "Return the clauses of BUCKET that may fit KEY, and possibly others."
  (if (and (bucket-table bucket) (not (eq key '%any)))
      (gethash key (bucket-table bucket) (bucket-default bucket))
      (bucket-clauses bucket)))

;;; Fact groups

(defun ensure-fact-group (name)
  (or (gethash name *fact-groups*)
      (setf (gethash name *fact-groups*)
            (make-fact-group name (hash-table-count *fact-groups*)))))

(defun set-section (predicate group clauses)
  "Make CLAUSES the ones that PREDICATE has of GROUP."
  (let ((others (remove group (predicate-sections predicate) :key #'car)))
    (setf (predicate-sections predicate)
          (if clauses
              (merge 'list (list (cons group clauses)) others #'<
                     :key (lambda (section) (fact-group-number (car section))))
              others))))

(defun warn-unless-extendable (predicate group)
  "Warn if PREDICATE, to which GROUP adds clauses, is defined elsewhere and not extendable."
  (let ((other (find group (mapcar #'car (predicate-sections predicate)) :test-not #'eq))
        (name (predicate-name predicate)))
    (when (or (predicate-control predicate)
              (and other (not (extendable-p name))))
      (warn 'predicate-not-extendable
            :predicate name :group (fact-group-name group)
            :other (if (predicate-control predicate) nil (fact-group-name other))))))

(defun define-fact-group (name extendable facts)
  "Make the clauses for FACTS, a list of (head goal*), the facts of the group NAME, in the place of
those that it had.  EXTENDABLE are the names of the predicates that other groups may extend."
  (let ((sections '())
        (group nil))
    (dolist (fact facts)
      (push (make-fact (first fact) (rest fact))
            (getf sections (first (first fact)))))
    (sb-thread:with-recursive-lock (*database-lock*)
      (setf group (ensure-fact-group name)
            (fact-group-extendable group) extendable)
      (let ((predicates (loop for (functor nil) on sections by #'cddr
                              collect (ensure-predicate functor))))
        (dolist (predicate (set-difference (fact-group-predicates group) predicates))
          (set-section predicate group '()))
        (setf (fact-group-predicates group) predicates)
        (dolist (predicate predicates)
          (set-section predicate group
                       (reverse (getf sections (predicate-name predicate)))))))
    (dolist (predicate (reverse (fact-group-predicates group)) name)
      (warn-unless-extendable predicate group))))
