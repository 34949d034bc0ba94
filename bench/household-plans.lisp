;;;; Plans and action bindings of the benchmarks of exploration, for the theory HOUSEHOLD-UNKNOWN.

(in-package #:discrepancy-finder-user)

(define-action (motion going) (region)
  (:domain household)
  (:event (navigate region)))

(define-action (motion looking) (spot)
  (:domain household)
  (:event (look spot)))

(define-action (motion detecting) (object)
  (:domain household)
  (:event (detect object))
  (:returns (truth-of (detected object))))

(define-action (action grasping) (object)
  (:domain household)
  (:event (grasp object)))

(define-action (action putting-down) (object)
  (:domain household)
  (:event (put-down object)))

(define-action (action opening) (drawer)
  (:domain household)
  (:event (open-drawer drawer)))

(define-action (action closing) (drawer)
  (:domain household)
  (:event (close-drawer drawer)))

(defun go-to (from to)
  (dolist (?region (discrepancy-finder.bench::route from to))
    (perform (a motion (type going) (region ?region)))))

(def-cram-function seek (?object)
  "Look for the object, which is in no region but the first, and put it down there."
  (let ((at :r0))
    (dolist (entry discrepancy-finder.bench::*spots*)
      (destructuring-bind (?spot here) entry
        (go-to at here)
        (setf at here)
        (unless (eq ?spot here)
          (perform (an action (type opening) (drawer ?spot))))
        (perform (a motion (type looking) (spot ?spot)))
        (when (perform (a motion (type detecting) (object ?object)))
          (perform (an action (type grasping) (object ?object)))
          (go-to at :r0)
          (perform (an action (type putting-down) (object ?object)))
          (return t))
        (unless (eq ?spot here)
          (perform (an action (type closing) (drawer ?spot))))))))

(def-top-level-cram-function tidy-one ()
  (seek :o0))

(def-top-level-cram-function tidy-two ()
  (and (seek :o0) (seek :o1)))

(def-top-level-cram-function tidy-three ()
  (and (seek :o0) (seek :o1) (seek :o2)))

(def-top-level-cram-function branches (?flag-0 ?flag-1 ?flag-2 ?flag-3 ?flag-4 ?flag-5 ?flag-6
                                               ?flag-7 ?flag-8 ?flag-9 ?flag-10 ?flag-11)
  (let ((count 0))
    (when ?flag-0 (incf count))
    (when ?flag-1 (incf count))
    (when ?flag-2 (incf count))
    (when ?flag-3 (incf count))
    (when ?flag-4 (incf count))
    (when ?flag-5 (incf count))
    (when ?flag-6 (incf count))
    (when ?flag-7 (incf count))
    (when ?flag-8 (incf count))
    (when ?flag-9 (incf count))
    (when ?flag-10 (incf count))
    (when ?flag-11 (incf count))
    (perform (a motion (type looking) (spot r0)))
    count))

(def-top-level-cram-function sixty-actions ()
  (dotimes (round 5)
    (dolist (?region '(:r1 :r2 :r3 :r4 :r0))
      (perform (a motion (type going) (region ?region)))
      (perform (a motion (type looking) (spot ?region))))
    (perform (a motion (type looking) (spot r0)))
    (perform (a motion (type looking) (spot r0)))))
