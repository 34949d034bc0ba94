;;;; Tests of the Bullet layer: names, refusals, and the lives of worlds.

(in-package #:discrepancy-finder.tests)

(in-suite bullet)

(test objects-print-in-one-line
  (bullet:with-world (world)
    (is (string= "#<BODY FLOOR static>" (princ-to-string (add-floor world))))
    (is (string= "#<BODY cup dynamic 1.000 kg>"
                 (princ-to-string (add-cube world "cup" 0 1))))
    (is (eql 0 (search "#<WORLD 2 bodies at 0.500 s"
                       (princ-to-string (bullet:step-world world 120)))))
    (bullet:close-world world)
    (is (eql 0 (search "#<WORLD closed" (princ-to-string world))))))

(test bodies-are-found-by-name
  (bullet:with-world (world)
    (let ((floor (add-floor world)) (cup (add-cube world "cup" 0 1)))
      (is (equal (list floor cup) (bullet:world-bodies world)))
      (is (eq cup (bullet:find-body world "cup")))
      (is (null (bullet:find-body world "plate")))
      (is (eq world (bullet:body-world cup)))
      (is (eq :dynamic (bullet:body-kind cup)))
      (is (= 1 (bullet:body-mass cup))))))

(defmacro refuses (sentence form)
  "Check that FORM signals a BULLET-ERROR whose report is SENTENCE."
  `(is (string= (format nil ,sentence)
                (handler-case (progn ,form "nothing was refused")
                  (bullet:bullet-error (condition) (princ-to-string condition))))))

(defun nan ()
  (sb-kernel:make-double-float -524288 0))

(test bad-shapes-are-refused
  (bullet:with-world (world)
    (flet ((add (shape &rest options)
             (apply #'bullet:add-body world :cup shape (geometry:identity-pose) options)))
      (loop for shape in (list '(:box 1 1) '(:box 1 1 0) '(:box 1 1 "x") '(:box 1 . 1)
                               (list :box 1 1 (nan))
                               (list :sphere sb-ext:double-float-positive-infinity)
                               '(:sphere -1) '(:sphere 1e10) '(:cylinder 1) '(:cylinder 0 1)
                               '(:plane 0 0 2 0) '(:compound) '(:compound (1 (:sphere 1)))
                               (list :compound (list (geometry:identity-pose) '(:plane 0 0 1 0)))
                               (list :compound (list (geometry:identity-pose) '(:sphere 0)))
                               '(:cone 1 1) nil :box 7)
            do (signals bullet:bullet-error (add shape))
               (signals bullet:bullet-error (add shape :mass 1)))
      (refuses "add-body failed: the shape (:BOX 1 1) of body CUP is malformed; it should be ~
(:box x y z) with positive lengths." (add '(:box 1 1)))
      (refuses "add-body failed: the shape :CONE of body CUP is malformed; it should be a list ~
that begins with :box, :sphere, :cylinder, :hull, :plane or :compound." (add :cone))
      (refuses "add-body failed: body CUP is dynamic, but only static bodies can be planes."
               (add '(:plane 0 0 1 0) :mass 1))
      (is (null (bullet:world-bodies world)))
      (is (typep (add '(:sphere 1)) 'bullet:body)))))

(test bad-numbers-are-refused
  (bullet:with-world (world)
    (let ((infinity sb-ext:double-float-positive-infinity)
          (cup (add-cube world :cup 0 1))
          (link (bullet:add-body world :link '(:sphere 1) (geometry:make-pose 9 9 0)
                                 :kind :kinematic)))
      (loop for options in (list '(:mass 0) '(:mass -1) '(:mass "x") (list :mass (nan))
                                 (list :mass infinity) '(:mass 1 :friction -1)
                                 (list :mass 1 :friction (nan)) '(:mass 1 :restitution 1.5d0)
                                 '(:mass 1 :rolling-friction -1) '(:mass 1 :inertia (1 2))
                                 '(:mass 1 :inertia (1 0 1))
                                 (list :mass 1 :inertia (list 1 1 (nan)))
                                 '(:mass 1 :kind :ghost))
            do (signals bullet:bullet-error
                 (apply #'bullet:add-body world :bad '(:sphere 1) (geometry:make-pose 0 0 0)
                        (append options '(:kind :dynamic)))))
      (refuses "add-body failed: the mass of body BAD is 0, but must be a positive number, ~
from 1e-30 to 1e9."
        (bullet:add-body world :bad '(:sphere 1) (geometry:make-pose 0 0 0)
                         :kind :dynamic :mass 0))
      (refuses "add-body failed: the world has a body CUP already." (add-cube world :cup 0 1))
      (loop for pose in (list (geometry:quaternion-pose 0d0 0d0 0d0 0d0 0d0 0d0 1.1d0)
                              (geometry:quaternion-pose 0d0 0d0 0d0 0d0 0d0 0d0 0d0)
                              (geometry:quaternion-pose (nan) 0d0 0d0 0d0 0d0 0d0 1d0)
                              (geometry:quaternion-pose 0d0 infinity 0d0 0d0 0d0 0d0 1d0)
                              (geometry:quaternion-pose 0d0 0d0 0d0 0d0 0d0 (nan) 1d0))
            do (signals bullet:bullet-error (bullet:add-body world :bad '(:sphere 1) pose))
               (signals bullet:bullet-error (bullet:place-body cup pose))
               (refuses "move-body failed: the pose for body LINK is not a finite position with a ~
unit quaternion." (bullet:move-body link pose)))
      (signals bullet:bullet-error (bullet:add-body world :bad '(:sphere 1) '(0 0 0)))
      (refuses "move-body failed: body CUP is dynamic, not kinematic."
               (bullet:move-body cup (geometry:make-pose 0 0 0)))
      (signals bullet:bullet-error (bullet:allow-sleep link t))
      (refuses "read-state failed: the vector has 13 elements for 2 bodies of 13 each."
               (bullet:read-state world (make-array 13 :element-type 'double-float)))
      (signals bullet:bullet-error (bullet:make-world :time-step 0))
      (signals bullet:bullet-error (bullet:make-world :time-step (nan)))
      (signals bullet:bullet-error (bullet:make-world :gravity infinity))
      (signals bullet:bullet-error
        (bullet:make-world :gravity sb-ext:single-float-negative-infinity))
      (signals bullet:bullet-error (bullet:make-world :time-step (sb-kernel:make-single-float -1)))
      (signals bullet:bullet-error (bullet:make-world :time-step (expt 10 400))))))

(test pairs-must-be-two-bodies-of-one-world
  (bullet:with-world (world)
    (bullet:with-world (other)
      (let ((cup (add-cube world :cup 0 1)) (floor (add-floor world))
            (stranger (add-cube other :stranger 0 1)))
        (refuses "attach failed: body CUP and body STRANGER are in different worlds."
                 (bullet:attach cup stranger))
        (refuses "attach failed: body FLOOR is static, and only dynamic bodies can be attached."
                 (bullet:attach cup floor))
        (refuses "attach failed: the bodies are not two bodies of this world."
                 (bullet:attach cup cup))
        (signals bullet:bullet-error (bullet:penetration cup cup))
        (signals bullet:bullet-error (bullet:penetration cup stranger))
        (signals bullet:bullet-error (bullet:ignore-collision cup cup t))))))

(test closed-worlds-are-refused
  (let* ((world (bullet:make-world))
         (floor (add-floor world))
         (cup (add-cube world :cup 0 1))
         (attachment (bullet:attach floor cup))
         (joint (bullet:add-joint world :slider nil cup (geometry:make-pose 0 0 1)))
         (checkpoint (bullet:make-checkpoint world))
         (pose (geometry:identity-pose)))
    (bullet:close-world world)
    (bullet:close-world world)
    (is-false (bullet:joint-live-p joint))
    (is (null (bullet:world-joints world)))
    (is-false (bullet:attachment-live-p attachment))
    (is (null (bullet:attachments world)))
    (refuses "step-world failed: the world is closed." (bullet:step-world world))
    (loop for (function . arguments)
            in `((bullet:add-body ,world :x (:sphere 1) ,pose) (bullet:body-pose ,cup)
                 (bullet:body-velocity ,cup) (bullet:move-body ,cup ,pose)
                 (bullet:place-body ,cup ,pose) (bullet:wake ,cup) (bullet:asleep-p ,cup)
                 (bullet:allow-sleep ,cup t) (bullet:ignore-collision ,cup ,floor t)
                 (bullet:attach ,floor ,cup) (bullet:detach ,attachment)
                 (bullet:attachment-load ,attachment) (bullet:state-hash ,world)
                 (bullet:read-state ,world ,(bullet:make-state-vector world))
                 (bullet:at-rest-p ,world) (bullet:penetration ,cup ,floor)
                 (bullet:deepest-penetration ,world)
                 (bullet:attachment-lost-p ,attachment) (bullet:attachment-utilization ,attachment)
                 (bullet:add-joint ,world :fixed nil ,cup ,pose) (bullet:remove-joint ,joint)
                 (bullet:joint-position ,joint) (bullet:set-joint-position ,joint 0)
                 (bullet:set-motor ,joint 1 1) (bullet:joint-load ,joint)
                 (bullet:pair-distance ,cup ,floor 1) (bullet:touching-p ,cup ,floor)
                 (bullet:contacts ,cup) (bullet:clearance (,cup) (,floor) 1)
                 (bullet:sweep ,world (:sphere 1) ,pose ,(geometry:make-pose 1 0 0))
                 (bullet:make-checkpoint ,world)
                 (bullet:restore-checkpoint ,world ,checkpoint))
          do (signals bullet:bullet-error (apply function arguments)))))

(defparameter *hull-list*
  '(:hull (0 0 0) (0.1d0 0 0) (0 0.1d0 0) (0 0 0.1d0) (0.1d0 0.1d0 0.1d0)))

(defun use-worlds (count)
  "Make, use and close COUNT worlds with a little of everything; return how many."
  (loop repeat count
        do (bullet:with-world (world)
             (let ((floor (add-floor world))
                   (drawer (bullet:add-body world :drawer `(:compound (,(at 0 0 0) ,*hull-list*))
                                            (at 1 0 1)
                                            :mass 1 :inertial-pose (at 0.1d0 0 0))))
               (bullet:attach floor (add-cube world :cube 0 0.05d0) :capacity 100)
               (bullet:add-joint world :slider nil drawer (at 1 0 1))
               (bullet:step-world world 3)
               (bullet:restore-checkpoint world (bullet:make-checkpoint world))
               (bullet:contacts drawer)
               (bullet:sweep world *hull-list* (at 5 0 1) (at 0 0 1))))
        count t))

(test interrupts-wait-for-the-end-of-a-call
  (bullet:with-world (world)
    (add-floor world)
    (add-cube world :cube 0 1)
    (signals sb-ext:timeout
      (sb-ext:with-timeout 1/20
        (bullet:step-world world 1000000000)))
    (is (zerop (mod (round (* 240 (bullet:world-time world))) 1000)))
    (is (plusp (bullet:world-time world)))
    (dotimes (i 20)
      (handler-case (sb-ext:with-timeout 1/1000
                      (loop (bullet:read-state world (bullet:make-state-vector world))
                            (bullet:step-world world)))
        (sb-ext:timeout ())))
    (let ((steps (round (* 240 (bullet:world-time world)))))
      (bullet:with-world (other)
        (add-floor other)
        (add-cube other :cube 0 1)
        (is (= (bullet:state-hash world) (bullet:state-hash (bullet:step-world other steps))))))))

(test many-worlds
  (use-worlds 500)
  (sb-ext:gc :full t)
  (let ((before (resident-megabytes)))
    (is (= 2000 (use-worlds 2000)))
    (sb-ext:gc :full t)
    (is (< (- (resident-megabytes) before) 20))))

(test dropped-worlds-are-freed
  (let ((handles (loop repeat 50 collect (bullet::world-handle (bullet:make-world)))))
    (loop repeat 100
          until (every (complement #'bullet::handle-open) (butlast handles 10))
          do (sb-ext:gc :full t)
             (sleep 0.01d0))
    (is (> (count nil handles :key #'bullet::handle-open) 25))))

(test twenty-thousand-worlds-leak-nothing
  (if *long*
      (progn
        (use-worlds 1000)
        (sb-ext:gc :full t)
        (let ((before (resident-megabytes)))
          (use-worlds 20000)
          (sb-ext:gc :full t)
          (is (< (- (resident-megabytes) before) 20))))
      (skip "Only the long run tests this.")))
