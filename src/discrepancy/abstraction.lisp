;;;; The abstraction m: how continuous states map to discrete ones.
;;;;
;;;; A REGION is a box that bounds some of the coordinates x, y, z (m) and yaw (rad), each
;;;; half-open, so that a shared border belongs to one region.  Observers connect fluents to the
;;;; world: a PLACEMENT says that a body's pose lies in a region, an ATTACHMENT that the robot holds
;;;; an item.
;;;; A DOMAIN is an action theory with a scene, regions and observers; DEFINE-ABSTRACTION makes one.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (region (:constructor make-region (name bounds)) (:copier nil))
  "BOUNDS is a list of (axis min max): min belongs to the region, max does not."
  (name nil :type keyword :read-only t)
  (bounds '() :type list :read-only t))

(setf (documentation 'region-name 'function)
      "Return the name of a region, a keyword."
      (documentation 'region-bounds 'function)
      "Return the bounds of a region: a list of (axis min max).")

(defmethod print-object ((region region) stream)
  (print-unreadable-object (region stream :type t)
    (format stream "~a~{ ~(~a~) in [~a, ~a[~}" (ec:name-text (region-name region))
            (reduce #'append (region-bounds region)))))

(defparameter *axes* '((:x . pose-x) (:y . pose-y) (:z . pose-z) (:yaw . pose-yaw))
  "The coordinates that regions may bound, and their readers.")

(defun coordinate (pose axis)
  "Return the coordinate AXIS (:x, :y, :z in m, :yaw in rad) of POSE."
  (funcall (cdr (assoc axis *axes*)) pose))

(defun inside-region-p (pose region)
  "Return true if POSE lies in REGION."
  (loop for (axis min max) in (region-bounds region)
        always (and (<= min (coordinate pose axis)) (< (coordinate pose axis) max))))

(defstruct (placement (:copier nil))
  "The fluent FLUENT (a keyword) of a region holds of the one that the pose of BODY lies in.
COORDINATES is a list of (axis min max), what is sampled; without min and max the region bounds the
axis.  REGIONS are the candidates, one for each element of the fluent's sort."
  (fluent nil :type keyword :read-only t)
  (body nil :type keyword :read-only t)
  (coordinates '() :type list :read-only t)
  (regions '() :type list :read-only t))

(defstruct (attachment (:copier nil))
  "The ground fluent ATOM holds if the robot holds ITEM."
  (atom '() :type list :read-only t)
  (item nil :type keyword :read-only t))

(defclass domain (symbolic:action-theory)
  ((documentation :initarg :documentation :initform nil :reader domain-documentation)
   (scene :initarg :scene :reader domain-scene :type projection:scene
          :documentation "What the world consists of.")
   (regions :initarg :regions :reader domain-regions :type list
            :documentation "The regions, in order.")
   (observers :initarg :observers :reader domain-observers :type list
              :documentation "Placements and attachments.")
   (file :initarg :file :initform nil :reader domain-file
         :documentation "The file that defines the domain, as a string, or NIL."))
  (:documentation "A theory, a scene, the abstraction between them, and action bindings."))

(defmethod symbolic:region-of-pose ((domain domain) pose)
  (let ((region (find-if (lambda (region) (inside-region-p pose region)) (domain-regions domain))))
    (and region (region-name region))))

(defun domain-with-parameters (domain parameters)
  "Return DOMAIN with the scene parameters in PARAMETERS, a property list of names and reals,
changed.  Signals UNKNOWN-PARAMETER and IMPOSSIBLE-PARAMETER."
  (if parameters
      (make-instance 'domain
                     :name (symbolic:action-theory-name domain)
                     :theory (symbolic:action-theory-theory domain)
                     :actions (symbolic:action-theory-actions domain)
                     :documentation (domain-documentation domain)
                     :scene (projection:scene-with-parameters (domain-scene domain) parameters)
                     :regions (domain-regions domain) :observers (domain-observers domain)
                     :file (domain-file domain))
      domain))

;;; m itself

(defgeneric observe (observer projection)
  (:documentation "Return the list of (atom . truth) that OBSERVER sees in PROJECTION.")
  (:method ((placement placement) projection)
    (let ((pose (projection:observed-pose projection (placement-body placement))))
      (loop for region in (placement-regions placement)
            collect (cons (list (placement-fluent placement) (region-name region))
                          (inside-region-p pose region)))))
  (:method ((attachment attachment) projection)
    (list (cons (attachment-atom attachment)
                (eq (projection:held-item projection) (attachment-item attachment))))))

(defun discrete-state (domain projection)
  "Return the discrete state of PROJECTION: a list of (atom . truth) for every fluent of DOMAIN that
can be observed."
  (loop for observer in (domain-observers domain) append (observe observer projection)))

(defun observed-fluents (state)
  "Return the list of the atoms that are true in STATE, a list of (atom . truth)."
  (loop for (atom . truth) in state when truth collect atom))
