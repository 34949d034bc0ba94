;;;; Log lines.
;;;;
;;;; (ros-info (pick-place pick-up) "Opening gripper ~a" arm) writes the line
;;;;
;;;;   [(PICK-PLACE PICK-UP) INFO] 1.250: Opening gripper LEFT
;;;;
;;;; to *DEBUG-STREAM*: who speaks, how urgent it is, the time, the text.  Names form a tree:
;;;; what SET-DEBUG-LEVEL says of (pick-place) goes for (pick-place pick-up) too.

(in-package #:discrepancy-finder.roslisp)

(defvar *debug-stream* (make-synonym-stream '*error-output*)
  "The stream of the log lines.  Unless it is set this is *ERROR-OUTPUT*, so that the standard
output of a program stays clean; roslisp itself writes to the standard output.")

(defvar *ros-clock* (constantly 0d0)
  "A function of no arguments that returns the time (s), a real.  Who executes plans sets it to the
virtual clock of the run; unless it is set it is always 0.")

(defun ros-time ()
  "Return the time (s) by *ROS-CLOCK*, a double float."
  (float (funcall *ros-clock*) 1d0))

;;; Levels

(defparameter *severities* '(:debug :info :warn :error :fatal)
  "The levels, the least urgent first.")

(defvar *debug-levels* '()
  "A list of (name . level), the name a list of strings.")

(defun logger-path (name)
  "Return the list of strings for NAME: a symbol, a string or a list of such."
  (mapcar #'string (if (listp name) name (list name))))

(defun debug-level (name)
  "Return the level, a keyword, from which on messages of NAME are written: what SET-DEBUG-LEVEL
said of NAME or else of the longest beginning of it, :info if it said nothing.  NAME is a symbol or
a list of symbols, NIL for the root; packages do not matter."
  (loop for path = (logger-path name) then (butlast path)
        for found = (assoc path *debug-levels* :test #'equal)
        when found return (cdr found)
        while path
        finally (return :info)))

(defun set-debug-level (name level)
  "From now on write the messages of NAME, and of what is below it, that are as urgent as LEVEL or
more: :debug, :info, :warn, :error or :fatal.  NAME is as for DEBUG-LEVEL.  Return LEVEL.  Signals
UNKNOWN-DEBUG-LEVEL."
  (unless (member level *severities*)
    (error 'unknown-debug-level :level level))
  (let ((path (logger-path name)))
    (setf *debug-levels* (acons path level (remove path *debug-levels* :key #'car :test #'equal))))
  level)

(defun written-p (name level)
  "Return true if messages of NAME at LEVEL are to be written."
  (and (member level (member (debug-level name) *severities*)) t))

;;; Messages

(defun one-line (text)
  "Return TEXT with each run of blanks that holds a line break as one blank, and none at the ends."
  (flet ((blankp (character) (member character '(#\Space #\Tab #\Newline #\Return))))
    (with-output-to-string (line)
      (loop with start = 0
            for begin = (position-if-not #'blankp text :start start)
            while begin
            do (let ((end (or (position-if #'blankp text :start begin) (length text)))
                     (gap (subseq text start begin)))
                 (unless (zerop start)
                   (write-string (if (find #\Newline gap) " " gap) line))
                 (write-string text line :start begin :end end)
                 (setf start end))))))

(defun write-message (name level control &rest arguments)
  "Write the log line of the message by the format CONTROL and ARGUMENTS.  Return NIL."
  (let ((text (let ((*print-pretty* nil)) (apply #'format nil control arguments))))
    ;; In one piece, so that lines of several threads do not mix.
    (write-string (format nil "[~@[(~{~a~^ ~}) ~]~a] ~,3f: ~a~%"
                          (logger-path name) level (ros-time) (one-line text))
                  *debug-stream*)
    nil))

(defun log-form (form level)
  "Return the expansion of FORM, which is (macro [name] [condition] format-string argument*)."
  (let* ((arguments (rest form))
         (name (unless (stringp (first arguments)) (pop arguments)))
         (condition (if (or (stringp (first arguments)) (null (rest arguments)))
                        't
                        (pop arguments))))
    (unless (and arguments (or (symbolp name) (listp name)))
      (error 'malformed-log-call :form form))
    `(when (and (written-p ',name ,level) ,condition)
       (write-message ',name ,level ,@arguments))))

(defmacro define-log-macro (name level purpose)
  `(defmacro ,name (&whole form &rest arguments)
     ,(format nil "([NAME] [CONDITION] FORMAT-STRING ARGUMENT*)
Write a log line ~a and return NIL.  NAME, a symbol or a list of symbols,
is not evaluated.  If CONDITION is false or the DEBUG-LEVEL of NAME is above ~(~s~), nothing is
written and the arguments are not evaluated.  Signals MALFORMED-LOG-CALL where it is expanded
without a format string." purpose level)
     (declare (ignore arguments))
     (log-form form ,level)))

(define-log-macro ros-debug :debug "for who looks for a mistake")
(define-log-macro ros-info :info "about what goes on")
(define-log-macro ros-warn :warn "about what may be wrong")
(define-log-macro ros-error :error "about what is wrong")
(define-log-macro ros-fatal :fatal "about what ends the program")
