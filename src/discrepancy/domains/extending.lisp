;;;; Domains that extend others: the clauses (:extends domain) and (:items name*).
;;;;
;;;; Regions and observers of the extended domain are read anew, as its author wrote them, for the
;;;; theory and scene of the one that extends it.  Those that speak of items that are not there are
;;;; left out, and so are those that it gives itself.

(in-package #:discrepancy-finder.discrepancy)

(defun extended-domain (name clause file)
  "Return the domain that CLAUSE, (:extends NAME-or-\"file\") or NIL, means."
  (let ((other (second clause)))
    (cond ((null clause) nil)
          ((and (stringp other) (null (cddr clause)))
           (load-domain (relative-file other file)))
          ((and other (symbolp other) (null (cddr clause))) (ensure-domain other))
          (t (abstraction-problem name clause
                                  "the name of a domain or of its file was expected")))))

(defun scene-of-items (name clause scene)
  "Return SCENE with the items only that CLAUSE, (:items name*) or NIL, names."
  (if (null clause)
      scene
      (let ((items (loop for item in (rest clause)
                         collect (or (find (and (symbolp item) item (ec:name-keyword item))
                                           (projection:scene-item-names scene))
                                     (abstraction-problem name clause "the scene has no item ~a"
                                                          (ec:formula-text item))))))
        (projection:scene-with-items scene items))))

(defun clause-key (clause)
  "Return what CLAUSE, one of a region or an observer, is about: two with the same are not both
inherited."
  (list (first clause)
        (let ((subject (second clause)))
          (if (consp subject) (mapcar #'ec:name-keyword subject) (ec:name-keyword subject)))))

(defun clause-applies-p (clause theory scene)
  "Return true if the body, item and elements that CLAUSE names exist in THEORY and SCENE."
  (destructuring-bind (key pattern &rest options) clause
    (flet ((there-p (body)
             (or (null body) (variable-name-p body)
                 (member (ec:name-keyword body) (projection:scene-item-names scene))
                 (eq (ec:name-keyword body) (projection:scene-robot-name scene)))))
      (or (eq key :region)
          (let ((declaration (assoc (ec:name-keyword (first pattern))
                                    (ec:theory-fluents theory))))
            (and declaration
                 (loop for term in (rest pattern)
                       for sort in (rest declaration)
                       always (or (variable-name-p term)
                                  (member (ec:name-keyword term)
                                          (ec:sort-elements theory sort))))
                 (or (eq key :computed)
                     (and (there-p (getf options :body)) (there-p (getf options :item))))))))))

(defun inherited-clauses (domain own theory scene)
  "Return the clauses of DOMAIN that apply to THEORY and SCENE and have no namesake in the list
OWN."
  (let ((keys (mapcar #'clause-key (remove-if-not (lambda (clause)
                                                    (and (consp (rest clause)) (second clause)))
                                                  own))))
    (remove-if-not (lambda (clause)
                     (and (not (member (clause-key clause) keys :test #'equal))
                          (clause-applies-p clause theory scene)))
                   (domain-clauses domain))))
