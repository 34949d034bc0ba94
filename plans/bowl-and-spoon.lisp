;;;; Bowl and spoon: the two are carried to the table, first the spoon, which is in one of three
;;;; drawers, then the bowl, which stands on the workspace.
;;;;
;;;; BOWL-AND-SPOON closes a drawer only as long as the spoon has not been detected, so that the one
;;;; with the spoon stays open.  BOWL-AND-SPOON-CLOSING always closes the drawer again.

(in-package #:discrepancy-finder-user)

(load-plan (merge-pathnames "kitchen-functions.lisp" *load-truename*))

(def-cram-function take-the-spoon (leave-open)
  "Open one drawer after the other until the spoon is detected in it; take it out and return it.
Close each drawer again, but with LEAVE-OPEN not that of the spoon."
  (dolist (drawer '(:drawer-1 :drawer-2 :drawer-3)
                  (fail 'object-nowhere-to-be-found :description "no drawer holds the spoon"))
    (stand-before drawer)
    (lift-torso 0.02)
    (open-the-drawer drawer)
    (let ((spoon (detect-in-drawer drawer :spoon)))
      (when spoon
        (grasp-with :left spoon))
      (unless (and spoon leave-open)
        (close-the-drawer drawer))
      (when spoon
        ;; Closing has lowered the torso.
        (lift-torso 0.25)
        (return spoon)))))

(def-top-level-cram-function bowl-and-spoon ()
  "Carry spoon and bowl to the table; the drawer of the spoon stays open."
  (put-on-the-table (take-the-spoon t))
  (put-on-the-table (take-from-the-workspace :bowl)))

(def-top-level-cram-function bowl-and-spoon-closing ()
  "Carry spoon and bowl to the table; every drawer is closed again."
  (put-on-the-table (take-the-spoon nil))
  (put-on-the-table (take-from-the-workspace :bowl)))
