;;;; Mechanisms: trees of links moved by forward kinematics, that is, robots.
;;;;
;;;; A mechanism is a vector of LINK-SPECs, parents first.  A link hangs on one joint, which has the
;;;; link's index: the joint's ORIGIN is its pose in the frame of the parent link (of the base, for
;;;; a link without parent), and its position turns the link about AXIS (rad) or shifts it along
;;;; AXIS (m).  POSITIONS are a vector of double floats, one for each joint; those of fixed joints
;;;; and of joints that mimic another one are not looked at.  A link may have a kinematic body,
;;;; whose pose is that of the link.  POSE-MECHANISM moves them all, in one foreign call.

(in-package #:discrepancy-finder.bullet)

(define-raw %mechanism-new "dfb_mechanism_new" :int
  (world :pointer) (count :int) (integers :pointer) (numbers :pointer))
(define-raw %mechanism-pose "dfb_mechanism_pose" :int
  (world :pointer) (mechanism :int) (base :pointer) (positions :pointer) (teleport :int))
(define-raw %mechanism-read "dfb_mechanism_read" :int
  (world :pointer) (mechanism :int) (base :pointer) (positions :pointer))
(define-raw %link-pose "dfb_link_pose" :int
  (world :pointer) (mechanism :int) (link :int) (pose :pointer))
(define-raw %forward-kinematics "dfb_forward_kinematics" :int
  (world :pointer) (mechanism :int) (base :pointer) (positions :pointer) (link :int)
  (pose :pointer))

(defstruct (link-spec
            (:constructor link-spec (name parent type origin
                                     &optional (axis '(1 0 0)) lower upper mimic body))
            (:copier nil))
  "A link of a mechanism and the joint that it hangs on."
  (name nil :read-only t)
  (parent nil :type (or null unsigned-byte) :read-only t)
  (type :fixed :type (member :fixed :revolute :continuous :prismatic) :read-only t)
  (origin nil :type geometry:pose :read-only t)
  (axis '(1 0 0) :type list :read-only t)
  (lower nil :type (or null real) :read-only t)
  (upper nil :type (or null real) :read-only t)
  (mimic nil :type list :read-only t)
  (body nil :type (or null body) :read-only t))

(setf (documentation 'link-spec 'function)
      "Return the description of a link for MAKE-MECHANISM.  PARENT is the index of the link's
parent, or NIL; TYPE that of the joint: :FIXED, :REVOLUTE, :CONTINUOUS or :PRISMATIC; ORIGIN the
joint's pose in the frame of the parent; AXIS a list of three numbers, not all zero, in the joint's
frame; LOWER and UPPER the joint's limits (rad or m), NIL for none; MIMIC is NIL or the list of the
index of another joint, a multiplier and an offset; BODY is NIL or a kinematic body."
      (documentation 'link-spec-name 'function) "Return the name of a link."
      (documentation 'link-spec-parent 'function)
      "Return the index of a link's parent, or NIL."
      (documentation 'link-spec-type 'function)
      "Return the type of a link's joint: :FIXED, :REVOLUTE, :CONTINUOUS or :PRISMATIC."
      (documentation 'link-spec-origin 'function)
      "Return the pose of a link's joint in the frame of its parent."
      (documentation 'link-spec-axis 'function)
      "Return the axis of a link's joint, a list of three numbers."
      (documentation 'link-spec-lower 'function)
      "Return the lower limit (rad or m) of a link's joint, or NIL."
      (documentation 'link-spec-upper 'function)
      "Return the upper limit (rad or m) of a link's joint, or NIL."
      (documentation 'link-spec-mimic 'function)
      "Return NIL or the list (index multiplier offset) of the joint that a link's joint mimics."
      (documentation 'link-spec-body 'function)
      "Return the body of a link, or NIL.")

(defmethod print-object ((link link-spec) stream)
  (print-unreadable-object (link stream :type t)
    (format stream "~a ~(~a~)" (link-spec-name link) (link-spec-type link))))

(defstruct (mechanism (:constructor %make-mechanism (world id links)) (:copier nil))
  "A tree of links in a world."
  (world nil :type world :read-only t)
  (id 0 :type (signed-byte 32) :read-only t)
  (links nil :type simple-vector :read-only t)
  (base (make-array 7 :element-type 'double-float) :type (simple-array double-float (7))
   :read-only t)
  (result (make-array 7 :element-type 'double-float) :type (simple-array double-float (7))
   :read-only t))

(setf (documentation 'mechanism-world 'function) "Return the world of a mechanism."
      (documentation 'mechanism-links 'function)
      "Return the vector of the LINK-SPECs of a mechanism.")

(defmethod print-object ((mechanism mechanism) stream)
  (print-unreadable-object (mechanism stream :type t :identity t)
    (format stream "~d link~:p" (length (mechanism-links mechanism)))))

(deftype positions () '(simple-array double-float (*)))

;;; Making

(defconstant +link-integers+ 4)
(defconstant +link-numbers+ 14)

(defun unit-axis (axis name)
  "Return the list AXIS of three numbers, of the link NAME, as one of length 1."
  (unless (eql (ignore-errors (list-length axis)) 3)
    (fail 'make-mechanism "the axis ~s of link ~a is no list of three numbers" axis name))
  (let* ((numbers (loop for number in axis
                        collect (number-of (list "a number of the axis of link ~a" name) number
                                           'make-mechanism)))
         (length (sqrt (reduce #'+ (mapcar #'* numbers numbers)))))
    (when (< length 1d-9)
      (fail 'make-mechanism "the axis of link ~a has no direction" name))
    (mapcar (lambda (number) (/ number length)) numbers)))

(defun link-integers (link world name)
  "Return the list of the integers that the shim wants to know of LINK."
  (let ((mimic (link-spec-mimic link))
        (body (link-spec-body link)))
    (when (and mimic (not (and (eql (ignore-errors (list-length mimic)) 3)
                               (typep (first mimic) '(unsigned-byte 31)))))
      (fail 'make-mechanism "~s, which link ~a mimics, is no (index multiplier offset)"
            mimic name))
    (when (and body (not (eq (body-world body) world)))
      (fail 'make-mechanism "body ~a of link ~a is of another world" (body-name body) name))
    (list (or (link-spec-parent link) -1)
          (ecase (link-spec-type link) (:fixed 0) ((:revolute :continuous) 1) (:prismatic 2))
          (if mimic (first mimic) -1)
          (if body (body-id body) -1))))

(defun link-numbers (link name)
  "Return the list of the double floats that the shim wants to know of LINK."
  (flet ((limit (value which none)
           (if (and value (not (eq (link-spec-type link) :continuous)))
               (number-of (list "the ~a limit of link ~a" which name) value 'make-mechanism)
               none))
         (mimicked (value what)
           (number-of (list "the ~a of link ~a" what name) value 'make-mechanism)))
    (destructuring-bind (&optional (index 0) (multiplier 1d0) (offset 0d0)) (link-spec-mimic link)
      (declare (ignore index))
      (let ((lower (limit (link-spec-lower link) "lower"
                          sb-ext:double-float-negative-infinity))
            (upper (limit (link-spec-upper link) "upper"
                          sb-ext:double-float-positive-infinity)))
        (when (> lower upper)
          (fail 'make-mechanism "the lower limit of link ~a is above the upper one" name))
        (append (geometry:pose-components (link-spec-origin link))
                (unit-axis (link-spec-axis link) name)
                (list lower upper (mimicked multiplier "multiplier")
                      (mimicked offset "offset")))))))

(defun make-mechanism (world links)
  "Return a new mechanism in WORLD of LINKS, a sequence of LINK-SPECs, parents first.  Its joints
are at 0; no body is moved.  Signals BULLET-ERROR, which names the link, if the links are no tree, a
body is not a kinematic one of WORLD, or a number is out of range."
  (check-length links 'make-mechanism)
  (let* ((links (coerce links 'simple-vector))
         (count (length links))
         (integers (make-array (* +link-integers+ count) :element-type '(signed-byte 32)))
         (numbers (make-array (* +link-numbers+ count) :element-type 'double-float)))
    (when (zerop count)
      (fail 'make-mechanism "a mechanism has at least one link"))
    (loop for link across links
          for i from 0
          do (unless (link-spec-p link)
               (fail 'make-mechanism "~s is no link-spec" link))
             (let ((parent (link-spec-parent link))
                   (name (link-spec-name link)))
               (when (and parent (>= parent i))
                 (fail 'make-mechanism "link ~a stands before its parent, number ~d" name parent))
               (replace integers (link-integers link world name) :start1 (* +link-integers+ i))
               (replace numbers (link-numbers link name) :start1 (* +link-numbers+ i))))
    (%make-mechanism
     world
     (cffi:with-pointer-to-vector-data (integers-pointer integers)
       (cffi:with-pointer-to-vector-data (numbers-pointer numbers)
         (invoke ('make-mechanism pointer world)
             (%mechanism-new pointer count integers-pointer numbers-pointer)
           (:bad-link "a joint mimics one that is none or mimics another one itself")
           (:bad-number "the origin of a joint is not a finite position with a unit quaternion")
           (:bad-kind "the body of a link is not kinematic"))))
     links)))

(defun link-index (mechanism name)
  "Return the index of the link of MECHANISM whose name is EQUAL to NAME, or NIL."
  (position name (mechanism-links mechanism) :key #'link-spec-name :test #'equal))

(defun make-positions (mechanism)
  "Return a new vector of positions for the joints of MECHANISM, all 0."
  (make-array (length (mechanism-links mechanism)) :element-type 'double-float
                                                   :initial-element 0d0))

;;; Forward kinematics

(declaim (inline read-pose))
(defun read-pose (numbers)
  (declare (type (simple-array double-float (7)) numbers))
  (geometry:quaternion-pose (aref numbers 0) (aref numbers 1) (aref numbers 2) (aref numbers 3)
                            (aref numbers 4) (aref numbers 5) (aref numbers 6)))

(defun check-positions (mechanism positions operation)
  (unless (and (typep positions 'positions)
               (= (length positions) (length (mechanism-links mechanism))))
    (fail operation "the positions are no vector of ~d double floats"
          (length (mechanism-links mechanism)))))

(defun bad-posture ()
  "the base is not a finite position with a unit quaternion, or a joint's position is not finite")

(defun pose-mechanism (mechanism base positions &key teleport)
  "Move the bodies of the links of MECHANISM to where the pose BASE and the POSITIONS of the joints
put them, as MOVE-BODY does; with TELEPORT as PLACE-BODY does, and with them what is attached to
them.  Return MECHANISM.  Limits of joints are not looked at.  Signals BULLET-ERROR if BASE or
POSITIONS are not finite."
  (declare (type mechanism mechanism) (type geometry:pose base))
  (check-positions mechanism positions 'pose-mechanism)
  (let ((numbers (write-pose base (mechanism-base mechanism))))
    (declare (type positions positions))
    (cffi:with-pointer-to-vector-data (base-pointer numbers)
      (cffi:with-pointer-to-vector-data (positions-pointer positions)
        (invoke ('pose-mechanism pointer (mechanism-world mechanism))
            (%mechanism-pose pointer (mechanism-id mechanism) base-pointer positions-pointer
                             (if teleport 1 0))
          (:bad-number (bad-posture))))))
  mechanism)

(defun mechanism-posture (mechanism)
  "Return where POSE-MECHANISM or RUN-MOTION last put MECHANISM: the pose of its base and a new
vector of the positions of its joints; those of joints that mimic another one are what follows from
it.  Signals BULLET-ERROR if the world is closed."
  (let ((base (mechanism-base mechanism))
        (positions (make-positions mechanism)))
    (cffi:with-pointer-to-vector-data (base-pointer base)
      (cffi:with-pointer-to-vector-data (positions-pointer positions)
        (invoke ('mechanism-posture pointer (mechanism-world mechanism))
            (%mechanism-read pointer (mechanism-id mechanism) base-pointer positions-pointer))))
    (values (read-pose base) positions)))

(defun link-pose (mechanism index)
  "Return the pose of the link INDEX of MECHANISM in the world, as of the last POSE-MECHANISM or
RUN-MOTION.  Signals BULLET-ERROR if there is no such link."
  (declare (type mechanism mechanism) (type (signed-byte 31) index))
  (let ((result (mechanism-result mechanism)))
    (cffi:with-pointer-to-vector-data (result-pointer result)
      (invoke ('link-pose pointer (mechanism-world mechanism))
          (%link-pose pointer (mechanism-id mechanism) index result-pointer)))
    (read-pose result)))

(defun forward-kinematics (mechanism base positions index)
  "Return the pose in the world that the link INDEX of MECHANISM would have with its base at the
pose BASE and the joints at POSITIONS.  Signals BULLET-ERROR if there is no such link or a number is
not finite."
  (declare (type mechanism mechanism) (type geometry:pose base) (type (signed-byte 31) index))
  (check-positions mechanism positions 'forward-kinematics)
  (let ((numbers (write-pose base (mechanism-base mechanism)))
        (result (mechanism-result mechanism)))
    (declare (type positions positions))
    (cffi:with-pointer-to-vector-data (base-pointer numbers)
      (cffi:with-pointer-to-vector-data (positions-pointer positions)
        (cffi:with-pointer-to-vector-data (result-pointer result)
          (invoke ('forward-kinematics pointer (mechanism-world mechanism))
              (%forward-kinematics pointer (mechanism-id mechanism) base-pointer
                                   positions-pointer index result-pointer)
            (:bad-number (bad-posture))))))
    (read-pose result)))
