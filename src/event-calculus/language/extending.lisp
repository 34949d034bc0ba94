;;;; Theories that extend others: the clauses (:extends theory*) and (:without name*).
;;;;
;;;; A theory begins with all that those it extends have, but for what it names in :WITHOUT; its own
;;;; declarations and axioms may then take these names anew.  It has their state constraints, too.

(in-package #:discrepancy-finder.event-calculus)

(defun file-theory (theory-name file)
  "Return the theory in FILE, relative to the file that is being read, for the theory THEORY-NAME."
  (let ((path (if *theory-file*
                  (merge-pathnames (source:native-path file) *theory-file*)
                  (source:native-path file))))
    (unless (uiop:file-exists-p path)
      (theory-problem theory-name ":extends" nil "there is no file ~s" file))
    (load-theory path)))

(defun extended-theories (theory-name clauses)
  "Return the theories that CLAUSES, written (:extends theory*), name."
  (map-entries (lambda (entry)
                 (unless (and entry (typep entry '(or symbol string)))
                   (theory-problem theory-name ":extends" nil
                                   "~a was found where the name of a theory or of its file was ~
                                    expected"
                                   (written-text entry)))
                 (if (stringp entry)
                     (file-theory theory-name entry)
                     (handler-case (find-theory entry)
                       (theory-not-found ()
                         (theory-problem theory-name ":extends" nil "there is no theory named ~a"
                                         (name-text entry))))))
               clauses))

(defun without-names (theory-name clauses extended)
  "Return the names in CLAUSES, written (:without name*), all of which stand in a theory of
EXTENDED."
  (let ((known (loop for theory in extended
                     append (mapcar #'sort-name (theory-sorts theory))
                     append (mapcar #'axiom-name (theory-axioms theory))
                     append (mapcar #'first (theory-predicates theory))
                     append (mapcar #'first (theory-fluents theory))
                     append (mapcar #'first (theory-events theory)))))
    (map-entries (lambda (entry)
                   (let ((name (and entry (symbolp entry) (name-keyword entry))))
                     (unless (member name known)
                       (theory-problem theory-name ":without" nil
                                       "~a is no sort, predicate, fluent, event or axiom of what ~
                                        is extended"
                                       (written-text entry)))
                     name))
                 clauses)))

(defun theory-without (theory names)
  "Return what THEORY has but for its sorts, predicates, fluents, events and axioms named in NAMES,
as a theory to extend: by itself it may make no sense."
  (flet ((others (things key)
           (remove-if (lambda (thing) (member (funcall key thing) names)) things)))
    (make-theory :name (theory-name theory) :syntax (theory-syntax theory)
                 :file (theory-file theory)
                 :extended-files (theory-extended-files theory)
                 :sorts (others (theory-sorts theory) #'sort-name)
                 :predicates (others (theory-predicates theory) #'first)
                 :extensions (others (theory-extensions theory) #'first)
                 :functions (theory-functions theory)
                 :fluents (others (theory-fluents theory) #'first)
                 :numeric-fluents (theory-numeric-fluents theory)
                 :non-inertial (others (theory-non-inertial theory) #'identity)
                 :manual-release (if (eq (theory-manual-release theory) t)
                                     t
                                     (others (theory-manual-release theory) #'identity))
                 :events (others (theory-events theory) #'first)
                 :axioms (others (theory-axioms theory) #'axiom-name)
                 :completions (theory-completions theory)
                 :exclusions (theory-exclusions theory)
                 :time-range (theory-time-range theory)
                 :offset-range (theory-offset-range theory)
                 :options (theory-options theory)
                 :state-constraints (theory-state-constraints theory))))

(defun inherit-state-constraints (theory extended)
  "Give THEORY the state constraints of the theories EXTENDED.  Return THEORY."
  (dolist (other extended theory)
    (dolist (constraint (theory-state-constraints other))
      (let ((name (state-constraint-name constraint)))
        (register-state-constraint
         theory
         (make-state-constraint
          :name name :theory theory :documentation (state-constraint-documentation constraint)
          :formula (parse-formula (state-constraint-formula constraint) theory
                                  :kind :constraint
                                  :blame (format nil "state constraint ~a" (name-text name)))
          :span (state-constraint-span constraint)))))))
