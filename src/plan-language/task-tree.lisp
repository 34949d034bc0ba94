;;;; The task tree: what was done on behalf of what, with the code it came from.
;;;;
;;;; A node stands for a place in the plan: the call of a plan function, a PERFORM, a :TAG, a branch
;;;; of a PAR.  Its PATH is the list of the heads from the node to the root; when the same place is
;;;; reached again under the same parent, that is a node of its own with (:call n) before the head.

(in-package #:discrepancy-finder.plan-language)

(defstruct (task-tree-node (:conc-name node-) (:constructor make-node) (:copier nil))
  "A node of the task tree.  PARAMETERS is a function that returns the arguments."
  (head nil :read-only t)
  (call 1 :type (integer 1) :read-only t)
  (parent nil :type (or null task-tree-node) :read-only t)
  (code nil :read-only t)
  (parameters nil :read-only t)
  (tasks '() :type list)
  (children '() :type list)
  (calls nil))

(defmethod print-object ((node task-tree-node) stream)
  (print-unreadable-object (node stream :type t)
    (let ((*print-pretty* nil) (*print-length* 6) (*print-level* 4))
      (format stream "~(~s~), ~d child~:*~[ren~;~:;ren~]" (task-tree-node-path node)
              (length (node-children node))))))

(defvar *top-level-trees* (make-hash-table :test 'equal)
  "The root of the last task tree of each named top-level.")

(defun make-root-node (name)
  (make-node :head (list 'top-level name)))

(defun add-node (parent head &key code parameters)
  "Return a new child of the node PARENT for the place HEAD."
  (let* ((calls (or (node-calls parent)
                    (setf (node-calls parent) (make-hash-table :test 'equal :size 7))))
         (node (make-node :head head :parent parent :code code :parameters parameters
                          :call (incf (gethash head calls 0)))))
    (push node (node-children parent))
    node))

(defun task-tree-node-path (node)
  "Return the path of NODE: the list of the heads from it up to the root.  The n-th call of the same
head has (:call n) in front of it, if n is greater than 1."
  (loop for place = node then (node-parent place)
        while place
        when (> (node-call place) 1) collect (list :call (node-call place))
        collect (node-head place)))

(defun task-tree-node-parent (node)
  "Return the parent of NODE, or NIL for the root."
  (node-parent node))

(defun task-tree-node-children (node)
  "Return the children of NODE, in the order in which they began."
  (reverse (node-children node)))

(defun task-tree-node-code (node)
  "Return the form that NODE stands for, or NIL where it is not known."
  (node-code node))

(defun task-tree-node-parameters (node)
  "Return the list of the arguments of the plan or of PERFORM that NODE stands for."
  (and (node-parameters node) (funcall (node-parameters node))))

(defun task-tree-node-task (node)
  "Return the last task that ran as NODE, or NIL."
  (first (node-tasks node)))

(defun task-tree-node-result (node)
  "Return the RESULT of the last task of NODE."
  (let ((task (task-tree-node-task node)))
    (and task (result task))))

(defun task-tree-node-status-fluent (node)
  "Return the status fluent of the last task of NODE."
  (let ((task (task-tree-node-task node)))
    (and task (status task))))

(defun flatten-task-tree (node)
  "Return NODE and all nodes below it, parents first, in the order in which they began."
  (let ((nodes '()) (open (list node)))
    (loop while open
          do (let ((next (pop open)))
               (push next nodes)
               (setf open (append (task-tree-node-children next) open))))
    (nreverse nodes)))

(defun task-path (task)
  "Return the path of TASK in the task tree."
  (and (task-node task) (task-tree-node-path (task-node task))))

(defun current-path ()
  "Return the path of the current task, NIL outside of any top-level."
  (and *current-task* (task-path *current-task*)))

(defun get-top-level-task-tree (name)
  "Return the root of the task tree of the last top-level with NAME, or NIL.  Plans defined by
DEF-TOP-LEVEL-CRAM-FUNCTION have their own name."
  (values (gethash name *top-level-trees*)))

(defun new-child (name head &key code parameters)
  "Return a new task of the current one, with a node of its own."
  (let* ((parent *current-task*)
         (node (add-node (task-node parent) head :code code :parameters parameters))
         (child (make-task name parent :node node)))
    (push child (node-tasks node))
    child))

(defun call-in-task (name head function &key code parameters)
  "Call FUNCTION as the body of a new task of the current one, and return its values or fail as it
does.  NAME says what it is, HEAD is its place in the task tree.  Signals NOT-IN-TOP-LEVEL."
  (need-task head)
  (run-child (new-child name head :code code :parameters parameters) function))

(defmacro with-task-tree-node ((&key (path-part '(quote anonymous)) (name "WITH-TASK-TREE-NODE")
                                  sexp lambda-list parameters)
                               &body body)
  "Evaluate BODY in a task of its own, whose place in the task tree is PATH-PART, and return its
values.  SEXP is the code to be noted, NAME a name, PARAMETERS a list of arguments."
  (declare (ignore lambda-list))
  `(call-in-task ,name ,path-part (lambda () ,@body)
                 :code ',sexp :parameters (lambda () ,parameters)))
