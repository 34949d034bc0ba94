;;;; What a designator describes: REFERENCE and NEXT-SOLUTION.
;;;;
;;;; REFERENCE returns the first solution of a designator and keeps it; NEXT-SOLUTION returns a new
;;;; designator, equated to it, for the next one.  Solutions come from RESOLVE-DESIGNATOR, as a lazy
;;;; list:
;;;;   action, motion   what prolog proves of (action-grounding designator ?solution) and
;;;;                    (motion-grounding designator ?solution): a list of the function or command
;;;;                    and its arguments; an action without a solution has those of
;;;;                    (default-action-grounding designator ?solution), so that what the system
;;;;                    brings along gives way to what a user defines
;;;;   location         poses that generators propose and validation functions accept
;;;;                    (locations.lisp)
;;;;   object, human    what perception put into the slot DATA, nothing else.
;;;; A ROLE says for whom: methods of RESOLVE-DESIGNATOR on (eql role) resolve in another way.

(in-package #:discrepancy-finder.designators)

(defvar *default-role* 'default-role
  "The role for which REFERENCE resolves designators when none is given, a symbol.")

(defgeneric resolve-designator (designator role)
  (:documentation "Return the solutions of DESIGNATOR for ROLE, a symbol, as a lazy list; NIL or an
empty one if there are none.  Does not change DESIGNATOR."))

(defun grounding-solutions (predicate designator)
  "Return the lazy list of the values of ?solution for which prolog proves (PREDICATE DESIGNATOR
?solution)."
  (lazy-mapcar (lambda (bindings) (var-value '?solution bindings))
               (prolog (list predicate designator '?solution))))

(defun user-grounded-p (designator)
  "Return true if DESIGNATOR is an action for which the predicate ACTION-GROUNDING has a solution,
and not only DEFAULT-ACTION-GROUNDING."
  (and (typep designator 'action-designator)
       (lazy-car (grounding-solutions 'action-grounding designator))
       t))

(defmethod resolve-designator ((designator action-designator) role)
  (declare (ignore role))
  (let ((own (grounding-solutions 'action-grounding designator)))
    (if (lazy-car own)
        own
        (grounding-solutions 'default-action-grounding designator))))

(defmethod resolve-designator ((designator motion-designator) role)
  (declare (ignore role))
  (grounding-solutions 'motion-grounding designator))

(defmethod resolve-designator ((designator designator) role)
  (declare (ignore role))
  (and (data designator) (list (data designator))))

;;; Why not

(defun key-words (designator)
  "Return words that say which keys DESIGNATOR has."
  (let ((keys (remove-duplicates (mapcar #'first (properties designator)) :from-end t)))
    (case (length keys)
      (0 "it has no properties")
      (1 (format nil "its only key is ~(~s~)" (first keys)))
      (t (format nil "its keys are ~{~(~s~)~#[~; and ~:;, ~]~}" keys)))))

(defun signal-unresolved (designator reason)
  (designator-error designator "~a cannot be resolved: ~a." designator reason))

(defgeneric unresolved-reason (designator)
  (:documentation "Return why DESIGNATOR, which has no solution, may have none, as a string.")
  (:method ((designator action-designator))
    (format nil "the predicate action-grounding has no solution for it; ~a"
            (key-words designator)))
  (:method ((designator motion-designator))
    (format nil "the predicate motion-grounding has no solution for it; ~a"
            (key-words designator)))
  (:method ((designator designator))
    "nothing was perceived that it describes"))

;;; Reference

(defgeneric reference (designator &optional role)
  (:documentation "Return the first solution of DESIGNATOR for ROLE: for an action the list of a
function and its arguments, for a motion of a command and its arguments, for a location a pose, for
an object or human what perception found.  It is kept, so that the same is returned the next time,
and DESIGNATOR becomes effective.  Signals DESIGNATOR-ERROR if there is none."))

(defmethod reference ((designator designator) &optional (role *default-role*))
  (with-slots (data solutions) designator
    (unless data
      (let* ((found (resolve-designator designator role))
             (first (and found (lazy-car found))))
        (unless first
          (signal-unresolved designator (unresolved-reason designator)))
        (setf solutions found
              data first)))
    (unless (effective designator)
      (mark-effective designator))
    data))

(defun solutions-from (designator)
  "Return the lazy list of the solutions of DESIGNATOR, which is referenced, from its own one on."
  (let ((solutions (slot-value designator 'solutions)))
    (or solutions (list (data designator)))))

(defun designator-groundings (designator)
  "Return the lazy list of the solutions of DESIGNATOR, that of REFERENCE first.  Signals
DESIGNATOR-ERROR if there is none."
  (reference designator)
  (solutions-from designator))

(defgeneric next-solution (designator)
  (:documentation "Return the successor of DESIGNATOR if it has one, else a new designator with the
same description, equated to DESIGNATOR, for its next solution; NIL if there is no further solution.
DESIGNATOR is referenced first, which signals DESIGNATOR-ERROR if there is no solution at all."))

(defmethod next-solution ((designator designator))
  (reference designator)
  (or (successor designator)
      (let* ((rest (lazy-cdr (solutions-from designator)))
             (next (and rest (lazy-car rest))))
        (when next
          (let ((new (copy-with designator (properties designator))))
            (setf (data new) next
                  (slot-value new 'solutions) rest)
            (equate designator new))))))
