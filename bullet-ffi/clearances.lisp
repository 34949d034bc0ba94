;;;; Clearances of mechanisms: how far one would be from what is around it.
;;;;
;;;; MECHANISM-CLEARANCE looks at one posture, PATH-CONTACT at the straight way of the joints from
;;;; one to another.  Neither moves or wakes a body.  Bodies of links, and bodies attached to them,
;;;; are where the posture would put them, on both sides; so a mechanism's own links may be
;;;; obstacles as well.

(in-package #:discrepancy-finder.bullet)

(define-raw %mechanism-clearance "dfb_mechanism_clearance" :int
  (world :pointer) (mechanism :int) (base :pointer) (positions :pointer)
  (watched-count :int) (watched :pointer) (obstacle-count :int) (obstacles :pointer)
  (limit :double) (distance :pointer) (bodies :pointer))
(define-raw %path-contact "dfb_path_contact" :int
  (world :pointer) (mechanism :int) (base :pointer) (start :pointer) (goal :pointer)
  (watched-count :int) (watched :pointer) (obstacle-count :int) (obstacles :pointer)
  (contact-distance :double) (fraction :pointer) (bodies :pointer))

(defmacro with-pointers ((&rest bindings) &body body)
  "Evaluate BODY with each variable of BINDINGS, a list of (variable vector), bound to a pointer to
the vector's data."
  (if (null bindings)
      `(progn ,@body)
      `(cffi:with-pointer-to-vector-data ,(first bindings)
         (with-pointers ,(rest bindings) ,@body))))

(defun clearance-bodies (mechanism ids)
  (let ((bodies (world-body-vector (mechanism-world mechanism))))
    (values (aref bodies (aref ids 0)) (aref bodies (aref ids 1)))))

(defun mechanism-clearance (mechanism base positions watched obstacles limit)
  "Return how far (m) apart the two nearest bodies would be, one of the list WATCHED and one of the
list OBSTACLES, with the base of MECHANISM at the pose BASE and its joints at POSITIONS; and the
two.  Return 0 and the first two found if any penetrate each other; LIMIT (m) and twice NIL if none
are nearer than that.  Pairs that ignore their collision do not count.  Signals BULLET-ERROR if a
number is not finite, LIMIT not positive or a body of another world."
  (check-positions mechanism positions 'mechanism-clearance)
  (let* ((world (mechanism-world mechanism))
         (limit (number-of "the limit" limit 'mechanism-clearance :positive))
         (watched (body-ids world watched 'mechanism-clearance))
         (obstacles (body-ids world obstacles 'mechanism-clearance))
         (base (write-pose base (mechanism-base mechanism)))
         (distance (make-array 1 :element-type 'double-float))
         (ids (make-array 2 :element-type '(signed-byte 32))))
    (declare (type positions positions))
    (with-pointers ((watched-pointer watched) (obstacles-pointer obstacles) (base-pointer base)
                    (positions-pointer positions) (distance-pointer distance) (ids-pointer ids))
      (invoke ('mechanism-clearance pointer world)
          (%mechanism-clearance pointer (mechanism-id mechanism) base-pointer positions-pointer
                                (length watched) watched-pointer
                                (length obstacles) obstacles-pointer
                                limit distance-pointer ids-pointer)
        (:bad-number (bad-posture))
        (:nothing (return-from mechanism-clearance (values limit nil nil)))))
    (multiple-value-call #'values (aref distance 0) (clearance-bodies mechanism ids))))

(defun path-contact (mechanism base start goal watched obstacles &key (contact-distance 0))
  "Return where on the straight way of the joints of MECHANISM from the positions START to GOAL, its
base at the pose BASE, a body of the list WATCHED first comes as near as CONTACT-DISTANCE (m) to one
of the list OBSTACLES: the part of the way, 0 to 1, and the two bodies.  Return NIL if nowhere.  Two
bodies that are so near at START already may come 1 mm closer; pairs that ignore their collision do
not count; a contact that is not deeper than 0.5 mm may be overlooked.  Signals BULLET-ERROR if a
number is not finite, the way of a joint longer than 1000 (m or rad), or a body of another world."
  (check-positions mechanism start 'path-contact)
  (check-positions mechanism goal 'path-contact)
  (let* ((world (mechanism-world mechanism))
         (distance (number-of "the contact distance" contact-distance 'path-contact
                              :not-negative))
         (watched (body-ids world watched 'path-contact))
         (obstacles (body-ids world obstacles 'path-contact))
         (base (write-pose base (mechanism-base mechanism)))
         (fraction (make-array 1 :element-type 'double-float))
         (ids (make-array 2 :element-type '(signed-byte 32))))
    (declare (type positions start goal))
    (with-pointers ((watched-pointer watched) (obstacles-pointer obstacles) (base-pointer base)
                    (start-pointer start) (goal-pointer goal) (fraction-pointer fraction)
                    (ids-pointer ids))
      (invoke ('path-contact pointer world)
          (%path-contact pointer (mechanism-id mechanism) base-pointer start-pointer goal-pointer
                         (length watched) watched-pointer (length obstacles) obstacles-pointer
                         distance fraction-pointer ids-pointer)
        (:bad-number (format nil "~a, or has to go farther than 1000" (bad-posture)))
        (:nothing (return-from path-contact nil))))
    (multiple-value-call #'values (aref fraction 0) (clearance-bodies mechanism ids))))
