;;;; Variables: LET, LET*, PROGV, SETQ and declarations.
;;;;
;;;; Of declarations the special ones are obeyed.  A lexical variable is an element of a frame.  A
;;;; special one is bound with PROGV; compiled code may read it, hence it holds nothing symbolic.

(in-package #:discrepancy-finder.symbolic-execution)

(defun split-body (body scope)
  "Return the forms of BODY and the variables that its declarations declare special."
  (declare (ignore scope))
  (multiple-value-bind (forms declarations) (alexandria:parse-body body)
    (values forms (declared-specials declarations))))

(defun declared-specials (declarations)
  "Return the variables that DECLARATIONS, a list of DECLARE forms, declare special."
  (loop for (nil . specifiers) in declarations
        append (loop for specifier in specifiers
                     when (and (consp specifier) (eq (first specifier) 'special))
                       append (rest specifier))))

(defun special-p (name specials)
  "Return true if a binding of NAME is special: it is among SPECIALS, those declared so by the form
that binds it, or globally."
  (or (member name specials) (globally-special-p name)))

(defun check-variable (name form)
  (cond ((not (symbolp name)) (unsupported form "a variable is a symbol"))
        ((eq (global-variable-kind name) :constant)
         (error 'sb-int:simple-program-error
                :format-control "~s names a constant, and cannot be bound or set."
                :format-arguments (list name)))))

(defun binding-parts (binding form)
  (typecase binding
    (symbol (check-variable binding form) (values binding nil))
    ((cons symbol (or null (cons t null)))
     (check-variable (first binding) form)
     (values (first binding) (second binding)))
    (t (unsupported form "it has a binding that is neither a variable nor (variable form)"))))

(defun special-value (name value)
  "Return VALUE, decided, for the special variable NAME.  A list of restarts holds functions of the
plan, and nothing else that compiled code looks at."
  (if (eq name 'sb-kernel:*restart-clusters*)
      value
      (decided value "a special variable")))

(defun call-with-special (name value function)
  "Bind the special variable NAME to VALUE and call FUNCTION."
  (declare (type function function))
  (let ((value (special-value name value)))
    (if *path*
        (with-forgotten-writes ((list name))
          (progv (list name) (list value) (funcall function)))
        (progv (list name) (list value) (funcall function)))))

(defun bind-in-order (bindings scope specials analyze-inside)
  "Return the code that binds variables one after the other in its frame, SCOPE's innermost one, and
then runs what ANALYZE-INSIDE, a function of the inner scope, returns.  BINDINGS is a list of
(name . function): the function returns, for a scope, the code of the value.  SPECIALS are the
variables declared special by the form."
  (if (null bindings)
      (funcall analyze-inside scope)
      (destructuring-bind ((name . analyzer) . more) bindings
        (let ((value (let ((*exits* '()) (*tails* '()) (*jumps* 0)) (funcall analyzer scope))))
          (declare (type function value))
          (if (special-p name specials)
              (let ((inside (bind-in-order more (scope-with-specials scope (list name)) specials
                                           analyze-inside)))
                (declare (type function inside))
                (code (frame)
                  (call-with-special name (run value frame)
                                     (lambda () (run inside frame)))))
              (multiple-value-bind (scope index) (scope-with-variable scope name)
                (declare (type fixnum index))
                (let ((inside (bind-in-order more scope specials analyze-inside)))
                  (declare (type function inside))
                  (code (frame)
                    (setf (svref frame index) (run value frame))
                    (run inside frame)))))))))

(define-analyzer let* (form scope)
  (multiple-value-bind (forms specials) (split-body (cddr form) scope)
    (analyze-in-frame
     scope
     (lambda (scope)
       (bind-in-order
        (loop for binding in (second form)
              collect (multiple-value-bind (name value) (binding-parts binding form)
                        (cons name (lambda (scope) (analyze value scope)))))
        scope specials
        (lambda (scope) (analyze-body forms (scope-with-specials scope specials))))))))

(define-analyzer let (form scope)
  (multiple-value-bind (forms specials) (split-body (cddr form) scope)
    (let ((names (loop for binding in (second form)
                       collect (values (binding-parts binding form))))
          (values (loop for binding in (second form)
                        collect (analyze (nth-value 1 (binding-parts binding form)) scope))))
      (unless (= (length names) (length (remove-duplicates names)))
        (unsupported form "it binds a variable twice"))
      (cond ((null names) (analyze-body forms (scope-with-specials scope specials)))
            ((some (lambda (name) (special-p name specials)) names)
             (analyze-special-let names values forms specials scope))
            (t (analyze-lexical-let names values forms specials scope))))))

(defun analyze-lexical-let (names values forms specials scope)
  (multiple-value-bind (inner layout) (scope-with-frame scope names)
    (let ((inside (analyze-body forms (scope-with-specials inner specials))))
      (declare (type function inside))
      (frame-code layout values inside))))

(defun scope-with-frame (scope names)
  "Return SCOPE with a new frame of the lexical variables NAMES, and its layout."
  (let ((layout (make-layout :size (1+ (length names)))))
    (values (extend-scope scope :layout layout
                                :variables (loop for name in names for index from 1
                                                 collect (cons name (make-place layout index)))
                                :augmentation (list :variable names))
            layout)))

(defun frame-code (layout values inside)
  "Return the code that makes a frame of LAYOUT, whose first elements are the values of the codes
VALUES, and runs INSIDE in it."
  (declare (type function inside))
  (let ((size (layout-size layout)))
    (if (= size (1+ (length values)))
        (with-argument-counts (-arguments- values)
          (code (frame) (run inside (vector frame -arguments-)))
          (code (frame) (run inside (coerce (cons frame (evaluate-arguments values frame))
                                            'simple-vector))))
        (code (frame)
          (let ((new (make-array size :initial-element nil)))
            (setf (svref new 0) frame)
            (loop for value in values for index fixnum from 1
                  do (setf (svref new index) (run value frame)))
            (run inside new))))))

(defun analyze-special-let (names values forms specials scope)
  "The values are computed first, into a frame; then the special ones are bound."
  (multiple-value-bind (inner layout)
      (scope-with-frame scope (loop for name in names
                                    collect (if (special-p name specials) (gensym) name)))
    (let* ((bound (loop for name in names for index fixnum from 1
                        when (special-p name specials) collect (cons name index)))
           (inside (analyze-body forms (scope-with-specials
                                        inner (union (mapcar #'car bound) specials)))))
      (declare (type function inside))
      (frame-code layout values
                  (code (frame)
                    (let ((names (mapcar #'car bound))
                          (values (loop for (name . index) in bound
                                        collect (special-value name (svref frame index)))))
                      (if *path*
                          (with-forgotten-writes (names)
                            (progv names values (run inside frame)))
                          (progv names values (run inside frame)))))))))

(define-analyzer progv (form scope)
  (let ((names (analyze (second form) scope)) (values (analyze (third form) scope))
        (inside (analyze-body (cdddr form) scope)))
    (declare (type function names values inside))
    (code (frame)
      (let ((names (run names frame))
            (values (decided (run values frame) "a special variable")))
        (if *path*
            (with-forgotten-writes (names)
              (progv names values (run inside frame)))
            (progv names values (run inside frame)))))))

;;; Assignment

(define-analyzer setq (form scope)
  (unless (evenp (length (rest form)))
    (error 'sb-int:simple-program-error :format-control "Odd number of arguments to SETQ: ~s"
                                        :format-arguments (list form)))
  (let ((assignments (loop for (name value) on (rest form) by #'cddr
                           collect (analyze-assignment name value scope form))))
    (if assignments
        (reduce (lambda (first rest) (sequence-code first nil rest)) assignments :from-end t)
        (constant-code nil))))

(defun analyze-assignment (name value scope form)
  (check-variable name form)
  (let ((meaning (variable-meaning name scope)))
    (cond ((eq meaning :symbol-macro) (analyze `(setf ,name ,value) scope))
          ((place-p meaning) (frame-writer meaning scope (analyze value scope)))
          (t (let ((value (analyze value scope)))
               (declare (type function value))
               (code (frame)
                 (let ((new (decided (run value frame) "a special variable")))
                   (when *path* (note-write name))
                   (set name new))))))))

;;; Declarations and local macros

(define-analyzer locally (form scope)
  (multiple-value-bind (forms specials) (split-body (rest form) scope)
    (analyze-body forms (scope-with-specials scope specials))))

(define-analyzer symbol-macrolet (form scope)
  (multiple-value-bind (forms specials) (split-body (cddr form) scope)
    (let ((names (mapcar #'first (second form))))
      (dolist (name names)
        (check-variable name form)
        (when (special-p name specials)
          (error 'sb-int:simple-program-error
                 :format-control "~s is special, and cannot be a symbol macro."
                 :format-arguments (list name))))
      (analyze-body forms
                    (scope-with-specials
                     (extend-scope scope
                                   :variables (loop for name in names
                                                    collect (cons name :symbol-macro))
                                   :augmentation (list :symbol-macro (second form)))
                     specials)))))

(define-analyzer macrolet (form scope)
  (multiple-value-bind (forms specials) (split-body (cddr form) scope)
    (let ((macros (loop for (name lambda-list . body) in (second form)
                        collect (list name (local-expander name lambda-list body scope)))))
      (analyze-body forms
                    (scope-with-specials
                     (extend-scope scope
                                   :functions (loop for (name) in macros
                                                    collect (cons name :macro))
                                   :augmentation (and macros (list :macro macros)))
                     specials)))))

(defun local-expander (name lambda-list body scope)
  "Return the expander of a local macro: it sees the macros of SCOPE, but no run-time values."
  (let ((environment (scope-environment scope)))
    (funcall (the function
                  (analyze (sb-cltl2:parse-macro name lambda-list body environment)
                           (extend-scope scope :variables '())))
             (vector nil))))
