;;;; Samples: continuous initial states that map to a trace's discrete one.
;;;;
;;;; The INITIAL-PARAMETERS of a trace are the coordinates of the bodies whose placements hold in
;;;; its initial state, each with the bounds of its region or its own range.  Sample i draws each
;;;; parameter uniformly: a pure function of seed, trace content and i.  The FINAL-PARAMETERS are
;;;; the coordinates that the regions of the trace's final state bound: the confidence rule predicts
;;;; them.  The tolerances of the scene that the user has not set are initial parameters, too: they
;;;; are drawn with each sample and belong to it.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (parameter (:constructor make-parameter (body axis min max &optional meaning region))
                      (:copier nil))
  "The coordinate AXIS of BODY between MIN and MAX (m, rad), in REGION if that is no box; or, where
BODY is a string, the :POSITION of the joint of this name; or, where BODY is NIL, the tolerance AXIS
of the scene, with the MEANING that the scene tells."
  (body nil :type (or null keyword string) :read-only t)
  (axis nil :type keyword :read-only t)
  (min 0d0 :type double-float :read-only t)
  (max 0d0 :type double-float :read-only t)
  (meaning nil :type (or null string) :read-only t)
  (region nil :type (or null region) :read-only t))

(setf (documentation 'parameter-body 'function)
      "Return the body of a parameter (a keyword), the name of its joint (a string), or NIL if it is
a tolerance."
      (documentation 'parameter-axis 'function)
      "Return the axis of a parameter, :POSITION of a joint, or the name of a tolerance."
      (documentation 'parameter-min 'function)
      "Return the least value of a parameter (m, rad, or the unit of the tolerance)."
      (documentation 'parameter-max 'function)
      "Return the bound (m, rad) that the values of a parameter do not reach.")

(defun fixed-p (parameter)
  "Return true if PARAMETER has one possible value, and is not sampled."
  (= (parameter-min parameter) (parameter-max parameter)))

(defun tolerance-p (parameter)
  "Return true if PARAMETER is a tolerance of the scene, and no coordinate of a body."
  (null (parameter-body parameter)))

(defun parameter-name (parameter)
  "Return the name of PARAMETER, such as \"box.x\", \"drawer_1_joint\" or \"grip-force\"."
  (let ((body (parameter-body parameter)))
    (if (stringp body)
        body
        (format nil "~@[~a.~]~(~a~)" (and body (ec:name-text body))
                (parameter-axis parameter)))))

(defmethod print-object ((parameter parameter) stream)
  (print-unreadable-object (parameter stream :type t)
    (format stream "~a in [~a, ~a[" (parameter-name parameter) (parameter-min parameter)
            (parameter-max parameter))))

(defstruct (sample (:constructor make-sample (index parameters values)) (:copier nil))
  "A continuous initial state: VALUES (a vector of double floats) of PARAMETERS (a list).  INDEX is
NIL if it was not drawn."
  (index 0 :type (or null (integer 0)) :read-only t)
  (parameters '() :type list :read-only t)
  (values #() :type vector :read-only t))

(setf (documentation 'sample-index 'function)
      "Return the number of a sample, counted from 0, or NIL if it was not drawn."
      (documentation 'sample-parameters 'function)
      "Return the list of the PARAMETERs of a sample."
      (documentation 'sample-values 'function)
      "Return the vector of the values of a sample (m, rad), in the order of its parameters.")

(defun value-text (parameter value)
  "Return the text of VALUE of PARAMETER, with its name and its unit."
  (format nil "~a = ~,4f~a" (parameter-name parameter) value
          (case (parameter-axis parameter)
            ((:x :y :z) " m")
            (:yaw " rad")
            (t ""))))

(defun sample-text (sample)
  "Return the values of SAMPLE that were drawn, with names and units."
  (format nil "~{~a~^, ~}"
          (loop for parameter in (sample-parameters sample)
                for value across (sample-values sample)
                unless (fixed-p parameter)
                  collect (value-text parameter value))))

(defun drawn-values (sample)
  "Return the vector of the values of SAMPLE that were drawn."
  (coerce (loop for parameter in (sample-parameters sample)
                for value across (sample-values sample)
                unless (fixed-p parameter)
                  collect value)
          '(simple-array double-float (*))))

(defmethod print-object ((sample sample) stream)
  (print-unreadable-object (sample stream :type t)
    (format stream "~@[~d: ~]~a" (sample-index sample) (sample-text sample))))

(defun placements (domain)
  (remove-if-not #'placement-p (domain-observers domain)))

(defun placement-regions-in (placement state)
  "Return the list of the regions that PLACEMENT's fluent names in STATE, a state of the theory."
  (remove-if-not (lambda (region) (ec:fluent-value state (placement-atom placement region)))
                 (placement-regions placement)))

(defun placement-region (placement state)
  "Return the first region that PLACEMENT's fluent names in STATE, or NIL."
  (first (placement-regions-in placement state)))

(defun tolerance-parameters (scene)
  "Return the list of the PARAMETERs that the tolerances of SCENE are; those that the user has set
are none."
  (loop for (name low high meaning) in (projection:scene-open-tolerances scene)
        collect (make-parameter nil name low high meaning)))

(defun check-hands-empty (domain trace)
  "Signal SAMPLING-ERROR if an item is held in the initial state of TRACE."
  (dolist (observer (domain-observers domain))
    (when (and (attachment-p observer)
               (ec:fluent-value (symbolic:trace-initial-state trace)
                                (attachment-atom observer)))
      (error 'sampling-error :trace trace
                             :reason (format nil "~a holds initially, and an item in the gripper ~
                                                  is not sampled"
                                             (ec:atom-text (attachment-atom observer)))))))

(defun coordinate-range (coordinate region)
  "Return the bounds of COORDINATE, one of the coordinates of a placement, in REGION."
  (destructuring-bind (axis min max) coordinate
    (let ((bounds (rest (assoc axis (region-bounds region)))))
      (cond ((null min) bounds)
            ((eq min :middle)
             (let ((middle (/ (reduce #'+ bounds) 2)))
               (list (- middle (/ max 2)) (+ middle (/ max 2)))))
            (t (list min max))))))

(defun placement-parameters (placement region)
  "Return the PARAMETERs of the body of PLACEMENT in REGION."
  (loop for coordinate in (placement-coordinates placement)
        for (min max) = (coordinate-range coordinate region)
        collect (make-parameter (placement-body placement) (first coordinate) min max nil
                                (and (not (region-box-p region)) region))))

(defun body-parameters (domain trace body)
  "Return the PARAMETERs of BODY, of which one placement must hold in the initial state of TRACE."
  (let* ((placements (remove body (placements domain) :key #'placement-body :test-not #'eq))
         (held (loop for placement in placements
                     append (loop for region in (placement-regions-in
                                                 placement (symbolic:trace-initial-state trace))
                                  collect (cons placement region)))))
    (cond ((null held)
           (error 'sampling-error
                  :trace trace
                  :reason (format nil "no ~{~a~^ and no ~} holds initially"
                                  (mapcar (lambda (placement)
                                            (ec:formula-text (placement-pattern placement)))
                                          placements))))
          ((rest held)
           (error 'sampling-error
                  :trace trace
                  :reason (format nil "~a would be in two regions, ~a and ~a" (ec:name-text body)
                                  (ec:name-text (region-name (cdr (first held))))
                                  (ec:name-text (region-name (cdr (second held)))))))
          (t (placement-parameters (car (first held)) (cdr (first held)))))))

(defun joint-parameter (scene joint min max)
  "Return the PARAMETER of JOINT of SCENE, a name, between MIN and MAX as far as it goes: a range
may go beyond its limits, for what is observed there."
  (multiple-value-bind (lower upper) (projection:scene-joint-limits scene joint)
    (flet ((within-limits (value)
             (max (or lower value) (min (or upper value) value))))
      (make-parameter joint :position (within-limits min) (within-limits max)))))

(defun joint-parameters (domain trace)
  "Return the PARAMETERs of the joints that DOMAIN observes, by the initial state of TRACE."
  (let ((ranges (remove-if-not #'joint-range-p (domain-observers domain)))
        (state (symbolic:trace-initial-state trace)))
    (loop for joint in (remove-duplicates (mapcar #'joint-range-joint ranges)
                                          :test #'string= :from-end t)
          for ours = (remove joint ranges :key #'joint-range-joint :test-not #'string=)
          for held = (find-if (lambda (range) (ec:fluent-value state (joint-range-atom range)))
                              ours)
          for (min max) = (if held
                              (list (joint-range-min held) (joint-range-max held))
                              (some #'joint-range-otherwise ours))
          when min collect (joint-parameter (domain-scene domain) joint min max))))

(defun initial-parameters (domain trace)
  "Return the list of the PARAMETERs of DOMAIN that are sampled for TRACE: coordinates of bodies,
positions of joints, tolerances.  Signals SAMPLING-ERROR if the initial state of TRACE says of a
body that it is nowhere or in two places, or that an item is held."
  (check-hands-empty domain trace)
  (append (loop for body in (remove-duplicates (mapcar #'placement-body (placements domain))
                                               :from-end t)
                append (body-parameters domain trace body))
          (joint-parameters domain trace)
          (tolerance-parameters (domain-scene domain))))

(defun final-regions (domain trace)
  "Return the list of (placement . region) of the regions in which bodies are finally in TRACE."
  (loop for placement in (placements domain)
        for region = (placement-region placement (symbolic:trace-final-state trace))
        when region collect (cons placement region)))

(defun final-parameters (domain trace)
  "Return the list of the PARAMETERs of DOMAIN whose final values the theory bounds in TRACE."
  (loop for (placement . region) in (final-regions domain trace)
        append (loop for (axis min max) in (region-bounds region)
                     collect (make-parameter (placement-body placement) axis min max nil
                                             (and (not (region-box-p region)) region)))))

(defun resting-bodies (domain trace)
  "Return the list of the bodies that, by the theory, are in one and the same region all along
TRACE, by each of their placements."
  (let ((states (symbolic:trace-states trace)))
    (flet ((resting-p (body)
             (loop for (placement . region) in (final-regions domain trace)
                   for atom = (placement-atom placement region)
                   always (or (not (eq (placement-body placement) body))
                              (every (lambda (state) (ec:fluent-value state atom)) states)))))
      (remove-if-not #'resting-p
                     (remove-duplicates (mapcar (lambda (entry) (placement-body (car entry)))
                                                (final-regions domain trace)))))))

(defparameter *settling-tolerance* 1d-3
  "How far (m, rad) a body that rests may move when the world settles.")

(defun final-bounds (parameters resting)
  "Return the vector of the bounds (MIN . MAX) of the final PARAMETERS.  A body that is RESTING may
be drawn anywhere in its region, and settles: its bounds are as much wider."
  (map 'vector (lambda (parameter)
                 (let ((margin (if (member (parameter-body parameter) resting)
                                   *settling-tolerance*
                                   0d0)))
                   (cons (- (parameter-min parameter) margin)
                         (+ (parameter-max parameter) margin))))
       parameters))

(defun inside-final-regions-p (parameters intervals &optional resting)
  "Return true if it is certain that the INTERVALS (LOWER . UPPER) of PARAMETERS lie in the regions
of their bodies that are no boxes, those of RESTING bodies, from which samples are drawn, apart;
also if a rule predicts nothing, and INTERVALS is empty."
  (or (null intervals)
      (loop for (body . region) in (remove-duplicates
                                    (loop for parameter in parameters
                                          when (and (parameter-region parameter)
                                                    (not (member (parameter-body parameter)
                                                                 resting)))
                                            collect (cons (parameter-body parameter)
                                                          (parameter-region parameter)))
                                    :test #'equal)
            always (box-inside-p (loop for parameter in parameters
                                       for (low . high) in intervals
                                       when (eq (parameter-body parameter) body)
                                         collect (list (parameter-axis parameter) low high))
                                 (region-description region)))))

;;; Drawing

(defconstant +attempts+ 10000
  "A body is tried in so many places of the box around its region before it counts as nowhere.")

(defun below-bound (value min max)
  "Return VALUE, a number from MIN to MAX, or, since the upper bound belongs to the next region, one
just below MAX for that; MIN if the two are equal."
  (if (< value max)
      value
      (- max (* (- max min) (scale-float 1d0 -50)))))

(defun values-at (parameters units)
  "Return the values of PARAMETERS at UNITS, a list of numbers from 0 to 1."
  (loop for parameter in parameters
        for unit in units
        for min = (parameter-min parameter) and max = (parameter-max parameter)
        collect (below-bound (+ min (* unit (- max min))) min max)))

(defun redrawn-values (parameters seed content index attempt)
  "Return the values of PARAMETERS at a later ATTEMPT to draw sample INDEX."
  (values-at parameters (loop for nil in parameters
                              for draw from (* attempt 4096)
                              collect (unit-float seed content index draw))))

(defun place-of (parameters values body)
  "Return the pose with the coordinates of BODY that are among the VALUES of PARAMETERS."
  (flet ((value (axis)
           (loop for parameter in parameters
                 for value in values
                 when (and (eq (parameter-body parameter) body)
                           (eq (parameter-axis parameter) axis))
                   return value)))
    (make-pose (or (value :x) 0d0) (or (value :y) 0d0) (or (value :z) 0d0)
               :yaw (or (value :yaw) 0d0))))

(defun draw-sample (parameters seed content index &key (sampler :independent))
  "Return the SAMPLE number INDEX of PARAMETERS, by SAMPLER (samplers.lisp): each is uniform between
its bounds, those of a body in a region that is no box uniform in it, by rejection; a pure function
of SEED, CONTENT (the hash of the trace) and INDEX.  Signals SAMPLING-ERROR if a region seems to be
empty."
  (let ((values (values-at parameters
                           (unit-point sampler seed content index (length parameters)))))
    (loop for body in (remove-duplicates (loop for parameter in parameters
                                               when (parameter-region parameter)
                                                 collect (parameter-body parameter)))
          for region = (some (lambda (parameter)
                               (and (eq (parameter-body parameter) body)
                                    (parameter-region parameter)))
                             parameters)
          do (loop for attempt from 1
                   until (inside-region-p (place-of parameters values body) region)
                   do (when (> attempt +attempts+)
                        (error 'sampling-error
                               :trace nil
                               :reason (format nil "no place in region ~a was found in ~d attempts"
                                               (ec:name-text (region-name region)) +attempts+)))
                      (setf values
                            (mapcar (lambda (parameter old new)
                                      (if (eq (parameter-body parameter) body) new old))
                                    parameters values
                                    (redrawn-values parameters seed content index attempt)))))
    (make-sample index parameters (coerce values '(simple-array double-float (*))))))

(defun pose-with (pose axis value)
  "Return the upright POSE with the coordinate AXIS changed to VALUE."
  (flet ((part (key) (if (eq key axis) value (coordinate pose key))))
    (make-pose (part :x) (part :y) (part :z) :yaw (part :yaw))))

(defun sample-poses (scene sample)
  "Return the property list of the poses that the bodies of SCENE have in SAMPLE."
  (let ((poses '()))
    (loop for parameter in (sample-parameters sample)
          for value across (sample-values sample)
          for body = (parameter-body parameter)
          when (keywordp body)
            do (setf (getf poses body)
                     (pose-with (or (getf poses body)
                                    (projection:scene-body-pose scene body))
                                (parameter-axis parameter) value)))
    poses))

(defun sample-tolerances (sample)
  "Return the property list of the values of tolerances that SAMPLE holds, by their names."
  (loop for parameter in (sample-parameters sample)
        for value across (sample-values sample)
        when (tolerance-p parameter)
          append (list (parameter-axis parameter) value)))

(defun sample-joints (sample)
  "Return the positions of joints that SAMPLE holds: an association list by their names."
  (loop for parameter in (sample-parameters sample)
        for value across (sample-values sample)
        when (stringp (parameter-body parameter))
          collect (cons (parameter-body parameter) value)))
