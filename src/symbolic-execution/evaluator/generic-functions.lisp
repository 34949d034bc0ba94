;;;; Calls of generic functions on a path.
;;;;
;;;; The methods that a plan file or a plan has defined are interpreted there, hence may be given
;;;; symbolic values: what SBCL's dispatch would do is done here, for the standard method
;;;; combination.  An argument by which methods are chosen is decided, but a symbolic number that
;;;; only its class is asked of is not.

(in-package #:discrepancy-finder.symbolic-execution)

(defun interpreted-generic-p (function)
  "Return true if FUNCTION is a generic function with a method that can be interpreted."
  (and (typep function 'standard-generic-function)
       (standard-combination-p function)
       (some #'method-code (sb-mop:generic-function-methods function))))

(defun standard-combination-p (function)
  (eq (type-of (sb-mop:generic-function-method-combination function))
      'sb-pcl::standard-method-combination))

(defun call-generic (function arguments description)
  "Call FUNCTION, a generic function with interpreted methods, with ARGUMENTS on a path."
  (let* ((required (length (sb-mop:generic-function-argument-precedence-order function)))
         (arguments (if (symbolic-run-p)
                        (settled-for-dispatch function required arguments description)
                        arguments)))
    (call-applicable-methods function arguments
                             (if (symbolic-run-p) (mapcar #'representative arguments) arguments)
                             description)))

(defun call-applicable-methods (function arguments representatives description &key (around t))
  "Call the methods of FUNCTION that apply to REPRESENTATIVES with ARGUMENTS, without those that are
qualified :AROUND unless AROUND."
  (let ((methods (compute-applicable-methods function representatives)))
    (flet ((qualified (&rest qualifiers)
             (remove qualifiers methods :key #'method-qualifiers :test-not #'equal)))
      (let ((primary (qualified)))
        (if primary
            (call-methods (and around (qualified :around)) (qualified :before) primary
                          (reverse (qualified :after)) arguments description)
            (call-opaque function arguments description))))))

(defun call-methods (around before primary after arguments description)
  (if around
      (call-method-in-chain around arguments description
                            (lambda (arguments)
                              (call-methods '() before primary after arguments description)))
      (progn
        (dolist (method before)
          (call-method-in-chain (list method) arguments description nil))
        (multiple-value-prog1 (call-method-in-chain primary arguments description nil)
          (dolist (method after)
            (call-method-in-chain (list method) arguments description nil))))))

(defun call-method-in-chain (methods arguments description last)
  "Call the first of METHODS with ARGUMENTS; the others are its next methods, LAST, a function of a
list of arguments or NIL, comes after them."
  (let* ((next (if (rest methods)
                   (lambda (arguments)
                     (call-method-in-chain (rest methods) arguments description last))
                   last))
         (method (first methods))
         (code (method-code method)))
    (cond (code (funcall (the function code) arguments next))
          ((typep method 'sb-mop:standard-accessor-method) (access-slot method arguments))
          (t (funcall (the function (sb-mop:method-function method))
                      (if (symbolic-run-p)
                          (loop for argument in arguments collect (decided argument description))
                          arguments)
                      (and next
                           (list (lambda (arguments next-methods)
                                   (declare (ignore next-methods))
                                   (funcall next arguments)))))))))

(defun access-slot (method arguments)
  "Do what METHOD, which reads or writes a slot, does with ARGUMENTS.  Its function is of another
kind than those of other methods."
  (let ((slot (sb-mop:slot-definition-name (sb-mop:accessor-method-slot-definition method))))
    (destructuring-bind (first &optional second) arguments
      (if (typep method 'sb-mop:standard-writer-method)
          (funcall (the function (or (lifted-function '(setf slot-value)) #'(setf slot-value)))
                   first second slot)
          (slot-value first slot)))))

(defun settled-for-dispatch (function required arguments description)
  "Return ARGUMENTS such that the first REQUIRED of them decide which methods of FUNCTION apply."
  (loop for argument in arguments
        for index from 0
        collect (if (and (symbolic-value-p argument) (< index required)
                         (not (dispatched-by-type-p function index argument)))
                    (settled argument description)
                    argument)))

(defun dispatched-by-type-p (function index argument)
  "Return true if every method of FUNCTION takes any argument INDEX or, ARGUMENT being a symbolic
number, asks for its class."
  (loop for method in (sb-mop:generic-function-methods function)
        for specializer = (nth index (sb-mop:method-specializers method))
        always (or (eq specializer (find-class t))
                   (and (symbolic-number-p argument) (typep specializer 'class)
                        (subtypep (symbolic-number-type argument) 'integer)))))

(defun representative (argument)
  "Return an object of the class of ARGUMENT."
  (cond ((symbolic-number-p argument) 0)
        ((symbolic-value-p argument) nil)
        (t argument)))

(defun generic-function-code (function name)
  "Return the code of calls of the generic FUNCTION with NAME."
  (let ((site (make-site name)))
    (lambda (&rest arguments)
      (cond ((and *path* (interpreted-generic-p function))
             (call-generic function arguments (site-description site)))
            ((null *path*) (apply function arguments))
            (t (let ((version (lifted-function name)))
                 (if version
                     (apply (the function version) arguments)
                     (call-opaque function arguments (site-description site)))))))))

;;; Functions of plan files that close over something

(setf plan:*closure-evaluator* #'evaluate)
