;;;; Tests of shrinking: what is left is a discrepancy of the same kind and cannot be made smaller.

(in-package #:discrepancy-finder.tests)

(def-suite shrink :in all)
(in-suite shrink)

(defun example-discrepancy (seed)
  (df:result-discrepancy (find-in-example 0.5 :seed seed)))

(defun table-top-discrepancy ()
  "Return the discrepancy of a narrow camera in which the cereal is on the right side."
  (handler-bind ((discrepancy:discrepancy-found
                   (lambda (condition)
                     (declare (ignore condition))
                     (invoke-restart 'discrepancy:next-trace))))
    (second (discrepancy:result-discrepancies
             (df:find-discrepancies *find-object* :domain :table-top :seed 1 :budget 100
                                    :on-discrepancy :signal
                                    :parameters '(:camera-field-of-view 0.9))))))

(defun shrunk-steps (discrepancy)
  (mapcar #'symbolic:step-designator
          (symbolic:trace-steps (discrepancy:discrepancy-trace discrepancy))))

(defun verdict-from (discrepancy sample)
  "Return the verdict on a run of DISCREPANCY from SAMPLE."
  (let ((run (discrepancy:run-case discrepancy :sample sample)))
    (and (eq :valid (discrepancy:run-validity run))
         (discrepancy:judgement-verdict
          (discrepancy:judge-run (discrepancy::discrepancy-domain discrepancy) run
                                 (discrepancy:discrepancy-trace discrepancy))))))

(defun shrinker-of (discrepancy)
  (make-instance 'discrepancy::shrinker :original discrepancy :best discrepancy :context nil
                                        :kind (discrepancy:discrepancy-kind discrepancy)
                                        :max-runs 200 :deadline 1d100))

(defun without-element (number list)
  (append (subseq list 0 number) (nthcdr (1+ number) list)))

(test smallest-lists-are-minimal
  ;; What is needed is known: some elements, of which one needs another that follows.
  (let ((state (sb-ext:seed-random-state 11)))
    (dotimes (i 60)
      (let* ((size (1+ (random 40 state)))
             (list (alexandria:iota size))
             (needed (remove-if (lambda (x) (declare (ignore x)) (plusp (random 6 state))) list))
             (asked 0))
        (flet ((enough-p (some) (incf asked) (subsetp needed some)))
          (is (equal needed (discrepancy::smallest-list list #'enough-p)))
          (is (< asked (* 25 size)) "~d questions for ~d elements" asked size)))))
  ;; Pairs: an element can go only with its partner.
  (flet ((paired-p (some)
           (and (member 5 some)
                (loop for x in '(0 1 2) always (eq (null (member x some))
                                                   (null (member (+ x 10) some)))))))
    (is (equal '(5) (discrepancy::smallest-list '(0 1 2 5 10 11 12) #'paired-p :pairs t)))))

(test the-example-shrinks-to-its-reason
  (dolist (seed '(1 2 3))
    (let* ((original (example-discrepancy seed))
           (shrinking (df:shrink-discrepancy original))
           (smaller (df:shrinking-discrepancy shrinking)))
      (is (null (discrepancy:shrinking-exhausted shrinking)))
      (is-true (discrepancy:discrepancy-confirmed-p smaller))
      (is (equal '(:pick-up :manipulation-pose-unreachable)
                 (discrepancy:discrepancy-kind original)))
      (is (equal (discrepancy:discrepancy-kind original) (discrepancy:discrepancy-kind smaller)))
      (is (equal '("(a motion (type going) (pose 1.500 0.000 0.000))"
                   "(an action (type picking-up) (object (an object (type box))))")
                 (shrunk-steps smaller)))
      (is (equal '("box.x")
                 (loop for number in (discrepancy::mattering-numbers smaller)
                       collect (discrepancy:parameter-name
                                (nth number (discrepancy::sample-parameters
                                             (discrepancy:discrepancy-sample smaller))))))
          "where the robot starts and how the box is turned do not matter")
      (is (string= (discrepancy:shrinking-text shrinking)
                   (discrepancy:shrinking-text (df:shrink-discrepancy original)))
          "shrinking is deterministic"))))

(test the-boundary-has-a-discrepancy-on-one-side-only
  (dolist (original (list (example-discrepancy 1) (table-top-discrepancy)))
    (let* ((shrinking (df:shrink-discrepancy original))
           (smaller (df:shrinking-discrepancy shrinking))
           (boundary (df:shrinking-boundary shrinking))
           (parameter (discrepancy:boundary-parameter boundary)))
      (is (eq :discrepancy (verdict-from smaller (discrepancy:boundary-failing boundary))))
      (is (eq :consistent (verdict-from smaller (discrepancy:boundary-passing boundary))))
      (destructuring-bind ((changed failing passing)) (discrepancy::changed-values boundary)
        (is (eq parameter changed))
        (is (<= (abs (- failing passing))
                (* 1.001d0 1/1000 (- (discrepancy:parameter-max parameter)
                                     (discrepancy:parameter-min parameter)))))))))

(test where-no-coordinate-alone-makes-a-difference-a-passing-sample-is-found
  (dolist (seed '(1 2))
    (let* ((original (example-discrepancy seed))
           (boundary (discrepancy::boundary-between (shrinker-of original)
                                                    (discrepancy:discrepancy-sample original))))
      (is (eq :discrepancy (verdict-from original (discrepancy:boundary-failing boundary))))
      (is (eq :consistent (verdict-from original (discrepancy:boundary-passing boundary))))
      (is (= 1 (length (discrepancy::changed-values boundary)))
          "what makes no difference stays as it was"))))

(test what-no-step-mentions-is-left-out-of-the-world
  (let* ((original (table-top-discrepancy))
         (smaller (df:shrinking-discrepancy (df:shrink-discrepancy original))))
    (is (= 6 (length (shrunk-steps original))) "the cereal is sought on the left side first")
    (is (equal '("(a motion (type going) (pose 1.600 0.000 0.000))"
                 "(a motion (type looking) (pose 1.600 0.800 0.800))"
                 "(a motion (type detecting) (object (an object (type cereal))))")
               (shrunk-steps smaller)))
    (is (equal '(:cup) (discrepancy:discrepancy-left-out smaller)))
    (is (null (assoc '(:cup-on :left) (discrepancy:run-initial-state
                                       (discrepancy:discrepancy-run smaller))
                     :test #'equal))
        "what the theory says of it is not observed")
    (is (search "left out of the world: cup" (df:discrepancy-text smaller)))
    (dotimes (number 2)
      (is (not (discrepancy::improve-by-steps
                (shrinker-of smaller)
                (without-element number (discrepancy::short-steps smaller))))
          "step ~d is needed" (1+ number)))))

(test what-passed-must-still-pass
  (let* ((original (example-discrepancy 1))
         (steps (discrepancy::short-steps original)))
    (flet ((improved-p (&rest witnesses)
             (let ((shrinker (shrinker-of original)))
               (setf (discrepancy::shrinker-witnesses shrinker) witnesses)
               (discrepancy::improve-by-steps shrinker steps))))
      (let* ((witnesses (discrepancy::find-witnesses (shrinker-of original)))
             (values (mapcar (lambda (sample)
                               (coerce (discrepancy:sample-values sample) 'list))
                             witnesses)))
        (is (equal '(0.5d0 0d0 1.5d0 0.4d0 0d0) (first values)) "the ordinary sample passes")
        (is (= 2 (length witnesses)))
        (dolist (witness witnesses)
          (is (eq :consistent (verdict-from original witness))))
        (is-true (apply #'improved-p witnesses)))
      (is (null (improved-p (discrepancy:discrepancy-sample original)))
          "a witness that does not pass"))))

(test without-its-plan-a-run-has-the-same-bits
  (let* ((original (table-top-discrepancy))
         (actions (mapcar #'discrepancy::short-step-action (discrepancy::short-steps original)))
         (run (discrepancy:run-case (discrepancy::variation original :actions actions))))
    (is (= (discrepancy:run-hash (discrepancy:discrepancy-run original))
           (discrepancy:run-hash run)))
    (is (equal (outcomes-of (discrepancy:discrepancy-run original)) (outcomes-of run)))))

(test shrinking-keeps-to-its-bounds
  (let ((original (example-discrepancy 2)))
    (let ((shrinking (df:shrink-discrepancy original :max-runs 0)))
      (is (eq original (df:shrinking-discrepancy shrinking)))
      (is (null (df:shrinking-boundary shrinking)))
      (is (string= "after 0 runs" (discrepancy:shrinking-exhausted shrinking))))
    (loop for max-runs from 1 to 25 by 4
          for shrinking = (df:shrink-discrepancy original :max-runs max-runs)
          do (is (<= (discrepancy:shrinking-runs shrinking) (1+ max-runs)))
             (is (eq :discrepancy
                     (verdict-from (df:shrinking-discrepancy shrinking)
                                 (discrepancy:discrepancy-sample
                                  (df:shrinking-discrepancy shrinking))))))
    (is (string= "when its time was over"
                 (discrepancy:shrinking-exhausted
                  (df:shrink-discrepancy original :max-seconds 0))))
    (signals-with (discrepancy:invalid-argument "max-runs")
      (df:shrink-discrepancy original :max-runs -1))
    (signals-with (discrepancy:invalid-argument "max-seconds")
      (df:shrink-discrepancy original :max-seconds "long"))))

;;; Files

(defmacro with-shrunk-file ((file discrepancy original) &body body)
  `(uiop:with-temporary-file (:pathname path :type "json")
     (let ((,file (namestring path))
           (,discrepancy (df:shrinking-discrepancy (df:shrink-discrepancy ,original))))
       (df:save-discrepancy ,discrepancy ,file)
       ,@body)))

(test a-shrunk-discrepancy-replays
  (dolist (original (list (example-discrepancy 1) (table-top-discrepancy)))
    (with-shrunk-file (file smaller original)
      (let* ((result (df:replay file))
             (again (discrepancy:replay-discrepancy result)))
        (is (eq :same-bits (df:replay-status result)))
        (is (equal (shrunk-steps smaller) (shrunk-steps again)))
        (is (equal (discrepancy:discrepancy-left-out smaller)
                   (discrepancy:discrepancy-left-out again)))
        (let ((shrinking (df:shrink-discrepancy again)))
          (is (equal (shrunk-steps smaller)
                     (shrunk-steps (df:shrinking-discrepancy shrinking)))))))))

(test a-shrunk-discrepancy-has-the-arguments-of-its-plan
  (let* ((original (df:result-discrepancy
                    (df:find-discrepancies *find-object* :domain :table-top :budget 100
                                           :arguments '((?object-type item))
                                           :parameters '(:camera-field-of-view 0.9))))
         (arguments (symbolic:trace-arguments (discrepancy:discrepancy-trace original))))
    (is (= 1 (length arguments)))
    (with-shrunk-file (file smaller original)
      (is (equal arguments
                 (symbolic:trace-arguments (discrepancy:discrepancy-trace smaller))))
      (is (eq :same-bits (df:replay-status (df:replay file)))))))

(test files-of-the-first-format-are-read
  (with-stored-discrepancy (file discrepancy)
    (edited file "discrepancy 2\"" "discrepancy 1\"")
    (edited file "\"actions\": []," "")
    (edited file "\"left-out\": []," "")
    (edited file "\"comparison\": \"consistent\"," "")
    (is (eq :same-bits (df:replay-status (df:replay file))))))

(defmacro shrunk-problem-of ((old new) &rest parts)
  `(with-shrunk-file (file discrepancy (example-discrepancy 1))
     (signals-with (df:replay-error file ,@parts) (df:replay (edited file ,old ,new)))))

(test bad-actions-are-refused
  (shrunk-problem-of ("\"left-out\": []" "\"left-out\": [\"sofa\"]") "left-out" "sofa")
  (shrunk-problem-of ("\"left-out\": []" "\"left-out\": [3]") "left-out")
  (shrunk-problem-of ("\"consistent\"" "\"equal\"") "comparison")
  (shrunk-problem-of ("\"class\": \"motion\"" "\"class\": \"object\"") "actions")
  (shrunk-problem-of ("\"class\": \"motion\"" "\"class\": 5") "class")
  (shrunk-problem-of ("\"going\"" "\"no-such-name-anywhere\"") "no-such-name-anywhere")
  (shrunk-problem-of ("[1.5, 0.0" "[1.5") "seven")
  (shrunk-problem-of ("\"actions\": [" "\"actions\": [5, ") "actions"))

(test descriptions-are-the-same-after-writing-and-reading
  (let* ((action (plan:make-designator
                  :action
                  `((:type :placing) (:arms (:left :right)) (:effort 12) (:speed 0.25d0)
                    (:part 1/3) (:single 0.1f0) (:text "a \"quoted\" text") (:flag t) (:none nil)
                    (:name discrepancy-finder-user::move-the-box)
                    (:object ,(plan:make-designator
                               :object `((:type :box)
                                         (:pose ,(geometry:make-pose 0.1 0.2 0.3 :yaw 1.1))))))))
         (description (discrepancy::described action))
         (text (json:encode (discrepancy::description-json description)))
         (again (discrepancy::action-from-json (json:parse text))))
    (is (string= (princ-to-string action) (discrepancy:recorded-action-text again)))
    (is (string= text (json:encode (discrepancy::description-json
                                    (discrepancy::recorded-action-description again)))))
    (is (eql 0.1f0 (second (assoc :single (discrepancy::description-properties
                                           (discrepancy::recorded-action-description again)))))))
  (is (not (discrepancy::writable-p
            (discrepancy::make-recorded-action
             :description (discrepancy::described
                           (plan:make-designator :motion `((:type :going)
                                                           (:pose ,(make-hash-table))))))))))
