;;;; How often does a search certify a trace that is discrepant?
;;;;
;;;; A replicate is a made-up simulation: n initial parameters, uniform in a box, n final ones, a
;;;; map of them with normal noise of 5 cm.  The true probability p of a discrepancy is known:
;;;; either a box of volume p, somewhere, from which the first final parameter jumps out of its
;;;; bounds, or the tail of the noise at the bounds.  Samples are drawn as a search draws them, with
;;;; targets or without, and the rules are asked after each, until one is a discrepancy or the rule
;;;; is satisfied.  With several traces, each a made-up simulation of its own, the search goes on
;;;; with the next trace when one is certified.  A miss is a replicate in which a trace was
;;;; certified.  Where p is above delta, rules with a guarantee may miss no more often than
;;;; 1 - confidence; and so rarely may the sound statement, which is made whatever the rule, be
;;;; false, even if one stops when it just has become so: the last column.

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

(defun made-up-parameters (n)
  "Return N parameters for the samplers of a search, in the box of INITIAL-BOUNDS."
  (loop for (low . high) across (initial-bounds n)
        collect (discrepancy::make-parameter :body :x low high)))

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
                         collect (loop with x = (map 'vector (lambda (pair)
                                                               (+ (car pair) (random 1d0 state)))
                                                     bounds)
                                       with values = (noisy-values kind x state)
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

(defstruct (cell (:predicate nil))
  "What is simulated: KIND of map, JUMP-P or tail, N parameters, probability P, the MARGIN of the
bounds; with TARGETS or without, a number of TRACES, the CONFIDENCE asked for."
  kind jump-p n p margin targets traces confidence)

(defun made-up-trace (cell seed number state names)
  "Sample a made-up trace, NUMBER from 1 of the search SEED, and return (rule missed . samples) for
each of the rules NAMES, and the number of blind samples before the first discrepancy."
  (let* ((n (cell-n cell)) (kind (cell-kind cell))
         (region (statistics:make-parameter-region (initial-bounds n)
                                                   (final-bounds kind n (cell-margin cell))))
         (parameters (made-up-parameters n))
         (evidence (statistics:make-evidence region))
         (targeting (and (cell-targets cell) (discrepancy::make-targeting (list region))))
         (box (and (cell-jump-p cell) (jump-box (initial-bounds n) (cell-p cell) state)))
         (open (loop for name in names
                     collect (cons name (statistics:rule-for-trace
                                         (statistics:make-confidence-rule
                                          name :confidence (cell-confidence cell))
                                         number))))
         (drawn 0) (results '()))
    (loop for count from 1 to +largest-run+
          while open
          do (let* ((blind-p (eq :blind (discrepancy::next-origin targeting)))
                    (sample (if blind-p
                                (discrepancy:draw-sample parameters seed number
                                                         (1- (incf drawn)))
                                (discrepancy::target-sample
                                 (discrepancy::targeting-aim targeting 0) parameters seed number
                                 (discrepancy::next-target targeting))))
                    (x (discrepancy:sample-values sample))
                    (y (noisy-values kind x state)))
               (when (and box (inside-p x box)) (incf (aref y 0) 3))
               (unless (inside-p y (statistics:parameter-region-final-bounds region))
                 (loop for (name) in open do (push (list* name nil count) results))
                 (setf open '())
                 (when blind-p (decf drawn))
                 (return))
               (statistics:add-sample evidence
                                      (statistics:make-parameter-sample x y :blind-p blind-p))
               (when targeting (discrepancy::note-values targeting 0 x y))
               (dolist (entry open)
                 (when (eq :confident (statistics:verdict-status
                                       (statistics:evidence-verdict (cdr entry) evidence)))
                   (push (list* (car entry) t count) results)
                   (setf open (remove entry open))))))
    (loop for (name) in open do (push (list* name nil +largest-run+) results))
    (values results drawn)))

(defun false-statement-p (cell blind number)
  "Return true if one could have made a false statement on trace NUMBER, of BLIND clean samples."
  (< (statistics:zero-failure-bound blind (- 1 (/ (- 1 (cell-confidence cell))
                                                  (* number (1+ number)))))
     (cell-p cell)))

(defun replicate (cell seed state)
  "Return for each rule (missed . samples) in one made-up search, and, last, whether a false
statement could have been made, and 0."
  (let ((missed '()) (samples (loop for name in *calibration-rules* collect (cons name 0)))
        (open *calibration-rules*) (false nil))
    (loop for number from 1 to (cell-traces cell)
          while open
          do (multiple-value-bind (results blind) (made-up-trace cell seed number state open)
               (when (false-statement-p cell blind number) (setf false t))
               (loop for (name missed-p . count) in results
                     do (incf (cdr (assoc name samples)) count)
                        (if missed-p
                            (pushnew name missed)
                            (setf open (remove name open))))))
    (append (loop for (name . count) in samples
                  collect (cons (and (member name missed) t) count))
            (list (cons false 0)))))

(defun calibration-row (cell replicates)
  "Return for each rule, and last for the statement, (percentage of misses . mean number of
samples)."
  (let ((state (sb-ext:seed-random-state (+ (cell-n cell) (round (* 1000 (cell-p cell))))))
        (sums (loop repeat (1+ (length *calibration-rules*)) collect (cons 0 0))))
    (loop for seed from 1 to replicates
          do (loop for (missed . count) in (replicate cell seed state)
                   for sum in sums
                   do (when missed (incf (car sum)))
                      (incf (cdr sum) count)))
    (loop for (misses . count) in sums
          collect (cons (/ (* 100d0 misses) replicates) (/ count (float replicates 1d0))))))

(defparameter *calibration-cells*
  '((:linear t 2 0.06d0) (:linear t 2 0.1d0) (:linear t 2 0.2d0) (:linear t 6 0.1d0)
    (:goal t 2 0.1d0) (:linear nil 2 0.1d0) (:goal nil 2 0.1d0) (:linear nil 6 0.1d0))
  "Lists (kind jump-p n p).")

(defun print-calibration (stream &key (replicates 200) (confidences '(0.95d0 0.99d0))
                                   (settings '((nil 1) (t 1) (nil 3) (t 3))))
  "Print to STREAM how often searches miss a discrepancy by each rule, and after how many samples.
SETTINGS is a list of (targets traces)."
  (format stream "misses in % (mean number of samples) by each rule, asked after every sample, ~
                  delta 5 %, ~d replicates~%" replicates)
  (loop for (targets traces) in settings
        do (format stream "~:[no targets~;targets~], ~d trace~:p~%~32t~{~16@a~}~12@a~%" targets
                   traces (mapcar #'string-downcase *calibration-rules*) "statement")
           (loop for (kind jump-p n p) in *calibration-cells*
                 for margin = (if jump-p 0.4d0 (tail-margin kind n p))
                 do (dolist (confidence confidences)
                      (let ((row (calibration-row
                                  (make-cell :kind kind :jump-p jump-p :n n :p p :margin margin
                                             :targets targets :traces traces
                                             :confidence confidence)
                                  replicates)))
                        (format stream "~(~a~), ~:[tail~;jump~] n=~d p=~2d % C=~2d %~32t~
                                        ~:{~8,1f ~7@a~}~12,1f~%"
                                kind jump-p n (round (* 100 p)) (round (* 100 confidence))
                                (loop for (misses . samples) in (butlast row)
                                      collect (list misses (format nil "(~,1f)" samples)))
                                (car (first (last row))))
                        (finish-output stream))))))
