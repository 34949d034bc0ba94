;;;; Frames: what a pose in a frame means in the world, and the way to the geometry layer.
;;;;
;;;; The world is the frame *FIXED-FRAME*.  Where other frames are, *TRANSFORMER* knows: an object
;;;; with a method of FRAME-POSE, so that a projection answers for its robot; a FRAME-STORE knows
;;;; the frames that it was made with.  There is only the present: stamps do not matter, and nothing
;;;; waits.  LOOKUP-FRAME asks; GEOMETRY-POSE turns every kind of pose into one of the world.

(in-package #:discrepancy-finder.transforms)

;;; CRAM leaves these unset until a robot is loaded; plans may use them at once here.

(defparameter *fixed-frame* "map"
  "The name of the frame in which poses are those of the world.")
(defparameter *odom-frame* "odom_combined"
  "The name of the odometry frame; that of a PR2 unless it is set.")
(defparameter *robot-base-frame* "base_footprint"
  "The name of the frame of the robot's base; that of a PR2 unless it is set.")
(defparameter *robot-torso-frame* "torso_lift_link"
  "The name of the frame of the robot's torso; that of a PR2 unless it is set.")
(defparameter *robot-left-tool-frame* "l_gripper_tool_frame"
  "The name of the frame of the tool in the robot's left hand; that of a PR2 unless it is set.")
(defparameter *robot-right-tool-frame* "r_gripper_tool_frame"
  "The name of the frame of the tool in the robot's right hand; that of a PR2 unless it is set.")
(defparameter *tf-default-timeout* 4d0
  "For plans that pass it as a :TIMEOUT (s).  It has no effect: frames are known or they are not.")

(defgeneric geometry-pose (thing)
  (:documentation "Return THING as a pose of the geometry layer in the world.  THING is such a pose
already, or a pose or a transform of this layer: a plain one is taken as given in the world, a
stamped one by the frame that it names.  Signals UNKNOWN-FRAME, ZERO-LENGTH if the orientation is
zero, and UNSUITABLE-VALUE if THING is something else.")
  (:method (thing)
    (unsuitable thing "what means a pose" "a pose or a transform")))

(defgeneric frame-pose (transformer name)
  (:documentation "Return what GEOMETRY-POSE takes for the pose in the world of the frame that is
named NAME, a string without a leading slash, or NIL if TRANSFORMER does not know it.  Not asked
about the fixed frame.  LOOKUP-FRAME calls it; who knows frames gives it a method.")
  (:method (transformer name)
    (declare (ignore transformer name))
    nil))

(defgeneric frame-names (transformer)
  (:documentation "Return the names of the frames that TRANSFORMER knows, a list of strings.")
  (:method (transformer)
    (declare (ignore transformer))
    '()))

(defclass frame-store ()
  ((frames :initarg :frames :reader frame-store-frames
           :documentation "A list of (name . pose), the poses those of the geometry layer."))
  (:documentation "Names of frames and their poses in the world; MAKE-FRAME-STORE makes one."))

(defmethod print-object ((store frame-store) stream)
  (print-unreadable-object (store stream)
    (format stream "FRAME-STORE~{ ~s~}" (frame-names store))))

(defmethod frame-pose ((store frame-store) name)
  (cdr (assoc name (frame-store-frames store) :test #'string=)))

(defmethod frame-names ((store frame-store))
  (mapcar #'car (frame-store-frames store)))

(defun bare-frame-name (name)
  "Return the string NAME without the leading slash of the old convention of ROS."
  (string-left-trim "/" (ensure-kind name 'string "the name of a frame")))

(defun make-frame-store (&rest names-and-poses)
  "Return a FRAME-STORE of the frames NAMES-AND-POSES, name pose name pose and so on; the poses are
what GEOMETRY-POSE takes."
  (make-instance 'frame-store
                 :frames (loop for (name pose) on names-and-poses by #'cddr
                               collect (cons (bare-frame-name name) (geometry-pose pose)))))

(defvar *transformer* (make-frame-store)
  "What knows where frames are: an object with a method of FRAME-POSE.  Nothing at first.")

(defun lookup-frame (name &optional (transformer *transformer*))
  "Return the pose, of the geometry layer, in the world of the frame named NAME, with or without a
leading slash; *FIXED-FRAME* is the world.  Signals UNKNOWN-FRAME if TRANSFORMER does not know it."
  (let ((bare (bare-frame-name name))
        (fixed (bare-frame-name *fixed-frame*)))
    (if (string= bare fixed)
        (geometry:identity-pose)
        (let ((pose (frame-pose transformer bare)))
          (if pose
              (geometry-pose pose)
              (error 'unknown-frame
                     :name name
                     :known (sort (list* fixed (copy-list (frame-names transformer)))
                                  #'string<)))))))

;;; The geometry layer

(defun parts-geometry-pose (vector quaternion)
  (let ((unit (normalize-quaternion quaternion)))
    (geometry:quaternion-pose (x vector) (y vector) (z vector)
                              (x unit) (y unit) (z unit) (w unit))))

(defun in-world (frame-id pose)
  (geometry:compose (lookup-frame frame-id) pose))

(defmethod geometry-pose ((thing geometry:pose))
  thing)

(defmethod geometry-pose ((thing pose))
  (parts-geometry-pose (origin thing) (orientation thing)))

(defmethod geometry-pose ((thing transform))
  (parts-geometry-pose (translation thing) (rotation thing)))

(defmethod geometry-pose ((thing pose-stamped))
  (in-world (frame-id thing) (call-next-method)))

(defmethod geometry-pose ((thing transform-stamped))
  (in-world (frame-id thing) (call-next-method)))

(defun pose-from-geometry (pose)
  "Return POSE, a pose of the geometry layer, as a plain POSE of this one, with the same bits."
  (make-pose (make-3d-vector (geometry:pose-x pose) (geometry:pose-y pose) (geometry:pose-z pose))
             (make-quaternion (geometry:pose-qx pose) (geometry:pose-qy pose)
                              (geometry:pose-qz pose) (geometry:pose-qw pose))))

;;; Between frames

(defun lookup-transform (transformer target-frame source-frame &key (time 0d0) timeout)
  "Return the TRANSFORM-STAMPED from coordinates in SOURCE-FRAME to those in TARGET-FRAME that
TRANSFORMER knows, with the stamp TIME (s).  TIMEOUT has no effect.  Signals UNKNOWN-FRAME."
  (declare (ignore timeout))
  (pose->transform-stamped
   target-frame source-frame time
   (pose-from-geometry
    (geometry:compose (geometry:inverse (lookup-frame target-frame transformer))
                      (lookup-frame source-frame transformer)))))

(defun transform-pose-stamped (transformer &key pose target-frame timeout use-current-ros-time)
  "Return the pose-stamped POSE as seen from the frame named TARGET-FRAME, by what TRANSFORMER
knows; the stamp stays.  TIMEOUT and USE-CURRENT-ROS-TIME have no effect.  Signals UNKNOWN-FRAME."
  (declare (ignore timeout use-current-ros-time))
  (if (string= (bare-frame-name target-frame) (bare-frame-name (frame-id pose)))
      (copy-pose-stamped pose :frame-id target-frame)
      (pose->pose-stamped target-frame (stamp pose)
                          (transform (lookup-transform transformer target-frame (frame-id pose))
                                     pose))))

(defun transform-point-stamped (transformer &key point target-frame timeout use-current-ros-time)
  "Return the point-stamped POINT as seen from the frame named TARGET-FRAME, by what TRANSFORMER
knows; the stamp stays.  TIMEOUT and USE-CURRENT-ROS-TIME have no effect.  Signals UNKNOWN-FRAME."
  (declare (ignore timeout use-current-ros-time))
  (if (string= (bare-frame-name target-frame) (bare-frame-name (frame-id point)))
      (copy-point-stamped point :frame-id target-frame)
      (make-point-stamped target-frame (stamp point)
                          (transform-point
                           (lookup-transform transformer target-frame (frame-id point))
                           point))))
