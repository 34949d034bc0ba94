;;;; A plan of fifteen actions in the kitchen: its time at both fidelities, against transport.cpp, a
;;;; peer in plain C++ on Bullet.
;;;;
;;;; The robot finds three items on the workspace, one after the other, picks each up and delivers
;;;; it to the table; it drives to a drawer, opens it, does the same with the spoon in it, and
;;;; closes the drawer.  The peer has the same scene and as many steps for each action, as this plan
;;;; says, but plans nothing: no inverse kinematics, no path, no test for collisions.  All times are
;;;; processor time, for the machine may have other users.

(in-package #:discrepancy-finder.bench)

(defun kitchen-scene ()
  (projection:load-scene (asdf:system-relative-pathname "discrepancy-finder"
                                                        "models/kitchen/scene.lisp")))

;;; The plan

(defparameter *deliveries*
  '((:bowl (-1.3 -0.6) (0.35 -0.6 0.7885))
    (:cereal (-1.3 -0.2) (0.35 -0.25 0.867))
    (:milk (-1.3 0.1) (0.35 0.1 0.852))
    (:spoon (-1.1 0.3) (0.35 0.5 0.7645)))
  "For each item where the robot stands to pick it up (x y) and where it is placed (x y z).")

(plan:def-cram-function stand-at (x y yaw)
  "Drive to X, Y, facing YAW."
  (let ((?pose (geometry:make-pose x y 0 :yaw yaw)))
    (plan:perform (plan:a motion (type going) (pose ?pose)))))

(plan:def-cram-function find-item (?type x y ?place)
  "Stand at X, Y before the counter and look at ?PLACE; return the object of ?TYPE there."
  (stand-at x y pi)
  (plan:perform (plan:a motion (type looking) (pose ?place)))
  (plan:perform (plan:a motion (type detecting) (object (plan:an object (type ?type))))))

(plan:def-cram-function pick-up (?object)
  "Pick up ?OBJECT and hold it close."
  (plan:perform (plan:an action (type picking-up) (object ?object) (arm :left)))
  (plan:perform (plan:an action (type parking-arms))))

(plan:def-cram-function deliver (?object x y z)
  "Carry ?OBJECT to the table, place it at X, Y, Z, and go back to an arm's rest."
  (stand-at -0.4 (- y 0.1) 0)
  (let ((?pose (geometry:make-pose x y z)))
    (plan:perform (plan:an action (type placing) (object ?object) (arm :left)
                           (target (plan:a location (pose ?pose))))))
  (plan:perform (plan:an action (type parking-arms))))

(plan:def-cram-function open-or-close (?type)
  "Open the drawer with the spoon, or close it: ?TYPE says which."
  (plan:perform (plan:an action (type ?type)
                         (object (plan:an object (type drawer) (name drawer-2)))))
  (plan:perform (plan:an action (type parking-arms))))

(plan:def-top-level-cram-function transport (projection note)
  "Carry all items to the table; call NOTE after each of the fifteen actions."
  (flet ((transport-one (entry)
           (destructuring-bind (type (x y) (to-x to-y to-z)) entry
             (let ((object (find-item type x y (projection:observed-pose projection type))))
               (funcall note)
               (pick-up object)
               (funcall note)
               (deliver object to-x to-y to-z)
               (funcall note)))))
    (mapc #'transport-one (butlast *deliveries*))
    (stand-at -1.1 0.3 pi)
    (funcall note)
    (open-or-close :opening)
    (funcall note)
    (transport-one (first (last *deliveries*)))
    (stand-at -1.1 0.3 pi)
    (open-or-close :closing)
    (funcall note)))

;;; Measuring

(defstruct (transport-run (:copier nil))
  "SECONDS of processor time of all and of making the world, BYTES that were allocated, STEPS a list
of the steps of each action, DELIVERED how many items are on the table, HASH of the final state."
  seconds world-seconds bytes steps delivered hash)

(defun world-steps (projection)
  (round (* 240 (projection:simulated-seconds projection))))

(defun delivered-items (projection)
  (loop for (type nil (x y z)) in *deliveries*
        for pose = (projection:observed-pose projection type)
        count (< (+ (abs (- x (geometry:pose-x pose))) (abs (- y (geometry:pose-y pose)))
                    (abs (- z (geometry:pose-z pose))))
                 0.1)))

(defun run-transport (scene fidelity)
  "Run the plan in a new projection of SCENE at FIDELITY and return a TRANSPORT-RUN."
  (let* ((start (foreign:processor-seconds))
         (bytes (sb-ext:get-bytes-consed))
         (projection (projection:make-projection scene :fidelity fidelity))
         (made (foreign:processor-seconds))
         (noted '()))
    (unwind-protect
         (flet ((note ()
                  (push (world-steps projection) noted)))
           (projection:settle projection)
           (note)
           (plan:with-executive (projection)
             (transport projection #'note))
           (let ((end (foreign:processor-seconds))
                 (steps (reverse noted)))
             (make-transport-run :seconds (- end start) :world-seconds (- made start)
                                 :bytes (- (sb-ext:get-bytes-consed) bytes)
                                 :steps (mapcar #'- (rest steps) steps)
                                 :delivered (delivered-items projection)
                                 :hash (projection:state-hash projection))))
      (projection:close-projection projection))))

(defun run-peer (steps program)
  "Run the peer PROGRAM with STEPS, a list, for its actions.  Return its seconds of processor time,
those of making the world, how many steps it made and how many items it delivered."
  (let ((output (uiop:run-program (list* (uiop:native-namestring program)
                                         (mapcar #'princ-to-string steps))
                                  :output :string))
        (*read-default-float-format* 'double-float)
        (*read-eval* nil))
    (with-input-from-string (stream output)
      (values (read stream) (read stream) (read stream) (read stream)))))

(defun world-microseconds (scene &key (rounds 31))
  "Return the median processor time (us) of making, and closing, a world with the kitchen of SCENE."
  (median (loop repeat rounds
                collect (let ((start (foreign:processor-seconds)))
                          (projection:close-projection (projection:make-projection scene))
                          (* 1d6 (- (foreign:processor-seconds) start))))))

(defun print-transport-benchmarks (stream &key (rounds 9))
  "Run the plan in turn at both fidelities and by the peer, and print the medians."
  (let* ((program (compiled-peer "transport"))
         (scene (kitchen-scene))
         (first (run-transport scene :full))
         (full '()) (fast '()) (peer '()) (peer-steps 0))
    (run-transport scene :fast)
    (loop repeat rounds
          do (push (run-transport scene :full) full)
             (push (run-transport scene :fast) fast)
             (multiple-value-bind (seconds world-seconds steps)
                 (run-peer (transport-run-steps first) program)
               (declare (ignore world-seconds))
               (push seconds peer)
               (setf peer-steps steps)))
    (flet ((milliseconds (runs) (* 1d3 (median (mapcar #'transport-run-seconds runs)))))
      (format stream "kitchen, 15 actions       ~,1f ms fully stepped (~d steps), ~,1f ms in plain ~
                      C++ (~d steps), time ratio ~,3f~%"
              (milliseconds full) (reduce #'+ (transport-run-steps first)) (* 1d3 (median peer))
              peer-steps
              (median (mapcar (lambda (run seconds) (/ (transport-run-seconds run) seconds))
                              full peer)))
      (format stream "the same, fast            ~,1f ms, ~,1f MB allocated (full ~,1f MB), ~d of 4 ~
                      items delivered (full ~d)~%"
              (milliseconds fast) (/ (transport-run-bytes (first fast)) 1d6)
              (/ (transport-run-bytes first) 1d6) (transport-run-delivered (first fast))
              (transport-run-delivered first))
      (format stream "state hashes              ~(~16,'0x~) fast, ~(~16,'0x~) full, ~:[differing~;~
                      equal~] in all ~d rounds~%"
              (transport-run-hash (first fast)) (transport-run-hash first)
              (flet ((same-p (runs) (= 1 (length (remove-duplicates
                                                  (mapcar #'transport-run-hash runs))))))
                (and (same-p fast) (same-p (cons first full))))
              rounds)
      (format stream "a world with the kitchen  ~,2f ms~%" (/ (world-microseconds scene) 1d3)))))
