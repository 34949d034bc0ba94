;;;; The classical scenarios of the event calculus, with the answers that the literature gives.
;;;;
;;;; Each scenario is a file of tests/theories/ in Lisp and one in the language of the Discrete
;;;; Event Calculus Reasoner, written independently; their headers name the source and say why there
;;;; are as many models.  DEFINE-SCENARIO states the number of models, formulas that hold in all of
;;;; them, and formulas that hold in some and not in others.  The models of the two files, and of
;;;; what is printed of each in the language of the second, are compared as sets of texts.

(in-package #:discrepancy-finder.tests)

(def-suite scenarios :in all)
(in-suite scenarios)

;;; Shooting, stealing, riding

(define-scenario yale-shooting 1
  :always ((holds-at (loaded) 2) (holds-at (alive turkey) 2)
           (not (holds-at (loaded) 3)) (not (holds-at (alive turkey) 3))))

(define-scenario dead-or-alive 1
  :always ((not (holds-at (dead sam) 2)) (holds-at (dead sam) 3) (not (holds-at (alive sam) 3))))

(define-scenario russian-turkey 2
  :always ((holds-at (loaded) 2) (not (holds-at (loaded) 4)) (released-at (loaded) 3)
           (iff (holds-at (loaded) 3) (not (holds-at (alive turkey) 4)))
           (iff (holds-at (alive turkey) 4) (holds-at (alive turkey) 5)))
  :sometimes ((holds-at (alive turkey) 4)))

(define-scenario stolen-car 1
  :always ((happens (steal) 1) (not (happens (steal) 0)) (not (happens (park) 1))))

(define-scenario bus-ride 1
  :always ((happens (board-red) 1) (not (happens (board-yellow) 1)) (holds-at (has-ticket) 1)))

;;; Derived fluents

(define-scenario stuffy-room 1
  :always ((not (holds-at (stuffy) 1)) (holds-at (stuffy) 2) (holds-at (stuffy) 3)))

(define-scenario happy 1
  :always ((not (holds-at (happy fred) 0)) (not (holds-at (happy fred) 1))
           (holds-at (happy fred) 2)))

(define-scenario carrying-a-book-1 1
  :always ((holds-at (in-room book living-room) 1) (holds-at (in-room book kitchen) 2)
           (not (holds-at (in-room book living-room) 2)) (holds-at (in-room book kitchen) 3)
           (not (holds-at (holding nathan book) 3))))

(define-scenario carrying-a-book-2 1
  :always ((released-at (in-room book kitchen) 2) (holds-at (in-room book kitchen) 2)
           (not (released-at (in-room book kitchen) 3)) (holds-at (in-room book kitchen) 4)
           (not (holds-at (in-room book living-room) 4))))

(define-scenario carrying-a-book-3 1
  :always ((released-at (in-room book kitchen) 0) (not (released-at (in-room nathan kitchen) 0))
           (holds-at (in-room book living-room) 0) (holds-at (in-room book kitchen) 1)
           (holds-at (in-room book kitchen) 3)))

;;; Non-deterministic effects

(define-scenario chess-board 3
  :always ((or (holds-at (on-black) 2) (holds-at (on-white) 2)))
  :sometimes ((holds-at (on-black) 2) (holds-at (on-white) 2)
              (and (holds-at (on-black) 2) (holds-at (on-white) 2))))

(define-scenario coin-tosses 8
  :always ((holds-at (heads coin1) 1))
  :sometimes ((holds-at (heads coin1) 2) (holds-at (heads coin1) 3) (holds-at (heads coin1) 4)
              (and (holds-at (heads coin1) 2) (not (holds-at (heads coin1) 3))
                   (holds-at (heads coin1) 4))))

(define-scenario coin-tosses-unfixed 8
  :sometimes ((holds-at (its-heads) 0) (holds-at (heads) 2) (holds-at (heads) 3)))

(define-scenario roulette-four 4
  :always ((exists (?number) (holds-at (ball-on wheel1 ?number) 1)))
  :sometimes ((holds-at (ball-on wheel1 7) 1) (holds-at (ball-on wheel1 8) 1)
              (holds-at (ball-on wheel1 9) 2) (holds-at (ball-on wheel1 10) 2)))

(define-scenario roulette-three 3
  :sometimes ((holds-at (ball-on wheel1 0) 2) (holds-at (ball-on wheel1 1) 2)
              (holds-at (ball-on wheel1 2) 2)))

(define-scenario running-and-driving-1 1
  :always ((happens (run james bookstore) 0) (not (happens (drive james bookstore) 0))
           (holds-at (at james bookstore) 1) (not (holds-at (at james home) 1))))

(define-scenario running-and-driving-2 2
  :always ((iff (happens (run james bookstore) 0) (holds-at (tired james) 1))
           (iff (happens (run james bookstore) 0) (not (happens (drive james bookstore) 0))))
  :sometimes ((holds-at (tired james) 1)))

;;; Concurrent events

(define-scenario supermarket-trolley 1
  :always ((not (holds-at (spinning) 5)) (holds-at (spinning) 6) (holds-at (spinning) 12)
           (forall (?time) (not (or (holds-at (forwards) ?time) (holds-at (backwards) ?time))))))

(define-scenario supermarket-trolley-conjectures 1
  :always ((holds-at (forwards) 1)
           (holds-at (backwards) 2) (not (holds-at (forwards) 2))
           (holds-at (spinning) 3) (not (holds-at (forwards) 3)) (not (holds-at (backwards) 3))))

(define-scenario bowl 1
  :always ((holds-at (raised bowl) 1) (not (holds-at (spilt bowl) 1))))

(define-scenario approve 1
  :always ((holds-at (confused child) 1) (not (holds-at (glad child) 1))
           (not (holds-at (sad child) 1)) (not (holds-at (confused mother) 1))))

(define-scenario camera-with-flash 1
  :always ((holds-at (black-picture camera1) 1) (not (holds-at (good-picture camera1) 1))
           (holds-at (good-picture camera1) 2)))

(define-scenario pat-head-rub-stomach 0)

(define-scenario moving-robot 1
  :always ((holds-at (location robot1 2 0) 1) (holds-at (direction robot1 1) 2)
           (holds-at (location robot1 2 1) 3) (holds-at (direction robot1 1) 3)
           (not (holds-at (location robot1 1 0) 3))))

;;; Continuous change

(define-scenario kitchen-sink 1
  :always ((happens (overflow) 15)
           (forall (?time) (implies (happens (overflow) ?time) (= ?time 15)))
           (holds-at (water-level 0) 5) (holds-at (water-level 1) 6) (holds-at (water-level 10) 15)
           (not (holds-at (filling) 16)) (holds-at (spilling) 16)
           (holds-at (water-level 10) 25) (holds-at (spilling) 25)))

(define-scenario kitchen-sink-conjectures 1
  :always ((holds-at (water-level 1) 1) (holds-at (water-level 2) 2) (holds-at (water-level 3) 3)
           (not (holds-at (water-level 0) 1))
           (holds-at (filling) 1) (holds-at (filling) 2) (holds-at (filling) 3)
           (not (happens (overflow) 2)) (happens (overflow) 3) (not (happens (overflow) 4))
           (not (holds-at (filling) 4)) (holds-at (spilling) 4) (holds-at (water-level 3) 4)
           (not (holds-at (water-level 4) 4))))

(define-scenario falling-object 1
  :always ((holds-at (height apple 2) 1) (holds-at (height apple 1) 2) (holds-at (height apple 0) 3)
           (happens (hit-ground apple) 3) (not (happens (hit-ground apple) 4))
           (holds-at (falling apple) 3) (not (holds-at (falling apple) 4))
           (holds-at (height apple 0) 5) (not (released-at (height apple 0) 4))))

(define-scenario falling-object-anti-trajectory 1
  :always ((holds-at (height apple 2) 1) (holds-at (height apple 1) 2) (holds-at (height apple 0) 3)
           (happens (hit-ground apple) 3) (not (happens (hit-ground apple) 4))
           (holds-at (falling apple) 3) (not (holds-at (falling apple) 4))
           (holds-at (height apple 0) 5)))

(define-scenario leaf-quadratic 1
  :always ((holds-at (height leaf 8) 1) (holds-at (height leaf 5) 2) (holds-at (height leaf 0) 3)
           (happens (hit-ground leaf) 3) (not (holds-at (falling leaf) 4))))

(define-scenario leaf-linear 1
  :always ((holds-at (height leaf 4) 2) (holds-at (height leaf 3) 3) (holds-at (height leaf 1) 5)
           (happens (hit-ground leaf) 6)
           (forall (?time) (implies (happens (hit-ground leaf) ?time) (= ?time 6)))))

(define-scenario hot-air-balloon 1
  :always ((holds-at (height montgolfier 1) 1) (holds-at (height montgolfier 2) 2)
           (holds-at (height montgolfier 1) 3) (not (holds-at (height montgolfier 3) 3))))

(define-scenario hot-air-balloon-truncated 16
  :always ((holds-at (height 1) 1) (holds-at (height 2) 2))
  :sometimes ((holds-at (height 0) 3) (holds-at (height 2) 4)
              (exists (?height) (holds-at (height ?height) 3))))

;;; Indirect effects in circuits

(define-scenario shanahan-circuit 1
  :always ((holds-at (lit lamp) 2) (holds-at (activated relay1) 2) (happens (open s2) 2)
           (not (holds-at (closed s2) 3)) (holds-at (lit lamp) 3) (not (holds-at (lit lamp) 4))
           (not (holds-at (activated relay1) 4)) (not (holds-at (lit lamp) 5))))

(define-scenario thielscher-circuit-delays 1
  :always ((holds-at (lit) 2) (holds-at (lit) 3) (not (holds-at (lit) 4))
           (not (holds-at (closed s2) 3)) (holds-at (activated) 5)))

(define-scenario thielscher-circuit-causal 1
  :always ((happens (activate relay1) 0) (happens (open s2) 0)
           (holds-at (activated relay1) 1) (not (holds-at (closed s2) 1))
           (forall (?time) (not (holds-at (lit lamp) ?time)))
           (forall (?time) (not (happens (light lamp) ?time)))))

(define-scenario thielscher-circuit-shanahan 1
  :always ((happens (relay-on) 0) (happens (open2) 0) (holds-at (relay) 1)
           (not (holds-at (switch2) 1)) (holds-at (relay) 3)
           (forall (?time) (not (holds-at (light) ?time)))))

;;; Triggered events

(define-scenario alarm-clock 1
  :always ((forall (?time) (iff (happens (start-beeping clock1) ?time) (= ?time 2)))
           (not (holds-at (beeping clock1) 2)) (holds-at (beeping clock1) 3)
           (not (holds-at (beeping clock1) 4)) (not (holds-at (alarm-time clock1 0) 1))))

(define-scenario snooze-alarm 1
  :always ((holds-at (beeping clock1) 2) (not (holds-at (beeping clock1) 3))
           (happens (start-beeping clock1) 4) (holds-at (beeping clock1) 5)
           (not (holds-at (beeping clock1) 6)) (not (happens (start-beeping clock1) 6))))

(define-scenario bank-account-service-fee 1
  :always ((holds-at (balance account1 2) 1) (holds-at (balance account2 4) 1)
           (happens (charge-service-fee account1) 1) (not (happens (charge-service-fee account1) 2))
           (holds-at (balance account1 1) 3) (happens (charge-service-fee account1) 3)
           (holds-at (balance account1 0) 4)
           (forall (?time) (not (happens (charge-service-fee account2) ?time)))))

(define-scenario workflow 1
  :always ((happens (end a) 1) (happens (start b) 2) (happens (start c) 2) (happens (end b) 3)
           (happens (end c) 4) (not (happens (start d) 4)) (happens (start d) 5)
           (not (happens (start d) 6)) (happens (start e) 7) (holds-at (completed e) 9)
           (forall (?time) (not (happens (start f) ?time)))))

(define-scenario counter 1
  :always ((holds-at (count counter1 3) 3) (not (holds-at (overflown counter1) 3))
           (holds-at (count counter1 0) 4) (holds-at (overflown counter1) 4)
           (holds-at (count counter1 1) 5) (holds-at (count counter1 0) 6)
           (not (holds-at (count counter1 1) 6))))

(define-scenario telephone 1
  :always ((holds-at (dial-tone phone1) 1) (holds-at (ringing phone1 phone2) 2)
           (not (holds-at (idle phone2) 2)) (holds-at (connected phone1 phone2) 3)
           (holds-at (idle phone1) 4) (holds-at (disconnected phone2) 4)
           (holds-at (idle phone2) 5) (not (holds-at (busy-signal phone1) 5))))

(define-scenario commuter 1
  :always ((journey 3 5) (not (journey 0 5)) (holds-at (at-work) 6)
           (not (holds-at (travelling) 2))))

;;; Minds, plans, animals

(define-scenario teacher-tells 1
  :always ((holds-at (know ann fractions) 1) (not (holds-at (know ben fractions) 1))))

(define-scenario hungry-cat 1
  :always ((happens (add-plan cat (b-satiated cat) p1) 0) (happens (jump cat floor chair) 1)
           (not (happens (jump cat chair shelf) 2))
           (not (holds-at (believe cat (b-can-jump chair shelf)) 2))
           (happens (drop-plan cat (b-satiated cat) p1) 2)
           (happens (add-plan cat (b-satiated cat) p1a) 3) (happens (jump cat chair table) 4)
           (happens (eat cat food2) 5) (holds-at (satiated cat) 6)
           (holds-at (on food1 shelf) 7) (not (holds-at (on food2 table) 7))
           (not (holds-at (plan cat (b-satiated cat) p1a) 7))))

(define-scenario monkey-planning 1
  :always ((happens (walk l3) 0) (happens (push-box l2) 1) (happens (climb-on) 2)
           (happens (grasp-bananas) 3) (holds-at (at bananas l2) 4)))

(define-scenario monkey-prediction 1
  :always ((holds-at (at monkey l2) 2) (holds-at (at box l2) 2) (holds-at (at bananas l2) 2)))

(define-scenario monkey-postdiction 1
  :always ((holds-at (at box l3) 0) (holds-at (at box l2) 2)))

(define-scenario zoo-one-step 6
  :always ((not (happens (close keeper gate1) 0)) (not (happens (move keeper p2) 0))
           (done-by (open keeper gate1) keeper) (not (done-by (open keeper gate1) elephant))
           (not (done-by (move keeper p2) elephant)))
  :sometimes ((happens (open keeper gate1) 0) (holds-at (at elephant p2) 1)
              (holds-at (at keeper p4) 1)))

(define-scenario zoo-two-steps 35
  :always ((not (holds-at (at elephant p4) 2))
           (implies (holds-at (at elephant p3) 2) (happens (open keeper gate1) 0)))
  :sometimes ((holds-at (at elephant p3) 2) (holds-at (at keeper p2) 2)
              (happens (close keeper gate1) 1)))

(define-scenario zoo-plan 1
  :always ((happens (open keeper gate1) 0) (happens (move elephant p2) 0)
           (happens (move keeper p4) 1) (happens (move elephant p3) 1)))

(define-scenario children-playing 1
  :always ((holds-at (soccer) 0) (holds-at (sunny) 0) (holds-at (computer-game) 1)
           (not (holds-at (outside) 1)) (not (holds-at (win jilly) 1))))

;;; Defaults

(define-scenario broken-device 1
  :always ((ab1 television 0) (not (ab1 radio 0)) (not (holds-at (on television) 1))
           (holds-at (on radio) 1)))

(define-scenario erratic-device 2
  :always ((iff (ab1 device1 0) (not (holds-at (on device1) 1))))
  :sometimes ((holds-at (on device1) 1)))

(define-scenario cancellation-of-state-default 1
  :always ((holds-at (employed kim) 0) (not (holds-at (employed kim) 1))
           (holds-at (employed lou) 0) (holds-at (employed lou) 1)))

(define-scenario cancellation-by-default 1
  :always ((holds-at (on new-one) 1) (not (holds-at (on old-one) 1)) (holds-at (on mended-one) 1)
           (not (ab1 mended-one 0)) (not (ab2 old-one 0))))

(define-scenario cancellation-by-default-one-label 4
  :always ((iff (ab1 old-one 0) (not (ab2 old-one 0))) (holds-at (on mended-one) 1))
  :sometimes ((holds-at (on old-one) 1) (ab1 old-one 1)))

(define-scenario default-location 1
  :always ((holds-at (in-room television living-room) 0) (holds-at (on television) 1)
           (not (holds-at (in-room radio living-room) 0)) (not (holds-at (on radio) 1))))

(define-scenario default-event 1
  :always ((happens (ring clock1) 3) (happens (wake-up ann) 3) (not (holds-at (asleep ann) 4))
           (forall (?time) (not (happens (ring clock2) ?time))) (holds-at (asleep ben) 4)))

(define-scenario nixon-diamond-1 0)

(define-scenario nixon-diamond-2 1
  :always ((not (pacifist nixon)) (ab1 nixon) (not (ab2 nixon))))

;;; Inconsistencies

(define-scenario inconsistency-1 0)
(define-scenario inconsistency-2 0)
(define-scenario inconsistency-3 0)
(define-scenario inconsistency-4 0)

(test every-scenario-file-is-tested
  (let ((tests (mapcar #'symbol-name (fiveam:test-names))))
    (dolist (file (append (uiop:directory-files (root-file "tests/theories/") "*.lisp")
                          (uiop:directory-files (root-file "tests/theories/") "*.e")))
      (is (member (format nil "SCENARIO-~:@(~a~)" (pathname-name file)) tests :test #'string=)
          "~a has no test" file))))
