;;;; Trajectories along a chain of states: DEC3 and DEC4.
;;;;
;;;; A state notes which causes of trajectories were initiated or terminated just before it, its
;;;; TURNS.  A trajectory that began at t makes its fluent true at t + offset unless its cause was
;;;; stopped in between; so at each step the chain is walked back to find those that are due.
;;;; Entry point: DUE-CHANGES.

(in-package #:discrepancy-finder.event-calculus)

(defun outline-changes (outline time)
  "Return the vector of the gradual changes of each cause, with offsets that reach from the first
timepoint to TIME."
  (let ((ground (outline-ground outline)))
    (if (and (outline-causes outline) (outline-dated-p outline))
        (dated-changes (outline-dated-until outline time))
        (ground-theory-changes ground))))

(defun map-turns (function step cause longest)
  "Call FUNCTION with each timepoint, back from that of STEP, at which CAUSE was initiated or
terminated at most LONGEST timepoints before the next one, and with the two propositions; until it
returns true.  The turns of STEP itself are those of its next state."
  (declare (type function function))
  (loop with end = (1+ (step-time step))
        for state = (step-next step) then (state-predecessor state)
        for time = (and state (1- (state-time state)))
        while (and (state-predecessor state) (<= (- end time) longest))
        do (let ((turn (assoc cause (state-turns state))))
             (when (and turn (funcall function time (second turn) (third turn)))
               (return)))))

(defun kind-changes (changes kind end time)
  "Return those of CHANGES of KIND that begin at TIME and are due at END."
  (loop for change in changes
        when (and (eq (gradual-change-kind change) kind)
                  (= (gradual-change-offset change) (- end time))
                  (or (null (gradual-change-time change)) (= (gradual-change-time change) time)))
          collect change))

(defun due-changes (step)
  "Return what trajectories say of the next state of STEP: a list of (gradual-change begin
proposition), where the proposition says that the change began at BEGIN and was not stopped."
  (let* ((outline (step-outline step))
         (end (1+ (step-time step)))
         (changes-of (outline-changes outline end))
         (due '()))
    (dolist (cause (outline-causes outline) due)
      (let* ((changes (svref changes-of cause))
             (longest (reduce #'max changes :key #'gradual-change-offset :initial-value 0))
             (stopped nil) (started nil))
        (map-turns (lambda (time initiated terminated)
                     (flet ((note (kind begun ended)
                              (let ((going (z3:conjunction (list begun (z3:negation ended)))))
                                (when going
                                  (dolist (change (kind-changes changes kind end time))
                                    (push (list change time going) due))))))
                       (note :trajectory initiated stopped)
                       (note :anti-trajectory terminated started)
                       (setf stopped (z3:disjunction (list stopped terminated))
                             started (z3:disjunction (list started initiated)))
                       (and (eq stopped t) (eq started t))))
                   step cause longest)))))

(defun change-begin (change begin)
  "Return by how much to move the guard of CHANGE, which began at BEGIN."
  (if (gradual-change-time change) 0 begin))

(defun early-change-p (change begin end)
  "Return true if guard and term of CHANGE are known before the timepoint END is."
  (loop for formula in (list (gradual-change-guard change)
                             (list :compare := 0 (gradual-change-term change)))
        for reach = (formula-reach formula)
        always (or (null reach) (< (+ reach (change-begin change begin)) end))))

(defun change-formula (outline change begin)
  "Return the axiom of CHANGE, for BEGIN, as a ground formula with timepoints."
  (let ((cause (gradual-change-cause change))
        (end (+ begin (gradual-change-offset change)))
        (trajectory (eq (gradual-change-kind change) :trajectory)))
    (fold :or (list* (fold-not (effects-formula outline cause
                                                (if trajectory :initiates :terminates) begin))
                     (fold-not (shift-formula (gradual-change-guard change)
                                              (change-begin change begin)))
                     (changed-formula change begin)
                     (loop for time from (1+ begin) below end
                           collect (effects-formula outline cause
                                                    (if trajectory :terminates :initiates)
                                                    time))))))
