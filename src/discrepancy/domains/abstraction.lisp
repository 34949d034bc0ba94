;;;; The abstraction m: how continuous states map to discrete ones.
;;;;
;;;; A DOMAIN is an action theory with a scene, regions (regions.lisp) and observers
;;;; (observers.lisp), which connect fluents to the world; DEFINE-ABSTRACTION makes one.
;;;; DISCRETE-STATE is m.

(in-package #:discrepancy-finder.discrepancy)

(defclass domain (symbolic:action-theory)
  ((documentation :initarg :documentation :initform nil :reader domain-documentation)
   (scene :initarg :scene :reader domain-scene :type projection:scene
          :documentation "What the world consists of.")
   (regions :initarg :regions :reader domain-regions :type list
            :documentation "The regions, in order.")
   (observers :initarg :observers :reader domain-observers :type list
              :documentation "Placements, joint and coordinate ranges, attachments, computed
observers.")
   (states :initform (make-hash-table :test #'equal :synchronized t) :reader domain-states
           :documentation "The discrete states that were seen, by the bits of their truth values.")
   (file :initarg :file :initform nil :reader domain-file
         :documentation "The file that defines the domain, as a string, or NIL.")
   (extended-files :initarg :extended-files :initform '() :reader domain-extended-files
                   :documentation "The files of the domains that it extends.")
   (clauses :initarg :clauses :initform '() :reader domain-clauses
            :documentation "The clauses of regions and observers, for domains that extend it."))
  (:documentation "A theory, a scene, the abstraction between them, and action bindings."))

(defmethod symbolic:region-of-pose ((domain domain) pose &optional sort)
  (let ((elements (and sort (ec:sort-elements (symbolic:action-theory-theory domain)
                                              (ec:name-keyword sort)))))
    (loop for region in (domain-regions domain)
          when (and (or (null sort) (member (region-name region) elements))
                    (inside-region-p pose region))
            return (region-name region))))

(defun domain-files (domain)
  "Return the list of the names of the files that DOMAIN, what it extends and its theory were read
from."
  (remove nil (append (list (domain-file domain)) (domain-extended-files domain)
                      (ec:theory-files (symbolic:action-theory-theory domain)))))

(defun changed-domain (domain &key (theory (symbolic:action-theory-theory domain))
                                (scene (domain-scene domain))
                                (observers (domain-observers domain)))
  "Return a domain like DOMAIN with another THEORY, another SCENE and other OBSERVERS."
  (make-instance 'domain
                 :name (symbolic:action-theory-name domain)
                 :theory theory
                 :actions (symbolic:action-theory-actions domain)
                 :documentation (domain-documentation domain)
                 :scene scene :regions (domain-regions domain) :observers observers
                 :file (domain-file domain) :extended-files (domain-extended-files domain)
                 :clauses (domain-clauses domain)))

(defun domain-with-parameters (domain parameters)
  "Return DOMAIN with the scene parameters in PARAMETERS, a property list of names and reals,
changed.  Signals UNKNOWN-PARAMETER and IMPOSSIBLE-PARAMETER."
  (if parameters
      (changed-domain domain
                      :scene (projection:scene-with-parameters (domain-scene domain) parameters))
      domain))

(defun speaks-of-p (observer items)
  "Return true if OBSERVER observes one of ITEMS, a list of names, or asks a function about one."
  (typecase observer
    (placement (member (placement-body observer) items))
    (attachment (member (attachment-item observer) items))
    (coordinate-range (member (coordinate-range-body observer) items))
    (computed (intersection (computed-arguments observer) items))))

(defun domain-without-items (domain items)
  "Return DOMAIN without ITEMS, a list of the names of items of its scene, and without the observers
that speak of them; what the theory says of them is not observed."
  (if items
      (let ((scene (domain-scene domain)))
        (changed-domain domain
                        :scene (projection:scene-with-items
                                scene
                                (set-difference (projection:scene-item-names scene) items))
                        :observers (remove-if (lambda (observer) (speaks-of-p observer items))
                                              (domain-observers domain))))
      domain))

(defun shared-state (domain state)
  "Return a list like STATE that is the same one whenever this state of DOMAIN is seen: a search
keeps thousands of them, of which few differ."
  (let ((bits (map 'simple-bit-vector (lambda (entry) (if (cdr entry) 1 0)) state))
        (states (domain-states domain)))
    (or (gethash bits states)
        (setf (gethash bits states) state))))

(defun discrete-state (domain projection)
  "Return the discrete state of PROJECTION: a list of (atom . truth) for every fluent of DOMAIN that
can be observed."
  (shared-state domain (loop for observer in (domain-observers domain)
                             append (observe observer projection))))

(defun observed-fluents (state)
  "Return the list of the atoms that are true in STATE, a list of (atom . truth)."
  (loop for (atom . truth) in state when truth collect atom))
