;;;; Tests of the plans of mobile manipulation in the kitchen: places, base poses, and the actions.

(in-package #:discrepancy-finder.tests)

(def-suite actions-kitchen :in all)
(in-suite actions-kitchen)

(defmacro with-settled-kitchen ((projection &rest options) &body body)
  `(projection:with-projection (,projection (manipulation-scene) ,@options)
     (projection:settle ,projection)
     ,@body))

(defun solutions-of (location &optional (count 5))
  "Return the first COUNT solutions of the location designator LOCATION."
  (loop repeat count
        while location
        collect (plan:reference location)
        do (setf location (plan:next-solution location))))

(defun drawer (?name)
  (plan:an object (type drawer) (name ?name)))

(defun in-drawer (name)
  (let ((?drawer (drawer name)))
    (plan:a location (in ?drawer))))

;;; Places

(test places-on-parts-are-points-to-look-at
  (with-settled-kitchen (projection)
    (let ((points (solutions-of (plan:a location (on counter)) 20)))
      (is (= 10 (length points)))
      (is-true (every (lambda (point)
                        (and (nearly 0.85 (geometry:pose-z point) 1d-3)
                             (< -2.5 (geometry:pose-x point) -1.9)
                             (< -1 (geometry:pose-y point) 1)))
                      points))
      (is (< 1.5 (- (reduce #'max points :key #'geometry:pose-y)
                    (reduce #'min points :key #'geometry:pose-y)))
          "all over it")
      (is (> (reduce #'min (loop for (point . others) on points
                                 append (loop for other in others
                                              collect (geometry:planar-distance point other))))
             0.2)))
    (is-true (every (lambda (point) (nearly 0.6 (geometry:pose-z point) 1d-3))
                    (solutions-of (in-drawer 'drawer-2)))
             "on the floor of the closed drawer")
    (signals desig:designator-error (plan:reference (plan:a location (on ceiling))))))

(test places-for-items-are-free
  (with-settled-kitchen (projection :poses (list :milk (geometry:make-pose 0.2 0 0.85)))
    (let ((places (solutions-of (plan:a location (on table) (for cereal)) 5)))
      (is (= 5 (length places)))
      (is-true (every (lambda (place) (nearly (+ 0.75 0.112 0.006) (geometry:pose-z place) 2d-3))
                      places)
               "it stands on the table")
      (is-true (every (lambda (place)
                        (> (geometry:planar-distance
                            place (projection:observed-pose projection :milk))
                           0.08))
                      places)
               "where the milk is not")
      (is-true (apply #'<= (mapcar (lambda (place)
                                     (geometry:planar-distance
                                      place (projection:observed-pose projection :robot)))
                                   places))
               "the nearest first"))))

;;; Base poses

(test base-poses-to-reach-something
  (flet ((poses ()
           (with-settled-kitchen (projection)
             (let ((poses (solutions-of (plan:a location (reachable-for robot)
                                                (object (plan:an object (type milk)))))))
               (is-true (every (lambda (pose) (projection::base-pose-free-p projection pose))
                               poses))
               poses))))
    (let ((poses (poses)))
      (is (= 5 (length poses)))
      (dolist (pose poses)
        (is (< 0.4 (geometry:planar-distance pose (geometry:make-pose -2.1 0.1 0)) 0.9))
        (is (< 0.7 (cos (geometry:pose-yaw (geometry:compose (geometry:inverse pose)
                                                             (geometry:make-pose -2.1 0.1 0
                                                                                 :yaw 3.14159)))))
            "it looks at the counter"))
      (is-true (every #'geometry:pose= poses (poses)) "always the same ones"))))

(test base-poses-to-see-into-a-drawer
  (flet ((count-poses (position)
           (with-settled-kitchen (projection :joints `(("drawer_2_joint" . ,position)))
             (let* ((?place (in-drawer 'drawer-2))
                    (location (plan:a location (visible-for robot) (location ?place))))
               (handler-case (length (solutions-of location 5))
                 (desig:designator-error () 0))))))
    (is (= 0 (count-poses 0)) "nobody sees into a closed drawer")
    (is (= 5 (count-poses 0.35)))))

(test base-poses-to-open-a-drawer
  (with-settled-kitchen (projection)
    (let* ((?drawer (drawer 'drawer-1))
           (poses (solutions-of (plan:a location (reachable-for robot) (object ?drawer)) 4)))
      (is (= 4 (length poses)))
      (dolist (pose poses)
        (is (< -1.4 (geometry:pose-x pose) -0.9))
        (is (< (abs (- (geometry:pose-y pose) -0.6)) 0.35))
        (is (nearly -1 (cos (geometry:pose-yaw pose)) 1d-6))))))

;;; Actions

(test turning-towards-what-the-head-does-not-reach
  (with-settled-kitchen (projection)
    (let ((?behind (geometry:make-pose 2 0.5 1)))
      (plan:perform (plan:an action (type turning-towards)
                             (target (plan:a location (pose ?behind)))))
      (is (< (pointing-error projection 2 0.5 1) 1d-3))
      (is (< 0.9 (cos (geometry:pose-yaw (projection:observed-pose projection :robot))))
          "the base has turned"))))

(test searching-finds-or-fails
  (with-settled-kitchen (projection)
    (let ((found (plan:perform (plan:an action (type searching)
                                        (object (plan:an object (type bowl)))
                                        (location (plan:a location (on counter)))))))
      (is (eq :bowl (plan:desig-prop-value found :name))))
    (is (eq :nowhere
            (plan:with-failure-handling
                ((plan:object-nowhere-to-be-found () (return :nowhere)))
              (plan:perform (plan:an action (type searching)
                                     (object (plan:an object (type teapot)))
                                     (location (plan:a location (on table))))))))))

(test going-and-looking-by-poses
  (with-settled-kitchen (projection)
    (let ((?place (geometry:make-pose -1.1 0.5 0 :yaw pi)) (?point (geometry:make-pose -2.1 0 0.9)))
      (plan:perform (plan:an action (type going) (pose ?place)))
      (is (nearly 0.5 (geometry:pose-y (projection:observed-pose projection :robot)) 1d-6))
      (is-true (plan:perform (plan:an action (type looking) (pose ?point)))))))

(test a-location-without-a-solution-is-a-failure
  "What is nowhere cannot be gone to, looked at or reached; plans of actions fail then, too."
  (flet ((failure-of (class type key value)
           (with-settled-kitchen (projection)
             (handler-case (plan:perform (plan:make-designator class
                                                               `((:type ,type) (,key ,value))))
               (plan:plan-failure (failure) (type-of failure))))))
    (let ((?nowhere (plan:a location (on ceiling))) (?nothing (drawer 'drawer-9)))
      (dolist (type '(:going :looking))
        (dolist (class '(:motion :action))
          (is (eq 'plan:designator-reference-failure
                  (failure-of class type :target ?nowhere)))))
      (is (eq 'plan:navigation-goal-in-collision
              (failure-of :action :navigating :location ?nowhere)))
      (is (eq 'plan:environment-manipulation-impossible
              (failure-of :action :accessing :location (plan:a location (in ?nothing)))))
      (is (eq 'plan:object-unfetchable
              (failure-of :action :fetching :object (plan:an object (type unicorn))))))))

(test accessing-and-sealing
  (with-settled-kitchen (projection)
    (let ((?place (in-drawer 'drawer-3)))
      (plan:perform (plan:an action (type accessing) (location ?place) (distance 0.3)))
      (is (nearly 0.3 (projection:observed-joint projection "drawer_3_joint") 0.02))
      (plan:perform (plan:an action (type sealing) (location ?place) (distance 0.3)))
      (is (nearly 0 (projection:observed-joint projection "drawer_3_joint") 0.02)))))

(defun transporting (?type ?from &rest more)
  "Return an action that transports the item of ?TYPE from ?FROM to the table."
  (plan:make-designator :action
                        `((:type :transporting) (:object ,(plan:an object (type ?type)))
                          (:location ,?from) (:target ,(plan:a location (on table)))
                          ,@more)))

(test transporting-from-the-counter
  (dolist (item '(:milk :bowl))
    (with-settled-kitchen (projection)
      (is (eq item (plan:perform (transporting item (plan:a location (on counter))))))
      (let ((pose (projection:observed-pose projection item)))
        (is (< 0.1 (geometry:pose-x pose) 0.9) "~a" item)
        (is (< 0.75 (geometry:pose-z pose) 0.9) "~a" item))
      (is (null (projection:held-items projection))))))

(test transporting-out-of-a-drawer
  (with-settled-kitchen (projection)
    (plan:perform (transporting :spoon (in-drawer 'drawer-2)))
    (is (< 0.1 (geometry:pose-x (projection:observed-pose projection :spoon)) 0.9))
    (is (nearly 0 (projection:observed-joint projection "drawer_2_joint") 0.02)
        "the drawer is closed again")))

(defvar *stand-in* nil "What A-USER-S-PICKING-UP was called with.")

(plan:def-cram-function a-user-s-picking-up (?object)
  (setf *stand-in* ?object))

(test a-user-s-plan-stands-for-a-process-module
  (unwind-protect
       (with-settled-kitchen (projection)
         (eval '(prolog:def-fact-group stand-ins (desig:action-grounding)
                 (prolog:<- (desig:action-grounding ?action (a-user-s-picking-up ?object))
                   (desig:desig-prop ?action (:type :picking-up))
                   (desig:desig-prop ?action (:object ?object)))))
         (let* ((milk (plan:an object (type milk)))
                (?object milk))
           (plan:perform (plan:an action (type picking-up) (object ?object)))
           (is (eq milk *stand-in*))
           (is (null (projection:held-items projection)))))
    (eval '(prolog:def-fact-group stand-ins ()))))
