;;;; Keeping going, budgets, interruption, targets, the store, statements.

(in-package #:discrepancy-finder.tests)

(def-suite search-phases :in all)
(in-suite search-phases)

(defun phase-of-result (result name)
  (find name (discrepancy:result-phases result) :key #'discrepancy:phase-name))

(defun sample-hashes (result)
  "Return the hashes of the runs of the first trace of RESULT, in their order."
  (mapcar (lambda (entry) (discrepancy:run-hash (car entry)))
          (discrepancy:trace-result-runs (first (discrepancy:result-traces result)))))

(test a-kind-is-the-action-and-what-differs
  (let ((discrepancy (discrepancy:result-discrepancy (find-in-example 0.5 :seed 1))))
    (is (equal '(:pick-up :manipulation-pose-unreachable)
               (discrepancy:discrepancy-kind discrepancy)))
    (is (string= "pick-up ends with manipulation-pose-unreachable"
                 (discrepancy:kind-text discrepancy)))
    (is (eq :blind (discrepancy:discrepancy-origin discrepancy)))
    (is (= 1 (length (discrepancy:discrepancy-runs discrepancy))))
    (is (eq (discrepancy:discrepancy-run discrepancy)
            (car (first (discrepancy:discrepancy-runs discrepancy)))))))

(test a-search-that-keeps-going-counts-each-kind
  (let* ((result (find-in-example 0.5 :keep-going t :rule :sound :budget 60))
         (discrepancy (discrepancy:result-discrepancy result)))
    (is (eq :discrepancy (discrepancy:result-status result)))
    (is (= 1 (length (discrepancy:result-discrepancies result))))
    (is (< 10 (discrepancy:discrepancy-occurrences discrepancy)))
    (is (equal (list (cons '(:pick-up :manipulation-pose-unreachable)
                           (discrepancy:discrepancy-occurrences discrepancy)))
               (discrepancy:result-kinds result)))
    (is (= 60 (discrepancy:phase-simulations (phase-of-result result :generate))))
    (is (= 1 (discrepancy:phase-simulations (phase-of-result result :confirm)))
        "one of each kind is confirmed")
    (is (= 61 (discrepancy:result-simulations result)))
    (is (search "budget of 60" (discrepancy:result-stopped result)))
    (is (= 60 (length (sample-hashes result))))
    (is (= (discrepancy:discrepancy-occurrences discrepancy)
           (count :discrepancy (discrepancy:trace-result-runs
                                (first (discrepancy:result-traces result)))
                  :key (lambda (entry) (discrepancy:judgement-verdict (cdr entry))))))
    (is (search (format nil "found ~d times" (discrepancy:discrepancy-occurrences discrepancy))
                (discrepancy:result-text result))))
  (is (= 2 (discrepancy:result-simulations
            (find-in-example 0.5 :keep-going 1 :rule :sound :budget 60)))
      "one kind is enough"))

(test a-trace-with-discrepancies-is-never-certified
  (let ((trace (first (discrepancy:result-traces (find-in-example 0.5 :keep-going t :budget 200)))))
    (is (eq :discrepancy (discrepancy:trace-result-status trace)))
    (is (null (discrepancy:trace-result-bound trace)))))

(test a-search-ends-when-its-time-is-over
  (let ((result (find-in-example 0.8 :rule :sound :seconds 1d-6)))
    (is (eq :undecided (discrepancy:result-status result)))
    (is (= 0 (discrepancy:result-simulations result)))
    (is (search "the time of" (discrepancy:result-reason result))))
  (signals-with (df:invalid-argument "seconds") (find-in-example 0.8 :seconds 0))
  (signals-with (df:invalid-argument "keep-going") (find-in-example 0.8 :keep-going 0))
  (signals-with (df:invalid-argument "store") (find-in-example 0.8 :store 5))
  (signals-with (df:invalid-argument "The rule paper takes no targets.")
    (find-in-example 0.8 :targets t)))

(test interrupted-searches-keep-what-they-have
  (dolist (stop (list #'discrepancy:request-stop #'discrepancy:stop-search))
    (let* ((count 0)
           (result (find-in-example 0.5 :seed 1 :keep-going t :rule :sound
                                    :progress (lambda (&key simulations &allow-other-keys)
                                                (setf count simulations)
                                                (when (>= simulations 7) (funcall stop))))))
      (is (= 7 count (discrepancy:result-simulations result)))
      (is (eq :discrepancy (discrepancy:result-status result)))
      (is (search "interrupted" (discrepancy:result-stopped result)))))
  (is (null (discrepancy:stop-search)) "there is no search to stop"))

(test progress-tells-the-phase
  (let ((phases '()))
    (find-in-example 0.5 :rule :sound :targets t :budget 30 :keep-going t
                         :progress (lambda (&key phase trace simulations verdict
                                            &allow-other-keys)
                                     (when (eq phase :target)
                                       (is (= 1 trace))
                                       (is (< 8 simulations))
                                       (is-true verdict))
                                     (pushnew phase phases)))
    (is (equal '(:confirm :explore :generate :target) (sort phases #'string<)))))

;;; Targets

(test targets-do-not-change-blind-samples
  (let* ((blind (find-in-example 0.8 :rule :sound :budget 40))
         (both (find-in-example 0.8 :rule :sound :budget 60 :targets t))
         (trace (first (discrepancy:result-traces both)))
         (common (intersection (sample-hashes blind) (sample-hashes both))))
    (is (= 34 (discrepancy:trace-result-blind trace))
        "8 of the first round, and every second one of the next 52")
    (is (= 26 (discrepancy:trace-result-targeted trace)))
    (is (= 34 (length common)))
    (is (= 60 (discrepancy:trace-result-samples trace)))))

(test targeted-samples-are-told-from-blind-ones
  "Both are numbered from 0."
  (let ((result (find-in-example 0.55 :rule :sound :seed 7 :targets t)))
    (is (eq :targeted (discrepancy:discrepancy-origin (df:result-discrepancy result))))
    (is (search "initial state of the simulation (targeted sample" (df:result-text result))))
  (let ((result (find-in-example 0.5 :rule :sound :seed 3)))
    (is (search "initial state of the simulation (sample" (df:result-text result)))))

(test targets-find-what-lies-at-the-border
  "With an arm of 0.63 m the box is out of reach in the ends of r2 alone."
  (flet ((needed (targets)
           (loop for seed from 1 to 8
                 sum (discrepancy:result-simulations
                      (find-in-example 0.625 :rule :zero-failure :seed seed :targets targets
                                             :delta 0.01d0)))))
    (is (< (needed t) (needed nil)))))

(test worst-corners-of-a-plane
  (let ((regression (statistics:make-regression 2 1))
        (region (statistics:make-parameter-region #((0d0 . 1d0) (0d0 . 2d0)) #((0d0 . 10d0)))))
    (is (null (statistics:worst-corners regression region)))
    (loop for (x y noise) in '((0.1 0.3 0.01) (0.9 0.2 -0.01) (0.4 1.7 0.02) (0.5 0.9 -0.02)
                               (0.8 1.2 0.01))
          do (statistics:add-observation
              regression (double-vector (list x y))
              (double-vector (list (+ 4 (* 3 x) (* -1 y) noise)))))
    ;; From 2 at (0, 2) to 7 at (1, 0), between the bounds 0 and 10.
    (let ((corners (statistics:worst-corners regression region)))
      (is (= 2 (length corners)))
      (is (equalp #(0d0 2d0) (first corners)))
      (is (equalp #(1d0 0d0) (second corners))))))

;;; Statements

(test the-sound-statement-counts-blind-samples
  (let* ((result (find-in-example 0.8 :rule :sound :targets t))
         (trace (first (discrepancy:result-traces result)))
         (blind (discrepancy:trace-result-blind trace)))
    (is (eq :certified (discrepancy:result-status result)))
    (is (= 0.975d0 (discrepancy:trace-result-confidence trace)))
    (is (= (statistics:zero-failure-bound blind 0.975d0) (discrepancy:trace-result-bound trace)))
    (is (<= (discrepancy:trace-result-bound trace) 0.05d0))
    (is (search (format nil "(~d blind simulations of ~d" blind
                        (discrepancy:trace-result-samples trace))
                (discrepancy:result-statement result)))
    (is (null (discrepancy:trace-result-warnings trace))))
  (let* ((result (find-in-example 0.8))
         (trace (first (discrepancy:result-traces result))))
    (is (search "0 residual degrees" (first (discrepancy:trace-result-warnings trace))))
    (is (search "at most 52.2 % of the initial region is discrepant"
                (discrepancy:trace-result-statement trace 0.95d0)))
    (is (search "at most 52.2 %" (discrepancy:result-text result))))
  (let ((trace (first (discrepancy:result-traces
                       (find-in-example 0.8 :sampler :sobol :budget 20)))))
    (is (null (discrepancy:trace-result-bound trace)))
    (is (search "none of the samples is blind"
                (discrepancy:trace-result-statement trace 0.95d0)))))

(test a-skipped-sample-voids-the-certificate
  (let* ((count 0)
         (result (handler-bind ((error (lambda (condition)
                                         (declare (ignore condition))
                                         (invoke-restart (if (oddp (incf count))
                                                             'discrepancy:retry-sample
                                                             'discrepancy:skip-sample)))))
                   (let ((original (fdefinition 'discrepancy::judge)) (calls 0))
                     (unwind-protect
                          (progn
                            (sb-int:encapsulate
                             'discrepancy::judge 'failing
                             (lambda (function &rest arguments)
                               (if (member (incf calls) '(3 4))
                                   (error "the simulator is on fire")
                                   (apply function arguments))))
                            (find-in-example 0.8 :rule :zero-failure))
                       (sb-int:unencapsulate 'discrepancy::judge 'failing)
                       (is (eq original (fdefinition 'discrepancy::judge)))))))
         (trace (first (discrepancy:result-traces result))))
    (is (= 2 count))
    (is (eq :undecided (discrepancy:result-status result)))
    (is (search "sample 2 was skipped" (discrepancy:trace-result-void trace)))
    (is (search "no certificate" (discrepancy:result-reason result)))
    (is (null (discrepancy:trace-result-bound trace)))))

(test where-no-sample-is-valid-the-reason-is-told
  "Bodies that do not overlap are too close here."
  (let* ((discrepancy::*rejection-limit* 10)
         (discrepancy::*penetration-tolerance* -1d0)
         (result (find-in-example 0.8))
         (trace (first (discrepancy:result-traces result))))
    (is (eq :skipped (discrepancy:trace-result-status trace)))
    (is (= 0 (discrepancy:result-acceptance-rate result) (discrepancy:result-simulations result)))
    (is (search "no valid initial state was found: all 11 samples were rejected"
                (discrepancy:result-reason result)))
    (is (search "penetrate" (discrepancy:result-reason result)))))

;;; Cost

(test a-late-sample-costs-what-an-early-one-does
  "Work is counted in bytes of memory that are asked for."
  (let* ((region (statistics:make-parameter-region #((0d0 . 1d0) (0d0 . 1d0)) #((0d0 . 2d0))))
         (evidence (statistics:make-evidence region))
         (targeting (discrepancy::make-targeting (list region)))
         (rule (statistics:make-confidence-rule :sound :delta 1d-6))
         (state (sb-ext:seed-random-state 1))
         (count 0))
    (flet ((work (samples)
             (let ((before (sb-ext:get-bytes-consed)))
               (loop repeat samples
                     for x = (double-vector (list (random 1d0 state) (random 1d0 state)))
                     for y = (double-vector (list (+ (aref x 0) (aref x 1)
                                                     (random 1d-3 state))))
                     do (incf count)
                        (discrepancy::next-origin targeting)
                        (discrepancy::note-values targeting 0 x y)
                        (statistics:add-sample evidence
                                               (statistics:make-parameter-sample x y))
                        (statistics:evidence-verdict rule evidence))
               (- (sb-ext:get-bytes-consed) before))))
      (work 128)
      (let ((early (work 1280)))
        (work 7300)
        (let ((late (work 1280)))
          (is (= 9988 count (statistics:evidence-blind evidence)))
          (is (< late (* 1.1 early))))))))

;;; The store

(defmacro with-folder ((folder) &body body)
  "Evaluate BODY with FOLDER bound to the name of a new folder that is deleted afterwards."
  `(call-in-new-folder (lambda (,folder) ,@body)))

(test stored-discrepancies-are-tried-first
  (with-folder (folder)
    (let* ((first (find-in-example 0.5 :seed 3 :store folder))
           (again (find-in-example 0.5 :seed 99 :store folder))
           (discrepancy (discrepancy:result-discrepancy again)))
      (is (= 1 (length (uiop:directory-files folder))))
      (is (equal (discrepancy:discrepancy-file (discrepancy:result-discrepancy first))
                 (discrepancy:discrepancy-file discrepancy)))
      (is (eq :reused (discrepancy:discrepancy-origin discrepancy)))
      (is (= 0 (discrepancy:result-iterations again)))
      (is (= (discrepancy:run-hash
              (discrepancy:discrepancy-run (discrepancy:result-discrepancy first)))
             (discrepancy:run-hash (discrepancy:discrepancy-run discrepancy))))
      (is-true (discrepancy:discrepancy-confirmed-p discrepancy)))
    (is (null (discrepancy:result-reused (find-in-example 0.8 :store folder)))
        "other parameters, another scene")
    (let ((result (find-in-example 0.5 :seed 99 :store folder :keep-going t :budget 30)))
      (is (= 1 (length (discrepancy:result-discrepancies result))) "it is of the known kind")
      (is (= 1 (discrepancy:result-iterations result)))
      (is (< 1 (discrepancy:discrepancy-occurrences (discrepancy:result-discrepancy result))))
      (is (= 1 (length (uiop:directory-files folder)))))
    (let ((file (first (uiop:directory-files folder))))
      (edited (namestring file) "\"(box-in r2)\"" "\"(box-in r1)\"")
      (with-open-file (stream (merge-pathnames "other.json" file) :direction :output)
        (write-string "[1, 2" stream))
      (destructuring-bind ((discrepancy file text))
          (discrepancy:result-reused (find-in-example 0.5 :seed 1 :store folder))
        (is (null discrepancy))
        (is (search "move-the-box" file))
        (is (search "does not allow" text))))))
