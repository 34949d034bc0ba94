;;;; What can be wrong with a scene and the models in it.

(in-package #:discrepancy-finder.projection)

(define-condition projection-error (error)
  ()
  (:documentation "Root of the errors about scenes and projections."))

(define-condition scene-error (projection-error)
  ((file :initarg :file :reader scene-error-file :documentation "The scene's file.")
   (line :initarg :line :initform nil :reader scene-error-line
         :documentation "The line, or NIL.")
   (reason :initarg :reason :reader scene-error-reason
           :documentation "What is wrong, as a string without a full stop."))
  (:report (lambda (condition stream)
             (format stream "~a~@[:~d~]: ~a." (scene-error-file condition)
                     (scene-error-line condition) (scene-error-reason condition))))
  (:documentation "Signaled when a scene file is not well-formed."))

(define-condition urdf-error (projection-error)
  ((file :initarg :file :reader urdf-error-file :documentation "The URDF file.")
   (line :initarg :line :initform nil :reader urdf-error-line
         :documentation "The line, or NIL.")
   (element :initarg :element :initform nil :reader urdf-error-element
            :documentation "The element to blame, as a string such as \"link base_link\", or NIL.")
   (reason :initarg :reason :reader urdf-error-reason
           :documentation "What is wrong, as a string without a full stop."))
  (:report (lambda (condition stream)
             (format stream "~a~@[:~d~]: ~@[~a: ~]~a." (urdf-error-file condition)
                     (urdf-error-line condition) (urdf-error-element condition)
                     (urdf-error-reason condition))))
  (:documentation "Signaled when a URDF file cannot be read or holds what is not supported."))

(define-condition unknown-parameter (projection-error)
  ((name :initarg :name :reader unknown-parameter-name :documentation "The name in question.")
   (scene :initarg :scene :reader unknown-parameter-scene :documentation "The scene.")
   (known :initarg :known :reader unknown-parameter-known
          :documentation "The names of the scene's parameters."))
  (:report (lambda (condition stream)
             (with-slots (name scene known) condition
               (format stream "The scene ~(~a~) has no parameter ~(~a~); it has ~{~(~a~)~^, ~}."
                       scene name known))))
  (:documentation "Signaled when a parameter is named that a scene does not have."))

(define-condition impossible-parameter (projection-error)
  ((name :initarg :name :reader impossible-parameter-name :documentation "The parameter's name.")
   (value :initarg :value :reader impossible-parameter-value :documentation "What was given.")
   (positive :initarg :positive :initform t :reader impossible-parameter-positive
             :documentation "False if values below 0 are possible.")
   (limit :initarg :limit :initform nil :reader impossible-parameter-limit
          :documentation "The largest possible value, or NIL if there is none.")
   (range :initarg :range :initform nil :reader impossible-parameter-range
          :documentation "The bounds of the tolerance as a list, or NIL if it is no tolerance."))
  (:report (lambda (condition stream)
             (let ((*read-default-float-format* 'double-float))
               (with-slots (name value positive limit range) condition
                 (format stream "The scene parameter ~(~a~) is ~(~s~) where ~:[a~:[~; positive~] ~
                                 number~@[ of at most ~,4f~]~;a number from ~a to ~a~] was ~
                                 expected."
                         name value range
                         (if range (first range) positive)
                         (if range (second range) limit))))))
  (:documentation "Signaled when a scene parameter is given a value that is no positive number,
beyond the limit of what it means, or outside of its tolerance."))

(defmethod source:self-explaining-p ((condition scene-error)) t)
(defmethod source:self-explaining-p ((condition urdf-error)) t)

(define-condition unknown-body (projection-error)
  ((name :initarg :name :reader unknown-body-name :documentation "The name in question.")
   (scene :initarg :scene :reader unknown-body-scene :documentation "The scene."))
  (:report (lambda (condition stream)
             (format stream "The scene ~(~a~) has no robot and no item ~(~a~)."
                     (unknown-body-scene condition) (unknown-body-name condition))))
  (:documentation "Signaled when a body is named that a scene does not have."))

(define-condition impossible-joint-position (projection-error)
  ((name :initarg :name :reader impossible-joint-position-name :documentation "The joint.")
   (value :initarg :value :reader impossible-joint-position-value
          :documentation "What was given.")
   (lower :initarg :lower :reader impossible-joint-position-lower
          :documentation "The lowest position (m or rad), or NIL.")
   (upper :initarg :upper :reader impossible-joint-position-upper
          :documentation "The highest position (m or rad), or NIL."))
  (:report (lambda (condition stream)
             (with-slots (name value lower upper) condition
               (let ((*read-default-float-format* 'double-float))
                 (format stream "The joint ~a cannot be at ~a; it goes~@[ from ~a~]~@[ to ~a~]."
                         name value lower upper)))))
  (:documentation "Signaled when a joint is given an initial position beyond its limits."))

(define-condition missing-robot-part (projection-error)
  ((part :initarg :part :reader missing-robot-part-part
         :documentation "The part in question, :HEAD, :CAMERA or :TORSO.")
   (scene :initarg :scene :reader missing-robot-part-scene :documentation "The scene."))
  (:report (lambda (condition stream)
             (with-slots (part scene) condition
               (format stream "The scene ~(~a~) has no robot with a ~(~a~); one is named in the ~
                               robot's entry by ~a."
                       scene part
                       (ecase part
                         (:head "(:head pan-joint tilt-joint)")
                         (:camera "(:camera link)")
                         (:torso "(:torso joint)"))))))
  (:documentation "Signaled when a robot is to do what it has no part for."))

(define-condition picture-error (projection-error)
  ((reason :initarg :reason :reader picture-error-reason
           :documentation "What is wrong, as a string without a full stop."))
  (:report (lambda (condition stream)
             (format stream "~a." (picture-error-reason condition))))
  (:documentation "Signaled when a picture cannot be drawn as asked for, or not be written."))

(define-condition unknown-joint (projection-error)
  ((name :initarg :name :reader unknown-joint-name :documentation "The name in question.")
   (scene :initarg :scene :reader unknown-joint-scene :documentation "The scene."))
  (:report (lambda (condition stream)
             (format stream "The scene ~(~a~) has no movable joint ~a."
                     (unknown-joint-scene condition) (unknown-joint-name condition))))
  (:documentation "Signaled when a joint is named that neither the robot nor a fixture has."))
