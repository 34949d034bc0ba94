;;;; Base paths: A* over x, y and yaw.
;;;;
;;;; PLAN-PATH finds a way for the base through a lattice of places 5 cm and 22.5 degrees apart.  From
;;;; one to the next the base moves or turns, which costs as much as its length in m, or half of
;;;; its angle in rad.  Ties are broken by the order in which the places were found, so that the same
;;;; scene gives the same path.  Then the path is made short: of its corners only those remain that
;;;; are needed.

(in-package #:discrepancy-finder.projection)

(defparameter *turn-cost* 0.5d0
  "The cost of turning by a radian, as the length (m) of a way that costs the same.")

(defconstant +lattice-limit+ 2000000
  "A lattice with more places than that is made coarser.")

;;; Priority queues: binary heaps of numbers with keys

(defstruct (queue (:constructor make-queue ()) (:copier nil) (:predicate nil))
  (keys (make-array 1024 :element-type 'double-float) :type doubles)
  (places (make-array 1024 :element-type 'fixnum) :type (simple-array fixnum (*)))
  (size 0 :type fixnum))

(defun grow-queue (queue)
  (flet ((grown (old)
           (replace (make-array (* 2 (length old)) :element-type (array-element-type old)) old)))
    (setf (queue-keys queue) (grown (queue-keys queue))
          (queue-places queue) (grown (queue-places queue)))))

(declaim (inline before-p))
(defun before-p (key place other-key other-place)
  (declare (double-float key other-key) (fixnum place other-place))
  (or (< key other-key) (and (= key other-key) (< place other-place))))

(defun enqueue (queue key place)
  "Put PLACE into QUEUE under KEY."
  (declare (double-float key) (fixnum place) (optimize speed))
  (when (= (queue-size queue) (length (queue-keys queue)))
    (grow-queue queue))
  (let ((keys (queue-keys queue)) (places (queue-places queue)) (index (queue-size queue)))
    (incf (queue-size queue))
    (loop while (plusp index)
          do (let ((parent (ash (1- index) -1)))
               (unless (before-p key place (aref keys parent) (aref places parent))
                 (return))
               (setf (aref keys index) (aref keys parent)
                     (aref places index) (aref places parent)
                     index parent)))
    (setf (aref keys index) key
          (aref places index) place)))

(defun dequeue (queue)
  "Take the place with the least key out of QUEUE; return it, or NIL if there is none."
  (declare (optimize speed))
  (let ((keys (queue-keys queue)) (places (queue-places queue)))
    (unless (zerop (queue-size queue))
      (prog1 (aref places 0)
        (let* ((size (decf (queue-size queue)))
               (key (aref keys size)) (place (aref places size)) (index 0))
          (declare (fixnum index))
          (loop
            (let ((child (1+ (* 2 index))))
              (declare (fixnum child))
              (when (>= child size) (return))
              (when (and (< (1+ child) size)
                         (before-p (aref keys (1+ child)) (aref places (1+ child))
                                   (aref keys child) (aref places child)))
                (incf child))
              (unless (before-p (aref keys child) (aref places child) key place)
                (return))
              (setf (aref keys index) (aref keys child)
                    (aref places index) (aref places child)
                    index child)))
          (setf (aref keys index) key
                (aref places index) place))))))

;;; The lattice

(defstruct (lattice (:constructor %make-lattice (footing step x y columns rows costs parents states))
                    (:copier nil))
  "Places (column, row, direction), numbered.  COSTS are those of the best way to each that is known,
PARENTS the places before, STATES 0 where nothing is known, 1 where the robot can stand, 2 where it
cannot, 3 where the best way is known."
  (footing nil :type footing :read-only t)
  (step 0d0 :type double-float :read-only t)
  (x 0d0 :type double-float :read-only t)
  (y 0d0 :type double-float :read-only t)
  (columns 0 :type fixnum :read-only t)
  (rows 0 :type fixnum :read-only t)
  (costs nil :type doubles :read-only t)
  (parents nil :type (simple-array (signed-byte 32) (*)) :read-only t)
  (states nil :type (simple-array (unsigned-byte 8) (*)) :read-only t))

(defun make-lattice (footing bounds)
  "Return a lattice for FOOTING within BOUNDS, a list of the least x and y and the largest (m)."
  (destructuring-bind (x0 y0 x1 y1) bounds
    (loop for step = 0.05d0 then (* 2 step)
          for columns = (+ 1 (ceiling (- x1 x0) step))
          for rows = (+ 1 (ceiling (- y1 y0) step))
          for size = (* columns rows +yaws+)
          until (<= size +lattice-limit+)
          finally (return
                    (%make-lattice footing step (* step (ffloor x0 step)) (* step (ffloor y0 step))
                                   columns rows
                                   (make-array size :element-type 'double-float
                                                    :initial-element 1d9)
                                   (make-array size :element-type '(signed-byte 32)
                                                    :initial-element -1)
                                   (make-array size :element-type '(unsigned-byte 8)
                                                    :initial-element 0))))))

(declaim (inline place-number number-parts))
(defun place-number (lattice column row direction)
  (declare (fixnum column row direction))
  (the fixnum (+ direction (the fixnum (* +yaws+ (the fixnum (+ column (the fixnum (* row (lattice-columns lattice))))))))))

(defun number-parts (lattice number)
  "Return column, row and direction of the place NUMBER of LATTICE."
  (declare (fixnum number))
  (multiple-value-bind (cell direction) (floor number +yaws+)
    (multiple-value-bind (row column) (floor cell (lattice-columns lattice))
      (values column row direction))))

(defun numbered-place (lattice number)
  (multiple-value-bind (column row direction) (number-parts lattice number)
    (list (+ (lattice-x lattice) (* column (lattice-step lattice)))
          (+ (lattice-y lattice) (* row (lattice-step lattice)))
          (short-turn (* direction (/ (* 2 pi) +yaws+))))))

(defun open-place-p (lattice number)
  "Return true if the robot can stand at the place NUMBER of LATTICE."
  (declare (fixnum number) (optimize speed))
  (let ((states (lattice-states lattice)))
    (when (zerop (aref states number))
      (multiple-value-bind (column row direction) (number-parts lattice number)
        (declare (fixnum column row))
        (let ((footing (lattice-footing lattice)))
          (setf (aref states number)
                (if (> (the double-float
                            (parts-clearance footing (parts-at footing direction)
                                             (+ (lattice-x lattice)
                                                (* column (lattice-step lattice)))
                                             (+ (lattice-y lattice)
                                                (* row (lattice-step lattice)))
                                             (the double-float *path-margin*)))
                       (the double-float *path-margin*))
                    1
                    2)))))
    (/= 2 (aref states number))))

(defun places-near (lattice place)
  "Return the numbers of the places of LATTICE to which the robot can go straight from PLACE."
  (destructuring-bind (x y yaw) place
    (let* ((step (lattice-step lattice)) (unit (/ (* 2 pi) +yaws+))
           (column (round (- x (lattice-x lattice)) step))
           (row (round (- y (lattice-y lattice)) step))
           (direction (floor yaw unit)))
      (loop for c from (max 0 (- column 3)) to (min (1- (lattice-columns lattice)) (+ column 3))
            append (loop for r from (max 0 (- row 3)) to (min (1- (lattice-rows lattice)) (+ row 3))
                         append (loop for d in (list direction (1+ direction))
                                      for number = (place-number lattice c r (mod d +yaws+))
                                      when (and (open-place-p lattice number)
                                                (straight-way-p (lattice-footing lattice) place
                                                                (numbered-place lattice number)))
                                        collect number))))))

(defun way-cost (from to)
  "Return the cost of going straight from the place FROM to TO."
  (+ (sqrt (+ (expt (- (first to) (first from)) 2) (expt (- (second to) (second from)) 2)))
     (* *turn-cost* (abs (short-turn (- (third to) (third from)))))))

(defun goal-estimate (lattice goal)
  "Return a function that returns a lower bound of the cost from the place with a number to GOAL."
  (destructuring-bind (goal-x goal-y goal-yaw) goal
    (declare (double-float goal-x goal-y))
    (let ((turns (make-array +yaws+ :element-type 'double-float
                                    :initial-contents
                                    (loop for d below +yaws+
                                          collect (* *turn-cost*
                                                     (abs (short-turn
                                                           (- (* d (/ (* 2 pi) +yaws+))
                                                              goal-yaw))))))))
      (lambda (number)
        (declare (fixnum number) (optimize speed))
        (multiple-value-bind (column row direction) (number-parts lattice number)
          (declare (fixnum column row))
          (let ((dx (- (+ (lattice-x lattice) (* column (lattice-step lattice))) goal-x))
                (dy (- (+ (lattice-y lattice) (* row (lattice-step lattice))) goal-y)))
            (+ (sqrt (the (double-float 0d0) (+ (* dx dx) (* dy dy))))
               (aref turns direction))))))))

(defun search-lattice (lattice starts goals estimate)
  "Return the number of the last place of the best way from one of STARTS to one of GOALS, both lists
of (number . cost), and its cost, or NIL.  ESTIMATE is a lower bound of the cost to come."
  (declare (function estimate) (optimize speed))
  (let ((queue (make-queue))
        (costs (lattice-costs lattice)) (parents (lattice-parents lattice))
        (states (lattice-states lattice))
        (columns (lattice-columns lattice)) (rows (lattice-rows lattice))
        (unit (lattice-step lattice))
        (turn (* (the double-float *turn-cost*) (/ (* 2 pi) +yaws+)))
        (goal-costs (make-hash-table))
        (best nil) (best-cost 1d9))
    (declare (double-float best-cost unit turn))
    (loop for (number . cost) in goals do (setf (gethash number goal-costs) cost))
    (flet ((reach (number cost parent)
             (declare (fixnum number parent) (double-float cost))
             (when (< cost (aref costs number))
               (setf (aref costs number) cost
                     (aref parents number) parent)
               (enqueue queue (+ cost (the double-float (funcall estimate number))) number))))
      (loop for (number . cost) in starts do (reach number cost -1))
      (loop
        (let ((number (dequeue queue)))
          (unless number (return))
          (let ((cost (aref costs number)))
            (when (and best (>= (+ cost (the double-float (funcall estimate number))) best-cost))
              (return))
            (unless (= 3 (aref states number))
              (setf (aref states number) 3)
              (let ((rest (gethash number goal-costs)))
                (when (and rest (< (+ cost (the double-float rest)) best-cost))
                  (setf best number
                        best-cost (+ cost (the double-float rest)))))
              (multiple-value-bind (column row direction) (number-parts lattice number)
                (declare (fixnum column row direction))
                (macrolet ((try (c r d cost)
                             `(let ((next (place-number lattice ,c ,r ,d)))
                                (when (and (/= 3 (aref states next)) (open-place-p lattice next))
                                  (reach next (+ cost ,cost) number)))))
                  (loop for dc of-type fixnum from -1 to 1
                        do (loop for dr of-type fixnum from -1 to 1
                                 for c of-type fixnum = (+ column dc)
                                 for r of-type fixnum = (+ row dr)
                                 do (unless (or (and (zerop dc) (zerop dr))
                                                (< c 0) (< r 0) (>= c columns) (>= r rows))
                                      (try c r direction
                                           (if (or (zerop dc) (zerop dr))
                                               unit
                                               (* unit #.(sqrt 2d0)))))))
                  (try column row (mod (1+ direction) +yaws+) turn)
                  (try column row (mod (1- direction) +yaws+) turn))))))))
    (values best best-cost)))

;;; Paths

(defun shortened-path (footing places)
  "Return the path through PLACES without the corners that it does not need."
  (let ((path (list (first places))) (rest places))
    (loop while (rest rest)
          do (let ((next (or (loop for tail on (reverse (rest rest))
                                   when (or (null (rest tail))
                                            (straight-way-p footing (first rest) (first tail)))
                                     return (first tail))
                             (second rest))))
               (push next path)
               (setf rest (member next rest :test #'eq))))
    (nreverse path)))

(defun plan-path (footing start goal bounds)
  "Return a list of places from START to GOAL on which the robot of FOOTING meets nothing, or NIL if
there is none within BOUNDS (see MAKE-LATTICE).  It is a straight one if that is free."
  (setf (footing-ends footing) (list start goal))
  (if (straight-way-p footing start goal)
      (list start goal)
      (let* ((lattice (make-lattice footing bounds))
             (starts (places-near lattice start))
             (goals (and starts (places-near lattice goal)))
             (last (and goals
                        (flet ((with-costs (numbers end)
                                 (loop for number in numbers
                                       collect (cons number
                                                     (way-cost (numbered-place lattice number)
                                                               end)))))
                          (search-lattice lattice (with-costs starts start)
                                          (with-costs goals goal)
                                          (goal-estimate lattice goal))))))
        (and last
             (shortened-path
              footing
              (let ((path (list goal)))
                (loop for number = last then (aref (lattice-parents lattice) number)
                      until (minusp number)
                      do (push (numbered-place lattice number) path))
                (cons start path)))))))
