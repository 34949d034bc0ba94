;;;; Whatever a function of the Bullet layer gets, it works or signals BULLET-ERROR or TYPE-ERROR,
;;;; and what it refused changed nothing: each argument of each call in a table is replaced by each
;;;; of a list of odd values.

(in-package #:discrepancy-finder.tests)

(def-suite refusals :in bullet)
(in-suite refusals)

(defun doubles (&rest numbers)
  (map '(simple-array double-float (*)) (lambda (number) (float number 1d0)) numbers))

(defun things-of-a-world ()
  "Return a plist of a new world and of things in it."
  (let* ((world (bullet:make-world))
         (a (add-cube world :a 0 0.05d0))
         (b (bullet:add-body world :b '(:sphere 0.1d0) (at 1 0 0.1d0) :mass 1))
         (hand (bullet:add-body world :hand '(:box 0.1d0 0.1d0 0.1d0) (at 0 2 0.3d0)
                                :kind :kinematic))
         (held (bullet:add-body world :held '(:cylinder 0.05d0 0.2d0) (at 0 2 0.45d0) :mass 1)))
    (add-floor world)
    (list :world world :a a :b b :hand hand :as (list a)
          :hold (bullet:attach hand held :capacity 10)
          :slider (bullet:add-joint world :slider nil b (at 1 0 0.1d0) :lower 0 :upper 1 :name :s)
          :robot (bullet:make-mechanism
                  world (list (bullet:link-spec :arm nil :revolute (geometry:identity-pose)
                                                '(0 0 1) -2 2 nil hand)))
          :checkpoint (bullet:make-checkpoint world)
          :pose (at 0 0 3) :to (at 1 0 3) :positions (doubles 0) :box '(:box 1 1 1)
          :base-poses (doubles 0 0 3 0 0 0 1) :parts (doubles 0.5d0)
          :rays (doubles 0 0 3 0 0 -1) :states (bullet:make-state-vector world))))

;;; All other keywords in the table are names of keyword arguments.
(defparameter *replaced-keywords*
  '(:world :a :b :as :hand :hold :slider :robot :checkpoint :pose :to :positions :box :base-poses
    :parts :rays :states :hinge :six-dof :revolute :full))

(defparameter *calls-of-the-bullet-layer*
  '((bullet:make-world :gravity 1 :time-step 1) (bullet:step-world :world 1)
    (bullet:find-body :world 1)
    (bullet:add-body :world 1 :box :pose :mass 1 :inertia (1 1 1) :inertial-pose :pose
     :friction 1 :rolling-friction 0 :restitution 0 :linear-damping 0 :angular-damping 0)
    (bullet:add-body :world 1 :box :pose :mass 1) (bullet:body-pose :a) (bullet:body-velocity :a)
    (bullet:move-body :hand :pose) (bullet:place-body :a :pose) (bullet:wake :a)
    (bullet:allow-sleep :a t) (bullet:asleep-p :a) (bullet:ignore-collision :a :b t)
    (bullet:convex-hull ((0 0 0) (1 0 0) (0 1 0) (0 0 1)) :vertices 4)
    (bullet:shape-volume :box) (bullet:shape-inertia :box 1) (bullet:mass-properties :box 1)
    (bullet:principal-axes 1 1 1 0 0 0)
    (bullet:attach :hand :a :point :pose :axis (0 1 0) :capacity 10 :torsion-radius 1)
    (bullet:detach :hold) (bullet:attachments :world) (bullet:attachment-load :hold)
    (bullet:attachment-utilization :hold) (bullet:read-state :world :states)
    (bullet:state-hash :world) (bullet:at-rest-p :world) (bullet:penetration :a :b)
    (bullet:deepest-penetration :world)
    (bullet:add-joint :world 1 :hand :a :pose :lower 0 :upper 1)
    (bullet:add-joint :world :hinge nil :a :pose :lower 0 :upper 1 :name 1)
    (bullet:add-joint :world :six-dof :hand :a :pose :linear (nil nil nil) :angular (nil nil nil))
    (bullet:remove-joint :slider) (bullet:joint-position :slider)
    (bullet:set-joint-position :slider 0.5d0) (bullet:set-motor :slider 1 1)
    (bullet:joint-load :slider) (bullet:pair-distance :a :b 1)
    (bullet:touching-p :a :b :distance 1) (bullet:contacts :a :distance 1 :passed :as)
    (bullet:clearance :as :as 1) (bullet:sweep :world :box :pose :to :passed :as)
    (bullet:make-checkpoint :world) (bullet:restore-checkpoint :world :checkpoint)
    (bullet:make-mechanism :world ()) (bullet:link-spec 1 0 :revolute :pose (1 0 0) 0 1 nil :hand)
    (bullet:pose-mechanism :robot :pose :positions :teleport t) (bullet:link-pose :robot 0)
    (bullet:forward-kinematics :robot :pose :positions 0)
    (bullet:inverse-kinematics :robot :base :pose :link 0 :tool :pose :target :to :joints (0)
     :start :positions :restarts 1 :tolerance 1 :attempt 0 :count 1)
    (bullet:run-motion :robot :steps 1 :bases :base-poses :fractions :parts :start :positions
     :through () :goal :positions :fidelity :full :watched :as :obstacles :as
     :contact-distance 1)
    (bullet:mechanism-clearance :robot :pose :positions :as :as 1)
    (bullet:path-contact :robot :pose :positions :positions :as :as :contact-distance 1)
    (bullet:cast-ray :world :pose :to :passed :as) (bullet:cast-rays :world :rays :passed :as)))

(defun odd-values (other closed)
  "Return values that few calls can use, among them the things of an OTHER and of a CLOSED world."
  (let ((infinity sb-ext:double-float-positive-infinity)
        (nan (sb-kernel:make-double-float -524288 0)))
    (append
     (list nil t -1 0 1/3 1d-320 1d-200 1d308 infinity nan (expt 10 400) (/ (expt 10 400))
           #c(1 2) "x" :foo #'car '(1 . 2) (circular 1) (circular '(0 0 1)) (list nan 0 0)
           #() (doubles nan) (doubles 1d9) (doubles 1d308 0) (doubles 0 0 0 0 0 0)
           most-positive-fixnum (expt 2 31) (expt 2 64)
           (geometry:quaternion-pose nan 0d0 0d0 0d0 0d0 0d0 1d0)
           (geometry:quaternion-pose 0d0 0d0 0d0 0d0 0d0 0d0 0d0)
           (geometry:quaternion-pose 1d308 0d0 0d0 0d0 infinity 0d0 1d0)
           '(:box 0 1 1) '(:box 1 1 . 1) '(:box 1d-300 1d-300 1d-300) (list :sphere nan)
           '(:plane 0 0 1 0) '(:hull (0 0 0) (1 0 0) (0 1 0) (1 1 0))
           (cons :hull (circular '(0 0 1)))
           (cons :compound (circular (list (geometry:identity-pose) '(:sphere 1)))))
     (loop for key in '(:world :a :as :hand :hold :slider :robot :checkpoint)
           collect (getf other key)
           collect (getf closed key)))))

(defun what-happened (call index value)
  "Do CALL with VALUE as its argument INDEX; return NIL if that is right, else what happened."
  (let* ((things (things-of-a-world))
         (world (getf things :world))
         (arguments (loop for argument in (rest call)
                          collect (getf things argument argument)))
         (before (bullet:state-hash world)))
    (setf (nth index arguments) value)
    (unwind-protect
         (handler-case (apply (first call) arguments)
           ((or bullet:bullet-error type-error) (condition)
             (princ-to-string condition)
             (and (/= before (bullet:state-hash world)) :changed))
           (error (condition) (type-of condition))
           (:no-error (&rest values)
             (declare (ignore values))
             (bullet:step-world world 5)
             (and (some (lambda (number)
                          (or (sb-ext:float-nan-p number) (sb-ext:float-infinity-p number)))
                        (bullet:read-state world (bullet:make-state-vector world)))
                  :not-finite)))
      (bullet:close-world world))))

(defun replaceable-p (call index)
  "Return true unless the argument INDEX of CALL is a key, or how many steps there are to do."
  (let ((argument (nth index (rest call))))
    (not (or (and (eq (first call) 'bullet:step-world) (= index 1))
             (and (keywordp argument)
                  (not (member argument *replaced-keywords*)))))))

(test odd-arguments-are-refused
  (let* ((other (things-of-a-world))
         (closed (things-of-a-world))
         (values (odd-values other closed)))
    (bullet:close-world (getf closed :world))
    (dolist (call *calls-of-the-bullet-layer*)
      (is (null (loop for index below (length (rest call))
                      when (replaceable-p call index)
                        append (loop for value in values
                                     for number from 0
                                     for outcome = (what-happened call index value)
                                     when outcome
                                       collect (list (first call) index number outcome))))))
    (bullet:close-world (getf other :world))))

(test conditions-print-whatever-was-wrong
  (bullet:with-world (world)
    (flet ((text (mass pose)
             (handler-case (bullet:add-body world :a '(:box 1 1 1) pose :mass mass)
               (bullet:bullet-error (condition) (princ-to-string condition)))))
      (is (search "#1=(1 . #1#)" (text (circular 1) (geometry:identity-pose))))
      (is (search "the pose for body A"
                  (text 1 (geometry:quaternion-pose sb-ext:double-float-positive-infinity
                                                    0d0 0d0 0d0 0d0 0d0 1d0))))
      (is (search "INFINITY" (princ-to-string
                              (geometry:quaternion-pose
                               sb-ext:double-float-positive-infinity
                               0d0 0d0 0d0 0d0 0d0 1d0)))))))

(test a-tensor-of-zeros-has-principal-axes
  (is (equal '(0d0 0d0 0d0) (bullet:principal-axes 0 0 0 0 0 0))))

(test a-motion-that-is-refused-has-not-begun
  (let* ((things (things-of-a-world))
         (world (getf things :world))
         (before (bullet:state-hash world))
         (bases (make-array (* 7 2000) :element-type 'double-float :initial-element 0d0)))
    (loop for i below 2000
          do (setf (aref bases (+ 6 (* 7 i))) 1d0))
    (dolist (wrong (list 1d10 sb-ext:double-float-positive-infinity))
      (setf (aref bases (* 7 1500)) wrong)
      (signals bullet:bullet-error
        (bullet:run-motion (getf things :robot) :steps 2000 :bases bases :start (doubles 1))))
    (setf (aref bases (* 7 1500)) 0d0
          (aref bases (+ 6 (* 7 1500))) 2d0)
    (signals bullet:bullet-error
      (bullet:run-motion (getf things :robot) :steps 2000 :bases bases :start (doubles 1)))
    (is (= before (bullet:state-hash world)))
    (is (zerop (bullet:world-time world)))
    (bullet:close-world world)))
