;;;; The declarations among the clauses of a define-theory form, taken apart.
;;;;
;;;; A clause is (keyword entry*), and its entries are checked one by one: what is wrong with one is
;;;; a THEORY-ERROR at the line of the entry, or else of the clause.  See define-theory.lisp.

(in-package #:discrepancy-finder.event-calculus)

(defconstant +deepest-form+ 6000
  "The number of levels in which a formula may be nested.")

(defun written-text (form)
  "Return the text of FORM, which a user wrote."
  (formula-text form t))

(defun normalize (form theory axiom &optional around (depth 0))
  "Return FORM, in the form AROUND, with every symbol made a keyword."
  (flet ((problem (blamed control &rest arguments)
           (apply #'theory-problem theory axiom blamed control arguments)))
    (typecase form
      (null nil)
      (symbol (name-keyword form))
      (rational form)
      (float (when (or (sb-ext:float-infinity-p form) (sb-ext:float-nan-p form))
               (problem nil "infinity is no number"))
       (rationalize form))
      (cons (cond ((>= depth +deepest-form+)
                   (with-place (form)
                     (problem nil "it is nested too deeply, in more than ~d levels"
                            +deepest-form+)))
                  ((circular-list-p form) (problem nil "a circular list is no formula"))
                  ((not (proper-list-p form)) (problem form "a dotted list is no formula")))
       (note-place (mapcar (lambda (part) (normalize part theory axiom form (1+ depth))) form)
                   form))
      (t (problem around "~s is neither a name nor a list" form)))))

(defun map-entries (function clauses)
  "Return the list of what FUNCTION returns for each entry of CLAUSES."
  (loop for clause in clauses
        append (with-place (clause)
                 (loop for entry in (rest clause)
                       collect (with-place (entry) (funcall function entry))))))

(defun entries-of (clauses)
  (loop for clause in clauses append (rest clause)))

(defun check-declared-name (theory-name option name entry)
  (when (or (not (symbolp name)) (null name) (variable-p name))
    (theory-problem theory-name option entry "~a cannot be a name" (written-text name)))
  (when (formula-operator-p name)
    (theory-problem theory-name option entry "~a is a word of the language" (name-text name))))

;;; Fluents, events, predicates, functions

(defun symbol-declaration (theory-name option entry)
  "Return ENTRY, checked to be (name name*), what follows the keyword OPTION."
  (unless (and (consp entry) (proper-list-p entry) (every #'symbolp entry))
    (theory-problem theory-name option nil "~a was found where (name ...) was expected"
                    (written-text entry)))
  (dolist (name entry)
    (check-declared-name theory-name option name entry))
  (normalize entry theory-name option))

(defun check-distinct (theory-name option declarations)
  "Check that none of DECLARATIONS, (name ...), has the name of another.  Return them."
  (let ((names (make-hash-table :test 'eq)))
    (dolist (declaration declarations declarations)
      (when (gethash (first declaration) names)
        (theory-problem theory-name option declaration "~a is declared twice"
                        (name-text (first declaration))))
      (setf (gethash (first declaration) names) t))))

(defun symbol-declarations (theory-name option clauses)
  (check-distinct theory-name option
                  (map-entries (lambda (entry) (symbol-declaration theory-name option entry))
                               clauses)))

(defun predicate-declarations (theory-name clauses)
  "Return the declarations (name sort*) of predicates, and a list of (name tuple*) for those that
are given as tables: ((name sort*) tuple*)."
  (let ((tables '()))
    (flet ((declaration (entry)
             (cond ((and (consp entry) (consp (first entry)))
                    (unless (and (proper-list-p entry) (every #'proper-list-p (rest entry))
                                 (symbolp (first (first entry))))
                      (theory-problem theory-name ":predicates" entry
                                      "((name sort ...) (element ...) ...) was expected"))
                    (push (normalize (cons (first (first entry)) (rest entry)) theory-name
                                     ":predicates")
                          tables)
                    (symbol-declaration theory-name ":predicates" (first entry)))
                   (t (symbol-declaration theory-name ":predicates" entry)))))
      (values (check-distinct theory-name ":predicates" (map-entries #'declaration clauses))
              (nreverse tables)))))

(defun function-declarations (theory-name clauses)
  (map-entries
   (lambda (entry)
     (unless (and (consp entry) (proper-list-p entry) (= (length entry) 2) (consp (first entry))
                  (proper-list-p (first entry)) (every #'symbolp (first entry))
                  (symbolp (second entry)))
       (theory-problem theory-name ":functions" nil
                       "~a was found where ((name sort ...) sort) was expected"
                       (written-text entry)))
     (dolist (name (cons (second entry) (first entry)))
       (check-declared-name theory-name ":functions" name entry))
     (normalize entry theory-name ":functions"))
   clauses))

;;; Sorts

(defun range-of (theory-name option form numbers)
  "Return NUMBERS, a list of two integers in order, as a pair."
  (unless (and (proper-list-p numbers) (= (length numbers) 2) (every #'integerp numbers)
               (<= (first numbers) (second numbers)))
    (theory-problem theory-name option form "the lowest and the highest integer were expected"))
  (cons (first numbers) (second numbers)))

(defun check-sort-parts (problem parents range constants terms)
  "Check that the parts of a sort go together; call PROBLEM with what is wrong."
  (flet ((problem (control &rest arguments)
           (apply (the function problem) control arguments)))
    (dolist (parent parents)
      (when (and (find-sort '() parent) (not (and (eq parent :integer) range)))
        (problem "~a cannot be a parent" (name-text parent))))
    (when (and range (or constants terms))
      (problem "a sort with a range has no elements but its integers"))
    (unless (= (length constants) (length (remove-duplicates constants)))
      (problem "an element stands twice"))))

(defun sort-declaration (theory-name entry)
  "Return the sort that ENTRY, (name element-or-option*), declares."
  (flet ((problem (control &rest arguments)
           (apply #'theory-problem theory-name ":sorts" (and (consp entry) entry)
                  control arguments)))
    (unless (and (consp entry) (proper-list-p entry) (symbolp (first entry)))
      (theory-problem theory-name ":sorts" nil "~a was found where (name ...) was expected"
                      (written-text entry)))
    (let ((parents '()) (range nil) (terms '()) (constants '()))
      (check-declared-name theory-name ":sorts" (first entry) entry)
      (dolist (part (rest entry))
        (cond ((atom part)
               (check-declared-name theory-name ":sorts" part entry)
               (push (name-keyword part) constants))
              ((not (and (proper-list-p part) (symbolp (first part))))
               (problem "~a is neither an element nor an option" (written-text part)))
              (t (case (name-keyword (first part))
                   (:parent
                    (dolist (parent (rest part))
                      (check-declared-name theory-name ":sorts" parent entry))
                    (setf parents (append parents (normalize (rest part) theory-name ":sorts"))))
                   (:range
                    (when range (problem "a sort has one range"))
                    (setf range (range-of theory-name ":sorts" entry (rest part))))
                   (:terms (setf terms (append terms
                                               (symbol-declarations theory-name ":sorts"
                                                                    (list part)))))
                   (t (problem "~a was found where an element or one of (:parent ...), (:range ~
                                ...), (:terms ...) was expected"
                               (written-text part)))))))
      (check-sort-parts #'problem parents range constants terms)
      (let ((name (name-keyword (first entry))))
        (when (digit-char-p (char (symbol-name name) (1- (length (symbol-name name)))))
          (problem "the name of a sort cannot end in a digit"))
        (when (find-sort '() name)
          (problem "~a is a sort of the language" (name-text name)))
        (note-place (make-element-sort :name name :parents parents :range range :terms terms
                                       :constants (nreverse constants))
                    entry)))))

;;; Names of what is declared

(defun name-declarations (theory-name option clauses kind)
  "Return the names that the entries of CLAUSES are, of things of KIND, such as \"fluent\"."
  (map-entries (lambda (entry)
                 (unless (and entry (symbolp entry))
                   (theory-problem theory-name option nil
                                   "~a was found where the name of a ~a was expected"
                                   (written-text entry) kind))
                 (name-keyword entry))
               clauses))

(defun exclusion-declarations (theory-name key clauses)
  "Return the entries of CLAUSES, lists of names, as a list of (KEY name*)."
  (let ((option (format nil "~(~s~)" key)))
    (map-entries (lambda (entry)
                   (unless (and (consp entry) (proper-list-p entry) (every #'symbolp entry)
                                (not (member nil entry)))
                     (theory-problem theory-name option nil
                                     "~a was found where a list of names was expected"
                                     (written-text entry)))
                   (note-place (cons key (normalize entry theory-name option)) entry))
                 clauses)))

(defun completion-declarations (theory-name clauses)
  "Return the entries of CLAUSES, predicates or (label predicate), as a list of (label predicate)."
  (map-entries (lambda (entry)
                 (cond ((and entry (symbolp entry))
                        (note-place (list nil (name-keyword entry)) entry))
                       ((and (consp entry) (proper-list-p entry) (= (length entry) 2)
                             (every #'symbolp entry) (second entry))
                        (normalize entry theory-name ":completion"))
                       (t (theory-problem theory-name ":completion" nil
                                          "~a was found where a predicate or (label predicate) ~
                                           was expected"
                                          (written-text entry)))))
               clauses))
