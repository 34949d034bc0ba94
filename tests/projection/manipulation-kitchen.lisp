;;;; Tests of the projection layer: arms, grippers and drawers in the kitchen.

(in-package #:discrepancy-finder.tests)

(def-suite manipulation-kitchen :in all)
(in-suite manipulation-kitchen)

(defvar *manipulation-scene* nil)

(defun manipulation-scene ()
  "Return the kitchen without stopping and perception errors."
  (or *manipulation-scene*
      (setf *manipulation-scene*
            (projection:load-scene
             (asdf:system-relative-pathname "discrepancy-finder" "models/kitchen/scene.lisp")))))

(defun standing-at (x y yaw &rest poses)
  "Return the poses of a projection with the robot at X, Y, turned by YAW; POSES are more of them."
  (list* :robot (geometry:make-pose x y 0 :yaw yaw) poses))

(defun call-in-kitchen (function poses &rest options)
  "Return what FUNCTION returns, called with a projection of the kitchen with POSES, settled."
  (let ((projection (apply #'projection:make-projection (manipulation-scene) :poses poses
                           options)))
    (unwind-protect (progn (perform-in projection (parking))
                           (projection:settle projection)
                           (funcall function projection))
      (projection:close-projection projection))))

(defun parking ()
  (plan:an action (type parking-arms)))

(defun picking-up-item (?name &rest more)
  (plan:make-designator :action
                        `((:type :picking-up)
                          (:object ,(plan:an object (name ?name)))
                          ,@more)))

(defun opening-drawer (?drawer &rest more)
  (plan:make-designator :action `((:type :opening)
                                  (:object ,(plan:an object (type drawer) (name ?drawer)))
                                  ,@more)))

(defun closing-drawer (?drawer &rest more)
  (plan:make-designator :action `((:type :closing)
                                  (:object ,(plan:an object (type drawer) (name ?drawer)))
                                  ,@more)))

(defun items-height (projection name)
  (geometry:pose-z (projection:observed-pose projection name)))

(defun picked-up-and-placed (item poses x y z)
  "Pick up ITEM and place it at X, Y, Z; return true if that is done, how high it was lifted, and how
far (m) it is from there."
  (call-in-kitchen
   (lambda (projection)
     (let ((before (items-height projection item)))
       (perform-in projection (picking-up-item item))
       (let ((held (projection:held-item projection))
             (lifted (- (items-height projection item) before)))
         (perform-in projection (parking))
         (perform-in projection (placing-at x y z))
         (let ((pose (projection:observed-pose projection item)))
           (values (and (eq item held) (null (projection:held-item projection)))
                   lifted
                   (sqrt (+ (expt (- (geometry:pose-x pose) x) 2)
                            (expt (- (geometry:pose-y pose) y) 2)
                            (expt (- (geometry:pose-z pose) z) 2))))))))
   poses))

(test each-item-is-picked-up-from-the-counter-and-placed-there
  (loop for (item y z to) in '((:milk 0.1 0.947 0.3) (:bowl -0.6 0.8835 -0.4)
                               (:cereal -0.2 0.962 -0.4))
        do (multiple-value-bind (done lifted away)
               (picked-up-and-placed item (standing-at -1.3 y pi) -2.1 to z)
             (is-true done "~a" item)
             (is (nearly 0.1 lifted 0.01) "~a is lifted by ~a" item lifted)
             (is (< away 0.02) "~a is ~a m from its target" item away))))

(test each-item-is-picked-up-from-the-table-and-placed-there
  (loop for (item height) in '((:milk 0.847) (:bowl 0.7835) (:cereal 0.862) (:spoon 0.7595))
        do (multiple-value-bind (done lifted away)
               (picked-up-and-placed item
                                     (standing-at -0.35 0 0 item
                                                  (geometry:make-pose 0.35 0.1 height))
                                     0.35 -0.1 height)
             (is-true done "~a" item)
             (is (nearly 0.1 lifted 0.01) "~a is lifted by ~a" item lifted)
             (is (< away 0.02) "~a is ~a m from its target" item away))))
