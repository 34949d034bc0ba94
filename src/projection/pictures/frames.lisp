;;;; Frames: pictures of a run, one pair for each performed designator.
;;;;
;;;; A RECORDER is told the state of a projection again and again by RECORD-FRAME and writes a top
;;;; view and a perspective picture each time, into files with the frame's number; FINISH-FRAMES
;;;; writes a page that shows them.  What is performed in a projection is told to its observer, a
;;;; function, so that WATCH-PROJECTION is all it takes.

(in-package #:discrepancy-finder.projection)

(defstruct (recorder (:copier nil))
  "Writes frames into DIRECTORY.  CAMERA is the pose from which all perspective pictures are taken,
NIL before the first; CAPTIONS a list of texts, the last frame's first; PROBLEM the error that kept
a frame from being written, or NIL.  NEW-FOLDERS are those that were made for it, innermost first."
  (directory nil :type pathname :read-only t)
  (new-folders '() :type list :read-only t)
  (camera nil :type (or null pose))
  (captions '() :type list)
  (problem nil))

(defun frame-folder (directory)
  "Return the absolute pathname of the folder DIRECTORY.  Signals PICTURE-ERROR if it is empty."
  (when (equal directory "")
    (picture-problem "The name of the directory for frames is empty"))
  (merge-pathnames (folder-pathname directory) (uiop:getcwd)))

(defun missing-folders (path)
  "Return PATH and the folders above it as far as they do not exist."
  (loop until (or (uiop:directory-exists-p path)
                  (uiop:pathname-equal path (uiop:pathname-parent-directory-pathname path)))
        collect path
        do (setf path (uiop:pathname-parent-directory-pathname path))))

(defun make-frame-recorder (directory)
  "Return a recorder of frames that are written into DIRECTORY, which is made if need be.  Signals
PICTURE-ERROR if that cannot be or nothing can be written there."
  (let* ((path (frame-folder directory))
         (new-folders (missing-folders path))
         (probe (merge-pathnames (format nil ".~36r.tmp" (random (expt 36 8)
                                                                 (make-random-state t)))
                                 path)))
    (handler-case
        (progn
          (ensure-directories-exist path)
          (with-open-file (stream probe :direction :output) (declare (ignorable stream)))
          (delete-file probe))
      ((or file-error stream-error) (condition)
        (picture-problem "The directory ~a cannot be written to: ~a" directory
                         (string-right-trim "." (source:condition-sentence condition)))))
    (make-recorder :directory path :new-folders new-folders)))

(defun abandon-frames (recorder)
  "Remove the folders that were made for RECORDER, if it has not recorded anything."
  (unless (recorder-captions recorder)
    (ignore-errors (mapc #'uiop:delete-empty-directory (recorder-new-folders recorder))))
  (values))

(defun frame-file (recorder number view type)
  (merge-pathnames (format nil "frame-~3,'0d-~(~a~).~a" number view type)
                   (recorder-directory recorder)))

(defun frame-camera (recorder projection)
  "Return the pose from which RECORDER takes its perspective pictures of PROJECTION."
  (or (recorder-camera recorder)
      (setf (recorder-camera recorder)
            (viewpoint-pose (scene-viewpoint (projection-chunks projection) 4 3)))))

(defun record-frame (recorder projection caption)
  "Write the pictures of PROJECTION, as it is now, as the next frame of RECORDER, with the text
CAPTION.  After an error no more are written; FINISH-FRAMES signals it."
  (unless (recorder-problem recorder)
    (handler-case
        (let ((number (length (recorder-captions recorder))))
          (view-world projection :file (frame-file recorder number :top "svg") :view :top)
          (view-world projection :file (frame-file recorder number :perspective "png")
                                 :camera (frame-camera recorder projection))
          (push caption (recorder-captions recorder)))
      (error (condition) (setf (recorder-problem recorder) condition)))))

(defun frame-caption (recorder projection designator failure)
  "Return what the next frame of RECORDER, after DESIGNATOR, is about; without one it is the
beginning or the end."
  (format nil "~,2f s: ~a" (simulated-seconds projection)
          (cond (failure (format nil "~a: ~a" designator (source:condition-sentence failure)))
                (designator (princ-to-string designator))
                ((recorder-captions recorder) "the end")
                (t "the beginning"))))

(defun frame-observer (recorder)
  "Return a function of a projection, a designator and a failure, or NIL, that records frames by
RECORDER; see WATCH-PROJECTION."
  (lambda (projection designator failure)
    (record-frame recorder projection (frame-caption recorder projection designator failure))))

(defun frames-page (recorder)
  "Return the text of an HTML page with all frames of RECORDER."
  (with-output-to-string (stream)
    (format stream "<!DOCTYPE html>~%<html><head><meta charset=\"utf-8\"><title>Frames</title>~%~
                    <style>body { font-family: sans-serif } img { width: 48%; ~
                    vertical-align: top }</style></head><body>~%")
    (loop for caption in (reverse (recorder-captions recorder))
          for number from 0
          do (format stream "<h4>~d. ~a</h4>~%~{<img src=\"~a\" alt=\"\">~^ ~}~%" number
                     (escaped-text caption)
                     (loop for (view type) in '((:top "svg") (:perspective "png"))
                           collect (file-namestring (frame-file recorder number view type)))))
    (format stream "</body></html>~%")))

(defun finish-frames (recorder)
  "Write index.html, which shows all frames of RECORDER, and return their number.  Signals
PICTURE-ERROR, or the error that kept a frame from being written."
  (when (recorder-problem recorder)
    (error (recorder-problem recorder)))
  (write-file-at-once (sb-ext:string-to-octets (frames-page recorder) :external-format :utf-8)
                      (merge-pathnames "index.html" (recorder-directory recorder)))
  (length (recorder-captions recorder)))

;;; Observers

(defun watch-projection (projection observer)
  "Let OBSERVER be called with PROJECTION, the designator and the failure, or NIL, whenever
something has been performed in PROJECTION; and now, with NIL for a designator.  OBSERVER NIL ends
that."
  (setf (projection-observer projection) observer)
  (when observer
    (funcall observer projection nil nil))
  (values))

(defun tell-observer (projection designator failure)
  (let ((observer (projection-observer projection)))
    (when observer
      (plan:call-on-main (lambda () (funcall observer projection designator failure))))))

(defmethod plan:perform-with :around ((projection projection) designator position)
  (declare (ignore position))
  (if (projection-observer projection)
      (handler-case (multiple-value-prog1 (call-next-method)
                      (tell-observer projection designator nil))
        (plan:plan-failure (failure)
          (tell-observer projection designator failure)
          (plan:fail failure)))
      (call-next-method)))
