;;;; Worlds: making, closing, stepping.
;;;;
;;;; A WORLD owns its foreign world through a HANDLE, which the finalizer shares with it: whoever
;;;; opens the handle's lock first, CLOSE-WORLD or the garbage collector, deletes the foreign world,
;;;; once.  WITH-WORLD is the way to have a world; the finalizer is for those that got lost, and
;;;; knows nothing of the megabyte that hangs on each.  A foreign world does not survive in a saved
;;;; image: a handle of another session counts as closed.
;;;;
;;;; All calls go through INVOKE, which keeps the world alive meanwhile, lets no interrupt unwind
;;;; through Bullet, and turns statuses into conditions.

(in-package #:discrepancy-finder.bullet)

(sb-ext:defglobal **session** (list :session))
(declaim (type list **session**))

(defun begin-session ()
  (setf **session** (list :session)))

(pushnew 'begin-session sb-ext:*init-hooks*)

(defstruct (handle (:constructor make-handle (pointer session)) (:copier nil) (:predicate nil))
  (pointer nil :type sb-sys:system-area-pointer :read-only t)
  (session nil :type list :read-only t)
  (open t :type (member t nil)))

(defun handle-usable-p (handle)
  (and (handle-open handle) (eq (handle-session handle) **session**)))

(defstruct (shape-handle (:include handle) (:constructor make-shape-handle (pointer session))
                         (:copier nil))
  (moments nil :type (or null (simple-array double-float (13)))))  ; see inertia.lisp

(defun release (handle)
  "Delete the foreign world or shape of HANDLE unless it was deleted already."
  (when (and (handle-usable-p handle)
             (eq t (sb-ext:compare-and-swap (handle-open handle) t nil)))
    (if (shape-handle-p handle)
        (%shape-delete (handle-pointer handle))
        (%world-delete (handle-pointer handle)))))

(defstruct (world (:constructor %make-world (handle time-step)) (:copier nil))
  "A rigid-body world with gravity, bodies and attachments, which advances in equal time steps."
  (handle nil :type handle :read-only t)
  (time-step 0d0 :type double-float :read-only t)
  (steps 0 :type (and fixnum unsigned-byte))
  (body-vector (make-array 16 :adjustable t :fill-pointer 0) :type vector :read-only t)
  (body-names (make-hash-table :test #'equal) :type hash-table :read-only t)
  (attachment-vector (make-array 4 :adjustable t :fill-pointer 0) :type vector :read-only t)
  (joint-vector (make-array 4 :adjustable t :fill-pointer 0) :type vector :read-only t))

(setf (documentation 'world-time-step 'function) "Return the time step of WORLD (s).")

(defmethod print-object ((world world) stream)
  (print-unreadable-object (world stream :type t :identity t)
    (if (handle-usable-p (world-handle world))
        (format stream "~d bod~:@p at ~,3f s" (length (world-body-vector world)) (world-time world))
        (write-string "closed" stream))))

(declaim (inline live-pointer))
(defun live-pointer (world operation)
  "Return the foreign pointer of WORLD, or signal that OPERATION has no open world."
  (let ((handle (world-handle world)))
    (if (and (handle-open handle) (eq (handle-session handle) **session**))
        (handle-pointer handle)
        (fail operation "the world is closed"))))

(defmacro uninterrupted (call)
  "Return the value of CALL, out of which no interrupt may unwind.  SBCL's own WITHOUT-INTERRUPTS
also provides for unwinding by CALL itself, which cannot be, at twice the price of a foreign call."
  `(if sb-sys:*interrupts-enabled*
       (prog1 (let ((sb-sys:*interrupts-enabled* nil)) ,call)
         (when sb-sys:*interrupt-pending*
           (sb-unix::receive-pending-interrupt)))
       ,call))

(defmacro invoke ((operation pointer world) call &body reasons)
  "Return the value of CALL: a call of the shim in which POINTER is the foreign world of WORLD, with
the bookkeeping that no interrupt may separate from it.  A negative value is signaled as a
BULLET-ERROR of OPERATION.  REASONS are clauses (status form...) for the statuses that need other
words than the usual ones; their forms return a string, or the value of the whole form when the
status is :NOTHING."
  (let ((owner (gensym "WORLD")) (status (gensym "STATUS")) (name (gensym "NAME"))
        (nothing (assoc :nothing reasons)))
    `(let* ((,owner ,world)
            (,pointer (live-pointer ,owner ,operation))
            (,status (sb-sys:with-pinned-objects (,owner)
                       (uninterrupted ,call))))
       (declare (type (signed-byte 32) ,status))
       (cond ((>= ,status 0) ,status)
             ,@(when nothing `(((= ,status -9) ,@(rest nothing))))
             (t (let ((,name (status-name ,status)))
                  (fail ,operation "~a"
                        (case ,name
                          ,@(remove nothing reasons)
                          (t (usual-reason ,name))))))))))

(defun usual-reason (status)
  (ecase status
    (:bad-world "the world is closed")
    (:bad-body "the bodies are not two bodies of this world")
    (:bad-shape "the shape cannot be used in this way")
    (:bad-constraint "the attachment or joint is not there any more")
    (:bad-number "a number is out of range")
    (:bad-kind "the kind of the body does not allow it")
    (:too-small "the vector is too short")
    (:no-memory "the memory is used up")
    (:bad-checkpoint "the checkpoint is not one of such a world")
    (:bad-link "the link, or one of the joints, is none of the mechanism")))

(declaim (inline in-range-p number-of))
(defun in-range-p (number sort)
  (declare (type double-float number))
  (and (not (sb-ext:float-nan-p number))
       (<= (abs number) 1d9)
       (ecase sort
         (:finite t)
         (:positive (>= number 1d-30))  ; whose square, cube and reciprocal are finite numbers, too
         (:not-negative (>= number 0d0))
         (:fraction (<= 0d0 number 1d0)))))

(defun converted-number (thing value operation sort)
  "Return what NUMBER-OF does for a VALUE that is no double float in the range of SORT."
  (let ((number (typecase value
                  (single-float (unless (or (sb-ext:float-nan-p value)
                                            (sb-ext:float-infinity-p value))
                                  (geometry:decimal-double value)))
                  ((rational -1000000000 1000000000) (geometry:decimal-double value)))))
    (if (and number (in-range-p number sort))
        number
        (fail operation "~a is ~s, but must be ~a" (described thing) value
              (ecase sort
                (:finite "a number of at most 1e9 in magnitude")
                (:positive "a positive number, from 1e-30 to 1e9")
                (:not-negative "a number from 0 to 1e9")
                (:fraction "a number from 0 to 1"))))))

(defun number-of (thing value operation &optional (sort :finite))
  "Return the real VALUE as a double float, by GEOMETRY:DECIMAL-DOUBLE.  If it is not of SORT,
signal that OPERATION got it for THING, a string or what DESCRIBED takes."
  (if (and (typep value 'double-float) (in-range-p value sort))
      value
      (converted-number thing value operation sort)))

(defun make-world (&key (gravity -9.81d0) (time-step 1/240))
  "Return a new, empty world with GRAVITY (m/s^2) along z that advances by TIME-STEP (s) at each
step.  Close it with CLOSE-WORLD, or use WITH-WORLD.  Signals BULLET-ERROR if GRAVITY is not finite
or TIME-STEP not positive."
  (let* ((gravity (number-of "the gravity" gravity 'make-world))
         (time-step (number-of "the time step" time-step 'make-world :positive))
         (pointer (%world-new gravity time-step)))
    (when (cffi:null-pointer-p pointer)
      (fail 'make-world "the memory is used up"))
    (let* ((handle (make-handle pointer **session**))
           (world (%make-world handle time-step)))
      (sb-ext:finalize world (lambda () (release handle)) :dont-save t)
      world)))

(defun close-world (world)
  "Free the foreign part of WORLD.  Closing twice is harmless; any other use of a closed world
signals BULLET-ERROR."
  (sb-sys:without-interrupts (release (world-handle world)))
  (sb-ext:cancel-finalization world)
  (values))

(defmacro with-world ((variable &rest options) &body body)
  "Evaluate BODY with VARIABLE bound to a new world, which is closed afterwards.  OPTIONS are those
of MAKE-WORLD."
  (let ((world (gensym "WORLD")))
    `(let* ((,world (make-world ,@options))
            (,variable ,world))
       (unwind-protect (progn ,@body)
         (close-world ,world)))))

(defun world-time (world)
  "Return how long WORLD has been stepped (s)."
  (* (world-steps world) (world-time-step world)))

(defun world-bodies (world)
  "Return the list of the bodies of WORLD, in the order in which they were added."
  (coerce (world-body-vector world) 'list))

(defun find-body (world name)
  "Return the body of WORLD whose name is EQUAL to NAME, or NIL."
  (values (gethash name (world-body-names world))))

(defconstant +steps-a-call+ 1000
  "An interrupt has to wait for the end of a foreign call, so that no call may take long.")

(defun step-world (world &optional (steps 1))
  "Advance WORLD by a number of STEPS, each of its time step; return WORLD.  One foreign call for up
to 1000 steps.  Signals BULLET-ERROR if WORLD is closed."
  (declare (optimize speed (safety 1)) (type (and fixnum unsigned-byte) steps))
  (loop for left of-type fixnum = steps then (- left +steps-a-call+)
        for count of-type fixnum = (min left +steps-a-call+)
        do (invoke ('step-world pointer world)
               (prog1 (%step pointer count)
                 (incf (world-steps world) count)))
        while (> left +steps-a-call+))
  world)
