;;;; Runs of plans in a scene alone: no theory, no abstraction, nothing to judge.
;;;;
;;;; RUN-IN-SCENE is RUN-PLAN for a scene that belongs to no domain.  What was performed, and where
;;;; everything ended, is all that there is to tell of it.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (scene-run (:copier nil))
  "A concrete execution in a scene.  ENDING is :FINISHED or the class of an unhandled failure;
PERFORMED a list of texts; POSES a list of (name . pose) of robot and items at the end."
  (ending nil :type symbol :read-only t)
  (performed '() :type list :read-only t)
  (tolerances '() :type list :read-only t)
  (poses '() :type list :read-only t)
  (hash 0 :type (unsigned-byte 64) :read-only t)
  (seconds 0d0 :type double-float :read-only t))

(setf (documentation 'scene-run-ending 'function)
      "Return how a run in a scene ended: :FINISHED or the class of an unhandled failure."
      (documentation 'scene-run-hash 'function)
      "Return the hash of the bits of the final state of a run in a scene.")

(defmethod print-object ((run scene-run) stream)
  (print-unreadable-object (run stream :type t)
    (format stream "~(~a~), ~d performed, ~,2f s simulated" (scene-run-ending run)
            (length (scene-run-performed run)) (scene-run-seconds run))))

(defun run-plan-in (projection plan arguments)
  "Run PLAN (a symbol) with ARGUMENTS in PROJECTION; return :FINISHED or the class of the failure."
  (let ((*random-state* (sb-ext:seed-random-state 0))
        (*gensym-counter* 0))
    (plan:with-executive (projection)
      (handler-case (progn (symbolic:call-plan plan plan arguments #'identity)
                           :finished)
        (plan:plan-failure (failure) (type-of failure))))))

(defun final-poses (projection)
  (let ((scene (projection:projection-scene projection)))
    (loop for name in (append (and (projection:scene-robot-name scene)
                                   (list (projection:scene-robot-name scene)))
                              (projection:scene-item-names scene))
          collect (cons name (projection:observed-pose projection name)))))

(defun performed-text (projection designator failure)
  (format nil "~a~%     ~:[success~;~:*~a~] at ~,2f s" designator
          (and failure (source:condition-sentence failure))
          (projection:simulated-seconds projection)))

(defun run-in-scene (plan scene &key state parameters arguments seed (fidelity :fast) observer)
  "Run PLAN (a symbol) concretely in SCENE (a scene or the name of its file) and return a SCENE-RUN.
The other arguments are those of RUN-PLAN.  Signals PLAN-NOT-FOUND, SCENE-ERROR, URDF-ERROR,
UNKNOWN-BODY, UNKNOWN-PARAMETER, INVALID-ARGUMENT."
  (let* ((plan (plan:plan-name (ensure-plan plan)))
         (scene (projection:scene-with-parameters
                 (if (typep scene 'projection:scene)
                     scene
                     (projection:load-scene (or (locate-file scene) scene)))
                 parameters))
         (sample (state-sample scene state seed))
         (performed '()))
    (check-plan-arguments plan arguments)
    (with-open-projection (projection (projection:make-projection
                                       scene :poses (sample-poses scene sample)
                                             :parameters (sample-tolerances sample)
                                             :fidelity fidelity))
      (flet ((observe (projection designator failure)
               (when designator
                 (push (performed-text projection designator failure) performed))
               (when observer
                 (funcall observer projection designator failure))))
        (projection:settle projection)
        (projection:watch-projection projection #'observe)
        (let ((ending (run-plan-in projection plan arguments)))
          (observe projection nil nil)
          (make-scene-run :ending ending :performed (reverse performed)
                          :tolerances (projection-tolerances projection)
                          :poses (final-poses projection)
                          :hash (projection:state-hash projection)
                          :seconds (float (projection:simulated-seconds projection) 1d0)))))))

(defun scene-run-text (run)
  "Return the report of RUN, a SCENE-RUN: a text of several lines."
  (with-output-to-string (stream)
    (loop for text in (scene-run-performed run)
          for number from 1
          do (format stream "  ~d. ~a~%" number text))
    (loop for (name value) on (scene-run-tolerances run) by #'cddr
          for word = "with " then ", "
          do (format stream "~a~a = ~,4f" word (ec:name-text name) value)
          finally (format stream "~@[~%~]" (scene-run-tolerances run)))
    (format stream "finally (~(~a~), ~,2f s simulated, state hash ~a)~%" (scene-run-ending run)
            (scene-run-seconds run) (hash-text (scene-run-hash run)))
    (loop for (name . pose) in (scene-run-poses run)
          do (format stream "  ~(~a~) at ~,4f ~,4f ~,4f, yaw ~,4f~%" name (pose-x pose)
                     (pose-y pose) (pose-z pose) (pose-yaw pose)))))
