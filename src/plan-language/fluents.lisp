;;;; Fluents: variables that tasks can wait for.
;;;;
;;;; A VALUE-FLUENT has a value; setting another one pulses it.  A FLUENT-NET is computed from other
;;;; fluents (fluent-operators.lisp) and pulses when its value changes.  A PULSED-FLUENT is true
;;;; when its origin has pulsed.  WAIT-FOR blocks the task until a fluent is true.  A fluent belongs
;;;; to the program that runs in one top-level.

(in-package #:discrepancy-finder.plan-language)

(defclass fluent ()
  ((name :initarg :name :initform nil :reader fluent-name
         :documentation "A symbol or a string.")
   (pulse-count :initform 0 :accessor pulse-count :type fixnum)
   (waiting-strands :initform '() :accessor waiting-strands)
   (dependents :initform '() :accessor fluent-dependents
               :documentation "Weak pointers to the fluents that are computed from this one."))
  (:documentation "A variable that tasks can wait for."))

(defclass value-fluent (fluent)
  ((value :initarg :value :initform nil :accessor %value)
   (test :initarg :test :initform 'eql :reader fluent-test))
  (:documentation "A fluent that is set by (setf value)."))

(defclass fluent-net (fluent)
  ((function :initarg :function :reader net-function)
   (arguments :initarg :arguments :reader net-arguments)
   (last-value :accessor net-last-value))
  (:documentation "A fluent that is computed from others."))

(defclass pulsed-fluent (fluent)
  ((origin :initarg :origin :reader pulsed-origin)
   (handling :initarg :handling :reader pulsed-handling :type (member :never :once :always))
   (handled :initarg :handled :accessor pulsed-handled))
  (:documentation "A fluent that is true when its origin has pulsed, until that is handled."))

(defgeneric value (fluent)
  (:documentation "Return the value of FLUENT; anything else is its own value.")
  (:method (thing) thing)
  (:method ((fluent value-fluent)) (%value fluent))
  (:method ((fluent fluent-net))
    (apply (net-function fluent) (mapcar #'value (net-arguments fluent))))
  (:method ((fluent pulsed-fluent))
    (> (pulse-count (pulsed-origin fluent)) (pulsed-handled fluent))))

(defclass changed-fluent (fluent)
  ((origin :initarg :origin :reader pulsed-origin)
   (key :initarg :key :reader changed-key)
   (test :initarg :test :reader changed-test)
   (last :initarg :last :accessor changed-last))
  (:documentation "A fluent that is true when its origin has another value than when a task last
waited for it."))

(defun changed-part (fluent)
  (funcall (changed-key fluent) (value (pulsed-origin fluent))))

(defmethod value ((fluent changed-fluent))
  (not (funcall (changed-test fluent) (changed-last fluent) (changed-part fluent))))

(defmethod print-object ((fluent fluent) stream)
  (print-unreadable-object (fluent stream :type t)
    (let ((*print-length* 5) (*print-level* 2) (*print-pretty* nil))
      (format stream "~@[~a ~]= ~s" (fluent-name fluent)
              (handler-case (value fluent)
                (serious-condition () :unknown))))))

(defun fluentp (thing)
  "Return true if THING is a fluent."
  (typep thing 'fluent))

(defun make-fluent (&key name value (test 'eql) (class 'value-fluent))
  "Return a new fluent with NAME and VALUE.  Setting a value that is the same by the function TEST
does not pulse it.  CLASS is VALUE-FLUENT or a subclass."
  (make-instance class :name name :value value :test test))

(defun live-dependents (fluent)
  "Return the dependents of FLUENT that are still in use, and forget the others."
  (let ((live '()))
    (dolist (pointer (fluent-dependents fluent))
      (let ((dependent (sb-ext:weak-pointer-value pointer)))
        (when dependent (push dependent live))))
    (when (> (length (fluent-dependents fluent)) (* 2 (1+ (length live))))
      (setf (fluent-dependents fluent)
            (delete-if-not #'sb-ext:weak-pointer-value (fluent-dependents fluent))))
    live))

(defgeneric needed-p (fluent)
  (:documentation "Return true if somebody looks at FLUENT when it pulses.  Whether one that nobody
uses any more is still there depends on the garbage collector; its function must not be called.")
  (:method (fluent)
    (or (waiting-strands fluent) (some #'needed-p (live-dependents fluent)))))

(defmethod needed-p ((fluent pulsed-fluent)) t)

(defgeneric note-value (fluent)
  (:documentation "Let the nets in FLUENT remember the values that who begins to wait has seen.")
  (:method (thing) (declare (ignore thing)))
  (:method ((net fluent-net))
    (mapc #'note-value (net-arguments net))
    (setf (net-last-value net) (value net))))

(defun depend-on (fluent origin)
  "Let FLUENT know of the pulses of ORIGIN, if it is a fluent."
  (when (fluentp origin)
    (note-value origin)
    (push (sb-ext:make-weak-pointer fluent) (fluent-dependents origin))
    (live-dependents origin)))

(defmethod initialize-instance :after ((net fluent-net) &key arguments)
  (dolist (argument arguments)
    (depend-on net argument))
  (setf (net-last-value net) (value net)))

(defmethod initialize-instance :after ((fluent pulsed-fluent) &key origin)
  (depend-on fluent origin))

(defmethod initialize-instance :after ((fluent changed-fluent) &key origin)
  (depend-on fluent origin))

(defgeneric origin-pulsed (fluent)
  (:documentation "Tell FLUENT that one that it depends on has pulsed.")
  (:method ((net fluent-net))
    (when (needed-p net)
      (let ((new (value net)))
        (unless (eql new (net-last-value net))
          (setf (net-last-value net) new)
          (pulse net)))))
  (:method (fluent)
    (pulse fluent)))

(defun pulse (fluent)
  "Pulse FLUENT: the tasks that wait for it look at it again.  Return FLUENT."
  (incf (pulse-count fluent))
  (dolist (strand (reverse (shiftf (waiting-strands fluent) '())))
    (wake strand))
  (when (fluent-dependents fluent)
    (mapc #'origin-pulsed (live-dependents fluent)))
  fluent)

(defgeneric (setf value) (new-value fluent)
  (:documentation "Set FLUENT to NEW-VALUE and pulse it, if that is another value than before.
Signals FLUENT-NOT-SETTABLE for a fluent that is computed from others.")
  (:method (new-value thing)
    (declare (ignore new-value))
    (error 'fluent-not-settable :fluent thing))
  (:method (new-value (fluent value-fluent))
    (unless (funcall (fluent-test fluent) (%value fluent) new-value)
      (setf (%value fluent) new-value)
      (pulse fluent))
    new-value))

;;; Pulses that were missed

(defgeneric begin-waiting (fluent)
  (:documentation "Prepare FLUENT for a task that begins to wait for it.")
  (:method (thing) (declare (ignore thing)))
  (:method ((net fluent-net)) (mapc #'begin-waiting (net-arguments net)))
  (:method ((fluent pulsed-fluent))
    (when (eq (pulsed-handling fluent) :never)
      (setf (pulsed-handled fluent) (pulse-count (pulsed-origin fluent))))))

(defgeneric end-waiting (fluent)
  (:documentation "Note that a task has waited for FLUENT and goes on.")
  (:method (thing) (declare (ignore thing)))
  (:method ((net fluent-net)) (mapc #'end-waiting (net-arguments net)))
  (:method ((fluent pulsed-fluent))
    (let ((count (pulse-count (pulsed-origin fluent))))
      (when (> count (pulsed-handled fluent))
        (setf (pulsed-handled fluent)
              (if (eq (pulsed-handling fluent) :always) (1+ (pulsed-handled fluent)) count)))))
  (:method ((fluent changed-fluent))
    (setf (changed-last fluent) (changed-part fluent))))

(defun pulsed (fluent &key (handle-missed-pulses :once))
  "Return a fluent that is true when FLUENT has pulsed since it was last waited for.  Of the pulses
while nobody waited :NEVER forgets all, :ONCE handles one, :ALWAYS handles each."
  (check-type handle-missed-pulses (member :never :once :always))
  (make-instance 'pulsed-fluent :name (fluent-name fluent) :origin fluent
                                :handling handle-missed-pulses :handled (pulse-count fluent)))

;;; Waiting

(defun now ()
  "Return the time (s) of the clock of the plan that runs."
  (clock-time (scheduler-clock (task-scheduler (need-task '(now))))))

(defun fluent-text (fluent)
  (if (fluent-name fluent)
      (format nil (if (symbolp (fluent-name fluent)) "the fluent ~(~a~)" "the fluent ~a")
              (fluent-name fluent))
      "a fluent without a name"))

(defun await-fluent (fluent deadline)
  (let ((strand (current-strand)))
    (begin-waiting fluent)
    (unwind-protect
         (loop
           (let ((value (value fluent)))
             (when value
               (end-waiting fluent)
               (return value)))
           (when (and deadline (>= (now) deadline))
             (return nil))
           (note-value fluent)
           (pushnew strand (waiting-strands fluent))
           (block-strand (lambda () (fluent-text fluent)) :deadline deadline))
      (setf (waiting-strands fluent) (delete strand (waiting-strands fluent))))))

(defun wait-for (fluent &key timeout)
  "Block the current task until the value of FLUENT is true and return it, or NIL if TIMEOUT (s) has
passed before.  What is no fluent is returned as it is.  Signals WAIT-FOR-NIL for NIL,
NOT-IN-TOP-LEVEL."
  (cond ((null fluent) (error 'wait-for-nil))
        ((fluentp fluent)
         (need-task `(wait-for ,fluent))
         (await-fluent fluent (and timeout (+ (now) timeout))))
        (t fluent)))

(defun sleep* (seconds)
  "Block the current task for SECONDS of the plan's clock.  Outside of a top-level that is
CL:SLEEP.  The package DISCREPANCY-FINDER.CPL has it under the name SLEEP, too."
  (if *current-task*
      (let ((deadline (+ (now) seconds)))
        (loop while (< (now) deadline)
              do (block-strand (format nil "~a s to pass" seconds) :deadline deadline)))
      (sleep seconds))
  nil)

(defun discrepancy-finder.cpl:sleep (seconds)
  "Block the current task for SECONDS of the plan's clock; the same as SLEEP*."
  (sleep* seconds))

(defmacro whenever ((fluent) &body body)
  "Evaluate BODY each time FLUENT becomes true, for ever: it is left by RETURN or by a failure.  A
fluent that stays true makes it go round without end, while other tasks have their turns."
  (let ((condition (gensym "FLUENT")))
    `(block nil
       (let ((,condition ,fluent))
         (loop
           (wait-for ,condition)
           ,@body
           (yield))))))
