;;;; VIEW-WORLD: a picture of a projection as it is, without a window system.
;;;;
;;;; The same state gives the same octets.  A file appears under its name when it is complete.

(in-package #:discrepancy-finder.projection)

(defparameter *picture-limit* 4000
  "Pictures have at most so many pixels a side.")

(defun picture-problem (control &rest arguments)
  (error 'picture-error :reason (apply #'format nil control arguments)))

(defun check-picture-size (width height)
  (loop for (thing size) in `(("width" ,width) ("height" ,height))
        do (unless (typep size `(or null (integer 1 ,*picture-limit*)))
             (picture-problem "The ~a of a picture is ~s where a number of pixels from 1 to ~d was ~
                               expected" thing size *picture-limit*))))

(defun picture-viewpoint (projection chunks view camera width height)
  "Return the viewpoint for VIEW and CAMERA, the arguments of VIEW-WORLD."
  (cond ((pose-p camera) (pose-viewpoint camera width height))
        ((eq view :camera) (robot-viewpoint projection))
        ((eq view :top) (multiple-value-call #'downward-viewpoint (top-view-bounds chunks)))
        (t (scene-viewpoint chunks width height))))

(defun viewpoint-height (viewpoint width)
  "Return the height of a picture from VIEWPOINT, WIDTH pixels wide, whose pixels are square."
  (max 1 (round (* width (/ (viewpoint-upwards viewpoint) (viewpoint-across viewpoint))))))

(defun png-picture (projection view camera width height)
  (let* ((chunks (projection-chunks projection))
         (shown (remove :ground chunks :key #'chunk-role))
         (height (or height (round width 4/3)))
         (viewpoint (picture-viewpoint projection shown view camera width height)))
    (picture-octets projection chunks viewpoint width
                    (if (and (member view '(:top :camera)) (null camera))
                        (viewpoint-height viewpoint width)
                        height)
                    :passed (and (eq view :camera) (projection-robot projection)
                                 (link-bodies (projection-robot projection))))))

(defun svg-picture (projection width)
  (sb-ext:string-to-octets
   (with-output-to-string (stream)
     (draw-top-view projection
                    (remove :ground (projection-chunks projection) :key #'chunk-role)
                    width stream))
   :external-format :utf-8))

(defun picture-type (file view)
  "Return the kind of picture that FILE, a pathname or NIL, is to hold: :SVG or :PNG."
  (let ((type (and file (pathname-type file))))
    (cond ((null file) (if (eq view :top) :svg :png))
          ((equalp type "png") :png)
          ((not (equalp type "svg"))
           (picture-problem "~a ends neither in .png nor in .svg" (source:native-name file)))
          ((eq view :top) :svg)
          (t (picture-problem "~a: only top views are drawn as SVG, others as PNG"
                              (source:native-name file))))))

(defun write-file-at-once (octets file)
  "Write OCTETS into FILE, which appears, or changes, when all of them are written."
  (let* ((name (source:native-name (merge-pathnames file (uiop:getcwd))))
         (temporary (format nil "~a.~36r.tmp" name (random (expt 36 8) (make-random-state t)))))
    (flet ((give-up (reason)
             (picture-problem "~a cannot be written: ~a" (source:native-name file)
                              (string-right-trim "." reason))))
      (unwind-protect
           (handler-case
               (progn
                 (with-open-file (stream (source:native-path temporary)
                                         :direction :output :if-exists :supersede
                                         :element-type '(unsigned-byte 8))
                   (write-sequence octets stream))
                 ;; RENAME-FILE takes brackets in a name for a pattern.
                 (multiple-value-bind (success number) (sb-unix:unix-rename temporary name)
                   (unless success
                     (give-up (sb-int:strerror number)))))
             ((or file-error stream-error) (condition)
               (give-up (source:condition-sentence condition))))
        (sb-unix:unix-unlink temporary)))))

(defun view-world (projection &key file (view (if file :perspective :top)) camera (width 800)
                                height)
  "Draw a picture of PROJECTION, as it is now.  VIEW is :TOP, from above with names; :PERSPECTIVE,
from obliquely above; or :CAMERA, what the robot's camera sees if its own links are left out.
CAMERA is a pose from which to look instead, along its x axis; see VIEWING-POSE.  FILE ends in .png,
or, for top views, in .svg; it is written, and returned as a pathname.  Without FILE the picture is
returned as a vector of octets, an SVG file for :TOP, else a PNG file.  WIDTH and HEIGHT are in
pixels; HEIGHT counts for :PERSPECTIVE, by default 3/4 of WIDTH.  Nothing in PROJECTION changes, and
equal states have equal pictures.  Signals PICTURE-ERROR, and MISSING-ROBOT-PART for the view of a
camera that there is not."
  (check-picture-size width height)
  (unless (member view '(:top :perspective :camera))
    (picture-problem "The view is ~(~s~) where :top, :perspective or :camera was expected" view))
  (unless (or (null camera) (and (pose-p camera) (eq view :perspective)))
    (picture-problem "The camera is ~s where a pose, for a view :perspective, was expected" camera))
  (let* ((file (and file (source:native-path file)))
         (octets (if (eq (picture-type file view) :svg)
                     (svg-picture projection width)
                     (png-picture projection view camera width height))))
    (cond (file (write-file-at-once octets file) file)
          (t octets))))
