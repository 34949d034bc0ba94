;;;; The world outside of a plan: files that a run cannot undo, and the time.
;;;;
;;;; On a path a file may not be opened for output, nor deleted or renamed, unless the exploration
;;;; allows it (:FILE-OUTPUT), and Common Lisp's clocks show the plan's virtual time.  This holds
;;;; for what plans call themselves, on every path; compiled code that they call does what it does.

(in-package #:discrepancy-finder.symbolic-execution)

(defun refuse-file-output (file)
  "Signal FILE-OUTPUT-REFUSED, past the handlers of the plan, if the run may not write FILE."
  (let ((path *path*))
    (when (and path (not (path-file-output path)))
      (outside-the-plan (path)
        (error 'file-output-refused :file (princ-to-string file) :plan (path-plan path))))))

(defmacro define-outside (name lambda-list (&rest arguments) &body body)
  "Define what stands for the function NAME with LAMBDA-LIST in plans; ARGUMENTS are its required
ones, and what the last one, a &rest parameter, holds is decided, too.  BODY is evaluated before
NAME is called."
  (let ((required (butlast arguments)) (rest (first (last arguments))))
    `(define-lifted (,name) ,lambda-list
       (let (,@(loop for argument in arguments
                     collect `(,argument (decided ,argument ,(describe-decision name)))))
         ,@body
         (apply #',name ,@required ,rest)))))

(define-outside open (file &rest options) (file options)
  (when (member (getf options :direction :input) '(:output :io))
    (refuse-file-output file)))

(define-outside delete-file (file &rest none) (file none)
  (refuse-file-output file))

(define-outside rename-file (file new &rest none) (file new none)
  (refuse-file-output file))

(define-outside ensure-directories-exist (file &rest options) (file options)
  (refuse-file-output file))

;;; Time

(defparameter *virtual-epoch* (encode-universal-time 0 0 0 1 1 2000 0)
  "The universal time at which each run of a plan begins.")

(defun virtual-seconds ()
  "Return the time since the begin of the run in s, a double float."
  (if (plan:current-task) (plan:now) 0d0))

(defun virtual-internal-time ()
  (floor (* (rational (virtual-seconds)) internal-time-units-per-second)))

(define-lifted (get-universal-time) ()
  (if *path*
      (+ *virtual-epoch* (floor (virtual-seconds)))
      (get-universal-time)))

(define-lifted (get-internal-real-time) ()
  (if *path* (virtual-internal-time) (get-internal-real-time)))

(define-lifted (get-internal-run-time) ()
  (if *path* (virtual-internal-time) (get-internal-run-time)))

(define-lifted (get-decoded-time) ()
  (if *path*
      (decode-universal-time (+ *virtual-epoch* (floor (virtual-seconds))) 0)
      (get-decoded-time)))
