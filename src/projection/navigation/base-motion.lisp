;;;; Base motion: a path of the base as a motion in time.
;;;;
;;;; A path is a list of places; from one to the next the base moves and turns at once.  The length of
;;;; a way is that in m or the turn, taken as the length that is driven in the same time, whichever is
;;;; more.  At a corner the base cuts across, no farther than BLEND and only where that is free, and
;;;; drives so slowly that its acceleration stays within bounds; else it stops there.
;;;; PATH-BASES is the entry point.

(in-package #:discrepancy-finder.projection)

(defparameter *blend* 0.15d0
  "The largest distance (m) from a corner of a path at which the base leaves the straight way.")

(defconstant +blend-parts+ 12
  "A corner that is cut is driven in so many straight parts.")

(defstruct (gait (:constructor make-gait (speed acceleration deceleration turn-weight))
                 (:copier nil))
  "How fast the base may be: SPEED (m/s), ACCELERATION and DECELERATION (m/s^2); a turn by a radian
counts as a way of TURN-WEIGHT (m)."
  (speed 1d0 :type double-float :read-only t)
  (acceleration 1d0 :type double-float :read-only t)
  (deceleration 1d0 :type double-float :read-only t)
  (turn-weight 1d0 :type double-float :read-only t))

(defun way-length (gait from to)
  "Return the length (m) of the way from the place FROM to TO; their yaws are not taken modulo a
turn."
  (max (sqrt (+ (expt (- (first to) (first from)) 2) (expt (- (second to) (second from)) 2)))
       (* (gait-turn-weight gait) (abs (- (third to) (third from))))))

(defun unwound (path)
  "Return PATH with yaws that differ by less than half a turn from each place to the next."
  (loop with yaw = (third (first path))
        for (x y next) in path
        do (incf yaw (short-turn (- next yaw)))
        collect (list x y yaw)))

(defun between (from to fraction)
  "Return the place at FRACTION of the way between two places."
  (mapcar (lambda (a b) (interpolate a b fraction)) from to))

;;; Corners

(defun blended-corner (gait from corner to)
  "Return a list of places that lead around CORNER on the way from FROM to TO."
  (flet ((near (end)
           (let ((length (way-length gait corner end)))
             (between corner end (/ (min *blend* (/ length 2)) (max length 1d-9))))))
    (let ((enter (near from)) (leave (near to)))
      (loop for i from 0 to +blend-parts+
            for fraction = (/ i (float +blend-parts+ 1d0))
            collect (between (between enter corner fraction) (between corner leave fraction)
                             fraction)))))

(defun way-direction (gait from to)
  "Return the vector, a list, from FROM to TO, with the turn as a length, by its own length; and that
length (m)."
  (let* ((vector (list (- (first to) (first from)) (- (second to) (second from))
                       (* (gait-turn-weight gait) (- (third to) (third from)))))
         (length (sqrt (reduce #'+ vector :key (lambda (part) (* part part))))))
    (values (if (zerop length) vector (mapcar (lambda (part) (/ part length)) vector)) length)))

(defun corner-speed (gait from corner to)
  "Return the speed (m/s) at which the base may pass CORNER, where it changes its direction a bit."
  (multiple-value-bind (before before-length) (way-direction gait from corner)
    (multiple-value-bind (after after-length) (way-direction gait corner to)
      (let ((change (sqrt (reduce #'+ (mapcar (lambda (a b) (expt (- a b) 2)) before after))))
            (length (/ (+ before-length after-length) 2)))
        (if (< change 1d-9)
            (gait-speed gait)
            (min (gait-speed gait)
                 (sqrt (/ (* length (min (gait-acceleration gait) (gait-deceleration gait)))
                          change))))))))

(defun smooth-path (gait path free-p)
  "Return the list of (place . speed) that leads along PATH: the speed (m/s) is that at which the
base may be at most there.  FREE-P is a function that tells whether the base can be at a place."
  (let ((result (list (cons (first path) 0d0))))
    (loop for (from corner to) on path
          while to
          do (let ((blend (blended-corner gait from corner to)))
               (if (every free-p blend)
                   (loop for (before place after) on (cons (car (first result)) blend)
                         while place
                         do (push (cons place
                                        (if after
                                            (corner-speed gait before place after)
                                            (gait-speed gait)))
                                  result))
                   (push (cons corner 0d0) result))))
    (push (cons (first (last path)) 0d0) result)
    (nreverse result)))

;;; Time

(defstruct (leg (:constructor make-leg (from to length entry peak rise cruise fall)) (:copier nil))
  "A straight part of a path: the base has the speed ENTRY at first, reaches PEAK after RISE (s),
keeps it for CRUISE and slows down for FALL."
  (from nil :type list :read-only t)
  (to nil :type list :read-only t)
  (length 0d0 :type double-float :read-only t)
  (entry 0d0 :type double-float :read-only t)
  (peak 0d0 :type double-float :read-only t)
  (rise 0d0 :type double-float :read-only t)
  (cruise 0d0 :type double-float :read-only t)
  (fall 0d0 :type double-float :read-only t))

(defun leg-duration (leg)
  (+ (leg-rise leg) (leg-cruise leg) (leg-fall leg)))

(defun leg-fraction (leg time deceleration acceleration)
  "Return the part of LEG that is done at TIME after its beginning."
  (let ((rise (leg-rise leg)) (left (- (leg-duration leg) time)))
    (cond ((or (<= left 0) (zerop (leg-length leg))) 1d0)
          ((< time rise)
           (/ (* time (+ (leg-entry leg) (* 0.5d0 acceleration time))) (leg-length leg)))
          ((< left (leg-fall leg))
           (let ((exit (- (leg-peak leg) (* deceleration (leg-fall leg)))))
             (- 1 (/ (* left (+ exit (* 0.5d0 deceleration left))) (leg-length leg)))))
          (t (/ (+ (* rise (/ (+ (leg-entry leg) (leg-peak leg)) 2))
                   (* (leg-peak leg) (- time rise)))
                (leg-length leg))))))

(defun path-legs (gait places)
  "Return the list of the legs along PLACES, a list of (place . largest speed)."
  (let* ((a (gait-acceleration gait)) (d (gait-deceleration gait))
         (count (length places))
         (places (coerce places 'simple-vector))
         (lengths (make-array count :initial-element 0d0))
         (speeds (map 'simple-vector #'cdr places)))
    (loop for i from 1 below count
          do (setf (svref lengths i)
                   (way-length gait (car (svref places (1- i))) (car (svref places i)))))
    (loop for i from 1 below count
          do (setf (svref speeds i)
                   (min (svref speeds i)
                        (sqrt (+ (expt (svref speeds (1- i)) 2) (* 2 a (svref lengths i)))))))
    (loop for i from (- count 2) downto 0
          do (setf (svref speeds i)
                   (min (svref speeds i)
                        (sqrt (+ (expt (svref speeds (1+ i)) 2)
                                 (* 2 d (svref lengths (1+ i))))))))
    (loop for i from 1 below count
          for length = (svref lengths i)
          for entry = (svref speeds (1- i)) for exit = (svref speeds i)
          for peak = (max entry exit
                          (min (gait-speed gait)
                               (sqrt (/ (+ (* 2 a d length) (* d entry entry) (* a exit exit))
                                        (+ a d)))))
          for rise = (/ (- peak entry) a) for fall = (/ (- peak exit) d)
          collect (make-leg (car (svref places (1- i))) (car (svref places i)) length entry peak
                            rise
                            (if (zerop peak)
                                0d0
                                (max 0d0 (/ (- length (* rise (/ (+ entry peak) 2))
                                               (* fall (/ (+ peak exit) 2)))
                                            peak)))
                            fall))))

(defun call-with-places (function gait places)
  "Call FUNCTION with the number of steps of the motion along PLACES, a list of (place . largest
speed), and with a function that returns the place after the next step each time it is called."
  (let* ((legs (path-legs gait places))
         (duration (reduce #'+ legs :key #'leg-duration))
         (steps (max 1 (ceiling (- (/ duration +time-step+) 1d-9))))
         (begin 0d0) (step 0))
    (funcall function steps
             (lambda ()
               (incf step)
               (let ((time (* step (float +time-step+ 1d0))))
                 (loop while (and (rest legs)
                                  (>= time (+ begin (leg-duration (first legs)))))
                       do (incf begin (leg-duration (pop legs))))
                 (between (leg-from (first legs)) (leg-to (first legs))
                          (leg-fraction (first legs) (- time begin) (gait-deceleration gait)
                                        (gait-acceleration gait))))))))

(defun path-bases (gait path terrain height free-p last)
  "Return the vector of the poses of the base, seven numbers each, after each step of the motion along
PATH, a list of places, at HEIGHT (m) above the ground of TERRAIN; the last pose is LAST.  FREE-P is
a function that tells whether the base can be at a place."
  (call-with-places
   (lambda (steps next)
     (let ((bases (make-array (* 7 steps) :element-type 'double-float)))
       (dotimes (step steps bases)
         (let ((pose (destructuring-bind (x y yaw) (funcall next)
                       (if (= step (1- steps))
                           last
                           (standing-pose terrain x y height yaw)))))
           (loop for number in (pose-components pose)
                 for i from (* 7 step)
                 do (setf (aref bases i) number))))))
   gait (smooth-path gait (unwound path) free-p)))
