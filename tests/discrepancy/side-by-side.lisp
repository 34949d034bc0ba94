;;;; Tests of replays told side by side, and step by step.

(in-package #:discrepancy-finder.tests)

(def-suite side-by-side :in all)
(in-suite side-by-side)

(defun documented-output (command)
  "Return the output of COMMAND that docs/shrinking.md shows."
  (format nil "~{~a~%~}" (rest (text-block "docs/shrinking.md"
                                           (format nil "$ ./discrepancy-finder ~a" command)))))

(test the-documentation-shows-a-replay-and-what-shrinking-leaves
  (let* ((file (root-file "discrepancies/move-the-box-1-4b1adfe8.json"))
         (result (df:replay file))
         (shrunk (documented-output "shrink")))
    (is (string= (documented-output "replay") (df:replay-text result)))
    (is (eql 0 (search (subseq shrunk 0 (search "  ..." shrunk))
                       (df:shrinking-text
                        (df:shrink-discrepancy (discrepancy:replay-discrepancy result))))))))

(defun example-steps ()
  "Return what a replay of the example's discrepancy of seed 1 tells of its steps."
  (let ((text (documented-output "replay")))
    (subseq text (search "  initially" text) (search "  theory and simulation part" text))))

(test a-replay-is-told-side-by-side
  (with-stored-discrepancy (file discrepancy)
    (let* ((result (df:replay file))
           (text (df:replay-text result)))
      (is (search (example-steps) text) "not in:~%~a" text)
      (is (null (search (example-steps) (df:replay-text result :steps nil))))
      (is (search "theory and simulation part at step 2" text)))))

(test a-run-that-agrees-is-told-without-marks
  (with-stored-discrepancy (file discrepancy)
    (let ((text (df:replay-text (df:replay (edited file "\"reach\": 0.5" "\"reach\": 0.9")))))
      (is (eql 0 (search "OTHER VERDICT" text)))
      (is (null (search " * " text)))
      (is (null (search "not performed" text)))
      (is (search "theory and simulation agree" text)))))

(defun comparison-of (discrepancy run)
  (discrepancy::compared-run (discrepancy:discrepancy-domain discrepancy)
                             (discrepancy:discrepancy-trace discrepancy) run :consistent))

(test each-marked-fluent-differs-and-each-other-one-does-not
  ;; The table against what was observed and what the trace's states say.
  (let* ((discrepancy (table-top-discrepancy))
         (run (discrepancy:discrepancy-run discrepancy))
         (case (comparison-of discrepancy run))
         (states (symbolic:trace-states (discrepancy:discrepancy-trace discrepancy))))
    (loop for number from 0 to (length (discrepancy:run-steps run))
          for observed = (if (zerop number)
                             (discrepancy:run-initial-state run)
                             (discrepancy:run-step-state
                              (nth (1- number) (discrepancy:run-steps run))))
          do (loop for (atom theory simulation) in (discrepancy::rows-at case number)
                   for seen = (assoc atom observed :test #'equal)
                   do (is (eq simulation (if seen (cdr seen) :unknown)))
                      (is (eq theory (ec:fluent-value (nth number states) atom)))))))

(test an-allowed-outcome-that-is-not-the-traces-is-told-as-such
  (let* ((trace (second (find-object-traces)))
         (domain (discrepancy:ensure-domain :table-top))
         ;; The cereal is on the left after all: the first detection does not fail.
         (run (discrepancy:execute-sample
               domain *find-object*
               (discrepancy:draw-sample
                (discrepancy:initial-parameters domain (first (find-object-traces))) 1 7 0)
               :execution :plan))
         (text (discrepancy::side-by-side-text
                (discrepancy::compared-run domain trace run :consistent))))
    (is (search "the theory allows it, but this is not the trace any more" text))
    (is (search "not performed" text))))

;;; Stepping

(defun stepped (file input)
  "Return what a stepped replay of FILE prints and asks when the user types INPUT."
  (with-output-to-string (output)
    (let ((*standard-output* output)
          (*query-io* (make-two-way-stream (make-string-input-stream input) output)))
      (discrepancy:replay file :step t))))

(defun count-text (part text)
  (loop for start = (search part text) then (search part text :start2 (1+ start))
        while start count t))

(test a-stepped-replay-asks-after-each-action
  (with-stored-discrepancy (file discrepancy)
    (let ((text (stepped file (format nil "~%~%~%"))))
      (is (= 2 (count-text "Enter: next action" text)))
      (is (< (search "  1. (a motion" text) (search "Enter: next action" text)
             (search "  2. (an action" text))))
    (is (= 1 (count-text "Enter: next action" (stepped file (format nil "c~%")))))
    (is (= 1 (count-text "Enter: next action" (stepped file ""))) "at the end of the input")
    (is (= 3 (count-text "Enter: next action" (stepped file (format nil "x~%~%~%"))))
        "what it does not know it asks again")
    (uiop:with-temporary-file (:pathname picture :type "png")
      (stepped file (format nil "p ~a~%~%~%" (namestring picture)))
      (with-open-file (stream picture :element-type '(unsigned-byte 8))
        (is (< 1000 (file-length stream)))))
    (is (search "neither" (stepped file (format nil "p picture.gif~%c~%"))))
    (is (search "  2. (an action"
                (with-output-to-string (*standard-output*)
                  (discrepancy:replay file :step (constantly :next)))))
    (signals-with (discrepancy:invalid-argument "step") (discrepancy:replay file :step 3))))

(test a-stepped-replay-stops-in-the-debugger
  (with-stored-discrepancy (file discrepancy)
    (flet ((stops (restart)
             (let* ((stops '())
                    (sb-ext:*invoke-debugger-hook*
                      (lambda (condition hook)
                        (declare (ignore hook))
                        (push (list (discrepancy:replay-stopped-number condition)
                                    (typep (discrepancy:replay-stopped-projection condition)
                                           'projection:projection)
                                    (search (discrepancy:replay-stopped-text condition)
                                            (princ-to-string condition)))
                              stops)
                        (invoke-restart restart)))
                    (result (let ((*standard-output* (make-broadcast-stream)))
                              (discrepancy:replay file :step :debugger))))
               (is (eq :same-bits (df:replay-status result)))
               (reverse stops))))
      (let ((stops (stops 'continue)))
        (is (equal '((1 t) (2 t)) (loop for (number projection) in stops
                                        collect (list number projection))))
        (is (every #'third stops)))
      (is (= 1 (length (stops 'discrepancy:finish-replay)))))))
