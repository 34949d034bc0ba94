;;;; Tests of motions of mechanisms: both fidelities against each other and against closed forms.

(in-package #:discrepancy-finder.tests)

(def-suite motion-runs :in all)
(in-suite motion-runs)

(defun ramp (steps distance acceleration &key (braking acceleration))
  "Return a vector with the way (m) after each of STEPS of 1/240 s of a drive at 1 m/s, or slower if
DISTANCE is too short, with ACCELERATION and BRAKING (m/s^2)."
  (let* ((a (float acceleration 1d0)) (b (float braking 1d0))
         (ramps (+ (/ 1 (* 2 a)) (/ 1 (* 2 b))))
         (speed (min 1d0 (sqrt (/ distance ramps))))
         (up (/ speed a)) (down (/ speed b))
         (end (+ up down (/ (- distance (* ramps speed speed)) speed)))
         (ways (make-array steps :element-type 'double-float)))
    (loop for i from 1 to steps
          for time = (/ i 240d0)
          do (setf (aref ways (1- i))
                   (cond ((< time up) (/ (* a time time) 2))
                         ((< time (- end down)) (+ (/ (* speed up) 2) (* speed (- time up))))
                         ((< time end) (- distance (/ (* b (expt (- end time) 2)) 2)))
                         (t (float distance 1d0)))))
    ways))

(defun straight-bases (ways &key (turn 0d0))
  "Return the base poses for WAYS along x, turned by TURN (rad) for each m."
  (let ((bases (make-array (* 7 (length ways)) :element-type 'double-float)))
    (loop for way across ways
          for i from 0 by 7
          do (replace bases (geometry:pose-components
                             (geometry:make-pose way 0 0 :yaw (* turn way)))
                      :start1 i))
    bases))

(defstruct carrier
  "A world with a robot: a base of 0.4 m, a sliding lift of 0.5 m, a hand that turns about z."
  world mechanism base hand item attachment)

(defun build-carrier (world &key (capacity 50) (arm 0.5d0) (point (geometry:identity-pose))
                             (mass 0.5d0) (hold t) (lift 0.5d0))
  "Add a floor and a robot that holds a box of MASS at its hand, which is ARM before it."
  (let* ((base (bullet:add-body world "base" '(:box 0.4d0 0.4d0 0.3d0)
                                (geometry:make-pose 0 0 0.2d0) :kind :kinematic))
         (hand (bullet:add-body world "hand" '(:box 0.04d0 0.1d0 0.04d0)
                                (geometry:make-pose 0 0 0) :kind :kinematic))
         (mechanism
           (bullet:make-mechanism
            world
            (list (bullet:link-spec "base" nil :fixed (geometry:make-pose 0 0 0.2d0) '(1 0 0)
                                    nil nil nil base)
                  (bullet:link-spec "lift" 0 :prismatic (geometry:make-pose 0 0 0) '(0 0 1) 0 1)
                  (bullet:link-spec "shoulder" 1 :revolute (geometry:make-pose 0 0 0) '(0 0 1))
                  (bullet:link-spec "hand" 2 :revolute (geometry:make-pose arm 0 0.2d0) '(0 1 0)
                                    nil nil nil hand))))
         (positions (bullet:make-positions mechanism)))
    (setf (aref positions 1) lift)
    (unless (bullet:find-body world :floor) (add-floor world))
    (bullet:pose-mechanism mechanism (geometry:identity-pose) positions :teleport t)
    (let ((item (bullet:add-body world "item" '(:box 0.06d0 0.06d0 0.2d0)
                                 (geometry:compose (bullet:link-pose mechanism 3)
                                                   (geometry:make-pose 0.06d0 0 0))
                                 :mass mass)))
      (make-carrier :world world :mechanism mechanism :base base :hand hand :item item
                    :attachment (and hold
                                     (bullet:attach hand item :capacity capacity :point point
                                                              :axis '(0 1 0)
                                                              :torsion-radius 0.012d0))))))

(defmacro with-carrier ((carrier &rest options) &body body)
  (let ((world (gensym "WORLD")))
    `(bullet:with-world (,world)
       (let ((,carrier (build-carrier ,world ,@options)))
         ,@body))))

(defun run-carrier (carrier fidelity &rest options)
  (apply #'bullet:run-motion (carrier-mechanism carrier) :fidelity fidelity options))

(defun goal (&rest numbers)
  (coerce (mapcar (lambda (x) (float x 1d0)) numbers) '(simple-array double-float (*))))

(defun swing-and-drive (carrier fidelity)
  "Drive 2 m and turn by 1 rad, and at the same time lift, turn and tilt the hand."
  (let ((ways (ramp 700 2 1)))
    (run-carrier carrier fidelity :steps 700 :bases (straight-bases ways :turn 0.5d0)
                                  :fractions (map '(simple-array double-float (*))
                                                  (lambda (way) (/ way 2)) ways)
                                  :goal (goal 0 0.8d0 1 -0.5d0))))

(test fidelities-agree-on-the-way-of-a-held-body
  (with-carrier (full)
    (with-carrier (fast)
      (is (= 700 (swing-and-drive full :full)))
      (is (eq :done (nth-value 1 (swing-and-drive fast :fast))))
      (is (geometry:pose= (bullet:body-pose (carrier-hand full))
                          (bullet:body-pose (carrier-hand fast))))
      (is (geometry:pose= (bullet:link-pose (carrier-mechanism fast) 3)
                          (bullet:body-pose (carrier-hand fast))))
      (is (> 1d-6 (pose-gap (bullet:body-pose (carrier-item full))
                            (bullet:body-pose (carrier-item fast)))))
      (is (= (bullet:world-time (carrier-world full)) (bullet:world-time (carrier-world fast))))
      (is (near 700/240 1d-9 (bullet:world-time (carrier-world fast))))
      (is-true (bullet:attachment-live-p (carrier-attachment fast))))))

(test fidelities-agree-on-the-load-of-a-grip
  (flet ((loads (fidelity)
           (with-carrier (carrier :point (geometry:make-pose 0.01d0 0 0.03d0))
             (let* ((ways (ramp 700 2 1))
                    (bases (straight-bases ways :turn 0.5d0)))
               (loop for i below 690
                     do (run-carrier carrier fidelity
                                     :steps 1 :bases (subseq bases (* 7 i) (* 7 (1+ i)))
                                     :start (goal 0 (+ 0.5d0 (/ (if (zerop i) 0
                                                                    (aref ways (1- i))) 8)) 0 0)
                                     :fractions (goal 1)
                                     :goal (goal 0 (+ 0.5d0 (/ (aref ways i) 8)) 0 0))
                     collect (bullet:attachment-utilization (carrier-attachment carrier)))))))
    (loop for full in (loads :full)
          for fast in (loads :fast)
          for i from 0
          do (is (near full (* 1d-4 full) fast)))))

;;; Losing

(defun drive-and-brake (carrier fidelity braking)
  "Drive until a stop from 1 m/s with BRAKING (m/s^2), and a second longer; return in which step the
item was lost, and where it is then."
  (let* ((ways (ramp 800 1.5d0 1 :braking braking))
         (bases (straight-bases ways))
         (attachment (carrier-attachment carrier)))
    (loop for i below 800
          do (run-carrier carrier fidelity :steps 1 :bases (subseq bases (* 7 i) (* 7 (1+ i))))
          until (bullet:attachment-lost-p attachment)
          finally (return (values (and (< i 800) i)
                                  (bullet:body-pose (carrier-item carrier)))))))

(test fidelities-agree-on-what-is-lost-and-when
  (loop for (capacity braking lost) in '((4.9d0 1 t) (5.05d0 2 nil) (5.05d0 3 t) (50 3 nil))
        for results = (loop for fidelity in '(:full :fast)
                            collect (with-carrier (carrier :capacity capacity
                                                           :point (geometry:make-pose 0 0 0))
                                      (multiple-value-list
                                       (drive-and-brake carrier fidelity braking))))
        do (destructuring-bind ((full full-pose) (fast fast-pose)) results
             (is (eq lost (not (null full))) "lost at ~a with ~a N and ~a m/s^2" full capacity
                 braking)
             (is (eql full fast))
             (is (> 1d-6 (pose-gap full-pose fast-pose))))))

(test what-is-lost-falls-alike-in-both-fidelities
  (flet ((outcome (fidelity)
           (with-carrier (carrier :capacity 5.05d0)
             (let ((ways (ramp 1000 1.5d0 1 :braking 3)))
               (run-carrier carrier fidelity :steps 1000 :bases (straight-bases ways))
               (is-true (bullet:attachment-lost-p (carrier-attachment carrier)))
               (is-true (bullet:at-rest-p (carrier-world carrier)))
               (bullet:body-pose (carrier-item carrier))))))
    (let ((full (outcome :full)) (fast (outcome :fast)))
      (is (< (geometry:pose-z full) 0.2d0))
      (is (> 1d-3 (pose-gap full fast)) "~a, but ~a" full fast))))

(test sudden-stop-loses-what-is-held
  (flet ((outcome (fidelity)
           (with-carrier (carrier :capacity 30)
             (let ((wall (add-box (carrier-world carrier) "wall"
                                  (geometry:make-pose 0.9d0 0 -0.75d0)))
                   (bases (straight-bases (ramp 800 2 1))))
               (list (nth-value 1 (run-carrier carrier fidelity
                                               :steps 800 :bases bases
                                               :watched (list (carrier-base carrier))
                                               :obstacles (list wall)))
                     (bullet:attachment-live-p (carrier-attachment carrier))
                     (run-carrier carrier fidelity :steps 1)
                     (bullet:attachment-lost-p (carrier-attachment carrier))
                     (> (bullet:attachment-utilization (carrier-attachment carrier)) 1))))))
    (is (equal '(:contact t 1 t t) (outcome :full)))
    (is (equal '(:contact t 1 t t) (outcome :fast)))))

;; A start that is off by a rounding error is no reason to put the arm there, at rest.
(test motions-may-follow-each-other-at-speed
  (dolist (fidelity '(:full :fast))
    (with-carrier (carrier :capacity 7)
      (let ((ways (ramp 400 0.4d0 1)))
        (loop for i from 0 below 400 by 8
              for before = (if (zerop i) 0d0 (aref ways (1- i)))
              for after = (aref ways (+ i 7))
              do (run-carrier carrier fidelity
                              :steps 8 :start (goal 0 (+ 0.5d0 before 1d-13) 0 0)
                              :goal (goal 0 (+ 0.5d0 after) 0 0)
                              :fractions (map '(simple-array double-float (*))
                                              (lambda (way) (/ (- way before)
                                                               (max 1d-9 (- after before))))
                                              (subseq ways i (+ i 8)))))
        (is-true (bullet:attachment-live-p (carrier-attachment carrier)))
        (is (near (+ 0.9d0 0.2d0 0.2d0) 1d-6 (height (carrier-item carrier))))))))

(test motions-through-positions-are-smooth-curves
  (flet ((heights (fidelity)
           (with-carrier (carrier)
             (run-carrier carrier fidelity
                          :steps 100 :through (list (goal 0 0.6d0 0 0) (goal 0 0.6d0 0.2d0 0))
                          :goal (goal 0 0.5d0 0.2d0 0)
                          :fractions (map '(simple-array double-float (*))
                                          (lambda (way) (/ way 0.4d0)) (ramp 100 0.4d0 4)))
             (list (nth-value 1 (bullet:mechanism-posture (carrier-mechanism carrier)))
                   (bullet:body-pose (carrier-hand carrier))))))
    (let ((full (heights :full)) (fast (heights :fast)))
      (is (equalp (first full) (first fast)))
      (is (geometry:pose= (second full) (second fast))))))

;;; Contacts

(defun add-box (world name pose &rest options)
  (apply #'bullet:add-body world name '(:box 0.2d0 2 2) pose options))

(test motion-ends-before-a-contact
  (dolist (fidelity '(:full :fast))
    (with-carrier (carrier)
      (let* ((wall (add-box (carrier-world carrier) "wall" (geometry:make-pose 1.5d0 0 0)))
             (bodies (list (carrier-base carrier) (carrier-hand carrier) (carrier-item carrier)))
             (bases (straight-bases (ramp 800 2 1))))
        (multiple-value-bind (steps reason body obstacle)
            (run-carrier carrier fidelity :steps 800 :bases bases :watched bodies
                                          :obstacles (list wall))
          (is (eq :contact reason))
          (is (eq (carrier-item carrier) body))
          (is (eq wall obstacle))
          ;; The item's front is 0.59 m before the base.
          (is (near 0.81d0 5d-3 (distance (carrier-base carrier))))
          (is (<= (distance (carrier-base carrier)) 0.81d0))
          (is (near (round (* 240 (+ 1 0.31d0))) 2 steps))
          (is (near (/ steps 240) 1d-9 (bullet:world-time (carrier-world carrier)))))
        ;; The robot can go back.
        (let ((back (straight-bases (map '(simple-array double-float (*))
                                         (lambda (way) (- 0.8d0 way)) (ramp 800 0.5d0 1)))))
          (is (eq :done (nth-value 1 (run-carrier carrier fidelity
                                                  :steps 800 :bases back :watched bodies
                                                  :obstacles (list wall))))))))))

(test unwatched-and-ignored-bodies-do-not-stop-a-motion
  (dolist (fidelity '(:full :fast))
    (with-carrier (carrier)
      (let ((wall (add-box (carrier-world carrier) "wall" (geometry:make-pose 1.5d0 0 0)))
            (bases (straight-bases (ramp 800 2 1))))
        (bullet:ignore-collision wall (carrier-item carrier) t)
        (bullet:ignore-collision wall (carrier-hand carrier) t)
        (is (eq :done (nth-value 1 (run-carrier carrier fidelity
                                                :steps 300 :bases bases
                                                :watched (list (carrier-item carrier)
                                                               (carrier-hand carrier))
                                                :obstacles (list wall)))))))))

(test bodies-that-touch-at-the-start-may-part
  (dolist (fidelity '(:full :fast))
    (with-carrier (carrier :hold nil)
      (let* ((world (carrier-world carrier))
             (wall (add-box world "wall" (geometry:make-pose -0.3d0 0 1)))
             (base (carrier-base carrier)))
        (flet ((drive (way)
                 (run-carrier carrier fidelity :steps 200 :bases (straight-bases (ramp 200 way 1))
                                               :watched (list base) :obstacles (list wall))))
          (bullet:pose-mechanism (carrier-mechanism carrier) (geometry:identity-pose)
                                 (goal 0 0.5d0 0 0) :teleport t)
          (is (< 0 (bullet:penetration base wall) 1d-9))
          (is (eq :done (nth-value 1 (drive 0.3d0)))))))))

(test a-wider-contact-distance-stops-earlier
  (with-carrier (carrier)
    (let ((wall (add-box (carrier-world carrier) "wall" (geometry:make-pose 1.5d0 0 0))))
      (run-carrier carrier :fast :steps 800 :bases (straight-bases (ramp 800 2 1))
                                 :watched (list (carrier-item carrier)) :obstacles (list wall)
                                 :contact-distance 0.1d0)
      (is (near 0.71d0 5d-3 (distance (carrier-base carrier)))))))

(test moving-links-push-loose-bodies-in-both-fidelities
  (flet ((pushed (fidelity)
           (with-carrier (carrier :hold nil)
             (let* ((world (carrier-world carrier))
                    (cube (bullet:add-body world "cube" '(:box 0.1d0 0.1d0 0.1d0)
                                           (geometry:make-pose 0.7d0 0.05d0 0.05d0) :mass 1)))
               (bullet:step-world world 480)
               (is-true (bullet:asleep-p cube))
               (run-carrier carrier fidelity :steps 1000
                                             :bases (straight-bases (ramp 1000 1 1)))
               (bullet:body-pose cube)))))
    (let ((full (pushed :full)) (fast (pushed :fast)))
      (is (< 1.2d0 (geometry:pose-x full)))
      (is (> 1d-2 (pose-gap full fast)) "~a, but ~a" full fast))))

(test motions-are-bit-identical
  (flet ((state (fidelity)
           (with-carrier (carrier :capacity 5.05d0)
             (run-carrier carrier fidelity
                          :steps 1000 :bases (straight-bases (ramp 1000 1.5d0 1 :braking 3)))
             (bullet:state-hash (carrier-world carrier)))))
    (dolist (fidelity '(:full :fast))
      (let ((hash (state fidelity)))
        (is (every (lambda (other) (= hash other))
                   (mapcar #'sb-thread:join-thread
                           (loop repeat 4
                                 collect (sb-thread:make-thread #'state
                                                                :arguments (list fidelity))))))))))

(test motions-go-on-alike-from-a-checkpoint
  (dolist (fidelity '(:full :fast))
    (with-carrier (carrier)
      (let ((world (carrier-world carrier))
            (ways (ramp 400 0.4d0 1)))
        (flet ((go-on ()
                 (run-carrier carrier fidelity :steps 200 :goal (goal 0 0.9d0 0.3d0 0)
                                               :fractions (subseq ways 200))
                 (bullet:state-hash world)))
          (run-carrier carrier fidelity :steps 200 :goal (goal 0 0.8d0 1 0) :fractions ways)
          (let* ((checkpoint (bullet:make-checkpoint world))
                 (hash (go-on)))
            (bullet:restore-checkpoint world checkpoint)
            (is (= hash (go-on)))))))))

(test senseless-motions-are-refused
  (with-carrier (carrier)
    (signals bullet:bullet-error (run-carrier carrier :quick :steps 1))
    (signals bullet:bullet-error (run-carrier carrier :fast :steps -1))
    (signals bullet:bullet-error (run-carrier carrier :fast :steps 2 :bases (goal 0 0 0 0 0 0 1)))
    (signals bullet:bullet-error (run-carrier carrier :fast :steps 1 :bases (goal 0 0 0 0 0 0 2)))
    (signals bullet:bullet-error (run-carrier carrier :fast :steps 1 :goal (goal 1 2)))
    (signals bullet:bullet-error (run-carrier carrier :fast :steps 1 :contact-distance -1))
    (bullet:with-world (other)
      (signals bullet:bullet-error
        (run-carrier carrier :fast :steps 1 :watched (list (add-cube other :cube 0 0)))))
    (is (equal '(0 :done nil nil) (multiple-value-list (run-carrier carrier :fast :steps 0))))))

;;; Clearances

(test loose-bodies-that-are-awake-are-stepped
  (with-carrier (carrier)
    (let ((ball (bullet:add-body (carrier-world carrier) "ball" '(:sphere 0.05d0)
                                 (geometry:make-pose 0 3 1) :mass 1)))
      (run-carrier carrier :fast :steps 240)
      (is (near 0.05d0 1d-3 (height ball))))))

(test sleeping-bodies-beside-the-way-are-let-alone
  (flet ((asleep-p (fidelity)
           (with-carrier (carrier :hold nil)
             (let* ((world (carrier-world carrier))
                    (cube (bullet:add-body world "cube" '(:box 0.1d0 0.1d0 0.1d0)
                                           (geometry:make-pose 0.7d0 0.27d0 0.05d0) :mass 1)))
               (bullet:step-world world 480)
               (run-carrier carrier fidelity :steps 300 :bases (straight-bases (ramp 300 0.5d0 1)))
               (bullet:asleep-p cube)))))
    (is-false (asleep-p :full))
    (is-true (asleep-p :fast))))
