;;;; Writing theories as .e files.
;;;;
;;;; WRITE-E-THEORY writes any theory, wherever it comes from, so that it reads back as an equal
;;;; one; SAVE-E-THEORY writes a file.  What the language cannot say is an E-FILE-ERROR.

(in-package #:discrepancy-finder.event-calculus)

(defun write-comment (text stream)
  (dolist (line (uiop:split-string (substitute #\Newline #\Return text)
                                   :separator '(#\Newline)))
    (format stream "; ~a~%" (string-trim '(#\Space #\Tab) line))))

(defun write-list (stream keyword items)
  "Write a declaration of ITEMS, strings, in lines that go on after a comma."
  (when items
    (let ((column (length keyword)))
      (write-string keyword stream)
      (loop for (item . more) on items
            for width = (+ 2 (length item))
            do (when (> (+ column width) +text-width+)
                 (format stream "~%   ")
                 (setf column 3))
               (format stream " ~a~:[~;,~]" item more)
               (incf column width))
      (terpri stream))))

(defun symbol-text (names declaration &optional value)
  (format nil "~a(~{~a~^,~})~@[: ~a~]" (e-name names :symbol (first declaration))
          (mapcar (lambda (sort) (e-name names :sort sort)) (rest declaration))
          (and value (e-name names :sort value))))

;;; Foundations and options

(defun mentions-any-p (form operators)
  (and (consp form)
       (or (member (first form) operators)
           (some (lambda (part) (mentions-any-p part operators)) (rest form)))))

(defun causal-axioms (theory)
  "Return the axioms of THEORY that are those of the theory CAUSAL-CONSTRAINTS."
  (intersection (theory-axioms theory) (theory-axioms (find-theory :causal-constraints))))

(defun needed-foundations (theory)
  (let ((options (theory-options theory)))
    (flet ((gradual-p (axiom)
             (mentions-any-p (axiom-formula axiom)
                             '(:trajectory :anti-trajectory :stopped-in :started-in :clipped
                               :declipped))))
      (append '("Root.e" "EC.e")
              (and (getf options :dec) '("DEC.e"))
              (and (or (getf options :ectraj)
                       (and (eq (theory-syntax theory) :lisp)
                            (some #'gradual-p (theory-axioms theory))))
                   '("ECTraj.e"))
              (and (causal-axioms theory) '("ECCausal.e"))))))

(defun write-options (theory stream)
  (loop for (key value) on (theory-options theory) by #'cddr
        unless (or (member key '(:dec :ectraj))
                   (and (eq key :trajectory) (getf (theory-options theory) :ectraj)))
          do (format stream "option ~(~a~) ~a~%" key
                     (case value ((t) "on") ((nil) "off") (t value))))
  (when (and (eq (theory-manual-release theory) t)
             (not (getf (theory-options theory) :manualrelease)))
    (format stream "option manualrelease on~%")))

;;; Sorts

(defun sorts-from-above (theory)
  "Return the sorts of THEORY, each after its parents if THEORY was not written in that order."
  (let ((result '()))
    (labels ((visit (sort)
               (unless (or (null sort) (member sort result))
                 (dolist (parent (sort-parents sort))
                   (visit (find parent (theory-sorts theory) :key #'sort-name)))
                 (push sort result))))
      (mapc #'visit (theory-sorts theory)))
    (nreverse result)))

(defun write-sort (theory names sort stream)
  (let ((text (e-name names :sort (sort-name sort)))
        (parents (sort-parents sort)))
    (format stream "~:[~;reified ~]sort ~a~@[: ~a~]~%" (sort-terms sort) text
            (cond (parents (e-name names :sort (first parents)))
                  ((and (sort-range sort) (eq (theory-syntax theory) :lisp)) "integer")))
    (dolist (parent (rest parents))
      (format stream "sort ~a: ~a~%" text (e-name names :sort parent)))))

(defun write-elements (names sorts stream)
  "Write the elements of SORTS.  A constant of a second sort needs an exclamation mark there."
  (let ((seen (make-hash-table :test 'eq)))
    (dolist (sort sorts)
      (let ((constants (sort-constants sort))
            (text (e-name names :sort (sort-name sort))))
        (loop while constants
              do (let* ((again (gethash (first constants) seen))
                        (end (position-if (lambda (constant)
                                            (not (eq again (gethash constant seen))))
                                          constants)))
                   (write-list stream (if again (concatenate 'string text "!") text)
                               (mapcar (lambda (constant) (e-name names :constant constant))
                                       (subseq constants 0 end)))
                   (setf constants (and end (nthcdr end constants)))))
        (dolist (constant (sort-constants sort))
          (setf (gethash constant seen) t))
        (write-list stream text (mapcar (lambda (declaration) (symbol-text names declaration))
                                        (sort-terms sort)))))))

;;; Completion
;;;
;;; Facts of a theory in Lisp are never completed.  Where a predicate that they mention is completed
;;; without a label, all other sentences about it get a label, since here the label alone decides.

(defun completion-in-need (theory)
  "Return the predicates that are completed over all sentences of THEORY but for its facts."
  (when (eq (theory-syntax theory) :lisp)
    (loop for (label predicate) in (theory-completions theory)
          when (and (null label)
                    (some (lambda (axiom)
                            (and (eq (axiom-label axiom) +facts+)
                                 (mentions-any-p (axiom-formula axiom) (list predicate))))
                          (theory-axioms theory)))
            collect predicate)))

(defun axiom-e-label (theory names axiom predicates)
  "Return the label of AXIOM as a string, or NIL; sentences about PREDICATES need one."
  (let ((label (axiom-label axiom)))
    (cond ((and (eq label +facts+) (eq (theory-syntax theory) :lisp)) nil)
          ((not (mentions-any-p (axiom-formula axiom) predicates))
           (and label (e-name names :label label)))
          (label
           (unwritable theory axiom "it has a label and is about ~a, which is completed without ~
                                     one while there are facts about it"
                       (name-text (find-if (lambda (predicate)
                                             (mentions-any-p (axiom-formula axiom)
                                                             (list predicate)))
                                           predicates))))
          (t (e-name names :label :delta)))))

;;; All of it

(defun write-declarations (theory names stream)
  (let ((sorts (if (eq (theory-syntax theory) :lisp)
                   (sorts-from-above theory)
                   (theory-sorts theory)))
        (predicates (set-difference
                     (theory-predicates theory)
                     (and (causal-axioms theory)
                          (theory-predicates (find-theory :causal-constraints)))
                     :test #'equal)))
    (dolist (sort sorts)
      (write-sort theory names sort stream))
    (write-elements names sorts stream)
    (flet ((declare-all (keyword declarations)
             (dolist (declaration declarations)
               (format stream "~a ~a~%" keyword (symbol-text names declaration)))))
      (declare-all "predicate" (remove-if-not (lambda (predicate) (member predicate predicates))
                                              (theory-predicates theory)))
      (loop for (declaration value) in (theory-functions theory)
            do (format stream "function ~a~%" (symbol-text names declaration value)))
      (declare-all "fluent" (theory-fluents theory))
      (declare-all "event" (theory-events theory)))
    (flet ((symbols (keywords)
             (mapcar (lambda (keyword) (e-name names :symbol keyword)) keywords)))
      (write-list stream "noninertial" (symbols (theory-non-inertial theory)))
      (when (listp (theory-manual-release theory))
        (write-list stream "manualrelease" (symbols (theory-manual-release theory))))
      (loop for (kind . members) in (theory-exclusions theory)
            do (write-list stream (string-downcase kind) (symbols members))))))

(defun write-axioms (theory names stream)
  (let ((causal (causal-axioms theory))
        (predicates (completion-in-need theory)))
    (dolist (axiom (theory-axioms theory))
      (unless (member axiom causal)
        ;; An unnamed axiom is named by a number; one of a .e file by its line there.
        (unless (or (eq (theory-syntax theory) :e)
                    (every #'digit-char-p (symbol-name (axiom-name axiom))))
          (write-comment (name-text (axiom-name axiom)) stream))
        (format stream "~{~a~%~}"
                (sentence-lines names axiom (axiom-e-label theory names axiom predicates)))))
    (loop for (predicate . tuples) in (theory-extensions theory)
          for text = (e-name names :symbol predicate)
          do (dolist (tuple tuples)
               (format stream "~a: ~a.~%" text (e-atom-text names (cons predicate tuple))))
             (format stream "completion ~a ~a~%" text text))
    (loop for (label predicate) in (theory-completions theory)
          do (format stream "completion ~@[~a ~]~a~%"
                     (cond (label (e-name names :label label))
                           ((member predicate predicates) (e-name names :label :delta)))
                     (e-name names :symbol predicate)))))

(defun write-ranges (theory names stream)
  (flet ((range (sort bounds)
           (when bounds
             (format stream "range ~a ~d ~d~%" sort (car bounds) (cdr bounds)))))
    (dolist (sort (theory-sorts theory))
      (range (e-name names :sort (sort-name sort)) (sort-range sort)))
    (range "time" (theory-time-range theory))
    (range "offset" (theory-offset-range theory))))

(defun write-e-theory (theory stream)
  "Write THEORY to STREAM in the language of .e files, so that it reads back as an equal theory.
Names of a theory in Lisp are written in camel case, the names of its axioms as comments, INITIALLY
as a sentence about the first timepoint; state constraints are not written.  Signals E-FILE-ERROR if
the language cannot say what the theory says."
  (let ((names (make-e-names theory)))
    (write-comment (format nil "Theory ~a~@[: ~a~]" (name-text (theory-name theory))
                           (theory-documentation theory))
                   stream)
    (format stream "~%~{load foundations/~a~%~}" (needed-foundations theory))
    (write-options theory stream)
    (terpri stream)
    (write-declarations theory names stream)
    (terpri stream)
    (write-axioms theory names stream)
    (terpri stream)
    (write-ranges theory names stream)))

(defun save-e-theory (theory file)
  "Write THEORY, a theory or its name, as the .e file FILE and return the true name of FILE.  An
existing file is replaced when all is written.  Signals E-FILE-ERROR, SOURCE-ERROR,
FILE-ERROR and THEORY-NOT-FOUND."
  (let* ((theory (if (theory-p theory) theory (find-theory theory)))
         (path (absolute-path (source:native-path file)))
         (temporary (make-pathname :type (format nil "~@[~a~].tmp" (pathname-type path))
                                   :defaults path))
         (done nil))
    (unless (uiop:directory-exists-p (uiop:pathname-directory-pathname path))
      (error 'source:source-error :file (source:native-name file)
                                  :reason "there is no folder to put it into"))
    (unwind-protect
         (progn
           (with-open-file (stream temporary :direction :output :if-exists :supersede
                                             :external-format :utf-8)
             (write-e-theory theory stream))
           (uiop:rename-file-overwriting-target temporary path)
           (setf done t))
      (unless done
        (uiop:delete-file-if-exists temporary)))
    (truename path)))
