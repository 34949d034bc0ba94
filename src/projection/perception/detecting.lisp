;;;; The perception process module: motions of type detecting.
;;;;
;;;; An item is detected if the part of it that is seen (seeing.lisp) is at least the scene's
;;;; visible-fraction.  Where it is reported to be is where it is plus the perception error, a
;;;; tolerance of the scene: perception-error-x, -y and -z, in m in the frame of the world.

(in-package #:discrepancy-finder.projection)

(defun detected-object (projection designator name)
  "Return a new object designator: the description of DESIGNATOR, by which the item NAME was sought,
with the item's type, name and pose."
  (plan:make-designator
   :object
   `((:type ,(scene-item-type (projection-scene projection) name))
     (:name ,name)
     ,@(remove-if (lambda (property) (member (first property) '(:type :name :pose)))
                  (plan:properties designator))
     (:pose ,(observed-pose projection name)))))

(defun fail-to-detect (projection designator seen)
  "Signal PERCEPTION-OBJECT-NOT-FOUND for the object DESIGNATOR; SEEN is a list of (item . part)."
  (plan:fail 'plan:perception-object-not-found
             :object designator
             :description
             (format nil "~a is not seen: ~:[there is no such item~;~:*~{~a~^, ~}, where ~,1f % ~
                          are needed~]"
                     designator
                     (loop for (name . part) in seen
                           collect (format nil "~,1f % of ~(~a~)" (* 100 part) name))
                     (* 100 (scene-parameter (projection-scene projection) :visible-fraction)))))

(defmethod execute-designator ((projection projection) (class (eql :motion))
                               (type (eql :detecting)) designator)
  (check-robot-part projection :camera :camera)
  (let ((object (plan:desig-prop-value designator :object))
        (enough (scene-parameter (projection-scene projection) :visible-fraction))
        (seen '()))
    (unless (and (typep object 'plan:object-designator)
                 (or (plan:desig-prop-value object :type) (plan:desig-prop-value object :name)))
      (misunderstood designator "a motion of type detecting needs an object with a type or a name"))
    (dolist (name (designated-items projection object)
                  (fail-to-detect projection object (nreverse seen)))
      (let ((part (visible-part projection name)))
        (when (>= part enough)
          (return (detected-object projection object name)))
        (push (cons name part) seen)))))
