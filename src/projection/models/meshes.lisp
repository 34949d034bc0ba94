;;;; Meshes: the convex hull of what an STL, OBJ or Collada file holds.
;;;;
;;;; MESH-SHAPE reads a file with the C API of libassimp, takes the corners of all meshes where the
;;;; nodes of the file put them, scales them and asks Bullet for a hull of at most 40 vertices.
;;;; Hulls are kept by file, its date and size, and scale.  As ROS does it, a Collada file's unit
;;;; counts and its upward axis does not: z is upwards.

(in-package #:discrepancy-finder.projection)

(foreign:define-library assimp "the mesh reader assimp" ("libassimp.so.5" "libassimp.so")
  :hint "apt-get install libassimp5")

;;; The part of assimp's C API that is needed: scene, node and mesh begin with these members.

(cffi:defcstruct assimp-scene
  (flags :unsigned-int)
  (root :pointer)
  (mesh-count :unsigned-int)
  (meshes :pointer))

(cffi:defcstruct assimp-node
  (name-length :uint32)
  (name :char :count 1024)
  (transformation :float :count 16)     ; by rows
  (parent :pointer)
  (child-count :unsigned-int)
  (children :pointer)
  (mesh-count :unsigned-int)
  (meshes :pointer))

(cffi:defcstruct assimp-mesh
  (primitive-types :unsigned-int)
  (vertex-count :unsigned-int)
  (face-count :unsigned-int)
  (vertices :pointer))

(cffi:defcfun ("aiImportFileExWithProperties" %import-file) :pointer
  (file :string) (flags :unsigned-int) (file-functions :pointer) (properties :pointer))
(cffi:defcfun ("aiReleaseImport" %release-import) :void (scene :pointer))
(cffi:defcfun ("aiGetErrorString" %error-string) :string)
(cffi:defcfun ("aiCreatePropertyStore" %make-properties) :pointer)
(cffi:defcfun ("aiReleasePropertyStore" %release-properties) :void (store :pointer))
(cffi:defcfun ("aiSetImportPropertyInteger" %set-property) :void
  (store :pointer) (name :string) (value :int))

(defmacro with-members (members type pointer &body body)
  "Evaluate BODY with MEMBERS, names of the struct TYPE at POINTER, bound to what they hold."
  (alexandria:once-only (pointer)
    `(let ,(loop for member in members
                 collect `(,member (cffi:foreign-slot-value ,pointer '(:struct ,type) ',member)))
       ,@body)))

(defmacro with-imported-scene ((scene file) &body body)
  "Evaluate BODY with SCENE bound to assimp's scene of FILE, a native name, NULL if it cannot be
read."
  (alexandria:with-unique-names (properties)
    `(let* ((,properties (%make-properties))
            (,scene (cffi:null-pointer)))
       (unwind-protect
            (progn
              (%set-property ,properties "IMPORT_COLLADA_IGNORE_UP_DIRECTION" 1)
              (setf ,scene (%import-file ,file 0 (cffi:null-pointer) ,properties))
              ,@body)
         (unless (cffi:null-pointer-p ,scene)
           (%release-import ,scene))
         (%release-properties ,properties)))))

;;; Corners

(defun matrix-product (a b)
  "Return the product of A and B, vectors of the 16 elements of a matrix by rows."
  (let ((product (make-array 16 :element-type 'double-float)))
    (dotimes (i 4 product)
      (dotimes (j 4)
        (setf (aref product (+ (* 4 i) j))
              (loop for k below 4
                    sum (* (aref a (+ (* 4 i) k)) (aref b (+ (* 4 k) j)))))))))

(defun node-matrix (node)
  (let ((matrix (make-array 16 :element-type 'double-float))
        (pointer (cffi:foreign-slot-pointer node '(:struct assimp-node) 'transformation)))
    (dotimes (i 16 matrix)
      (setf (aref matrix i) (float (cffi:mem-aref pointer :float i) 1d0)))))

(defun map-mesh-corners (function mesh matrix)
  "Call FUNCTION with the coordinates of each vertex of MESH, transformed by MATRIX."
  (declare (type (simple-array double-float (16)) matrix) (function function))
  (with-members (vertex-count vertices) assimp-mesh mesh
    (dotimes (i vertex-count)
      (flet ((coordinate (k)
               (float (the single-float (cffi:mem-aref vertices :float (+ (* 3 i) k))) 1d0)))
        (let ((x (coordinate 0)) (y (coordinate 1)) (z (coordinate 2)))
          (flet ((row (k)
                   (+ (* (aref matrix k) x) (* (aref matrix (+ k 1)) y)
                      (* (aref matrix (+ k 2)) z) (aref matrix (+ k 3)))))
            (funcall function (row 0) (row 4) (row 8))))))))

(defun map-corners (function scene)
  "Call FUNCTION with the coordinates of each vertex in SCENE."
  (with-members (root mesh-count meshes) assimp-scene scene
    (let ((scene-mesh-count mesh-count) (scene-meshes meshes))
      (labels ((visit (node matrix)
                 (with-members (child-count children mesh-count meshes) assimp-node node
                   (let ((matrix (matrix-product matrix (node-matrix node))))
                     (dotimes (i mesh-count)
                       (let ((index (cffi:mem-aref meshes :unsigned-int i)))
                         (when (< index scene-mesh-count)
                           (map-mesh-corners function
                                             (cffi:mem-aref scene-meshes :pointer index)
                                             matrix))))
                     (dotimes (i child-count)
                       (visit (cffi:mem-aref children :pointer i) matrix))))))
        (unless (cffi:null-pointer-p root)
          (visit root (coerce '(1d0 0d0 0d0 0d0 0d0 1d0 0d0 0d0 0d0 0d0 1d0 0d0 0d0 0d0 0d0 1d0)
                              '(simple-array double-float (16)))))))))

(defun mesh-corners (path element)
  "Return the list of the different corners (x y z) in the mesh file PATH, which ELEMENT names."
  (foreign:with-c-float-traps
    (with-imported-scene (scene (source:native-name path))
      (when (cffi:null-pointer-p scene)
        (urdf-problem element "the mesh ~a cannot be read: ~a" (source:native-name path)
                      (string-right-trim ". " (first (uiop:split-string
                                                      (%error-string)
                                                      :separator '(#\Newline))))))
      (let ((corners (make-hash-table :test 'equal)) (list '()))
        (map-corners (lambda (x y z)
                       (unless (and (< -1d6 x 1d6) (< -1d6 y 1d6) (< -1d6 z 1d6))
                         (urdf-problem element "the mesh ~a has a corner at ~a ~a ~a"
                                       (source:native-name path) x y z))
                       (let ((corner (list x y z)))
                         (unless (gethash corner corners)
                           (setf (gethash corner corners) t)
                           (push corner list))))
                     scene)
        (nreverse list)))))

;;; Hulls

(defparameter *hull-vertices* 40
  "The greatest number of vertices of a hull.")

(defvar *hulls* (make-hash-table :test 'equal :synchronized t)
  "Shapes of meshes that were read, by file, date of writing, size and scale.")

(defvar *mesh-files* '()
  "The names of the mesh files that the model which is being read has named, the last one first.")

(defun hull-shape (corners path element)
  (handler-case (cons :hull (bullet:convex-hull corners :vertices *hull-vertices*))
    (bullet:bullet-error (condition)
      (urdf-problem element "the mesh ~a has no hull: ~a" (source:native-name path)
                    (string-right-trim "." (source:condition-sentence condition))))))

(defun file-size (path)
  (with-open-file (stream path :element-type '(unsigned-byte 8))
    (file-length stream)))

(defun mesh-shape (element)
  "Return the shape of the <mesh> ELEMENT: (:hull (x y z)...)."
  (let* ((name (name-attribute element "filename"))
         (path (named-file name element))
         (scale (numbers-in (attribute element "scale" "1 1 1") 3 element)))
    (unless (member (pathname-type path) '("stl" "obj" "dae") :test #'equalp)
      (urdf-problem element "the mesh ~a is of no kind that is read; STL, OBJ and DAE are" name))
    (dolist (factor scale)
      (unless (< 1d-6 (abs factor) 1d6)
        (urdf-problem element "the mesh ~a has a scale of ~a" name factor)))
    (let ((key (list (source:native-name path) (file-write-date path) (file-size path) scale)))
      (pushnew (source:native-name path) *mesh-files* :test #'string=)
      (or (gethash key *hulls*)
          (setf (gethash key *hulls*)
                (hull-shape (loop for corner in (mesh-corners path element)
                                  collect (mapcar #'* corner scale))
                            path element))))))
