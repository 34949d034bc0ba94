;;;; Building: the bodies of a scene in a Bullet world.

(in-package #:discrepancy-finder.projection)

(defun part-pose (part poses)
  (getf poses (scene-part-name part) (scene-part-pose part)))

(defun add-model (part poses world kind)
  "Add the links of PART, a fixture or an item, to WORLD and return their bodies."
  (add-links (make-instance 'robot :part part :base-pose (part-pose part poses)) world kind))

(defun build-world (scene world fidelity poses joints)
  "Add all parts of SCENE to WORLD and return the projection."
  (declare (ignore joints))
  (let* ((part (scene-robot scene))
         (robot (and part (make-instance 'robot :part part :base-pose (part-pose part poses)))))
    (bullet:add-body world "ground" '(:plane 0d0 0d0 1d0 0d0) (identity-pose) :kind :static)
    (let ((fixtures (loop for part in (parts-of-kind scene :fixture)
                          append (add-model part poses world :static))))
      (when robot (add-links robot world :kinematic))
      (make-instance 'projection
                     :scene scene :world world :robot robot :fixtures fixtures :fidelity fidelity
                     :items (loop for part in (parts-of-kind scene :item)
                                  collect (cons (scene-part-name part)
                                                (first (add-model part poses world
                                                                  :dynamic))))))))
