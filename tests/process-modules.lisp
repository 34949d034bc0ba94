;;;; Process modules and performing: which one is for a motion, order, nesting, loaded plans.
;;;;
;;;; What PERFORM does in its corner cases is shown, and tested, by docs/plan-language.md.

(in-package #:discrepancy-finder.tests)

(def-suite process-modules :in all)
(in-suite process-modules)

(defvar *arm-is-free* t
  "Whether the process module ARM-OF-TESTS is available.")

(defun arm-free-p (name)
  (declare (ignore name))
  *arm-is-free*)

(plan:def-process-module arm-of-tests (motion)
  "Moves an arm."
  (note-event (list :arm (plan:desig-prop-value motion :to)))
  (plan:sleep* 1)
  (when (eq :nowhere (plan:desig-prop-value motion :to))
    (plan:fail 'plan:manipulation-pose-unreachable))
  (values (plan:desig-prop-value motion :to) :unseen))

(plan:def-process-module wheels-of-tests (motion)
  (note-event (list :wheels (plan:desig-prop-value motion :to)))
  (plan:desig-prop-value motion :to))

(plan:def-process-module body-of-tests (motion)
  "Uses the wheels for what it is asked for."
  (let ((?to (plan:desig-prop-value motion :to)))
    (plan:perform (plan:a motion (type test-driving) (to ?to)))))

(prolog:def-fact-group modules-of-tests (plan:matching-process-module
                                         plan:available-process-module
                                         desig:motion-grounding)
  (prolog:<- (plan:matching-process-module ?motion arm-of-tests)
    (desig:desig-prop ?motion (:type :test-reaching)))
  (prolog:<- (plan:matching-process-module ?motion wheels-of-tests)
    (desig:desig-prop ?motion (:type :test-driving)))
  (prolog:<- (plan:matching-process-module ?motion wheels-of-tests)
    (desig:desig-prop ?motion (:type :test-reaching)))
  (prolog:<- (plan:matching-process-module ?motion body-of-tests)
    (desig:desig-prop ?motion (:type :test-walking)))
  (prolog:<- (plan:available-process-module arm-of-tests)
    (prolog:lisp-pred arm-free-p arm-of-tests))
  (prolog:<- (plan:available-process-module wheels-of-tests))
  (prolog:<- (plan:available-process-module body-of-tests))
  (prolog:<- (desig:motion-grounding ?motion (move ?to))
    (desig:desig-prop ?motion (:to ?to))))

(defmacro with-test-modules (&body body)
  `(plan:with-process-modules-running (arm-of-tests wheels-of-tests body-of-tests) ,@body))

(test the-first-module-that-matches-and-is-available
  (flet ((reach ()
           (events-of (lambda ()
                        (plan:top-level
                          (with-test-modules
                            (plan:perform (plan:a motion (type test-reaching) (to table)))))))))
    (is (equal '((:arm :table)) (reach)))
    (setf *arm-is-free* nil)
    (unwind-protect (is (equal '((:wheels :table)) (reach)))
      (setf *arm-is-free* t))))

(test only-modules-that-run
  (is (equal '((:wheels :table))
             (events-of (lambda ()
                          (plan:top-level
                            (plan:with-process-modules-running (wheels-of-tests)
                              (plan:perform (plan:a motion (type test-reaching)
                                                    (to table))))))))))

(test the-first-failure-of-several-modules
  "The module that is tried second succeeds, or the first one's failure counts."
  (let (result)
    (is (equal '((:arm :nowhere) (:wheels :nowhere))
               (events-of (lambda ()
                            (setf result
                                  (plan:top-level
                                    (with-test-modules
                                      (plan:perform (plan:a motion (type test-reaching)
                                                            (to nowhere))))))))))
    (is (eq :nowhere result)))
  (signals plan:manipulation-pose-unreachable
    (plan:top-level
      (plan:with-process-modules-running (arm-of-tests)
        (plan:perform (plan:a motion (type test-reaching) (to nowhere)))))))

(test a-module-that-performs
  (is (equal '((:wheels :door))
             (events-of (lambda ()
                          (plan:top-level
                            (with-test-modules
                              (plan:perform (plan:a motion (type test-walking)
                                                    (to door))))))))))

(plan:def-cram-function reach-one-of (places)
  (plan:with-retry-counters ((more (1- (length places))))
    (plan:with-failure-handling
        ((plan:manipulation-low-level-failure ()
           (plan:do-retry more
             (pop places)
             (plan:retry))))
      (let ((?to (first places)))
        (plan:perform (plan:a motion (type test-reaching) (to ?to)))))))

(test a-plan-handles-what-a-module-fails-with
  (flet ((reach (&rest places)
           (plan:top-level
             (plan:with-process-modules-running (arm-of-tests)
               (reach-one-of places)))))
    (is (equal '((:arm :nowhere) (:arm :nowhere) (:arm :table))
               (events-of (lambda () (reach :nowhere :nowhere :table :door)))))
    (is (eq :table (reach :nowhere :table)))
    (signals plan:manipulation-pose-unreachable (reach :nowhere :nowhere))))

(test modules-in-parallel
  (is (equal '((:arm :table) (:wheels :door) (:done :door 0d0) (:done :table 1d0))
             (events-of (lambda ()
                          (plan:top-level
                            (with-test-modules
                              (plan:par
                                (note-event
                                 (list :done
                                       (plan:perform (plan:a motion (type test-reaching)
                                                             (to table)))
                                       (plan:now)))
                                (note-event
                                 (list :done
                                       (plan:perform (plan:a motion (type test-driving)
                                                             (to door)))
                                       (plan:now)))))))))))

(test a-motion-that-times-out
  (is (equal '((:arm :table) :too-late)
             (events-of (lambda ()
                          (plan:top-level
                            (with-test-modules
                              (plan:pursue
                                (plan:perform (plan:a motion (type test-reaching) (to table)))
                                (progn (plan:sleep* 1/2) (note-event :too-late))))))))))

(test an-executive-comes-before-the-modules
  (let ((recorder (make-instance 'recorder)))
    (is (eq :test-driving
            (plan:with-executive (recorder)
              (plan:top-level
                (with-test-modules
                  (plan:perform (plan:a motion (type test-driving) (to door))))))))
    (is (equal '(:test-driving) (mapcar #'car (performed recorder))))))

(test errors-about-modules-name-them
  (signals-with (plan:process-module-not-found "no-such-module")
    (plan:top-level (plan:with-process-modules-running (no-such-module) 1)))
  (signals-with (plan:process-module-not-running "wheels-of-tests")
    (plan:top-level (plan:pm-execute 'wheels-of-tests (plan:a motion (type test-driving)))))
  (signals-with (plan:simple-plan-failure "No matching process module" "test-driving"
                                          "arm-of-tests")
    (plan:top-level
      (plan:with-process-modules-running (arm-of-tests)
        (plan:perform (plan:a motion (type test-driving) (to door))))))
  (signals-with (plan:designator-reference-failure "test-driving")
    (plan:top-level
      (with-test-modules (plan:perform (plan:a motion (type test-driving)))))))

(test modules-stand-in-the-task-tree
  (plan:named-top-level (:name :modules)
    (with-test-modules
      (plan:perform (plan:a motion (type test-walking) (to door)))))
  (let ((nodes (plan:flatten-task-tree (plan:get-top-level-task-tree :modules))))
    (is (equal '(body-of-tests wheels-of-tests)
               (loop for node in nodes
                     for head = (first (plan:task-tree-node-path node))
                     when (eq (first head) 'plan:process-module)
                       collect (second head))))
    (is (= 2 (count '(plan:goal (plan:perform plan:?designator)) nodes :test #'equal
                    :key (lambda (node) (first (plan:task-tree-node-path node))))))))

(test the-same-motions-every-time
  (flet ((walk (seed)
           (let ((plan:*scheduling-seed* seed))
             (events-of (lambda ()
                          (plan:top-level
                            (with-test-modules
                              (plan:par-loop (place '(:a :b :c))
                                (let ((?to place))
                                  (plan:perform (plan:a motion (type test-reaching) (to ?to)))
                                  (plan:perform (plan:a motion (type test-driving)
                                                        (to ?to))))))))))))
    (let ((events (walk 3)))
      (is (= 6 (length events)))
      (is (loop repeat 100 always (equal events (walk 3)))))))
