(in-package :ts-plans)

;;; The robot's drivers, all of which pretend.

(cpm:def-process-module base (motion-designator)
  (destructuring-bind (command argument &rest more) (desig:reference motion-designator)
    (declare (ignore more))
    (roslisp:ros-debug (ts-plans base) "~a ~a" command argument)
    (ecase command
      (cram-common-designators:move-base
       (unless (< (abs (cl-transforms:x (cl-transforms:origin argument))) 10.0)
         (cpl:fail 'common-fail:navigation-pose-unreachable
                   :pose-stamped argument
                   :description (format nil "too far: ~a" argument)))
       (cpl:sleep* 1.5)
       (setf *base-pose* argument)))))

(cpm:def-process-module head (motion-designator)
  (let ((reference (desig:reference motion-designator)))
    (case (car reference)
      (cram-common-designators:move-head
       (destructuring-bind (goal-type goal) (rest reference)
         (when (eql goal-type :frame)
           (cpl:fail 'common-fail:ptu-goal-unreachable :location goal)))))))

(cpm:def-process-module camera (motion-designator)
  (destructuring-bind (command object-designator) (desig:reference motion-designator)
    (declare (type desig:object-designator object-designator))
    (assert (eql command 'cram-common-designators:detect))
    (let* ((type (desig:desig-prop-value object-designator :type))
           (thing (find-if (lambda (candidate)
                             (and (eql (thing-type candidate) type)
                                  (near-p (thing-pose candidate) *base-pose*)))
                           *things*)))
      (when (plusp *blindness*)
        (decf *blindness*)
        (setf thing nil))
      (unless thing
        (cpl:fail 'common-fail:perception-object-not-found
                  :object object-designator
                  :description (format nil "could not see a ~a" type)))
      (desig:equate
       object-designator
       (desig:copy-designator
        object-designator
        :new-description
        `((:name ,(thing-name thing))
          (:pose ((:pose ,(thing-pose thing))
                  (:transform ,(cram-tf:pose-stamped->transform-stamped
                                (thing-pose thing) "object")))))))
      (desig:current-desig object-designator))))

(cpm:def-process-module grippers (motion-designator)
  (destructuring-bind (action-type which-gripper &optional effort)
      (rest (desig:reference motion-designator))
    (when (and (eql action-type :grip) effort (> effort 100))
      (cpl:fail 'common-fail:gripper-goal-not-reached
                :action action-type
                :description (format nil "the gripper ~a is too weak" which-gripper)))))

(cpm:def-process-module arms (motion-designator)
  (destructuring-bind (command left-pose right-pose mode) (desig:reference motion-designator)
    (declare (ignore command mode))
    (dolist (pose (list left-pose right-pose))
      (when pose
        (unless (near-p pose *base-pose*)
          (cpl:fail 'common-fail:manipulation-pose-unreachable
                    :description (format nil "~a cannot be reached" pose)))))))

(def-fact-group ts-process-modules (cpm:matching-process-module cpm:available-process-module)

  (<- (cpm:matching-process-module ?motion-designator base)
    (desig:desig-prop ?motion-designator (:type :going)))

  (<- (cpm:matching-process-module ?motion-designator head)
    (desig:desig-prop ?motion-designator (:type :looking)))

  (<- (cpm:matching-process-module ?motion-designator camera)
    (desig:desig-prop ?motion-designator (:type :detecting)))

  (<- (cpm:matching-process-module ?motion-designator grippers)
    (or (desig:desig-prop ?motion-designator (:type :opening))
        (desig:desig-prop ?motion-designator (:type :closing))
        (desig:desig-prop ?motion-designator (:type :gripping))
        (and (desig:desig-prop ?motion-designator (:type ?type))
             (member ?type (:moving-gripper-joint)))))

  (<- (cpm:matching-process-module ?motion-designator arms)
    (desig:desig-prop ?motion-designator (:type :moving-tcp)))

  (<- (cpm:available-process-module ?pm)
    (member ?pm (base head camera grippers arms))
    (not (cpm:projection-running ?_))))
