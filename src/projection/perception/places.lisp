;;;; Places: parts of fixtures that designators name, and what is on or in them.
;;;;
;;;; A PART is a body of a fixture: the fixture's immobile links together, or what a joint moves, as
;;;; a drawer.  It is named by a link of it, by its joint or by the fixture, a string or a symbol;
;;;; hyphens and underscores are the same, so that (urdf-name drawer-2) is the link drawer_2.
;;;; What is on or in a part is what has it straight below, whatever items are in between.

(in-package #:discrepancy-finder.projection)

(defun plain-name (name)
  "Return NAME, a string or symbol, in lower case and with underscores for hyphens."
  (substitute #\_ #\- (string-downcase name)))

(defun same-name-p (one other)
  (string= (plain-name one) (plain-name other)))

(defun part-link (projection name)
  "Return the name of the link and of the fixture that NAME, a string or symbol, means as a part of
PROJECTION, or NIL: a link, else what a joint moves, else the root of a fixture."
  (let ((parts (parts-of-kind (projection-scene projection) :fixture)))
    (flet ((search-parts (function)
             (dolist (part parts)
               (let ((link (funcall function (scene-part-model part))))
                 (when link
                   (return-from part-link (values link (scene-part-name part))))))))
      (search-parts (lambda (model)
                      (loop for link in (urdf-model-links model)
                            when (same-name-p name (urdf-link-name link))
                              return (urdf-link-name link))))
      (search-parts (lambda (model)
                      (loop for joint in (urdf-model-joints model)
                            when (same-name-p name (urdf-joint-name joint))
                              return (urdf-joint-child joint))))
      (let ((part (find name parts :key #'scene-part-name :test #'same-name-p)))
        (and part
             (values (urdf-model-root (scene-part-model part)) (scene-part-name part)))))))

(defun movable-link (projection type)
  "Return the name of the first link that a joint with TYPE in its name moves, and of its fixture,
or NIL."
  (dolist (part (parts-of-kind (projection-scene projection) :fixture))
    (dolist (joint (urdf-model-joints (scene-part-model part)))
      (when (and (not (eq (urdf-joint-type joint) :fixed))
                 (search (plain-name type) (plain-name (urdf-joint-name joint))))
        (return-from movable-link (values (urdf-joint-child joint) (scene-part-name part)))))))

(defun thing-link (projection thing)
  "Return the name of the link and of the fixture of the part that THING, an object designator, a
string or a symbol, means, or NIL."
  (flet ((try (function name)
           (when name
             (multiple-value-bind (link fixture) (funcall function projection name)
               (when link (return-from thing-link (values link fixture)))))))
    (typecase thing
      (plan:object-designator
       (try #'part-link (plan:desig-prop-value thing :urdf-name))
       (try #'part-link (plan:desig-prop-value thing :name))
       (try #'part-link (plan:desig-prop-value thing :type))
       (try #'movable-link (plan:desig-prop-value thing :type))
       (try #'part-link (plan:desig-prop-value thing :part-of)))
      ((or string symbol) (try #'part-link thing)))))

(defun part-body (projection thing)
  "Return the body of the part of a fixture of PROJECTION that THING, an object designator, a string
or a symbol, means, or NIL."
  (multiple-value-bind (link fixture) (thing-link projection thing)
    (and link (fixture-link-body projection link fixture))))

(defun location-part (projection location)
  "Return the body of the part on or in which LOCATION, a location designator, is, or NIL."
  (let ((thing (or (plan:desig-prop-value location :on) (plan:desig-prop-value location :in))))
    (and thing (part-body projection thing))))

(defun point-below (pose depth)
  (quaternion-pose (pose-x pose) (pose-y pose) (- (pose-z pose) depth) 0d0 0d0 0d0 1d0))

(defun part-below (projection pose)
  "Return the body of the fixture that is straight below the position of POSE in PROJECTION, or NIL
if there is none."
  (let ((passed (append (mapcar #'cdr (projection-items projection))
                        (and (projection-robot projection)
                             (link-bodies (projection-robot projection))))))
    (find (bullet:cast-ray (projection-world projection) pose (point-below pose 10d0)
                           :passed passed)
          (projection-fixtures projection))))

(defun item-at-location-p (projection name location)
  "Return true if the item NAME is on or in the part that LOCATION names, or if that names none."
  (let ((part (and (typep location 'plan:location-designator)
                   (location-part projection location))))
    (or (null part)
        (eq part (part-below projection (observed-pose projection name))))))
