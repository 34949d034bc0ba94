;;;; Interleavings: the order in which parallel tasks take their turns, as decisions.
;;;;
;;;; A TURN is what a strand does between two switches.  Where several strands are ready, a NODE,
;;;; the first run takes the one that has waited for longest.  After the run its turns are
;;;; compared (see races.lisp): only where two of them may not change places another order is
;;;; noted as an alternative.  So branches that have nothing to do with each other are explored in
;;;; one order. With :ALL every order is explored.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (node (:constructor make-node (ready leaving so-far)) (:copier nil))
  "A place where one of the strands READY, a list of numbers, is chosen after the decisions SO-FAR.
Those LEAVING are going to leave their tasks.  EXPLORED are the positions in READY that some run
chooses."
  (ready '() :type list :read-only t)
  (leaving '() :type list :read-only t)
  (so-far '() :type list :read-only t)
  (explored '() :type list))

(defstruct (turn-decision (:include decision)
                          (:constructor make-turn-decision (choice description node))
                          (:copier nil))
  "The decision at NODE."
  (node nil :type (or null node)))

(defstruct (turn (:copier nil))
  "A turn of the strand with the number STRAND, chosen at NODE if others were ready.  RELATIVES are
the numbers of the strands around its strand.  LOOKS and CHANGES are sets of fluents.  USE is what
its code does in Lisp; STEPS-P is true if it performs something, EVAPORATING if it only leaves its
task, NEEDS-ALL if all branches that its strand has started had to end before."
  (strand 0 :type fixnum :read-only t)
  (node nil :type (or null node) :read-only t)
  (relatives '() :type list :read-only t)
  (looks 0 :type unsigned-byte)
  (changes 0 :type unsigned-byte)
  (use nil :type lisp-use)
  (steps-p nil)
  (evaporating nil :read-only t)
  (needs-all nil :read-only t))

(defstruct (schedule (:copier nil))
  "The TURNS of a run, the last one first.  NODE is the one at which the next strand was chosen.
USES are what the code of branches does in Lisp, by their forms, CALLS what plans that a perform
enters do, by the number of the strand.  VISIBLE is what VISIBLE-STEPS returns; STRICT is true if
each step has its place."
  (turns '() :type list)
  (node nil :type (or null node))
  (uses nil :type hash-table :read-only t)
  (calls '() :type list)
  (visible '(0) :type list :read-only t)
  (strict nil :read-only t))

(defparameter *turn* "the task that has its turn"
  "The description of decisions for a strand.")

(defmethod plan:choose-strand ((path path) scheduler count)
  (case (path-interleavings path)
    ((nil) (call-next-method))
    (:all (decide path *turn* (loop for number below count collect (cons number t))
                  :exhaustive t))
    (t (outside-the-plan (path)
         (check-deadline path)
         (choose-turn path (plan:ready-strands scheduler))))))

(defmethod plan:gives-way-p ((path path))
  (null (path-interleavings path)))

(defun new-turn-decision (path choice node)
  (fill-decision path (make-turn-decision choice *turn* node) (cons choice t)))

(defun make-turn-node (path strands)
  (make-node (mapcar #'plan:strand-number strands)
             (mapcar #'plan:strand-number (remove-if-not #'plan:strand-evaporating-p strands))
             (path-decisions path)))

(defun choose-turn (path strands)
  "Return the number of the one among STRANDS that has its turn on PATH."
  (let* ((recorded (next-recorded path))
         (node (or (and (turn-decision-p recorded) (turn-decision-node recorded))
                   (make-turn-node path strands))))
    (when (and recorded (not (and (string= (decision-description recorded) *turn*)
                                  (< (decision-choice recorded) (length strands)))))
      (other-decision path recorded *turn*))
    (let ((choice (if recorded (decision-choice recorded) 0)))
      (cond (recorded
             (unless (current-p path recorded)
               (fill-decision path recorded (cons choice t)))
             (repeat-decision path recorded))
            (t (take-decision path (new-turn-decision path choice node))))
      (pushnew choice (node-explored node))
      (setf (schedule-node (path-schedule path)) node)
      choice)))

(defun relatives (strand)
  "Return the numbers of the strands that the tasks around that of STRAND run on, innermost first."
  (let ((numbers '()))
    (loop for task = (plan:strand-task strand) then (plan:task-parent task)
          while task
          do (let ((other (plan:task-strand task)))
               (when (and other (not (eq other strand)))
                 (pushnew (plan:strand-number other) numbers))))
    (nreverse numbers)))

(defun branch-use (path strand)
  "Return what the code of STRAND does in Lisp: that of the branch that it belongs to.  A strand for
a PERFORM has no code of its own."
  (let ((uses (schedule-uses (path-schedule path))))
    (loop for task = (plan:strand-task strand) then (plan:task-parent task)
          while task
          do (multiple-value-bind (form branch-p) (plan:branch-code task)
               (cond (branch-p
                      (return (or (gethash form uses)
                                  (setf (gethash form uses)
                                        (outside-the-plan (path) (form-use form))))))
                     ((and (eq (plan:task-strand task) strand) (plan:perform-task-p task)
                           (not (eq (plan:task-strand (plan:task-parent task)) strand)))
                      (return (make-lisp-use)))))
          finally (return (make-lisp-use :unknown-p t)))))

(defmethod plan:begin-turn ((path path) strand)
  (let ((schedule (path-schedule path)))
    (when schedule
      (let* ((relatives (relatives strand))
             (use (branch-use path strand))
             (calls (loop for (number . call) in (schedule-calls schedule)
                          when (or (= number (plan:strand-number strand))
                                   (member number relatives))
                            collect call)))
        (push (make-turn :strand (plan:strand-number strand) :relatives relatives
                         :node (shiftf (schedule-node schedule) nil)
                         :evaporating (plan:strand-evaporating-p strand)
                         :needs-all (plan:all-needed-p strand)
                         :use (reduce #'merge-use calls
                                      :initial-value (merge-use (make-lisp-use) use)))
              (schedule-turns schedule))))))

;;; What a turn does

(defun current-turn (path)
  (let ((schedule (path-schedule path)))
    (and schedule (first (schedule-turns schedule)))))

(defun note-looks (looks)
  "Note that the current turn, if there is one, looks at the set of fluents LOOKS."
  (let ((turn (and *path* (current-turn *path*))))
    (when turn
      (setf (turn-looks turn) (logior (turn-looks turn) looks)))))

(defun note-entered-plan (path name)
  "Note that the current turn of PATH begins to run the plan NAME."
  (let ((turn (current-turn path)))
    (when turn
      (let ((use (function-use name)))
        (push (cons (turn-strand turn) use) (schedule-calls (path-schedule path)))
        (merge-use (turn-use turn) use)))))

(defun note-outcomes (path outcomes)
  "Note what the outcomes of an action look at and change."
  (let ((turn (current-turn path)))
    (when turn
      (let* ((ground (action-theory-ground (path-domain path)))
             (schedule (path-schedule path))
             (beyond (ash 1 (length (ec:ground-theory-fluents ground)))))
        (setf (turn-steps-p turn) t)
        (destructuring-bind (visible &rest events) (schedule-visible schedule)
          (dolist (outcome outcomes)
            (let ((event (ec:event-number ground (outcome-event outcome))))
              (multiple-value-bind (looks changes) (ec:event-footprint ground event)
                (when (or (eq visible t) (schedule-strict schedule)
                          (plusp (logand changes visible))
                          (member event events))
                  (setf changes (logior changes beyond)))
                (setf (turn-looks turn)
                      (logior (turn-looks turn) looks
                              (ec:formula-footprint (outcome-condition outcome)))
                      (turn-changes turn) (logior (turn-changes turn) changes))))))))))
