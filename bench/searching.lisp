;;;; What a sample costs a search, from the first to the ten thousandth.

(in-package #:discrepancy-finder.bench)

(defun sample-costs (&key (samples 10000) (block-size 1000))
  "Return, for each block of BLOCK-SIZE samples of a search along Example 1 that is never satisfied,
the processor time of a sample (ms) and the megabytes of the Lisp heap after a collection."
  (let ((costs '()) (start (foreign:processor-seconds)))
    (df:find-discrepancies
     'discrepancy-finder-user::move-the-box
     :domain :two-regions :parameters '(:reach 0.8d0) :rule :sound :delta 1d-5 :budget samples
     :progress (lambda (&key simulations &allow-other-keys)
                 (when (zerop (mod simulations block-size))
                   (let ((cost (/ (- (foreign:processor-seconds) start) block-size)))
                     (sb-ext:gc :full t)
                     (push (cons (* 1d3 cost) (* 1d-6 (sb-kernel:dynamic-usage))) costs)
                     (setf start (foreign:processor-seconds))))))
    (nreverse costs)))

(defun print-search-benchmarks (stream)
  (let ((costs (sample-costs)))
    (format stream "samples of a search       ~,2f ms each in the first thousand, ~,2f ms in the ~
                    tenth; heap ~,0f MB and ~,0f MB~%"
            (car (first costs)) (car (first (last costs)))
            (cdr (first costs)) (cdr (first (last costs))))))
