;;;; Shapes.
;;;;
;;;; A shape is data, a list; its origin is that of its body's link frame (lengths in m):
;;;;
;;;;   (:box x y z)                  full extents
;;;;   (:sphere r)
;;;;   (:cylinder r h)               along z
;;;;   (:hull (x y z)...)            the convex hull of 4 to 40 points
;;;;   (:plane nx ny nz d)           all points p with n.p <= d, n a unit vector; static bodies only
;;;;   (:compound (pose shape) ...)  a union of the others but planes
;;;;
;;;; WITH-SHAPE makes the foreign shape.  Foreign shapes belong to no world; those that take long to
;;;; make, of hulls and compounds, are kept as long as the list that they were made of, so that the
;;;; next world with the same list, by EQ, has them at once.  So a shape must not be modified.

(in-package #:discrepancy-finder.bullet)

(defun malformed-shape (shape owner)
  (fail 'add-body "the shape ~s of ~a is malformed; it should be ~a" shape
        (described owner)
        (case (if (consp shape) (first shape) shape)
          (:box "(:box x y z) with positive lengths")
          (:sphere "(:sphere radius) with a positive radius")
          (:cylinder "(:cylinder radius height) with positive lengths")
          (:hull "(:hull (x y z)...) with 4 to 40 points that are not flat")
          (:plane "(:plane nx ny nz d) with a unit vector n")
          (:compound "(:compound (pose shape)...) of boxes, spheres, cylinders and hulls")
          (t "a list that begins with :box, :sphere, :cylinder, :hull, :plane or :compound"))))

(defun shape-numbers (shape owner count)
  "Return the COUNT numbers of SHAPE as a list of double floats."
  (unless (and (eql (ignore-errors (list-length shape)) (1+ count))
               (every #'realp (rest shape)))
    (malformed-shape shape owner))
  (loop for number in (rest shape)
        collect (number-of (list "a number of the shape ~s of ~?" shape (first owner) (rest owner))
                           number 'add-body)))

(defun point-numbers (points operation)
  "Return a vector of the numbers of POINTS, a list or vector of lists of three numbers each."
  (check-length points operation)
  (let ((numbers (make-array (* 3 (length points)) :element-type 'double-float))
        (index 0))
    (declare (type fixnum index))
    (flet ((add (point)
             (unless (eql (ignore-errors (list-length point)) 3)
               (fail operation "~s is no point (x y z)" point))
             (dolist (number point)
               (setf (aref numbers index) (number-of "a number of a point" number operation))
               (incf index))))
      (map nil #'add points))
    numbers))

(defun hull-numbers (shape owner)
  "Return a vector of the numbers of the points of the hull SHAPE."
  (unless (typep (ignore-errors (list-length shape)) '(integer 5 41))
    (malformed-shape shape owner))
  (handler-case (point-numbers (rest shape) 'add-body)
    (bullet-error () (malformed-shape shape owner))))

(defun new-shape (shape owner)
  "Return the pointer of a new foreign shape made of the list SHAPE.  OWNER is who has it, a
list that DESCRIBED takes, for messages.  Signals BULLET-ERROR if SHAPE is malformed."
  (let ((out (make-array 1 :element-type '(unsigned-byte 64))))
    (cffi:with-pointer-to-vector-data (pointer out)
      (flet ((numbers (count) (shape-numbers shape owner count)))
        (let ((status
                (case (and (consp shape) (first shape))
                  (:box (destructuring-bind (x y z) (numbers 3)
                          (%shape-box x y z pointer)))
                  (:sphere (destructuring-bind (radius) (numbers 1)
                             (%shape-sphere radius pointer)))
                  (:cylinder (destructuring-bind (radius height) (numbers 2)
                               (%shape-cylinder radius height pointer)))
                  (:plane (destructuring-bind (nx ny nz d) (numbers 4)
                            (%shape-plane nx ny nz d pointer)))
                  (:hull (let ((numbers (hull-numbers shape owner)))
                           (cffi:with-pointer-to-vector-data (points numbers)
                             (%shape-hull (floor (length numbers) 3) points pointer))))
                  (:compound (new-compound shape owner pointer))
                  (t (malformed-shape shape owner)))))
          (declare (type (signed-byte 32) status))
          (when (minusp status)
            (if (eq (status-name status) :no-memory)
                (fail 'add-body "the memory is used up")
                (malformed-shape shape owner))))))
    (sb-sys:int-sap (aref out 0))))

(defun compound-parts (shape owner)
  "Return the list of the (pose shape) of the compound SHAPE."
  (flet ((part-p (part)
           (and (eql (ignore-errors (list-length part)) 2)
                (geometry:pose-p (first part))
                (consp (second part))
                (member (first (second part)) '(:box :sphere :cylinder :hull)))))
    (unless (and (ignore-errors (list-length shape)) (rest shape) (every #'part-p (rest shape)))
      (malformed-shape shape owner))
    (rest shape)))

(defun new-compound (shape owner out)
  "Write the pointer of a new foreign compound to OUT; return the status."
  (let* ((parts (compound-parts shape owner))
         (count (length parts))
         (children (make-array count :element-type '(unsigned-byte 64) :initial-element 0))
         (poses (make-array (* 7 count) :element-type 'double-float)))
    (unwind-protect
         (let ((status (progn
                         (loop for (pose part) in parts
                               for i from 0
                               do (setf (aref children i)
                                        (sb-sys:sap-int (new-shape part owner)))
                                  (replace poses (geometry:pose-components pose)
                                           :start1 (* 7 i)))
                         (cffi:with-pointer-to-vector-data (children-pointer children)
                           (cffi:with-pointer-to-vector-data (poses-pointer poses)
                             (%shape-compound count children-pointer poses-pointer out))))))
           (when (= status -5)
             (fail 'add-body "a pose in the compound shape of ~a is not a finite position with a ~
                              unit quaternion" (described owner)))
           status)
      (loop for child across children
            unless (zerop child)
              do (%shape-delete (sb-sys:int-sap child))))))

(sb-ext:defglobal **kept-shapes**
    (make-hash-table :test #'eq :weakness :key :synchronized t))
(declaim (type hash-table **kept-shapes**))

(defun kept-moments (shape make)
  "Return the moments of SHAPE, those that are kept with its foreign shape or what MAKE returns."
  (let ((handle (gethash shape **kept-shapes**)))
    (if handle
        (or (shape-handle-moments handle)
            (setf (shape-handle-moments handle) (funcall make)))
        (funcall make))))

(defun kept-shape (shape owner)
  "Return the handle of the foreign shape made of the list SHAPE, now or before."
  (let ((handle (gethash shape **kept-shapes**)))
    (if (and handle (handle-usable-p handle))
        handle
        (sb-sys:without-interrupts
          (let ((handle (make-shape-handle (new-shape shape owner) **session**)))
            (sb-ext:finalize shape (lambda () (release handle)) :dont-save t)
            (setf (gethash shape **kept-shapes**) handle))))))

(declaim (inline call-with-shape))
(defun call-with-shape (function shape owner)
  (declare (type function function))
  (if (and (consp shape) (member (first shape) '(:hull :compound)))
      (let ((handle (kept-shape shape owner)))
        (sb-sys:with-pinned-objects (shape)
          (funcall function (handle-pointer handle))))
      (let ((pointer (new-shape shape owner)))
        (unwind-protect (funcall function pointer)
          (%shape-delete pointer)))))

(defmacro with-shape ((pointer shape owner) &body body)
  "Evaluate BODY with POINTER bound to the foreign shape made of the list SHAPE.  OWNER is who
has it, a list that DESCRIBED takes, for messages.  Signals BULLET-ERROR if SHAPE is malformed."
  `(call-with-shape (lambda (,pointer) ,@body) ,shape ,owner))
