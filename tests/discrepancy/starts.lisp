;;;; Tests of starts: what a trace's path leaves open of the initial state is drawn, too.
;;;;
;;;; The robot of Example 1 drives to r2 and back and does not care where the box lies.

(in-package #:discrepancy-finder.tests)

(def-suite starts :in all)
(in-suite starts)

(defparameter *there-and-back* "(in-package #:discrepancy-finder-user)
(def-top-level-cram-function to-the-table ()
  (let ((?table (make-pose -0.3 0 0)))
    (perform (a motion (type going) (pose ?table)))))
(def-top-level-cram-function there-and-back ()
  (let ((?there (make-pose 1.5 0 0))
        (?back (make-pose 0.5 0 0)))
    (perform (a motion (type going) (pose ?there)))
    (perform (a motion (type going) (pose ?back)))))
"
  "A plan of one step for the kitchen, and one of two.")

(defun call-with-open-domain (function clauses &optional (theory "models/two-regions/theory.lisp")
                                                 (domain "models/two-regions/domain.lisp"))
  "Call FUNCTION with the domain in the file DOMAIN, but for the theory, which extends that in the
file THEORY by CLAUSES, a text; and with the name of the folder in which it is."
  (with-folder (folder)
    (flet ((file (name control &rest arguments)
             (let ((file (format nil "~a~a" folder name)))
               (with-open-file (stream file :direction :output)
                 (apply #'format stream control arguments))
               file)))
      (file "theory.lisp" "(define-theory open-regions (:extends ~s) ~a)"
            (root-file theory) clauses)
      (plan:load-plan (file "plan.lisp" "~a" *there-and-back*))
      (funcall function
               (discrepancy:load-domain
                (file "domain.lisp" "(in-package #:discrepancy-finder-user)~@
                                     (define-abstraction open-regions (:extends ~s)
                                       (:theory \"theory.lisp\"))"
                      (root-file domain)))
               folder))))

(defmacro with-open-domain ((domain folder &rest extension) &body body)
  `(call-with-open-domain (lambda (,domain ,folder) (declare (ignorable ,folder)) ,@body)
                          ,@extension))

(defun find-there-and-back (domain &rest options)
  (apply #'discrepancy:find-discrepancies 'discrepancy-finder-user::there-and-back :domain domain
         :constraint '(discrepancy-finder-user::happens
                       (discrepancy-finder-user::move discrepancy-finder-user::r1)
                       discrepancy-finder-user::?time)
         options))

(defun box-in-r1-p (run)
  (cdr (assoc '(:box-in :r1) (discrepancy:run-initial-state run) :test #'equal)))

(defun only-trace-result (result)
  (is (= 1 (length (discrepancy:result-traces result))))
  (first (discrepancy:result-traces result)))

(test an-open-choice-is-drawn
  (with-open-domain (domain folder "(:without box-starts-in-r2)")
    (let* ((result (find-there-and-back domain :rule :sound))
           (trace (only-trace-result result))
           (runs (mapcar #'car (discrepancy:trace-result-runs trace))))
      (is (eq :certified (discrepancy:result-status result)))
      (is (= 86 (length runs) (discrepancy:trace-result-blind trace)))
      (is (< 25 (count-if #'box-in-r1-p runs) 61))
      (is (every (lambda (run)
                   (eq (and (box-in-r1-p run) t)
                       (and (member '(:box-in :r1)
                                    (ec:state-fluents (symbolic:trace-initial-state
                                                       (discrepancy:run-trace trace run)))
                                    :test #'equal)
                            t)))
                 runs))
      (is (search "from 2 initial states" (discrepancy:result-text result)))
      (is (search "of 2 discrete states" (discrepancy:trace-result-statement trace 0.95d0)))
      (is (search (format nil "(box-in r1) (~d)" (count-if #'box-in-r1-p runs))
                  (discrepancy:result-text result)))
      (is (equal (outline result) (outline (find-there-and-back domain :rule :sound))))
      (loop for options in '((:rule :sound :targets t)
                             (:rule :zero-failure :sampler :stratified))
            do (let ((whole (apply #'find-there-and-back domain options))
                     (file (format nil "~a~(~a~).jsonl" folder (second options))))
                 (apply #'find-there-and-back domain :budget 30 :resume file options)
                 (is (equal (outline whole)
                            (outline (apply #'find-there-and-back domain :resume file
                                            options))))
                 (is (some #'box-in-r1-p
                           (mapcar #'car (discrepancy:trace-result-runs
                                          (only-trace-result whole))))))))))

(test every-state-leaves-nothing-open
  (with-open-domain (domain folder "(:without box-starts-in-r2)")
    (let ((result (find-there-and-back domain :traces :every-state :rule :zero-failure)))
      (is (equal '(72 94) (mapcar #'discrepancy:trace-result-blind
                                  (discrepancy:result-traces result))))
      (loop for trace in (discrepancy:result-traces result)
            do (is (= 1 (length (remove-duplicates
                                 (loop for (run) in (discrepancy:trace-result-runs trace)
                                       collect (and (box-in-r1-p run) t))))))))))

(defparameter *dragging* "(:without box-starts-in-r2)
(:axioms
 (drags-there (implies (holds-at (box-in r1) ?time)
                       (initiates (move r2) (box-in r2) ?time)))
 (drags-away (implies (holds-at (box-in r1) ?time)
                      (terminates (move r2) (box-in r1) ?time))))"
  "A theory that believes that a box in the region that the robot leaves comes along.")

(test a-discrepancy-of-another-start
  (with-open-domain (domain folder *dragging*)
    (let* ((result (find-there-and-back domain :rule :sound :shrink t :explain t :store folder))
           (trace (only-trace-result result))
           (discrepancy (discrepancy:result-discrepancy result))
           (initial (ec:state-fluents (symbolic:trace-initial-state
                                       (discrepancy:discrepancy-trace discrepancy)))))
      (is (not (member '(:box-in :r1) (ec:state-fluents
                                       (symbolic:trace-initial-state
                                        (discrepancy:trace-result-trace trace)))
                       :test #'equal))
          "the least initial state has none")
      (is (member '(:box-in :r1) initial :test #'equal))
      (is (equal '(:move :box-in) (discrepancy:discrepancy-kind discrepancy)))
      (is (every #'box-in-r1-p (mapcar #'car (discrepancy:discrepancy-runs discrepancy))))
      (is (search "DRAGS-THERE"
                  (string-upcase (discrepancy:explanation-text
                                  (discrepancy:discrepancy-explanation discrepancy)))))
      (is (eq :same-bits (discrepancy:replay-status
                          (discrepancy:replay (discrepancy:discrepancy-file discrepancy)))))
      (let ((page (format nil "~apage.html" folder)))
        (report:write-report result page)
        (is (search "drags-there" (uiop:read-file-string page)))))))

(test only-what-acted-is-taken-out
  "That the robot carries what it holds has no say where it only drives."
  (with-open-domain (domain folder *dragging*)
    (let* ((discrepancy (discrepancy:result-discrepancy
                         (find-there-and-back domain :rule :sound)))
           (edit (first (discrepancy:candidate-edits discrepancy))))
      (is (eq :weaken (discrepancy:edit-kind edit)))
      (is (equal '(:drags-away :drags-there)
                 (sort (copy-list (discrepancy:edit-replaced edit)) #'string<)))
      (is (null (discrepancy:edit-sentences edit)))
      (is-true (discrepancy:edit-removes-p edit))
      (is (zerop (discrepancy:edit-contradicted edit))))))

(test starts-as-json
  (with-open-domain (domain folder "(:without box-starts-in-r2)")
    (let* ((result (find-there-and-back domain :budget 10))
           (trace (aref (json:get-key (json:parse (json:encode (discrepancy:result-json result)))
                                      "traces")
                        0))
           (starts (json:get-key trace "starts"))
           (runs (discrepancy:trace-result-runs (only-trace-result result))))
      (flet ((range (parameters)
               (let ((x (find "box.x" parameters :test #'string=
                                                 :key (lambda (entry)
                                                        (json:get-key entry "name")))))
                 (list (json:get-key x "min") (json:get-key x "max")))))
        (is (equal '((1d0 2d0) (0d0 1d0))
                   (map 'list (lambda (start) (range (json:get-key start "parameters"))) starts)))
        (is (equal '(0d0 2d0) (range (json:get-key trace "parameters")))))
      (is (equal (loop for (run) in runs collect (if (box-in-r1-p run) 2 1))
                 (map 'list (lambda (run) (json:get-key run "start"))
                      (json:get-key trace "runs"))))
      (is (= 10 (reduce #'+ starts :key (lambda (start) (json:get-key start "accepted")))))
      (let ((page (format nil "~apage.html" folder))
            (in-r1 (count-if #'box-in-r1-p runs :key #'car)))
        (report:write-report result page)
        (is (search (format nil "<p>Valid samples by what is open initially: ~
                                 (box-in r2) (~d) or (box-in r1) (~d).</p>" (- 10 in-r1) in-r1)
                    (uiop:read-file-string page)))))))

(test states-that-cannot-be-sampled
  "The box may be nowhere, by the theory, or in both regions."
  (with-open-domain (domain folder
                     "(:without box-starts-in-r2 box-somewhere box-in-one-region)")
    (let* ((result (find-there-and-back domain :rule :zero-failure))
           (trace (only-trace-result result)))
      (is (eq :certified (discrepancy:result-status result)))
      (is (= 2 (length (discrepancy::trace-result-starts trace))))
      (is (equal '("Of the trace's initial states 2 cannot be sampled.")
                 (discrepancy:trace-result-warnings trace)))
      (is (search "of 2 discrete states" (discrepancy:trace-result-statement trace 0.95d0))))))

(test a-state-that-is-not-met-has-no-say
  "By the scene whatever lies in r1 penetrates the robot."
  (with-open-domain (domain folder "(:without box-starts-in-r2)")
    (let ((result nil))
      (sb-int:encapsulate 'discrepancy::sample-validity 'crowded
                          (lambda (function projection trace state)
                            (if (cdr (assoc '(:box-in :r1) state :test #'equal))
                                "it is crowded there"
                                (funcall function projection trace state))))
      (unwind-protect (setf result (find-there-and-back domain :rule :sound))
        (sb-int:unencapsulate 'discrepancy::sample-validity 'crowded))
      (let ((trace (only-trace-result result)))
        (is (eq :certified (discrepancy:result-status result)))
        (is (= 86 (discrepancy:trace-result-blind trace)))
        (is (< 50 (discrepancy:trace-result-rejected trace)))
        (is (equal '("No sample of the initial state (robot-in r1) (box-in r1) was valid.")
                   (discrepancy:trace-result-warnings trace)))
        (is (search "from 1 initial state " (discrepancy:trace-result-reason trace)))))))

(test drawers-may-be-open
  "The robot drives to the table with any of three drawers open and the spoon in any of them."
  (with-open-domain (domain folder "(:without drawers-start-closed spoon-starts-in-a-drawer)
      (:axioms (spoon-in-some-drawer (initially (exists (?drawer) (in spoon ?drawer)))))"
                     "models/kitchen/drawers-theory.lisp" "models/kitchen/drawers.lisp")
    (let* ((result (discrepancy:find-discrepancies
                    'discrepancy-finder-user::to-the-table :domain domain
                    :constraint :any-action :rule :zero-failure :budget 30))
           (trace (only-trace-result result))
           (joints (loop for (run) in (discrepancy:trace-result-runs trace)
                         append (mapcar #'cdr (discrepancy::sample-joints
                                               (discrepancy:run-sample run))))))
      (is (= 24 (length (discrepancy::trace-result-starts trace))))
      (is (= 90 (length joints)))
      (is (some #'zerop joints))
      (is (every (lambda (position) (or (zerop position) (<= 0.3d0 position 0.4d0))) joints)
          "the range of a drawer that is open goes beyond the joint's limit"))))

;;; The parts

(test traces-have-alternatives
  (flet ((initials (traces)
           (loop for trace in traces
                 collect (ec:state-fluents (symbolic:trace-initial-state trace)))))
    (let* ((text "
(def-top-level-cram-function lamp-plan ()
  (with-failure-handling ((gripper-goal-not-reached () (return)))
    (perform (a motion (type toggling) (lamp a)))))")
           (atoms '((:lit :b) (:broken :b)))
           (trace (first (symbolic:exploration-traces
                          (explore-text text :constraint 'lamp-a-lit :alternatives atoms)))))
      (is (equal '() (first (initials (list trace)))))
      (is (equal '(((:broken :b)) ((:lit :b))) (initials (symbolic:trace-alternatives trace))))
      (is (null (symbolic:trace-more-p trace)))
      (is (every (lambda (other) (equal (symbolic:trace-steps trace)
                                        (symbolic:trace-steps other)))
                 (symbolic:trace-alternatives trace)))
      (let* ((symbolic::*alternatives-wanted* 1)
             (trace (first (symbolic:exploration-traces
                            (explore-text text :constraint 'lamp-a-lit :alternatives atoms)))))
        (is (equal '(((:broken :b))) (initials (symbolic:trace-alternatives trace))))
        (is-true (symbolic:trace-more-p trace)))
      (is (null (symbolic:trace-alternatives
                 (first (symbolic:exploration-traces
                         (explore-text text :constraint 'lamp-a-lit)))))))))

(test mixed-evidence
  "Each part is predicted by itself, with its share of alpha; all blind samples are counted."
  (let ((evidence (statistics:make-mixed-evidence (list (linear-region 0 1) (linear-region 5 6))))
        (sound (statistics:make-confidence-rule :sound :confidence 0.95d0 :delta 0.05d0)))
    (flet ((status (rule) (statistics:verdict-status
                           (statistics:evidence-verdict
                            (if (keywordp rule) (statistics:make-confidence-rule rule) rule)
                            evidence)))
           (shifted (sample)
             (statistics:make-parameter-sample
              (statistics:parameter-sample-initial sample)
              (map '(simple-array double-float (*)) (lambda (value) (+ value 5))
                   (statistics:parameter-sample-final sample)))))
      (dolist (sample (linear-samples 80 :noise 0.001d0))
        (statistics:add-sample evidence sample 0))
      (is (eq :confident (status :zero-failure)))
      (is (eq :continue (status :paper-sd)))
      (is (search "initial state 2" (statistics:verdict-reason
                                     (statistics:evidence-verdict sound evidence)))
          "nothing is known of the second part")
      (dolist (sample (linear-samples 5 :noise 0.001d0 :blind-p nil))
        (statistics:add-sample evidence sample 1))
      (is (eq :continue (status :prediction)))
      (dolist (sample (mapcar #'shifted (linear-samples 30 :noise 0.001d0)))
        (statistics:add-sample evidence sample 1))
      (is (= 110 (statistics:evidence-blind evidence)))
      (is (= 5 (statistics:evidence-targeted evidence)))
      (dolist (rule '(:zero-failure :prediction :sound))
        (is (eq :confident (status rule))))
      (let ((parts (statistics:verdict-parts (statistics:evidence-verdict sound evidence))))
        (is (equal '(0 1) (mapcar #'car parts)))
        (is (equal '(80 30) (mapcar (lambda (part) (statistics:verdict-count (cdr part)))
                                    parts))))))
  (let ((evidence (statistics:make-mixed-evidence (list (linear-region 0 1) (linear-region 0 1))))
        (rule (statistics:make-confidence-rule :paper-sd)))
    (flet ((status ()
             (statistics:verdict-status (statistics:evidence-verdict rule evidence))))
      (dolist (sample (linear-samples 10 :noise 0.001d0))
        (statistics:add-sample evidence sample 1))
      (is (eq :continue (status)))
      (statistics:leave-out-part evidence 0)
      (is (eq :confident (status)))
      (statistics:add-sample evidence (first (linear-samples 1)) 0)
      (is (eq :continue (status)) "the part is met after all")))
  (flet ((width (rule evidence)
           (let* ((verdict (statistics:evidence-verdict rule evidence))
                  (part (or (cdr (first (statistics:verdict-parts verdict))) verdict)))
             (destructuring-bind ((low . high)) (statistics:verdict-intervals part)
               (- high low)))))
    (let ((mixed (statistics:make-mixed-evidence (list (linear-region -9 9) (linear-region -9 9))))
          (single (statistics:make-evidence (linear-region -9 9))))
      (dolist (sample (linear-samples 20 :noise 0.1d0))
        (statistics:add-sample mixed sample 0)
        (statistics:add-sample mixed sample 1)
        (statistics:add-sample single sample))
      (is (nearly (width (statistics:make-confidence-rule :prediction :confidence 0.95d0) mixed)
                  (width (statistics:make-confidence-rule :prediction :confidence 0.975d0) single)
                  1d-9)))))
