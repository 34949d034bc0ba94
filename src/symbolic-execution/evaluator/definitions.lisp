;;;; Definitions inside of forms: DEFUN, DEFMETHOD, DEFSTRUCT, load-time matters.
;;;;
;;;; What is defined is SBCL's, with interpreted bodies.  On a path the definition of a function is
;;;; undone after it.  DEFCLASS, DEFINE-CONDITION, DEFTYPE and others need no mention here: their
;;;; expansions do the right thing.

(in-package #:discrepancy-finder.symbolic-execution)

(define-analyzer defun (form scope)
  (destructuring-bind (name lambda-list . body) (rest form)
    (unless (sb-int:legal-fun-name-p name) (unsupported form "it has no name of a function"))
    (let ((maker (local-function-maker name lambda-list body scope))
          (documentation (nth-value 2 (alexandria:parse-body body :documentation t))))
      (declare (type function maker))
      (code (frame)
        (define-function name (run maker frame) documentation)))))

(defun define-function (name function documentation)
  "Define the global function NAME and return NAME."
  (let ((old (and (fboundp name)
                  (not (and (symbolp name) (macro-function name)))
                  (fdefinition name))))
    (note-undo (lambda ()
                 (if old (setf (fdefinition name) old) (fmakunbound name)))))
  (sb-c:%compiler-defun name nil nil nil)
  (setf (fdefinition name) function)
  (when documentation
    (setf (documentation name 'function) documentation))
  name)

(define-analyzer defmacro (form scope)
  (destructuring-bind (name lambda-list . body) (rest form)
    (unless (symbolp name) (unsupported form "the name of a macro is a symbol"))
    (let ((expander (analyze (sb-cltl2:parse-macro name lambda-list body
                                                   (scope-environment scope))
                             scope))
          (documentation (nth-value 2 (alexandria:parse-body body :documentation t))))
      (declare (type function expander))
      (code (frame)
        (setf (macro-function name) (run expander frame))
        (when documentation
          (setf (documentation name 'function) documentation))
        name))))

;;; The functions of structures are compiled, unless default values are of a lexical scope

(define-analyzer defstruct (form scope)
  (if (or (scope-variables scope) (scope-functions scope))
      (analyze-macro form scope)
      (code (frame) (eval form))))

(define-analyzer define-method-combination (form scope)
  (code (frame) (eval form)))

;;; Methods

(defstruct (method-parts (:copier nil))
  "A DEFMETHOD form taken apart.  LAMBDA-LIST has no specializers."
  name qualifiers specializers lambda-list body)

(defun method-parts (form)
  "Return the parts of FORM, a DEFMETHOD form."
  (destructuring-bind (name . rest) (rest form)
    (let* ((at (or (position-if #'listp rest) (unsupported form "it has no lambda list")))
           (lambda-list (nth at rest))
           (required (or (position-if (lambda (part) (member part lambda-list-keywords))
                                      lambda-list)
                         (length lambda-list))))
      (make-method-parts
       :name name :qualifiers (subseq rest 0 at) :body (nthcdr (1+ at) rest)
       :specializers (loop for parameter in (subseq lambda-list 0 required)
                           collect (if (consp parameter) (second parameter) t))
       :lambda-list (append (loop for parameter in (subseq lambda-list 0 required)
                                  collect (if (consp parameter) (first parameter) parameter))
                            (nthcdr required lambda-list))))))

(defun open-lambda-list (lambda-list)
  "Return LAMBDA-LIST, of a method, such that it takes the keywords of all methods: the generic
function checks them."
  (if (and (member '&key lambda-list) (not (member '&allow-other-keys lambda-list)))
      (let ((aux (member '&aux lambda-list)))
        (append (ldiff lambda-list aux) '(&allow-other-keys) aux))
      lambda-list))

(defun method-lambda (parts cell)
  "Return the lambda expression for the method of PARTS: of the list of the arguments, and of the
next method as a function of such a list, or NIL.  CELL is going to hold the method."
  (let ((arguments (gensym "ARGUMENTS")) (next (gensym "NEXT"))
        (name (method-parts-name parts)))
    (multiple-value-bind (forms declarations)
        (alexandria:parse-body (method-parts-body parts) :documentation t)
      `(lambda (,arguments ,next)
         (flet ((next-method-p () (if ,next t nil))
                (call-next-method (&rest arguments)
                  (if ,next
                      (funcall ,next (or arguments ,arguments))
                      (no-further-method ',cell (or arguments ,arguments)))))
           (apply (lambda ,(open-lambda-list (method-parts-lambda-list parts))
                    ,@declarations
                    (block ,(if (consp name) (second name) name) ,@forms))
                  ,arguments))))))

(defun no-further-method (cell arguments)
  (let ((method (first cell)))
    (apply #'no-next-method (sb-mop:method-generic-function method) method arguments)))

(defvar *method-codes* (make-hash-table :test 'eq :weakness :key :synchronized t)
  "The interpreted function of each method that has one: of arguments and next method.")

(defun method-code (method)
  "Return the code of the interpreted body of METHOD, a function of the list of the arguments and of
the next method, a function of such a list, or NIL; NIL if METHOD has only a compiled one."
  (or (gethash method *method-codes*)
      (let ((source (plan:method-source method)))
        (and source
             (setf (gethash method *method-codes*)
                   (interpreted-function-code
                    (evaluate-form (method-lambda (method-parts source) (list method)))))))))

(define-analyzer defmethod (form scope)
  (let* ((parts (method-parts form))
         (cell (list nil))
         (function (analyze `(function ,(method-lambda parts cell)) scope))
         (specializers (loop for specializer in (method-parts-specializers parts)
                             collect (if (typep specializer '(cons (eql eql)))
                                         (analyze (second specializer) scope)
                                         specializer))))
    (declare (type function function))
    (code (frame)
      (setf (first cell)
            (add-interpreted-method
             parts
             (loop for specializer in specializers
                   collect (if (functionp specializer)
                               (sb-mop:intern-eql-specializer (run specializer frame))
                               specializer))
             (run function frame))))))

(defun add-interpreted-method (parts specializers function)
  "Add the method of PARTS with SPECIALIZERS and the interpreted FUNCTION and return it."
  (let* ((generic (generic-function-for parts))
         (specializers (loop for specializer in specializers
                             collect (if (symbolp specializer)
                                         (find-class specializer)
                                         specializer)))
         (old (find-method generic (method-parts-qualifiers parts) specializers nil))
         (code (interpreted-function-code function))
         (cell (list nil))
         (method (make-instance
                  (sb-mop:generic-function-method-class generic)
                  :lambda-list (method-parts-lambda-list parts)
                  :qualifiers (method-parts-qualifiers parts)
                  :specializers specializers
                  :documentation (nth-value 2 (alexandria:parse-body (method-parts-body parts)
                                                                     :documentation t))
                  :function (lambda (arguments next-methods)
                              (funcall function arguments
                                       (next-function next-methods (first cell)))))))
    (setf (first cell) method)
    (add-method generic method)
    (setf (gethash method *method-codes*) code)
    (note-undo (lambda ()
                 (remove-method generic method)
                 (when old (add-method generic old))))
    method))

(defun next-function (next-methods method)
  "Return the first of NEXT-METHODS, as SBCL hands them to METHOD, as a function of a list of
arguments, or NIL."
  (let ((next (first next-methods))
        (generic (sb-mop:method-generic-function method)))
    (cond ((null next-methods) nil)
          ;; What stands for all methods after the last :AROUND forgets which come after its first.
          ((and (null (sb-mop:method-generic-function next)) (standard-combination-p generic))
           (lambda (arguments)
             (call-applicable-methods generic arguments arguments nil :around nil)))
          (t (lambda (arguments)
               (funcall (the function (sb-mop:method-function next))
                        arguments (rest next-methods)))))))

(defun generic-function-for (parts)
  "Return the generic function to which the method of PARTS belongs; make it if need be."
  (let ((name (method-parts-name parts)))
    (if (and (fboundp name) (typep (fdefinition name) 'generic-function))
        (fdefinition name)
        (ensure-generic-function
         name :lambda-list (generic-lambda-list (method-parts-lambda-list parts))))))

(defun generic-lambda-list (lambda-list)
  "Return the lambda list of a generic function that is made for a method with LAMBDA-LIST."
  (multiple-value-bind (required optional rest keys allow-other-keys aux keyp)
      (alexandria:parse-ordinary-lambda-list lambda-list)
    (declare (ignore keys allow-other-keys aux))
    (append required
            (and optional (cons '&optional (mapcar #'first optional)))
            (and rest (list '&rest rest))
            (and keyp '(&key &allow-other-keys)))))
