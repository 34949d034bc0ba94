;;;; Lambda expressions: interpreted functions with full lambda lists.

(in-package #:discrepancy-finder.symbolic-execution)

(defun declared-specials (declarations)
  "Return the variables that DECLARATIONS, a list of DECLARE forms, declare special."
  (loop for (nil . specifiers) in declarations
        append (loop for (kind . arguments) in specifiers
                     when (eq kind 'special) append arguments)))

(defun globally-special-p (symbol)
  (eq (sb-cltl2:variable-information symbol) :special))

(defun declaration-specifiers (declarations)
  "Return the SPECIAL specifiers of DECLARATIONS that say something new; the evaluator ignores the
others."
  (let ((specials (remove-if #'globally-special-p (declared-specials declarations))))
    (and specials `((special ,@specials)))))

(defun special-variable-p (symbol declarations)
  "Return true if a binding of SYMBOL under DECLARATIONS is special: because of them or globally.  A
declaration further out does not count."
  (or (member symbol (declared-specials declarations))
      (globally-special-p symbol)))

(defun call-with-bindings (scope declarations names values body)
  "Return a closure that binds NAMES, in parallel, to the values of the closures VALUES and then
calls the closure that BODY, a function of the inner scope, returns."
  (let* ((specials (remove-if-not (lambda (name) (special-variable-p name declarations))
                                  names))
         (lexicals (set-difference names specials))
         (lexicals (remove-if-not (lambda (name) (member name lexicals)) names))
         (inner (extend-scope scope (or lexicals (list (gensym)))
                              :variable (remove-if #'globally-special-p names)
                              :declare (declaration-specifiers declarations)))
         (run (funcall body inner))
         (size (1+ (max 1 (length lexicals))))
         (places (loop for name in names
                       collect (let ((place (position name lexicals))) (and place (1+ place))))))
    (if specials
        (lambda (frame)
          (let ((new (make-array size :initial-element nil))
                (special-values '()))
            (setf (svref new 0) frame)
            (loop for value in values for place in places
                  do (let ((value (funcall (the function value) frame)))
                       (if place
                           (setf (svref new place) value)
                           ;; Compiled code may read it.
                           (push (decided value "a special variable") special-values))))
            (with-forgotten-writes (specials)
              (progv specials (nreverse special-values) (funcall (the function run) new)))))
        (lambda (frame)
          (let ((new (make-array size :initial-element nil)))
            (setf (svref new 0) frame)
            (loop for value in values for place in places
                  do (setf (svref new place) (funcall (the function value) frame)))
            (funcall (the function run) new))))))

(defun analyze-lambda (name lambda-list body scope)
  "Return a closure that makes the interpreted function with LAMBDA-LIST and BODY."
  (multiple-value-bind (forms declarations) (alexandria:parse-body body :documentation t)
    (multiple-value-bind (required optional rest keywords allow-other-keys aux keyp)
        (alexandria:parse-ordinary-lambda-list lambda-list)
      (if (or optional rest keywords aux keyp)
          (analyze-general-lambda name lambda-list forms declarations scope
                                  (list required optional rest keywords allow-other-keys aux keyp))
          (analyze-simple-lambda name required forms declarations scope)))))

(defun analyze-simple-lambda (name required forms declarations scope)
  (let* ((count (length required))
         (arguments (gensym "ARGUMENTS"))
         (outer (extend-scope scope (list arguments) :variable (list arguments)))
         (run (call-with-bindings
               outer declarations required
               (loop for index below count
                     collect (let ((index index))
                               (lambda (frame) (nth index (svref frame 1)))))
               (lambda (inner) (analyze-body forms inner)))))
    (lambda (frame)
      (make-interpreted-function
       name
       (lambda (&rest values)
         (unless (= (length values) count)
           (error 'sb-int:simple-program-error
                  :format-control "~a takes ~d argument~:p, not ~d."
                  :format-arguments (list (or name "A function") count (length values))))
         (funcall run (vector frame values)))))))

(defun analyze-general-lambda (name lambda-list forms declarations scope parsed)
  "The same for lambda lists with keywords: a compiled function of the same lambda list takes the
arguments apart, the evaluator computes the defaults and binds the variables in order."
  (destructuring-bind (required optional rest keywords allow-other-keys aux keyp) parsed
    (let* ((missing (gensym "MISSING"))
           (plain `(,@required
                    ,@(and optional
                           `(&optional ,@(loop for (variable) in optional
                                               collect `(,variable ',missing))))
                    ,@(and rest `(&rest ,rest))
                    ,@(and keyp `(&key ,@(loop for ((keyword variable)) in keywords
                                               collect `((,keyword ,variable) ',missing))))
                    ,@(and allow-other-keys '(&allow-other-keys))))
           (taken (append required (mapcar #'first optional) (and rest (list rest))
                          (mapcar #'cadar keywords)))
           (splitter (handler-bind ((warning #'muffle-warning))
                       (compile nil `(lambda ,plain (list ,@taken)))))
           (parameters (append (loop for variable in required collect (list variable nil nil))
                               optional
                               (and rest (list (list rest nil nil)))
                               (loop for ((nil variable) init suppliedp) in keywords
                                     collect (list variable init suppliedp))))
           (values-name (gensym "VALUES"))
           (outer (extend-scope scope (list values-name) :variable (list values-name))))
      (labels ((bind (parameters index scope)
                 (if (null parameters)
                     (bind-aux aux scope)
                     (destructuring-bind (variable init suppliedp) (first parameters)
                       (let ((reader (multiple-value-call #'frame-reader
                                       (variable-address values-name scope)))
                             (default (analyze init scope)))
                         (call-with-bindings
                          scope declarations
                          (if suppliedp (list variable suppliedp) (list variable))
                          (cons (lambda (frame)
                                  (let ((value (nth index (funcall reader frame))))
                                    (if (eq value missing) (funcall default frame) value)))
                                (and suppliedp
                                     (list (lambda (frame)
                                             (not (eq (nth index (funcall reader frame))
                                                      missing))))))
                          (lambda (inner) (bind (rest parameters) (1+ index) inner)))))))
               (bind-aux (aux scope)
                 (if aux
                     (destructuring-bind (variable init) (first aux)
                       (call-with-bindings scope declarations (list variable)
                                           (list (analyze init scope))
                                           (lambda (inner) (bind-aux (rest aux) inner))))
                     (analyze-body forms scope))))
        (let ((run (bind parameters 0 outer)))
          (lambda (frame)
            (make-interpreted-function
             (or name lambda-list)
             (lambda (&rest values)
               (funcall run (vector frame (apply splitter values)))))))))))
