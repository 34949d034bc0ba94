;;;; The subcommand table1.

(in-package #:discrepancy-finder)

(defun table1-progress-text (row seed)
  (format nil "~a, rule ~(~a~), seed ~d" (paper-search-title (table1-row-search row))
          (table1-row-rule row) seed))

(define-subcommand "table1" (arguments options)
    ("[--seed N] [--seeds N] [--brute-force]"
     "Run the searches of the paper's Table I and print its figures beside ours."
     (("seed") :type integer :documentation "seed of the first run of each search (1)")
     (("seeds") :type integer
      :documentation "number of runs of each search; more than 1 show distributions (1)")
     (("brute-force") :type boolean :optional t
      :documentation "simulate from random initial states as well, for comparison"))
  (when arguments
    (usage-problem "table1 takes options only."))
  (let ((search ""))
    (write-string
     (with-output-to-string (stream)
       (telling ((lambda () search))
         (table1 :seed (or (getf options :seed) 1) :seeds (or (getf options :seeds) 1)
                 :brute-force (getf options :brute-force) :stream stream
                 :progress (lambda (row seed)
                             (setf search (table1-progress-text row seed))))))))
  0)
