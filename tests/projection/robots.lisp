;;;; Robots as they are published.
;;;;
;;;; The environment variable DISCREPANCY_FINDER_ROBOTS names a folder below which
;;;; pr2_description/urdf/pr2.urdf and tiago_description/robots/tiago.urdf are with their meshes, as
;;;; in the Python package example-robot-data.  Without it the test is skipped.

(in-package #:discrepancy-finder.tests)
(in-suite urdf)

(defun published-robot (folder name)
  "Return the first file below FOLDER whose path ends with NAME."
  (let ((found nil))
    (uiop:collect-sub*directories
     (uiop:ensure-directory-pathname folder) t t
     (lambda (folder)
       (let ((file (uiop:subpathname folder name)))
         (when (and (null found) (uiop:file-exists-p file))
           (setf found file)))))
    found))

(test published-robots-are-read
  (let ((folder (uiop:getenvp "DISCREPANCY_FINDER_ROBOTS")))
    (cond ((not *long*) (skip "Only the long run tests this."))
          ((null folder) (skip "DISCREPANCY_FINDER_ROBOTS does not name a folder of robots."))
          (t (loop for (name link-count moving-count)
                     in '(("pr2_description/urdf/pr2.urdf" 82 30)
                          ("tiago_description/robots/tiago.urdf" 78 48)
                          ("tiago_description/robots/tiago_dual.urdf" 130 101))
                   for file = (published-robot folder name)
                   do (is-true file "there is no ~a" name)
                      (let* ((model (projection:read-urdf file))
                             (groups (projection::rigid-groups model)))
                        (is (= link-count (length (projection:urdf-model-links model))))
                        (is (= moving-count (1- (length groups))))
                        (is (every (lambda (link)
                                     (let ((shape (projection::urdf-link-shape link)))
                                       (or (null shape)
                                           (< 0 (discrepancy-finder.bullet:shape-volume shape)
                                              1))))
                                   (projection:urdf-model-links model)))
                        (with-file (scene (format nil "(define-scene s (:robot r ~s (:at 1 0 0)))"
                                                  (uiop:native-namestring file)))
                          (projection:with-projection (projection (projection:load-scene scene))
                            (perform-in projection (going-to 0 0 0))
                            (is (near-p 0 (geometry:pose-x
                                           (projection:observed-pose projection :r))
                                        1d-6))))))))))
