;;;; New designators from old ones, and descriptions compared.

(in-package #:discrepancy-finder.designators)

(defun description-of (description)
  "Return DESCRIPTION, a list of properties, or that of the designator DESCRIPTION."
  (if (typep description 'designator) (properties description) description))

(defun update-designator-properties (new-properties properties)
  "Return a list of properties: NEW-PROPERTIES and those of PROPERTIES whose key does not occur
there.  Both are lists of properties or designators."
  (let ((new (description-of new-properties)))
    (append new
            (remove-if (lambda (property) (assoc (first property) new))
                       (description-of properties)))))

(defun merge-desig-descriptions (old new)
  "Return the list of the properties of OLD and NEW, lists of properties or designators.  Where both
have a key, NEW's properties of that key stand in the place of OLD's."
  (let* ((old (description-of old))
         (new (description-of new))
         (replaced '()))
    (append
     (loop for property in old
           for key = (first property)
           if (not (assoc key new)) collect property
           else unless (member key replaced)
                  append (progn (push key replaced)
                                (remove key new :key #'first :test-not #'eq)))
     (remove-if (lambda (property) (assoc (first property) old)) new))))

(defun copy-with (designator description)
  "Return a new designator, in no chain, of the class and with the quantifier of DESIGNATOR."
  (new-designator (designator-class-keyword designator) description (quantifier designator)))

(defun copy-designator (designator &key new-description)
  "Return a new designator, not equated, with the properties of DESIGNATOR; the properties in the
list NEW-DESCRIPTION dominate."
  (copy-with designator (merge-desig-descriptions designator new-description)))

(defun extend-designator-properties (designator new-properties)
  "Return a new designator, equated to DESIGNATOR, with NEW-PROPERTIES in addition to DESIGNATOR's
properties; where both have a key, NEW-PROPERTIES dominate."
  (equate designator
          (copy-with designator (update-designator-properties new-properties designator))))

(defun make-effective-designator (parent &key (new-properties (properties parent)) data-object
                                           (timestamp (funcall *timestamp-function*)))
  "Return a new effective designator, equated to the designator PARENT, with NEW-PROPERTIES,
DATA-OBJECT as what it describes, and TIMESTAMP.  Perception makes what it saw such a designator."
  (let ((designator (copy-with parent new-properties)))
    (setf (data designator) data-object
          (slot-value designator 'effective) t
          (slot-value designator 'timestamp) timestamp)
    (equate parent designator)))

(defun same-value-p (first second)
  (or (equal first second)
      (desig-equal first second)
      (and (consp first) (consp second)
           (same-value-p (car first) (car second))
           (same-value-p (cdr first) (cdr second)))
      (and (pose-p first) (pose-p second) (pose= first second))
      (and (typep first 'designator) (typep second 'designator)
           (eq (designator-class-keyword first) (designator-class-keyword second))
           (matches-description-p first (properties second))
           (matches-description-p second (properties first)))))

(defun matches-description-p (designator description)
  "Return true if DESIGNATOR has every property of DESCRIPTION, a list of properties or a
designator.  Nested designators are the same if they are in one chain or have the same properties."
  (every (lambda (property)
           (some (lambda (own) (same-value-p own property)) (properties designator)))
         (description-of description)))
