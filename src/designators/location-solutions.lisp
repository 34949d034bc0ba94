;;;; The solutions of location designators, lazily: what the generators of locations.lisp propose
;;;; and the validation functions accept.

(in-package #:discrepancy-finder.designators)

;;; Validation

(defun print-verdict (function solution verdict)
  (when *print-location-validation-function-results*
    (format *trace-output* "~&~(~s~) says ~(~s~) of ~a~%"
            (location-function-name function) verdict (description-text solution))))

(defun validate-location-designator-solution (designator solution)
  "Return true if the validation functions, asked in the order of their priorities, accept SOLUTION,
a pose, for the location DESIGNATOR: none rejects it, and if one returns :maybe-reject, another
returns :accept."
  (let ((accepted nil)
        (doubted nil))
    (dolist (function *location-validation-functions* (or accepted (not doubted)))
      (when (location-function-enabled function)
        (let ((verdict (funcall (location-function-function function) designator solution)))
          (print-verdict function solution verdict)
          (case verdict
            (:accept (setf accepted t))
            (:unknown)
            (:maybe-reject (setf doubted t))
            (t (return nil))))))))

;;; Generation

(defun proposed-poses (designator)
  "Return the lazy list of what the enabled generators propose for DESIGNATOR.  A generator is
called when those before it have no further pose."
  (lazy-mapcan (lambda (generator) (funcall (location-function-function generator) designator))
               (remove-if-not #'location-function-enabled *location-generators*)))

(defmethod resolve-designator ((designator location-designator) role)
  (declare (ignore role))
  (lazy-list ((poses (proposed-poses designator)) (rejected 0))
    (cond ((null poses) (fin))
          ((validate-location-designator-solution designator (lazy-car poses))
           (lazy-cons (lazy-car poses) (next (lazy-cdr poses) 0)))
          ((>= (1+ rejected) *location-generator-max-retries*) (fin))
          (t (next (lazy-cdr poses) (1+ rejected))))))

(defmethod unresolved-reason ((designator location-designator))
  (format nil "no generator proposes a pose for it that the validation functions accept; ~a"
          (key-words designator)))

;;; The generators that are always there

(defun described-poses (designator)
  "Return the poses that the location DESIGNATOR itself names: the values of :pose and the elements
of the values of :poses."
  (append (remove nil (desig-prop-values designator :pose))
          (loop for poses in (desig-prop-values designator :poses)
                when (listp poses) append (remove nil poses))))

(defun grounded-poses (designator)
  "Return the lazy list of what the predicate LOCATION-GROUNDING proves of DESIGNATOR and
DESCRIBED-POSES does not return."
  (let ((described (described-poses designator)))
    (lazy-filter (lambda (pose) (not (member pose described)))
                 (grounding-solutions 'location-grounding designator))))

(register-location-generator 1 described-poses
  "The poses in the description.")

(register-location-generator 2 grounded-poses
  "What the prolog predicate location-grounding has for the designator.")
