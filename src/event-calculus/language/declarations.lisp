;;;; Declarations: how the parts of a theory fit together, and the making of a theory from them.
;;;;
;;;; Entry point: MAKE-CHECKED-THEORY.

(in-package #:discrepancy-finder.event-calculus)

(defun check-argument-sorts (theory option declaration sorts)
  (dolist (sort sorts)
    (cond ((not (theory-sort theory sort))
           (theory-problem theory option declaration "there is no sort ~a" (name-text sort)))
          ((and (eq sort :integer) (not (equal option ":functions")))
           (theory-problem theory option declaration
                           "the sort integer has no range: declare a sort with (:range low ~
                            high)")))))

(defun declarations-by-kind (theory)
  "Return a list of (option kind declaration*)."
  `((":predicates" "a predicate" ,@(theory-predicates theory))
    (":functions" "a function" ,@(mapcar #'first (theory-functions theory)))
    (":fluents" "a fluent" ,@(theory-fluents theory))
    (":numeric-fluents" "a numeric fluent" ,@(theory-numeric-fluents theory))
    (":events" "an event" ,@(theory-events theory))
    (":sorts" "a term" ,@(mapcan (lambda (sort) (copy-list (sort-terms sort)))
                                 (copy-list (theory-sorts theory))))))

(defun check-kinds (theory)
  "Check that no name is declared as two kinds of things, which would leave open what is meant."
  (let ((kinds (make-hash-table :test 'eq)))
    (loop for (option kind . declarations) in (declarations-by-kind theory)
          do (loop for declaration in declarations
                   for name = (first declaration)
                   for (other . other-kind) = (gethash name kinds)
                   do (when (and other (string/= other-kind kind))
                        (theory-problem theory option (latest (list other declaration))
                                        "~a is declared as ~a and as ~a" (name-text name)
                                        other-kind kind))
                      (setf (gethash name kinds) (cons declaration kind))))))

(defun check-signatures (theory)
  (loop for (option nil . declarations) in (declarations-by-kind theory)
        do (loop with seen = (make-hash-table :test 'eq)
                 for declaration in declarations
                 do (when (gethash (first declaration) seen)
                      (theory-problem theory option declaration "~a is declared twice"
                                      (name-text (first declaration))))
                    (setf (gethash (first declaration) seen) t)
                    (check-argument-sorts theory option declaration (rest declaration))))
  (loop for function in (theory-functions theory)
        do (check-argument-sorts theory ":functions" function (rest function))))

;;; Sorts

(defun check-sort-tree (theory)
  "Check the names and the parents of sorts."
  (loop with seen = (make-hash-table :test 'eq)
        for sort in (theory-sorts theory)
        for name = (sort-name sort)
        do (with-place (sort)
             (when (or (gethash name seen) (find-sort '() name))
               (theory-problem theory ":sorts" nil "~a is declared twice" (name-text name)))
             (setf (gethash name seen) t)
             (dolist (parent (sort-parents sort))
               (unless (theory-sort theory parent)
                 (theory-problem theory ":sorts" nil "there is no sort ~a, the parent of ~a"
                                 (name-text parent) (name-text name)))
               (when (subsort-p (theory-sorts theory) parent name)
                 (theory-problem theory ":sorts" nil "~a is below itself" (name-text name)))))))

(defun sorts-within (theory name)
  "Return the names of the sorts on whose elements those of the sort named NAME depend."
  (flet ((arguments (declarations)
           (loop for (nil . sorts) in declarations
                 unless (member name sorts) append sorts)))
    (case name
      (:fluent (arguments (theory-fluents theory)))
      (:event (arguments (theory-events theory)))
      (t (let ((sort (theory-sort theory name)))
           (unless (sort-range sort)
             (append (arguments (sort-terms sort))
                     (loop for other in (theory-sorts theory)
                           when (member name (sort-parents other)) collect (sort-name other)))))))))

(defun endless-sorts (theory circle)
  "Signal that the elements of the sorts named CIRCLE depend on each other."
  (let ((declarations
          (loop for name in circle
                append (case name
                         (:fluent (theory-fluents theory))
                         (:event (theory-events theory))
                         (t (let ((sort (theory-sort theory name)))
                              (cons sort (sort-terms sort))))))))
    (with-place ((latest (remove-if-not (lambda (thing)
                                          (or (element-sort-p thing)
                                              (intersection (rest thing) circle)))
                                        declarations)))
      (theory-problem theory ":sorts" nil
                      "there would be no end to the elements of sort ~a: they depend on those of ~
                       ~{~#[~;sort ~a~:;sort ~a, those on ~]~}"
                      (name-text (first circle)) (mapcar #'name-text (rest circle))))))

(defun check-elements (theory)
  "Check that the elements of each sort, and the instances of each declaration, are finitely many."
  (let ((done '()))
    (labels ((visit (name above)
               (cond ((member name done))
                     ((member name above)
                      (endless-sorts theory
                                     (cons name (reverse (cons name (ldiff above
                                                                           (member name
                                                                                   above)))))))
                     (t (dolist (other (sorts-within theory name))
                          (visit other (cons name above)))
                        (push name done)))))
      (dolist (sort (theory-sorts theory)) (visit (sort-name sort) '()))
      (visit :fluent '())
      (visit :event '())))
  (loop for (option nil . declarations) in (declarations-by-kind theory)
        when (member option '(":fluents" ":events" ":numeric-fluents") :test #'string=)
          do (loop for (name . sorts) in declarations
                   do (with-place ((assoc name declarations))
                        (check-size theory name
                                    (reduce #'* sorts
                                            :key (lambda (sort) (sort-size theory sort)))
                                    "instances")))))

;;; Names

(defun check-names (theory)
  "Check the names of fluents, events and predicates that declarations mention."
  (flet ((check (option names known kind)
           (dolist (name names)
             (unless (assoc name known)
               (theory-problem theory option nil "there is no ~a ~a" kind (name-text name))))))
    (check ":non-inertial-fluents" (theory-non-inertial theory) (theory-fluents theory) "fluent")
    (when (listp (theory-manual-release theory))
      (with-place ((first (getf *written-clauses* :manual-release)))
        (check ":manual-release" (theory-manual-release theory) (theory-fluents theory)
               "fluent")))
    (dolist (exclusion (theory-exclusions theory))
      (destructuring-bind (key . names) exclusion
        (let ((option (format nil "~(~s~)" key)))
          (with-place (exclusion)
            (check option names (append (theory-fluents theory) (theory-events theory))
                   "fluent or event")
            (let ((fluent (find-if (lambda (name) (assoc name (theory-fluents theory))) names))
                  (event (find-if (lambda (name) (assoc name (theory-events theory))) names)))
              (when (and fluent event (not (eq fluent event))
                         (eq (theory-syntax theory) :lisp))
                (theory-problem theory option nil "~a is a fluent and ~a an event"
                                (name-text fluent) (name-text event))))))))
    (dolist (completion (theory-completions theory))
      (let ((predicate (second completion)))
        (with-place (completion)
          (unless (or (member predicate *effect-predicates*) (eq predicate :happens)
                      (assoc predicate (theory-predicates theory)))
            (theory-problem theory ":completion" nil "there is no predicate ~a to complete"
                            (name-text predicate))))))))

(defun check-extensions (theory)
  (loop for ((name . tuples) . others) on (theory-extensions theory)
        for sorts = (rest (assoc name (theory-predicates theory)))
        do (when (assoc name others)
             (theory-problem theory ":predicates" nil "~a is given as two tables"
                             (name-text name)))
           (dolist (tuple tuples)
             (unless (and (= (length tuple) (length sorts))
                          (loop for element in tuple
                                for sort in sorts
                                always (element-of-sort-p theory element sort)))
               (theory-problem theory ":predicates" tuple
                               "the arguments of ~a are of the sorts ~{~a~^, ~}" (name-text name)
                               (mapcar #'name-text sorts))))
           (when (find name (theory-completions theory) :key #'second)
             (theory-problem theory ":completion" nil "~a is given as a table already"
                             (name-text name)))))

(defun check-axioms (theory)
  (let ((names (make-hash-table :test 'eq)))
    (dolist (axiom (theory-axioms theory))
      (check-axiom theory axiom)
      (when (gethash (axiom-name axiom) names)
        (theory-problem theory axiom nil "another axiom has the same name"))
      (setf (gethash (axiom-name axiom) names) t))))

(defun numbered-p (axiom)
  "Return true if the name of AXIOM is a number, for its author has given none."
  (every #'digit-char-p (symbol-name (axiom-name axiom))))

(defun inherited-axioms (extends)
  "Return the axioms of the theories EXTENDS.  Of those that share a number all but the first are
named after their theory, too."
  (let ((names (make-hash-table :test 'eq))
        (axioms '()))
    (dolist (theory extends (nreverse axioms))
      (dolist (axiom (theory-axioms theory))
        (unless (member axiom axioms :test #'eq)
          (when (and (gethash (axiom-name axiom) names) (numbered-p axiom))
            (setf axiom (make-axiom :name (name-keyword
                                           (make-symbol
                                            (format nil "~a/~a" (theory-name theory)
                                                    (axiom-name axiom))))
                                    :label (axiom-label axiom)
                                    :formula (axiom-formula axiom)
                                    :position (axiom-position axiom))))
          (setf (gethash (axiom-name axiom) names) t)
          (push axiom axioms))))))

(defun make-checked-theory (&rest parts
                            &key extends name documentation syntax file sorts predicates
                              extensions functions fluents numeric-fluents non-inertial
                              manual-release events axioms completions exclusions time-range
                              offset-range options extended-files)
  "Return the theory NAME of the given parts, which are as the readers of a THEORY return them;
those of the theories EXTENDS come first.  Signals THEORY-ERROR if they do not fit together."
  (declare (ignore name documentation syntax file))
  (flet ((all (reader own)
           (remove-duplicates (append (mapcan (lambda (theory) (copy-list (funcall reader theory)))
                                              extends)
                                      own)
                              :test #'equalp :from-end t))
         (own-or-inherited (own reader)
           (or own (some reader extends))))
    (let ((theory
            (apply #'make-theory :allow-other-keys t
                   :extended-files (remove-duplicates
                                    (append extended-files (mapcan #'theory-files extends))
                                    :test #'string= :from-end t)
                   :sorts (all #'theory-sorts sorts)
                   :predicates (all #'theory-predicates predicates)
                   :extensions (all #'theory-extensions extensions)
                   :functions (all #'theory-functions functions)
                   :fluents (all #'theory-fluents fluents)
                   :numeric-fluents (all #'theory-numeric-fluents numeric-fluents)
                   :non-inertial (all #'theory-non-inertial non-inertial)
                   :manual-release (if (or (eq manual-release t)
                                           (find t extends :key #'theory-manual-release))
                                       t
                                       (all #'theory-manual-release manual-release))
                   :events (all #'theory-events events)
                   :axioms (append (inherited-axioms extends) axioms)
                   :completions (all #'theory-completions completions)
                   :exclusions (all #'theory-exclusions exclusions)
                   :time-range (own-or-inherited time-range #'theory-time-range)
                   :offset-range (own-or-inherited offset-range #'theory-offset-range)
                   :options (append options (mapcan (lambda (theory)
                                                      (copy-list (theory-options theory)))
                                                    extends))
                   parts)))
      (check-sort-tree theory)
      (check-signatures theory)
      (when (eq (theory-syntax theory) :lisp) (check-kinds theory))
      (check-elements theory)
      (check-names theory)
      (check-extensions theory)
      (check-axioms theory)
      (when (theory-functions theory) (check-values theory))
      theory)))
