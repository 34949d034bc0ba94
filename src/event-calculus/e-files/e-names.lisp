;;;; The names of a theory as a .e file writes them.
;;;;
;;;; A theory from a .e file keeps its names.  In one from Lisp, words and hyphens become camel
;;;; case: the event pick-up is PickUp, the element r1 is R1; a sort is in lower case without
;;;; hyphens: item-type is itemtype.  Different names stay different: where two would be the same,
;;;; the later one gets a number, or a sort a letter, since digits tell variables apart.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (e-names (:constructor make-empty-e-names (theory)) (:copier nil))
  "The .e names of THEORY: a table of strings by (kind . keyword), where the kind is :SORT,
:CONSTANT, :SYMBOL or :LABEL, and the names that are taken."
  (theory nil :type theory :read-only t)
  (table (make-hash-table :test 'equal) :type hash-table :read-only t)
  (taken (make-hash-table :test 'equal) :type hash-table :read-only t))

(defparameter *e-keywords*
  '("load" "option" "sort" "reified" "predicate" "function" "fluent" "event" "range" "noninertial"
    "manualrelease" "completion" "mutex" "xor" "ignore")
  "The words that begin statements.")

(defun name-words (string)
  "Return the parts of STRING that can stand in a name, without what separates them."
  (loop with end = (length string)
        for start = (position-if #'alphanumericp string)
          then (position-if #'alphanumericp string :start stop)
        while start
        for stop = (or (position-if-not #'alphanumericp string :start start) end)
        collect (subseq string start stop)
        while (< stop end)))

(defun capitalized (word)
  "Return WORD with a capital; a word without lower-case letters goes on in lower case."
  (let ((word (if (some #'lower-case-p word) word (string-downcase word))))
    (string-upcase word :end 1)))

(defun camel-case (string)
  "Return a .e name for a constant or symbol named STRING in Lisp."
  (let ((name (remove-if-not #'name-character-p
                             (format nil "~{~a~}" (mapcar #'capitalized (name-words string))))))
    (if (and (plusp (length name)) (upper-case-p (char name 0)))
        name
        (concatenate 'string "X" name))))

(defun sort-case (string)
  "Return a .e name for a sort named STRING in Lisp: it ends in no digit."
  (let ((name (remove-if-not #'name-character-p
                             (string-downcase (format nil "~{~a~}" (name-words string))))))
    (format nil "~:[x~;~]~a~:[~;x~]"
            (and (plusp (length name)) (lower-case-p (char name 0)))
            name
            (and (plusp (length name)) (digit-char-p (char name (1- (length name))))))))

(defun free-name (names base kind)
  "Return BASE, or if it is taken a name that begins with it."
  (flet ((free-p (name) (not (gethash name (e-names-taken names)))))
    (let ((name (if (eq kind :sort)
                    (loop for name = base then (concatenate 'string name "x")
                          when (free-p name) return name)
                    (loop for number from 1
                          for name = (if (= number 1) base (format nil "~a~d" base number))
                          when (free-p name) return name))))
      (setf (gethash name (e-names-taken names)) t)
      name)))

(defun own-e-name (keyword kind)
  "Return the name that a .e file gave to what is named KEYWORD now."
  (let ((name (symbol-name keyword)))
    (if (and (eq kind :sort) (notany #'lower-case-p name)) (string-downcase name) name)))

(defun e-name (names kind keyword)
  "Return the .e name of the sort, constant, symbol or label that is named KEYWORD in the theory."
  (cond ((and (eq kind :symbol) (standard-e-name keyword)))
        ((and (eq kind :sort) (find-sort '() keyword)) (string-downcase (symbol-name keyword)))
        ((eq (theory-syntax (e-names-theory names)) :e) (own-e-name keyword kind))
        ((gethash (cons kind keyword) (e-names-table names)))
        (t (setf (gethash (cons kind keyword) (e-names-table names))
                 (free-name names
                            (funcall (if (eq kind :sort) #'sort-case #'camel-case)
                                     (symbol-name keyword))
                            kind)))))

(defun e-variable-name (names variable)
  "Return the .e name of VARIABLE: that of its sort and what tells it from others of the sort."
  (let* ((sort (variable-sort (e-names-theory names) variable))
         (suffix (subseq (symbol-name variable) (1+ (length (symbol-name sort))))))
    (concatenate 'string (e-name names :sort sort) suffix)))

(defun make-e-names (theory)
  "Return the E-NAMES of THEORY; names are given out in the order of the declarations."
  (let ((names (make-empty-e-names theory)))
    (flet ((take (name) (setf (gethash name (e-names-taken names)) t))
           (give (kind keyword) (e-name names kind keyword)))
      (mapc #'take *e-keywords*)
      (mapc #'take *built-in-e-sorts*)
      (mapc #'take (mapcar #'first (append *e-predicates* *e-trajectory-predicates*
                                           *e-causal-predicates*)))
      (dolist (sort (theory-sorts theory))
        (give :sort (sort-name sort)))
      (dolist (sort (theory-sorts theory))
        (dolist (constant (sort-constants sort))
          (give :constant constant))
        (loop for (name) in (sort-terms sort)
              do (give :symbol name)))
      (dolist (declarations (list (theory-predicates theory)
                                  (mapcar #'first (theory-functions theory))
                                  (theory-fluents theory) (theory-events theory)))
        (loop for (name) in declarations
              do (give :symbol name))))
    names))
