;;;; Clearances of mechanisms: of a posture, and along the way of the joints.

(in-package #:discrepancy-finder.tests)

(in-suite motion-runs)

(test clearance-is-that-of-the-posture
  (with-carrier (carrier)
    (let* ((world (carrier-world carrier))
           (mechanism (carrier-mechanism carrier))
           (wall (add-box world "wall" (geometry:make-pose 1.5d0 0 0)))
           (links (list (carrier-base carrier) (carrier-hand carrier)))
           (held (list (carrier-item carrier)))
           (posture (goal 0 0.5d0 0 0)))
      (flet ((clearance (x watched &rest obstacles)
               (multiple-value-list
                (bullet:mechanism-clearance mechanism (geometry:make-pose x 0 0) posture
                                            watched (or obstacles (list wall)) 1))))
        (destructuring-bind (distance body obstacle) (clearance 0.2d0 links)
          (is (near 0.68d0 1d-9 distance))
          (is (eq (carrier-hand carrier) body))
          (is (eq wall obstacle)))
        (is (near 0.61d0 1d-6 (first (clearance 0.2d0 held))))
        (is (equal (list 0d0 (carrier-hand carrier) wall) (clearance 1 links)))
        (is (equal '(1d0 nil nil) (clearance -1 links)))
        ;; Its own links are where they would be.
        (is (near (sqrt (+ (expt 0.28d0 2) (expt 0.53d0 2))) 1d-6
                  (first (clearance 0 (list (carrier-hand carrier)) (carrier-base carrier)))))
        (setf posture (goal 0 0.2d0 0 0))
        (is (near (sqrt (+ (expt 0.28d0 2) (expt 0.23d0 2))) 1d-6
                  (first (clearance 0 (list (carrier-hand carrier)) (carrier-base carrier)))))
        ;; What is attached goes along, and does not count for the hand that holds it.
        (is (near (sqrt (+ (expt 0.33d0 2) (expt 0.15d0 2))) 1d-6
                  (first (clearance 0 links (carrier-item carrier)))))
        (signals bullet:bullet-error
          (bullet:mechanism-clearance mechanism (geometry:identity-pose) posture links held 0))))))

(test path-contact-is-where-the-way-is-blocked
  (with-carrier (carrier)
    (let* ((world (carrier-world carrier))
           (mechanism (carrier-mechanism carrier))
           (post (bullet:add-body world "post" '(:box 0.02d0 0.02d0 2)
                                  (geometry:make-pose 0 0.5d0 1)))
           (start (goal 0 0.5d0 0 0)) (goal (goal 0 0.5d0 2 0)))
      (flet ((contact (watched &rest options)
               (multiple-value-list
                (apply #'bullet:path-contact mechanism (geometry:identity-pose) start goal
                       watched (list post) options))))
        (destructuring-bind (fraction body obstacle) (contact (list (carrier-hand carrier)))
          (is (eq (carrier-hand carrier) body))
          (is (eq post obstacle))
          ;; Run the same way with time: both agree.
          (let ((steps (run-carrier carrier :fast
                                    :steps 1000 :goal goal
                                    :fractions (let ((fractions (make-array
                                                                 1000
                                                                 :element-type 'double-float)))
                                                 (dotimes (i 1000 fractions)
                                                   (setf (aref fractions i) (/ (1+ i) 1d3))))
                                    :watched (list (carrier-hand carrier))
                                    :obstacles (list post))))
            (is (near (/ steps 1000) 2d-3 fraction))))
        (is (< (first (contact (list (carrier-hand carrier)) :contact-distance 0.05d0))
               (first (contact (list (carrier-hand carrier))))))
        (is (equal '(nil) (contact (list (carrier-base carrier)))))
        (bullet:ignore-collision post (carrier-hand carrier) t)
        (is (equal '(nil) (contact (list (carrier-hand carrier)))))))))

;;; Skipping
