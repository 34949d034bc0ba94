(defpackage #:discrepancy-finder.bullet
  (:documentation "Rigid-body worlds of the Bullet physics library: worlds, bodies, attachments and
queries.  SI units and double floats everywhere; poses are those of DISCREPANCY-FINDER.GEOMETRY.
Whatever is wrong with a call is signaled as BULLET-ERROR before Bullet sees it.  All functions may
be called with SBCL's float traps on.  A world is for one thread at a time; equal calls in equal
order give equal bits, in any thread or process, and queries change no later bit.")
  (:use #:cl)
  (:local-nicknames (#:foreign #:discrepancy-finder.foreign)
                    (#:geometry #:discrepancy-finder.geometry))
  (:export
   ;; conditions
   #:bullet-error #:bullet-error-operation #:bullet-error-reason
   ;; worlds
   #:world #:make-world #:close-world #:with-world #:step-world
   #:world-time #:world-time-step #:world-bodies #:find-body
   ;; bodies
   #:body #:add-body #:body-world #:body-name #:body-shape #:body-kind #:body-mass
   #:body-pose #:body-velocity #:move-body #:place-body
   #:wake #:allow-sleep #:asleep-p #:ignore-collision
   ;; shapes
   #:convex-hull #:shape-volume #:shape-inertia #:mass-properties #:principal-axes
   ;; attachments
   #:attachment #:attach #:detach #:attachments #:attachment-parent #:attachment-child
   #:attachment-live-p #:attachment-load #:attachment-lost-p #:attachment-utilization
   ;; states of whole worlds
   #:make-state-vector #:read-state #:state-hash #:at-rest-p
   ;; queries
   #:penetration #:deepest-penetration
   ;; joints
   #:joint #:add-joint #:remove-joint #:joint-world #:joint-name #:joint-type #:joint-parent
   #:joint-child #:joint-lower #:joint-upper #:joint-live-p #:world-joints #:find-joint
   #:joint-position #:set-joint-position #:set-motor #:joint-load
   ;; contacts and sweeps
   #:pair-distance #:touching-p #:contacts #:clearance #:sweep
   ;; checkpoints
   #:checkpoint #:checkpoint-p #:make-checkpoint #:restore-checkpoint
   ;; mechanisms
   #:link-spec #:link-spec-name #:link-spec-parent #:link-spec-type #:link-spec-origin
   #:link-spec-axis #:link-spec-lower #:link-spec-upper #:link-spec-mimic #:link-spec-body
   #:mechanism #:make-mechanism #:mechanism-world #:mechanism-links #:link-index
   #:make-positions #:pose-mechanism #:mechanism-posture #:link-pose #:forward-kinematics
   #:inverse-kinematics #:run-motion #:mechanism-clearance #:path-contact
   ;; rays
   #:cast-ray #:cast-rays))
