;;;; Calls of functions.
;;;;
;;;; A CALLEE stands for a global function at all the places where it is called; it notices when the
;;;; function is defined again.  Plans are interpreted.  As long as nothing is symbolic the function
;;;; itself is called, if it changes nothing, else the version of it that understands symbolic
;;;; arguments, or it gets its arguments decided.  Calls with up to four arguments make no list of
;;;; them.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (callee (:constructor make-callee (name definition)) (:copier nil))
  "NAME is the function's; SEEN the function that DEFINITION, SBCL's entry for the name, held when
CODE, the function to be called for it, was found.  KIND and VERSION are what FUNCTION-VERSIONS
returns."
  (name nil :read-only t)
  (definition nil :type sb-kernel:fdefn :read-only t)
  (seen nil :type (or null function))
  (code #'identity :type function)
  (interpreted-p nil :type boolean)
  (kind :opaque :type keyword)
  (version nil :type (or null function)))

(declaim (sb-ext:freeze-type callee))

(defvar *callees* (make-hash-table :test 'equal :synchronized t)
  "The callee of each name of a global function that was called.")

(defun find-callee (name)
  "Return the callee of the global function NAME, a symbol or (setf symbol)."
  (or (gethash name *callees*)
      (setf (gethash name *callees*)
            (make-callee name (sb-kernel::find-or-create-fdefn name)))))

(declaim (inline callee-function))
(defun callee-function (callee)
  "Return the function to be called for CALLEE.  Signals UNDEFINED-FUNCTION."
  (let ((function (sb-kernel:fdefn-fun (callee-definition callee))))
    (if (and function (eq function (callee-seen callee)))
        (callee-code callee)
        (look-up-callee callee))))

(defun look-up-callee (callee)
  (let* ((name (callee-name callee))
         (function (if (fboundp name) (global-function name) (undefined-caller name))))
    (multiple-value-bind (kind version always) (function-versions name)
      (setf (callee-code callee)
            (cond ((interpreted-function-p function) (interpreted-function-code function))
                  ((typep function 'generic-function) (generic-function-code function name))
                  ((and always version))
                  (t function))
            ;; Such code knows itself what to do with symbolic values.
            (callee-interpreted-p callee) (not (eq (callee-code callee) function))
            (callee-kind callee) kind
            (callee-version callee) version
            (callee-seen callee) (sb-kernel:fdefn-fun (callee-definition callee))))
    (callee-code callee)))

(defun global-function (name)
  "Return the function that a call of NAME means: a plan is interpreted, all else is as defined."
  (let ((plan (plan:plan-source name)))
    (if plan (interpreted-plan plan) (defined-function name))))

(defun undefined-caller (name)
  "Return a function that calls the undefined function NAME, which SBCL has restarts for."
  (if (symbolp name)
      (lambda (&rest arguments) (apply name arguments))
      (defined-function name)))

(defun defined-function (name)
  "Return the global function NAME.  Signals UNDEFINED-FUNCTION."
  (if (or (not (fboundp name))
          (and (symbolp name) (or (macro-function name) (special-operator-p name))))
      (error 'undefined-function :name name)
      (fdefinition name)))

(defun call-among-symbols (callee site &rest arguments)
  "Call the function of CALLEE with ARGUMENTS while there are symbolic values."
  (let ((function (callee-function callee)))
    (cond ((callee-interpreted-p callee) (apply function arguments))
          ((callee-version callee) (apply (the function (callee-version callee)) arguments))
          ((eq (callee-kind callee) :opaque)
           (call-opaque function arguments (site-description site)))
          (t (apply function arguments)))))

(defmacro with-argument-counts ((arguments code-list &key (maximum 4)) call general)
  "Evaluate CALL where CODE-LIST has at most MAXIMUM elements, with ARGUMENTS replaced in it by
forms that evaluate them in FRAME, and else GENERAL."
  (let ((codes (loop repeat maximum collect (gensym "CODE"))))
    `(case (length ,code-list)
       ,@(loop for count to maximum
               collect (let ((used (subseq codes 0 count)))
                         `(,count
                           (destructuring-bind ,used ,code-list
                             (declare (type function ,@used))
                             ,(subst-arguments (loop for code in used collect `(run ,code frame))
                                               arguments call)))))
       (t ,general))))

(eval-when (:compile-toplevel :load-toplevel :execute)
  (defun subst-arguments (forms marker tree)
    "Return TREE with FORMS spliced in for MARKER."
    (cond ((atom tree) tree)
          ((eq (first tree) marker) (append forms (subst-arguments forms marker (rest tree))))
          (t (cons (subst-arguments forms marker (first tree))
                   (subst-arguments forms marker (rest tree)))))))

(defun evaluate-arguments (codes frame)
  (loop for code in codes collect (run code frame)))

;;; Global functions

(defun analyze-global-call (form scope)
  (or (analyze-inline-call form scope)
      (global-call-code (find-callee (first form)) (make-site form)
                        (analyze-all (rest form) scope))))

(defmacro call-callee (callee site &rest arguments)
  "Call CALLEE with ARGUMENTS, forms that are evaluated first."
  (let ((values (loop for nil in arguments collect (gensym "ARGUMENT"))))
    `(let ,(mapcar #'list values arguments)
       (if (symbolic-run-p)
           (call-among-symbols ,callee ,site ,@values)
           (funcall (callee-function ,callee) ,@values)))))

(defun global-call-code (callee site codes)
  (with-argument-counts (-arguments- codes)
    (code (frame) (call-callee callee site -arguments-))
    (code (frame)
      (let ((arguments (evaluate-arguments codes frame)))
        (if (symbolic-run-p)
            (apply #'call-among-symbols callee site arguments)
            (apply (callee-function callee) arguments))))))

;;; Functions that are values

(declaim (inline function-to-call))
(defun function-to-call (function)
  "Return what is to be called for FUNCTION, a function or a symbol."
  (cond ((interpreted-function-p function) (interpreted-function-code function))
        ((and (functionp function) (null *path*)) function)
        (t (designated-function function))))

(defun designated-function (function)
  (cond ((and (symbolp function) (null *path*))
         (callee-function (find-callee function)))
        ((typep function '(or function symbol)) (code-of function))
        (t (error 'type-error :datum function :expected-type '(or function symbol)))))

(define-analyzer (funcall sb-c::%funcall) (form scope)
  (if (null (rest form))
      (global-call-code (find-callee 'funcall) (make-site form) '())
      (let ((function (analyze (second form) scope))
            (codes (analyze-all (cddr form) scope)))
        (declare (type function function))
        (value-call-code function codes))))

(defmacro call-value (function &rest arguments)
  (let ((values (loop for nil in arguments collect (gensym "ARGUMENT"))))
    `(let* ((function ,function)
            ,@(mapcar #'list values arguments))
       (funcall (the function (function-to-call function)) ,@values))))

(defun value-call-code (function codes)
  "Return the code that calls the value of the code FUNCTION with those of CODES."
  (declare (type function function))
  (with-argument-counts (-arguments- codes)
    (code (frame) (call-value (run function frame) -arguments-))
    (code (frame)
      (let ((function (run function frame)))
        (apply (the function (function-to-call function)) (evaluate-arguments codes frame))))))

(define-analyzer apply (form scope)
  (if (null (cddr form))
      (global-call-code (find-callee 'apply) (make-site form) (analyze-all (rest form) scope))
      (let ((function (analyze (second form) scope))
            (codes (analyze-all (cddr form) scope))
            (description (make-site form)))
        (declare (type function function))
        (code (frame)
          (let ((function (run function frame))
                (arguments (evaluate-arguments codes frame)))
            (apply (the function (function-to-call function))
                   (spread arguments description)))))))

(defun spread (arguments site)
  "Return the list of the arguments that APPLY with ARGUMENTS hands over."
  (let* ((arguments (apply #'list* arguments))
         (end (last arguments)))
    (when (and (cdr end) (symbolic-value-p (cdr end)))
      (setf (cdr end) (decided (cdr end) (site-description site))))
    arguments))

(define-analyzer multiple-value-call (form scope)
  (let ((function (analyze (second form) scope))
        (codes (analyze-all (cddr form) scope)))
    (declare (type function function))
    (if (= (length codes) 1)
        (let ((values (first codes)))
          (declare (type function values))
          (code (frame)
            (let ((function (run function frame)))
              (multiple-value-call (the function (function-to-call function))
                (run values frame)))))
        (code (frame)
          (let ((function (run function frame)))
            (apply (the function (function-to-call function))
                   (loop for code in codes append (multiple-value-list (run code frame)))))))))

;;; Local functions and lambda expressions

(defun analyze-local-call (form place scope)
  (let ((function (frame-reader place scope))
        (codes (analyze-all (rest form) scope)))
    (declare (type function function))
    (with-argument-counts (-arguments- codes)
      (code (frame) (funcall (interpreted-function-code (run function frame)) -arguments-))
      (code (frame)
        (apply (interpreted-function-code (run function frame))
               (evaluate-arguments codes frame))))))

(defun analyze-lambda-call (form scope)
  (value-call-code (analyze `(function ,(first form)) scope)
                   (analyze-all (rest form) scope)))

;;; What performs

(define-analyzer plan:perform (form scope)
  (let ((callee (find-callee 'plan:perform))
        (codes (analyze-all (rest form) scope))
        (position (source:form-position form)))
    (if (= (length codes) 1)
        (let ((designator (first codes)))
          (declare (type function designator))
          ;; The step of the trace says where it was performed.
          (code (frame) (funcall (callee-function callee) (run designator frame) position)))
        (global-call-code callee (make-site form) codes))))
