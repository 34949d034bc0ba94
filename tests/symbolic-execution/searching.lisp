;;;; How an exploration searches: orders, bounds, traces, statistics, interruption, what is undone.

(in-package #:discrepancy-finder.tests)

(def-suite searching :in all)
(in-suite searching)

(defparameter *three-flags* '((?one boolean) (?two boolean) (?three boolean)))

(defparameter *eight-paths* "
(def-top-level-cram-function lamp-plan (?one ?two ?three)
  (if ?one 1 2)
  (if ?two 1 2)
  (if ?three 1 2)
  (perform (a motion (type smashing) (lamp a))))")

(defun traced-arguments (exploration)
  (mapcar #'symbolic:trace-arguments (symbolic:exploration-traces exploration)))

(defun arguments-in-order (&rest options)
  (traced-arguments (apply #'explore-text *eight-paths* :constraint 'anything
                                                        :arguments *three-flags* options)))

;;; Orders

(test orders-find-the-same-paths
  (let ((depth-first (arguments-in-order)))
    (is (= 8 (length depth-first)))
    (is (equal '((t t t) (t t nil) (t nil t) (t nil nil)) (subseq depth-first 0 4)))
    (dolist (options '((:order :breadth-first) (:order :coverage)
                       (:order :random :seed 1) (:order :random :seed 2)))
      (is (null (set-exclusive-or depth-first (apply #'arguments-in-order options)
                                  :test #'equal))))))

(test breadth-first-takes-short-prefixes-first
  (is (equal '((t t t) (nil t t) (t nil t) (nil nil t))
             (subseq (arguments-in-order :order :breadth-first) 0 4))))

(test random-orders-are-functions-of-the-seed
  (is (equal (arguments-in-order :order :random :seed 7)
             (arguments-in-order :order :random :seed 7)))
  (is (< 1 (length (remove-duplicates (loop for seed below 6
                                            collect (arguments-in-order :order :random
                                                                        :seed seed))
                                      :test #'equal))))
  (let ((text (with-output-to-string (stream)
                (describe (explore-text *eight-paths* :constraint 'anything :order :random
                                                      :arguments *three-flags* :seed 42)
                          stream))))
    (is (search "seed 42" text))))

(test coverage-opens-new-options-first
  "After the first path each of the three falses is taken once before anything else."
  (is (equal '((t t t) (t t nil) (t nil t) (nil t t))
             (subseq (arguments-in-order :order :coverage) 0 4))))

;;; Bounds

(defun gaps-of (text &rest options)
  (let ((exploration (apply #'explore-text text :constraint 'anything options)))
    (is-false (symbolic:exploration-complete-p exploration))
    (symbolic:exploration-gaps exploration)))

(defparameter *busy-plan* "
(def-top-level-cram-function lamp-plan ()
  (perform (a motion (type smashing) (lamp a)))
  (loop))")

(test bounds-say-what-they-cut-off
  (is (equal '("paths beyond the first 3")
             (gaps-of *eight-paths* :arguments *three-flags* :max-paths 3)))
  (is (equal '("paths of more than 1 step")
             (gaps-of "
(def-top-level-cram-function lamp-plan ()
  (loop (perform (a motion (type smashing) (lamp a)))))" :max-steps 1)))
  (is (equal '("paths of more than 500 iterations") (gaps-of *busy-plan* :max-jumps 500)))
  (let ((exploration (explore-text *busy-plan* :constraint 'anything :max-seconds 0.2
                                               :max-jumps 1000000000)))
    (is (equal '("what takes more than 0.2 seconds") (symbolic:exploration-gaps exploration)))
    (is (= 1 (length (symbolic:exploration-traces exploration)))
        "what the path did before is a trace")
    (is (= 1 (symbolic:exploration-pending exploration)))
    (is-false (symbolic:exploration-complete-p exploration))))

(test what-z3-cannot-answer-is-kept
  "With no resources for Z3 nothing is pruned, and nothing is complete."
  (let* ((text "
(def-top-level-cram-function lamp-plan ()
  (perform (a motion (type smashing) (lamp a)))
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (perform (a motion (type toggling) (lamp b)))))")
         (exact (explore-text text :constraint 'anything))
         (unable (explore-text text :constraint 'anything
                                    :solver-options '(("rlimit" . 1)))))
    (is-true (symbolic:exploration-complete-p exact))
    (is (<= (symbolic:exploration-paths exact) (symbolic:exploration-paths unable)))
    (is (plusp (getf (symbolic:exploration-statistics unable) :unknowns)))
    (is-false (symbolic:exploration-complete-p unable))
    (is (search "Z3 could not answer" (format nil "~{~a ~}" (symbolic:exploration-gaps unable)))))
  (signals z3:solver-unknown
    (explore-text *eight-paths* :constraint 'anything :arguments *three-flags*
                                :on-unknown :signal :solver-options '(("rlimit" . 1)))))

(test statistics-add-up
  (let* ((exploration (explore-text *eight-paths* :constraint 'anything
                                                  :arguments *three-flags*))
         (figures (symbolic:exploration-statistics exploration)))
    (is (= 8 (getf figures :paths) (getf figures :traces) (getf figures :steps)))
    (is (= 7 (getf figures :decisions)) "one, two, four places")
    (is (<= 1 (getf figures :checks-per-decision) 2))
    (is (<= (getf figures :decision-checks) (getf figures :checks)))
    (is (= (getf figures :checks) (symbolic:exploration-checks exploration)))
    (is (<= (getf figures :solver-seconds) (getf figures :seconds)))
    (is (= 0 (getf figures :pending) (getf figures :dead-ends) (getf figures :unknowns)))
    (let ((text (with-output-to-string (stream) (describe exploration stream))))
      (dolist (part '("7 decisions" "a decision" " s in Z3" "8 traces on 8 paths"))
        (is (search part text) "~s is not in ~a" part text)))))

(test progress-is-told-at-most-once-a-second
  (let ((calls '()))
    (explore-text *busy-plan* :constraint 'anything :max-jumps 1000
                              :progress (lambda (exploration) (push exploration calls)))
    (is (null calls) "it does not last a second"))
  (let ((calls '()))
    (explore-text "
(def-top-level-cram-function lamp-plan (?one ?two ?three)
  (if ?one 1 2) (if ?two 1 2) (if ?three 1 2)
  (discrepancy-finder.tests::nap)
  (perform (a motion (type smashing) (lamp a))))"
                  :constraint 'anything :arguments *three-flags*
                  :progress (lambda (exploration)
                              (push (symbolic:exploration-paths exploration) calls)))
    (is (<= 1 (length calls) 3) "eight paths of 0.3 s each: ~a" calls)
    (is (apply #'> (append calls '(0))))))

(defun nap () (sleep 0.3))

;;; Interruption

(test an-interruption-keeps-what-was-found
  (let* ((count 0)
         (exploration
           (handler-bind ((warning (lambda (condition)
                                     (when (search "interrupt me" (princ-to-string condition))
                                       (when (= 3 (incf count))
                                         (invoke-restart 'symbolic:stop-exploring))
                                       (muffle-warning condition)))))
             (explore-text "
(def-top-level-cram-function lamp-plan (?one ?two ?three)
  (if ?one 1 2) (if ?two 1 2) (if ?three 1 2)
  (perform (a motion (type smashing) (lamp a)))
  (warn \"interrupt me\"))" :constraint 'anything :arguments *three-flags*))))
    (is (= 2 (length (symbolic:exploration-traces exploration))))
    (is (equal '("what comes after an interruption") (symbolic:exploration-gaps exploration)))
    (is-false (symbolic:exploration-complete-p exploration))
    (is (plusp (symbolic:exploration-pending exploration)))))

;;; Leaks between paths

(defvar *table* (make-hash-table))
(defvar *cell* (list 1 2 3))
(defvar *vector* (make-array 3 :initial-contents '(1 2 3) :adjustable t :fill-pointer t))

(defun counts-on-each-path (form)
  "Return what FORM, which changes something, gives on each of two paths."
  (mapcar #'symbolic:trace-output
          (symbolic:exploration-traces
           (explore-text (format nil "
(def-top-level-cram-function lamp-plan (?one)
  (if ?one 1 2)
  (princ ~a)
  (perform (a motion (type smashing) (lamp a))))" form)
                         :constraint 'anything :arguments '((?one boolean))))))

(test nothing-leaks-from-path-to-path
  (dolist (form '("(random 1000000)" "(gensym)" "(get-universal-time)" "(get-internal-real-time)"
                  "(get-internal-run-time)" "(multiple-value-list (get-decoded-time))"
                  "(incf discrepancy-finder.tests::*counter*)"
                  "(progn (makunbound 'discrepancy-finder.tests::*counter*)
                          (setq discrepancy-finder.tests::*counter* 1))"
                  "(incf (gethash :key discrepancy-finder.tests::*table* 0))"
                  "(progn (push 1 (gethash :list discrepancy-finder.tests::*table*))
                          (length (gethash :list discrepancy-finder.tests::*table*)))"
                  "(incf (second discrepancy-finder.tests::*cell*))"
                  "(progn (push 0 (cdr discrepancy-finder.tests::*cell*))
                          (princ-to-string discrepancy-finder.tests::*cell*))"
                  "(princ-to-string (setf discrepancy-finder.tests::*cell*
                                          (nreverse discrepancy-finder.tests::*cell*)))"
                  "(incf (aref discrepancy-finder.tests::*vector* 1))"
                  "(vector-push-extend 1 discrepancy-finder.tests::*vector*)"
                  "(length (setf (symbol-plist 'discrepancy-finder.tests::*cell*)
                                 (list* 1 2 (symbol-plist 'discrepancy-finder.tests::*cell*))))"
                  "(let ((x 0)) (flet ((count-up () (incf x))) (count-up) (count-up)))"))
    (setf *counter* 0)
    (let ((outputs (counts-on-each-path form)))
      (is (= 2 (length outputs)))
      (is (equal (first outputs) (second outputs)) "~a: ~a" form outputs)
      (is (plusp (length (first outputs))))
      (is (eql 0 *counter*))
      (is (= 0 (hash-table-count *table*)))
      (is (equal '(1 2 3) *cell*))
      (is (equalp #(1 2 3) *vector*)))))

(test output-belongs-to-its-path
  (let ((exploration (explore-text "
(def-top-level-cram-function lamp-plan (?one)
  (format t \"~a, \" (if ?one 'yes 'no))
  (format *error-output* \"really\")
  (perform (a motion (type smashing) (lamp a))))"
                                   :constraint 'anything :arguments '((?one boolean)))))
    (is (equal '("YES, really" "NO, really")
               (mapcar #'symbolic:trace-output (symbolic:exploration-traces exploration))))))

(test files-are-not-written
  (with-file (file "before")
    (let ((text (format nil "
(def-top-level-cram-function lamp-plan ()
  (handler-case
      (with-open-file (stream ~s :direction :output :if-exists :supersede)
        (write-string \"after\" stream))
    (error () nil))
  (perform (a motion (type smashing) (lamp a))))" file)))
      (signals-with (symbolic:file-output-refused "lamp-plan" file ":file-output")
        (explore-text text :constraint 'anything))
      (is (equal "before" (uiop:read-file-string file)))
      (is (= 1 (length (symbolic:exploration-traces
                        (explore-text text :constraint 'anything :file-output t)))))
      (is (equal "after" (uiop:read-file-string file))))
    (is (= 1 (length (symbolic:exploration-traces
                      (explore-text (format nil "
(def-top-level-cram-function lamp-plan ()
  (with-open-file (stream ~s) (read-line stream))
  (perform (a motion (type smashing) (lamp a))))" file) :constraint 'anything))))
        "reading is no matter")))

;;; Abandoning

(test an-abandoned-path-is-seen-by-nothing-in-the-plan
  (dolist (wrapping '("(unwind-protect ~a (discrepancy-finder.tests::count-a-run))"
                      "(handler-case ~a (t () (discrepancy-finder.tests::count-a-run)))"
                      "(handler-bind ((t (lambda (c) (declare (ignore c))
                                           (discrepancy-finder.tests::count-a-run)))) ~a)"
                      "(progn (catch :anything ~a) (discrepancy-finder.tests::count-a-run))"
                      "(progn (catch 'plan ~a) (discrepancy-finder.tests::count-a-run))"
                      "(progn (ignore-errors ~a) (discrepancy-finder.tests::count-a-run))"
                      "(progn (block nil ~a) (discrepancy-finder.tests::count-a-run))"
                      "(restart-case ~a (abort () (discrepancy-finder.tests::count-a-run))
                                        (continue () (discrepancy-finder.tests::count-a-run)))"
                      "(with-failure-handling ((t (c) (declare (ignore c))
                                                  (discrepancy-finder.tests::count-a-run)
                                                  (return)))
                         ~a)"
                      "(par (seq ~a) (sleep 1))"
                      "(progn (pursue (seq ~a) (wait-for (make-fluent :value nil)))
                              (discrepancy-finder.tests::count-a-run))"))
    (dolist (cause '("(loop)" "(loop (perform (a motion (type smashing) (lamp b))))"
                     "(progn (perform (a motion (type smashing) (lamp a)))
                             (perform (a motion (type lighting) (lamp a))))"))
      (setf *runs* 0)
      (let ((exploration (explore-text (format nil "
(define-action (motion lighting) (lamp)
  (:domain lamps) (:event (toggle lamp)) (:requires (not (broken lamp))))
(def-top-level-cram-function lamp-plan ()
  (perform (a motion (type smashing) (lamp b)))
  ~@?)" wrapping cause)
                                       :constraint 'anything :max-steps 5 :max-jumps 500)))
        (is (= 0 *runs*) "~a around ~a" wrapping cause)
        (is (= 1 (symbolic:exploration-paths exploration)))))))
