;;;; Scene files: materials, tolerances, parameters and their defaults, robots with arms.

(in-package #:discrepancy-finder.tests)

(def-suite scenes :in all)
(in-suite scenes)

(defparameter *armed-robot*
  "<robot name=\"armed\">
  <link name=\"base\"/><link name=\"torso\"/><link name=\"upper\"/><link name=\"lower\"/>
  <link name=\"tool\"/><link name=\"pan\"/><link name=\"camera\"/>
  <link name=\"finger1\"><collision><geometry><box size=\".1 .1 .1\"/></geometry></collision></link>
  <link name=\"finger2\"><collision><geometry><box size=\".1 .1 .1\"/></geometry></collision></link>
  <joint name=\"torso_joint\" type=\"prismatic\"><parent link=\"base\"/><child link=\"torso\"/>
    <limit lower=\"0\" upper=\"0.3\"/></joint>
  <joint name=\"shoulder\" type=\"revolute\"><parent link=\"torso\"/><child link=\"upper\"/>
    <limit lower=\"0.5\" upper=\"2\"/></joint>
  <joint name=\"elbow\" type=\"continuous\"><parent link=\"upper\"/><child link=\"lower\"/></joint>
  <joint name=\"tool_joint\" type=\"fixed\"><parent link=\"lower\"/><child link=\"tool\"/></joint>
  <joint name=\"gripper\" type=\"prismatic\"><parent link=\"lower\"/><child link=\"finger1\"/>
    <limit lower=\"0\" upper=\"0.05\"/></joint>
  <joint name=\"follower\" type=\"prismatic\"><parent link=\"lower\"/><child link=\"finger2\"/>
    <limit lower=\"0\" upper=\"0.05\"/><mimic joint=\"gripper\" multiplier=\"-1\"/></joint>
  <joint name=\"pan_joint\" type=\"continuous\"><parent link=\"torso\"/>
    <child link=\"pan\"/></joint>
  <joint name=\"tilt_joint\" type=\"continuous\"><parent link=\"pan\"/>
    <child link=\"camera\"/></joint>
</robot>")

(defparameter *arm*
  "(:arm left (:joints \"shoulder\" \"elbow\") (:tool \"tool\") (:gripper \"gripper\")
         (:fingers \"finger1\" \"finger2\") (:parked 1 -0.5))")

(defun call-with-scene (function text)
  "Call FUNCTION with the name of a scene file with TEXT, in which ROBOT, CUP and TABLE stand for
the names of URDF files."
  (with-file (robot *armed-robot* "urdf")
    (loop for (name file) in `(("ROBOT" ,robot)
                               ("CUP" ,(root-file "models/table-top/cup.urdf"))
                               ("TABLE" ,(root-file "models/table-top/table.urdf")))
          do (loop for place = (search name text)
                   while place
                   do (setf text (format nil "~a~s~a" (subseq text 0 place) file
                                         (subseq text (+ place (length name)))))))
    (with-file (file (format nil "(define-scene s~%~a)" text))
      (funcall function file))))

(defmacro with-scene ((scene &rest lines) &body body)
  "Evaluate BODY with SCENE bound to what is read of a scene file with LINES."
  `(call-with-scene (lambda (file) (let ((,scene (projection:load-scene file))) ,@body))
                    (format nil "~{~a~%~}" (list ,@lines))))

(test parameters-have-defaults
  (with-scene (scene "(:parameters (base-speed 2))")
    (is (= 2d0 (projection:scene-parameter scene :base-speed)))
    (is (= 40d0 (projection:scene-parameter scene 'grip-force)))
    (is (= 0d0 (projection:scene-parameter scene :perception-error-z)))
    (is (= 2d0 (projection:scene-parameter scene :base-turn-speed)) "that of another parameter")
    (signals projection:unknown-parameter (projection:scene-parameter scene :reach))
    (is-true (projection:scene-knows-p scene :visible-fraction))
    (is-false (projection:scene-knows-p scene :reach))
    (let ((other (projection:scene-with-parameters scene '(grip-force 12 perception-error-x -0.1))))
      (is (= 12d0 (projection:scene-parameter other :grip-force)))
      (is (= -0.1d0 (projection:scene-parameter other :perception-error-x)))
      (is (= 40d0 (projection:scene-parameter scene :grip-force)) "the scene itself is unchanged")))
  (is (null (loop for (name default documentation) in projection::*known-parameters*
                  unless (and (keywordp name) (stringp documentation)
                              (if (keywordp default)
                                  (projection::known-parameter default)
                                  (or (zerop default)
                                      (projection::possible-value-p name default))))
                    collect name))))

(test tolerances-are-ranges
  (with-scene (scene "(:parameters (mu 0.5) (grip-force 35))"
                     "(:tolerances (grip-force 30 50 \"N\") (mu 0.4 0.6)
                                   (base-stopping-error-x -0.03 0.01))")
    (is (equal '((:grip-force 30d0 50d0 "N") (:mu 0.4d0 0.6d0 nil)
                 (:base-stopping-error-x -0.03d0 0.01d0
                  "how far ahead of its goal the base stops, m"))
               (projection:scene-tolerances scene)))
    (is (= 35d0 (projection:scene-parameter scene :grip-force)) "the parameter's value")
    (is (near-p -0.01d0 (projection:scene-parameter scene :base-stopping-error-x)) "the middle")
    (let ((drawn (projection:scene-with-parameters scene '(:base-stopping-error-x -0.02d0
                                                           :mu 0.6))))
      (is (= -0.02d0 (projection:scene-parameter drawn :base-stopping-error-x)))
      (is (= 0.6d0 (projection:scene-parameter drawn :mu)))
      (is (= 0.55d0 (projection:scene-parameter
                     (projection:scene-with-parameters drawn '(:mu 0.55d0)) :mu))))
    (signals-with (projection:impossible-parameter "grip-force" "from 30.0 to 50.0")
      (projection:scene-with-parameters scene '(:grip-force 51)))
    (signals-with (projection:impossible-parameter "mu" "from 0.4 to 0.6")
      (projection:scene-with-parameters scene '(:mu nil)))))

(test parts-have-materials
  (with-scene (scene "(:tolerances (wood-friction 0.2 0.4))"
                     "(:materials (wood (:friction wood-friction) (:restitution 0.1))"
                     "            (steel (:friction 0.3) (:rolling-friction 0.001)))"
                     "(:fixture table TABLE (:at 0 0 0) (:material wood))"
                     "(:item cup CUP (:at 0 0 1) (:material steel))"
                     "(:item other CUP (:at 1 0 1))")
    (flet ((surface (scene name)
             (let ((surface (projection::part-surface scene (projection::scene-part scene name))))
               (loop for kind in '(:friction :restitution :rolling-friction)
                     collect (getf surface kind)))))
      (is (near-p '(0.3d0 0.1d0) (butlast (surface scene :table))))
      (is (equal '(0.3d0 nil 0.001d0) (surface scene :cup)))
      (is (equal '(nil nil nil) (surface scene :other)))
      (is (equal '(0.4d0 0.1d0 nil)
                 (surface (projection:scene-with-parameters scene '(:wood-friction 0.4))
                          :table))))))

(test items-have-grasps
  (with-scene (scene "(:item cup CUP (:at 0 0 1) (:grasps top (front 0 0.1 0)))"
                     "(:item other CUP (:at 1 0 1))")
    (is (equal '(:top (:front 0d0 0.1d0 0d0)) (projection:scene-item-grasps scene 'cup)))
    (is (null (projection:scene-item-grasps scene 'other)))))

(test robots-have-arms
  (with-scene (scene "(:robot robot ROBOT (:at 0 0 0) (:torso \"torso_joint\")" *arm*
                     "(:head \"pan_joint\" \"tilt_joint\") (:camera \"camera\"))")
    (let* ((part (projection::scene-robot scene))
           (arm (projection::part-arm part 'left)))
      (is (equal '(:torso "torso_joint" :camera "camera" :pan "pan_joint" :tilt "tilt_joint")
                 (projection::scene-part-roles part)))
      (is (null (projection::part-arm part :right)))
      (is (equal '(:left ("shoulder" "elbow") "tool" "gripper" ("finger1" "finger2") (1d0 -0.5d0))
                 (loop for reader in '(projection::arm-roles-name projection::arm-roles-joints
                                       projection::arm-roles-tool projection::arm-roles-gripper
                                       projection::arm-roles-fingers
                                       projection::arm-roles-parked)
                       collect (funcall reader arm))))))
  (with-scene (scene "(:robot robot ROBOT (:at 0 0 0)"
                     "(:arm left (:joints \"shoulder\" \"elbow\") (:tool \"tool\")"
                     "      (:gripper \"gripper\") (:fingers \"finger1\" \"finger2\")))")
    (is (equal '(0.5d0 0d0) (projection::arm-roles-parked
                             (projection::part-arm (projection::scene-robot scene) :left)))
        "nearest to 0")))

(defun arm-text (old new)
  "Return a robot's clause with OLD in its arm replaced by NEW."
  (let ((place (search old *arm*)))
    (format nil "(:robot r ROBOT (:at 0 0 0)~%~a~a~a)" (subseq *arm* 0 place) new
            (subseq *arm* (+ place (length old))))))

(defparameter *wrong-scenes*
  `(("(:materials (wood))" ":2: " "(name (:friction number)")
    ("(:materials (wood (:friction -1)))" ":2: " "friction of the material wood is -1")
    ("(:materials (wood (:friction 1) (:restitution 2)))" "restitution" "from 0 to 1")
    ("(:materials (wood (:friction nosuch)))" ":2: " "names the parameter nosuch")
    ("(:materials (wood (:friction 1) (:friction 2)))" "two frictions")
    ("(:materials (wood (:friction 1)) (wood (:friction 2)))" ":2: " "two materials" "wood")
    (,(format nil "(:tolerances (mu 5 11))~%(:materials (wood (:friction mu)))")
     ":3: " "can be 11.0")
    ("(:fixture table TABLE (:at 0 0 0) (:material wood))" ":2: " "no material wood")
    ("(:fixture table TABLE (:at 0 0 0) (:material 7))" ":2: " "(:material name)")
    ("(:fixture table TABLE (:at 0 0 0) (:material wood steel))" ":2: " "(:material name)")
    ("(:tolerances (grip-force 30))" ":2: " "(name low high")
    ("(:tolerances (grip-force 30 20))" ":2: " "begins above its end")
    ("(:tolerances (grip-force 0 20))" ":2: " "grip-force" "positive number")
    ("(:tolerances (grip-force 1 nan))" ":2: " "grip-force" "nan")
    ("(:tolerances (visible-fraction 0.5 1.5))" ":2: " "1.5" "at most 1.0")
    ("(:tolerances (nosuch 1 2))" ":2: " "nosuch" "no known parameter")
    ("(:tolerances (grip-force 1 2) (grip-force 1 2))" ":2: " "two tolerances" "grip-force")
    (,(format nil "(:parameters (grip-force 20))~%(:tolerances (grip-force 30 50))")
     ":3: " "20.0, outside its tolerance")
    ("(:parameters (grip-force 20 7))" ":2: " "(name positive-number [documentation])")
    (,(format nil "(:parameters (a 1))~%(:parameters (b 1) (a 2))") ":3: " "two parameters" "a")
    ("(:item cup CUP (:at 0 0 1) (:colour red))" ":2: "
     ":item cup has no option :colour; it can have :at, :type")
    ("(:item cup CUP (:at 0 0 1) (:at 0 0 2))" ":2: " "two options :at")
    ("(:item cup CUP (:at 0 0 1) red)" ":2: " "no option red")
    ("(:item cup CUP (:at 0 0 1e300))" ":2: " "(:at x y z [yaw])")
    ("(:item cup CUP (:at 0 0 1e400))" ":2: " "1e400")
    ("(:item cup CUP (:at 0 0 1) (:grasps 7))" ":2: " "a grasp is a name")
    ("(:item cup CUP (:at 0 0 1) (:grasps (top 1 2)))" ":2: " "(name x y z)")
    ("(:item cup CUP (:at 0 0 1) (:grasps top up))" ":2: " "no grasp up; top, bottom, front")
    ("(:item cup \"no-such\" (:at 0 0 1))" ":2: " "no-such: no such file")
    ("(:item cup CUP . (:at 0 0 1) )" ":2: ")
    ("(:item nil CUP (:at 0 0 1))" ":2: " "(:item name \"file.urdf\" option*)")
    (,(format nil "(:item cup CUP (:at 0 0 1))~%(:item cup CUP (:at 0 0 1))")
     ":3: " "two parts" "cup")
    (,(format nil "(:robot r ROBOT (:at 0 0 0))~%(:robot q ROBOT (:at 0 0 0))") ":3: " "one robot")
    ("(:item r ROBOT (:at 0 0 0))" ":2: " "one link")
    ("(:robot r ROBOT (:at 0 0 0) (:torso \"elbow\"))" ":torso" "elbow" "not prismatic")
    ("(:robot r ROBOT (:at 0 0 0) (:torso \"torso_joint\") (:lift \"torso_joint\"))"
     ":2: " "either")
    (,(arm-text "left" "7") ":3: " "(:arm name option*)")
    (,(arm-text "\"shoulder\" \"elbow\"" "") ":3: " ":arm left needs (:joints name ...)")
    (,(arm-text "\"shoulder\"" "\"nosuch\"") ":3: " "\"nosuch\"" "no such joint")
    (,(arm-text "\"shoulder\"" "\"pan_joint\"") ":3: " "\"pan_joint\" does not move the tool")
    (,(arm-text "\"shoulder\" \"elbow\"" "\"elbow\" \"shoulder\"") ":3: " "from the body outwards")
    (,(arm-text "\"shoulder\"" "\"tool_joint\"") ":3: " "tool_joint" "a joint that is not")
    (,(arm-text "(:tool \"tool\")" "") ":3: " "(:tool name)")
    (,(arm-text "(:tool \"tool\")" "(:tool \"nosuch\")") ":3: " "no such link")
    (,(arm-text "\"gripper\"" "\"follower\"") ":3: " ":gripper" "follows another")
    (,(arm-text "\"finger2\"" "") ":3: " "(:fingers name name)")
    (,(arm-text "\"finger2\"" "\"lower\"") ":3: " "without a shape")
    (,(arm-text "-0.5" "") "2 numbers" ":parked")
    (,(arm-text "(:parked 1" "(:parked 0") ":3: " "shoulder cannot be parked at 0")
    (,(arm-text "(:parked" "(:packed") ":packed" "no option")
    (,(format nil "(:robot r ROBOT (:at 0 0 0)~%~a~%~:*~a)" *arm*) "two arms" "left"))
  "Texts of scenes, each with what its error says.")

(test each-wrong-scene-is-refused-in-one-sentence
  (loop for (text . parts) in *wrong-scenes*
        do (call-with-scene
            (lambda (file)
              (let ((report (report-of 'error (lambda () (projection:load-scene file)))))
                (is-true report "this was read: ~a" text)
                (dolist (part (cons file parts))
                  (is (search part (or report "")) "~s is not in: ~a" part report))
                (is (null (find #\Newline (or report ""))) "more than one line: ~a" report)
                (is (and report (alexandria:ends-with #\. report)) "no sentence: ~a" report)))
            text)))
