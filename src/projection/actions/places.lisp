;;;; The poses of (a location (on part)) and (a location (in part)).
;;;;
;;;; Rays from above find the points of a part on which something can lie: of what is ON it the
;;;; highest, of what is IN it, a drawer, the lowest.  Where an item is to be put there, one that is
;;;; named by :for or else the one that the robot holds, the poses are those of the item standing as
;;;; in the scene, free of other items and near the robot first.  Without one they are the points
;;;; themselves, spread over the part: places to look at.

(in-package #:discrepancy-finder.projection)

(defparameter *point-spacing* 0.1d0
  "The distance (m) of the points of a part at which something can lie.")

(defparameter *item-gap* 0.03d0
  "How far (m) an item is put from others and from an edge, at the least.")

(defparameter *setting-gap* 6d-3
  "How far (m) above where it is going to stand an item is let go: where it was seen is not exactly
where it is in the hand.")

(defparameter *places-to-look-at* 10
  "So many places of a part are looked at.")

(defun shape-bounds (shape pose)
  "Return the least x, y, z and the greatest x, y, z (m) of SHAPE at POSE: two lists."
  (flet ((reaches (sign)
           (loop for axis in '((1 0 0) (0 1 0) (0 0 1))
                 collect (* sign (placed-support shape pose
                                                 (mapcar (lambda (number) (* sign number))
                                                         axis))))))
    (values (reaches -1) (reaches 1))))

(defun body-bounds (body)
  "Return the least and the greatest coordinates (m) of BODY in the world: two lists."
  (shape-bounds (bullet:body-shape body) (bullet:body-pose body)))

(defun steps-between (low high)
  "Return numbers from LOW to HIGH, evenly spaced, the middle included."
  (let* ((half (/ (- high low) 2))
         (steps (max 0 (floor half *point-spacing*))))
    (loop for step from (- steps) to steps
          collect (+ low half (if (zerop steps) 0 (* step (/ half steps)))))))

(defun part-points (projection body extreme)
  "Return upright poses at the points of the part BODY on which something can lie: those as high as
the extreme one, by the function EXTREME, which is MAX or MIN."
  (destructuring-bind ((left near bottom) (right far top)) (multiple-value-list (body-bounds body))
    (let* ((world (projection-world projection))
           (margin *item-gap*)
           (rays (coerce (loop for x in (steps-between (+ left margin) (- right margin))
                               append (loop for y in (steps-between (+ near margin) (- far margin))
                                            append (list x y (+ top 0.01d0)
                                                         x y (- bottom 0.01d0))))
                         'numbers))
           (points (multiple-value-bind (bodies hits)
                       (bullet:cast-rays world rays
                                         :passed (remove body (bullet:world-bodies world)))
                     (loop for met across bodies
                           for hit from 0 by 7
                           when (and met (> (aref hits (+ hit 5)) 0.99d0))
                             collect (point-pose (aref hits hit) (aref hits (+ hit 1))
                                                 (aref hits (+ hit 2)))))))
      (when points
        (let ((level (reduce extreme points :key #'pose-z)))
          (remove-if (lambda (point) (> (abs (- (pose-z point) level)) 0.01d0)) points))))))

;;; Places to look at

(defun spread-out (points)
  "Return at most *PLACES-TO-LOOK-AT* of POINTS: the one in the middle, then each time the one that
is farthest from those before."
  (let* ((count (length points))
         (middle (point-pose (/ (reduce #'+ points :key #'pose-x) count)
                             (/ (reduce #'+ points :key #'pose-y) count)
                             0))
         (chosen '()))
    (flet ((best (key)
             (reduce (lambda (one other) (if (> (funcall key other) (funcall key one)) other one))
                     points)))
      (push (best (lambda (point) (- (planar-distance middle point)))) chosen)
      (loop repeat (1- (min count *places-to-look-at*))
            do (push (best (lambda (point)
                             (reduce #'min (mapcar (lambda (other) (planar-distance point other))
                                                   chosen))))
                     chosen)))
    (nreverse chosen)))

;;; Places for items

(defun item-meant (projection thing)
  "Return the name of the item that the object designator or the name THING means, or NIL."
  (cond ((typep thing 'plan:object-designator) (first (designated-items projection thing)))
        ((and thing (symbolp thing) (find-item projection thing)) (source:name-keyword thing))))

(defun pose-standing-on (projection name point)
  "Return the pose at which the item NAME stands on POINT, turned to the robot as it is now."
  (let* ((base (base-pose (projection-robot projection)))
         (upright (scene-body-pose (projection-scene projection) name))
         (heading (atan (- (pose-y point) (pose-y base)) (- (pose-x point) (pose-x base))))
         (yaw (- (pose-yaw (observed-pose projection name)) (pose-yaw base)))
         (turned (compose (make-pose 0 0 0 :yaw (- (+ heading yaw) (pose-yaw upright)))
                          (quaternion-pose 0d0 0d0 0d0 (pose-qx upright) (pose-qy upright)
                                           (pose-qz upright) (pose-qw upright))))
         (height (placed-support (bullet:body-shape (item-body projection name)) turned
                                 '(0 0 -1))))
    (quaternion-pose (pose-x point) (pose-y point) (+ (pose-z point) height *setting-gap*)
                     (pose-qx turned) (pose-qy turned) (pose-qz turned) (pose-qw turned))))

(defun beside-p (low high other-low other-high gap)
  "Return true if two boxes, given by their least and greatest coordinates, are GAP (m) apart."
  (some (lambda (low high other-low other-high)
          (or (> (- low gap) other-high) (< (+ high gap) other-low)))
        low high other-low other-high))

(defun free-place-p (projection name pose part)
  "Return true if the item NAME at POSE is beside all other items and within the edges of PART."
  (multiple-value-bind (low high)
      (shape-bounds (bullet:body-shape (item-body projection name)) pose)
    (multiple-value-bind (part-low part-high) (body-bounds part)
      (and (every (lambda (low high part-low part-high)
                    (and (>= low (+ part-low *item-gap*)) (<= high (- part-high *item-gap*))))
                  (subseq low 0 2) (subseq high 0 2) part-low part-high)
           (loop for (other . body) in (projection-items projection)
                 always (or (eq other name)
                            (multiple-value-bind (other-low other-high) (body-bounds body)
                              (beside-p low high other-low other-high *item-gap*))))))))

(defun places-for (projection name part points)
  "Return the lazy list of the poses of the item NAME on POINTS of PART that are free, the nearest
first."
  (let ((base (base-pose (projection-robot projection))))
    (prolog:lazy-filter (lambda (pose) (free-place-p projection name pose part))
                        (prolog:lazy-mapcar
                         (lambda (point) (pose-standing-on projection name point))
                         (stable-sort (copy-list points) #'<
                                      :key (lambda (point) (planar-distance base point)))))))

(defun part-poses (projection location)
  "Return the lazy list of the poses that the location designator LOCATION means by :on or :in."
  (let* ((part (location-part projection location))
         (points (and part (part-points projection part
                                        (if (plan:desig-prop-value location :in) #'min #'max))))
         (item (or (item-meant projection (plan:desig-prop-value location :for))
                   (held-item projection))))
    (cond ((null points) '())
          (item (places-for projection item part points))
          (t (spread-out points)))))
