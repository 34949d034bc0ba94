;;;; Races: where another order of turns may make a difference.
;;;;
;;;; Two turns CONFLICT if one changes what the other looks at or changes: fluents of the theory,
;;;; the truth of the explored state constraint, variables of Lisp.  A turn comes BEFORE another
;;;; one if it is earlier and they conflict or belong together, or by way of others.  For each
;;;; turn the last earlier one is sought that conflicts with it and does not come before what its
;;;; strand did before: there the other order is to be explored, too.  This is dynamic
;;;; partial-order reduction (Flanagan and Godefroid, 2005), worked out after each run; since a
;;;; run notes alternatives only at nodes on its own path, it does not matter in which order runs
;;;; are made.  A strand that was ready but had no turn any more, because it evaporated or the
;;;; path ended, is taken at the last node where it could be.  Entry points: NEW-SCHEDULE,
;;;; NOTE-RACES.

(in-package #:discrepancy-finder.symbolic-execution)

(defun without-events (formula)
  "Return the ground FORMULA with all events false, as far as constants can be folded."
  (cond ((atom formula) formula)
        ((eq (first formula) :event) nil)
        ((eq (first formula) :not)
         (let ((part (without-events (second formula))))
           (if (typep part 'boolean) (not part) (list :not part))))
        ((member (first formula) '(:and :or))
         (let ((parts (mapcar #'without-events (rest formula)))
               (absorbing (eq (first formula) :or)))
           (cond ((member absorbing parts) absorbing)
                 ((every (lambda (part) (eq part (not absorbing))) parts) (not absorbing))
                 (t (cons (first formula) parts)))))
        (t formula)))

(defun formula-events (formula)
  "Return the numbers of the events in the ground FORMULA."
  (cond ((atom formula) '())
        ((eq (first formula) :event) (list (second formula)))
        ((member (first formula) '(:and :or :not :iff))
         (remove-duplicates (mapcan #'formula-events (copy-list (rest formula)))))))

(defun visible-steps (formula span)
  "Return which steps can change whether the ground FORMULA of a state constraint over SPAN steps
comes true: a list of a set of fluents and numbers of events; the set is T if all can, as FORMULA
:ANY says."
  (cond ((eq formula :any) (list t))
        ((typep formula 'boolean) (list 0))
        ((or (> span 1) (and (= span 1) (without-events formula))) (list t))
        (t (cons (ec:formula-footprint formula) (formula-events formula)))))

(defun new-schedule (domain interleavings formula span uses)
  "Return the schedule of a new run, or NIL if orders are not to be pruned.  USES is a table for
what code of branches does."
  (and (eq interleavings t)
       (make-schedule :uses uses
                      :visible (visible-steps formula span)
                      :strict (ec:order-matters-p (action-theory-ground domain)))))

(defun clash-p (one other)
  "Return true if one of the turns ONE and OTHER changes what the other looks at or changes."
  (or (plusp (logand (turn-changes one) (logior (turn-looks other) (turn-changes other))))
      (plusp (logand (turn-changes other) (turn-looks one)))
      (uses-conflict-p (turn-use one) (turn-use other))))

(defun around-p (strand turn)
  "Return true if the number STRAND is that of a strand around that of TURN."
  (and (member strand (turn-relatives turn)) t))

(defun family-turn-p (strand turn)
  (or (= strand (turn-strand turn)) (around-p strand turn)))

(defun branch-below (strand turn)
  "Return the number of the strand next to STRAND among those around that of TURN, or its own."
  (let ((tail (member strand (turn-relatives turn))))
    (or (first (last (ldiff (turn-relatives turn) tail))) (turn-strand turn))))

(defun ready-at-p (strand turn)
  "Return true if the number STRAND could have had its turn instead of TURN."
  (let ((node (turn-node turn)))
    (and node (member strand (node-ready node)) t)))

(defun ordered-p (turns i j)
  "Return true if the turn I among TURNS must come before the later turn J: they are of one strand,
or I starts the branch of J, or J waits for the end of the branch of I."
  (let ((one (svref turns i)) (other (svref turns j)))
    (cond ((= (turn-strand one) (turn-strand other)))
          ((ready-at-p (turn-strand other) one) nil)
          ((around-p (turn-strand other) one)
           ;; One that has turns afterwards has not ended.
           (let ((branch (branch-below (turn-strand other) one)))
             (and (turn-needs-all other)
                  (not (find-if (lambda (turn) (family-turn-p branch turn)) turns
                                :start (1+ j))))))
          ((around-p (turn-strand one) other)
           (let ((branch (branch-below (turn-strand one) other)))
             (not (find-if (lambda (turn) (family-turn-p branch turn)) turns :end i)))))))

(defun conflict-p (turns i j)
  "Return true if the turns I and J among TURNS may not change places: they clash, or one can end
the branch of the other."
  (let ((one (svref turns i)) (other (svref turns j)))
    (or (around-p (turn-strand one) other)
        (around-p (turn-strand other) one)
        (clash-p one other))))

(defun note-turn-at (path node strand)
  "Note that the number STRAND is to have its turn at NODE, if it is ready there."
  (let ((choice (position strand (node-ready node))))
    (when (and choice (not (member choice (node-explored node))))
      (push choice (node-explored node))
      (push (cons (new-turn-decision path choice node) (node-so-far node))
            (path-alternatives path)))))

(defun note-order (path node strand between)
  "Let STRAND, or one of the strands BETWEEN without which it is not ready, have its turn at NODE."
  (let* ((ready (node-ready node))
         (useful (intersection ready (cons strand between))))
    (flet ((explored-p (strand)
             (member (position strand (node-ready node)) (node-explored node))))
      (cond ((some #'explored-p useful))
            ((member strand useful) (note-turn-at path node strand))
            (useful (note-turn-at path node (reduce #'min useful)))
            (t (dolist (other ready) (note-turn-at path node other)))))))

(defun strands-between (turns start end wanted-p)
  "Return the numbers of the strands of those of TURNS after START and before END that are
WANTED-P, a function of an index."
  (remove-duplicates (loop for k from (1+ start) below end
                           when (funcall wanted-p k) collect (turn-strand (svref turns k)))))

(defun note-race (path turns i j own)
  "Note that the turns I and J among TURNS are to be tried the other way round.  OWN are those that
must come before J, as bits."
  (let ((node (turn-node (svref turns i))))
    (when node
      (note-order path node (turn-strand (svref turns j))
                  (strands-between turns i j (lambda (k) (logbitp k own)))))))

(defun ended-branches (turns j)
  "Return the branches of the strand of turn J among TURNS that have ended before it."
  (let* ((strand (turn-strand (svref turns j)))
         (branches (loop for i below j
                         for turn = (svref turns i)
                         when (around-p strand turn)
                           collect (branch-below strand turn))))
    (remove-if (lambda (branch)
                 (find-if (lambda (turn) (family-turn-p branch turn)) turns :start (1+ j)))
               (remove-duplicates branches))))

(defun effectless-p (turn)
  "Return true if TURN changes nothing: where its branch is given up, it does not matter whether it
was there."
  (and (zerop (turn-changes turn))
       (null (lisp-use-writes (turn-use turn)))
       (not (lisp-use-unknown-p (turn-use turn)))))

(defun note-first-ends (path turns j own)
  "The strand of turn J among TURNS went on as soon as one of its branches had ended: note that each
of these is to end before the turns of the others, as far as they are not in OWN."
  (let* ((strand (turn-strand (svref turns j)))
         (ended (ended-branches turns j)))
    (loop for i from (1- j) downto 0
          for turn = (svref turns i)
          when (and (turn-node turn) (around-p strand turn) (not (logbitp i own))
                    (not (effectless-p turn)))
            do (when (ready-at-p strand turn)
                 (note-order path (turn-node turn) strand '()))
               (dolist (branch (remove (branch-below strand turn) ended))
                 (note-order path (turn-node turn) branch
                             (strands-between turns i j
                                              (lambda (k)
                                                (family-turn-p branch (svref turns k)))))))))

(defun last-race (turns j own)
  "Return the index of the last of TURNS before J that clashes with it and is not in OWN, or NIL."
  (loop for i from (1- j) downto 0
        when (and (not (logbitp i own))
                  (conflict-p turns i j)
                  (not (around-p (turn-strand (svref turns j)) (svref turns i))))
          return i))

(defun note-races (path)
  "Note the orders of turns that are to be explored because of what the run of PATH has shown."
  (when (path-schedule path)
    (let* ((turns (coerce (reverse (schedule-turns (path-schedule path))) 'simple-vector))
           (before (make-array (length turns) :initial-element 0)))
      (dotimes (j (length turns))
        (flet ((gather (mask test)
                 (loop for i from (1- j) downto 0
                       do (when (and (not (logbitp i mask)) (funcall test turns i j))
                            (setf mask (logior mask (ash 1 i) (svref before i)))))
                 mask))
          (let* ((own (gather 0 #'ordered-p))
                 (race (last-race turns j own)))
            (when race
              (note-race path turns race j own))
            (unless (turn-needs-all (svref turns j))
              (note-first-ends path turns j own))
            (setf (svref before j) (gather own #'conflict-p)))))
      (note-unfinished path turns))))

(defun next-turn (turns index strand)
  "Return the first of TURNS after INDEX that STRAND has, unless it only leaves its task there."
  (let ((turn (find strand turns :key #'turn-strand :start (1+ index))))
    (and turn (not (turn-evaporating turn)) turn)))

(defun note-unfinished (path turns)
  "Note at the last possible node the turns that strands could have had and did not."
  (let ((done '()))
    (loop for index from (1- (length turns)) downto 0
          for turn = (svref turns index)
          for node = (turn-node turn)
          when node
            do (dolist (strand (set-difference (node-ready node) (node-leaving node)))
                 (unless (or (eql strand (turn-strand turn)) (member strand done))
                   (unless (next-turn turns index strand)
                     (push strand done)
                     (note-turn-at path node strand)))))))
