;;;; Windows: what a state alone decides.
;;;;
;;;; To ask why something follows after many steps, it is enough to look at the last few: if the
;;;; future of a state depends on its fluents and on nothing before, a run can be told from there,
;;;; with the fluents as facts.

(in-package #:discrepancy-finder.event-calculus)

(defun timeless-clause-p (clause)
  "Return true if CLAUSE, (axiom kind condition head), speaks of no timepoint."
  (labels ((timeless-p (form)
             (or (atom form)
                 (and (not (member (first form)
                                   '(:holds-at :happens :released-at :initiates :terminates
                                     :releases :trajectory :anti-trajectory :value-at :clipped
                                     :declipped :stopped-in :started-in)))
                      (every #'timeless-p (rest form))))))
    (destructuring-bind (axiom kind &rest forms) clause
      (declare (ignore axiom kind))
      (every #'timeless-p forms))))

(defun self-contained-p (state)
  "Return true if what the theory says of the time after STATE depends on the truth values of its
fluents alone: on no earlier timepoints, no numbers, no fluents that are or may be released but are
inertial as a rule."
  (let* ((outline (state-outline state))
         (ground (outline-ground outline)))
    (and (not (axioms-look-back-p outline))
         (not (outline-late-p outline))
         (every #'timeless-clause-p (ground-theory-absolute-clauses ground))
         (zerop (length (ground-theory-numerics ground)))
         (null (state-pending state))
         (loop for released across (state-released state)
               for release across (outline-release outline)
               always (or (null released) (eq release :always))))))

(defun formula-form (ground formula time)
  "Return the ground state FORMULA of GROUND as a formula about the timepoint TIME, or as a state
formula if that is NIL; or NIL if it speaks of more than fluents and timeless atoms."
  (labels ((form (formula)
             (cond ((eq formula t) '(:and))
                   ((null formula) '(:or))
                   ((member (first formula) '(:and :or :not :iff))
                    (cons (first formula) (mapcar #'form (rest formula))))
                   ((eq (first formula) :fluent)
                    (let ((atom (svref (ground-theory-fluents ground) (second formula))))
                      (if time (list :holds-at atom time) atom)))
                   ((eq (first formula) :static)
                    (aref (atom-table-atoms (ground-theory-statics ground)) (second formula)))
                   (t (return-from formula-form nil)))))
    (form formula)))

(defun effect-conditions (ground predicate event fluent)
  "Return a list of (name . formula): the axioms of GROUND by which the ground EVENT has an effect
by PREDICATE (:initiates, :terminates or :releases) on the ground FLUENT, and under which condition,
a state formula; that is NIL where it speaks of more than fluents and timeless atoms."
  (loop for effect in (effects-of ground predicate (find-event ground event)
                                  (find-fluent ground fluent))
        collect (cons (axiom-name (effect-axiom effect))
                      (formula-form ground (effect-guard effect) nil))))
