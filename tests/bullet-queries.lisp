;;;; Tests of the Bullet layer: equal bits, states, penetrations, rays.

(in-package #:discrepancy-finder.tests)

(in-suite bullet)

;;; Equal bits

(defparameter *tumble*
  '(lambda (queries)
    (discrepancy-finder.bullet:with-world (world)
      (discrepancy-finder.bullet:add-body
       world :floor '(:plane 0 0 1 0) (discrepancy-finder.geometry:identity-pose))
      (dotimes (i 12)
        (discrepancy-finder.bullet:add-body
         world i (if (evenp i) '(:box 0.1d0 0.12d0 0.14d0) '(:cylinder 0.05d0 0.1d0))
         (discrepancy-finder.geometry:make-pose (* 0.02d0 i) (* -0.01d0 i) (+ 0.1d0 (* 0.15d0 i))
          :roll i :pitch (* 0.3d0 i))
         :mass 0.5d0))
      (dotimes (i 300)
        (discrepancy-finder.bullet:step-world world)
        (when queries
          (discrepancy-finder.bullet:deepest-penetration world)
          (discrepancy-finder.bullet:cast-ray world '(0 0 3) (list (* 0.001d0 i) 0 -1))
          (discrepancy-finder.bullet:at-rest-p world)))
      (discrepancy-finder.bullet:state-hash world)))
  "A function that can be sent to another process.")

(defun hash-in-another-process ()
  (let ((forms `((require :asdf)
                 (asdf:load-asd ,(namestring (asdf:system-source-file "discrepancy-finder")))
                 (asdf:load-system "discrepancy-finder/bullet")
                 (defpackage #:discrepancy-finder.tests (:use #:cl))
                 (format t "~%~d" (funcall ,*tumble* nil)))))
    (parse-integer
     (uiop:run-program
      (list* (namestring sb-ext:*runtime-pathname*)
             "--noinform" "--no-sysinit" "--no-userinit" "--non-interactive"
             (loop for form in forms
                   collect "--eval"
                   collect (with-standard-io-syntax
                             (let ((*package* (find-package '#:keyword)) (*print-readably* nil))
                               (prin1-to-string form)))))
      :output (lambda (stream)
                (loop for line = (read-line stream nil)
                      while line for last = line finally (return last)))))))

(test equal-calls-give-equal-bits
  (let* ((tumble (compile nil *tumble*))
         (hash (funcall tumble nil)))
    (is (typep hash '(unsigned-byte 64)))
    (is (= hash (funcall tumble nil)))
    (is (= hash (sb-thread:join-thread (sb-thread:make-thread tumble :arguments '(nil)))))
    (is (= hash (foreign:with-c-float-traps (funcall tumble nil))))
    (is (= hash (hash-in-another-process)))))

(test queries-change-no-bit
  (let ((tumble (compile nil *tumble*)))
    (is (= (funcall tumble nil) (funcall tumble t)))))

(test worlds-in-threads-do-not-disturb-each-other
  (let* ((tumble (compile nil *tumble*))
         (hash (funcall tumble nil))
         (threads (loop repeat 4 collect (sb-thread:make-thread tumble :arguments '(nil)))))
    (loop repeat 3 do (sb-ext:gc))
    (is (every (lambda (thread) (= hash (sb-thread:join-thread thread))) threads))))

(test hash-is-fnv-1a-of-the-state-vector
  (bullet:with-world (world)
    (add-cube world :cube 0.1d0 0.2d0)
    (bullet:step-world world 10)
    (let ((hash 14695981039346656037))
      (loop for number across (bullet:read-state world (bullet:make-state-vector world))
            for bits = (logior (ash (ldb (byte 32 0) (sb-kernel:double-float-high-bits number)) 32)
                               (sb-kernel:double-float-low-bits number))
            do (dotimes (i 8)
                 (setf hash (ldb (byte 64 0) (* 1099511628211
                                                (logxor hash (ldb (byte 8 (* 8 i)) bits)))))))
      (is (= hash (bullet:state-hash world))))))

(test state-vector-agrees-with-bodies
  (bullet:with-world (world)
    (add-floor world)
    (let ((cube (add-cube world :cube 0.3d0 0.4d0)))
      (bullet:step-world world 30)
      (let ((state (bullet:read-state world (bullet:make-state-vector world))))
        (is (= 26 (length state)))
        (is (geometry:pose= (bullet:body-pose cube)
                            (geometry:components-pose (coerce (subseq state 13 20) 'list))))
        (is (equal (multiple-value-list (bullet:body-velocity cube))
                   (coerce (subseq state 20) 'list)))))))

;;; Queries

(test penetration-depths
  (bullet:with-world (world)
    (let ((floor (add-floor world))
          (a (add-cube world :a 0 0.04d0))
          (b (add-cube world :b 0.07d0 0.04d0))
          (c (add-cube world :c 1 0.5d0)))
      (is (near 0.01d0 1d-9 (bullet:penetration a floor)))
      (is (near 0.03d0 1d-3 (bullet:penetration a b)))
      (is (= 0 (bullet:penetration a c)))
      (multiple-value-bind (depth x y) (bullet:deepest-penetration world)
        (is (= depth (bullet:penetration a b)))
        (is (equal (list a b) (list x y))))
      (bullet:place-body b (geometry:make-pose 2 0 1))
      (is (eq floor (nth-value 2 (bullet:deepest-penetration world))))
      (bullet:place-body a (geometry:make-pose 0 0 1))
      (is (equal '(0d0 nil nil) (multiple-value-list (bullet:deepest-penetration world)))))))

(defun hit-p (expected point world from to)
  (multiple-value-bind (body hit fraction) (bullet:cast-ray world from to)
    (and (eq expected body)
         (every (lambda (x y) (near x 1d-9 y)) point hit)
         (every (lambda (a b x) (near x 1d-9 (+ a (* fraction (- b a))))) from to point))))

(test rays-hit-exactly
  (bullet:with-world (world)
    (let* ((floor (add-floor world))
           (box (bullet:add-body world :box '(:box 0.2d0 0.4d0 0.6d0)
                                 (geometry:make-pose 1 0 0.3d0 :yaw (/ pi 2))))
           (ball (bullet:add-body world :ball '(:sphere 0.1d0) (geometry:make-pose 2 0 1)))
           (can (bullet:add-body world :can '(:cylinder 0.1d0 0.4d0) (geometry:make-pose 3 0 1)))
           (pair (bullet:add-body world :pair
                                  (list :compound
                                        (list (geometry:make-pose 0 0 0.5d0) '(:sphere 0.1d0))
                                        (list (geometry:make-pose 0 0 -0.5d0) '(:box 1 1 0.2d0)))
                                  (geometry:make-pose 5 0 1)))
           (mover (bullet:add-body world :mover '(:box 1 1 1) (geometry:make-pose 0 9 1)
                                   :kind :kinematic)))
      (is-true (hit-p box '(0.8d0 0 0.3d0) world '(0 0 0.3d0) '(4 0 0.3d0)))
      (is-true (hit-p box '(1.2d0 0.05d0 0.3d0) world '(4 0.05d0 0.3d0) '(0 0.05d0 0.3d0)))
      (is-true (hit-p box '(1 0 0.6d0) world '(1 0 5) '(1 0 -5)))
      (is-true (hit-p ball (list (- 2 (sqrt 0.0075d0)) 0 1.05d0)
                      world '(1 0 1.05d0) '(2.5d0 0 1.05d0)))
      (is-true (hit-p can '(2.9d0 0 1.1d0) world '(2.5d0 0 1.1d0) '(9 0 1.1d0)))
      (is-true (hit-p can '(3.05d0 0 1.2d0) world '(3.05d0 0 2) '(3.05d0 0 0)))
      (is-true (hit-p pair '(5 0 1.6d0) world '(5 0 3) '(5 0 0)))
      (is-true (hit-p pair '(4.5d0 0 0.5d0) world '(4 0 0.5d0) '(6 0 0.5d0)))
      (is-true (hit-p floor '(7 0 0) world '(7 0 1) '(7 0 -1)))
      (bullet:move-body mover (geometry:make-pose 0 -9 1))
      (is-true (hit-p mover '(0 -9 1.5d0) world '(0 -9 3) '(0 -9 0)))
      (is (eq floor (bullet:cast-ray world '(0 9 3) '(0 9 -1))))
      (is (equal '(nil) (multiple-value-list (bullet:cast-ray world '(7 0 2) '(7 0 1)))))
      (is (null (bullet:cast-ray world '(2 0 1) '(2 0 0.95d0)))
          "A body that holds the start is not seen."))))
