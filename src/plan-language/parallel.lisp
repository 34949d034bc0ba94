;;;; Doing several things at a time, or one of several.
;;;;
;;;; The branches of PAR, PURSUE, TRY-ALL and PARTIAL-ORDER are child tasks with strands of their
;;;; own, which begin in the order of their forms.  When such a form is left because of a failure
;;;; its other branches evaporate on their own time; when it succeeds it waits until they have.

(in-package #:discrepancy-finder.plan-language)

(defun start-branches (operator forms functions)
  "Start a task for each of FUNCTIONS, the branches of OPERATOR that FORMS are the code of."
  ;; Branches of an earlier form that failed stay until they have evaporated.
  (let ((parent (need-task (list operator))))
    (setf (task-children parent) (delete-if #'task-dead-p (task-children parent))))
  (loop with parent = *current-task*
        for function in functions
        for form in forms
        for number from 1
        collect (progn
                  (check-escape parent)
                  (start-strand (new-child (list operator "branch" number)
                                           (list operator number) :code form)
                                function))))

(defun branch-code (task)
  "Return the form that TASK, a branch of a parallel form, evaluates, and true; or NIL if it is
none."
  (let ((name (task-name task)))
    (and (consp name) (equal (second name) "branch")
         (values (node-code (task-node task)) t))))

(defun all-needed-p (strand)
  "Return true if STRAND goes on only because all branches that it has started have ended: those of
a PAR, with success."
  (let ((children (and (strand-task strand) (task-children (strand-task strand)))))
    (every (lambda (child)
             (or (not (nth-value 1 (branch-code child)))
                 (and (eq (first (task-name child)) 'par) (task-done-p child))))
           children)))

(defun strand-evaporating-p (strand)
  "Return true if STRAND is going to leave a task, asked to evaporate, when it has its turn."
  (and (strand-task strand) (evaporating-task strand) t))

(defun call-with-branches (operator forms functions over-p conclude)
  "Start the branches and wait until OVER-P, a function of the tasks, is true.  Return what
CONCLUDE, a function of the tasks, does.  Left in any other way, branches that run evaporate."
  (let ((tasks (start-branches operator forms functions))
        (parent *current-task*)
        (succeeded nil))
    (unwind-protect
         (multiple-value-prog1
             (progn (wait-for-tasks tasks (lambda () (funcall over-p tasks)))
                    (funcall conclude tasks))
           (setf succeeded t)
           (dolist (task tasks) (evaporate task :sync nil))
           (wait-for-tasks tasks (lambda () (every #'task-dead-p tasks))))
      (if succeeded
          (setf (task-children parent) (set-difference (task-children parent) tasks))
          (dolist (task tasks) (evaporate task :sync nil))))))

(defun newest-failed (tasks)
  "Return the one of TASKS, in the order of creation, that has failed and was created last."
  (find-if #'task-failed-p tasks :from-end t))

(defun call-par (forms functions)
  (call-with-branches
   'par forms functions
   (lambda (tasks) (or (some #'task-failed-p tasks) (every #'task-dead-p tasks)))
   (lambda (tasks)
     (when (newest-failed tasks)
       (fail (result (newest-failed tasks))))
     (and tasks (conclude (first tasks))))))

(defun call-pursue (forms functions)
  (call-with-branches
   'pursue forms functions
   (lambda (tasks) (or (some #'task-failed-p tasks) (some #'task-done-p tasks)
                       (every #'task-dead-p tasks)))
   (lambda (tasks)
     (when (newest-failed tasks)
       (fail (result (newest-failed tasks))))
     (let ((done (find-if #'task-done-p tasks)))
       (and done (conclude done))))))

(defun call-try-all (forms functions)
  (call-with-branches
   'try-all forms functions
   (lambda (tasks) (or (some #'task-done-p tasks) (every #'task-dead-p tasks)))
   (lambda (tasks)
     (let ((done (find-if #'task-done-p tasks)))
       (if done
           (conclude done)
           (fail 'composite-failure
                 :failures (mapcar #'result (reverse (remove-if-not #'task-failed-p tasks)))))))))

(defmacro define-parallel-operator (name function documentation)
  `(defmacro ,name (&body forms)
     ,documentation
     `(,',function ',forms (list ,@(loop for form in forms collect `(lambda () ,form))))))

(define-parallel-operator par call-par
  "Evaluate FORMS in parallel and return the values of the first one when all are done.  Fails when
one of them does; of several that have failed the one started last counts.")
(define-parallel-operator pursue call-pursue
  "Evaluate FORMS in parallel and return the values of the first to succeed; the others evaporate.
Fails when one of them fails before.")
(define-parallel-operator try-all call-try-all
  "Evaluate FORMS in parallel and return the values of one that succeeds; the others evaporate.
Signals COMPOSITE-FAILURE if all fail, its failures in the reverse order of the forms.")

(defmacro par-loop ((variable sequence) &body body)
  "Evaluate BODY in parallel for VARIABLE bound to each element of SEQUENCE; like PAR."
  `(call-par-loop (lambda (,variable) ,@body) ,sequence ',body))

(defun call-par-loop (function sequence body)
  (let ((functions (map 'list (lambda (element) (lambda () (funcall function element)))
                        sequence)))
    (call-par (mapcar (constantly `(progn ,@body)) functions) functions)))

;;; One after the other

(defun call-try-in-order (functions)
  (let ((failures '()))
    (dolist (function functions)
      (handler-case (return-from call-try-in-order (funcall (the function function)))
        (plan-failure (failure) (push failure failures))))
    (fail 'composite-failure :failures (nreverse failures))))

(defmacro try-in-order (&body forms)
  "Evaluate FORMS one after the other until one does not fail, and return its values.  Signals
COMPOSITE-FAILURE if all fail.  There is a block named NIL around it."
  `(block nil
     (call-try-in-order (list ,@(loop for form in forms collect `(lambda () ,form))))))

(defmacro try-each-in-order ((variable list) &body body)
  "Evaluate BODY with VARIABLE bound to one element of LIST after the other until it does not fail,
and return its values.  Signals COMPOSITE-FAILURE if it always fails."
  `(block nil
     (call-try-in-order (mapcar (lambda (,variable) (lambda () ,@body)) ,list))))

(defun mapcar-clean (function list &rest lists)
  "Return the results of MAPCAR without those that are NIL."
  (remove nil (apply #'mapcar function list lists)))
