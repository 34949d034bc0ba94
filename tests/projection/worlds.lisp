;;;; Tests of worlds: joints at first, what runs in a projection, the torso, time.

(in-package #:discrepancy-finder.tests)

(def-suite worlds :in all)
(in-suite worlds)

(test joints-begin-where-they-are-told-to
  (projection:with-projection (projection (kitchen-scene)
                                          :joints '(("drawer_2_joint" . 0.3)
                                                    ("torso_lift_joint" . 0.2)))
    (is (nearly 0.3d0 (projection:observed-joint projection "drawer_2_joint") 1d-9))
    (is (nearly 0 (projection:observed-joint projection "drawer_1_joint") 1d-9))
    (is (= 0.2d0 (projection:observed-joint projection "torso_lift_joint")))
    (let ((closed (projection:scene-body-pose (kitchen-scene) :spoon)))
      (is (nearly (+ (geometry:pose-x closed) 0.3)
                  (geometry:pose-x (projection:observed-pose projection :spoon)) 1d-6)
          "what lies in a drawer goes along"))
    (dolist (item '(:bowl :cereal :milk))
      (is (nearly 0 (geometry:planar-distance
                     (projection:scene-body-pose (kitchen-scene) item)
                     (projection:observed-pose projection item))
                  1d-9)
          "what stands on the counter above it does not"))
    (let ((handle (projection:fixture-link-pose projection "drawer_2_handle")))
      (is (nearly 0.3d0 (- (geometry:pose-x handle)
                           (projection:with-projection (closed (kitchen-scene))
                             (geometry:pose-x
                              (projection:fixture-link-pose closed "drawer_2_handle"))))
                  1d-9)))
    (projection:settle projection)
    (is (nearly 0.3 (projection:observed-joint projection "drawer_2_joint") 5d-3))
    (is (projection:item-at-rest-p projection :spoon))))

(test an-item-with-a-pose-of-its-own-stays-there
  (let ((pose (geometry:make-pose -2.12 0 0.6095)))
    (projection:with-projection (projection (kitchen-scene) :poses (list :spoon pose)
                                                            :joints '(("drawer_2_joint" . 0.3)))
      (is (nearly -2.12d0 (geometry:pose-x (projection:observed-pose projection :spoon)) 1d-9)))))

(test joints-that-do-not-exist-are-refused
  (flet ((attempt (name position)
           (projection:close-projection
            (projection:make-projection (kitchen-scene) :joints (list (cons name position))))))
    (signals-with (projection:unknown-joint "kitchen" "drawer_9") (attempt "drawer_9" 0))
    (signals-with (projection:unknown-joint) (attempt "drawer_2_handle_joint" 0))
    (signals-with (projection:unknown-joint) (attempt :torso 0))
    (signals-with (projection:impossible-joint-position "drawer_2_joint" "0.5" "to 0.4")
      (attempt "drawer_2_joint" 0.5))
    (signals-with (projection:impossible-joint-position "far") (attempt "drawer_2_joint" "far"))
    (projection:with-projection (projection (kitchen-scene))
      (signals projection:unknown-joint (projection:observed-joint projection "drawer_9"))
      (signals projection:unknown-joint
        (projection:observed-joint projection "drawer_2_handle_joint")))))

(test plans-run-in-a-projection
  "The body of WITH-PROJECTION performs in it, returns its values, and may make top-levels."
  (is (equal '(1 2) (multiple-value-list
                     (projection:with-projection (projection (two-regions-scene))
                       (values (if projection 1 0) 2)))))
  (is (nearly 1.5 (projection:with-projection (projection (two-regions-scene))
                    (plan:par (plan:perform (going-to 1.5)))
                    (geometry:pose-x (projection:observed-pose projection :robot)))
              1d-6))
  (is (eq :failed (projection:with-projection (projection (two-regions-scene))
                    (is-true projection)
                    (handler-case (plan:perform (going-to 0.5 0.4))
                      (plan:navigation-pose-unreachable () :failed)))))
  (signals plan:navigation-pose-unreachable
    (projection:with-projection (projection (two-regions-scene))
      (is-true projection)
      (plan:perform (going-to 0.5 0.4))))
  (signals plan:nested-top-level
    (projection:with-projection (projection (two-regions-scene))
      (is-true projection)
      (plan:top-level (plan:top-level 1))))
  (is (= 3 (projection:with-projection (projection (root-file "models/two-regions/scene.lisp"))
             (plan:top-level (length (bullet:world-bodies
                                      (projection:projection-world projection)))
                             3)))))

(test a-projection-that-is-left-is-closed
  (let ((world nil))
    (block nil
      (projection:with-projection (projection (two-regions-scene))
        (setf world (projection:projection-world projection))
        (return)))
    (signals bullet:bullet-error (bullet:step-world world))))

(test handlers-around-a-projection-see-what-its-body-signals
  (let ((seen '()))
    (handler-bind ((warning (lambda (warning) (push warning seen) (muffle-warning warning))))
      (projection:with-projection (projection (two-regions-scene))
        (warn "~a" projection)))
    (is (= 1 (length seen)))))

(test errors-of-tasks-are-errors-outside-of-a-projection
  "What goes wrong in a task of the body is seen outside as what it is, and in the body in CRAM's
envelope."
  (flet ((seen-outside (function)
           (let ((seen '()))
             (ignore-errors
              (handler-bind ((serious-condition (lambda (condition)
                                                  (push (type-of condition) seen))))
                (projection:with-projection (projection (two-regions-scene))
                  (funcall function))))
             (remove-duplicates seen))))
    (is (equal '(plan:designator-not-understood)
               (seen-outside (lambda () (plan:perform (plan:a motion (type going)))))))
    (is (equal '(type-error) (seen-outside (lambda () (plan:par (error 'type-error))))))
    (is (equal '() (seen-outside (lambda ()
                                   (plan:with-failure-handling
                                       ((plan:common-lisp-error-envelope () (return)))
                                     (plan:par (error 'type-error)))))))))

(test poses-are-those-of-things-of-the-scene
  (dolist (name '(:teapot :counter))
    (signals projection:unknown-body
      (projection:with-projection (projection (kitchen-scene)
                                              :poses (list name (geometry:make-pose 0 0 0)))))))

(test equal-projections-have-equal-bits
  (flet ((hash (fidelity)
           (projection:with-projection (projection (kitchen-scene) :fidelity fidelity)
             (projection:settle projection)
             (projection:state-hash projection))))
    (is (= (hash :fast) (hash :fast) (hash :full)))
    (is (= (hash :fast) (sb-thread:join-thread (sb-thread:make-thread #'hash
                                                                      :arguments '(:fast)))))))

(test the-torso-moves-within-its-limits
  (flet ((moving (projection ?angle)
           (perform-in projection (plan:a motion (type moving-torso) (joint-angle ?angle)))))
    (projection:with-projection (projection (kitchen-scene))
      (is (= 0.1d0 (moving projection 0.1)))
      (is (= 0.1d0 (projection:observed-joint projection "torso_lift_joint")))
      (is (< 0.1 (moving projection :upper-limit)))
      (signals plan:torso-goal-not-reached (moving projection 5))
      (is (= (projection:observed-joint projection "torso_lift_joint")
             (moving projection :upper-limit))
          "it is at its limit now")
      (signals plan:designator-not-understood (moving projection :somewhere)))
    (projection:with-projection (projection (two-regions-scene))
      (signals-with (projection:missing-robot-part "torso") (moving projection 0.1)))))

(test time-passes-at-both-fidelities
  (dolist (fidelity '(:fast :full))
    (projection:with-projection (projection (two-regions-scene) :fidelity fidelity)
      (projection:settle projection)
      (let ((before (projection:simulated-seconds projection)))
        (projection:pass-time projection 240)
        (is (= 1 (- (projection:simulated-seconds projection) before)))))))
