;;;; Start and end of a program that would be a ROS node: the functions that files register.
;;;;
;;;; There is no ROS master here, no topic and no service.  STARTUP-ROS and SHUTDOWN-ROS do what is
;;;; left: they run the functions that were registered for the occasion.

(in-package #:discrepancy-finder.roslisp)

(defvar *init-functions* '()
  "The registered init functions, the last one first.")

(defvar *cleanup-functions* '()
  "The registered cleanup functions, the last one first.")

(defun checked-function (function)
  (if (or (functionp function) (and function (symbolp function)))
      function
      (error 'not-a-function :value function)))

(defun register-ros-init-function (function)
  "Have STARTUP-ROS call FUNCTION, a function of no arguments or the name of one; once, also if it
is registered again.  Return FUNCTION.  Signals NOT-A-FUNCTION."
  (pushnew (checked-function function) *init-functions*)
  function)

(defun register-ros-cleanup-function (function)
  "Have SHUTDOWN-ROS call FUNCTION, a function of no arguments or the name of one; once, also if it
is registered again.  Return FUNCTION.  Signals NOT-A-FUNCTION."
  (pushnew (checked-function function) *cleanup-functions*)
  function)

(defun startup-ros (&key master-uri name anonymous)
  "Call the registered init functions in the order of their registration and return NIL.  That is
all: no ROS node is started and no ROS master is asked, so that MASTER-URI, NAME and ANONYMOUS have
no effect."
  (declare (ignore master-uri name anonymous))
  (mapc #'funcall (reverse *init-functions*))
  nil)

(defun shutdown-ros ()
  "Call the registered cleanup functions, the last registered one first, and return NIL.  That is
all: there is no ROS node to be shut down."
  (mapc #'funcall (copy-list *cleanup-functions*))
  nil)
