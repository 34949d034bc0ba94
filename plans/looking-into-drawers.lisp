;;;; Looking into drawers: a spoon lies in one of three drawers, anywhere in it.  The robot opens
;;;; one drawer after the other, tries to detect the spoon from several poses before it, and takes
;;;; it.

(in-package #:discrepancy-finder-user)

(load-plan (merge-pathnames "kitchen-functions.lisp" *load-truename*))

(defun poses-for-looking (drawer)
  "Return the list of the base poses from which the robot looks into DRAWER: where it opens it, and
nearer at both sides."
  (let ((y (pose-y (inside-drawer drawer))))
    (list (place-before drawer)
          (make-pose -1.2 (+ y 0.2) 0 :yaw pi)
          (make-pose -1.2 (- y 0.15) 0 :yaw pi))))

(def-cram-function try-to-take (drawer type ?pose)
  "Try to detect an object of TYPE in DRAWER, which is open, from ?POSE, and to pick it up.  Return
the object, or NIL."
  (with-failure-handling
      ((perception-object-not-found ()
         (return nil))
       (manipulation-low-level-failure ()
         (park-the-arm :left)
         (return nil)))
    (perform (a motion (type going) (pose ?pose)))
    (grasp-with :left (detect-at (inside-drawer drawer) type))))

(def-cram-function look-into-drawer (drawer type)
  "Open DRAWER and try to take an object of TYPE out of it, from one pose after the other.  Return
the object; or NIL, and the drawer is closed again."
  (lift-torso 0.02)
  (stand-before drawer)
  (open-the-drawer drawer)
  (or (some (lambda (pose) (try-to-take drawer type pose))
            (poses-for-looking drawer))
      (progn (stand-before drawer)
             (close-the-drawer drawer)
             nil)))

(def-top-level-cram-function looking-into-drawers (&optional (type :spoon))
  "Find an object of TYPE in one of the drawers, take it out and return it."
  (or (some (lambda (drawer) (look-into-drawer drawer type))
            '(:drawer-1 :drawer-2 :drawer-3))
      (fail 'object-nowhere-to-be-found :description "no drawer seems to hold it")))
