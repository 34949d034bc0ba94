;;;; CRAM's packages, and plan files that were written for them.
;;;;
;;;; The files below plan-files/ are written in the manner of CRAM's own and loaded as they are.

(in-package #:discrepancy-finder.tests)

(def-suite cram-compat :in all)
(in-suite cram-compat)

(defun plan-file (name)
  (root-file (concatenate 'string "tests/plan-files/" name)))

(defun the-symbol (name package)
  (or (find-symbol (string name) (find-global-package package))
      (error "There is no ~a in ~a." name package)))

(defun find-global-package (name)
  "Return the package NAME, not what a local nickname says."
  (let ((*package* (find-package '#:keyword)))
    (find-package name)))

(defun call (name package &rest arguments)
  (apply (the-symbol name package) arguments))

;;; The table

(test every-package-of-the-table-is-there-with-its-symbols
  (is (= (length (compat:compat-packages)) (length (compat:compat-report))))
  (dolist (entry (compat:compat-packages))
    (let ((package (find-global-package (compat:compat-package-name entry))))
      (is (equal (list (compat:compat-package-name entry) :defined package)
                 (assoc (compat:compat-package-name entry) (compat:compat-report)
                        :test #'string=)))
      (is-true (documentation package t) "~a has no documentation" package)
      (dolist (nickname (compat:compat-package-nicknames entry))
        (is (eq package (find-global-package nickname))))
      (is (null (set-exclusive-or
                 (compat:compat-package-symbols entry)
                 (loop for symbol being the external-symbols of package collect symbol)))))))

(test external-symbols-of-the-packages-are-documented
  "That is those that are not Common Lisp's own."
  (dolist (entry (compat:compat-packages))
    (dolist (symbol (compat:compat-package-symbols entry))
      (unless (eq (symbol-package symbol) (find-package '#:cl))
        (is-true (documented-p symbol) "~s has no documentation" symbol)))))

(test packages-of-cram-have-no-name-conflicts
  "A package may use all of them; only CPL and CL exclude each other, by what knows fluents."
  (let ((names (make-hash-table :test 'equal)))
    (dolist (entry (compat:compat-packages))
      (dolist (symbol (compat:compat-package-symbols entry))
        (pushnew symbol (gethash (symbol-name symbol) names))))
    (is (null (loop for symbols being the hash-values of names
                    when (rest symbols) collect symbols))))
  (is (equal '("*" "+" "-" "/" "<" "=" ">" "EQ" "EQL" "NOT" "SLEEP")
             (sort (loop for symbol being the external-symbols of '#:cl
                         unless (member symbol (compat:compat-package-symbols
                                                (first (compat:compat-packages))))
                           collect (symbol-name symbol))
                   #'string<))))

(test names-of-cram-are-ours
  (loop for (symbol name package) in `((plan:perform perform exe) (plan:seq seq cpl)
                                       (desig:a a desig) (cl:when when desig) (cl:when when cpl)
                                       (discrepancy-finder.cpl:< < cpl) (plan:fail fail cpl)
                                       (plan:fail fail prolog) (desig:property property spec)
                                       (prolog:lazy-car lazy-car cut)
                                       (transforms:make-pose make-pose cl-transforms)
                                       (transforms:pose pose cl-transforms-stamped)
                                       (transforms:*fixed-frame* *fixed-frame* cram-tf)
                                       (roslisp:ros-info ros-info roslisp)
                                       (plan:on-event on-event coe)
                                       (plan:object-attached object-attached cpoe)
                                       (plan:object-in-hand object-in-hand cpoe))
        do (is (eq symbol (the-symbol name package)))))

(test fail-and-not-of-cpl-are-predicates
  (with-file (file "(defpackage compat-1 (:use :cpl :cram-prolog)) (in-package compat-1)
(def-fact-group compat-1 ()
  (<- (small ?x) (or (and (> ?x 3) (fail)) (not (> ?x 2)))))
(defun small-p (x) (and (prolog `(small ,x)) t))")
    (plan:load-plan file)
    (is (equal '(t nil nil)
               (mapcar (the-symbol 'small-p 'compat-1) '(1 3 4))))))

(test definitions-of-packages-as-in-cram
  (dolist (uses '("#:cpl" "#:common-lisp #:cram-prolog"
                  "#:common-lisp #:cram-prolog #:cram-designators #:cram-process-modules"
                  ":cpl :roslisp :cl-transforms :cram-designators :cram-process-modules
                   :cram-language-designator-support"
                  ":cpl :cram-prolog :cram-utilities" ":cpl :desig :prolog :cut :exe :cpm :coe"
                  ":cpl-impl :common-lisp" ":cram-language :cl-transforms-stamped :cram-tf"))
    (with-file (file (format nil "(defpackage compat-2 (:use ~a)) (in-package compat-2)
(defun loaded (&key object location) (list :loaded object location))" uses))
      (unwind-protect
           (progn (plan:load-plan file)
                  (is (equal '(:loaded 1 nil) (call 'loaded 'compat-2 :object 1))))
        (delete-package '#:compat-2)))))

;;; Other images

(defun output-of-image (&rest forms)
  "Return what a new image prints that evaluates FORMS, strings, the compat system's loading among
them as :LOAD."
  (with-file (file (format nil "(require :asdf)~%~{~a~%~}"
                           (substitute
                            (format nil "(progn (asdf:load-asd ~s)
  (let ((*standard-output* (make-broadcast-stream)))
    (asdf:load-system \"discrepancy-finder/cram-compat\")))"
                                    (root-file "discrepancy-finder.asd"))
                            :load forms)))
    (uiop:run-program (list sb-ext:*runtime-pathname* "--noinform" "--no-userinit"
                            "--non-interactive" "--load" file)
                      :output :string :error-output :output :ignore-error-status t)))

(defun count-of (part text)
  (loop for start = (search part text) then (search part text :start2 (1+ start))
        while start count t))

(defparameter *left-alone*
  "(print (loop for (name what) in (discrepancy-finder.cram-compat:compat-report)
            when (eq what :left-alone) collect name))")

(test where-cram-is-nothing-is-defined
  (let ((output (output-of-image
                 "(defpackage #:cram-language (:use #:cl) (:nicknames #:cpl) (:export #:seq))"
                 :load
                 "(print (remove :left-alone (discrepancy-finder.cram-compat:compat-report)
                                 :key #'second))"
                 "(let (symbols) (do-external-symbols (s :cpl) (push s symbols)) (print symbols))"
                 "(print (mapcar #'find-package '(:cram-user :cram-prolog :exe :roslisp)))"
                 "(asdf:load-system \"discrepancy-finder/cram-compat\"
                                    :force '(\"discrepancy-finder/cram-compat\"))")))
    (is (= 1 (count-of "CRAM itself is here: discrepancy-finder/cram-compat defines none"
                       output))
        "one sentence, once: ~a" output)
    (is (search "(CRAM-LANGUAGE:SEQ)" output) "~a" output)
    (is (search "(NIL NIL NIL NIL)" output) "nothing was defined: ~a" output)))

(test a-package-that-exists-is-left-alone
  (let ((output (output-of-image
                 "(defpackage #:somebodys-prolog (:use #:cl) (:nicknames #:prolog))"
                 :load
                 *left-alone*
                 "(print (find-package :cram-prolog))"
                 "(print (package-name (find-package :cram-designators)))")))
    (is (search "(\"CRAM-PROLOG\")" output) "~a" output)
    (is (= 1 (count-of "leaves alone what is here already: cram-prolog." output)) "~a" output)
    (is (search "NIL" output))
    (is (search "\"CRAM-DESIGNATORS\"" output) "other packages are defined")))

(test a-system-that-asdf-finds-is-left-alone
  (with-plan-files (folder "roslisp.asd" "(defsystem roslisp :components ((:file \"roslisp\")))"
                           "roslisp.lisp" "(defpackage roslisp (:use :cl) (:export #:from-ros))"
                           "some-plans.asd" "(defsystem some-plans :depends-on (roslisp cram-tf))")
    (let ((output (output-of-image
                   (format nil "(push ~s asdf:*central-registry*)" folder)
                   :load
                   *left-alone*
                   "(print (discrepancy-finder.plan-language:load-plan :some-plans))"
                   "(print (find-symbol \"FROM-ROS\" :roslisp))")))
      (is (search "(\"ROSLISP\")" output) "~a" output)
      (is (search "ROSLISP:FROM-ROS" output) "~a" output))))

(test loading-twice-is-harmless-and-silent
  (let ((output (output-of-image
                 :load
                 "(print (find-package :cpl))"
                 "(asdf:load-system \"discrepancy-finder/cram-compat\"
                                    :force '(\"discrepancy-finder/cram-compat\"))"
                 *left-alone*)))
    (is (= 0 (count-of "leaves alone" output)) "~a" output)
    (is (= 0 (count-of "WARNING" output)) "~a" output)
    (is (search "NIL" output))))

;;; A system of plans

(defun call-with-table-setting (function)
  "Load the plans that set a table and call FUNCTION with what LOAD-PLAN has returned."
  (unwind-protect
       (funcall function
                (let ((*error-output* (make-broadcast-stream)))
                  (plan:load-plan (plan-file "table-setting/table-setting-plans.asd"))))
    ;; All locations would be tried with them.
    (desig:delete-location-generator-function (the-symbol 'table-places 'ts-plans))
    (desig:delete-location-validation-function (the-symbol 'not-underground 'ts-plans))))

(defmacro with-table-setting ((plans) &body body)
  `(call-with-table-setting (lambda (,plans) (declare (ignorable ,plans)) ,@body)))

(defun demo (&rest options)
  "Return what the demo of the plans does: the name of what was carried, the events, the log."
  (let* ((name nil)
         (log (with-output-to-string (*error-output*)
                (let ((*standard-output* (make-broadcast-stream)))
                  (setf name (plan:desig-prop-value (apply #'call 'demo 'ts-plans options)
                                                    :name))))))
    (values (string name)
            (loop for (event thing) in (reverse (symbol-value (the-symbol '*events* 'ts-plans)))
                  collect (list event (string thing)))
            log)))

(test a-system-of-plans-loads-and-runs
  (with-table-setting (plans)
    (is (equal '("go-to-target" "perceive" "look-at" "move-arms-in-sequence" "grip" "release"
                 "pick-up" "place" "search-for-object" "transport")
               (plan-names plans)))
    (multiple-value-bind (name events log) (demo)
      (is (string= "BOWL-1" name))
      (is (equal '((plan:object-attached "BOWL-1") (plan:object-detached "BOWL-1")) events))
      (is (search "[(TS-PLANS GO) WARN] 0.000: Driving failed: navigation-pose-unreachable: too far"
                  log)
          "the first place is too far away")
      (is (= 2 (count-of "[(TS-PLANS SEARCH-FOR-OBJECT) WARN]" log)))
      (is (= 8 (count-of "[(TS-PLANS PERCEIVE) WARN]" log)) "four retries at two places")
      (is (search "[(TS-PLANS TRANSPORT) INFO] 6.000: Arrived" log)
          "four drives of 1.5 s by the virtual clock")
      (is (equal log (nth-value 2 (demo))) "the same each time"))))

(test a-system-of-plans-recovers-from-failures
  (with-table-setting (plans)
    (multiple-value-bind (name events log) (demo :type :cup :blindness 11 :arm :right)
      (is (string= "CUP-1" name))
      (is (= 2 (length events)))
      (is (search "could not see a CUP" log)))
    (let ((report (report-of 'plan:object-nowhere-to-be-found (lambda () (demo :type :spoon)))))
      (is-true report)
      (is (search "Could not find (an object (type spoon))" report)))))

;;; A tutorial

(defun load-turtle ()
  (let ((*error-output* (make-broadcast-stream)))
    (plan:load-plan (plan-file "turtle.lisp"))))

(defmacro quietly (&body body)
  `(let ((*error-output* (make-broadcast-stream))) ,@body))

(test a-tutorial-with-fluents-loads-and-runs
  (is (equal '("move-to" "navigate-without-going-out" "draw-simple-shape" "go-out" "race"
               "visit-corner")
             (plan-names (load-turtle))))
  (is (= 4 (quietly (call 'draw 'turtle))))
  (is (equal '((0 1) (150 0)) (symbol-value (the-symbol '*pen* 'turtle))))
  (let ((pose (plan:value (symbol-value (the-symbol '*turtle-pose* 'turtle)))))
    (is (> 0.25 (transforms:v-dist (transforms:origin pose) (transforms:make-3d-vector 5 3 0)))
        "it is at the last corner"))
  (call 'init-turtle 'turtle)
  (is (eq :out (quietly (call 'go-out 'turtle)))))

(test fluents-tags-and-goals-of-a-tutorial
  (load-turtle)
  (call 'init-turtle 'turtle)
  (is (eq :seen (call 'race 'turtle 3)))
  (call 'init-turtle 'turtle)
  (is (eq :late (call 'race 'turtle 0.05)))
  (call 'init-turtle 'turtle)
  (is (equal '(:there 3) (multiple-value-list (call 'visit-corner 'turtle)))))

;;; Symbolic execution

(defun explore-lamps (plan &rest options)
  (make-lamp-domain)
  (quietly (plan:load-plan (plan-file "lamps.lisp")))
  (apply #'symbolic:explore-plan (the-symbol plan 'lamp-plans) :domain :lamps
         :constraint 'anything options))

(test plans-of-cram-packages-are-executed-symbolically
  (let ((exploration (explore-lamps 'lamp-plan
                                    :arguments `((,(quote ?which) boolean)))))
    (is-true (symbolic:exploration-complete-p exploration))
    (is (equal '((t (:success)) (t (:failure :failure)) (nil (:success)) (nil (:failure :failure)))
               (loop for trace in (symbolic:exploration-traces exploration)
                     collect (list (first (symbolic:trace-arguments trace))
                                   (loop for step in (symbolic:trace-steps trace)
                                         collect (if (eq :success (symbolic:step-outcome step))
                                                     :success
                                                     :failure))))))))

(test helpers-are-executed-symbolically
  "Compiled code would decide the flag, which makes no difference here."
  (is (= 2 (symbolic:exploration-paths
            (explore-lamps 'indifferent-plan :arguments `((,(quote ?flag) boolean)))))))

(test bindings-of-cram-utilities
  (quietly (plan:load-plan (plan-file "lamps.lisp")))
  (is (= 3 (call 'smallest-retries 'lamp-plans
                 (desig:an action (type toggling-carefully) (lamp a) (retries 3)))))
  (is (= 1 (call 'smallest-retries 'lamp-plans
                 (desig:an action (type toggling-carefully) (lamp a))))))

;;; Poses and time

(test a-stamped-pose-is-a-place-in-the-projection
  (quietly (plan:load-plan (plan-file "drive.lisp")))
  (projection:with-projection (projection (two-regions-scene))
    (let* ((drive (the-symbol 'drive 'drive-plans))
           (pose (plan:with-executive (projection) (funcall drive 1.25 0)))
           (base (projection:observed-pose projection :robot)))
      (is (typep pose 'transforms:pose-stamped))
      (is (string= "1.250 0.000 0.000" (desig:description-text pose)))
      (is (nearly 1.25 (geometry:pose-x base) 1d-3))
      (is (< 0.5 (first (symbol-value (the-symbol '*log* 'drive-plans))))
          "time has passed"))))

(test poses-of-other-frames-and-transforms-are-places
  (let ((transforms:*transformer*
          (transforms:make-frame-store "table" (geometry:make-pose 1 2 3)))
        (vector (transforms:make-3d-vector 1 0 0))
        (turn (transforms:make-identity-rotation)))
    (flet ((x-of (thing) (geometry:pose-x (desig:designated-pose thing))))
      (is (= 2 (x-of (transforms:make-pose-stamped "table" 0 vector turn))))
      (is (= 1 (x-of (transforms:make-pose vector turn))))
      (is (= 2 (x-of (transforms:make-transform-stamped "table" "cup" 0 vector turn))))
      (let ((?pose (transforms:make-pose-stamped "table" 0 vector turn)))
        (is (= 2 (x-of (desig:an object (type cup) (pose ?pose)))))
        (is (string= "(a location (pose 1.000 0.000 0.000))"
                     (princ-to-string (desig:a location (pose ?pose)))))))))

(test time-is-that-of-the-run
  (is (= 0 (roslisp:ros-time)))
  (is (equal '(0d0 2d0 2d0)
             (plan:top-level
               (let ((before (roslisp:ros-time)))
                 (plan:sleep* 2)
                 (list before (roslisp:ros-time)
                       (desig:timestamp (desig:make-effective-designator
                                         (desig:an object (type cup))))))))))

;;; What else plan files use

(test motions-have-the-commands-of-cram
  (flet ((command (motion)
           (let ((reference (desig:reference motion)))
             (cons (string-downcase (first reference)) (rest reference))))
         (place (x) (desig:make-designator :location
                                           (list (list :pose (geometry:make-pose x 0 0))))))
    (let ((?cup (desig:an object (type cup))) (?place (place 1)))
      (is (equal "move-base" (first (command (desig:a motion (type going) (target ?place))))))
      (is (= 1 (geometry:pose-x
                (third (command (desig:a motion (type looking) (target ?place)))))))
      (is (equal '("move-head" :frame "hand")
                 (command (desig:a motion (type looking) (frame "hand")))))
      (is (equal (list "detect" ?cup) (command (desig:a motion (type detecting) (object ?cup)))))
      (is (equal '("move-gripper-joint" :open :left)
                 (command (desig:a motion (type opening) (gripper left)))))
      (is (equal '("move-gripper-joint" :grip :left 5)
                 (command (desig:a motion (type gripping) (gripper left) (effort 5)))))
      (is (equal '("move-joints" (1 2) nil)
                 (command (desig:a motion (type moving-arm-joints)
                                   (left-configuration (1 2))))))
      (let ((tcp (command (desig:a motion (type moving-tcp) (right-target ?place)))))
        (is (equal '("move-tcp" nil nil) (list (first tcp) (second tcp) (fourth tcp))))
        (is (= 1 (geometry:pose-x (third tcp))))))))

(defvar *projected-with* :outside)

(plan:def-process-module projected-base (motion)
  (declare (ignore motion))
  (list *projected-with* compat:*projection-environment*))

(compat:define-projection-environment test-environment
  :special-variable-initializers ((*projected-with* :inside))
  :process-module-definitions ((the-base projected-base)))

(test projection-environments-run-process-modules-and-bind-variables
  (is (equal '(:inside test-environment)
             (compat:with-projection-environment test-environment
               (plan:top-level (plan:pm-execute 'the-base (desig:a motion (type going)))))))
  (is (null (plan:holds '(plan:projection-running ?environment))))
  (is-true (compat:with-projection-environment test-environment
             (plan:holds '(plan:projection-running ?environment))))
  (signals-with (compat:unknown-projection-environment "no-such-environment")
    (compat:with-projection-environment no-such-environment 1)))

(test lists-are-made-equally-long
  (is (equal '((1 nil) (2 3))
             (multiple-value-list (compat:equalize-two-list-lengths '(1) '(2 3)))))
  (is (equal '(((1) (nil)) ((2) (3)))
             (multiple-value-list
              (compat:equalize-lists-of-lists-lengths '((1)) '((2) (3))))))
  (is (equal '(((1 nil) (nil)) ((2 4) (3)))
             (multiple-value-list
              (compat:equalize-lists-of-lists-lengths '((1)) '((2 4) (3)))))))
