;;;; What is read of URDF files that are right.

(in-package #:discrepancy-finder.tests)
(in-suite urdf)

(defmacro with-urdf ((model &rest lines) &body body)
  "Evaluate BODY with MODEL bound to what is read of a URDF file with LINES."
  (alexandria:with-unique-names (file)
    `(with-file (,file (urdf-lines ,@lines) "urdf")
       (let ((,model (projection:read-urdf ,file)))
         ,@body))))

(defun near-p (a b &optional (tolerance 1d-12))
  "Return true if the numbers, or lists of numbers, A and B differ by at most TOLERANCE."
  (if (listp a)
      (and (= (length a) (length b))
           (every (lambda (x y) (near-p x y tolerance)) a b))
      (<= (abs (- a b)) tolerance)))

(defun first-link (model)
  (first (projection:urdf-model-links model)))

(defun first-joint (model)
  (first (projection:urdf-model-joints model)))

(test angles-turn-about-fixed-axes
  ;; Roll, then pitch, then yaw: the z axis goes to -y, to -y, to x.
  (with-urdf (model *two-links*
                    (joint-with "<origin xyz=\"1 2 3\"
                                        rpy=\"1.5707963267948966 0.5 1.5707963267948966\"/>"
                                :type "fixed"))
    (let* ((origin (projection::urdf-joint-origin (first-joint model)))
           (tip (geometry:compose origin (geometry:make-pose 0 0 1))))
      (is (near-p '(2d0 2d0 3d0) (list (geometry:pose-x tip) (geometry:pose-y tip)
                                       (geometry:pose-z tip)))))))

(test joints-have-axes-limits-and-dynamics
  (with-urdf (model *two-links*
                    (joint-with "<limit lower=\"-1\" upper=\"2.5e-1\" effort=\"30\" velocity=\"2\"/>
                                 <axis xyz=\"0 3 4\"/><dynamics damping=\"0.5\" friction=\"2\"/>"))
    (let ((joint (first-joint model)))
      (is (equal '(0d0 0.6d0 0.8d0) (projection::urdf-joint-axis joint)))
      (is (equal '(-1d0 0.25d0 30d0 2d0 0.5d0 2d0)
                 (loop for reader in '(projection::urdf-joint-lower projection::urdf-joint-upper
                                       projection::urdf-joint-effort
                                       projection::urdf-joint-velocity
                                       projection::urdf-joint-damping
                                       projection::urdf-joint-friction)
                       collect (funcall reader joint))))))
  (with-urdf (model *two-links* (joint-with "<limit effort=\"3\" velocity=\"1\" upper=\"1\"/>"
                                            :type "continuous"))
    (let ((joint (first-joint model)))
      (is (equal '(1d0 0d0 0d0) (projection::urdf-joint-axis joint)) "without an axis it is x")
      (is (null (projection::urdf-joint-upper joint)) "a continuous joint has no limits")
      (is (= 3d0 (projection::urdf-joint-effort joint)))
      (is (null (projection::urdf-joint-mimic joint)))))
  (with-urdf (model *two-links* (joint-with "<limit effort=\"3\" upper=\"1\"/>"))
    (is (eql 0d0 (projection::urdf-joint-lower (first-joint model))) "a missing limit is 0")))

(test a-joint-follows-the-end-of-a-chain
  (with-urdf (model *two-links* "<link name=\"c\"/><link name=\"d\"/>"
                    (joint-with (format nil "~a<mimic joint=\"k\" multiplier=\"2\" offset=\"1\"/>"
                                        *limit*))
                    (joint-with (format nil "~a<mimic joint=\"l\" multiplier=\"-3\" ~
                                                       offset=\"0.5\"/>" *limit*)
                                :name "k" :child "c")
                    (joint-with *limit* :name "l" :child "d"))
    (is (equal '(("l" -6d0 2d0) ("l" -3d0 0.5d0) nil)
               (loop for name in '("j" "k" "l")
                     collect (projection::urdf-joint-mimic
                              (projection::find-urdf-joint model name)))))))

(test a-fixed-joint-follows-nothing
  (with-urdf (model *two-links* "<link name=\"c\"/>"
                    (joint-with "<mimic joint=\"k\"/>" :type "fixed")
                    (joint-with *limit* :name "k" :child "c"))
    (is (null (projection::urdf-joint-mimic (projection::find-urdf-joint model "j"))))))

(test joints-come-after-the-joint-above
  (with-urdf (model "<link name=\"c\"/><link name=\"b\"/><link name=\"a\"/><link name=\"d\"/>"
                    (joint-with "" :type "fixed" :name "bc" :parent "b" :child "c")
                    (joint-with "" :type "fixed" :name "ad" :parent "a" :child "d")
                    (joint-with "" :type "fixed" :name "ab" :parent "a" :child "b"))
    (is (string= "a" (projection:urdf-model-root model)))
    (is (equal '("ad" "ab" "bc")
               (mapcar #'projection::urdf-joint-name (projection:urdf-model-joints model))))
    (is (equal '("ab" "bc") (mapcar #'projection::urdf-joint-name
                                    (projection::joints-to model "c"))))))

(test what-urdf-does-not-mean-is-passed-over
  (with-urdf (model "<gazebo reference=\"a\"><sensor:camera x=\"${1}\"/>text &amp; more</gazebo>"
                    "<transmission name=\"t\"><joint name=\"nosuch\"/></transmission>"
                    "<link name=\"a&#x62;&lt;\" type='\"'><!-- - <link/> --><![CDATA[<link>]]>"
                    "</link>"
                    "<?processing instruction?>")
    (is (string= "ab<" (projection::urdf-link-name (first-link model))))
    (is (= 1 (length (projection:urdf-model-links model))))
    (is (= 4 (projection::urdf-link-line (first-link model))))))

(test numbers-are-the-nearest-doubles
  (loop for (text number) in '(("0.1" 0.1d0) ("-.5" -0.5d0) ("+2." 2d0) ("1e3" 1000d0)
                               ("1.E+2" 100d0) ("4.35" 4.35d0) ("1e-400" 0d0) ("1e-320" 0d0)
                               ("0e999999" 0d0) ("-0" 0d0) ("1.7976931348623157e308"
                                                            1.7976931348623157d308)
                               ("0.000000000000000000000000000000000001234" 1.234d-36)
                               ("123456789012345678901234567890" 123456789012345678901234567890d0))
        do (is (eql number (projection::number-in text nil)) "~a" text)))

;;; Shapes and inertia

(test shapes-are-merged-in-the-frame-of-the-link
  (with-urdf (model (link-with (collision-of "<box size=\"1 2 3\"/>")))
    (is (equal '(:box 1d0 2d0 3d0) (projection::urdf-link-shape (first-link model)))))
  (with-urdf (model (link-with (collision-of "<cylinder radius=\"1\" length=\"2\"/>")
                               "<collision><origin xyz=\"0 0 1\"/><geometry>
                                <sphere radius=\"0.5\"/></geometry></collision>"))
    (destructuring-bind (kind (pose first) (other-pose second))
        (projection::urdf-link-shape (first-link model))
      (is (equal '(:compound (:cylinder 1d0 2d0) (:sphere 0.5d0)) (list kind first second)))
      (is (geometry:pose= (geometry:identity-pose) pose))
      (is (= 1d0 (geometry:pose-z other-pose)))))
  (with-urdf (model "<link name=\"a\"/>")
    (is (null (projection::urdf-link-shape (first-link model))))))

(defun inertia-text (tensor)
  "Return an <inertial> of 2 kg at (1 0 0) with the list TENSOR (xx yy zz xy xz yz)."
  (format nil "<inertial><origin xyz=\"1 0 0\"/><mass value=\"2\"/><inertia ~{~a=\"~f\"~^ ~}/>~
               </inertial>"
          (loop for name in '("ixx" "iyy" "izz" "ixy" "ixz" "iyz")
                for number in tensor
                collect name collect number)))

(test inertia-is-turned-to-its-principal-axes
  (with-urdf (model (link-with (inertia-text '(3d0 2d0 4d0 0d0 0d0 0d0))))
    (let ((link (first-link model)))
      (is (equal '(3d0 2d0 4d0) (projection::urdf-link-inertia link)))
      (is (= 2d0 (projection::urdf-link-mass link)))
      (is (geometry:pose= (geometry:make-pose 1 0 0) (projection::urdf-link-inertial-pose link)))))
  ;; Tensors of known moments, turned at random: back come moments and axes.
  (let ((state (sb-ext:seed-random-state 7)))
    (loop repeat 100
          do (flet ((draw (from to) (+ from (random (- to from) state))))
               (let* ((moments (list (draw 0.001d0 3d0) (draw 0.001d0 3d0) (draw 0.001d0 3d0)))
                      (pose (geometry:make-pose 0 0 0 :roll (draw -3d0 3d0)
                                                      :pitch (draw -1.5d0 1.5d0)
                                                      :yaw (draw -3d0 3d0)))
                      (tensor (projection::turned-tensor moments pose)))
                 (multiple-value-bind (found axes) (projection::principal-axes tensor)
                   (is (near-p (sort (copy-list moments) #'<) (sort (copy-list found) #'<)))
                   (is (near-p tensor (projection::turned-tensor found axes)))
                   (is (near-p 1d0 (reduce #'+ (mapcar (lambda (x) (* x x))
                                                       (nthcdr 3 (geometry:pose-components
                                                                  axes))))))))))))

(test inertia-that-no-body-has-is-an-error-where-it-counts
  (with-file (file (urdf-lines "<link name=\"a\"><inertial><mass value=\"1\"/>"
                               "<inertia ixx=\"1\" iyy=\"-1\" izz=\"1\"/></inertial>"
                               (collision-of "<sphere radius=\"1\"/>") "</link>")
                   "urdf")
    (is (null (projection::urdf-link-inertia (first-link (projection:read-urdf file)))))
    (flet ((scene (kind)
             (format nil "(define-scene s (~a x ~s (:at 0 0 0)))" kind file)))
      (dolist (kind '(":item" ":fixture"))
        (with-file (scene-file (scene kind))
          (signals-with (projection:urdf-error file ":3: link a: " "positive definite"
                                               "1.0, -1.0, 1.0")
            (projection:load-scene scene-file))))
      (with-file (scene-file (scene ":robot"))
        (is (eq :x (projection:scene-robot-name (projection:load-scene scene-file))))))))

(test inertia-of-zeros-is-none
  (with-urdf (model (link-with (inertia-text '(0d0 0d0 0d0 0d0 0d0 0d0))))
    (is (null (projection::urdf-link-inertia (first-link model))))
    (is (null (projection::urdf-link-fault (first-link model))))))

(test inertia-without-a-diagonal-is-a-fault
  (dolist (tensor '((0d0 0d0 1d0 0d0 0d0 0d0) (0d0 0d0 0d0 0d0 2d-35 0d0)))
    (with-urdf (model (link-with (inertia-text tensor)))
      (is (typep (projection::urdf-link-fault (first-link model)) 'projection:urdf-error)))))

(test text-of-many-lines-is-passed-over
  (with-urdf (model (link-with (make-string 200000 :initial-element #\Newline)))
    (is (string= "a" (projection:urdf-model-root model)))))

(test colors-come-from-the-first-visual-that-has-one
  (with-urdf (model "<material name=\"red\"><color rgba=\"1 0 0 1\"/></material>"
                    "<link name=\"a\"><visual/><visual><material name=\"red\"/></visual></link>"
                    (joint-with "" :type "fixed")
                    "<link name=\"b\"><visual><material name=\"x\"><color rgba=\"0 2 0 0.5\"/>"
                    "</material></visual></link>")
    (is (equal '((1d0 0d0 0d0 1d0) (0d0 1d0 0d0 0.5d0))
               (mapcar #'projection::urdf-link-visual-color
                       (projection:urdf-model-links model))))))

;;; Groups

(test what-is-fixed-together-is-one-body
  (with-urdf (model
              "<link name=\"a\"/>"
              "<link name=\"b\"><inertial><mass value=\"1\"/></inertial>"
              (collision-of "<box size=\"0.1 0.1 0.1\"/>") "</link>"
              "<link name=\"c\"><inertial><mass value=\"3\"/></inertial>"
              (collision-of "<box size=\"0.1 0.1 0.1\"/>") "</link>"
              "<link name=\"d\">" (collision-of "<box size=\"1 0.1 0.1\"/>") "</link>"
              (joint-with "<limit upper=\"1\"/>" :type "prismatic")
              (joint-with "<origin xyz=\"0.4 0 0\" rpy=\"0 0 1.5707963267948966\"/>" :type "fixed"
                          :name "k" :parent "b" :child "c")
              (joint-with "" :type "continuous" :name "l" :parent "c" :child "d"))
    (destructuring-bind (root drawer knob) (projection::rigid-groups model)
      (is (null (projection::rigid-group-joint root)))
      (is (= 0d0 (projection::rigid-group-mass root)))
      (is (string= "j" (projection::urdf-joint-name (projection::rigid-group-joint drawer))))
      (is (eq root (projection::rigid-group-parent drawer)))
      (is (string= "b" (projection::urdf-link-name (projection::rigid-group-link drawer))))
      (is (= 2 (length (projection::rigid-group-members drawer))))
      (is (= 4d0 (projection::rigid-group-mass drawer)))
      (is (near-p 0.3d0 (geometry:pose-x (projection::rigid-group-inertial-pose drawer))))
      ;; Two cubes, 0.1 and 0.3 m from their common centre, along x.
      (let ((cube (/ 0.01d0 6)) (way (+ (* 1 0.09d0) (* 3 0.01d0))))
        (is (near-p (sort (list (* 4 cube) (+ way (* 4 cube)) (+ way (* 4 cube))) #'<)
                    (sort (copy-list (projection::rigid-group-inertia drawer)) #'<) 1d-9)))
      (is (near-p 5d0 (projection::rigid-group-mass knob)) "0.01 m^3 of 500 kg/m^3"))))
