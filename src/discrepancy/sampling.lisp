;;;; Samples: continuous initial states that map to a trace's discrete one.
;;;;
;;;; The INITIAL-PARAMETERS of a trace are the coordinates of the bodies whose placements hold in
;;;; its initial state, each with the bounds of its region or its own range.  Sample i draws each
;;;; parameter uniformly: a pure function of seed, trace content and i.  The FINAL-PARAMETERS are
;;;; the coordinates that the regions of the trace's final state bound: the confidence rule predicts
;;;; them.  The tolerances of the scene that the user has not set are initial parameters, too: they
;;;; are drawn with each sample and belong to it.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (parameter (:constructor make-parameter (body axis min max &optional meaning))
                      (:copier nil))
  "The coordinate AXIS of BODY between MIN and MAX (m, rad); or, where BODY is NIL, the tolerance
AXIS of the scene, with the MEANING that the scene tells."
  (body nil :type (or null keyword) :read-only t)
  (axis nil :type keyword :read-only t)
  (min 0d0 :type double-float :read-only t)
  (max 0d0 :type double-float :read-only t)
  (meaning nil :type (or null string) :read-only t))

(setf (documentation 'parameter-body 'function)
      "Return the name (a keyword) of the body whose coordinate a parameter is, or NIL."
      (documentation 'parameter-axis 'function)
      "Return the coordinate (:x, :y, :z, :yaw), or the tolerance's name, that a parameter is."
      (documentation 'parameter-min 'function)
      "Return the least value of a parameter (m, rad, or the unit of the tolerance)."
      (documentation 'parameter-max 'function)
      "Return the bound (m, rad) that the values of a parameter do not reach.")

(defun tolerance-p (parameter)
  "Return true if PARAMETER is a tolerance of the scene, and no coordinate of a body."
  (null (parameter-body parameter)))

(defun parameter-name (parameter)
  "Return the name of PARAMETER, such as \"box.x\", or \"grip-force\" for a tolerance."
  (format nil "~@[~a.~]~(~a~)"
          (and (parameter-body parameter) (ec:name-text (parameter-body parameter)))
          (parameter-axis parameter)))

(defmethod print-object ((parameter parameter) stream)
  (print-unreadable-object (parameter stream :type t)
    (format stream "~a in [~a, ~a[" (parameter-name parameter) (parameter-min parameter)
            (parameter-max parameter))))

(defstruct (sample (:constructor make-sample (index parameters values)) (:copier nil))
  "A continuous initial state: VALUES (a vector of double floats) of PARAMETERS (a list)."
  (index 0 :type (integer 0) :read-only t)
  (parameters '() :type list :read-only t)
  (values #() :type vector :read-only t))

(setf (documentation 'sample-index 'function)
      "Return the number of a sample, counted from 0."
      (documentation 'sample-values 'function)
      "Return the vector of the values of a sample (m, rad), in the order of its parameters.")

(defun value-text (parameter value)
  "Return the text of VALUE of PARAMETER, with its name and its unit."
  (format nil "~a = ~,4f~:[ ~:[m~;rad~]~;~*~]" (parameter-name parameter) value
          (tolerance-p parameter) (eq (parameter-axis parameter) :yaw)))

(defun sample-text (sample)
  "Return the values of SAMPLE with names and units."
  (format nil "~{~a~^, ~}"
          (loop for parameter in (sample-parameters sample)
                for value across (sample-values sample)
                collect (value-text parameter value))))

(defmethod print-object ((sample sample) stream)
  (print-unreadable-object (sample stream :type t)
    (format stream "~d: ~a" (sample-index sample) (sample-text sample))))

(defun placements (domain)
  (remove-if-not #'placement-p (domain-observers domain)))

(defun placement-region (placement state)
  "Return the region that PLACEMENT's fluent names in STATE, a state of the theory, or NIL."
  (find-if (lambda (region)
             (ec:fluent-value state (list (placement-fluent placement) (region-name region))))
           (placement-regions placement)))

(defun tolerance-parameters (scene)
  "Return the list of the PARAMETERs that the tolerances of SCENE are; those that the user has set
are none."
  (loop for (name low high meaning) in (projection:scene-open-tolerances scene)
        collect (make-parameter nil name low high meaning)))

(defun initial-parameters (domain trace)
  "Return the list of the PARAMETERs of DOMAIN that are sampled for TRACE: coordinates of bodies,
then tolerances.  Signals SAMPLING-ERROR if the initial state of TRACE says of a body that it is
nowhere, or that an item is held."
  (let ((state (symbolic:trace-initial-state trace)))
    (dolist (observer (domain-observers domain))
      (when (and (attachment-p observer) (ec:fluent-value state (attachment-atom observer)))
        (error 'sampling-error :trace trace
                               :reason (format nil "~a holds initially, and an item in the gripper ~
                                                    is not sampled"
                                               (ec:atom-text (attachment-atom observer))))))
    (append
     (loop for placement in (placements domain)
           for region = (or (placement-region placement state)
                            (error 'sampling-error
                                   :trace trace
                                   :reason (format nil "no ~a holds initially"
                                                   (ec:name-text (placement-fluent placement)))))
           append (loop for (axis min max) in (placement-coordinates placement)
                        for (nil region-min region-max) = (assoc axis (region-bounds region))
                        collect (make-parameter (placement-body placement) axis
                                                (or min region-min) (or max region-max))))
     (tolerance-parameters (domain-scene domain)))))

(defun final-parameters (domain trace)
  "Return the list of the PARAMETERs of DOMAIN whose final values the theory bounds in TRACE."
  (loop for placement in (placements domain)
        for region = (placement-region placement (symbolic:trace-final-state trace))
        append (and region
                    (loop for (axis min max) in (region-bounds region)
                          collect (make-parameter (placement-body placement) axis min max)))))

(defun draw-sample (parameters seed content index)
  "Return the SAMPLE number INDEX of PARAMETERS: each is uniform between its bounds, a pure function
of SEED, CONTENT (the hash of the trace) and INDEX."
  (make-sample index parameters
               (coerce (loop for parameter in parameters
                             for draw from 0
                             collect (+ (parameter-min parameter)
                                        (* (unit-float seed content index draw)
                                           (- (parameter-max parameter)
                                              (parameter-min parameter)))))
                       '(simple-array double-float (*)))))

(defun pose-with (pose axis value)
  "Return the upright POSE with the coordinate AXIS changed to VALUE."
  (flet ((part (key) (if (eq key axis) value (coordinate pose key))))
    (make-pose (part :x) (part :y) (part :z) :yaw (part :yaw))))

(defun sample-poses (domain sample)
  "Return the property list of the poses that the bodies of DOMAIN's scene have in SAMPLE."
  (let ((poses '()))
    (loop for parameter in (sample-parameters sample)
          for value across (sample-values sample)
          for body = (parameter-body parameter)
          unless (tolerance-p parameter)
            do (setf (getf poses body)
                     (pose-with (or (getf poses body)
                                    (projection:scene-body-pose (domain-scene domain) body))
                                (parameter-axis parameter) value)))
    poses))

(defun sample-tolerances (sample)
  "Return the property list of the values of tolerances that SAMPLE holds, by their names."
  (loop for parameter in (sample-parameters sample)
        for value across (sample-values sample)
        when (tolerance-p parameter)
          append (list (parameter-axis parameter) value)))
