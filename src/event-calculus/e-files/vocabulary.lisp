;;;; What a .e file declares: sorts, constants, predicates, functions, fluents, events.
;;;;
;;;; Declarations may stand before or after their use, so the VOCABULARY is collected from all
;;;; statements before a formula is looked at.  To declare a thing twice in the same way is
;;;; harmless.  Names are strings here, as in the file; the names of the theory are made in
;;;; e-names.lisp.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (declared-sort (:copier nil))
  "A sort of a .e file: PARENTS are ((name . statement)*), CONSTANTS and INTEGERS its elements,
newest first."
  (name "" :type string :read-only t)
  (reified nil :type boolean)
  (parents '() :type list)
  (range nil :type (or null cons))
  (constants '() :type list)
  (integers '() :type list)
  (statement nil :type statement :read-only t))

(defstruct (declared-symbol (:copier nil))
  "A symbol of a .e file; SORT is one of *SYMBOL-KINDS* or the reified sort whose terms it builds."
  (name "" :type string :read-only t)
  (sort "" :type string :read-only t)
  (arguments '() :type list :read-only t)
  (value nil :type (or null string) :read-only t)
  (statement nil :type statement :read-only t))

(defstruct (vocabulary (:copier nil))
  "The sorts and symbols of a .e file in the order of their declarations, newest first, and tables
of them.  SYMBOL-TABLE is by (sort . name), symbols of terms are also in it under the sort NIL.
CONSTANTS maps a name to the sorts that declare it; FOUNDATIONS are the loaded ones."
  (sorts '() :type list)
  (symbols '() :type list)
  (sort-table (make-hash-table :test 'equal) :type hash-table :read-only t)
  (symbol-table (make-hash-table :test 'equal) :type hash-table :read-only t)
  (constants (make-hash-table :test 'equal) :type hash-table :read-only t)
  (time-range nil :type (or null cons))
  (offset-range nil :type (or null cons))
  (foundations '() :type list))

(defparameter *built-in-e-sorts* '("integer" "time" "offset" "fluent" "event")
  "The sorts that the foundations declare and that variables can have.")

(defparameter *symbol-kinds* '("predicate" "function" "fluent" "event")
  "What symbols are if they do not build terms of a reified sort of the file.")

(defparameter *e-predicates*
  '(("Happens" :happens "event" "time")
    ("HoldsAt" :holds-at "fluent" "time")
    ("ReleasedAt" :released-at "fluent" "time")
    ("Initiates" :initiates "event" "fluent" "time")
    ("Terminates" :terminates "event" "fluent" "time")
    ("Releases" :releases "event" "fluent" "time")
    ("Trajectory" :trajectory "fluent" "time" "fluent" "offset")
    ("AntiTrajectory" :anti-trajectory "fluent" "time" "fluent" "offset"))
  "The predicates that every file has: name, name in the theory, and argument sorts.")

(defparameter *e-trajectory-predicates*
  '(("StoppedIn" :stopped-in "time" "fluent" "time")
    ("StartedIn" :started-in "time" "fluent" "time")
    ("Clipped" :clipped "time" "fluent" "time")
    ("Declipped" :declipped "time" "fluent" "time"))
  "The predicates that every file has if it does not declare others of the name itself.")

(defparameter *e-causal-predicates*
  '(("Started" :started "fluent" "time")
    ("Stopped" :stopped "fluent" "time")
    ("Initiated" :initiated "fluent" "time")
    ("Terminated" :terminated "fluent" "time"))
  "The predicates of the foundation ECCausal.")

(defun standard-e-name (keyword)
  "Return the .e name of the predicate of the event calculus that is named KEYWORD in Lisp, or NIL."
  (first (find keyword (append *e-predicates* *e-trajectory-predicates* *e-causal-predicates*)
               :key #'second)))

(defun statement-problem (statement control &rest arguments)
  "Signal an E-FILE-ERROR at the line of STATEMENT."
  (apply #'e-problem (statement-file statement) (statement-line statement) control arguments))

(defun foundation-loaded-p (vocabulary name)
  (and (member name (vocabulary-foundations vocabulary) :test #'string=) t))

(defun find-declared-symbol (vocabulary name sort)
  (gethash (cons sort name) (vocabulary-symbol-table vocabulary)))

(defun find-declared-sort (vocabulary name)
  (gethash name (vocabulary-sort-table vocabulary)))

(defun known-sort-p (vocabulary name)
  (or (find-declared-sort vocabulary name)
      (and (member name *built-in-e-sorts* :test #'string=) t)))

(defun check-declared-sort (vocabulary name statement)
  (unless (known-sort-p vocabulary name)
    (statement-problem statement "there is no sort ~a" name)))

(defun standard-predicate (vocabulary name)
  "Return the entry of the predicate NAME if it is one of the event calculus, or NIL."
  (flet ((entry (entries) (assoc name entries :test #'string=)))
    (or (entry *e-predicates*)
        (and (or (foundation-loaded-p vocabulary "ECTraj.e")
                 (not (find-declared-symbol vocabulary name "predicate")))
             (entry *e-trajectory-predicates*))
        (and (foundation-loaded-p vocabulary "ECCausal.e")
             (entry *e-causal-predicates*)))))

;;; Sorts and their elements

(defun declare-sort (vocabulary statement name parent reified)
  (cond ((or (member name *built-in-e-sorts* :test #'string=)
             (member name '("predicate" "function") :test #'string=)))
        ((not (lower-case-p (char name 0)))
         (statement-problem statement
                            "the name of a sort begins with a lower-case letter, unlike ~a" name))
        (t (let ((sort (or (find-declared-sort vocabulary name)
                           (first (push (make-declared-sort :name name :statement statement)
                                        (vocabulary-sorts vocabulary))))))
             (setf (gethash name (vocabulary-sort-table vocabulary)) sort)
             (when reified
               (setf (declared-sort-reified sort) t))
             (when (and parent
                        (not (assoc parent (declared-sort-parents sort) :test #'string=)))
               (setf (declared-sort-parents sort)
                     (append (declared-sort-parents sort) (list (cons parent statement)))))))))

(defun sort-with-elements (vocabulary statement name)
  "Return the sort NAME, to which STATEMENT adds elements."
  (or (find-declared-sort vocabulary name)
      (statement-problem statement (if (known-sort-p vocabulary name)
                                       "~a has no constants"
                                       "~a is neither a keyword nor a declared sort")
                         name)))

(defun declare-constant (vocabulary statement sort-name name again)
  (let ((sort (sort-with-elements vocabulary statement sort-name))
        (others (gethash name (vocabulary-constants vocabulary))))
    (when (lower-case-p (char name 0))
      (statement-problem statement "a constant begins with an upper-case letter, unlike ~a" name))
    (unless (member sort-name others :test #'string=)
      (when (and others (not again))
        (statement-problem statement "~a is a constant of sort ~a already; \"~a! ~a\" declares it ~
                                      of sort ~a, too"
                           name (first (last others)) sort-name name sort-name))
      (push sort-name (gethash name (vocabulary-constants vocabulary)))
      (push name (declared-sort-constants sort)))))

(defun declare-integer (vocabulary statement sort-name value)
  (pushnew value (declared-sort-integers (sort-with-elements vocabulary statement sort-name))))

(defun declare-range (vocabulary statement name low high)
  (let ((range (cons low high)))
    (cond ((string= name "time") (setf (vocabulary-time-range vocabulary) range))
          ((string= name "offset") (setf (vocabulary-offset-range vocabulary) range))
          ((find-declared-sort vocabulary name)
           (setf (declared-sort-range (find-declared-sort vocabulary name)) range))
          (t (statement-problem statement "there is no sort ~a to give a range" name)))))

(defun integers-range (sort)
  "Return the range of SORT, also if its integers were declared one by one."
  (let ((integers (sort (copy-list (declared-sort-integers sort)) #'<)))
    (cond ((and (declared-sort-range sort) (declared-sort-constants sort))
           (statement-problem (declared-sort-statement sort)
                              "the sort ~a has both a range and constants"
                              (declared-sort-name sort)))
          ((null integers) (declared-sort-range sort))
          ((or (declared-sort-range sort) (declared-sort-constants sort)
               (/= (length integers) (1+ (- (first (last integers)) (first integers)))))
           (statement-problem (declared-sort-statement sort)
                              "the integers of the sort ~a are no range" (declared-sort-name sort)))
          (t (cons (first integers) (first (last integers)))))))

;;; Symbols

(defun declare-symbol (vocabulary statement sort name arguments value)
  (let ((known (find-declared-symbol vocabulary name sort))
        (standard (and (string= sort "predicate")
                       (assoc name *e-predicates* :test #'string=))))
    (cond ((and standard (not (equal (cddr standard) arguments)))
           (statement-problem statement "~a is a predicate of the event calculus, with the ~
                                         arguments ~{~a~^, ~}"
                              name (cddr standard)))
          (standard)
          ((null known)
           (let ((symbol (make-declared-symbol :name name :sort sort :arguments arguments
                                               :value value :statement statement))
                 (table (vocabulary-symbol-table vocabulary)))
             (push symbol (vocabulary-symbols vocabulary))
             (setf (gethash (cons sort name) table) symbol)
             (unless (member sort *symbol-kinds* :test #'string=)
               (setf (gethash (cons nil name) table) symbol))))
          ((not (and (equal arguments (declared-symbol-arguments known))
                     (equal value (declared-symbol-value known))))
           (statement-problem statement "~a is declared in another way at ~a:~d" name
                              (statement-file (declared-symbol-statement known))
                              (statement-line (declared-symbol-statement known)))))))

(defun check-symbol (vocabulary symbol)
  (let ((statement (declared-symbol-statement symbol))
        (sort-name (declared-symbol-sort symbol)))
    (unless (member sort-name *symbol-kinds* :test #'string=)
      (unless (declared-sort-reified (sort-with-elements vocabulary statement sort-name))
        (statement-problem statement "~a has arguments, so ~a must be a reified sort"
                           (declared-symbol-name symbol) sort-name)))
    (dolist (argument (declared-symbol-arguments symbol))
      (check-declared-sort vocabulary argument statement)
      (when (string= argument "integer")
        (statement-problem statement "an argument of ~a needs a sort with a range, not integer"
                           (declared-symbol-name symbol))))
    (when (declared-symbol-value symbol)
      (check-declared-sort vocabulary (declared-symbol-value symbol) statement))))

;;; All of it

(defun sort-circle-p (vocabulary name)
  "Return true if the sort NAME is above itself."
  (let ((seen '()))
    (labels ((walk (ancestor)
               (let ((sort (find-declared-sort vocabulary ancestor)))
                 (and sort
                      (some (lambda (parent)
                              (or (string= (car parent) name)
                                  (unless (member (car parent) seen :test #'string=)
                                    (push (car parent) seen)
                                    (walk (car parent)))))
                            (declared-sort-parents sort))))))
      (walk name))))

(defun check-vocabulary (vocabulary)
  (dolist (sort (reverse (vocabulary-sorts vocabulary)))
    (loop for (parent . statement) in (declared-sort-parents sort)
          do (check-declared-sort vocabulary parent statement))
    (when (sort-circle-p vocabulary (declared-sort-name sort))
      (statement-problem (declared-sort-statement sort) "the sort ~a is a part of itself"
                         (declared-sort-name sort)))
    (integers-range sort))
  (dolist (symbol (reverse (vocabulary-symbols vocabulary)))
    (check-symbol vocabulary symbol)))

(defun collect-vocabulary (statements)
  "Return the VOCABULARY that STATEMENTS declare.  Signals E-FILE-ERROR."
  (let ((vocabulary (make-vocabulary)))
    (flet ((each (kind function)
             (dolist (statement statements)
               (when (eq (statement-kind statement) kind)
                 (apply function vocabulary statement (statement-data statement))))))
      ;; Elements can be declared before their sort.
      (each :foundation (lambda (vocabulary statement name)
                          (declare (ignore statement))
                          (pushnew name (vocabulary-foundations vocabulary) :test #'string=)))
      (each :sort #'declare-sort)
      (each :constant #'declare-constant)
      (each :integer #'declare-integer)
      (each :range #'declare-range)
      (each :symbol #'declare-symbol))
    (check-vocabulary vocabulary)
    vocabulary))
