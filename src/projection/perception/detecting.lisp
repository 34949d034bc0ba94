;;;; The perception process module: motions of type detecting.
;;;;
;;;; An item is seen as far as rays from the camera to points on its surface get there: the point is
;;;; within the field of view and the range, and the first thing that the ray meets is the item.
;;;; The far side of an item counts as seen where its near side is.  The robot's own links hide
;;;; nothing.  What is detected is where it is: there is no noise.

(in-package #:discrepancy-finder.projection)

(defparameter *points-on-a-surface* 240
  "An item is looked at in about so many points.")

(defun view-test (scene)
  "Return a function that returns true if a point, a pose in the frame of the camera, is within its
field of view and range by the parameters of SCENE."
  (let ((range (scene-parameter scene :camera-range))
        (across (/ (scene-parameter scene :camera-field-of-view) 2))
        (upwards (/ (scene-parameter scene :camera-vertical-field-of-view) 2)))
    (lambda (point)
      (let ((x (pose-x point)) (y (pose-y point)) (z (pose-z point)))
        (and (> x 1d-6)
             (<= (sqrt (+ (* x x) (* y y) (* z z))) range)
             (<= (abs (atan y x)) across)
             (<= (abs (atan z x)) upwards))))))

(defun rays-to (points camera)
  "Return the rays from the position of CAMERA to those of POINTS, for BULLET:CAST-RAYS."
  (coerce (loop for point in points
                append (list (pose-x camera) (pose-y camera) (pose-z camera)
                             (pose-x point) (pose-y point) (pose-z point)))
          '(simple-array double-float (*))))

(defun visible-part (projection name)
  "Return which part, 0 to 1, of the surface of the item NAME, a symbol, the camera of PROJECTION's
robot sees.  Signals UNKNOWN-BODY, and MISSING-ROBOT-PART if there is no camera."
  (check-robot-part projection :camera :camera)
  (let* ((scene (projection-scene projection))
         (robot (projection-robot projection))
         (body (or (cdr (assoc (source:name-keyword name) (projection-items projection)))
                   (error 'unknown-body :name name :scene (scene-name scene))))
         (camera (camera-pose robot))
         (outside (inverse camera))
         (pose (bullet:body-pose body))
         (points (loop for point in (surface-points (bullet:body-shape body)
                                                    *points-on-a-surface*)
                       collect (compose pose point)))
         (in-view (remove-if-not (view-test scene) points
                                 :key (lambda (point) (compose outside point))))
         (met (bullet:cast-rays (projection-world projection) (rays-to in-view camera)
                                :passed (link-bodies robot))))
    ;; A ray may end a last bit before the surface and meet nothing.
    (/ (count-if (lambda (other) (or (null other) (eq other body))) met)
       (float (length points) 1d0))))

(defun detected-object (projection designator name)
  "Return a new object designator: the description of DESIGNATOR, by which the item NAME was sought,
with the item's type, name and pose."
  (plan:make-designator
   :object
   `((:type ,(scene-item-type (projection-scene projection) name))
     (:name ,name)
     ,@(remove-if (lambda (property) (member (first property) '(:type :name :pose)))
                  (plan:properties designator))
     (:pose ,(observed-pose projection name)))))

(defun fail-to-detect (projection designator seen)
  "Signal PERCEPTION-OBJECT-NOT-FOUND for the object DESIGNATOR; SEEN is a list of (item . part)."
  (plan:fail 'plan:perception-object-not-found
             :object designator
             :description
             (format nil "~a is not seen: ~:[there is no such item~;~:*~{~a~^, ~}, where ~,1f % ~
                          are needed~]"
                     designator
                     (loop for (name . part) in seen
                           collect (format nil "~,1f % of ~(~a~)" (* 100 part) name))
                     (* 100 (scene-parameter (projection-scene projection) :visible-fraction)))))

(defmethod execute-designator ((projection projection) (class (eql :motion))
                               (type (eql :detecting)) designator)
  (check-robot-part projection :camera :camera)
  (let ((object (plan:desig-prop-value designator :object))
        (enough (scene-parameter (projection-scene projection) :visible-fraction))
        (seen '()))
    (unless (and (typep object 'plan:object-designator)
                 (or (plan:desig-prop-value object :type) (plan:desig-prop-value object :name)))
      (misunderstood designator "a motion of type detecting needs an object with a type or a name"))
    (dolist (name (designated-items projection object)
                  (fail-to-detect projection object (nreverse seen)))
      (let ((part (visible-part projection name)))
        (when (>= part enough)
          (return (detected-object projection object name)))
        (push (cons name part) seen)))))
