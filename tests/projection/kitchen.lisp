;;;; The kitchen: that the models are what they should be, stand still, and fall and slide as things
;;;; do.  Here are the scene and the seeded draws that the other suites of the kitchen use, too.

(in-package #:discrepancy-finder.tests)

(def-suite kitchen :in all)
(in-suite kitchen)

(defvar *kitchen-scene* nil)

(defun kitchen-scene ()
  (or *kitchen-scene*
      (setf *kitchen-scene* (projection:load-scene (root-file "models/kitchen/scene.lisp")))))

(defmacro with-kitchen ((projection &rest options) &body body)
  `(projection:with-projection (,projection (kitchen-scene) ,@options) ,@body))

(defun drawn (subject index draw low high)
  "Return the number between LOW and HIGH that is drawn for the sample INDEX of SUBJECT, a string."
  (+ low (* (- high low)
            (discrepancy:unit-float 1 (discrepancy:content-hash subject) index draw))))

(defun drawn-tolerances (subject index)
  "Return values of all tolerances of the kitchen, drawn for the sample INDEX of SUBJECT, as a
property list."
  (loop for (name low high) in (projection:scene-tolerances (kitchen-scene))
        for draw from 100
        append (list name (drawn subject index draw low high))))

(defun place-of (projection item)
  "Return where ITEM is in PROJECTION: :hand, :workspace, :table, :drawer, :floor or :elsewhere."
  (let* ((pose (projection:observed-pose projection item))
         (x (geometry:pose-x pose)) (z (geometry:pose-z pose)))
    (cond ((member item (projection:held-items projection) :key #'cdr) :hand)
          ((< z 0.2) :floor)
          ((and (< x -1.9) (> z 0.85)) :workspace)
          ((and (< x -1.4) (< 0.59 z 0.75)) :drawer)
          ((and (< 0.1 x 0.9) (> z 0.74)) :table)
          (t :elsewhere))))

(defun distance-between (pose other)
  (flet ((square (coordinate)
           (expt (- (funcall coordinate pose) (funcall coordinate other)) 2)))
    (sqrt (+ (square #'geometry:pose-x) (square #'geometry:pose-y) (square #'geometry:pose-z)))))

(defun degrees-from-upright (pose)
  (let ((x (geometry:pose-qx pose)) (y (geometry:pose-qy pose)))
    (* (/ 180 pi) (acos (max -1d0 (min 1d0 (- 1 (* 2 (+ (* x x) (* y y))))))))))

(test the-kitchen-is-as-described
  (let ((scene (kitchen-scene)))
    (is (equal '(:bowl :cereal :milk :spoon) (projection:scene-item-names scene)))
    (is (eq :robot (projection:scene-robot-name scene)))
    (with-kitchen (projection)
      (dolist (item (projection:scene-item-names scene))
        (is (eq (if (eq item :spoon) :drawer :workspace) (place-of projection item))))
      (dolist (drawer '("drawer_1_joint" "drawer_2_joint" "drawer_3_joint"))
        (is (zerop (projection:observed-joint projection drawer)))))))

(test nothing-in-the-kitchen-moves-by-itself
  (with-kitchen (projection)
    (is-true (projection:settle projection))
    (dolist (item (projection:scene-item-names (kitchen-scene)))
      (let ((pose (projection:observed-pose projection item))
            (scene-pose (projection:scene-body-pose (kitchen-scene) item)))
        (is-true (projection:item-at-rest-p projection item))
        (is (< (distance-between pose scene-pose) 5d-4) "~a moved" item)
        (is (< (degrees-from-upright pose) 0.1) "~a tilts" item)))
    (is (< (projection:interpenetration projection) 1d-4))))

(test what-falls-comes-to-rest
  "Items let go anyhow come to rest on something within three seconds, and the bowl in a drawer, too."
  (loop for index below (if *long* 100 8)
        do (flet ((pose (draw x y z)
                    (flet ((angle (number) (drawn "falling" index (+ draw number) -3 3)))
                      (geometry:make-pose (+ x (drawn "falling" index draw -0.1 0.1)) y z
                                          :roll (angle 1) :pitch (angle 2) :yaw (angle 3)))))
             (with-kitchen (projection :poses (list :bowl (pose 0 -2.2 -0.6 1.1)
                                                    :cereal (pose 10 0.5 -0.4 1.0)
                                                    :milk (pose 20 0.5 0.4 1.0)
                                                    :spoon (pose 30 0 -1.2 0.5)))
               (is-true (projection:settle projection :limit 3) "sample ~d" index)
               (dolist (item (projection:scene-item-names (kitchen-scene)))
                 (is (< 0 (geometry:pose-z (projection:observed-pose projection item)) 1.2)))
               (is (< (projection:interpenetration projection) 1d-3))))))
