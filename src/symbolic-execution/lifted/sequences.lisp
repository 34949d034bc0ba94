;;;; Functions that call functions: sequences, lists, trees.
;;;;
;;;; SBCL's own functions do the work.  They are given, for each function among their arguments,
;;;; one that may be called with symbolic values, and that decides the answer where it is a test.
;;;; So the elements are decided upon one after the other, in the order in which SBCL asks; nothing
;;;; else is looked at.
;;;;
;;;; The arguments of a function have ROLES: :ANY, nothing is done; :ONE, settled; :SEQUENCE, a
;;;; settled sequence or list; :CHANGED, the same, which the function changes; :FUNCTION; :TEST, a
;;;; function of which only the truth matters; :VALUE-TEST, one whose value is returned; :JOINED,
;;;; one that returns lists to be joined by NCONC; :TREE, a tree that the function changes.

(in-package #:discrepancy-finder.symbolic-execution)

(defun decided-eql (one other)
  "Return whether ONE and OTHER are the same, by a decision if that is symbolic."
  (if (or (symbolic-value-p one) (symbolic-value-p other))
      (or (eq one other)
          (decide-proposition (equal-proposition one other #'eql)
                              "whether two values are the same"))
      (eql one other)))

(defun deciding-function (function keep-value)
  "Return a function that decides the answer of FUNCTION; with KEEP-VALUE it returns that answer,
which is true then, else whether it is true."
  (let ((code (code-of function)) (description (function-description function)))
    (flet ((answer (value)
             (if (symbolic-value-p value)
                 (let ((truth (truth value description)))
                   (if keep-value (and truth value) truth))
                 value)))
      (declare (inline answer))
      (if (functionp code)
          (lambda (&rest arguments)
            (declare (dynamic-extent arguments))
            (answer (if (and arguments (null (cdr arguments)))
                        (funcall code (car arguments))
                        (apply code arguments))))
          code))))

(defun settled-sequence (value description)
  "Return the sequence VALUE, settled, also where a list ends."
  (let ((value (settled value description)))
    (when (and (consp value) (symbolic-run-p))
      (loop for slow = value then (cdr slow)
            for cons = value then (cddr cons)
            while (and (consp cons) (consp (cdr cons)))
            do (when (and (eq slow cons) (not (eq cons value))) (return))
            finally (let ((last (if (and (consp cons) (consp (cdr cons))) (cdr cons) cons)))
                      (when (and (consp last) (symbolic-value-p (cdr last)))
                        (note-place (cdr last))
                        (setf (cdr last) (settled (cdr last) description))))))
    value))

(defun prepared (value role description)
  "Return the argument VALUE as its ROLE demands it."
  (ecase role
    (:any value)
    (:one (settled value description))
    (:sequence (settled-sequence value description))
    (:changed (let ((sequence (settled-sequence value description)))
                (note-sequence sequence)
                sequence))
    (:function (if (null value) nil (code-of (settled value description))))
    (:test (deciding-function (settled value description) nil))
    (:value-test (deciding-function (settled value description) t))
    (:joined (joined-lists (code-of (settled value description))))
    (:tree (note-tree value)
     value)))

(defun joined-lists (function)
  "Return a function that returns the lists that FUNCTION does, whose ends are going to be changed."
  (lambda (&rest arguments)
    (let ((list (settled (apply (the function function) arguments) "a list to be joined")))
      (when (consp list)
        (let ((last (last list)))
          (note-place (cdr last))))
      list)))

(defun note-tree (tree)
  "Note that the conses of TREE are to be as they are after the run."
  (when *path*
    (loop while (consp tree)
          do (note-place (car tree))
             (note-place (cdr tree))
             (note-tree (car tree))
             (setf tree (cdr tree)))))

(defun prepared-keywords (keywords description)
  "Return the keyword arguments KEYWORDS as prepared."
  (loop for (keyword value) on keywords by #'cddr
        collect keyword
        collect (if (null value)
                    nil
                    (prepared value
                              (case keyword
                                ((:test :test-not) :test)
                                (:key :function)
                                ((:initial-value :initial-element) :any)
                                (t :one))
                              description))))

(defun prepared-call (function arguments roles rest-role default-test description)
  "Call FUNCTION with ARGUMENTS, which are prepared by ROLES.  What is behind them are keyword
arguments, or of REST-ROLE.  With DEFAULT-TEST the function compares by EQL if it is told nothing
else."
  (declare (function function))
  (let ((prepared '()))
    (loop for role in roles
          while arguments
          do (push (prepared (pop arguments) role description) prepared))
    (apply function
           (nreconc prepared
                    (cond (rest-role
                           (loop for argument in arguments
                                 collect (prepared argument rest-role description)))
                          ((or (not default-test) (not (symbolic-run-p))
                               (getf arguments :test) (getf arguments :test-not))
                           (prepared-keywords arguments description))
                          (t (list* :test #'decided-eql
                                    (prepared-keywords arguments description))))))))

(eval-when (:compile-toplevel :load-toplevel :execute)
  (defun sequence-version (name roles)
    "Return a form that registers the version of NAME, whose arguments have ROLES: a list, in which
&REST stands before the role of all others and &EQL at the end if the default test is EQL."
    (let* ((positional (subseq roles 0 (or (position-if (lambda (role) (member role '(&rest &eql)))
                                                        roles)
                                           (length roles))))
           (rest-role (second (member '&rest roles)))
           (default-test (and (member '&eql roles) t)))
      `(define-lifted ,(list name) (&rest arguments)
         (if (and *path* (<= ,(length positional) (length arguments))
                  ,(or (and rest-role t) `(evenp (- (length arguments) ,(length positional)))))
             (prepared-call #',name arguments ',positional ',rest-role ,default-test
                            ,(describe-decision name))
             (apply #',name arguments))))))

(defmacro define-sequence-functions (&rest definitions)
  "Define the versions of functions: each definition is a list of names and the list of roles."
  `(progn ,@(loop for (names roles) in definitions
                  append (loop for name in (if (listp names) names (list names))
                               collect (sequence-version name roles)))))

(define-sequence-functions
  ((find position count member assoc rassoc adjoin) (:any :sequence &eql))
  ((find-if find-if-not position-if position-if-not count-if count-if-not member-if member-if-not
    assoc-if assoc-if-not rassoc-if rassoc-if-not remove-if remove-if-not)
   (:test :sequence))
  (remove (:any :sequence &eql))
  (delete (:any :changed &eql))
  ((delete-if delete-if-not) (:test :changed))
  (remove-duplicates (:sequence &eql))
  (delete-duplicates (:changed &eql))
  (substitute (:any :any :sequence &eql))
  ((substitute-if substitute-if-not) (:any :test :sequence))
  ((union intersection set-difference set-exclusive-or subsetp search mismatch)
   (:sequence :sequence &eql))
  ((nunion nintersection nset-difference nset-exclusive-or) (:changed :changed &eql))
  (reduce (:function :sequence))
  ((sort stable-sort) (:changed :test))
  (merge (:one :changed :changed :test))
  ((mapcar mapc maplist mapl) (:function &rest :sequence))
  ((mapcan mapcon) (:joined &rest :sequence))
  ((some) (:value-test &rest :sequence))
  ((every) (:value-test &rest :sequence))
  ((notany notevery) (:test &rest :sequence))
  (subst (:any :any :any &eql))
  ((subst-if subst-if-not) (:any :test :any))
  (sublis (:sequence :any &eql))
  (nsubst (:any :any :tree &eql))
  ((nsubst-if nsubst-if-not) (:any :test :tree))
  (nsublis (:sequence :tree &eql))
  (tree-equal (:any :any &eql))
  (maphash (:function :one)))

;;; Those that change what is not a plain sequence, or make arrays that hold not everything

(defun general-array-p (array)
  (or (listp array) (eq (array-element-type array) t)))

(define-lifted (nsubstitute) (any-new any-old sequence &rest keywords)
  (let ((sequence (prepared sequence :changed "an argument of nsubstitute")))
    (prepared-call #'nsubstitute (list* (element-for any-new sequence) any-old sequence keywords)
                   '(:any :any :any) nil t "an argument of nsubstitute")))

(define-lifted (nsubstitute-if) (any-new test sequence &rest keywords)
  (let ((sequence (prepared sequence :changed "an argument of nsubstitute-if")))
    (prepared-call #'nsubstitute-if (list* (element-for any-new sequence) test sequence keywords)
                   '(:any :test :any) nil nil "an argument of nsubstitute-if")))

(define-lifted (nsubstitute-if-not) (any-new test sequence &rest keywords)
  (let ((sequence (prepared sequence :changed "an argument of nsubstitute-if-not")))
    (prepared-call #'nsubstitute-if-not
                   (list* (element-for any-new sequence) test sequence keywords)
                   '(:any :test :any) nil nil "an argument of nsubstitute-if-not")))

(defun element-for (value sequence)
  "Return VALUE as an element of SEQUENCE: settled unless that can hold anything."
  (if (general-array-p sequence) value (settled value "an element of an array")))

(define-lifted (fill) (sequence any-item &rest keywords)
  (let ((sequence (prepared sequence :changed "an argument of fill")))
    (apply #'fill sequence (element-for any-item sequence)
           (settled-each keywords "an argument of fill"))))

(define-lifted (replace) (target source &rest keywords)
  (let ((target (prepared target :changed "an argument of replace"))
        (source (prepared source :sequence "an argument of replace")))
    (apply #'replace target (elements-for source target)
           (settled-each keywords "an argument of replace"))))

(defun elements-for (source target)
  "Return SOURCE, a sequence, with elements that TARGET can hold."
  (if (and (symbolic-run-p) (general-array-p source) (not (general-array-p target)))
      (map 'list (lambda (element) (settled element "an element of an array")) source)
      source))

(define-lifted (map-into) (target function &rest sequences)
  (let* ((target (prepared target :changed "an argument of map-into"))
         (code (code-of function)))
    (apply #'map-into target
           (if (general-array-p target)
               code
               (lambda (&rest arguments)
                 (settled (apply code arguments) "an element of an array")))
           (loop for sequence in sequences
                 collect (settled-sequence sequence "an argument of map-into")))))

(defun general-type-p (type)
  "Return true if a sequence of TYPE holds any Lisp object."
  (or (subtypep type 'list)
      (subtypep type '(array t))))

(define-lifted (map) (type function &rest sequences)
  (let ((code (code-of function)) (type (settled type "a type")))
    (apply #'map type
           (if (or (null type) (not *path*) (general-type-p type))
               code
               (lambda (&rest arguments)
                 (settled (apply code arguments) "an element of an array")))
           (loop for sequence in sequences
                 collect (settled-sequence sequence "an argument of map")))))

(define-lifted (concatenate) (type &rest sequences)
  (apply #'concatenate type
         (if (symbolic-run-p)
             (let ((general (general-type-p type)))
               (loop for sequence in sequences
                     for settled = (settled-sequence sequence "an argument of concatenate")
                     collect (if (or general (not (general-array-p settled)))
                                 settled
                                 (map 'list (lambda (element)
                                              (settled element "an element of an array"))
                                      settled))))
             sequences)))

(define-lifted (coerce) (value type)
  (if (not (symbolic-run-p))
      (coerce value type)
      (let ((value (current value)) (type (settled type "a type")))
        (cond ((symbolic-value-p value)
               (if (truth (lifted-typep value type) "an argument of coerce")
                   value
                   (coerce (settled value "an argument of coerce") type)))
              ((or (not (typep value 'sequence)) (not (general-array-p value))
                   (general-type-p type) (not (subtypep type 'sequence)))
               (coerce value type))
              (t (coerce (map 'vector (lambda (element) (settled element "an element of an array"))
                              value)
                         type))))))

;;; Calls

(define-lifted funcall (function &rest arguments)
  (apply (the function (code-of (settled function "a function"))) arguments))

(define-lifted apply (function argument &rest more)
  (let ((arguments (apply #'list* argument more)))
    (apply (the function (code-of (settled function "a function")))
           (settled-sequence arguments "the arguments of a call"))))

(define-lifted (constantly) (value)
  (constantly value))

(define-lifted (complement) (function)
  (let ((code (code-of (the function (settled function "a function")))))
    (make-interpreted-function
     (lambda (&rest arguments)
       (funcall (the function (lifted-function 'not)) (apply (the function code) arguments))))))
