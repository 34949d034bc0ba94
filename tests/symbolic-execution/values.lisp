;;;; Symbolic values against brute force.
;;;;
;;;; An expression over symbolic arguments is explored: one run a path.  For each concrete
;;;; assignment just one path must be possible, and what the expression returns on it, with the
;;;; assignment's values in the place of symbolic ones, must be what SBCL computes.

(in-package #:discrepancy-finder.tests)

(def-suite symbolic-values :in all)
(in-suite symbolic-values)

(defparameter *expression-arguments*
  '((x (integer 0 3) 0 1 2 3) (y (integer -2 2) -2 -1 0 1 2) (e (member :a :b :c) :a :b :c)
    (f (member :a :c nil) :a :c nil) (b boolean nil t) (n (member 1 2 :x) 1 2 :x)
    (c (member #\a #\B) #\a #\B))
  "The arguments of expressions: name, type and all values.")

(defun expression-arguments (form)
  "Return those of *EXPRESSION-ARGUMENTS* that FORM mentions."
  (let ((mentioned '()))
    (labels ((look (form)
               (cond ((consp form) (look (car form)) (look (cdr form)))
                     ((and form (symbolp form)) (pushnew form mentioned)))))
      (look form))
    (remove-if-not (lambda (argument) (member (first argument) mentioned))
                   *expression-arguments*)))

(defun assignments (arguments)
  "Return all lists of values of ARGUMENTS."
  (if arguments
      (loop for value in (cddr (first arguments))
            append (loop for rest in (assignments (rest arguments))
                         collect (cons value rest)))
      (list '())))

(defvar *state* nil
  "Objects that exist before a run: expressions may change them.")

(defun fresh-state ()
  "Return objects of many kinds, as they are before each run."
  (let ((table (make-hash-table :test 'equal)) (other-table (make-hash-table)))
    (setf (symbol-plist 'fresh-mark) '() (get 'thing :marks) '()
          (gethash "a" table) 1 (gethash '(:a) table) 2
          (gethash :a other-table) 1 (gethash :b other-table) 2)
    (list :list (list 1 2 3 4) :tree (list (list :a 1) (list :b (list 2)))
          :table table :other-table other-table
          :vector (vector 3 1 2) :fixnums (make-array 3 :element-type 'fixnum)
          :fill (make-array 4 :fill-pointer 2 :initial-element 0 :adjustable t)
          :matrix (make-array '(2 2) :initial-element 0)
          :bits (make-array 4 :element-type 'bit :initial-element 0)
          :string (copy-seq "abcd")
          :point (make-point :px 1) :thing (make-instance 'thing :weight 1)
          :plist (list :a 1 :b 2))))

(defun state (key)
  (getf *state* key))

(defun run-expression (function path values)
  "Call FUNCTION with VALUES on PATH and return (:values . values), (:error) or (:abandoned), as a
tree in which symbolic values may stand."
  (let ((symbolic::*path* path) (outcome '(:abandoned))
        (*standard-output* (make-broadcast-stream)))
    (unwind-protect
         (catch path
           (setf outcome
                 (handler-case (plain-tree (cons :values (multiple-value-list
                                                          (apply function values))))
                   (z3:z3-error (condition) (error "Z3: ~a" condition))
                   (symbolic:symbolic-execution-error (condition)
                     (list :broken (princ-to-string condition)))
                   (error () (list :error)))))
      (symbolic::undo-writes path))
    outcome))

(defun same-value-proposition (value concrete)
  "Return the proposition that the argument VALUE is CONCRETE."
  (etypecase value
    (symbolic::symbolic-boolean
     (let ((proposition (symbolic:symbolic-boolean-proposition value)))
       (if concrete proposition (z3:negation proposition))))
    (symbolic::symbolic-number (z3:equals (symbolic:symbolic-number-term value) concrete))
    (symbolic::symbolic-element
     (cdr (assoc concrete (symbolic:symbolic-element-choices value))))))

(defun replaced-symbolic (tree lookup)
  "Return TREE with what LOOKUP returns for it in the place of each symbolic value."
  (typecase tree
    (symbolic:symbolic-value (plain-tree (funcall lookup tree)))
    (cons (cons (replaced-symbolic (car tree) lookup) (replaced-symbolic (cdr tree) lookup)))
    (t tree)))

(defun plain-tree (value)
  "Return VALUE as a tree of conses and atoms that are EQUAL for values that look the same; symbolic
values are left as they are."
  (let ((depth 0))
    (labels ((plain (value)
               (when (> (incf depth) 2000) (return-from plain-tree :deep))
               (typecase value
                 (symbolic:symbolic-value value)
                 (cons (cons (plain (car value)) (plain (cdr value))))
                 (string (copy-seq value))
                 (bit-vector (copy-seq value))
                 (array (list* :array (array-dimensions value)
                               (if (array-has-fill-pointer-p value)
                                   (map 'list #'plain value)
                                   (loop for index below (array-total-size value)
                                         collect (plain (row-major-aref value index))))))
                 (hash-table (cons :table
                                   (loop for key being the hash-keys of value
                                           using (hash-value content)
                                         collect (cons (plain key) (plain content)))))
                 (function :function)
                 (structure-object
                  (cons (type-of value)
                        (loop for slot in (sb-mop:class-slots (class-of value))
                              collect (plain (slot-value value
                                                         (sb-mop:slot-definition-name slot))))))
                 (standard-object
                  (cons (type-of value)
                        (loop for slot in (sb-mop:class-slots (class-of value))
                              for name = (sb-mop:slot-definition-name slot)
                              collect (and (slot-boundp value name)
                                           (plain (slot-value value name))))))
                 (symbol (if (symbol-package value) value (symbol-name value)))
                 (t value))))
      (plain value))))

(defun lookup-in-model (solver)
  "Return the function that returns what a symbolic value is in the model of SOLVER."
  (lambda (value)
    (etypecase value
      (symbolic:symbolic-boolean
       (z3:model-value solver (symbolic:symbolic-boolean-proposition value)))
      (symbolic:symbolic-number (z3:model-value solver (symbolic:symbolic-number-term value)))
      (symbolic:symbolic-element
       (car (find-if (lambda (choice) (z3:model-value solver (cdr choice)))
                     (symbolic:symbolic-element-choices value)))))))

(defvar *decision-count* 0
  "The number of decisions on the paths of the last expression.")

(defun symbolic-arguments (arguments oracle)
  "Return a symbolic value for each of ARGUMENTS, of whose conditions ORACLE is told."
  (loop for (name type) in arguments
        collect (multiple-value-bind (value propositions)
                    (symbolic:make-symbolic-argument name type nil
                                                     (symbolic::oracle-context oracle))
                  (dolist (proposition propositions value)
                    (symbolic::oracle-assume oracle proposition)))))

(defun covered-assignments (solver values assignments outcome)
  "Return an alist from those of ASSIGNMENTS, concrete VALUES, that SOLVER allows to OUTCOME with
these."
  (loop for assignment in assignments
        do (z3:push-scope solver)
           (loop for value in values for concrete in assignment
                 do (z3:solver-assert solver (same-value-proposition value concrete)))
        when (eq (z3:check solver) :sat)
          collect (cons assignment (replaced-symbolic outcome (lookup-in-model solver)))
        do (z3:pop-scope solver)))

(defun explore-expression (form &key (arguments (expression-arguments form)))
  "Explore FORM over ARGUMENTS, those of *EXPRESSION-ARGUMENTS* that it mentions.  Return a list
with an element for each path, in order: an alist from the assignments that it covers, lists of
values, to the outcome, as a tree; the list of what was left out; and the arguments."
  (let* ((function (symbolic::interpreted-function-code
                    (symbolic:evaluate
                     `(lambda ,(mapcar #'first arguments)
                        (declare (ignorable ,@(mapcar #'first arguments)))
                        ,form))))
         (assignments (assignments arguments))
         (oracle (symbolic::open-oracle
                  (symbolic::make-oracle :make-solver (lambda (context)
                                                        (z3:make-solver context :logic nil)))))
         (values (symbolic-arguments arguments oracle))
         (domain (make-lamp-domain))
         (*state* (fresh-state)) (state-before (plain-tree *state*))
         (pending (list '())) (results '()) (limits '()))
    (setf *decision-count* 0)
    (loop while pending
          do (let ((prefix (reverse (pop pending))))
               (symbolic::retract-to-depth oracle (symbolic::shared-depth oracle prefix))
               (let* ((path (symbolic::make-path :plan 'expression :domain domain :oracle oracle
                                                 :prefix prefix :repeated (length prefix)
                                                 :symbolic-p (and arguments t) :jumps-left 10000))
                      (outcome (run-expression function path values)))
                 (incf *decision-count* (length (symbolic::path-decisions path)))
                 (setf pending (append (symbolic::path-alternatives path) pending)
                       limits (append (symbolic::path-limits path) limits))
                 (push (covered-assignments (symbolic::path-solver path) values assignments outcome)
                       results))))
    (symbolic::close-oracle oracle)
    (unless (equal state-before (plain-tree *state*))
      (push "the state before the run has changed" limits))
    (values (nreverse results) limits arguments)))

(defun compiled-lambda (names form)
  "Return (lambda NAMES FORM), compiled by SBCL."
  (handler-bind ((warning #'muffle-warning))
    (let ((*error-output* (make-broadcast-stream)))
      (compile nil `(lambda ,names
                      (declare (ignorable ,@names) (optimize (safety 3) (debug 0)))
                      ,form)))))

(defun concrete-outcome (function values)
  "Return the outcome of the compiled FUNCTION with VALUES, as a tree."
  (let ((*state* (fresh-state)))
    (plain-tree (handler-case (cons :values (multiple-value-list (apply function values)))
                  (error () (list :error))))))

(defun expression-problem (form)
  "Return NIL if the paths of FORM are what brute force says, else a text that says what is wrong;
and the number of paths."
  (multiple-value-bind (paths limits arguments) (explore-expression form)
    (let* ((names (mapcar #'first arguments))
           (*standard-output* (make-broadcast-stream))
           (function (compiled-lambda names form)))
      (values
       (or (and limits (format nil "~s is incomplete: ~{~a~^; ~}" form limits))
           (dolist (assignment (assignments arguments) nil)
             (let ((covering (loop for path in paths
                                   for entry = (assoc assignment path :test #'equal)
                                   when entry collect (cdr entry)))
                   (expected (concrete-outcome function assignment)))
               (cond ((/= (length covering) 1)
                      (return (format nil "~s: ~d paths for ~{~s ~s~^, ~}" form (length covering)
                                      (mapcan #'list names assignment))))
                     ((not (equal (first covering) expected))
                      (return (format nil "~s is ~s for ~{~s ~s~^, ~}, and the path says ~s" form
                                      expected (mapcan #'list names assignment)
                                      (first covering))))))))
       (length paths)))))
