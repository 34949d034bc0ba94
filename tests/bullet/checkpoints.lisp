;;;; Tests of the Bullet layer: checkpoints, bit for bit, and worlds in threads.

(in-package #:discrepancy-finder.tests)

(in-suite bullet)

(defparameter *drawer*
  `(:compound (,(geometry:make-pose 0 0 -0.05d0) (:box 0.4d0 0.4d0 0.01d0))
              (,(geometry:make-pose 0.2d0 0 0) (:box 0.01d0 0.4d0 0.1d0))
              (,(geometry:make-pose -0.2d0 0 0) (:box 0.01d0 0.4d0 0.1d0)))
  "The same list for all worlds, so that they share its foreign shape.")

(defun small-kitchen (world)
  "Add a table with a few things, a drawer with a cup, a door, and a hand that holds a carton."
  (add-floor world)
  (bullet:add-body world :table '(:box 1 1 0.1d0) (at 0 0 0.5d0))
  (let ((drawer (bullet:add-body world :drawer *drawer* (at 1 0 0.3d0) :mass 2
                                 :inertial-pose (geometry:make-pose 0.01d0 0 -0.03d0 :yaw 0.1d0)))
        (door (bullet:add-body world :door '(:box 0.6d0 0.02d0 0.5d0) (at -0.7d0 0 1.5d0)
                               :mass 3)))
    (bullet:set-motor (bullet:add-joint world :slider nil drawer (at 1 0 0.3d0)
                                        :lower 0 :upper 0.4d0 :name :drawer)
                      0 3)
    (bullet:add-joint world :hinge nil door (geometry:make-pose -1 0 1.5d0 :pitch (/ pi -2))
                      :lower -1 :upper 1 :name :door))
  (dotimes (i 4)
    (bullet:add-body world i (if (evenp i) '(:box 0.1d0 0.1d0 0.1d0) *hull-list*)
                     (geometry:make-pose (* 0.02d0 i) 0 (+ 0.7d0 (* 0.15d0 i)) :roll (* 0.1d0 i))
                     :mass 0.5d0))
  (bullet:add-body world :cup '(:cylinder 0.04d0 0.1d0) (at 1 0 0.37d0) :mass 0.2d0)
  (let ((palm (bullet:add-body world :palm '(:box 0.05d0 0.05d0 0.05d0) (at 0 -2 1)
                               :kind :kinematic))
        (carton (bullet:add-body world :carton '(:box 0.06d0 0.06d0 0.2d0) (at 0.1d0 -2 1)
                                 :mass 0.4d0)))
    (bullet:attach palm carton :point (at 0 0 0.03d0) :capacity 20))
  world)

(defun live-in-the-kitchen (world from to)
  "Move the hand, drawer and more from step FROM to step TO; return the hash of WORLD."
  (let ((palm (bullet:find-body world :palm)) (drawer (bullet:find-joint world :drawer)))
    (loop for i from from below to
          do (bullet:set-motor drawer (if (< i 300) 0.15d0 -0.2d0) 20)
             (bullet:move-body palm (at (* 0.3d0 (- 1 (cos (/ i 100d0)))) -2
                                        (+ 1 (* 0.01d0 (- 1 (cos (* i 0.05d0)))))))
             (case i
               (150 (bullet:ignore-collision (bullet:find-body world 0)
                                             (bullet:find-body world 1) t))
               (250 (bullet:attach palm (bullet:find-body world 3)))
               (350 (mapc #'bullet:detach (last (bullet:attachments world))))
               (400 (bullet:remove-joint (bullet:find-joint world :door))))
             (bullet:step-world world))
    (bullet:state-hash world)))

(test restored-worlds-go-on-with-the-same-bits
  (bullet:with-world (world)
    (bullet:with-world (fresh)
      (live-in-the-kitchen (small-kitchen world) 0 270)
      (let* ((grip (first (bullet:attachments world)))
             (checkpoint (bullet:make-checkpoint world))
             (hash (bullet:state-hash world))
             (utilization (bullet:attachment-utilization grip))
             (continued (live-in-the-kitchen world 270 600)))
        (is (string= "#<CHECKPOINT after 270 steps>" (princ-to-string checkpoint)))
        (is (= 1 (length (bullet:world-joints world))))
        (dotimes (i 2)
          (bullet:restore-checkpoint world checkpoint)
          (is (= hash (bullet:state-hash world)))
          (is (= (* 270 1/240) (rational (bullet:world-time world))))
          (is (= 2 (length (bullet:attachments world)) (length (bullet:world-joints world))))
          (is (eq grip (first (bullet:attachments world))))
          (is (= utilization (bullet:attachment-utilization grip)))
          (is (= continued (live-in-the-kitchen world 270 600))))
        (bullet:restore-checkpoint (small-kitchen fresh) checkpoint)
        (is (= hash (bullet:state-hash fresh)))
        (is (equal '(:carton 3) (mapcar (lambda (attachment)
                                          (bullet:body-name (bullet:attachment-child attachment)))
                                        (bullet:attachments fresh))))
        (is (= continued (live-in-the-kitchen fresh 270 600)))))))

(test checkpoint-changes-little
  "A world that forgets its contacts 20 times stays where it would be to a millimetre or so."
  (flet ((positions (forgetful)
           (bullet:with-world (world)
             (add-floor world)
             (dotimes (i 5)
               (add-cube world i (* 0.01d0 i) (+ 0.05d0 (* 0.1d0 i))))
             (dotimes (i 20)
               (bullet:step-world world 60)
               (when forgetful (bullet:make-checkpoint world)))
             (loop for i below 5
                   append (subseq (geometry:pose-components
                                   (bullet:body-pose (bullet:find-body world i)))
                                  0 3)))))
    (is (all-near-p (positions nil) 3d-3 (positions t)))))

(test checkpoint-undoes-and-redoes-attachments
  (bullet:with-world (world)
    (let* ((palm (bullet:add-body world :palm '(:sphere 0.05d0) (at 0 0 1) :kind :kinematic))
           (a (add-cube world :a 0.2d0 1))
           (b (add-cube world :b -0.2d0 1))
           (start (bullet:make-checkpoint world))
           (first (bullet:attach palm a))
           (middle (bullet:make-checkpoint world)))
      (bullet:detach first)
      (bullet:restore-checkpoint world middle)
      (is (equal (list first) (bullet:attachments world)))
      (bullet:restore-checkpoint world start)
      (is-false (bullet:attachment-live-p first))
      (is-false (bullet:attachment-lost-p first))
      (bullet:detach first)
      (signals bullet:bullet-error (bullet:attachment-load first))
      (let ((second (bullet:attach palm b)))
        (is-false (bullet:attachment-live-p first) "another one has its place")
        (is-true (bullet:attachment-live-p second))
        (bullet:restore-checkpoint world middle)
        (is-false (bullet:attachment-live-p second))
        (is (eq a (bullet:attachment-child (first (bullet:attachments world)))))
        (bullet:step-world world 240)
        (is (near 1 1d-4 (height a)))
        (is (< (height b) 0))))))

(test what-slept-at-a-checkpoint-falls-when-its-support-goes
  "Bullet has no contacts between bodies that have slept since then."
  (bullet:with-world (world)
    (let ((shelf (bullet:add-body world :shelf '(:box 1 1 0.1d0) (at 0 0 1) :kind :kinematic))
          (board (bullet:add-body world :board '(:box 1 1 0.1d0) (at 5 0 1)))
          (cubes (list (add-cube world :a 0 1.1d0) (add-cube world :b 5 1.1d0))))
      (bullet:step-world world 480)
      (is (every #'bullet:asleep-p cubes))
      (bullet:make-checkpoint world)
      (bullet:step-world world 10)
      (is (every #'bullet:asleep-p cubes))
      (bullet:move-body shelf (at 0 9 1))
      (bullet:place-body board (at 5 9 1))
      (bullet:step-world world 120)
      (is (every (lambda (cube) (< (height cube) 0)) cubes)))))

(test checkpoints-of-other-worlds-are-refused
  (bullet:with-world (world)
    (bullet:with-world (other)
      (let ((cube (add-cube world :cube 0 1)))
        (add-cube other :cube 0 1)
        (let ((checkpoint (bullet:make-checkpoint world)))
          (is (eq other (bullet:restore-checkpoint other checkpoint)))
          (bullet:add-joint other :slider nil (bullet:find-body other :cube) (at 0 0 1))
          (refuses "restore-checkpoint failed: the checkpoint is of a world with other bodies or ~
joints." (bullet:restore-checkpoint other checkpoint))
          (bullet:add-body world :more '(:sphere 1) (at 5 0 0))
          (let ((hash (bullet:state-hash world)))
            (signals bullet:bullet-error (bullet:restore-checkpoint world checkpoint))
            (is (= hash (bullet:state-hash world))))
          (is (near 1 0 (height cube))))
        (bullet:with-world (heavier)
          (add-cube heavier :cube 0 1 :friction 0.6d0)
          (add-cube heavier :more 5 1)
          (signals bullet:bullet-error
            (bullet:restore-checkpoint heavier (bullet:make-checkpoint world))))))))

(test worlds-of-endless-numbers-have-no-checkpoint
  (bullet:with-world (world :gravity -9d8 :time-step 1)
    (add-cube world :cube 0 0)
    (bullet:step-world world 2)
    (refuses "make-checkpoint failed: something in the world is not at a finite place any more."
             (bullet:make-checkpoint world))
    (is (integerp (bullet:state-hash (bullet:step-world world))))))

(test worlds-with-shared-shapes-in-threads-have-the-same-bits
  (flet ((live ()
           (bullet:with-world (world)
             (live-in-the-kitchen (small-kitchen world) 0 450))))
    (let ((hash (live))
          (threads (loop repeat 4
                         collect (sb-thread:make-thread
                                  (lambda () (loop repeat 3 collect (live)))))))
      (sb-ext:gc :full t)
      (dolist (thread threads)
        (is (equal (list hash hash hash) (sb-thread:join-thread thread)))))))

(test checkpoint-holds-the-posture-of-a-mechanism
  (bullet:with-world (world)
    (let* ((arm (bullet:add-body world :arm '(:box 0.1d0 0.1d0 0.1d0) (at 0 0 0)
                                 :kind :kinematic))
           (mechanism (bullet:make-mechanism
                       world (vector (bullet:link-spec "base" nil :fixed (at 0 0 0))
                                     (bullet:link-spec "arm" 0 :prismatic (at 0 0 1)
                                                       '(1 0 0) 0 1 nil arm))))
           (positions (bullet:make-positions mechanism)))
      (setf (aref positions 1) 0.5d0)
      (bullet:pose-mechanism mechanism (at 1 2 0) positions)
      (bullet:step-world world)
      (let ((checkpoint (bullet:make-checkpoint world)))
        (setf (aref positions 1) 0.1d0)
        (bullet:pose-mechanism mechanism (at 0 0 0) positions)
        (bullet:restore-checkpoint world checkpoint)
        (is (geometry:pose= (at 1.5d0 2 1) (bullet:link-pose mechanism 1)))
        (is (geometry:pose= (at 1.5d0 2 1) (bullet:body-pose arm)))))))
