;;;; Regions beyond boxes, joints and computed fluents in an abstraction, and samples of them.

(in-package #:discrepancy-finder.tests)

(def-suite regions :in all)
(in-suite regions)

(defun described-region (form)
  "Return the region written as FORM."
  (discrepancy::parse-region 'test (list :region 'test form)))

(defun inside (form x y &rest more)
  (discrepancy:inside-region-p (apply #'geometry:make-pose x y more) (described-region form)))

(test polygons
  (let ((triangle '(polygon (0 0) (2 0) (0 2))))
    (is-true (inside triangle 0.5d0 0.5d0 7))
    (is-false (inside triangle 1.5d0 1.5d0 0))
    (is (equal '((:x 0d0 2d0) (:y 0d0 2d0))
               (discrepancy:region-bounds (described-region triangle))))))

(test two-polygons-share-a-border
  "Every point near the common side belongs to exactly one of two squares cut out of one."
  (let ((left '(polygon (0 0) (1 0) (2 2) (0 2))) (right '(polygon (1 0) (3 0) (3 2) (2 2))))
    (loop for i from 0 below 200
          for y = (/ (+ i 0.5d0) 100)
          for x = (+ 1 (/ y 2))
          do (is (= 1 (count t (list (inside left x y 0) (inside right x y 0))))))))

(test unions-differences-intersections
  (let ((frame '(difference (box (x 0 3) (y 0 3)) (box (x 1 2) (y 1 2))))
        (corner '(union (box (x 0 3) (y 0 1)) (box (x 0 1) (y 0 3))))
        (slice '(intersection (polygon (0 0) (2 0) (0 2)) (interval x 1 5))))
    (is-true (inside frame 0.5d0 1.5d0 0))
    (is-false (inside frame 1.5d0 1.5d0 0))
    (is-true (inside frame 2 1.5d0 0) "what is taken away is half-open, too")
    (is-true (inside corner 2.5d0 0.5d0 0))
    (is-false (inside corner 2.5d0 2.5d0 0))
    (is-true (inside slice 1.2d0 0.5d0 0))
    (is-false (inside slice 0.5d0 0.5d0 0))
    (is (equal '((:x 1d0 2d0) (:y 0d0 2d0)) (discrepancy:region-bounds (described-region slice))))
    (is (equal '((:x 0d0 3d0) (:y 0d0 3d0))
               (discrepancy:region-bounds (described-region corner))))))

(defun in-the-unit-disk-p (pose)
  (< (+ (expt (geometry:pose-x pose) 2) (expt (geometry:pose-y pose) 2)) 1))

(test regions-with-a-predicate
  (let ((disk '(where (box (x -1 1) (y -1 1)) in-the-unit-disk-p)))
    (is-true (inside disk 0.5d0 0.5d0 0))
    (is-false (inside disk 0.9d0 0.9d0 0))
    (is (string= (format nil "#<REGION test (x in [-1.0d0, 1.0d0[, y in [-1.0d0, 1.0d0[ where ~
                              in-the-unit-disk-p)>")
                 (princ-to-string (described-region disk))))))

(test boxes-that-are-certainly-inside
  (flet ((certain-p (form x-min x-max y-min y-max)
           (discrepancy::box-inside-p `((:x ,(float x-min 1d0) ,(float x-max 1d0))
                                        (:y ,(float y-min 1d0) ,(float y-max 1d0)))
                                      (discrepancy:region-description (described-region form)))))
    (is-true (certain-p '(polygon (0 0) (2 0) (0 2)) 0.1 0.9 0.1 0.9))
    (is-false (certain-p '(polygon (0 0) (2 0) (0 2)) 0.1 1.1 0.1 1))
    (is-true (certain-p '(union (box (x 0 1) (y 0 1)) (box (x 1 2) (y 0 1))) 1.2 1.8 0 1))
    (is-false (certain-p '(difference (box (x 0 3) (y 0 3)) (box (x 1 2) (y 1 2))) 0.5 1.5 0.5 1.5))
    (is-true (certain-p '(difference (box (x 0 3) (y 0 3)) (box (x 1 2) (y 1 2))) 0.5 0.9 0 3))
    (is-false (certain-p '(where (box (x 0 3) (y 0 3)) in-the-unit-disk-p) 0 0.1 0 0.1))))

(test what-is-wrong-with-regions
  (loop for (form . parts) in '(((polygon (0 0) (1 0)) "three corners")
                                ((polygon (0 0) (2 2) (2 0) (0 2)) "convex")
                                ((polygon (0 0) (2 0) (1 0.5d0) (0 2)) "convex")
                                ((polygon (0 0) (1 0) 3) "corner (x y)")
                                ((union) "union of no regions")
                                ((where (interval x 0 1)) "(where region function-name)")
                                ((intersection (interval x 0 1) (interval x 2 3))
                                 "nothing is in it")
                                ((sphere 1) "sphere is no kind of region"))
        do (let ((report (report-of 'discrepancy:abstraction-error
                                    (lambda () (described-region form)))))
             (dolist (part parts)
               (is (search part (or report "")) "~s is not in: ~a" part report)))))

(test samples-fill-their-regions
  "Samples of a disk are uniform in it: as many as chance lets be in each quarter and in the inner
half of its area; the same seed draws the same ones."
  (let* ((region (described-region '(where (box (x -1 1) (y -1 1)) in-the-unit-disk-p)))
         (parameters (loop for axis in '(:x :y)
                           collect (discrepancy::make-parameter :box axis -1d0 1d0 nil region)))
         (poses (loop for index below 2000
                      for values = (discrepancy:sample-values
                                    (discrepancy:draw-sample parameters 5 77 index))
                      collect (geometry:make-pose (aref values 0) (aref values 1) 0))))
    (is (every #'in-the-unit-disk-p poses))
    (loop for (sx sy) in '((1 1) (1 -1) (-1 1) (-1 -1))
          do (is (< 420 (count-if (lambda (pose)
                                    (and (plusp (* sx (geometry:pose-x pose)))
                                         (plusp (* sy (geometry:pose-y pose)))))
                                  poses)
                    580)))
    (is (< 900 (count-if (lambda (pose)
                           (< (+ (expt (geometry:pose-x pose) 2) (expt (geometry:pose-y pose) 2))
                              1/2))
                         poses)
           1100))
    (is (equalp (discrepancy:sample-values (discrepancy:draw-sample parameters 5 77 9))
                (discrepancy:sample-values (discrepancy:draw-sample parameters 5 77 9))))))

(defun nowhere-p (pose)
  (declare (ignore pose))
  nil)

(test an-empty-region-is-an-error
  (let ((region (described-region '(where (interval x 0 1) nowhere-p))))
    (signals-with (discrepancy:sampling-error "no place in region test was found")
      (discrepancy:draw-sample (list (discrepancy::make-parameter :box :x 0d0 1d0 nil region))
                               1 1 0))))

(defun box-above-p (projection)
  "A computed fluent: the box of Example 1 is higher than 0.4 m."
  (< 0.4d0 (geometry:pose-z (projection:observed-pose projection :box))))

(defun lifting-domain ()
  "Return Example 1's scene with a theory of a lifted arm and a box high up."
  (with-file (theory "(define-theory lifting
  (:sorts (region r1 r2)) (:fluents (robot-in region) (box-in region) (lifted) (high))
  (:axioms (initially (lifted))))")
    (discrepancy::parse-abstraction
     'lifting `((:theory ,theory) (:scene "scene.lisp")
                (:region r1 (interval x 0 1)) (:region r2 (polygon (1 -1) (2 -1) (2 1) (1 1)))
                (:placement (robot-in ?region) :body robot :coordinates (x (y 0)))
                (:placement (box-in ?region) :body box :coordinates (x (y 0.38d0 0.42d0)))
                (:joint (lifted) :joint "lift_joint" :range (0.3d0 0.5d0) :otherwise (0 0.1d0))
                (:computed (high) box-above-p))
     :file (root-file "models/two-regions/domain.lisp"))))

(test joints-and-computed-fluents-are-observed
  (let ((domain (lifting-domain)))
    (loop for (lift . expected) in '((0.4d0 (:robot-in :r1) (:box-in :r2) (:lifted) (:high))
                                     (0.2d0 (:robot-in :r1) (:box-in :r2) (:high)))
          do (is (equal expected
                        (projection:with-projection (projection (discrepancy:domain-scene domain)
                                                                :joints (list (cons "lift_joint"
                                                                                    lift)))
                          (discrepancy:observed-fluents
                           (discrepancy:discrete-state domain projection))))))))

(test predictions-are-to-lie-in-regions-that-are-no-boxes
  (let ((parameters (loop for axis in '(:x :y)
                          collect (discrepancy::make-parameter
                                   :box axis 0d0 2d0 nil
                                   (described-region '(polygon (0 0) (2 0) (0 2)))))))
    (is-true (discrepancy::inside-final-regions-p parameters '((0.1d0 . 0.9d0) (0.1d0 . 0.9d0))))
    (is-false (discrepancy::inside-final-regions-p parameters '((0.1d0 . 1.5d0) (0.1d0 . 1.5d0)))
              "in the box around the triangle, but not in it")
    (is-true (discrepancy::inside-final-regions-p parameters '()))))
