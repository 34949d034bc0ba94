;;;; A projection: a scene built as a Bullet world, ready to have plans performed in it.
;;;;
;;;; MAKE-PROJECTION builds a world anew for every sample, so that the same sample gives the same
;;;; bits.  WITH-PROJECTION does that, runs plans in it and closes it.  What the abstraction wants
;;;; to know of the outcome it asks through the functions of observations.lisp; how designators come
;;;; to the process modules is in performing.lisp.

(in-package #:discrepancy-finder.projection)

(defconstant +time-step+ 1/240
  "The length of a simulation step, in s.")

(defclass projection ()
  ((scene :initarg :scene :reader projection-scene :type scene
          :documentation "The SCENE that it was made of, with the parameters that were drawn.")
   (world :initarg :world :reader projection-world :documentation "The Bullet world.")
   (robot :initarg :robot :reader projection-robot
          :documentation "The ROBOT, or NIL.")
   (solids :initarg :solids :reader projection-solids
           :documentation "The list of the SOLIDs that the fixtures are, drawers included.")
   (items :initarg :items :reader projection-items
          :documentation "List of (name . body).")
   (joints :initarg :joints :initform '() :reader projection-joints
           :documentation "List of (fixture name . joint): the movable joints of the fixtures.")
   (grasps :initform '() :accessor projection-grasps
           :documentation "What the arms hold: a list of (arm item . attachment), oldest first.")
   (fidelity :initarg :fidelity :initform :fast :reader projection-fidelity
             :documentation "How motions are stepped: :FAST or :FULL.")
   (memory :initform '() :accessor projection-memory
           :documentation "A property list of what process modules keep in mind.")
   (trail :initform '() :accessor projection-trail
          :documentation "Places where the base has been, newest first, if that is recorded.")
   (observer :initform nil :accessor projection-observer
             :documentation "A function that is called after each performed designator, or NIL."))
  (:documentation "A scene as a physical world, in which plans are performed."))

(defmethod print-object ((projection projection) stream)
  (print-unreadable-object (projection stream :type t :identity t)
    (format stream "of ~(~a~) at ~,2f s~@[, holding~{ ~(~a~)~}~]"
            (scene-name (projection-scene projection)) (simulated-seconds projection)
            (mapcar #'cdr (held-items projection)))))

(defun make-projection (scene &key poses joints parameters (fidelity :fast))
  "Return a new PROJECTION of SCENE.
  POSES       property list of poses that replace the scene's own, by the name (a keyword) of the
              robot or item
  JOINTS      association list of the initial positions (m or rad) of joints of fixtures and of the
              robot, by their names, strings; the limits bound them
  PARAMETERS  property list of values of parameters and tolerances that replace the scene's
  FIDELITY    :FULL steps all of every motion, :FAST what something can depend on
Signals BULLET-ERROR for impossible numbers, UNKNOWN-BODY, UNKNOWN-JOINT, UNKNOWN-PARAMETER and
IMPOSSIBLE-PARAMETER."
  (check-type fidelity (member :fast :full))
  (let ((scene (if parameters (scene-with-parameters scene parameters) scene))
        (world (bullet:make-world :time-step +time-step+))
        (projection nil))
    (unwind-protect (setf projection (build-world scene world fidelity poses joints))
      (unless projection (bullet:close-world world)))))

(defun projection-fixtures (projection)
  "Return the list of the bodies of PROJECTION's fixtures, drawers included."
  (mapcar #'solid-body (projection-solids projection)))

(defun close-projection (projection)
  "Free the world of PROJECTION."
  (bullet:close-world (projection-world projection)))

(defun call-with-projection (function scene options)
  "Call FUNCTION with a new projection of SCENE, a scene or the name of its file, made with OPTIONS,
as the executive of an implicit top-level; close it afterwards."
  (let ((projection (apply #'make-projection
                           (if (typep scene 'scene) scene (load-scene scene))
                           options)))
    (unwind-protect
         (plan:with-executive (projection)
           (plan:call-in-implicit-top-level (lambda () (funcall function projection))))
      (close-projection projection))))

(defmacro with-projection ((projection scene &rest options) &body body)
  "Evaluate BODY with PROJECTION bound to a new projection of SCENE, a scene or the name of a
scene's file, and return its values; the projection is closed afterwards.  What BODY performs is
performed in it, and BODY may call plans: it is in a top-level, unless it makes one.  OPTIONS are
those of MAKE-PROJECTION."
  `(call-with-projection (lambda (,projection) (declare (ignorable ,projection)) ,@body)
                         ,scene (list ,@options)))
