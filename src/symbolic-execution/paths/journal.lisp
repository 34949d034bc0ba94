;;;; The journal of a path: what a run changes outside of itself is undone after it.
;;;;
;;;; The journal is a list of entries, the last first: (number symbol task . restoring function) for
;;;; a write to a global variable, (number . restoring function) for a change of an object.  A write
;;;; to a variable that a task has bound itself is forgotten when the binding ends; what another
;;;; task writes meanwhile is the global value.  Bindings of several tasks need not end in the
;;;; reverse order of their begin.  Entry points: NOTE-WRITE, NOTE-UNDO, WITH-FORGOTTEN-WRITES,
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

(defun note-undo (function)
  "Let FUNCTION, without arguments, be called after the run, what was noted last first: it undoes
what the run does to an object.  Without a path nothing is noted."
  (declare (type function function))
  (let ((path *path*))
    (when path
      (push (cons (incf (path-writes path)) function) (path-journal path))))
  (values))

(defun object-entry-p (entry)
  (functionp (rest entry)))

(defun forget-writes (path symbols since)
  "Forget the writes of the current task to SYMBOLS that have a number above SINCE."
  (let ((task (plan:current-task)) (newer '()) (older (path-journal path)))
    (loop while (and older (> (first (first older)) since))
          do (let ((entry (pop older)))
               (unless (and (not (object-entry-p entry))
                            (member (second entry) symbols)
                            (eq (third entry) task))
                 (push entry newer))))
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
  (loop for entry in (shiftf (path-journal path) '())
        do (funcall (the function (if (object-entry-p entry) (rest entry) (cdddr entry))))))
