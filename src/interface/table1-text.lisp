;;;; Table I as text: the paper's figures beside ours, distributions, and random simulation.

(in-package #:discrepancy-finder)

;;; One seed

(defun first-result (row)
  (cdr (first (table1-row-results row))))

(defun print-table1-heading (rows stream)
  (format stream "Table I, rule paper, confidence ~,2f, seed ~d~2%" *table1-confidence*
          (car (first (table1-row-results (first rows)))))
  (format stream "~26a~20@a~24@a~%" "" "paper" "ours")
  (format stream "~26a~{~7@a~7@a~6@a~}  ~{~7@a~7@a~8@a~}  ~a~%" "plan"
          '("iter." "sim." "s") '("iter." "sim." "s") "found"))

(defun print-table1-row (row stream)
  (let ((search (table1-row-search row))
        (result (first-result row)))
    (format stream "~26a~7d~7d~6d  ~7d~7d~8,2f  ~a~%" (paper-search-title search)
            (paper-search-iterations search) (paper-search-simulations search)
            (paper-search-seconds search)
            (result-iterations result) (looking-simulations result)
            (discrepancy:result-seconds result) (found-text result))))

(defun print-table1-sum (rows stream)
  (flet ((sum (function things) (reduce #'+ things :key function)))
    (let ((searches (mapcar #'table1-row-search rows))
          (results (mapcar #'first-result rows)))
      (format stream "~26a~7d~7d~6d  ~7d~7d~8,2f~%" "in all"
              (sum #'paper-search-iterations searches) (sum #'paper-search-simulations searches)
              (sum #'paper-search-seconds searches)
              (sum #'result-iterations results) (sum #'looking-simulations results)
              (sum #'discrepancy:result-seconds results)))))

(defun print-finds (rows stream)
  "Print what was found, with the step and what the simulator said."
  (dolist (row rows)
    (let* ((search (table1-row-search row))
           (discrepancy (result-discrepancy (first-result row))))
      (format stream "~a~%  paper: ~a~%  ours:  " (paper-search-title search)
              (paper-search-found search))
      (if discrepancy
          (let* ((run (discrepancy-run discrepancy))
                 (number (discrepancy:divergence-step
                          (discrepancy:judgement-divergence
                           (discrepancy-judgement discrepancy))))
                 (failure (discrepancy:run-step-failure (nth number (run-steps run)))))
            (format stream "~a~@[~%         ~a~]~%"
                    (discrepancy:discrepancy-summary discrepancy) failure))
          (format stream "~a~%" (found-text (first-result row)))))))

;;; Several seeds

(defun quantile-of (numbers part)
  "Return the one of NUMBERS below which PART of them lie."
  (nth (min (1- (length numbers)) (floor (* part (length numbers))))
       (sort (copy-list numbers) #'<)))

(defun distribution-text (numbers)
  "Return the smallest, the middle, the mean and the largest of NUMBERS."
  (format nil "~d / ~d / ~,1f / ~d" (reduce #'min numbers) (quantile-of numbers 1/2)
          (/ (reduce #'+ numbers) (float (length numbers) 1d0)) (reduce #'max numbers)))

(defun counted (things)
  "Return the list of (thing . count) of THINGS, the most frequent first."
  (stable-sort (loop for thing in (remove-duplicates things :test #'equal :from-end t)
                     collect (cons thing (count thing things :test #'equal)))
               #'> :key #'cdr))

(defun print-distributions (rows stream)
  (let ((seeds (mapcar #'car (table1-row-results (first rows)))))
    (format stream "~%Seeds ~d to ~d: smallest / middle / mean / largest~2%" (first seeds)
            (first (last seeds))))
  (dolist (row rows)
    (let ((results (mapcar #'cdr (table1-row-results row))))
      (format stream "~a, rule ~(~a~)~%  iterations ~a~%  simulations ~a~%  seconds ~,2f in all~%"
              (paper-search-title (table1-row-search row)) (table1-row-rule row)
              (distribution-text (mapcar #'result-iterations results))
              (distribution-text (mapcar #'looking-simulations results))
              (reduce #'+ results :key #'discrepancy:result-seconds))
      (loop for (found . count) in (counted (mapcar #'found-text results))
            do (format stream "  found ~a: ~d time~:p~%" found count)))))

;;; Random simulation

(defun print-random-simulation (rows stream)
  (format stream "~%Simulation from random initial states over the whole state space, until there ~
                  is a~%discrepancy of the same kind~2%")
  (dolist (row (remove nil rows :key #'table1-row-random))
    (let ((found (remove nil (mapcar #'cdr (table1-row-random row)))))
      (format stream "~a~%" (paper-search-title (table1-row-search row)))
      (if found
          (let ((numbers (mapcar #'discrepancy:blind-result-simulations found)))
            (format stream "  simulations ~a~%  seconds ~,2f; ~d initial state~:p drawn in vain~%"
                    (if (rest numbers) (distribution-text numbers) (first numbers))
                    (reduce #'+ found :key #'discrepancy:blind-result-seconds)
                    (reduce #'+ found :key #'discrepancy:blind-result-rejected))
            (format stream "~@[  ~d time~:p nothing of the kind in so many~%~]"
                    (let ((vain (count nil found :key #'discrepancy:blind-result-discrepancy)))
                      (and (plusp vain) vain)))
            (loop for (kind . count) in (met-kinds found)
                  do (format stream "  met ~{~(~a~)~^, ~}: ~d time~:p~%" kind count)))
          (format stream "  nothing to look for~%")))))

(defun met-kinds (results)
  "Return the list of (kind . count) of all discrepancies in RESULTS, the most frequent first."
  (counted (loop for result in results
                 append (loop for (kind . count) in (discrepancy:blind-result-kinds result)
                              append (make-list count :initial-element kind)))))

;;; All of it

(defun table1-text (rows)
  "Return the report of ROWS, TABLE1-ROWs: a text of several lines."
  (let ((paper (remove :paper rows :key #'table1-row-rule :test-not #'eq)))
    (with-output-to-string (stream)
      (print-table1-heading paper stream)
      (dolist (row paper)
        (print-table1-row row stream))
      (print-table1-sum paper stream)
      (terpri stream)
      (print-finds paper stream)
      (when (rest (table1-row-results (first rows)))
        (print-distributions rows stream))
      (when (some #'table1-row-random paper)
        (print-random-simulation paper stream)))))
