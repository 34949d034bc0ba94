;;;; Benchmark of progression: a plan that searches and tidies, on all initial states at once.
;;;;
;;;; For each object the robot looks at the eleven spots until it detects it, grasps it, carries it
;;;; to the first region and puts it down.  The places of the objects are unknown.  At each event it
;;;; is asked whether the theory can forbid it on this path, at each detection which outcomes are
;;;; possible.  With 1, 2 and 3 objects there are 11, 115 and 1161 paths; in 0, 3 and 54 cases an
;;;; event can be forbidden, since a drawer that an earlier grasp has left open is opened again.
;;;; Entry point: TIDYING-FIGURES.

(in-package #:discrepancy-finder.bench)

(defparameter *regions* '(:r0 :r1 :r2 :r3 :r4 :r5 :r6 :r7))

(defparameter *spots* '((:r0 :r0) (:r1 :r1) (:r2 :r2) (:r3 :r3) (:r4 :r4) (:r5 :r5) (:r6 :r6)
                        (:r7 :r7) (:d0 :r2) (:d1 :r5) (:d2 :r7))
  "The spots to look at, each with the region where that can be done.")

(defun neighbours (region)
  "Return the regions next to REGION: two of the ring, one by the chord between r0 and r4."
  (let ((index (position region *regions*)))
    (loop for number in (sort (append (list (mod (1- index) 8) (mod (1+ index) 8))
                                      (case index (0 (list 4)) (4 (list 0))))
                              #'<)
          collect (nth number *regions*))))

(defun route (from to)
  "Return the regions on a shortest way FROM one TO another, without the first."
  (let ((ways (list (list from))) (seen (list from)))
    (loop
      (let ((way (pop ways)))
        (when (eq (first way) to)
          (return (rest (reverse way))))
        (dolist (next (neighbours (first way)))
          (unless (member next seen)
            (push next seen)
            (setf ways (append ways (list (cons next way))))))))))

(defstruct (tidying (:copier nil))
  "An exploration of the plan: what it needs, and its figures."
  (ground nil :read-only t)
  (solver nil :read-only t)
  (routes (make-hash-table :test 'equal) :read-only t)
  (events (make-hash-table :test 'equal) :read-only t)
  (paths 0 :type fixnum)
  (steps 0 :type fixnum)
  (checks 0 :type fixnum)
  (violations 0 :type fixnum))

(defun possible-in (tidying proposition)
  (and proposition
       (progn (incf (tidying-checks tidying))
              (eq (z3:check (tidying-solver tidying) (list proposition)) :sat))))

(defun after-event (tidying state &rest event)
  "Return the state after EVENT in STATE, once it is asked whether the theory can forbid it."
  (let ((number (or (gethash event (tidying-events tidying))
                    (setf (gethash event (tidying-events tidying))
                          (ec:find-event (tidying-ground tidying) event)))))
    (multiple-value-bind (next conditions) (ec:progress state number)
      (incf (tidying-steps tidying))
      (when conditions
        (let ((allowed (z3:conjunction (mapcar #'cdr conditions))))
          (when (possible-in tidying (z3:negation allowed))
            (incf (tidying-violations tidying)))
          (z3:solver-assert (tidying-solver tidying) allowed)))
      next)))

(defun after-route (tidying state from to)
  (let ((routes (tidying-routes tidying)) (key (cons from to)))
    (dolist (region (or (gethash key routes)
                        (setf (gethash key routes) (route from to)))
                    state)
      (setf state (after-event tidying state :navigate region)))))

(defun branch (tidying proposition function)
  "Call FUNCTION with T and with NIL, each where PROPOSITION can have that value, which is assumed."
  (let ((solver (tidying-solver tidying)))
    (dolist (value '(t nil))
      (let ((assumed (if value proposition (z3:negation proposition))))
        (when (if (z3:term-p assumed) (possible-in tidying assumed) assumed)
          (z3:push-scope solver)
          (z3:solver-assert solver assumed)
          (funcall function value)
          (z3:pop-scope solver))))))

(defun tidy (tidying objects state region)
  "Explore the rest of the plan: OBJECTS are still to be tidied, the robot is in REGION."
  (if objects
      (seek tidying objects *spots* state region)
      (incf (tidying-paths tidying))))

(defun seek (tidying objects spots state region)
  "Look for the first of OBJECTS at SPOTS, in turn."
  (if (null spots)
      (incf (tidying-paths tidying))
      (destructuring-bind ((spot here) . others) spots
        (let ((drawer (not (eq spot here))) (object (first objects)))
          (setf state (after-route tidying state region here))
          (when drawer (setf state (after-event tidying state :open-drawer spot)))
          (setf state (after-event tidying state :look spot)
                state (after-event tidying state :detect object))
          (branch tidying (ec:fluent-value state (list :detected object))
                  (lambda (detected)
                    (cond (detected
                           (tidy tidying (rest objects)
                                 (after-event tidying
                                              (after-route tidying
                                                           (after-event tidying state
                                                                        :grasp object)
                                                           here :r0)
                                              :put-down object)
                                 :r0))
                          (t (seek tidying objects others
                                   (if drawer
                                       (after-event tidying state :close-drawer spot)
                                       state)
                                   here)))))))))

(defun initial-household-state (ground context)
  "Return the state in which only the places of the objects are unknown."
  (ec:concrete-state ground
                     (lambda (atom)
                       (if (eq (first atom) :position)
                           (z3:variable context (ec:atom-text atom))
                           (equal atom '(:robot-in :r0))))
                     :context context))

(defun tidying-figures (objects &key (logic "QF_UF")
                                  (ground (ec:ground (ec:find-theory :household-unknown))))
  "Explore the plan for OBJECTS (1 to 4) objects with a solver for LOGIC.  Return the numbers of
paths, events, checks and violations."
  (z3:with-context (context)
    (z3:with-solver (solver context :logic logic)
      (let ((tidying (make-tidying :ground ground :solver solver))
            (state (initial-household-state ground context)))
        (loop for (nil . proposition) in (ec:initial-conditions state)
              do (z3:solver-assert solver proposition))
        (tidy tidying (subseq '(:o0 :o1 :o2 :o3) 0 objects) state :r0)
        (values (tidying-paths tidying) (tidying-steps tidying) (tidying-checks tidying)
                (tidying-violations tidying))))))

(defun print-progression-benchmarks (stream)
  (let ((ground (ec:ground (ec:find-theory :household-unknown))))
    (loop for objects from 1 to 3
          do (multiple-value-bind (paths steps checks violations)
                 (tidying-figures objects :ground ground)
               (format stream "search and tidy ~d         ~d paths, ~d events, ~d checks, ~d ~
                               violation~:p in ~,1f ms~%"
                       objects paths steps checks violations
                       (median (loop repeat 5
                                     collect (processor-milliseconds
                                              (lambda ()
                                                (tidying-figures objects :ground ground))))))))))
