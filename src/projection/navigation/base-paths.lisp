;;;; Base paths: A* over x, y and yaw.
;;;;
;;;; PLAN-PATH finds a way for the base through a lattice of places 5 cm and 22.5 degrees apart,
;;;; after it has tried one of 10 cm in which the base turns only from its first direction to its
;;;; last.  From one place to the next the base moves or turns, which costs as much as its length in
;;;; m, or half of its angle in rad.  Ties are broken by the numbers of the places, so that the same
;;;; scene gives the same path.  Then the path is made short: of its corners only those remain that
;;;; are needed.

(in-package #:discrepancy-finder.projection)

(defparameter *turn-cost* 0.5d0
  "The cost of turning by a radian, as the length (m) of a way that costs the same.")

(defconstant +lattice-limit+ 2000000
  "A lattice with more places than that is made coarser.")

;;; The lattice

(defstruct (lattice (:constructor %make-lattice (footing step x y columns rows directions costs
                                                  parents clearances closed))
                    (:copier nil))
  "Places (column, row, direction), numbered; a direction is an index into DIRECTIONS, a vector of
numbers below +YAWS+.  COSTS are those of
the best way to each that is known, PARENTS the places before, CLEARANCES lower bounds of the
distances (m) that the robot has there, as far as they are known, CLOSED is 1 where the best way is
known."
  (footing nil :type footing :read-only t)
  (step 0d0 :type double-float :read-only t)
  (x 0d0 :type double-float :read-only t)
  (y 0d0 :type double-float :read-only t)
  (columns 0 :type (unsigned-byte 24) :read-only t)
  (rows 0 :type (unsigned-byte 24) :read-only t)
  (directions #() :type simple-vector :read-only t)
  (costs nil :type doubles :read-only t)
  (parents nil :type (simple-array (signed-byte 32) (*)) :read-only t)
  (clearances nil :type doubles :read-only t)
  (closed nil :type simple-bit-vector :read-only t))

(defconstant +unknown+ -1d9
  "Where the clearance of a place is not known.")

(defun make-lattice (footing bounds step directions)
  "Return a lattice for FOOTING within BOUNDS, a list of the least x and y and the largest (m), with
places about STEP (m) apart in DIRECTIONS, a list of numbers below +YAWS+."
  (destructuring-bind (x0 y0 x1 y1) bounds
    (loop for unit = step then (* 2 unit)
          for columns = (+ 1 (ceiling (- x1 x0) unit))
          for rows = (+ 1 (ceiling (- y1 y0) unit))
          for size = (* columns rows (length directions))
          until (<= size +lattice-limit+)
          finally (flet ((numbers (initial)
                           (make-array size :element-type 'double-float :initial-element initial)))
                    (return
                      (%make-lattice footing unit (* unit (ffloor x0 unit))
                                     (* unit (ffloor y0 unit)) columns rows
                                     (coerce directions 'simple-vector)
                                     (numbers 1d9)
                                     (make-array size :element-type '(signed-byte 32)
                                                      :initial-element -1)
                                     (numbers +unknown+)
                                     (make-array size :element-type 'bit
                                                      :initial-element 0)))))))

(declaim (inline place-number number-parts))
(defun place-number (lattice column row direction)
  (declare (type (unsigned-byte 24) column row direction))
  (+ direction (* (the (unsigned-byte 8) (length (lattice-directions lattice)))
                  (+ column (* row (lattice-columns lattice))))))

(defun number-parts (lattice number)
  "Return column, row and direction of the place NUMBER of LATTICE."
  (declare (type (unsigned-byte 32) number))
  (multiple-value-bind (cell direction)
      (floor number (the (integer 1 255) (length (lattice-directions lattice))))
    (multiple-value-bind (row column) (floor cell (lattice-columns lattice))
      (values column row direction))))

(defun direction-yaw (direction)
  "Return the yaw (rad) of the DIRECTION, a number below +YAWS+."
  (* direction (/ (* 2 pi) +yaws+)))

(defun lattice-yaw (lattice index)
  "Return the yaw (rad) of the direction INDEX of LATTICE."
  (direction-yaw (svref (lattice-directions lattice) index)))

(defun nearest-direction (yaw)
  "Return the direction, a number below +YAWS+, that is nearest to YAW (rad)."
  (mod (round yaw (/ (* 2 pi) +yaws+)) +yaws+))

(defun numbered-place (lattice number)
  "Return the place NUMBER of LATTICE as a list x, y, yaw."
  (multiple-value-bind (column row direction) (number-parts lattice number)
    (list (+ (lattice-x lattice) (* column (lattice-step lattice)))
          (+ (lattice-y lattice) (* row (lattice-step lattice)))
          (short-turn (lattice-yaw lattice direction)))))

(defun open-place-p (lattice number bound)
  "Return true if the robot can stand at the place NUMBER of LATTICE, where it has at least the
clearance BOUND (m)."
  (declare (type (unsigned-byte 32) number) (double-float bound)
           (optimize speed (safety 1))
           (sb-ext:muffle-conditions sb-ext:compiler-note))
  (let ((clearances (lattice-clearances lattice)) (margin *path-margin*))
    (declare (type double-float margin))
    (when (> bound (aref clearances number))
      (cond ((> bound margin)
             (setf (aref clearances number) bound))
            ((= +unknown+ (aref clearances number))
             (multiple-value-bind (column row direction) (number-parts lattice number)
               (declare (type (unsigned-byte 24) column row direction))
               (let ((footing (lattice-footing lattice)))
                 (setf (aref clearances number)
                       (the double-float
                            (clearance-at footing
                                          (+ (lattice-x lattice)
                                             (* column (lattice-step lattice)))
                                          (+ (lattice-y lattice) (* row (lattice-step lattice)))
                                          (the double-float (lattice-yaw lattice direction))
                                          (parts-at footing
                                                    (svref (lattice-directions lattice)
                                                           direction))
                                          margin))))))))
    (> (aref clearances number) margin)))

(defun places-near (lattice place)
  "Return the numbers of the places of LATTICE to which the robot can go straight from PLACE."
  (destructuring-bind (x y yaw) place
    (let* ((step (lattice-step lattice))
           (column (round (- x (lattice-x lattice)) step))
           (row (round (- y (lattice-y lattice)) step))
           (around (if (< step 0.075d0) 3 2)))
      (loop for c from (max 0 (- column around))
              to (min (1- (lattice-columns lattice)) (+ column around))
            append (loop for r from (max 0 (- row around))
                           to (min (1- (lattice-rows lattice)) (+ row around))
                         for number = (place-number lattice c r
                                                    (position (nearest-direction yaw)
                                                              (lattice-directions lattice)))
                         when (and (open-place-p lattice number 0d0)
                                   (straight-way-p (lattice-footing lattice) place
                                                   (numbered-place lattice number)))
                           collect number)))))

(defun way-cost (from to)
  "Return the cost of going straight from the place FROM to TO."
  (+ (sqrt (+ (expt (- (first to) (first from)) 2) (expt (- (second to) (second from)) 2)))
     (* *turn-cost* (abs (short-turn (- (third to) (third from)))))))

(defparameter *greed* 1.5d0
  "How much the estimated cost of the way to come counts: with more than 1 fewer places are looked
at, and the way may cost so much more than the best one.")

(defun goal-estimate (lattice goal)
  "Return a function that returns the estimated cost from the place with a number to GOAL."
  (destructuring-bind (goal-x goal-y goal-yaw) goal
    (declare (double-float goal-x goal-y))
    (let ((turns (map 'doubles
                      (lambda (direction)
                        (* *turn-cost* (abs (short-turn (- (direction-yaw direction) goal-yaw)))))
                      (lattice-directions lattice))))
      (lambda (number)
        (declare (fixnum number) (optimize speed (safety 1))
                 (sb-ext:muffle-conditions sb-ext:compiler-note))
        (multiple-value-bind (column row direction) (number-parts lattice number)
          (declare (fixnum column row))
          (let ((dx (- (+ (lattice-x lattice) (* column (lattice-step lattice))) goal-x))
                (dy (- (+ (lattice-y lattice) (* row (lattice-step lattice))) goal-y)))
            (* (the double-float *greed*)
               (+ (sqrt (the (double-float 0d0) (+ (* dx dx) (* dy dy))))
                  (aref turns direction)))))))))

(defun can-turn-p (lattice column row from to)
  "Return true if the robot can turn at COLUMN and ROW of LATTICE from one direction to another,
both numbers below +YAWS+."
  (let ((footing (lattice-footing lattice))
        (x (+ (lattice-x lattice) (* column (lattice-step lattice))))
        (y (+ (lattice-y lattice) (* row (lattice-step lattice))))
        (step (if (<= (mod (- to from) +yaws+) (/ +yaws+ 2)) 1 -1)))
    (or (> (turning-room footing x y) *path-margin*)
        (loop for direction = (mod (+ from step) +yaws+) then (mod (+ direction step) +yaws+)
              always (> (clearance-at footing x y (direction-yaw direction)
                                      (parts-at footing direction) *path-margin*)
                        *path-margin*)
              until (= direction to)))))

(defun turn-costs ()
  "Return a vector of the costs of turning by 0, 1, 2, ... directions."
  (map 'doubles (lambda (number) (* *turn-cost* (abs (short-turn (direction-yaw number)))))
       (loop for number below +yaws+ collect number)))

(defun search-lattice (lattice starts goals estimate)
  "Return the number of the last place of the best way from one of STARTS to one of GOALS, both
lists of (number . cost), and its cost, or NIL.  ESTIMATE is a function of a number that returns the
cost to come."
  (declare (function estimate) (optimize speed (safety 1))
           (sb-ext:muffle-conditions sb-ext:compiler-note))
  (let ((queue (make-queue))
        (costs (lattice-costs lattice)) (parents (lattice-parents lattice))
        (clearances (lattice-clearances lattice)) (closed (lattice-closed lattice))
        (columns (lattice-columns lattice)) (rows (lattice-rows lattice))
        (unit (lattice-step lattice))
        (turns (turn-costs))
        (goal-costs (make-hash-table)))
    (declare (double-float unit) (type doubles turns))
    (loop for (number . cost) in goals do (setf (gethash number goal-costs) cost))
    (flet ((reach (number cost parent)
             (declare (fixnum number parent) (double-float cost))
             (when (< cost (aref costs number))
               (setf (aref costs number) cost
                     (aref parents number) parent)
               (enqueue queue (+ cost (the double-float (funcall estimate number))) number))))
      (declare (inline reach))
      (loop for (number . cost) in starts do (reach number cost -1))
      (loop
        (let ((number (dequeue queue)))
          (declare (type (or null (unsigned-byte 32)) number))
          (unless number (return nil))
          (when (zerop (aref closed number))
            (setf (aref closed number) 1)
            (when (gethash number goal-costs)
              (return number))
            (let ((cost (aref costs number)) (clearance (aref clearances number)))
              (multiple-value-bind (column row direction) (number-parts lattice number)
                (declare (fixnum column row direction))
                (loop for dc of-type fixnum from -1 to 1
                      do (loop for dr of-type fixnum from -1 to 1
                               for c of-type fixnum = (+ column dc)
                               for r of-type fixnum = (+ row dr)
                               do (unless (or (and (zerop dc) (zerop dr))
                                              (< c 0) (< r 0) (>= c columns) (>= r rows))
                                    (let ((next (place-number lattice c r direction))
                                          (length (if (or (zerop dc) (zerop dr))
                                                      unit
                                                      (* unit #.(sqrt 2d0)))))
                                      (when (and (zerop (aref closed next))
                                                 (open-place-p lattice next (- clearance length)))
                                        (reach next (+ cost length) number))))))
                (loop with here of-type fixnum = (svref (lattice-directions lattice) direction)
                      for there of-type fixnum across (lattice-directions lattice)
                      for other of-type fixnum from 0
                      for next = (place-number lattice column row other)
                      for turned = (+ cost (aref turns (mod (- there here) +yaws+)))
                      do (when (and (/= other direction) (zerop (aref closed next))
                                    (< turned (aref costs next))
                                    (open-place-p lattice next 0d0)
                                    (can-turn-p lattice column row here there))
                           (reach next turned number)))))))))))

;;; Paths

(defun corners-of (places)
  "Return PLACES without those that lie on the straight way from the one before to the one after."
  (loop for (place next) on places
        for before = nil then kept
        for kept = (if (and before next (straight-p before place next)) before place)
        when (eq kept place) collect place))

(defun straight-p (a b c)
  "Return true if the place B lies on the straight way from A to C, and the base does not turn."
  (destructuring-bind ((ax ay aw) (bx by bw) (cx cy cw)) (list a b c)
    (and (= aw bw cw)
         (< (abs (- (* (- bx ax) (- cy ay)) (* (- by ay) (- cx ax)))) 1d-9))))

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

(defun lattice-path (footing start goal bounds step directions)
  "Return the path from START to GOAL through the lattice with STEP and DIRECTIONS, or NIL."
  (let* ((lattice (make-lattice footing bounds step directions))
         (starts (places-near lattice start))
         (goals (and starts (places-near lattice goal)))
         (last (and goals
                    (flet ((with-costs (numbers end)
                             (loop for number in numbers
                                   collect (cons number
                                                 (way-cost (numbered-place lattice number)
                                                           end)))))
                      (search-lattice lattice (with-costs starts start) (with-costs goals goal)
                                      (goal-estimate lattice goal))))))
    (and last
         (let ((path (list goal)))
           (loop for number = last then (aref (lattice-parents lattice) number)
                 until (minusp number)
                 do (push (numbered-place lattice number) path))
           (cons start path)))))

(defun plan-path (footing start goal bounds)
  "Return a list of places from START to GOAL on which the robot of FOOTING meets nothing, or NIL if
there is none within BOUNDS (see MAKE-LATTICE).  It is a straight one if that is free.  A coarse
lattice with the directions of START and GOAL only is tried before the whole."
  (setf (footing-ends footing) (list start goal))
  (if (straight-way-p footing start goal)
      (list start goal)
      (let* ((directions (remove-duplicates (list (nearest-direction (third start))
                                                  (nearest-direction (third goal)))))
             (path (or (lattice-path footing start goal bounds 0.1d0 directions)
                       (and (connected-p footing start goal bounds)
                            (lattice-path footing start goal bounds 0.05d0
                                          (loop for direction below +yaws+
                                                collect direction))))))
        (and path (shortened-path footing (corners-of path))))))
