;;;; Meshes: hulls of STL, OBJ and Collada files, and where they are found.

(in-package #:discrepancy-finder.tests)
(in-suite urdf)

(defparameter *pyramid*
  '((0 0 0) (2 0 0) (2 2 0) (0 2 0) (1 1 3))
  "The corners of a pyramid of 2 x 2 x 3 m.")

(defparameter *pyramid-faces* '((1 3 2) (1 4 3) (1 2 5) (2 3 5) (3 4 5) (4 1 5)))

(defun corner (index)
  (nth (1- index) *pyramid*))

(defun stl-text ()
  (format nil "solid pyramid~%~{~{facet normal 0 0 0~% outer loop~%~@{  vertex ~{~a ~}~%~} ~
               endloop~%endfacet~%~}~}endsolid pyramid~%"
          (loop for face in *pyramid-faces* collect (mapcar #'corner face))))

(defun obj-text ()
  (format nil "~:{v ~a ~a ~a~%~}~:{f ~a ~a ~a~%~}" *pyramid* *pyramid-faces*))

(defun dae-text (&key (unit 1) (up "Z_UP") (transform "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"))
  (format nil "<?xml version=\"1.0\" encoding=\"utf-8\"?>
<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">
<asset><created>2020-01-01T00:00:00</created><modified>2020-01-01T00:00:00</modified>
<unit name=\"unit\" meter=\"~a\"/><up_axis>~a</up_axis></asset>
<library_geometries><geometry id=\"g\"><mesh>
<source id=\"p\"><float_array id=\"pa\" count=\"~d\">~{~{~a ~}~}</float_array>
<technique_common><accessor source=\"#pa\" count=\"~d\" stride=\"3\">
<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/>
</accessor></technique_common></source>
<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>
<triangles count=\"~d\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>
<p>~{~{~a ~}~}</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id=\"s\"><node id=\"n\"><matrix>~a</matrix>
<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>"
          unit up (* 3 (length *pyramid*)) *pyramid* (length *pyramid*) (length *pyramid-faces*)
          (mapcar (lambda (face) (mapcar #'1- face)) *pyramid-faces*) transform))

(defun mesh-urdf (name &optional (more ""))
  (urdf-lines (link-with (collision-of (format nil "<mesh filename=\"~a\" ~a/>" name more)))))

(defun shape-of-mesh (name &optional (more ""))
  "Return the shape of a link with the mesh NAME."
  (with-file (file (mesh-urdf name more) "urdf")
    (projection::urdf-link-shape (first-link (projection:read-urdf file)))))

(defun hull-near-p (points shape)
  "Return true if SHAPE is a hull of just POINTS."
  (and (eq :hull (first shape))
       (= (length points) (length (rest shape)))
       (every (lambda (point) (some (lambda (other) (near-p point other 1d-6)) (rest shape)))
              points)))

(test the-hull-of-a-mesh
  (loop for (type text) in `(("stl" ,(stl-text)) ("STL" ,(stl-text)) ("obj" ,(obj-text))
                             ("dae" ,(dae-text)))
        do (with-file (file text type)
             (is (hull-near-p *pyramid* (shape-of-mesh file)) "~a" type)
             (is (hull-near-p (loop for (x y z) in *pyramid*
                                    collect (list (* 0.001d0 x) (* -0.001d0 y) (* 0.002d0 z)))
                              (shape-of-mesh file "scale=\"0.001 -0.001 0.002\""))
                 "~a, scaled" type)
             (is (eq (shape-of-mesh file) (shape-of-mesh file)) "hulls are kept"))))

(test a-collada-file-has-units-and-nodes-and-no-upward-axis
  (with-file (file (dae-text :unit 0.01 :up "Y_UP"
                             :transform "0 -1 0 100 1 0 0 0 0 0 1 0 0 0 0 1")
                   "dae")
    (is (hull-near-p (loop for (x y z) in *pyramid*
                           collect (list (- 1d0 (* 0.01d0 y)) (* 0.01d0 x) (* 0.01d0 z)))
                     (shape-of-mesh file)))))

(test a-mesh-that-changes-is-read-again
  (with-file (file (obj-text) "obj")
    (is (hull-near-p *pyramid* (shape-of-mesh file)))
    (with-open-file (stream file :direction :output :if-exists :supersede)
      (format stream "~:{v ~a ~a ~a~%~}~:{f ~a ~a ~a~%~}"
              (loop for (x y z) in *pyramid* collect (list (* 10 x) y z)) *pyramid-faces*))
    (is (hull-near-p (loop for (x y z) in *pyramid* collect (list (* 10 x) y z))
                     (shape-of-mesh file)))))

(test a-fine-mesh-has-a-hull-of-forty-vertices
  (with-file (file (with-output-to-string (stream)
                     (loop for i below 40
                           do (loop for j from 0 to 20
                                    for a = (* i (/ pi 20)) for b = (* j (/ pi 20))
                                    do (format stream "v ~f ~f ~f~%" (* (cos a) (sin b))
                                               (* (sin a) (sin b)) (cos b))))
                     (loop for i from 1 to 837 do (format stream "f ~d ~d ~d~%" i (1+ i) (+ 3 i))))
                   "obj")
    (let ((shape (shape-of-mesh file)))
      (is (<= 30 (length (rest shape)) 40))
      (is (< 0.8 (/ (discrepancy-finder.bullet:shape-volume shape) (* 4/3 pi)) 1)))))

(test meshes-that-cannot-be-read
  (flet ((problem (text type &rest parts)
           (with-file (file text type)
             (dolist (part (list* ":2: link a: " file parts))
               (let ((report (report-of 'projection:urdf-error (lambda () (shape-of-mesh file)))))
                 (is (search part (or report "")) "~s is not in: ~a" part report))))))
    (problem "" "stl" "cannot be read")
    (problem "this is no mesh" "stl" "cannot be read")
    (problem "this is no mesh" "obj" "cannot be read")
    (problem "<COLLADA" "dae" "cannot be read")
    (problem (subseq (dae-text) 0 700) "dae" "mesh")
    (problem (format nil "v 0 0 0~%v 1 0 0~%v 0 1 0~%v 1 1 0~%f 1 2 3~%f 2 3 4~%") "obj" "no hull")
    (problem (format nil "v 0 0 0~%v 1 0 0~%v 0 1 0~%f 1 2 3~%") "obj" "no hull")
    (problem (stl-text) "ply" "of no kind"))
  (with-file (file (stl-text) "stl")
    (dolist (scale '("0 1 1" "1 1" "1 1 1e9" "a b c"))
      (is-true (report-of 'projection:urdf-error
                          (lambda () (shape-of-mesh file (format nil "scale=\"~a\"" scale))))
               "~a" scale))))

;;; Packages

(defun call-with-package (function)
  "Call FUNCTION with a new folder that holds stack/some_robot/{urdf,meshes/pyramid.obj}."
  (let* ((name (format nil "discrepancy-finder-~36r/" (random (expt 36 8) (make-random-state t))))
         (folder (uiop:subpathname (uiop:temporary-directory) name)))
    (unwind-protect
         (flet ((write-text (text file)
                  (ensure-directories-exist (uiop:subpathname folder file))
                  (with-open-file (stream (uiop:subpathname folder file) :direction :output)
                    (write-string text stream))))
           (write-text (obj-text) "stack/some_robot/meshes/pyramid.obj")
           (write-text (mesh-urdf "package://some_robot/meshes/pyramid.obj")
                       "stack/some_robot/urdf/a.urdf")
           (write-text (mesh-urdf "../meshes/pyramid.obj") "stack/some_robot/urdf/relative.urdf")
           (write-text (mesh-urdf "package://some_robot/meshes/pyramid.obj") "elsewhere/a.urdf")
           (funcall function folder))
      (uiop:delete-directory-tree folder :validate (constantly t)))))

(test packages-are-found
  (call-with-package
   (lambda (folder)
     (flet ((pyramid-p (file &rest options)
              (hull-near-p *pyramid*
                           (projection::urdf-link-shape
                            (first-link (apply #'projection:read-urdf
                                               (uiop:subpathname folder file) options)))))
            (with-environment (value function)
              (let ((old (uiop:getenv "ROS_PACKAGE_PATH")))
                (unwind-protect (progn (setf (uiop:getenv "ROS_PACKAGE_PATH") value)
                                       (funcall function))
                  (setf (uiop:getenv "ROS_PACKAGE_PATH") (or old ""))))))
       (is-true (pyramid-p "stack/some_robot/urdf/relative.urdf"))
       (is-true (pyramid-p "stack/some_robot/urdf/a.urdf") "a folder above the file")
       (signals-with (projection:urdf-error "elsewhere/a.urdf:2: link a: " "package some_robot")
         (pyramid-p "elsewhere/a.urdf"))
       (let ((stack (uiop:native-namestring (uiop:subpathname folder "stack"))))
         (is-true (pyramid-p "elsewhere/a.urdf" :package-path (list stack)))
         (is-true (pyramid-p "elsewhere/a.urdf"
                             :package-path (list (uiop:subpathname folder "stack/some_robot/"))))
         (is-true (with-environment (format nil "/no/such:~a" stack)
                    (lambda () (pyramid-p "elsewhere/a.urdf")))))))))
