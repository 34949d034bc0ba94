;;;; Poses for location designators: generators propose, validation functions judge.
;;;;
;;;; A generator is called with a location designator and returns a list or lazy list of poses.
;;;; Those of all generators are tried one after the other, generators with a small priority first.
;;;; A validation function is called with the designator and a pose and returns a verdict:
;;;;   :accept         the pose is good
;;;;   :unknown        it cannot tell
;;;;   :maybe-reject   the pose is bad unless another function accepts it
;;;;   anything else   (:reject) the pose is bad, and no other function is asked.
;;;; After *LOCATION-GENERATOR-MAX-RETRIES* bad poses in a row the search ends.

(in-package #:discrepancy-finder.designators)

(defvar *location-generator-max-retries* 30
  "After so many rejected poses in a row there are no further solutions of a location designator.")

(defvar *print-location-validation-function-results* nil
  "If true, each verdict of a validation function is printed to *TRACE-OUTPUT*, on a line.")

(defstruct (location-function (:copier nil))
  "A registered generator or validation function."
  (name nil :type symbol :read-only t)
  (function nil :type (or symbol function) :read-only t)
  (priority 0 :type real :read-only t)
  (documentation nil :type (or null string) :read-only t)
  (enabled t))

(defvar *location-generators* '()
  "The registered generators by ascending priority.")

(defvar *location-validation-functions* '()
  "The registered validation functions by ascending priority.")

;;; Registration.  Functions are named, so that a file which is loaded again replaces its own.

(defun insert-location-function (new functions)
  "Return FUNCTIONS with NEW in the place of that of the same name and priority, else behind those
that have no greater priority."
  (let ((old (find (location-function-name new) functions :key #'location-function-name)))
    (if (and old (= (location-function-priority old) (location-function-priority new)))
        (substitute new old functions)
        (stable-sort (append (remove old functions) (list new)) #'<
                     :key #'location-function-priority))))

(defun new-location-function (name priority function documentation)
  (unless (realp priority)
    (error 'invalid-location-function
           :function name
           :problem (format nil "has the priority ~s, where a number was expected" priority)))
  (make-location-function :name name :function function :priority priority
                          :documentation documentation))

(defun add-location-generator (name priority function &optional documentation)
  (setf *location-generators*
        (insert-location-function (new-location-function name priority function documentation)
                                  *location-generators*))
  name)

(defun add-location-validation-function (name priority function &optional documentation)
  (setf *location-validation-functions*
        (insert-location-function (new-location-function name priority function documentation)
                                  *location-validation-functions*))
  name)

(defun function-name (function)
  "Return the name in FUNCTION, one of name, 'name and #'name."
  (cond ((and function (symbolp function)) function)
        ((and (consp function) (member (first function) '(quote function))
              (second function) (symbolp (second function)))
         (second function))
        (t (error 'invalid-location-function :function function
                                             :problem "is not the name of a function"))))

(defmacro register-location-generator (priority function &optional documentation)
  "Register FUNCTION, the unevaluated name of a function from a location designator to a list or
lazy list of poses, as a generator with PRIORITY, a number; generators with smaller ones are asked
first.  DOCUMENTATION is a string.  Return the name.  Signals INVALID-LOCATION-FUNCTION."
  (let ((name (function-name function)))
    `(add-location-generator ',name ,priority ',name ,documentation)))

(defmacro register-location-validation-function (priority function &optional documentation)
  "Register FUNCTION, the unevaluated name of a function from a location designator and a pose to a
verdict, as a validation function with PRIORITY, a number; those with smaller ones are asked first.
DOCUMENTATION is a string.  Return the name.  Signals INVALID-LOCATION-FUNCTION."
  (let ((name (function-name function)))
    `(add-location-validation-function ',name ,priority ',name ,documentation)))

(defun find-location-function (name functions what)
  (or (find name functions :key #'location-function-name)
      (error 'invalid-location-function
             :function name :problem (format nil "is not registered as a ~a of locations" what))))

(defun delete-location-generator-function (name)
  "Remove the generator with NAME, if there is one, and return NAME."
  (setf *location-generators*
        (remove name *location-generators* :key #'location-function-name))
  name)

(defun delete-location-validation-function (name)
  "Remove the validation function with NAME, if there is one, and return NAME."
  (setf *location-validation-functions*
        (remove name *location-validation-functions* :key #'location-function-name))
  name)

(defun set-enabled (name functions what enabled)
  (setf (location-function-enabled (find-location-function name functions what)) enabled)
  name)

(defun enable-location-generator-function (name)
  "Let the generator with NAME be asked again; return NAME.  Signals INVALID-LOCATION-FUNCTION."
  (set-enabled name *location-generators* "generator" t))

(defun disable-location-generator-function (name)
  "Let the generator with NAME not be asked until it is enabled; return NAME.  Signals
INVALID-LOCATION-FUNCTION."
  (set-enabled name *location-generators* "generator" nil))

(defun enable-location-validation-function (name)
  "Let the validation function with NAME be asked again; return NAME.  Signals
INVALID-LOCATION-FUNCTION."
  (set-enabled name *location-validation-functions* "validation function" t))

(defun disable-location-validation-function (name)
  "Let the validation function with NAME not be asked until it is enabled; return NAME.  Signals
INVALID-LOCATION-FUNCTION."
  (set-enabled name *location-validation-functions* "validation function" nil))

(defun listed (functions)
  (loop for function in functions
        collect (list (location-function-priority function)
                      (location-function-name function)
                      (if (location-function-enabled function) :enabled :disabled)
                      (location-function-documentation function))))

(defun list-location-generators ()
  "Return a list of (priority name :enabled-or-:disabled documentation) for the generators, in the
order in which they are asked."
  (listed *location-generators*))

(defun list-location-validation-functions ()
  "Return a list of (priority name :enabled-or-:disabled documentation) for the validation
functions, in the order in which they are asked."
  (listed *location-validation-functions*))
