;;;; Stepping: a replay that stops after each action.
;;;;
;;;; At a prompt, on *QUERY-IO*, the user goes on to the next action or to the end, looks at the
;;;; world, or enters the debugger, where the condition REPLAY-STOPPED holds the projection.  With
;;;; :STEP :DEBUGGER each stop is such a condition, with the restarts CONTINUE and FINISH-REPLAY.

(in-package #:discrepancy-finder.discrepancy)

(define-condition replay-stopped (condition)
  ((number :initarg :number :reader replay-stopped-number
           :documentation "The number of actions that were performed.")
   (text :initarg :text :reader replay-stopped-text
         :documentation "The last one, and its outcome on both sides.")
   (projection :initarg :projection :reader replay-stopped-projection
               :documentation "The projection as it is now."))
  (:report (lambda (condition stream)
             (format stream "Replay stopped after action ~d.~%~a"
                     (replay-stopped-number condition) (replay-stopped-text condition))))
  (:documentation "Brings up the debugger after an action of a replay."))

(defun stop-in-debugger (number text projection)
  "Enter the debugger after action NUMBER; return :NEXT or :FINISH."
  (restart-case (invoke-debugger (make-condition 'replay-stopped :number number :text text
                                                                 :projection projection))
    (continue ()
      :report "Perform the next action."
      :next)
    (finish-replay ()
      :report "Perform the other actions without a stop."
      :finish)))

(defun save-picture (projection file)
  (handler-case (progn (projection:view-world projection :file file)
                       (format *query-io* "~a is written~%" file))
    (error (condition) (format *query-io* "~a~%" condition))))

(defun ask-at-prompt (number text projection)
  "Ask the user what to do after action NUMBER; return :NEXT or :FINISH."
  (loop
    (format *query-io* "[Enter: next action, c: to the end, p FILE: picture, d: debugger] ")
    (finish-output *query-io*)
    (let* ((line (string-trim '(#\Space #\Tab #\Return) (or (read-line *query-io* nil) "c")))
           (command (if (string= line "") #\n (char-downcase (char line 0)))))
      (case command
        (#\n (return :next))
        (#\c (return :finish))
        (#\d (return (stop-in-debugger number text projection)))
        (#\p (save-picture projection (string-trim " " (subseq line 1))))))))

(defun stepper (domain trace sample comparison step)
  "Return the function that EXECUTE-SAMPLE calls after each action of a replay: it tells the action
and stops.  STEP is T, :DEBUGGER, or a function of the number of actions, the text and the
projection that returns :NEXT or :FINISH."
  (let ((stop (case step
                ((t) #'ask-at-prompt)
                (:debugger #'stop-in-debugger)
                (t step)))
        (output *standard-output*))
    (lambda (projection initial-state steps)
      (let* ((*standard-output* output) ; what the plan prints is not shown
             (run (make-run :sample sample :initial-state initial-state :steps steps))
             (case (compared-run domain trace run comparison))
             (number (length steps))
             (text (step-text-of case (1- number))))
        (when (= number 1)
          (write-string (beginning-text case)))
        (write-string text)
        (finish-output)
        (when stop
          (when (eq (funcall stop number text projection) :finish)
            (setf stop nil)))))))
