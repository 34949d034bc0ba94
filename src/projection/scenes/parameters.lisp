;;;; The parameters of a scene: numbers that the plan's author can set.
;;;;
;;;; A scene gives values in (:parameters (NAME value [documentation])*), and ranges in
;;;; (:tolerances (NAME low high [documentation])*).  A tolerance stands for what is not known
;;;; exactly; its value is drawn as part of a sample.  Undrawn, it is the value under :parameters
;;;; if there is one, else the middle of the range.  What neither clause names has the default of
;;;; *KNOWN-PARAMETERS*; names that only the scene's user knows are allowed, too.
;;;; SCENE-PARAMETER (scene.lisp) asks for a value, SCENE-WITH-PARAMETERS changes some.

(in-package #:discrepancy-finder.projection)

(defparameter *known-parameters*
  '((:base-speed 0.6 "greatest speed of the base, m/s")
    (:base-acceleration 0.6 "of the base as it starts, m/s^2")
    (:base-deceleration :base-acceleration "of the base as it brakes, m/s^2")
    (:base-turn-speed :base-speed "greatest speed at which the base turns, rad/s")
    (:base-turn-acceleration :base-acceleration "of the base as it begins to turn, rad/s^2")
    (:joint-speed 1.0 "greatest speed of a joint, m/s or rad/s")
    (:joint-acceleration 4.0 "of a joint, m/s^2 or rad/s^2")
    (:gripper-speed 0.1 "speed of a gripper's joint, m/s or rad/s")
    (:clearance 0.1 "height by which an arm lifts what it holds, m")
    (:suspension 0.05 "way over which the base rises at a step, m")
    (:step-height 0.02 "height up to which fixtures are driven over, m")
    (:grip-force 40 "force with which a gripper closes, N" (0 . nil))
    (:finger-friction 0.6 "coefficient of friction between fingers and items" (0 . nil))
    (:pad-radius 0.012 "radius of the fingers' contact patch, m")
    (:camera-range 5.0 "distance up to which the camera sees, m")
    (:camera-field-of-view 1.05 "from the left to the right side of the picture, rad"
     (0 . #.pi))
    (:camera-vertical-field-of-view 0.8 "from the lower to the upper side of the picture, rad"
     (0 . #.pi))
    (:visible-fraction 0.2 "part of an item's surface that must be seen to detect it, 0 to 1"
     (0 . 1))
    (:base-stopping-error-x 0 "how far ahead of its goal the base stops, m" (nil . nil))
    (:base-stopping-error-y 0 "how far left of its goal the base stops, m" (nil . nil))
    (:base-stopping-error-yaw 0 "how far to the left of its goal the base turns, rad" (nil . nil))
    (:perception-error-x 0 "what is added to the x coordinate of a detected item, m" (nil . nil))
    (:perception-error-y 0 "what is added to the y coordinate of a detected item, m" (nil . nil))
    (:perception-error-z 0 "what is added to the z coordinate of a detected item, m" (nil . nil)))
  "The parameters that the process modules ask for: (name default documentation [limits]).  A
default that is a name is the value of that parameter.  LIMITS is (bound . largest): a value must be
above the bound; without limits, above 0.")

(defun known-parameter (name)
  "Return the entry of the keyword NAME in *KNOWN-PARAMETERS*, or NIL."
  (find name *known-parameters* :key #'first))

(defun parameter-limits (name)
  "Return the number that values of the parameter NAME, a symbol, must exceed, and the largest one
possible; NIL stands for no limit."
  (let ((limits (or (fourth (known-parameter (source:name-keyword name))) '(0 . nil))))
    (values (car limits) (cdr limits))))

(defun possible-value-p (name value)
  "Return true if VALUE can be that of the parameter NAME, a symbol."
  (multiple-value-bind (bound largest) (parameter-limits name)
    (and (realp value)
         (< -1000000000 value 1000000000)
         (or (null bound) (> value bound))
         (or (null largest) (<= value largest)))))

;;; Reading

(defun parameter-name-p (object)
  (and (symbolp object) object))

(defun documentation-p (more)
  "Return true if MORE, the end of an entry, is empty or a documentation string."
  (or (null more) (and (stringp (first more)) (null (rest more)))))

(defun parse-parameter (entry file)
  "Return the (name value [documentation]) that ENTRY of a :parameters clause in FILE gives."
  (unless (and (consp entry) (parameter-name-p (first entry))
               (possible-value-p (first entry) (second entry))
               (documentation-p (cddr entry)))
    (multiple-value-bind (bound largest)
        (if (and (consp entry) (parameter-name-p (first entry)))
            (parameter-limits (first entry))
            0)
      (scene-problem file entry "(name ~:[~;positive-~]number [documentation]) was expected in ~
                                 :parameters~@[, and a number of at most ~,4f~]" bound largest)))
  (list* (source:name-keyword (first entry)) (decimal-double (second entry)) (cddr entry)))

(defun parse-tolerance (entry file)
  "Return the (name low high documentation) that ENTRY of a :tolerances clause in FILE gives."
  (unless (and (consp entry) (<= 3 (length entry)) (parameter-name-p (first entry))
               (documentation-p (cdddr entry)))
    (scene-problem file entry "(name low high [documentation]) was expected in :tolerances"))
  (destructuring-bind (name low high &optional documentation) entry
    (dolist (value (list low high))
      (unless (possible-value-p name value)
        (multiple-value-bind (bound largest) (parameter-limits name)
          (scene-problem file entry "the tolerance ~(~a~) has the bound ~(~s~) where a ~:[~;~
                                     positive ~]number~@[ of at most ~,4f~] was expected"
                         name value bound largest))))
    (when (> low high)
      (scene-problem file entry "the tolerance ~(~a~) begins above its end" name))
    (list (source:name-keyword name) (decimal-double low) (decimal-double high)
          (or documentation (third (known-parameter (source:name-keyword name)))))))

(defun check-distinct (forms what file &key (key #'first))
  "Signal SCENE-ERROR at the first of FORMS, lists, whose name, which KEY returns, an earlier one
has; WHAT names them in the plural."
  (let ((names '()))
    (dolist (form forms)
      (let ((name (symbol-name (funcall key form))))
        (when (member name names :test #'string=)
          (scene-problem file form "two ~a have the same name, ~(~a~)" what name))
        (push name names)))))

(defun check-tolerances (tolerances parameters materials entries file)
  "Signal SCENE-ERROR unless each of TOLERANCES is that of a known parameter, of one of PARAMETERS,
in whose range that parameter's value lies, or used by one of MATERIALS.  ENTRIES are the forms that
the tolerances were read from."
  (loop for (name low high) in tolerances
        for entry in entries
        for value = (second (assoc name parameters))
        do (unless (or value (known-parameter name) (material-uses-p materials name))
             (scene-problem file entry "the tolerance ~(~a~) is of no known parameter, no ~
                                        parameter of the scene, and in no material" name))
           (unless (<= low (or value low) high)
             (scene-problem file entry "the parameter ~(~a~) is ~a, outside its tolerance"
                            name value))))
