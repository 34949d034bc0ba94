;;;; Setting the table: bowl, cereal, milk and spoon are carried from the workspace to the table,
;;;; one by one.  The spoon is in one of three drawers, the others stand on the workspace.

(in-package #:discrepancy-finder-user)

(load-plan (merge-pathnames "kitchen-functions.lisp" *load-truename*))

(def-cram-function take-from-a-drawer (type)
  "Open one drawer after the other until an object of TYPE is detected in it; take that out, and
return it.  Close each drawer again."
  (dolist (drawer '(:drawer-1 :drawer-2 :drawer-3)
                  (fail 'object-nowhere-to-be-found :description "no drawer holds it"))
    (stand-before drawer)
    (lift-torso 0.02)
    (open-the-drawer drawer)
    (let ((object (detect-in-drawer drawer type)))
      (when object
        (grasp-with :left object))
      (close-the-drawer drawer)
      (when object
        ;; The torso sank to bring the hand to the handle.
        (lift-torso 0.25)
        (return object)))))

(def-top-level-cram-function setting-the-table (&optional (types '(:bowl :cereal :milk :spoon)))
  "Carry an object of each of TYPES to the table."
  (dolist (type types)
    (put-on-the-table (if (eq type :spoon)
                          (take-from-a-drawer type)
                          (take-from-the-workspace type)))))
