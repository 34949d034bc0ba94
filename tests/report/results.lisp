;;;; Results for the tests of reports, and what the JSON of a result tells.

(in-package #:discrepancy-finder.tests)

(def-suite report :in all)
(in-suite report)

(defvar *found-result* nil
  "A result with a discrepancy that is shrunk and explained, once it was asked for.")

(defun found-result ()
  "Return the result of a search in which one sample agrees before another does not."
  (or *found-result*
      (setf *found-result*
            (df:find-discrepancies 'discrepancy-finder-user::move-the-box
                                   :domain :two-regions :parameters '(:reach 0.55d0) :seed 4
                                   :shrink t :explain t))))

(defun certified-result ()
  (df:find-discrepancies 'discrepancy-finder-user::move-the-box :domain :two-regions))

(defun undecided-result ()
  (df:find-discrepancies 'discrepancy-finder-user::move-the-box :domain :two-regions :budget 1))

(defun json-of (result)
  "Return RESULT as it comes out of its JSON text."
  (json:parse (json:encode (df:result-json result) :pretty t)))

(defun json-at (object &rest keys)
  "Return what is in OBJECT under the first of KEYS, strings or indices, in that under the second,
and so on."
  (dolist (key keys object)
    (setf object (if (integerp key) (svref object key) (json:get-key object key)))))

(defun shows-p (part page)
  "Return true if PART is in PAGE, a text that is too long for the message of a failed check."
  (and (search part page) t))

(test the-json-of-a-result-tells-what-the-result-does
  (let* ((result (found-result))
         (object (json-of result))
         (discrepancy (df:result-discrepancy result))
         (divergence (discrepancy:judgement-divergence (df:discrepancy-judgement discrepancy))))
    (is (string= "discrepancy" (json-at object "status")))
    (is (= (df:result-simulations result) (json-at object "simulations")))
    (is (= (df:result-iterations result) (json-at object "iterations")))
    (is (= 0.55d0 (json-at object "parameters" "reach")))
    (is (string= "plans/move-the-box.lisp" (without-directories (json-at object "plan" "file"))))
    (is (= 1 (length (json-at object "discrepancies"))))
    (let ((found (json-at object "discrepancies" 0)))
      (is (= 1 (json-at found "trace")))
      (is (= (1+ (discrepancy:divergence-step divergence)) (json-at found "divergence" "step")))
      (is (equalp #("(holding-box)" :true :false) (json-at found "divergence" "fluents" 0)))
      (is (= 4 (length (json-at found "theory" "steps"))))
      (is (= 2 (length (json-at found "simulation" "steps"))))
      (is (string= "(pick-up)" (json-at found "theory" "steps" 1 "event")))
      (is (string= "manipulation-pose-unreachable"
                   (json-at found "simulation" "steps" 1 "outcome")))
      (is (equalp #("(robot-in r2)" "(box-in r2)") (json-at found "simulation" "final")))
      (is (equalp #("consistent" "consistent" "discrepancy")
                  (map 'vector (lambda (run) (json-at run "verdict")) (json-at found "runs"))))
      (is (equalp (discrepancy:sample-values (df:discrepancy-sample discrepancy))
                  (json-at found "runs" 2 "values")))
      (is (= 2 (json-at found "explanation" "step")))
      (is (equalp #(4 2) (json-at found "shrunk" "steps"))))))

(test the-json-of-a-certified-and-of-an-undecided-result
  (let ((object (json-of (certified-result))))
    (is (string= "certified" (json-at object "status")))
    (is (equalp #() (json-at object "discrepancies")))
    (is (string= "certified" (json-at object "traces" 0 "status")))
    (is (= (json-at object "simulations") (length (json-at object "traces" 0 "runs"))))
    (is (equalp (json-at object "traces" 0 "theory" "final")
                (json-at object "traces" 0 "simulation" "final"))))
  (let ((object (json-of (undecided-result))))
    (is (string= "undecided" (json-at object "status")))
    (is (search "budget" (json-at object "reason")))))

(test equal-searches-have-equal-json-but-for-seconds
  (labels ((timeless (value)
             (typecase value
               (cons (loop for (key . element) in value
                           unless (search "seconds" key)
                             collect (cons key (timeless element))))
               (string value)
               (vector (map 'vector #'timeless value))
               (t value))))
    (is (equalp (timeless (json-of (certified-result))) (timeless (json-of (certified-result)))))))

;;; Trails

(test a-trail-is-the-way-of-the-base
  "From where the base stands, to the middle of r2, and back to that of r1, at most 0.1 m apart."
  (let ((trail '()))
    (df:run-plan 'discrepancy-finder-user::move-the-box
                 :domain :two-regions :state '((:robot :x 0.25) (:box :x 1.5))
                 :observer (let ((begun nil))
                             (lambda (projection designator failure)
                               (declare (ignore designator failure))
                               (unless begun
                                 (setf begun t)
                                 (projection:record-trail projection))
                               (setf trail (projection:base-trail projection)))))
    (let ((xs (mapcar #'first trail)))
      (is (= 0.25d0 (first xs)))
      (is (< (abs (- 1.5d0 (reduce #'max xs))) 1d-9))
      (is (< (abs (- 0.5d0 (first (last xs)))) 1d-9))
      (is (loop for (x next) on xs while next always (<= (abs (- next x)) 0.1001d0)))
      (is (every (lambda (place) (< (abs (second place)) 1d-9)) trail)))))

(test what-is-not-recorded-leaves-no-trail
  (df:with-projection (projection (discrepancy:domain-scene (two-regions)))
    (is (null (projection:base-trail projection)))))

;;; The text on results

(defun json-keys (value)
  "Return the list of the keys of objects in VALUE, but for those that are names of something."
  (typecase value
    (string '())
    (vector (reduce #'union (map 'list #'json-keys value) :initial-value '()))
    (cons (let ((keys '()))
            (loop for (key . element) in value
                  do (pushnew key keys :test #'string=)
                     (unless (member key '("parameters" "values" "shrunk" "explanation" "sample")
                                     :test #'string=)
                       (setf keys (union (json-keys element) keys :test #'string=))))
            keys))
    (t '())))

(test the-text-on-results-names-every-key
  (let ((text (uiop:read-file-string (root-file "docs/results.md"))))
    (dolist (key (union (json-keys (json-of (found-result)))
                        (json-keys (json-of (certified-result)))
                        :test #'string=))
      (is-true (shows-p (format nil "`~a`" key) text) "~s is not in docs/results.md" key))))
