;;;; Tests of the Bullet layer: equal bits, states, penetrations.

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
          (discrepancy-finder.bullet:at-rest-p world)))
      (discrepancy-finder.bullet:state-hash world)))
  "A function that can be sent to another process.")

(defun hash-in-another-process ()
  (parse-integer
   (last-line-of-another-process
    "discrepancy-finder/bullet"
    '(defpackage #:discrepancy-finder.tests (:use #:cl))
    `(format t "~%~d" (funcall ,*tumble* nil)))))

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
