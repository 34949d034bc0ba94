;;;; Structures and instances: their slots are read and written as they are.
;;;;
;;;; A slot with a type is given a decided value.  Functions of a structure (constructors, readers,
;;;; setters) and accessors of classes need no entry in the table: they are known when they are
;;;; asked for.

(in-package #:discrepancy-finder.symbolic-execution)

;;; Structures

(defun structure-slot (instance index)
  "Return SBCL's description of the slot of the structure INSTANCE at INDEX, or NIL."
  (find index (structure-slots (type-of instance)) :key #'sb-kernel:dsd-index))

(defun slot-element (value slot)
  "Return VALUE, settled if the structure SLOT has a type, which it must have then."
  (if (and (symbolic-value-p value) slot (not (eq (sb-kernel:dsd-type slot) t)))
      (let ((value (settled value "the value of a slot")))
        (unless (typep value (sb-kernel:dsd-type slot))
          (error 'type-error :datum value :expected-type (sb-kernel:dsd-type slot)))
        value)
      value))

(define-transparent (sb-kernel:%instance-set) (instance index any-value)
  (if *path*
      (let ((value (slot-element any-value (and (symbolic-value-p any-value)
                                                (structure-slot instance index)))))
        (note-place (sb-kernel:%instance-ref instance index))
        (sb-kernel:%instance-set instance index value)
        (values))
      (sb-kernel:%instance-set instance index any-value)))

(define-transparent sb-kernel:%instance-ref (any-instance any-index))

(macrolet ((define (&rest names)
             `(progn
                ,@(loop for name in names
                        for setter = (find-symbol (format nil "%RAW-INSTANCE-SET/~a" name)
                                                  '#:sb-kernel)
                        for reader = (find-symbol (format nil "%RAW-INSTANCE-REF/~a" name)
                                                  '#:sb-kernel)
                        when (and setter reader)
                          collect `(define-transparent (,setter) (instance index value)
                                     (when *path*
                                       (let ((old (,reader instance index)))
                                         (note-undo (lambda () (,setter instance index old)))))
                                     (,setter instance index
                                              (settled value "the value of a slot")))))))
  (define "WORD" "SIGNED-WORD" "SINGLE" "DOUBLE" "COMPLEX-SINGLE" "COMPLEX-DOUBLE"))

(define-transparent copy-structure (structure))

(defun constructor-version (function description)
  "Return the version of FUNCTION, the constructor of the structure that DESCRIPTION describes."
  (let ((typed (remove t (sb-kernel:dd-slots description) :key #'sb-kernel:dsd-type)))
    (if (null typed)
        function
        (lambda (&rest arguments)
          (apply (the function function)
                 (settled-each arguments "the value of a slot"))))))

(defun structure-setter-version (function slot)
  "Return the version of FUNCTION, which stores a value in the structure SLOT."
  (declare (function function))
  (let ((reader (fdefinition (sb-kernel:dsd-accessor-name slot))))
    (declare (function reader))
    (lambda (value instance)
      (let ((instance (settled instance "a structure")))
        (when *path*
          (let ((old (funcall reader instance)))
            (note-undo (lambda () (funcall function old instance)))))
        (funcall function (slot-element value slot) instance)))))

(defun structure-version (name)
  "Return the version of the function NAME of a structure, or NIL if it is none."
  (let ((setter (and (consp name) (eq (first name) 'setf))))
    (when (and (fboundp name) (or setter (symbolp name)))
      (let* ((information (sb-int:info :function :source-transform
                                       (if setter (second name) name)))
             (role (and (consp information) (cdr information)))
             (function (fdefinition name)))
        (cond ((null role) nil)
              ((typep role 'sb-kernel:defstruct-slot-description)
               (cond ((not setter) (structure-reader-version function))
                     ((sb-kernel:dsd-read-only role) nil)
                     (t (structure-setter-version function role))))
              (setter nil)
              ((eq role :constructor) (constructor-version function (car information)))
              (t (structure-reader-version function)))))))

(defun structure-reader-version (function)
  "Return the version of FUNCTION, a reader, predicate or copier of structures."
  (declare (function function))
  (lambda (&rest arguments)
    (declare (dynamic-extent arguments))
    (if (and arguments (null (rest arguments)))
        (let ((value (first arguments)))
          (funcall function (if (symbolic-value-p value) (settled value "a structure") value)))
        (apply function arguments))))

;;; Instances

(defun slot-type (object name)
  "Return the type of the slot NAME of OBJECT."
  (let ((slot (find name (sb-mop:class-slots (class-of object))
                    :key #'sb-mop:slot-definition-name)))
    (if slot (sb-mop:slot-definition-type slot) t)))

(defun slot-content (value object name)
  (if (and (symbolic-value-p value) (not (eq (slot-type object name) t)))
      (settled value "the value of a slot")
      value))

(defun note-slot (object name)
  "Note that the slot NAME of OBJECT must be as it is after the run."
  (when (and *path* (slot-exists-p object name))
    (if (slot-boundp object name)
        (note-place (slot-value object name))
        (note-undo (lambda () (slot-makunbound object name))))))

(define-transparent slot-value (object name))
(define-transparent slot-boundp (object name))
(define-transparent slot-exists-p (object name))

(defun set-slot (object name value)
  (let ((object (settled object "an instance")) (name (settled name "the name of a slot")))
    (note-slot object name)
    (setf (slot-value object name) (slot-content value object name))))

(define-transparent (sb-pcl::set-slot-value) (object name any-value)
  (set-slot object name any-value))

(define-transparent ((setf slot-value)) (any-value object name)
  (set-slot object name any-value))

(define-transparent (slot-makunbound) (object name)
  (let ((object (settled object "an instance")) (name (settled name "the name of a slot")))
    (note-slot object name)
    (slot-makunbound object name)))

;;; Accessors are generic functions whose methods only read or write a slot

(defun accessor-p (function)
  "Return :READER or :WRITER if all methods of FUNCTION, a generic function, only read or only write
a slot."
  (let ((methods (sb-mop:generic-function-methods function)))
    (flet ((all-p (type)
             (and methods (every (lambda (method) (typep method type)) methods))))
      (cond ((all-p 'sb-mop:standard-reader-method) :reader)
            ((all-p 'sb-mop:standard-writer-method) :writer)))))

(defun written-slot (function object)
  "Return the name of the slot that the writer FUNCTION writes in OBJECT, or NIL."
  (loop for class in (sb-mop:class-precedence-list (class-of object))
        for method = (find class (sb-mop:generic-function-methods function)
                           :key (lambda (method) (second (sb-mop:method-specializers method))))
        when method
          return (sb-mop:slot-definition-name (sb-mop:accessor-method-slot-definition method))))

(defun accessor-version (function)
  "Return the version of FUNCTION, a generic function that is an accessor now; it may get other
methods later."
  (let ((description (function-description function)))
    (lambda (&rest arguments)
      (case (accessor-p function)
        (:reader (apply function (settled-each arguments description)))
        (:writer
         (destructuring-bind (value object) arguments
           (let* ((object (settled object description)) (name (written-slot function object)))
             (when name
               (note-slot object name))
             (funcall function (if name (slot-content value object name) value) object))))
        (t (call-opaque function arguments description))))))

;;; Making instances

(defun plain-class-p (class)
  "Return true if instances of CLASS are initialized by the methods of Common Lisp alone."
  (and (sb-mop:class-finalized-p class)
       (let ((prototype (sb-mop:class-prototype class)))
         (flet ((plain-p (function)
                  (let ((methods (compute-applicable-methods
                                  function (if (eq function #'shared-initialize)
                                               (list prototype t)
                                               (list prototype)))))
                    (null (rest methods)))))
           (and (plain-p #'initialize-instance) (plain-p #'shared-initialize))))))

(define-transparent (make-instance) (class &rest keywords)
  (if (symbolic-run-p)
      (let* ((class (settled class "a class"))
             (object (if (symbolp class) (find-class class) class)))
        (unless (sb-mop:class-finalized-p object)
          (sb-mop:finalize-inheritance object))
        (apply #'make-instance class
               (if (plain-class-p object)
                   (initialization-arguments object keywords)
                   (loop for keyword in keywords
                         collect (decided keyword "an argument of make-instance")))))
      (apply #'make-instance class keywords)))

(defun initialization-arguments (class keywords)
  "Return KEYWORDS with values that the slots of CLASS may have."
  (loop for (keyword value) on keywords by #'cddr
        for slots = (remove-if-not (lambda (slot)
                                     (member keyword (sb-mop:slot-definition-initargs slot)))
                                   (sb-mop:class-slots class))
        collect keyword
        collect (if (and slots (every (lambda (slot) (eq (sb-mop:slot-definition-type slot) t))
                                      slots))
                    value
                    (settled value "an argument of make-instance"))))
