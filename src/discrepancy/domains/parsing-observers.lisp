;;;; Reading observers as they are written in DEFINE-ABSTRACTION.

(in-package #:discrepancy-finder.discrepancy)

;;; Placements

(defun middle-width (entry)
  "Return the width if ENTRY is (axis (middle width)), else NIL."
  (and (alexandria:proper-list-p entry) (= (length entry) 2)
       (alexandria:proper-list-p (second entry)) (= (length (second entry)) 2)
       (destructuring-bind (operator width) (second entry)
         (and operator (symbolp operator) (eq (ec:name-keyword operator) :middle)
              (realp width) (plusp width)
              width))))

(defun parse-coordinate (name clause entry regions)
  "Return (axis min max) for ENTRY: an axis that every region of REGIONS bounds, (axis min max), or
(axis value); or (axis :middle width) for (axis (middle width))."
  (let* ((axis (first (alexandria:ensure-list entry)))
         (axis (and axis (symbolp axis) (ec:name-keyword axis))))
    (cond ((and (alexandria:proper-list-p entry) (= (length entry) 2) (assoc axis *axes*)
                (realp (second entry)))
           (let ((value (decimal-double (second entry))))
             (list axis value value)))
          ((middle-width entry)
           (unless (every (lambda (region) (assoc axis (region-bounds region))) regions)
             (abstraction-problem name clause "the coordinate ~(~a~) is bounded by no region, so ~
                                               that there is no middle of it" axis))
           (list axis :middle (decimal-double (middle-width entry))))
          ((and (consp entry) (rest entry))
           (first (parse-bounds name clause (list (cons axis (rest entry))))))
          ((not (assoc axis *axes*))
           (abstraction-problem name clause "~a is no coordinate; x, y, z and yaw are"
                                (ec:formula-text entry)))
          ((every (lambda (region) (assoc axis (region-bounds region))) regions)
           (list axis nil nil))
          (t (abstraction-problem name clause "the coordinate ~(~a~) is bounded by no region and ~
                                               needs a range, (~:*~(~a~) min max)" axis)))))

(defun parse-coordinates (name clause entries regions)
  (let ((coordinates (loop for entry in entries
                           collect (parse-coordinate name clause entry regions))))
    (unless (= (length coordinates)
               (length (remove-duplicates (mapcar #'first coordinates))))
      (abstraction-problem name clause "a coordinate stands twice"))
    coordinates))

(defun parse-placement (name clause theory scene regions)
  (source:destructuring-or (pattern &key body coordinates) (rest clause)
      (abstraction-problem name clause "(:placement (fluent ?region) :body name :coordinates ~
                                        (coordinate*)) was expected")
    (multiple-value-bind (atom sorts) (parse-pattern name clause pattern theory)
      (let ((place (position-if #'variable-name-p atom :start 1)))
        (unless (and place (= 1 (count-if #'variable-name-p (rest atom))))
          (abstraction-problem name clause "~a needs one variable, for the region"
                               (ec:formula-text pattern)))
        (unless (and body (symbolp body) (alexandria:proper-list-p coordinates) coordinates)
          (abstraction-problem name clause ":body and :coordinates are needed"))
        (handler-case (projection:check-movable scene body)
          (projection:unknown-body ()
            (abstraction-problem name clause "the scene has no robot and no item ~a"
                                 (ec:name-text body))))
        (let ((candidates (loop for element in (ec:sort-elements theory (nth (1- place) sorts))
                                for region = (find element regions :key #'region-name)
                                when region collect region)))
          (unless candidates
            (abstraction-problem name clause "there is no (:region ~a ...)"
                                 (ec:name-text (first (ec:sort-elements
                                                       theory (nth (1- place) sorts))))))
          (check-disjoint name candidates)
          (make-placement :pattern atom :place place :body (ec:name-keyword body)
                          :regions candidates
                          :coordinates (parse-coordinates name clause coordinates
                                                          candidates)))))))

;;; Joints

(defun parse-range (name clause range)
  (unless (and (alexandria:proper-list-p range) (= (length range) 2) (every #'realp range)
               (<= (first range) (second range)))
    (abstraction-problem name clause "~a was found where a range (min max) was expected"
                         (ec:formula-text range)))
  (mapcar #'decimal-double range))

(defun parse-joint-range (name clause theory scene)
  (source:destructuring-or (pattern &key joint range otherwise) (rest clause)
      (abstraction-problem name clause "(:joint (fluent) :joint \"name\" :range (min max) ~
                                        [:otherwise (min max)]) was expected")
    (unless (and joint range)
      (abstraction-problem name clause ":joint and :range are needed"))
    (let ((atom (parse-ground name clause pattern theory))
          (range (parse-range name clause range))
          (otherwise (and otherwise (parse-range name clause otherwise))))
      (unless (and (stringp joint) (projection:scene-joint scene joint))
        (abstraction-problem name clause "the scene has no joint ~s" joint))
      (when (and otherwise (<= (first otherwise) (second range)) (<= (first range)
                                                                     (second otherwise)))
        (abstraction-problem name clause "the ranges :range and :otherwise overlap"))
      (make-joint-range :atom atom :joint joint :min (first range) :max (second range)
                        :otherwise otherwise))))

;;; Coordinates

(defun parse-coordinate-range (name clause theory scene)
  (source:destructuring-or (pattern &key body axis range) (rest clause)
      (abstraction-problem name clause "(:coordinate (fluent) :body name :axis axis :range (min ~
                                        max)) was expected")
    (let ((axis (and axis (symbolp axis) (ec:name-keyword axis))))
      (unless (assoc axis *axes*)
        (abstraction-problem name clause ":axis is needed, one of x, y, z, yaw"))
      (unless (and body (symbolp body))
        (abstraction-problem name clause ":body is needed, a name"))
      (handler-case (projection:check-movable scene body)
        (projection:unknown-body ()
          (abstraction-problem name clause "the scene has no robot and no item ~a"
                               (ec:name-text body))))
      (destructuring-bind (min max) (parse-range name clause range)
        (make-coordinate-range :atom (parse-ground name clause pattern theory)
                               :body (ec:name-keyword body) :axis axis :min min :max max)))))

;;; Attachments and computed fluents

(defun bound-name (term bindings)
  "Return the element that TERM, a symbol, stands for."
  (let ((keyword (ec:name-keyword term)))
    (or (cdr (assoc keyword bindings)) keyword)))

(defun parse-attachments (name clause theory scene)
  (source:destructuring-or (pattern &key item arm) (rest clause)
      (abstraction-problem name clause "(:attachment (fluent) :item name [:arm name]) was expected")
    (unless (and item (symbolp item) (symbolp arm))
      (abstraction-problem name clause ":item is needed, a name"))
    (multiple-value-bind (atom sorts) (parse-pattern name clause pattern theory)
      (dolist (term (remove-if-not #'variable-name-p (rest atom)))
        (unless (member term (list (ec:name-keyword item) (and arm (ec:name-keyword arm))))
          (abstraction-problem name clause "~a is neither the item nor the arm"
                               (ec:formula-text term))))
      (loop for (ground . bindings) in (ground-patterns atom sorts theory)
            for held = (bound-name item bindings)
            for hand = (and arm (bound-name arm bindings))
            do (unless (member held (projection:scene-item-names scene))
                 (abstraction-problem name clause "the scene has no item ~a" (ec:name-text held)))
               (unless (or (null hand) (member hand (projection:scene-arm-names scene)))
                 (abstraction-problem name clause "the scene's robot has no arm ~a"
                                      (ec:name-text hand)))
            collect (make-attachment :atom ground :item held :arm hand)))))

(defun parse-computed (name clause theory)
  (source:destructuring-or (pattern function) (rest clause)
      (abstraction-problem name clause "(:computed (fluent) function-name) was expected")
    (let ((function (if (and (consp function) (eq (first function) 'function))
                        (second function)
                        function)))
      (unless (and function (symbolp function))
        (abstraction-problem name clause "~a is no name of a function" (ec:formula-text function)))
      (multiple-value-bind (atom sorts) (parse-pattern name clause pattern theory)
        (loop for (ground) in (ground-patterns atom sorts theory)
              collect (make-computed :atom ground :function function :arguments (rest ground)))))))
