;;;; What does the way through Lisp and the shim cost?  Steps of a world with a robot of five links
;;;; that moves, and one item that stays awake on a bench, against steps.cpp, which is the same
;;;; scene and loop in plain C++.  Compare medians of runs in turn: a run of 100 000 steps takes
;;;; about a third of a second.

(in-package #:discrepancy-finder.bench)

(defconstant +links+ 5)

(declaim (inline link-pose))
(defun link-pose (link step)
  (declare (type (unsigned-byte 32) link step))
  (geometry:quaternion-pose (+ (* 0.25d0 link) (* 0.0001d0 (mod step 1000))) -0.5d0 0.5d0
                            0d0 0d0 0d0 1d0))

(defun build-scene (world)
  "Add the scene of steps.cpp to WORLD, in the same order; return the list of the robot's links."
  (bullet:add-body world :floor '(:plane 0 0 1 0) (geometry:identity-pose))
  (bullet:add-body world :bench '(:box 2.6d0 0.3d0 0.4d0) (geometry:make-pose 1 0.4d0 0.2d0))
  (prog1 (loop for link below +links+
               collect (bullet:add-body world link '(:box 0.1d0 0.1d0 0.2d0) (link-pose link 0)
                                        :kind :kinematic))
    (bullet:allow-sleep (bullet:add-body world :item '(:box 0.06d0 0.06d0 0.12d0)
                                         (geometry:make-pose 1 0.4d0 0.46d0) :mass 0.4d0)
                        nil)))

(declaim (inline step-scene))
(defun step-scene (world links number)
  (loop for link in links
        for i of-type (unsigned-byte 32) from 0
        ;; On the stack, as in C++: a pose from the heap would be a cache miss each time.
        do (let ((pose (link-pose i number)))
             (declare (dynamic-extent pose))
             (bullet:move-body link pose)))
  (bullet:step-world world))

(defun lisp-steps-per-second (n)
  "Return how many steps a second of processor time the scene makes through the Lisp API, over N
steps; as a second value the height (m) at which the item ends, to compare with steps.cpp."
  (declare (type (integer 1 1000000000) n))
  (bullet:with-world (world)
    (let ((links (build-scene world))
          (state (bullet:make-state-vector world)))
      (declare (type (simple-array double-float (*)) state))
      (dotimes (i 240) (step-scene world links i))
      (let ((start (foreign:processor-seconds)))
        (foreign:with-c-float-traps
          (dotimes (i n)
            (step-scene world links i)
            (bullet:read-state world state)))
        (values (/ n (- (foreign:processor-seconds) start))
                (aref state (+ 2 (* 13 (+ 2 +links+)))))))))

(defun plain-steps-per-second (n executable)
  "Return how many steps a second of processor time the program EXECUTABLE, made of steps.cpp,
makes over N steps; as a second value the height (m) at which the item ends.  Signals an error if
the program fails."
  (multiple-value-bind (output height)
      (uiop:run-program (list (uiop:native-namestring executable) (princ-to-string n))
                        :output :string :error-output :string)
    (let ((*read-default-float-format* 'double-float) (*read-eval* nil))
      (values (read-from-string output)
              (read-from-string height t nil :start (length "height "))))))
