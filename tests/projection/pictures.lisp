;;;; Tests of pictures: top views, perspective pictures, frames of runs.

(in-package #:discrepancy-finder.tests)

(def-suite pictures :in all)
(in-suite pictures)

(defmacro with-view ((projection scene) &body body)
  "Evaluate BODY with PROJECTION bound to a projection of SCENE, in no top-level."
  `(let ((,projection (projection:make-projection ,scene)))
     (unwind-protect (progn ,@body)
       (projection:close-projection ,projection))))

;;; Reading PNG files

(defun big-endian-number (octets start)
  (loop for position from start below (+ start 4)
        for number = (aref octets position) then (+ (* 256 number) (aref octets position))
        finally (return number)))

(defun crc-32 (octets)
  (let ((crc #xffffffff))
    (loop for octet across octets
          do (setf crc (logxor crc octet))
             (loop repeat 8
                   do (setf crc (if (oddp crc)
                                    (logxor #xedb88320 (ash crc -1))
                                    (ash crc -1)))))
    (logxor crc #xffffffff)))

(defun png-chunks (octets)
  "Return the chunks of the PNG file OCTETS as a list of (type . data); check their sums."
  (is (equalp #(137 80 78 71 13 10 26 10) (subseq octets 0 8)))
  (loop with start = 8
        while (< start (length octets))
        collect (let* ((length (big-endian-number octets start))
                       (end (+ start 8 length)))
                  (is (= (crc-32 (subseq octets (+ start 4) end)) (big-endian-number octets end)))
                  (prog1 (cons (map 'string #'code-char (subseq octets (+ start 4) (+ start 8)))
                               (subseq octets (+ start 8) end))
                    (setf start (+ end 4))))))

(defun png-size (octets)
  "Return the list of width and height of the PNG file OCTETS."
  (let ((header (cdr (assoc "IHDR" (png-chunks octets) :test #'string=))))
    (list (big-endian-number header 0) (big-endian-number header 4))))

(defun adler-32 (octets)
  (let ((a 1) (b 0))
    (loop for octet across octets
          do (setf a (mod (+ a octet) 65521)
                   b (mod (+ b a) 65521)))
    (+ (* 65536 b) a)))

(test png-files-are-well-formed
  (let* ((pixels (coerce (loop for i below (* 3 5 4) collect (mod (* 37 i) 256))
                         'projection::octets))
         (chunks (png-chunks (projection::png-octets pixels 5 4)))
         (data (cdr (assoc "IDAT" chunks :test #'string=))))
    (is (equal '("IHDR" "IDAT" "IEND") (mapcar #'car chunks)))
    (is (equalp #(0 0 0 5 0 0 0 4 8 2 0 0 0) (cdr (first chunks))))
    (is (= (adler-32 (coerce (loop for row below 4
                                   collect 0
                                   append (coerce (subseq pixels (* 15 row) (* 15 (1+ row))) 'list))
                             'vector))
           (big-endian-number data (- (length data) 4)))
        "the rows, each after a zero, are what was compressed")))

;;; What is on them

(defun colors-at (projection viewpoint width height point)
  "Return red, green and blue, from 0 to 1, where the position of POINT is in a picture from
VIEWPOINT, and NIL if it is outside of the picture."
  (let* ((local (geometry:compose (geometry:inverse (projection::viewpoint-pose viewpoint)) point))
         (depth (geometry:pose-x local))
         (column (* width 1/2 (- 1 (/ (geometry:pose-y local) depth
                                      (projection::viewpoint-across viewpoint)))))
         (row (* height 1/2 (- 1 (/ (geometry:pose-z local) depth
                                    (projection::viewpoint-upwards viewpoint)))))
         (canvas (projection::make-canvas
                  :world (projection:projection-world projection)
                  :frame (projection::viewpoint-frame viewpoint) :width width :height height
                  :colors (projection::body-colors (projection::projection-chunks projection))
                  :cuts (projection::number-vector '())
                  :walls (projection::number-vector '()))))
    (and (< 0 column width) (< 0 row height)
         (coerce (projection::cast-colors canvas 1 (lambda (index)
                                                     (declare (ignore index))
                                                     (values (float column 1d0) (float row 1d0))))
                 'list))))

(defun hue-of (color)
  "Return COLOR with its largest part made 1."
  (let ((largest (reduce #'max color)))
    (mapcar (lambda (part) (/ part largest)) color)))

(test everything-is-on-the-picture
  (with-view (projection (table-top-scene))
    (projection:settle projection)
    (let* ((chunks (projection::projection-chunks projection))
           (viewpoint (projection::scene-viewpoint chunks 400 300)))
      (loop for (name . body) in (projection:projection-items projection)
            for seen = (colors-at projection viewpoint 400 300 (bullet:body-pose body))
            do (is-true seen "~a is outside" name)
               (is-true (every (lambda (a b) (nearly a b 1d-9))
                               (hue-of (projection::chunk-color
                                        (find body chunks :key #'projection::chunk-body)))
                               (hue-of seen))
                        "~a has another colour" name)))))

(test pictures-have-the-size-asked-for
  (with-view (projection (table-top-scene))
    (is (equal '(120 90) (png-size (projection:view-world projection :view :perspective
                                                                     :width 120))))
    (is (equal '(80 100) (png-size (projection:view-world projection :view :perspective
                                                                     :width 80 :height 100))))
    (is (equal '(70 40) (png-size (projection:view-world projection :view :camera :width 70)))
        "as the camera's angles are")))

(test equal-states-have-equal-pictures
  (flet ((pictures ()
           (with-view (projection (table-top-scene))
             (projection:settle projection)
             (list (projection:state-hash projection)
                   (projection:view-world projection)
                   (projection:view-world projection :view :perspective :width 80)
                   (projection:view-world projection :view :camera :width 80)
                   (projection:state-hash projection)))))
    (let ((first (pictures)))
      (is (= (first first) (fifth first)) "looking changes nothing")
      (is-true (equalp first (pictures)))
      (is-true (equalp first (sb-thread:join-thread (sb-thread:make-thread #'pictures)))))))

(defun text-count (part text)
  "Return how many times PART is in TEXT."
  (loop for start = (search part text) then (search part text :start2 (1+ start))
        while start count t))

(test top-views-have-outlines-and-names
  (with-view (projection (table-top-scene))
    (let ((picture (sb-ext:octets-to-string (projection:view-world projection)
                                            :external-format :utf-8)))
      (is (eql 0 (search "<svg xmlns=\"http://www.w3.org/2000/svg\"" picture)))
      (is (= (text-count "<text" picture) (text-count "</text>" picture)))
      (is (<= 15 (text-count "<polygon points=" picture)))
      (dolist (name '("cereal" "cup" "table" "0" "1"))
        (is-true (search (format nil ">~a</text>" name) picture) "no ~a" name)))))

(test outlines-are-convex-hulls
  (flet ((area (shape pose)
           (let ((outline (projection::chunk-outline
                           (projection::make-chunk :pose pose :shape shape))))
             (loop for (a b) on (append outline (list (first outline)))
                   while b
                   sum (/ (- (* (first a) (second b)) (* (first b) (second a))) 2)))))
    (is (nearly 0.06d0 (area '(:box 0.2d0 0.3d0 0.4d0) (geometry:make-pose 1 2 3 :yaw 1)) 1d-9))
    (is (nearly 0.12d0 (area '(:box 0.2d0 0.3d0 0.4d0)
                           (geometry:make-pose 1 2 3 :pitch (/ pi 2))) 1d-9))
    (is (nearly pi (area '(:sphere 1d0) (geometry:make-pose 1 2 3 :roll 1)) 0.1))
    (is (nearly pi (area '(:cylinder 1d0 3d0) (geometry:make-pose 0 0 0)) 0.1))
    (is (nearly 1/2 (area '(:hull (0d0 0d0 0d0) (1d0 0d0 0d0) (0d0 1d0 0d0) (0d0 0d0 1d0))
                          (geometry:make-pose 0 0 0 :yaw 2)) 1d-9))))

;;; Walls

(defun room-text (name)
  "Return a URDF file with a room of four walls, a floor and a ceiling."
  (format nil "<robot name=~s><link name=\"walls\">~:{<collision><origin xyz=~s/>~
               <geometry><box size=~s/></geometry></collision>~}</link></robot>" name
          '(("-2 0 1" "0.1 4 2") ("2 0 1" "0.1 4 2") ("0 -2 1" "4 0.1 2") ("0 2 1" "4 0.1 2")
            ("0 0 2.05" "4.1 4.1 0.1"))))

(test pictures-look-through-walls-on-the-near-side
  (with-file (room (room-text "room") "urdf")
    (with-file (file (format nil "(define-scene s (:fixture room ~s (:at 0 0 0))
                                    (:item cup ~s (:at 0 0 0.05)))"
                             room (root-file "models/table-top/cup.urdf")))
      (with-view (projection (projection:load-scene file))
        (let* ((chunks (projection::projection-chunks projection))
               (walls (projection::enclosing-faces chunks))
               (viewpoint (projection::scene-viewpoint chunks 40 30)))
          (is (= 5 (length walls)))
          (is (= 1 (length (projection::contents chunks))))
          (is (= 3 (length (projection::near-faces
                            walls (geometry:make-pose 5 -5 5)))) "two walls and the ceiling")
          (is (= 0 (length (projection::near-faces walls (geometry:make-pose 0 0 1)))))
          (is (= (1- (length chunks)) (length (projection::below-ceilings chunks))))
          ;; The cup is red in the middle of the picture, if no wall is before it.
          (let* ((pixels (projection::canvas-pixels
                          (projection::make-canvas
                           :world (projection:projection-world projection)
                           :frame (projection::viewpoint-frame viewpoint) :width 40 :height 30
                           :colors (projection::body-colors chunks)
                           :walls (projection::number-vector (apply #'append walls))
                           :cuts (projection::number-vector
                                  (apply #'append
                                         (projection::near-faces
                                          walls (projection::viewpoint-pose viewpoint)))))))
                 (middle (* 3 (+ 20 (* 40 15)))))
            (is (> (aref pixels middle) (* 2 (aref pixels (+ middle 2)))))))))))

;;; Files

(defun folder-files (folder)
  "Return the sorted names of the files in FOLDER, hidden ones included."
  (sort (uiop:run-program (list "ls" "-A" folder) :output :lines) #'string<))

(test picture-files-are-written-at-once
  (call-in-new-folder
   (lambda (folder)
     (with-view (projection (table-top-scene))
       (flet ((file (name) (concatenate 'string folder name)))
         (dolist (name '("top.svg" "top.png" "side.png" "SIDE.PNG" "top [1].svg"))
           (is (pathnamep (projection:view-world projection :file (file name) :width 60
                                                            :view (if (eql (char name 0) #\t)
                                                                      :top
                                                                      :perspective)))))
         (is (equal '("SIDE.PNG" "side.png" "top [1].svg" "top.png" "top.svg")
                    (folder-files folder))
             "and no other files are left")
         (is (equalp (projection:view-world projection :width 60)
                     (alexandria:read-file-into-byte-vector (file "top.svg"))))
         (projection:view-world projection :file (file "top.svg") :view :top :width 61)
         (is (equalp (projection:view-world projection :width 61)
                     (alexandria:read-file-into-byte-vector (file "top.svg")))
             "a file that is there is replaced")
         (signals-with (projection:picture-error "nowhere/x.png" "cannot be written")
           (projection:view-world projection :file (file "nowhere/x.png") :width 20)))))))

(test what-is-wrong-with-a-picture-is-named
  (with-view (projection (table-top-scene))
    (signals-with (projection:picture-error "x.gif" ".png" ".svg")
      (projection:view-world projection :file "x.gif"))
    (signals-with (projection:picture-error "x.svg" "top views")
      (projection:view-world projection :file "x.svg"))
    (signals-with (projection:picture-error ":side" ":top, :perspective or :camera")
      (projection:view-world projection :view :side))
    (signals-with (projection:picture-error "width" "100000")
      (projection:view-world projection :width 100000))
    (signals-with (projection:picture-error "height" "0.5")
      (projection:view-world projection :view :perspective :height 0.5))
    (signals-with (projection:picture-error "camera")
      (projection:view-world projection :view :perspective :camera '(1 2 3))))
  (with-view (projection (discrepancy:domain-scene (two-regions)))
    (signals-with (projection:missing-robot-part "camera")
      (projection:view-world projection :view :camera)))
  (let ((projection (projection:make-projection (table-top-scene))))
    (projection:close-projection projection)
    (signals bullet:bullet-error (projection:view-world projection))))

(test cameras-look-where-they-should
  (loop for (from target) in '(((0 0 1) (1 0 1)) ((1 2 3) (-1 0 0.5)) ((0 0 2) (0 0 0))
                               ((0 0 0) (0 0 2)))
        for pose = (projection:viewing-pose (apply #'geometry:make-pose from)
                                            (apply #'geometry:make-pose target))
        for local = (geometry:compose (geometry:inverse pose) (apply #'geometry:make-pose target))
        do (is (< 0 (geometry:pose-x local)))
           (is (nearly 0 (geometry:pose-y local) 1d-9))
           (is (nearly 0 (geometry:pose-z local) 1d-9))))

;;; Frames

(test each-performed-designator-has-a-frame
  (call-in-new-folder
   (lambda (folder)
     (let ((run (df:run-plan 'discrepancy-finder-user::find-object :domain :table-top
                             :state '((cereal :x 1.5))
                             :observer (lambda (projection designator failure)
                                         (declare (ignore projection))
                                         (is (typep failure '(or null plan:plan-failure)))
                                         (is (typep designator
                                                    '(or null plan:motion-designator)))))))
       (is (= 6 (length (df:run-steps run)))))
     (let ((recorder (projection:make-frame-recorder folder)))
       (with-view (projection (discrepancy:domain-scene (two-regions)))
         (projection:watch-projection projection (projection:frame-observer recorder))
         (perform-in projection (going-to 0.6 0 0))
         (signals plan:plan-failure
           (perform-in projection (plan:an action (type picking-up)
                                           (object (plan:an object (type box)))))))
       (is (= 3 (projection:finish-frames recorder)))
       (is (equal '("frame-000-perspective.png" "frame-000-top.svg" "frame-001-perspective.png"
                    "frame-001-top.svg" "frame-002-perspective.png" "frame-002-top.svg"
                    "index.html")
                  (folder-files folder)))
       (let ((page (uiop:read-file-string (concatenate 'string folder "index.html"))))
         (is (search "the beginning" page))
         (is (search "going" page))
         (is (search "picking-up" page))
         (is (search "frame-002-top.svg" page)))))))

(test frames-do-not-change-a-run
  (call-in-new-folder
   (lambda (folder)
     (flet ((hash (&rest options)
              (df:run-hash (apply #'df:run-plan 'discrepancy-finder-user::find-object
                                  :domain :table-top options))))
       (is (= (hash)
              (hash :observer (projection:frame-observer
                               (projection:make-frame-recorder folder)))))))))

(test frames-go-where-they-are-told
  (signals-with (projection:picture-error "directory for frames is empty")
    (projection:make-frame-recorder ""))
  (call-in-new-folder
   (lambda (folder)
     (let ((recorder (projection:make-frame-recorder (concatenate 'string folder "a/c [b]*"))))
       (is (equal '("c [b]*") (folder-files (concatenate 'string folder "a"))))
       (projection:abandon-frames recorder)
       (is (equal '() (folder-files folder)) "what was made is removed"))
     (projection:abandon-frames (projection:make-frame-recorder folder))
     (is (uiop:directory-exists-p folder) "what was there is not"))))

(test frames-that-cannot-be-written-are-told
  (signals-with (projection:picture-error "/proc/nowhere" "cannot be written")
    (projection:make-frame-recorder "/proc/nowhere/"))
  (call-in-new-folder
   (lambda (folder)
     (let* ((inner (concatenate 'string folder "inner/"))
            (recorder (projection:make-frame-recorder inner)))
       (with-view (projection (table-top-scene))
         (uiop:delete-directory-tree (pathname inner) :validate t)
         (projection:watch-projection projection (projection:frame-observer recorder))
         (perform-in projection (looking-at 0.4 0.8 0.8)))
       (signals-with (projection:picture-error "frame-000" "cannot be written")
         (projection:finish-frames recorder))))))

;;; Runs in a scene

(test plans-run-in-a-scene-without-a-domain
  (let* ((scene (table-top-scene))
         (run (discrepancy:run-in-scene 'discrepancy-finder-user::find-object scene
                                        :state '((cereal :x 1.5)))))
    (is (eq :finished (discrepancy:scene-run-ending run)))
    (is (= (df:run-hash (df:run-plan 'discrepancy-finder-user::find-object :domain :table-top
                                     :state '((cereal :x 1.5))))
           (discrepancy:scene-run-hash run)))
    (let ((text (discrepancy:scene-run-text run)))
      (dolist (part '("  6. (a motion (type detecting)" "perception-object-not-found"
                      "finally (finished" "cereal at 1.5000 0.6500"))
        (is (search part text) "~a is not in ~a" part text)))
    (is (eq 'plan:perception-object-not-found
            (discrepancy:scene-run-ending
             (discrepancy:run-in-scene 'discrepancy-finder-user::find-object scene
                                       :state '((cereal :x 5)))))))
  (signals projection:unknown-body
    (discrepancy:run-in-scene 'discrepancy-finder-user::find-object (table-top-scene)
                              :state '((teapot :x 1.5))))
  (signals-with (discrepancy:invalid-argument "seed is -1" "an integer from 0")
    (discrepancy:run-in-scene 'discrepancy-finder-user::find-object (table-top-scene)
                              :seed -1)))
