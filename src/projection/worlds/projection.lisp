;;;; A projection: a scene built as a Bullet world, ready to have plans performed in it.
;;;;
;;;; MAKE-PROJECTION builds a world anew for every sample, so that the same sample gives the same
;;;; bits.  A projection is an executive: performing a designator calls EXECUTE-DESIGNATOR, which
;;;; the process modules of navigation.lisp, head.lisp, perception.lisp and manipulation.lisp
;;;; implement.  What the abstraction wants to know of the outcome it asks through OBSERVED-POSE and
;;;; HELD-ITEM.

(in-package #:discrepancy-finder.projection)

(defconstant +time-step+ 1/240
  "The length of a simulation step, in s.")

(defclass projection ()
  ((scene :initarg :scene :reader projection-scene :type scene
          :documentation "The SCENE that it was made of.")
   (world :initarg :world :reader projection-world :documentation "The Bullet world.")
   (robot :initarg :robot :reader projection-robot)
   (fixtures :initarg :fixtures :reader projection-fixtures)
   (items :initarg :items :reader projection-items
          :documentation "List of (name . body).")
   (grasp :initform nil :accessor projection-grasp
          :documentation "What the gripper holds: (item-name . attachment), or NIL."))
  (:documentation "A scene as a physical world, in which plans are performed."))

(defmethod print-object ((projection projection) stream)
  (print-unreadable-object (projection stream :type t :identity t)
    (format stream "of ~(~a~) at ~,2f s~@[, holding ~(~a~)~]"
            (scene-name (projection-scene projection)) (simulated-seconds projection)
            (held-item projection))))

(defun part-pose (part poses)
  (getf poses (scene-part-name part) (scene-part-pose part)))

(defun add-model (part poses world kind)
  "Add the links of PART, a fixture or an item, to WORLD and return their bodies."
  (add-links (make-instance 'robot :part part :base-pose (part-pose part poses)) world kind))

(defun build-world (scene poses world)
  "Add all parts of SCENE to WORLD and return the projection."
  (let* ((part (scene-robot scene))
         (robot (and part (make-instance 'robot :part part :base-pose (part-pose part poses)))))
    (bullet:add-body world "ground" '(:plane 0d0 0d0 1d0 0d0) (identity-pose) :kind :static)
    (let ((fixtures (loop for part in (parts-of-kind scene :fixture)
                          append (add-model part poses world :static))))
      (when robot (add-links robot world :kinematic))
      (make-instance 'projection
                     :scene scene :world world :robot robot :fixtures fixtures
                     :items (loop for part in (parts-of-kind scene :item)
                                  collect (cons (scene-part-name part)
                                                (first (add-model part poses world
                                                                  :dynamic))))))))

(defun make-projection (scene &key poses)
  "Return a new PROJECTION of SCENE.  POSES is a property list of poses that replace the scene's
own, by the name (a keyword) of the robot or item.  Signals BULLET-ERROR for impossible numbers."
  (let ((world (bullet:make-world :time-step +time-step+))
        (projection nil))
    (unwind-protect (setf projection (build-world scene poses world))
      (unless projection (bullet:close-world world)))))

(defun close-projection (projection)
  "Free the world of PROJECTION."
  (bullet:close-world (projection-world projection)))

(defmacro with-projection ((projection scene &rest options) &body body)
  "Evaluate BODY with PROJECTION bound to a new projection of SCENE, which is closed afterwards.
OPTIONS are those of MAKE-PROJECTION."
  `(let ((,projection (make-projection ,scene ,@options)))
     (unwind-protect (progn ,@body)
       (close-projection ,projection))))

;;; What can be seen of the outcome

(defun observed-pose (projection name)
  "Return the pose of the robot's base or of the item NAME, a symbol, in PROJECTION.  Signals
UNKNOWN-BODY."
  (let ((name (source:name-keyword name))
        (scene (projection-scene projection)))
    (cond ((eq name (scene-robot-name scene)) (base-pose (projection-robot projection)))
          ((assoc name (projection-items projection))
           (bullet:body-pose (cdr (assoc name (projection-items projection)))))
          (t (error 'unknown-body :name name :scene (scene-name scene))))))

(defun designated-items (projection designator)
  "Return the names of the items that fit the :type and the :name of the object designator
DESIGNATOR, in the order of the scene; none if it has neither."
  (let ((type (plan:desig-prop-value designator :type))
        (name (plan:desig-prop-value designator :name)))
    (and (or type name)
         (loop for (item) in (projection-items projection)
               when (and (or (null name) (eq name item))
                         (or (null type)
                             (eq type (scene-item-type (projection-scene projection) item))))
                 collect item))))

(defun held-item (projection)
  "Return the name (a keyword) of the item that the robot holds in PROJECTION, or NIL."
  (car (projection-grasp projection)))

(defun simulated-seconds (projection)
  "Return the time (s) that has passed in PROJECTION."
  (bullet:world-time (projection-world projection)))

(defun state-hash (projection)
  "Return a 64-bit number that depends on every bit of the state of PROJECTION's bodies."
  (bullet:state-hash (projection-world projection)))

(defun fixture-contact (projection)
  "Return the depth (m) by which the robot's links penetrate the fixtures of PROJECTION at the worst
place, 0 if nowhere, and the names of link and fixture."
  (let ((worst 0d0) (names '()))
    (when (projection-robot projection)
      (dolist (fixture (projection-fixtures projection))
        (dolist (link (link-bodies (projection-robot projection)))
          (let ((depth (bullet:penetration link fixture)))
            (when (> depth worst)
              (setf worst depth
                    names (list (bullet:body-name link) (bullet:body-name fixture))))))))
    (values worst names)))

(defun interpenetration (projection)
  "Return the depth (m) by which bodies of PROJECTION penetrate each other at the worst place, and
the names of the two bodies.  The robot's links and the fixtures count, too."
  (multiple-value-bind (depth one other) (bullet:deepest-penetration (projection-world projection))
    (multiple-value-bind (fixture-depth names) (fixture-contact projection)
      (if (> fixture-depth depth)
          (values fixture-depth names)
          (values depth (and one (list (bullet:body-name one) (bullet:body-name other))))))))

;;; Time

(defun settle (projection &key (limit 2))
  "Let PROJECTION run until everything in it rests, for LIMIT seconds at the most.  Return true if
it rests."
  (let ((world (projection-world projection)))
    (foreign:with-c-float-traps
      (loop repeat (ceiling limit +time-step+)
            until (bullet:at-rest-p world)
            do (bullet:step-world world))
      (bullet:at-rest-p world))))

;;; Performing

(defgeneric execute-designator (projection class type designator)
  (:documentation "Execute DESIGNATOR, of CLASS :motion or :action and TYPE (a keyword), in
PROJECTION.  A process module is a set of methods on this function.  Signals a PLAN-FAILURE if the
execution fails, DESIGNATOR-NOT-UNDERSTOOD if it cannot be interpreted.")
  (:method ((projection projection) class type designator)
    (error 'plan:designator-not-understood
           :designator designator :executive "The projection"
           :reason (format nil "no process module is for ~(~a~)s of type ~(~a~)" class type))))

;; The time of a projection is that of its world.

(defmethod plan:executive-clock ((projection projection))
  projection)

(defmethod plan:clock-time ((projection projection))
  (float (simulated-seconds projection) 1d0))

(defmethod plan:let-time-pass ((projection projection) seconds)
  (foreign:with-c-float-traps
    (loop repeat (ceiling seconds +time-step+)
          do (step-projection projection))))

(defun executes-p (projection designator)
  "Return true if PROJECTION has a process module for DESIGNATOR."
  (let ((default (find-method #'execute-designator '() (list (find-class 'projection) t t t))))
    (not (eq default
             (first (compute-applicable-methods
                     #'execute-designator
                     (list projection (plan:designator-class-keyword designator)
                           (plan:desig-prop-value designator :type) designator)))))))

(defmethod plan:perform-with ((projection projection) designator position)
  (declare (ignore position))
  (if (and (not (executes-p projection designator)) (plan:plan-known-p designator))
      (call-next-method)
      (plan:call-on-main
       (lambda ()
         ;; The float traps of C are set once an execution; the plan itself has those of Lisp.
         (foreign:with-c-float-traps
           (execute-designator projection (plan:designator-class-keyword designator)
                               (plan:desig-prop-value designator :type) designator))))))

(defun misunderstood (designator reason)
  "Signal that DESIGNATOR is not understood for REASON, a format control without arguments."
  (error 'plan:designator-not-understood :designator designator :executive "The projection"
                                         :reason (format nil reason)))
