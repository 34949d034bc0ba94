;;;; The two fidelities agree, equal samples have equal bits, nothing leaks: seeded runs of the plan
;;;; that carries an object to the table.

(in-package #:discrepancy-finder.tests)

(def-suite kitchen-fidelity :in all)
(in-suite kitchen-fidelity)

(defun carry-run (index fidelity)
  "Run the plan on the sample INDEX.  Return its discrete outcome, a list: how the plan ended and
where each item is, and what of it stands; and the hash of the final state."
  (let ((subject "run"))
    (with-kitchen (projection :poses (carry-poses subject index)
                              :parameters (drawn-tolerances subject index)
                              :fidelity fidelity)
      (let ((end (outcome (funcall 'discrepancy-finder-user::carry-to-the-table
                                   (if (evenp index) :milk :cereal)))))
        (projection:settle projection)
        (values (list end
                      (loop for item in (projection:scene-item-names (kitchen-scene))
                            for pose = (projection:observed-pose projection item)
                            collect (list item (place-of projection item)
                                          (< (degrees-from-upright pose) 30))))
                (projection:state-hash projection))))))

(test both-fidelities-end-alike
  "The same discrete final state on 98 % of the runs; the others are listed.  Of 500 runs 6 differ
(1.2 %), all in whether a finger touches the cereal as the hand draws back from it."
  (kitchen-plans)
  (let ((number (if *long* 500 12)) (different '()))
    (dotimes (index number)
      (let ((full (carry-run index :full)) (fast (carry-run index :fast)))
        (unless (equal full fast)
          (push (list index full fast) different))))
    (is (<= (length different) (* number 2/100)) "~:{~%~d: full ~a~%  fast ~a~}"
        (reverse different))
    (loop for (index full fast) in (reverse different)
          do (format *test-dribble* "~&  run ~d: full ~a~%    fast ~a~%" index full fast))))

(defun run-hash (index)
  (nth-value 1 (carry-run index :fast)))

(defun hashes-in-threads (indices threads)
  "Return the hashes of the runs INDICES, which THREADS threads share."
  (let ((workers (loop for worker below threads
                       collect (let ((worker worker))
                                 (sb-thread:make-thread
                                  (lambda ()
                                    (loop for index in indices
                                          for position from 0
                                          when (= worker (mod position threads))
                                            collect (cons index (run-hash index)))))))))
    (let ((hashes (mapcan #'sb-thread:join-thread workers)))
      (loop for index in indices collect (cdr (assoc index hashes))))))

(defun hashes-in-another-process (indices)
  (read-from-string
   (last-line-of-another-process
    "discrepancy-finder/tests"
    `(let ((*print-pretty* nil))
       (print (uiop:symbol-call "DISCREPANCY-FINDER.TESTS" "RUN-HASHES" ',indices))))))

(defun run-hashes (indices)
  (kitchen-plans)
  (mapcar #'run-hash indices))

(test equal-samples-have-equal-bits
  "In the same process, in another one, in one thread and in four."
  (kitchen-plans)
  (let* ((indices (loop for index below (if *long* 1000 8) collect index))
         (others (if *long* indices (subseq indices 0 4)))
         (hashes (run-hashes indices)))
    (is (equal hashes (hashes-in-threads indices 1)))
    (is (equal hashes (hashes-in-threads indices 4)))
    (is (equal (subseq hashes 0 (length others)) (hashes-in-another-process others)))
    (is (= (length hashes) (length (remove-duplicates hashes))) "each sample is another")))

(test worlds-of-the-kitchen-leave-nothing-behind
  (flet ((make-some (count)
           (loop repeat count do (with-kitchen (projection) (projection:settle projection)))
           (sb-ext:gc :full t)
           (resident-megabytes)))
    (let ((before (make-some 50)))
      (is (< (- (make-some (if *long* 20000 400)) before) 20)))))
