;;;; How often does a confidence rule certify a trace that is discrepant?
;;;;
;;;; A replicate is a made-up simulation: n initial parameters, uniform in a box, n final ones, a
;;;; map of them with normal noise of 5 cm.  The true probability p of a discrepancy is known:
;;;; either a box of volume p, somewhere, from which the first final parameter jumps out of its
;;;; bounds, or the tail of the noise at the bounds.  Samples are drawn until one is a discrepancy
;;;; or the rule is satisfied, which is a miss.  Where p is above delta, rules with a guarantee may
;;;; miss it no more often than 1 - confidence.

(in-package #:discrepancy-finder.bench)

(defparameter *calibration-rules* '(:paper :paper-sd :prediction :zero-failure :sound))

(defconstant +noise+ 0.05d0)
(defconstant +largest-run+ 400)

(defun normal-number (state)
  (* (sqrt (* -2 (log (- 1 (random 1d0 state))))) (cos (* 2 pi (random 1d0 state)))))

(defun map-parameters (kind x)
  "Return the final parameters, but for noise, of the initial ones X, under the map KIND: :LINEAR
mixes them, :GOAL drives to a fixed place wherever it began."
  (let* ((n (length x)) (mean (/ (reduce #'+ x) n)))
    (map 'vector (lambda (value index)
                   (ecase kind
                     (:linear (+ (* 0.6d0 value) (* 0.2d0 mean)))
                     (:goal (+ 0.5d0 (mod index 2) (* 0.1d0 (- value (mod index 2) 0.5d0))))))
         x (alexandria:iota n))))

(defun initial-bounds (n)
  "Return the box of initial parameters: [0, 1], [1, 2], [0, 1], ... m."
  (map 'vector (lambda (index) (let ((low (float (mod index 2) 1d0))) (cons low (1+ low))))
       (alexandria:iota n)))

(defun draw (bounds state)
  (map '(simple-array double-float (*))
       (lambda (pair) (+ (car pair) (random 1d0 state))) bounds))

(defun final-bounds (kind n margin)
  "Return the range of the map's values, widened by MARGIN."
  (let* ((bounds (initial-bounds n))
         (low (map-parameters kind (map 'vector #'car bounds)))
         (high (map-parameters kind (map 'vector #'cdr bounds))))
    (map 'vector (lambda (low high) (cons (- low margin) (+ high margin))) low high)))

(defun inside-p (values bounds)
  (every (lambda (value pair) (and (<= (car pair) value) (<= value (cdr pair)))) values bounds))

(defun noisy-values (kind x state)
  (map '(simple-array double-float (*))
       (lambda (value) (+ value (* +noise+ (normal-number state))))
       (map-parameters kind x)))

(defun tail-margin (kind n p)
  "Return the margin (m) at which a part P of the values falls out of bounds, by 20 000 draws."
  (let* ((state (sb-ext:seed-random-state 7))
         (bounds (initial-bounds n))
         (exact (final-bounds kind n 0d0))
         (excesses (loop repeat 20000
                         collect (loop with values = (noisy-values kind (draw bounds state) state)
                                       for value across values
                                       for (low . high) across exact
                                       maximize (max (- low value) (- value high))))))
    (nth (floor (* p 20000)) (sort excesses #'>))))

(defun jump-box (bounds p state)
  "Return a box of volume P somewhere in BOUNDS, whose sides are 1."
  (let ((side (expt p (/ 1d0 (length bounds)))))
    (map 'vector (lambda (pair)
                   (let ((low (+ (car pair) (random (max 1d-9 (- 1 side)) state))))
                     (cons low (+ low side))))
         bounds)))

(defun replicate (kind p jump-p n margin confidence state)
  "Return for each rule (missed . samples) in one made-up simulation."
  (let* ((bounds (initial-bounds n))
         (region (statistics:make-parameter-region bounds (final-bounds kind n margin)))
         (evidence (statistics:make-evidence region))
         (box (and jump-p (jump-box bounds p state)))
         (open (loop for name in *calibration-rules*
                     collect (cons name (statistics:rule-for-trace
                                         (statistics:make-confidence-rule
                                          name :confidence confidence)
                                         1))))
         (results '()))
    (loop for count from 1 to +largest-run+
          while open
          do (let* ((x (draw bounds state)) (y (noisy-values kind x state)))
               (when (and box (inside-p x box)) (incf (aref y 0) 3))
               (unless (inside-p y (statistics:parameter-region-final-bounds region))
                 (loop for (name) in open do (push (list name nil count) results))
                 (setf open '())
                 (return))
               (statistics:add-sample evidence (statistics:make-parameter-sample x y))
               (dolist (entry open)
                 (when (eq :confident (statistics:verdict-status
                                       (statistics:evidence-verdict (cdr entry) evidence)))
                   (push (list (car entry) t count) results)
                   (setf open (remove entry open))))))
    (loop for (name) in open do (push (list name nil +largest-run+) results))
    results))

(defun calibration-row (kind p jump-p n confidence replicates)
  "Return for each rule (percentage of misses . mean number of samples)."
  (let ((state (sb-ext:seed-random-state (+ n (round (* 1000 p)))))
        (margin (if jump-p 0.4d0 (tail-margin kind n p)))
        (misses (make-hash-table)) (samples (make-hash-table)))
    (loop repeat replicates
          do (loop for (name missed count) in (replicate kind p jump-p n margin confidence state)
                   do (when missed (incf (gethash name misses 0)))
                      (incf (gethash name samples 0) count)))
    (loop for name in *calibration-rules*
          collect (cons (/ (* 100d0 (gethash name misses 0)) replicates)
                        (/ (gethash name samples 0) (float replicates 1d0))))))

(defun print-calibration (stream &key (replicates 400))
  "Print to STREAM how often each rule misses a discrepancy, and after how many samples."
  (format stream "misses in % (mean number of samples) of confidence rules, first trace, delta ~
                  5 %, ~d replicates~%~28t~{~16@a~}~%"
          replicates (mapcar #'string-downcase *calibration-rules*))
  (loop for (kind jump-p n p) in '((:linear t 2 0.05d0) (:linear t 2 0.1d0) (:linear t 2 0.2d0)
                                   (:linear t 6 0.1d0) (:goal t 2 0.1d0)
                                   (:linear nil 2 0.1d0) (:goal nil 2 0.1d0))
        do (dolist (confidence '(0.95d0 0.99d0))
             (format stream "~(~a~), ~:[tail~;jump~] n=~d p=~2d % C=~2d %~28t~:{~8,1f ~7@a~}~%"
                     kind jump-p n (round (* 100 p)) (round (* 100 confidence))
                     (loop for (misses . samples) in (calibration-row kind p jump-p n confidence
                                                                      replicates)
                           collect (list misses (format nil "(~,1f)" samples)))))))
