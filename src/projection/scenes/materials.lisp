;;;; Materials: what the surfaces of a scene's fixtures and items are like.
;;;;
;;;;   (:materials (NAME [(:friction X)] [(:restitution Y)] [(:rolling-friction Z)])*)
;;;; gives coefficients; Bullet multiplies those of the two bodies that touch.  A coefficient is a
;;;; number or the name of a parameter or tolerance of the scene, so that it can be drawn.  A part
;;;; names its material with (:material NAME); PART-SURFACE returns what it comes to.

(in-package #:discrepancy-finder.projection)

(defstruct (material (:copier nil))
  "COEFFICIENTS is a property list of :friction, :restitution and :rolling-friction; the values are
double floats or keywords, names of parameters."
  (name nil :type keyword :read-only t)
  (coefficients '() :type list :read-only t)
  (form nil :type list :read-only t))

(defmethod print-object ((material material) stream)
  (print-unreadable-object (material stream :type t)
    (format stream "~(~a~)~{ ~(~a~) ~(~a~)~}" (material-name material)
            (material-coefficients material))))

(defparameter *coefficients* '((:friction . 10) (:restitution . 1) (:rolling-friction . 1))
  "The coefficients that a material can have, with their largest values.")

(defun possible-coefficient-p (kind value)
  (and (realp value) (<= 0 value (cdr (assoc kind *coefficients*)))))

(defun parse-material (entry file)
  "Return the MATERIAL that ENTRY of a :materials clause in FILE describes."
  (unless (and (consp entry) (parameter-name-p (first entry)) (rest entry)
               (every (lambda (option)
                        (and (consp option) (= (length option) 2)
                             (assoc (first option) *coefficients*)))
                      (rest entry)))
    (scene-problem file entry "(name (:friction number) (:restitution number) ~
                               [(:rolling-friction number)]) was expected in :materials"))
  (let ((coefficients '()))
    (loop for (kind value) in (rest entry)
          do (when (getf coefficients kind)
               (scene-problem file entry "the material ~(~a~) has two ~(~a~)s" (first entry) kind))
             (unless (or (parameter-name-p value) (possible-coefficient-p kind value))
               (scene-problem file entry "the ~(~a~) of the material ~(~a~) is ~(~s~) where a ~
                                          number from 0 to ~d or the name of a parameter was ~
                                          expected" kind (first entry) value
                              (cdr (assoc kind *coefficients*))))
             (setf (getf coefficients kind)
                   (if (realp value) (decimal-double value) (source:name-keyword value))))
    (make-material :name (source:name-keyword (first entry)) :form entry
                   :coefficients coefficients)))

(defun material-uses-p (materials name)
  "Return true if a coefficient of one of MATERIALS is the parameter with the keyword NAME."
  (loop for material in materials
          thereis (loop for (nil value) on (material-coefficients material) by #'cddr
                          thereis (eq value name))))

(defun check-materials (scene)
  "Signal SCENE-ERROR unless the parameters that SCENE's materials name exist and make possible
coefficients over all of their range, and the parts' materials exist."
  (dolist (material (scene-materials scene))
    (loop for (kind name) on (material-coefficients material) by #'cddr
          for (nil low high) = (assoc name (scene-tolerances scene))
          do (when (keywordp name)
               (flet ((problem (control &rest arguments)
                        (apply #'scene-problem (scene-file scene) (material-form material)
                               control arguments)))
                 (unless (scene-knows-p scene name)
                   (problem "the material ~(~a~) names the parameter ~(~a~), which the scene does ~
                             not have" (material-name material) name))
                 (dolist (value (list low high (scene-parameter scene name)))
                   (unless (or (null value) (possible-coefficient-p kind value))
                     (problem "the ~(~a~) of the material ~(~a~) is the parameter ~(~a~), which ~
                               can be ~a; it must be from 0 to ~d" kind (material-name material)
                              name value (cdr (assoc kind *coefficients*)))))))))
  (dolist (part (scene-parts scene))
    (let ((name (scene-part-material part)))
      (unless (or (null name) (find name (scene-materials scene) :key #'material-name))
        (scene-problem (scene-file scene) (scene-part-form part)
                       "~(~s~) ~(~a~): there is no material ~(~a~)" (scene-part-kind part)
                       (scene-part-name part) name)))))

(defun part-surface (scene part)
  "Return the coefficients of the material of PART of SCENE, a property list of double floats under
:friction, :restitution and :rolling-friction, as BULLET:ADD-BODY takes them; NIL without material."
  (let ((material (find (scene-part-material part) (scene-materials scene)
                        :key #'material-name)))
    (and material
         (loop for (kind value) on (material-coefficients material) by #'cddr
               append (list kind (if (keywordp value) (scene-parameter scene value) value))))))
