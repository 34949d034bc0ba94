;;;; Variables and binding sets as Lisp sees them.
;;;;
;;;; A variable is a symbol whose name begins with a question mark; ?_ stands for something else at
;;;; every place.  A binding set is an alist (variable . value) whose values may contain variables
;;;; of the set.  VAR-VALUE looks a value up.

(in-package #:discrepancy-finder.prolog)

(defun is-var (form)
  "Return true if FORM is a variable: a symbol whose name begins with a question mark."
  (and (symbolp form)
       (let ((name (symbol-name form)))
         (and (plusp (length name)) (char= (char name 0) #\?)))))

(defun is-unnamed-var (form)
  "Return true if FORM is a symbol ?_, the variable whose value does not matter."
  (and (symbolp form) (string= (symbol-name form) "?_")))

(defun is-segvar (form)
  "Return true if FORM is a symbol whose name begins with !?, by which CRAM's patterns of goals name
several elements.  Unification treats it as a constant."
  (and (symbolp form) (eql (mismatch "!?" (symbol-name form)) 2)))

(defun is-genvar (form)
  "Return true if FORM is a variable that GEN-VAR made or that stands for an unbound variable of a
fact."
  (and (is-var form) (null (symbol-package form))))

(defun gen-var (&optional (base '?var))
  "Return a new variable with the name of the symbol or string BASE, which begins with ?."
  (make-symbol (string base)))

;;; Walking forms.  A list is walked along its conses, not on the control stack, and so is a nest in
;;; last elements such as (s (s (s 0))), whatever its depth.

(declaim (inline some-leaf))
(defun some-leaf (predicate form)
  "Return true if PREDICATE is true of an atom in FORM other than the NIL at the end of a list."
  (labels ((walk (form)
             (loop
               (cond ((atom form) (return (funcall predicate form)))
                     ((null (cdr form)) (setf form (car form)))
                     ((walk (car form)) (return t))
                     (t (setf form (cdr form)))))))
    (walk form)))

(declaim (inline copy-form))
(defun copy-form (expand form)
  "Return a copy of FORM with what the function EXPAND returns for it and for each of its parts in
their places; the parts of what EXPAND returns are expanded, too."
  (labels ((walk (node)
             ;; The copy grows in a hole: the car or the cdr of the cons that was made last.
             (let* ((start (list nil))
                    (cell start)
                    (in-car t))
               (flet ((fill-hole (value)
                        (if in-car
                            (setf (car cell) value)
                            (setf (cdr cell) value))))
                 (loop
                   (when (atom node)
                     (fill-hole node)
                     (return (car start)))
                   (let ((new-cell (list nil))
                         (tail (funcall expand (cdr node))))
                     (fill-hole new-cell)
                     (setf cell new-cell
                           in-car (null tail))
                     (cond (in-car (setf node (funcall expand (car node))))
                           (t (setf (car cell) (walk (funcall expand (car node)))
                                    node tail)))))))))
    (walk (funcall expand form))))

(defun vars-in (form)
  "Return the list of the variables in FORM without ?_, each once, in order of appearance."
  (let ((variables '()))
    (some-leaf (lambda (leaf)
                 (when (and (is-var leaf) (not (is-unnamed-var leaf)))
                   (pushnew leaf variables))
                 nil)
               form)
    (nreverse variables)))

(defun rename-vars (form)
  "Return FORM with a new variable for each of its variables, and the alist (variable . new
variable).  Each ?_ stays as it is."
  (let ((renaming (loop for variable in (vars-in form)
                        collect (cons variable (gen-var variable)))))
    (values (sublis renaming form) renaming)))

(defun add-bds (variable value bindings)
  "Return BINDINGS with VALUE for VARIABLE added in front."
  (acons variable value bindings))

(defun binding-of (form bindings)
  "Return the value of FORM in BINDINGS as it is written there, or FORM itself if it is no variable
or has none."
  (loop
    (let ((binding (and (is-var form) (assoc form bindings :test #'eq))))
      (if (or (null binding) (eq (cdr binding) form))
          (return form)
          (setf form (cdr binding))))))

(defun substitute-vars (form bindings)
  "Return FORM with the values that BINDINGS have for its variables in their places; variables
without a value stay.  FORM itself is returned if it has no variables."
  (if (some-leaf #'is-var form)
      (copy-form (lambda (node) (binding-of node bindings)) form)
      form))

(defun var-value (variable bindings)
  "Return the value of VARIABLE in BINDINGS, with the values of variables in it; VARIABLE itself if
it has none.  A form that is no variable is treated as SUBSTITUTE-VARS does."
  (substitute-vars variable bindings))

(defun is-bound (form bindings)
  "Return true if FORM is no variable or is one that has a value in BINDINGS other than a variable."
  (not (is-var (binding-of form bindings))))

(defun strict-value (variable bindings)
  (let ((value (var-value variable bindings)))
    (if (is-var value)
        (error 'variable-not-bound :variable variable)
        value)))

(defun binding-let (variables bindings reader body)
  (let ((set (gensym "BINDINGS")))
    `(let* ((,set ,bindings)
            ,@(loop for variable in variables
                    collect `(,variable (,reader ',variable ,set))))
       (declare (ignorable ,set ,@variables))
       ,@body)))

(defmacro with-vars-bound ((&rest variables) bindings &body body)
  "Evaluate BODY with the Lisp variables VARIABLES, symbols such as ?x, bound to their values in
BINDINGS; one that has none is bound to its own name."
  (binding-let variables bindings 'var-value body))

(defmacro with-vars-strictly-bound ((&rest variables) bindings &body body)
  "Evaluate BODY as WITH-VARS-BOUND does.  Signals VARIABLE-NOT-BOUND if one of VARIABLES has no
value in BINDINGS."
  (binding-let variables bindings 'strict-value body))
