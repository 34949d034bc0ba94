;;;; Predicates written in Lisp.
;;;;
;;;; DEF-PROLOG-HANDLER is for users: a function from a binding set to a lazy list of binding sets.
;;;; DEFINE-CONTROL is for this layer: a function that sets the frame of the proof.  DEFINE-TEST is
;;;; a control whose goal is true at most once.

(in-package #:discrepancy-finder.prolog)

(defun install-predicate (name lambda-list documentation control)
  (let ((predicate (ensure-predicate name)))
    (setf (predicate-lambda-list predicate) lambda-list
          (predicate-documentation predicate) documentation
          (predicate-control predicate) control)
    name))

(defmethod documentation ((name symbol) (kind (eql 'predicate)))
  (let ((predicate (find-predicate name)))
    (and predicate (predicate-documentation predicate))))

(defmethod (setf documentation) (text (name symbol) (kind (eql 'predicate)))
  (setf (predicate-documentation (ensure-predicate name)) text))

(defun argument-numbers (lambda-list)
  "Return the least and the greatest number of arguments, NIL for any, that LAMBDA-LIST takes."
  (flet ((names (lambda-list)
           (loop for name in lambda-list
                 until (member name lambda-list-keywords) count t)))
    (let ((required (names lambda-list))
          (optional (names (rest (member '&optional lambda-list)))))
      (values required
              (if (intersection '(&rest &key) lambda-list) nil (+ required optional))))))

(defun check-arguments (goal arguments least most)
  (unless (<= least (length arguments) (or most call-arguments-limit))
    (malformed goal "it takes ~:[~d to ~d~;~d~:[ or more~;~]~*~] argument~:p"
               (or (null most) (= least most)) least most most)))

(defmacro define-control (name (proof barrier next) (&rest lambda-list) documentation &body body)
  "Define the built-in predicate NAME.  In BODY the arguments of the goal are bound by LAMBDA-LIST,
and PROOF, BARRIER and NEXT to the proof, the choices to which a cut goes back, and the frame of the
goals after this one.  BODY sets the frame and returns true, or it returns false: the goal fails."
  (let ((goal (gensym "GOAL")) (arguments (gensym "ARGUMENTS")))
    (multiple-value-bind (least most) (argument-numbers lambda-list)
      `(install-predicate
        ',name ',lambda-list ,documentation
        (lambda (,proof ,goal ,arguments ,barrier ,next)
          (declare (ignorable ,proof ,barrier ,next))
          (check-arguments ,goal ,arguments ,least ,most)
          (apply (lambda ,lambda-list ,@body) ,arguments))))))

(defmacro define-test (name (proof) (&rest lambda-list) documentation &body body)
  "Define the built-in predicate NAME: its goal is true, once, if BODY returns true.  In BODY the
arguments of the goal are bound by LAMBDA-LIST and PROOF to the proof."
  (let ((barrier (gensym "BARRIER")) (next (gensym "NEXT")))
    `(define-control ,name (,proof ,barrier ,next) ,lambda-list
       ,documentation
       (when (progn ,@body)
         (setf (proof-frame ,proof) ,next)
         t))))

;;; Handlers of users

(defun add-solution (proof solution variables)
  "Bind VARIABLES, for which symbols stand in the binding set SOLUTION, and return true or false."
  (let ((names (placeholder-names variables)))
    (loop for (symbol . variable) in (names-table names)
          always (let ((value (var-value symbol solution)))
                   (or (eq value symbol)
                       (unify-terms proof variable (internalise value names)))))))

(defun try-solutions (proof solutions variables next)
  "Go on to NEXT with the first binding set of the lazy list SOLUTIONS, with the others as a
choice."
  (let ((list (forced solutions)))
    (when list
      (let ((others (cdr list)))
        (when others
          (push-choice proof (make-frame (list (lambda (proof next)
                                                 (try-solutions proof others variables next)))
                                         nil nil next))))
      (when (add-solution proof (first list) variables)
        (setf (proof-frame proof) next)
        t))))

(defun call-handler (proof goal handler arguments next)
  (multiple-value-bind (forms variables) (externalise arguments)
    (let ((solutions (apply handler '() forms)))
      (unless (lazy-list-p solutions)
        (malformed goal "its handler returned ~s, no list of binding sets" solutions))
      (try-solutions proof solutions variables next))))

(defmacro def-prolog-handler (name (bindings &rest lambda-list) &body body)
  "Define the predicate NAME in Lisp; it takes the place of the handler that NAME had.  For each
goal BODY is evaluated with the arguments of the goal bound by LAMBDA-LIST and BINDINGS bound to a
binding set.  It returns the lazy list of the binding sets, extensions of BINDINGS by ADD-BDS or
UNIFY, that make the goal true.  The arguments have the values of their variables; a symbol for
which IS-VAR is true stands for an unbound one.  A string in front of BODY is the documentation of
NAME as a PREDICATE."
  (let ((proof (gensym "PROOF")) (goal (gensym "GOAL")) (arguments (gensym "ARGUMENTS"))
        (barrier (gensym "BARRIER")) (next (gensym "NEXT"))
        (text (and (stringp (first body)) (rest body) (first body))))
    (multiple-value-bind (least most) (argument-numbers lambda-list)
      `(install-predicate
        ',name ',lambda-list ,text
        (lambda (,proof ,goal ,arguments ,barrier ,next)
          (declare (ignore ,barrier))
          (check-arguments ,goal ,arguments ,least ,most)
          (call-handler ,proof ,goal
                        (lambda (,bindings ,@lambda-list)
                          (declare (ignorable ,bindings))
                          ,@(if text (rest body) body))
                        ,arguments ,next))))))

(defun alias-predicate (name built-in)
  "Make NAME another name of the predicate BUILT-IN, which is built in or has a handler, and return
NAME.  So a package with a symbol NOT of its own may negate goals by that."
  (let ((predicate (ensure-predicate built-in)))
    (assert (predicate-control predicate) (built-in)
            "~(~s~) is neither built in nor has it a handler." built-in)
    (install-predicate name (predicate-lambda-list predicate)
                       (predicate-documentation predicate) (predicate-control predicate))))

(defun describe-predicates (&optional (stream *standard-output*))
  "Print the built-in predicates on STREAM, each with its arguments and its documentation, then the
predicates that have facts, each with the fact groups that define it.  Return no value."
  (let ((predicates (sort (sb-ext:with-locked-hash-table (*predicates*)
                            (loop for predicate being the hash-values of *predicates*
                                  collect predicate))
                          #'string< :key #'predicate-name)))
    (dolist (predicate predicates)
      (when (predicate-control predicate)
        (format stream "~&~(~a~)~%~@[    ~a~%~]"
                (cons (predicate-name predicate) (predicate-lambda-list predicate))
                (predicate-documentation predicate))))
    (dolist (predicate predicates (values))
      (let ((groups (mapcar #'car (predicate-sections predicate))))
        (when groups
          (format stream "~&~(~s~): facts in ~{~(~a~)~^, ~}~%~@[    ~a~%~]"
                  (predicate-name predicate) (mapcar #'fact-group-name groups)
                  (predicate-documentation predicate)))))))
