;;;; Designators: forms, properties, chains, resolution, locations, predicates.

(in-package #:discrepancy-finder.tests)

(def-suite designator-layer :in all)
(in-suite designator-layer)

(defparameter *bound-special* 'left "A special variable with a value when the tests are expanded.")

(defun key-warnings-of (form)
  "Return the list of the conditions of which the expansion of FORM warns."
  (let ((warnings '()))
    (handler-bind ((desig:unknown-designator-key
                     (lambda (warning)
                       (push warning warnings)
                       (muffle-warning warning))))
      (macroexpand-1 form))
    (nreverse warnings)))

(defun keys-of (designator)
  (mapcar #'first (desig:properties designator)))

;;; Forms

(test values-in-designator-forms
  (let* ((pose (geometry:make-pose 1 2 3))
         (?pose pose)
         (list (list 1 2))
         (?list list)
         (designator (desig:a motion (type going) (pose ?pose) (frame "map") (speed 2)
                              (gripper (left right)) (arm *bound-special*) (call (car ?list))
                              (list-value ?list) (flags ((hot nil) (cold 3.5d0))) (fixed pi)
                              (nothing nil) (:key :value) (several 1 two ?pose))))
    (flet ((value (key) (desig:desig-prop-value designator key)))
      (is (eq :going (value :type)))
      (is (eq pose (value :pose)))
      (is (string= "map" (value :frame)))
      (is (eql 2 (value :speed)))
      (is (equal '(:left :right) (value :gripper)))
      (is (eq :left (value :arm)))
      (is (equal '(:car (1 2)) (value :call)))
      (is (eq list (value :list-value)))
      (is (equal '((:hot nil) (:cold 3.5d0)) (value :flags)))
      (is (eql pi (value :fixed)))
      (is (equal '(:nothing nil) (assoc :nothing (desig:properties designator))))
      (is (eq :value (value :key)))
      (is (equal (list :several 1 :two pose) (assoc :several (desig:properties designator)))))))

(test bound-specials-are-taken-when-the-form-is-expanded
  (let ((*bound-special* 'right))
    (is (eq :left (desig:desig-prop-value (desig:a motion (arm *bound-special*)) :arm)))
    (is (search ":RIGHT" (prin1-to-string
                          (macroexpand-1 '(desig:a motion (arm *bound-special*)))))))
  (let ((*bound-special* '(1 (one *bound-special-2*))))
    (is (equal '(list 1 (list :one :*bound-special-2*))
               (second (cdadr (third (macroexpand-1 '(desig:a motion (v *bound-special*)))))))))
  (let ((*bound-special* '(1 . 2)))
    (signals desig:malformed-designator
      (macroexpand-1 '(desig:a motion (v *bound-special*))))))

(test conditional-properties
  (flet ((designator (?arm)
           (desig:an action (type picking-up)
                     (desig:when ?arm (arm ?arm) (grasp top))
                     nil
                     (when (not ?arm) (effort 3)))))
    (is (equal '(:type :arm :grasp) (keys-of (designator :left))))
    (is (equal '(:type :effort) (keys-of (designator nil)))))
  (is (eq 'cl:when (find-symbol "WHEN" '#:discrepancy-finder.designators)))
  (is (null (desig:properties (desig:a motion (when nil (type going))))))
  (is (null (desig:properties (desig:a motion)))))

(test nested-designators-and-quantifiers
  (let ((designator (desig:all object (type cup)
                               (at (a location (on (the object (name table))))
                                   (some location (near (all object (type plate))))))))
    (is (eq :all (desig:quantifier designator)))
    (is (eq :object (desig:designator-class-keyword designator)))
    (destructuring-bind (first second) (rest (assoc :at (desig:properties designator)))
      (is (eq :a (desig:quantifier first)))
      (is (eq :the (desig:quantifier (desig:desig-prop-value first :on))))
      (is (eq :some (desig:quantifier second)))
      (is (eq :all (desig:quantifier (desig:desig-prop-value second :near))))))
  (is (eq :the (desig:quantifier (desig:the object (type cup)))))
  (is (eq :a (desig:quantifier (desig:an object (type cup)))))
  (is (typep (desig:a human (name "Ann")) 'desig:human-designator))
  (is (= 3 (desig:the fixnum (+ 1 2)))))

(test malformed-designator-forms
  (signals-with (desig:malformed-designator "after the article" "A THING)")
    (macroexpand-1 '(desig:a thing)))
  (signals-with (desig:malformed-designator "after the article") (macroexpand-1 '(desig:a)))
  (signals-with (desig:malformed-designator "after the article" "(AN OBJCT (TYPE CUP))")
    (macroexpand-1 '(desig:a motion (object (an objct (type cup))))))
  (signals-with (desig:malformed-designator "(key value)")
    (macroexpand-1 '(desig:a motion type)))
  (signals-with (desig:malformed-designator "a value after the key type")
    (macroexpand-1 '(desig:a motion (type))))
  (signals-with (desig:malformed-designator "(key value)")
    (macroexpand-1 '(desig:a motion ("type" going))))
  (signals-with (desig:malformed-designator "(when test (key value))")
    (macroexpand-1 '(desig:a motion (when 1))))
  (signals-with (desig:malformed-designator "without a dot")
    (macroexpand-1 '(desig:a motion (via (1 . 2)))))
  (signals-with (desig:malformed-designator ":human" "FLIGHT")
    (desig:make-designator :flight '())))

(test malformed-forms-know-their-place
  (with-file (file (format nil "(desig:a motion~%  (type going)~%  (target))~%"))
    (let ((form (first (source:read-source file :package '#:discrepancy-finder.tests))))
      (signals-with (desig:malformed-designator ":3: In " "a value after the key target")
        (macroexpand-1 form))))
  (with-file (file (format nil "~%(desig:a motion (type going)~%  (trget 1))~%"))
    (signals-with (source:source-error ":2" "(key value)")
      (with-file (bad "(desig:a motion (type going))
                       (macroexpand-1 '(desig:a motion type))")
        (source:load-source bad :package '#:discrepancy-finder.tests)))
    (let ((warning (first (key-warnings-of (first (source:read-source
                                               file :package '#:discrepancy-finder.tests))))))
      (is (search ":3: In " (princ-to-string warning)))
      (is (search "did you mean :target?" (princ-to-string warning))))))

;;; Keys

(test unknown-keys-like-known-ones-are-warned-of
  (flet ((suggestions (form)
           (mapcar #'desig:unknown-designator-key-suggestion (key-warnings-of form))))
    (is (equal '(:target) (suggestions '(desig:a motion (type going) (trget 1)))))
    (is (equal '(:target) (suggestions '(desig:a motion (type going) (tagret 1)))))
    (is (equal '(:left-poses :right-poses)
               (suggestions '(desig:an action (left-pose-s 1) (rigth-poses 1)))))
    (is (equal '(:urdf-name)
               (suggestions '(desig:a location (in (an object (urdf-nmae x)))))))
    (is (equal '(:target) (suggestions '(desig:a motion (when t (targt 1))))))
    (is (equal '(:type) (suggestions '(desig:a motion (typ going)))))
    ;; Inventions, short words, plurals.
    (is (null (suggestions '(desig:a motion (type waving) (amplitude 1) (if 1) (colour 2)
                             (targets 3) (object (an object (size 1)))))))
    (is (null (suggestions '(desig:an object (side left) (weight 1) (|| 2)))))
    (is (null (suggestions '(desig:a location (weight 1)))))
    (is (null (suggestions '(desig:a motion (type going) (target 1) (object 2))))))
  (let ((form '(desig:a motion (trget 2))))
    (is (= 1 (length (key-warnings-of form))))
    (is (null (key-warnings-of form)) "the same form is warned of twice"))
  (is (subtypep 'desig:unknown-designator-key 'style-warning)))

(test declared-keys-are-known
  (is (member :target (desig:known-keys :motion)))
  (is (not (member :targett (desig:known-keys :motion))))
  (is (= 1 (length (key-warnings-of '(desig:a motion (targett 1))))))
  (eval '(desig:declare-designator-keys motion targett :other-key-of-test))
  (is (subsetp '(:targett :other-key-of-test :target) (desig:known-keys 'desig:motion)))
  (is (null (key-warnings-of '(desig:a motion (targett 2)))))
  (is (= 1 (length (key-warnings-of '(desig:an action (targett 3))))))
  (signals desig:malformed-designator (desig:known-keys :thing))
  (setf (gethash :motion discrepancy-finder.designators::*known-keys*)
        (set-difference (desig:known-keys :motion) '(:targett :other-key-of-test))))

(test edit-distances
  (flet ((distance (first second)
           (discrepancy-finder.designators::edit-distance first second)))
    (is (= 0 (distance "" "")))
    (is (= 3 (distance "" "ABC")))
    (is (= 3 (distance "ABC" "")))
    (is (= 1 (distance "TARGET" "TAGRET")))
    (is (= 1 (distance "TARGET" "TARGT")))
    (is (= 1 (distance "TARGET" "TARGGET")))
    (is (= 2 (distance "TARGET" "TARGAT")))
    (is (= 5 (distance "KITTEN" "SITTING")))
    (is (= 10 (distance "ABCDE" "VWXYZ")))))

;;; Designators and their properties

(test properties-of-designators
  (let ((designator (desig:make-designator :location '((:side :left) (:of 1 2) (:side :front)))))
    (is (eq :left (desig:desig-prop-value designator :side)))
    (is (equal '(:left :front) (desig:desig-prop-values designator :side)))
    (is (eql 1 (desig:desig-prop-value designator :of)))
    (is (null (desig:desig-prop-value designator :nothing)))
    (is (null (desig:desig-prop-values designator :nothing)))
    (desig:with-desig-props (side of nothing) designator
      (is (eq :left side))
      (is (eql 1 of))
      (is (null nothing))))
  (is (null (desig:desig-prop-value nil :side)))
  (is (null (desig:desig-prop-values nil :side)))
  (desig:with-desig-props (side) nil
    (is (null side))))

(test classes-of-designators
  (loop for (keyword class) in '((:action desig:action-designator)
                                 (:motion desig:motion-designator)
                                 (:location desig:location-designator)
                                 (:object desig:object-designator)
                                 (:human desig:human-designator))
        do (dolist (type (list keyword class (find-class class)
                               (intern (symbol-name keyword) '#:discrepancy-finder.tests)))
             (let ((designator (desig:make-designator type '((:type :x)))))
               (is (eq class (type-of designator)))
               (is (eq keyword (desig:designator-class-keyword designator))))))
  (desig:with-designators ((cup :object '((:type :cup)))
                           (place :location `((:of ,cup))))
    (is (eq cup (desig:desig-prop-value place :of)))))

(test designators-as-text
  (let ((designator (desig:an object (type cup) (name "Cup 1") (size (1 2))
                              (at (a location (near (the object (type plate))))))))
    (is (string= (concatenate 'string "#<A OBJECT (TYPE CUP) (NAME \"Cup 1\") (SIZE (1 2)) "
                              "(AT (A LOCATION (NEAR (THE OBJECT (TYPE PLATE)))))>")
                 (prin1-to-string designator)))
    (is (string= (concatenate 'string "(an object (type cup) (name Cup 1) (size (1 2)) "
                              "(at (a location (near (the object (type plate))))))")
                 (princ-to-string designator))))
  (is (string= "(a motion (pose 1.000 2.000 3.000) (arm nil))"
               (let ((?pose (geometry:make-pose 1 2 3)))
                 (princ-to-string (desig:a motion (pose ?pose) (arm nil))))))
  (is (string= "(a motion)" (princ-to-string (desig:a motion))))
  (is (string= "(a motion (v (1 . 2)))"
               (princ-to-string (desig:make-designator :motion '((:v (1 . 2)))))))
  (is (string= "#<A MOTION (V (1 . 2))>"
               (prin1-to-string (desig:make-designator :motion '((:v (1 . 2)))))))
  (let ((*print-circle* t)
        (object (desig:an object (type box))))
    (is (string= "(an action (object (an object (type box))))"
                 (princ-to-string (desig:make-designator :action `((:object ,object)))))))
  (let ((*print-right-margin* 20) (*print-pretty* t))
    (is (null (find #\Newline (prin1-to-string (desig:a motion (type going) (target place)
                                                         (speed 1) (direction forward))))))))

;;; Chains

(test equated-designators
  (let ((a (desig:a location (in kitchen)))
        (b (desig:a location (in kitchen)))
        (c (desig:a location (in cellar)))
        (d (desig:a location (in hall))))
    (is (not (desig:desig-equal a b)) "equal properties do not make designators equal")
    (is (desig:desig-equal a a))
    (is (eq b (desig:equate a b)))
    (desig:equate c d)
    (is (eq c (desig:equate a c)) "the younger chain goes behind the youngest")
    (is (equal (list a b c d) (desig:get-equal-designators c)))
    (dolist (member (list a b c d))
      (is (eq d (desig:current-desig member)))
      (is (eq a (desig:first-desig member)))
      (is (desig:desig-equal member b)))
    (is (eq c (desig:successor b)))
    (is (eq b (desig:parent c)))
    (is (null (desig:successor d)))
    (is (null (desig:parent a)))
    (signals-with (desig:designator-error "already equated" "(in kitchen)") (desig:equate a d))
    (signals desig:designator-error (desig:equate a a))
    (is (null (desig:newest-effective-designator b)))
    (setf (slot-value b 'desig:effective) t)
    (dolist (member (list a b c d))
      (is (eq b (desig:newest-effective-designator member)))))
  (is (null (desig:current-desig nil)))
  (is (null (desig:first-desig nil)))
  (is (null (desig:newest-effective-designator nil)))
  (is (null (desig:desig-equal nil nil)))
  (let* ((old (desig:a location (in kitchen)))
         (new (desig:make-designator :location '((:in :hall)) old)))
    (is (eq new (desig:current-desig old)))))

(defclass watched-designator (desig:object-designator)
  ((pairs :initform '() :accessor pairs))
  (:documentation "An object designator that notes what it is equated to."))

(defmethod desig:on-equate-designators progn ((successor desig:designator)
                                              (parent watched-designator))
  (push (cons successor parent) (pairs parent)))

(test equating-calls-the-hook
  (let ((parent (make-instance 'watched-designator :description '((:type :cup))))
        (successor (desig:an object (type cup))))
    (desig:equate parent successor)
    (is (equal (list (cons successor parent)) (pairs parent)))))

;;; New descriptions

(test descriptions-are-merged
  (let* ((old (desig:all object (type cup) (side left) (side right) (color red)))
         (copy (desig:copy-designator old :new-description '((:side :front) (:name x)))))
    (is (equal '((:type :cup) (:side :front) (:color :red) (:name x)) (desig:properties copy)))
    (is (eq :all (desig:quantifier copy)))
    (is (eq :object (desig:designator-class-keyword copy)))
    (is (not (desig:desig-equal old copy)))
    (is (equal (desig:properties old) (desig:properties (desig:copy-designator old))))
    (is (equal '((:a 1) (:b 3) (:b 4) (:c 5))
               (desig:merge-desig-descriptions '((:a 1) (:b 2) (:b 7)) '((:b 3) (:b 4) (:c 5)))))
    (is (equal '((:side :back) (:type :cup) (:color :red))
               (desig:update-designator-properties '((:side :back)) old)))
    (let ((extended (desig:extend-designator-properties old '((:name y) (:color :blue)))))
      (is (eq extended (desig:current-desig old)))
      (is (equal '((:name y) (:color :blue) (:type :cup) (:side :left) (:side :right))
                 (desig:properties extended))))))

(test effective-designators
  (let* ((parent (desig:an object (type cup)))
         (data (make-instance 'desig:object-designator-data
                              :object-identifier 'cup-1 :pose (geometry:make-pose 1 2 3)))
         (found (desig:make-effective-designator parent :data-object data :timestamp 7))
         (again (desig:make-effective-designator parent :new-properties '((:type :mug)))))
    (is (desig:effective found))
    (is (not (desig:effective parent)))
    (is (eql 7 (desig:timestamp found)))
    (is (realp (desig:timestamp again)))
    (is (equal '((:type :cup)) (desig:properties found)))
    (is (equal '((:type :mug)) (desig:properties again)))
    (is (eq again (desig:newest-effective-designator parent)))
    (is (eq data (desig:reference found)))
    (is (eq 'cup-1 (desig:object-identifier data)))
    (is (geometry:pose= (geometry:make-pose 1 2 3) (desig:object-pose data)))
    (is (null (find #\Newline (prin1-to-string data))))))

(test descriptions-are-matched
  (let ((designator (desig:an object (type cup) (side left) (side right)
                              (pose ((pose 1) (transform 2)))
                              (at (a location (in (an object (type box))))))))
    (flet ((matches (description) (desig:matches-description-p designator description)))
      (is-true (matches '()))
      (is-true (matches '((:side :right) (:type :cup))))
      (is-true (matches '((:pose ((:pose 1) (:transform 2))))))
      (is-false (matches '((:side :front))))
      (is-false (matches '((:pose ((:pose 1))))))
      (is-true (matches (desig:an object (at (a location (in (an object (type box))))))))
      (is-false (matches (desig:an object (at (a location (in (an object (type bag)))))))))))
