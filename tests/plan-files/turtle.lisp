;;; A plan file in the manner of a tutorial: all in one file, a package of its own, fluents.

(defpackage :turtle-tutorial
  (:nicknames :turtle)
  (:use :cpl :roslisp :cl-transforms :cram-designators :cram-process-modules
        :cram-language-designator-support)
  (:import-from :cram-prolog :def-fact-group :<- :lisp-fun)
  (:import-from :exe :perform)
  (:export :draw-house :follow :*turtle-pose*))

(in-package :turtle-tutorial)

(defvar *turtle-pose* (make-fluent :name :turtle-pose) "current pose of turtle")
(defvar *color-sensor* (make-fluent :name :color-sensor :value 0))
(defparameter *velocity* (cons 0 0) "what was commanded: (forward . turn)")
(defparameter *pen* '())

(defun init-turtle (&key (x 1) (y 1) (angle 0))
  (setf *velocity* (cons 0 0)
        *pen* '()
        (value *color-sensor*) 0
        (value *turtle-pose*)
        (make-pose (make-3d-vector x y 0)
                   (axis-angle->quaternion (make-3d-vector 0 0 1) angle))))

(defun send-vel-cmd (lin ang)
  "function to send velocity commands"
  (setf *velocity* (cons lin ang)))

;;; The simulator.

(defun turtle-moves (seconds)
  (destructuring-bind (lin . ang) *velocity*
    (let* ((pose (value *turtle-pose*))
           (step (make-transform
                  (make-3d-vector (* lin seconds) 0 0)
                  (euler->quaternion :az (* ang seconds)))))
      (setf (value *turtle-pose*)
            (transform-pose (pose->transform pose) (transform->pose step))))))

(defun simulate ()
  (loop
    (sleep 0.02)
    (turtle-moves 0.02)))

;;; Control.

(defun relative-angle-to (goal pose)
  "Given a `pose' and a `goal', a 3d-vector, calculate the angle by which the pose has to be turned
to point towards the goal."
  (let ((diff (v- goal (origin pose))))
    (normalize-angle
     (- (atan (y diff) (x diff))
        (get-yaw (orientation pose))))))

(defun calculate-angular-cmd (goal &optional (ang-vel-factor 8))
  (* ang-vel-factor (relative-angle-to goal (value *turtle-pose*))))

(defun distance-to (goal pose)
  (v-dist goal (origin pose)))

(def-cram-function move-to (goal &optional (distance-threshold 0.1))
  (let ((reached-fl (< (fl-funcall #'distance-to goal *turtle-pose*)
                       distance-threshold)))
    (unwind-protect
         (pursue
           (wait-for reached-fl)
           (whenever ((pulsed *turtle-pose*))
             (send-vel-cmd
              1.5
              (calculate-angular-cmd goal))))
      (send-vel-cmd 0 0))))

(define-condition out-of-bounds-error (simple-plan-failure)
  ((description :initarg :description
                :initform "Turtle went out of bounds"
                :reader error-description))
  (:report (lambda (condition stream)
             (format stream (error-description condition)))))

(defgeneric at-border-p (pose)
  (:method ((pose pose))
    (with-slots (origin) pose
      (or (> (x (origin pose)) 11) (< (x (origin pose)) 0)))))

(def-cram-function navigate-without-going-out (goal)
  (let ((at-border (fl-funcall #'at-border-p *turtle-pose*)))
    (with-failure-handling
        ((out-of-bounds-error (e)
           (ros-warn (turtle moving) "Turned back: ~a" e)
           (return :out)))
      (pursue
        (seq
          (wait-for at-border)
          (fail 'out-of-bounds-error :description "over the border"))
        (move-to goal)))))

;;; Designators.

(defun calculate-edges (?radius ?edges)
  (loop for i below ?edges
        collect (make-3d-vector (+ 5 (* ?radius (cos (* 2 pi (/ i ?edges)))))
                                (+ 5 (* ?radius (sin (* 2 pi (/ i ?edges)))))
                                0)))

(def-fact-group turtle-motion-designators (motion-grounding)

  (<- (motion-grounding ?desig (drive-to ?goal))
    (desig-prop ?desig (:type :going-to))
    (desig-prop ?desig (:goal ?goal)))

  (<- (motion-grounding ?desig (set-pen ?r ?off))
    (desig-prop ?desig (:type :setting-pen))
    (or (desig-prop ?desig (:r ?r))
        (equal ?r 0))
    (or (desig-prop ?desig (:off ?off))
        (and (not (desig-prop ?desig (:off ?_)))
             (equal ?off 1)))))

(def-fact-group turtle-actions (action-grounding)

  (<- (action-grounding ?desig (draw-simple-shape ?vertices))
    (desig-prop ?desig (:type :drawing))
    (desig-prop ?desig (:shape :polygon))
    (desig-prop ?desig (:radius ?radius))
    (desig-prop ?desig (:edges ?edges))
    (lisp-fun calculate-edges ?radius ?edges ?vertices)))

(def-process-module turtle-navigation (motion-designator)
  (ros-info (turtle process-modules) "going with ~a" motion-designator)
  (destructuring-bind (command goal) (reference motion-designator)
    (ecase command
      (drive-to (move-to goal)))))

(def-process-module turtle-pen (motion-designator)
  (destructuring-bind (command r off) (reference motion-designator)
    (ecase command
      (set-pen (push (list r off) *pen*)))))

(def-fact-group turtle-process-modules (available-process-module matching-process-module)
  (<- (available-process-module turtle-navigation))
  (<- (available-process-module turtle-pen))
  (<- (matching-process-module ?desig turtle-navigation)
    (desig-prop ?desig (:type :going-to)))
  (<- (matching-process-module ?desig turtle-pen)
    (desig-prop ?desig (:type :setting-pen))))

;;; Plans.

(def-cram-function draw-simple-shape (vertices)
  (perform (a motion (type setting-pen) (r 150) (off 0)))
  (dolist (?v vertices)
    (perform (a motion (type going-to) (goal ?v))))
  (par
    (perform (a motion (type setting-pen) (off 1)))
    (sleep 0.1))
  (length vertices))

(defun draw (&optional (edges 4))
  (init-turtle)
  (with-process-modules-running (turtle-navigation turtle-pen)
    (top-level
      (pursue
        (let ((?edges edges))
          (perform (an action (type drawing) (shape polygon) (radius 2) (edges ?edges))))
        (simulate)))))

(def-top-level-cram-function go-out ()
  (pursue
    (simulate)
    (navigate-without-going-out (make-3d-vector 20 1 0))))

(def-top-level-cram-function race (seconds)
  "Drive about until the color sensor sees something or the time is over."
  (let ((counter 0))
    (with-tags
      (pursue
        (:tag sensing
          (wait-for (fl-and (> *color-sensor* 3) (not (eq *color-sensor* 5))))
          :seen)
        (:tag driving
          (whenever ((pulsed *turtle-pose*))
            (incf counter)
            (when (= counter 3)
              (setf (value *color-sensor*) 5))
            (when (= counter 5)
              (setf (value *color-sensor*) 7))))
        (simulate)
        (seq (sleep seconds) :late)))))

(declare-goal visit (place))

(def-goal (visit (:corner ?x ?y))
  (move-to (make-3d-vector ?x ?y 0))
  (succeed :there ?x))

(def-goal (visit nowhere)
  :nowhere)

(def-top-level-cram-function visit-corner ()
  (pursue
    (simulate)
    (try-in-order
      (fail "no ~a" :way)
      (visit '(:corner 3 3)))))
