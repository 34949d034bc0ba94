;;;; The journal of a path: what a run changes outside of itself is undone after it.
;;;;
;;;; The journal is a list of (number symbol task . restoring function), the last write first.  A
;;;; write to a variable that a task has bound itself is forgotten when the binding ends; what
;;;; another task writes meanwhile is the global value.  Bindings of several tasks need not end in
;;;; the reverse order of their begin.  Entry points: NOTE-WRITE, WITH-FORGOTTEN-WRITES,
;;;; UNDO-WRITES.

(in-package #:discrepancy-finder.symbolic-execution)

(defun note-write (symbol)
  "Remember the value of SYMBOL, so that it can be restored after the run."
  (when *path*
    (push (list* (incf (path-writes *path*)) symbol (plan:current-task)
                 (if (boundp symbol)
                     (let ((value (symbol-value symbol)))
                       (lambda () (setf (symbol-value symbol) value)))
                     (lambda () (makunbound symbol))))
          (path-journal *path*))))

(defun forget-writes (path symbols since)
  "Forget the writes of the current task to SYMBOLS that have a number above SINCE."
  (let ((task (plan:current-task)) (newer '()) (older (path-journal path)))
    (loop while (and older (> (first (first older)) since))
          do (let ((entry (pop older)))
               (destructuring-bind (symbol writer . restore) (rest entry)
                 (declare (ignore restore))
                 (unless (and (member symbol symbols) (eq writer task))
                   (push entry newer)))))
    (setf (path-journal path) (nreconc newer older))))

(defmacro with-forgotten-writes ((symbols) &body body)
  "Evaluate BODY, in which SYMBOLS are bound, and forget the writes to them in it."
  (let ((since (gensym "SINCE")) (names (gensym "SYMBOLS")))
    `(let ((,since (if *path* (path-writes *path*) 0))
           (,names ,symbols))
       (unwind-protect (progn ,@body)
         (when *path*
           (forget-writes *path* ,names ,since))))))

(defun undo-writes (path)
  (loop for (nil nil nil . restore) in (path-journal path) do (funcall restore))
  (setf (path-journal path) '()))
