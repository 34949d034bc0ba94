;;;; Tags: names for tasks, so that others can refer to them.
;;;;
;;;; In WITH-TAGS, (:tag name form*) evaluates its forms in a task of its own, and NAME is a
;;;; variable that holds this task, everywhere in the body of WITH-TAGS and from its beginning.
;;;; Plans defined by DEF-CRAM-FUNCTION have a WITH-TAGS around their bodies.  PARTIAL-ORDER runs
;;;; steps in parallel as far as constraints between tagged tasks allow.

(in-package #:discrepancy-finder.plan-language)

;; Inside of WITH-TAGS there is a local macro of this name.  CRAM defines it, too.
(unless (macro-function :tag)
  (setf (macro-function :tag)
        (lambda (form environment)
          (error 'malformed-plan-form :form form :expected "an enclosing with-tags"
                                      :plan (source:enclosing-definition environment)))))

(defvar *tags* '()
  "The names that a body, while it is expanded, has for tasks.")

(defun may-hide-tags-p (form)
  "Return true if there may be a :TAG in FORM: it is there, or in what a macro expands to that is
neither CL's nor ours."
  (and (consp form)
       (or (eq (first form) :tag)
           (let ((operator (first form)))
             (and (symbolp operator) (macro-function operator)
                  (not (member (symbol-package operator)
                                  '#.(list (find-package '#:cl)
                                           (find-package
                                            '#:discrepancy-finder.plan-language))))))
           (loop for rest = form then (cdr rest)
                 while (consp rest)
                   thereis (may-hide-tags-p (car rest))))))

(defun tag-names (body environment)
  "Return the names of the tags in BODY, a list of forms, in their order."
  (when (some #'may-hide-tags-p body)
    (let ((*tags* '()))
      (sb-cltl2:macroexpand-all
       `(macrolet ((:tag (name &body body)
                     (pushnew name *tags*)
                     `(progn ,@body)))
          ,@body)
       environment)
      (reverse *tags*))))

(defun make-tag-task (name)
  (need-task (list :tag name))
  (make-task name *current-task*))

(defun tag-task (task)
  "Return TASK, placed in the task tree, or a new task of the same name if it was used before."
  (let* ((parent *current-task*)
         (name (task-name task))
         (fresh (if (task-node task) (make-task name parent) (adopt task parent)))
         (node (add-node (task-node parent) (list 'tagged name))))
    (setf (task-node fresh) node)
    (push fresh (node-tasks node))
    fresh))

(defun adopt (task parent)
  (setf (task-parent task) parent)
  task)

(defmacro with-tags (&body body &environment environment)
  "Evaluate BODY, in which (:tag name form*) evaluates its forms in a task of its own and returns
their values.  NAME is a variable that holds the task, from the beginning of BODY on."
  (let ((names (tag-names body environment)))
    (if names
        `(let ,(loop for name in names collect `(,name (make-tag-task ',name)))
           (declare (ignorable ,@names))
           (macrolet ((:tag (name &body body)
                        `(run-child (setf ,name (tag-task ,name)) (lambda () ,@body))))
             ,@body))
        `(progn ,@body))))

;;; Partial order

(defun check-order (constraint form)
  (unless (and (consp constraint) (eq (first constraint) :order) (= (length constraint) 3))
    (error 'malformed-plan-form :form form :expected "constraints of the form (:order a b)")))

(defun find-task (path &optional (task *current-task*))
  "Return the task of the current top-level with PATH, a list of heads of the task tree."
  (let ((root (loop for node = (task-node task) then (node-parent node)
                    while (node-parent node)
                    finally (return node))))
    (let ((node (find path (flatten-task-tree root) :key #'task-tree-node-path :test #'equal)))
      (or (and node (task-tree-node-task node))
          (error 'task-not-found :path path)))))

(defun task (path)
  "Return the task of the current top-level with PATH.  Signals TASK-NOT-FOUND."
  (find-task path))

(defun sub-task (path)
  "Return the task with PATH below the current task.  Signals TASK-NOT-FOUND."
  (find-task (append path (current-path))))

(defun await-constraints (task)
  "Wait until all that is to come before TASK is done."
  (when (task-constraints task)
    (set-status task :waiting))
  (loop while (task-constraints task)
        do (let ((constraint (pop (task-constraints task))))
             (wait-for (if (task-p constraint) (task-dead constraint) constraint)))))

(defun constrain (before after)
  "Let the task AFTER begin only when BEFORE, a task or a fluent, has ended or pulsed."
  (setf (task-constraints after)
        (append (task-constraints after)
                (list (if (typep before 'value-fluent) (pulsed before) before)))))

(defmacro partial-order (&whole form (&rest steps) &body constraints)
  "Evaluate STEPS in parallel, like PAR.  CONSTRAINTS are (:order a b): b, a tag of a step, begins
only when a, a tag or another task, has ended or, if it is a fluent, has pulsed."
  (dolist (constraint constraints)
    (check-order constraint form))
  `(with-tags
     ,@(loop for (nil before after) in constraints
             collect `(constrain ,before ,after))
     (par ,@steps)))
