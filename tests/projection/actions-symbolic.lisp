;;;; Tests of the plans of mobile manipulation under symbolic execution: an action without a binding
;;;; is entered through its plan, down to the designators that the theory knows.

(in-package #:discrepancy-finder.tests)

(def-suite actions :in all)
(in-suite actions)

(defparameter *pantry-theory* "
(define-theory pantry
  (:sorts (thing cup) (place counter table))
  (:fluents (on thing place) (robot-at place) (looking-at place) (held thing) (stuck place)
            (hidden thing) (slippery thing))
  (:events (go place) (look place) (detect thing) (pick-up thing) (put thing place))
  (:axioms
   (cup-begins-on-the-counter (initially (on cup counter)))
   (robot-begins-at-the-table (initially (robot-at table)))
   (looks-nowhere (initially (not (looking-at ?place))))
   (holds-nothing (initially (not (held ?thing))))
   (going-arrives (initiates (go ?place) (robot-at ?place) ?time))
   (going-leaves (implies (/= ?place1 ?place2)
                          (terminates (go ?place1) (robot-at ?place2) ?time)))
   (looking-points (initiates (look ?place) (looking-at ?place) ?time))
   (looking-turns (implies (/= ?place1 ?place2)
                           (terminates (look ?place1) (looking-at ?place2) ?time)))
   (picking-up-holds (initiates (pick-up ?thing) (held ?thing) ?time))
   (picking-up-takes (terminates (pick-up ?thing) (on ?thing ?place) ?time))
   (putting-moves (initiates (put ?thing ?place) (on ?thing ?place) ?time))
   (putting-releases (terminates (put ?thing ?place) (held ?thing) ?time))))
(define-state-constraint delivered (?time)
  (and (happens (put cup table) ?time) (holds-at (on cup table) (+ ?time 1))))
(define-state-constraint anything (?time)
  (exists (?place) (holds-at (robot-at ?place) ?time)))
")

(defparameter *pantry-actions* "
(defun place-of (thing)
  (typecase thing
    (location-designator
     (let ((inner (or (desig-prop-value thing :location) (desig-prop-value thing :object))))
       (or (desig-prop-value thing :on) (and inner (place-of inner)))))
    (object-designator (place-of (desig-prop-value thing :location)))))
(define-action (motion going) (target)
  (:domain pantry)
  (:event (go (place-of target)))
  (:requires (not (stuck (place-of target))))
  (:failure navigation-pose-unreachable))
(define-action (motion looking) (target)
  (:domain pantry)
  (:event (look (place-of target))))
(define-action (motion detecting) (object)
  (:domain pantry)
  (:event (detect (desig-prop-value object :type)))
  (:requires (not (hidden (desig-prop-value object :type))))
  (:failure perception-object-not-found)
  (:returns (let ((?type (desig-prop-value object :type)))
              (an object (type ?type) (location (a location (on counter)))))))
(define-action (action picking-up) (object)
  (:domain pantry)
  (:event (pick-up (desig-prop-value object :type)))
  (:requires (not (slippery (desig-prop-value object :type))))
  (:failure gripper-closed-completely))
(define-action (action placing) (object target)
  (:domain pantry)
  (:event (put (desig-prop-value object :type) (place-of target))))
")

(defun explore-pantry (text constraint)
  "Define the plan in TEXT, which is named pantry-plan, and explore it."
  (with-file (file *pantry-theory*)
    (symbolic:register-action-theory
     (make-instance 'symbolic:action-theory :name :pantry :theory (ec:load-theory file))))
  (with-file (file *pantry-actions*)
    (plan:load-plan file))
  (with-file (file text)
    (plan:load-plan file)
    (symbolic:explore-plan 'discrepancy-finder-user::pantry-plan
                           :domain :pantry :constraint constraint)))

(defparameter *transporting-the-cup* "
(def-top-level-cram-function pantry-plan ()
  (perform (an action (type transporting)
               (object (an object (type cup)))
               (location (a location (on counter)))
               (target (a location (on table))))))")

(defparameter *finding-the-cup* '((:success :go :counter) (:success :look :counter)))

(defparameter *trying-to-grasp* '((:success :look :counter) (:success :detect :cup)))

(defparameter *getting-the-cup*
  (append *finding-the-cup* '((:success :detect :cup) (:success :go :counter))))

(test an-unbound-action-is-entered-through-its-plan
  "The plan of transporting goes through those of searching, fetching and delivering."
  (let ((exploration (explore-pantry *transporting-the-cup* 'delivered)))
    (is-true (symbolic:exploration-complete-p exploration))
    (is (equal (list (append *getting-the-cup* *trying-to-grasp*
                             '((:success :pick-up :cup) (:success :go :table)
                               (:success :look :table) (:success :put :cup :table))))
               (step-lists exploration)))))

(test failures-are-tried-again-and-become-those-of-actions
  "What the theory lets fail the plans of the actions try again as often as CRAM's."
  (flet ((steps-to (failure)
           "Return the steps of the paths of the plan that end with FAILURE."
           (remove :put (step-lists
                         (explore-pantry (format nil "
(def-top-level-cram-function pantry-plan ()
  (with-failure-handling
      ((~a () (perform (a motion (type looking) (target (a location (on table))))) (return)))
    (perform (an action (type transporting)
                 (object (an object (type cup)))
                 (location (a location (on counter)))
                 (target (a location (on table)))))))" failure)
                                         'anything))
                   :key (lambda (steps) (second (alexandria:lastcar steps)))))
         (ended (&rest parts)
           (append (apply #'append parts) '((:success :look :table)))))
    (is (alexandria:set-equal
         (list (ended '((plan:navigation-pose-unreachable)))
               (ended *finding-the-cup*
                      (loop repeat 5 collect '(plan:perception-object-not-found))))
         (remove '(:success :look :table) (steps-to "object-nowhere-to-be-found")
                 :key #'alexandria:lastcar :test-not #'equal)
         :test #'equal)
        "there is no way to the counter, or the cup is hidden")
    (is (member (ended *getting-the-cup*
                       *trying-to-grasp* '((plan:gripper-closed-completely))
                       *trying-to-grasp* '((plan:gripper-closed-completely)))
                (steps-to "object-unfetchable") :test #'equal)
        "the cup is slippery")
    (is (member (ended *getting-the-cup* *trying-to-grasp*
                       '((:success :pick-up :cup) (plan:navigation-pose-unreachable)))
                (steps-to "object-undeliverable") :test #'equal)
        "there is no way to the table")))

(test a-grounding-of-the-user-wins
  (unwind-protect
       (is (equal '(((:success :look :table)))
                  (step-lists (explore-pantry "
(def-fact-group pantry-groundings (action-grounding)
  (<- (action-grounding ?action (look-only ?target))
    (desig-prop ?action (:type :transporting))
    (desig-prop ?action (:target ?target))))
(def-cram-function look-only (?target)
  (perform (a motion (type looking) (target ?target))))
(def-top-level-cram-function pantry-plan ()
  (perform (an action (type transporting)
               (object (an object (type cup)))
               (location (a location (on counter)))
               (target (a location (on table))))))" 'anything))))
    (eval '(prolog:def-fact-group discrepancy-finder-user::pantry-groundings ())))
  (let ((?cup (plan:an object (type cup))))
    (is (eq 'projection::perceive
            (first (plan:reference (plan:an action (type detecting) (object ?cup))))))
    (is-false (discrepancy-finder.designators:user-grounded-p
               (plan:an action (type detecting) (object ?cup))))))
