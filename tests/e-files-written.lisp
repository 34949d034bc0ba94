;;;; Theories written as .e files, and models as the Discrete Event Calculus Reasoner prints them.

(in-package #:discrepancy-finder.tests)

(in-suite e-files)

;;; Writing

(defparameter *all-of-the-language* "
load foundations/Root.e
load foundations/EC.e
load foundations/DEC.e
load foundations/ECTraj.e
load foundations/ECCausal.e
option encoding 3
option modeldiff on
option renaming off
option solver relsat
sort object
sort agent: object
sort agent: thing
sort thing
sort height: integer
sort itemType
reified sort belief
agent Nathan, Gun2
thing! Nathan
thing Cup
itemType A1
belief BOn(object,thing), None
predicate Ab1(agent,time), Plain()
predicate Clipped2(fluent)
function Distance(agent,agent): height
fluent Alive(agent), Raised(), Believes(belief), Height(thing,height)
event Load(agent), Shoot(agent,agent)
noninertial Raised
manualrelease Alive, Height
mutex Load, Shoot
xor Alive, Raised
Distance(Nathan,Gun2)=3.
Distance(Gun2,Nathan)=Distance(Nathan,Gun2)+1.
[agent,time] !HoldsAt(Alive(agent),time) -> Terminates(Load(agent),Raised(),time).
Theta: [agent,time] HoldsAt(Believes(BOn(agent,Cup)),time) & agent!=Nathan -> Ab1(agent,time).
Delta: Happens(Load(Nathan),0).
[fluent,time] Started(fluent,time) & Clipped(0,fluent,time) -> Clipped2(fluent).
completion Theta Ab1
completion Delta Happens
range height -1 4
range time 0 5
range offset 1 3
"
  "Every kind of statement.")

(test round-trip
  (let* ((theory (ec:parse-e-text *all-of-the-language*))
         (again (ec:parse-e-text (e-text theory))))
    (is (equal (theory-parts theory) (theory-parts again)))
    (is (string= (e-text theory) (e-text again)))))

(test round-trip-of-random-sentences
  "Random trees of connectives, comparisons and arithmetic come back as they were."
  (let ((state (sb-ext:seed-random-state 11)) (wrong 0))
    (labels ((pick (&rest choices) (nth (random (length choices) state) choices))
             (term (depth)
               (if (or (zerop depth) (zerop (random 3 state)))
                   (pick :?n :?n1 0 3 -2 '(:f :?n1))
                   (list (pick :+ :- :* :/ :mod) (term (1- depth)) (term (1- depth)))))
             (formula (depth)
               (if (zerop depth)
                   (pick '(:p) '(:q) '(:t :c) '(:u :?n 3)
                         (list (pick := :/= :< :<= :> :>=) (term 2) (term 2)))
                   (flet ((part () (formula (random depth state))))
                     (ecase (random 6 state)
                       (0 (list :not (part)))
                       (1 (list* (pick :and :or) (part) (part) (pick '() (list (part)))))
                       (2 (list (pick :implies :iff) (part) (part)))
                       ((3 4) (list (pick :and :or) (part) (part)))
                       (5 (list (pick :forall :exists) (pick '(:?n2) '(:?thing :?n2)) (part))))))))
      (dotimes (i 500)
        (let* ((base (e-theory ""))
               (formula (formula 5))
               (axiom (ec::make-axiom :name :a :formula (ec::strip-quantifiers formula)))
               (theory (ec:make-checked-theory
                        :name :random :syntax :e
                        :sorts (ec:theory-sorts base) :predicates (ec:theory-predicates base)
                        :functions (ec:theory-functions base) :axioms (list axiom)))
               (again (ec:parse-e-text (e-text theory))))
          (unless (equal (ec:axiom-formula axiom)
                         (ec:axiom-formula (first (ec:theory-axioms again))))
            (incf wrong)
            (fail "~s~%was written as ~a" formula (e-text theory))))))
    (is (zerop wrong))))

;;; Theories in Lisp

(ec:define-theory e-files-household
  "A theory in Lisp,
in which names need other names."
  (:sorts (small-box (:parent box) r1)
          (box r-1 grip)
          (|Item| a)
          (item b)
          (shelf-level (:range 0 2))
          (belief (:terms (is-on box item))))
  (:predicates (ab-1 box time))
  (:functions ((size-of box) shelf-level))
  (:fluents (in-gripper box) (raised) (load) (level-of item shelf-level) (believes belief))
  (:non-inertial-fluents (warm))
  (:manual-release raised)
  (:events (pick-up box) (unload) (put-down))
  (:axioms
   (begins (initially (and (raised) (not (exists (?box) (in-gripper ?box))))))
   (implies (and (holds-at (raised) ?time)
                 (or (/= ?box r1) (< (size-of ?box) (- 2 (- 1 (mod 3 2))))))
            (initiates (pick-up ?box) (in-gripper ?box) ?time))
   (puts (terminates (put-down) (in-gripper ?small-box1) ?time))
   (odd :label theta-x (implies (exists (?item) (holds-at (level-of ?item 1) ?time))
                                (ab-1 grip ?time)))
   (warm-iff-raised (iff (holds-at (warm) ?time) (holds-at (raised) ?time)))
   (only-one (implies (and (happens ?event1 ?time) (happens ?event2 ?time))
                      (= ?event1 ?event2))))
  (:facts (known (or (happens (pick-up r-1) 0) (happens (unload) 1)))
          (= (size-of r1) 1) (= (size-of r-1) 2) (= (size-of grip) 0))
  (:narrative (happens (unload) 1) (not (holds-at (load) 0)))
  (:completion happens (theta-x ab-1))
  (:mutex (pick-up put-down))
  (:time 0 2))

(defun household ()
  (ec:find-theory 'e-files-household))

(test theories-in-lisp-are-written
  (is (string= (e-text (household))
               "; Theory e-files-household: A theory in Lisp,
; in which names need other names.

load foundations/Root.e
load foundations/EC.e

sort box
sort smallbox: box
sort item
sort itemx
sort shelflevel: integer
reified sort belief
box R12, Grip
smallbox R1
item A
itemx B
belief IsOn(box,itemx)
predicate Ab1(box,time)
function SizeOf(box): shelflevel
fluent InGripper(box)
fluent Raised()
fluent Load()
fluent LevelOf(itemx,shelflevel)
fluent Believes(belief)
fluent Warm()
event PickUp(box)
event Unload()
event PutDown()
noninertial Warm
manualrelease Raised
mutex PickUp, PutDown

; begins
HoldsAt(Raised(),0) & !{box} HoldsAt(InGripper(box),0).
[time,box]
HoldsAt(Raised(),time) & (box!=R1 | SizeOf(box)<2-(1-3%2)) ->
Initiates(PickUp(box),InGripper(box),time).
; puts
[smallbox1,time] Terminates(PutDown(),InGripper(smallbox1),time).
; odd
ThetaX: [time] ({itemx} HoldsAt(LevelOf(itemx,1),time)) -> Ab1(Grip,time).
; warm-iff-raised
[time] HoldsAt(Warm(),time) <-> HoldsAt(Raised(),time).
; only-one
Delta: [event1,time,event2] Happens(event1,time) & Happens(event2,time) -> event1=event2.
; known
Happens(PickUp(R12),0) | Happens(Unload(),1).
SizeOf(R1)=1.
SizeOf(R12)=2.
SizeOf(Grip)=0.
Delta: Happens(Unload(),1).
!HoldsAt(Load(),0).
completion Delta Happens
completion ThetaX Ab1

range shelflevel 0 2
range time 0 2
")))

(defun models-text (theory)
  (with-output-to-string (stream)
    (ec:print-e-models (ec:models theory :limit nil) stream)))

(defun texts-of-models (text)
  "Return the sorted list of the models in TEXT, each without its number."
  (let ((models '()))
    (dolist (line (uiop:split-string text :separator '(#\Newline)) (sort models #'string<))
      (cond ((uiop:string-prefix-p "model " line) (push "" models))
            ((uiop:string-suffix-p line " models"))
            (models (setf (first models) (format nil "~a~a~%" (first models) line)))))))

(test written-theories-have-the-same-models
  (let* ((text (models-text (household)))
         (models (texts-of-models text)))
    (is (< 1 (length models)))
    (is (equal models (texts-of-models (models-text (ec:parse-e-text (e-text (household)))))))))

(test names-of-theories-in-lisp
  (flet ((names (&rest elements)
           (let ((text (e-text (ec:make-checked-theory
                                :name :names
                                :sorts (list (ec::make-element-sort :name :thing
                                                                    :constants elements))))))
             (subseq text (+ 6 (search "thing " text :from-end t))
                     (search (format nil "~%") text :start2 (search "thing " text :from-end t))))))
    (is (string= "PickUp, PickUp2, PickUp3" (names :pick-up :pick-up2 :pick_up))
        "the second one is called so by itself")
    (is (string= "Pickup, PickUp" (names :pickup :pick-up)))
    (is (string= "R1, R12, R13" (names :r1 :r-1 :r--1)))
    (is (string= "Nathan, NathanB, X3dBox, X, X2" (names :|Nathan| :|nathanB| :3d-box :* :**)))
    (is (string= "Happens2, Not" (names :happens :not)) "the predicates keep their names")))

(test sorts-of-theories-in-lisp
  (let ((text (e-text (ec:make-checked-theory
                       :name :names
                       :sorts (mapcar (lambda (name) (ec::make-element-sort :name name))
                                      '(:item-type :itemtype :item_type :range :a-1x))))))
    (is-true (search "sort itemtype
sort itemtypex
sort itemtypexx
sort rangex
sort a1x
" text))))

(test gradual-and-causal-theories-load-their-foundations
  (flet ((written (axiom)
           (e-text (ec:make-checked-theory
                    :name :foundations :fluents '((:lit) (:high)) :events '((:go))
                    :extends (list (ec:find-theory :causal-constraints))
                    :axioms (list (ec::make-axiom :name :a :formula axiom))))))
    (let ((text (written '(:trajectory (:lit) :?time (:high) :?offset))))
      (is-true (search "load foundations/ECTraj.e" text))
      (is-true (search "load foundations/ECCausal.e" text))
      (is (null (search "predicate" text)))
      (is-true (search "[time,offset] Trajectory(Lit(),time,High(),offset)." text)))
    (let ((text (written '(:implies (:started (:lit) :?time) (:happens (:go) :?time)))))
      (is (null (search "ECTraj" text)))
      (is-true (search "[time] Started(Lit(),time) -> Happens(Go(),time)." text)))))

(test what-cannot-be-written
  (flet ((theory (label)
           (ec:make-checked-theory
            :name :strange :events '((:go)) :completions '((nil :happens) (:theta :happens))
            :axioms (list (ec::make-axiom :name :seen :label ec::+facts+
                                          :formula '(:happens (:go) 0))
                          (ec::make-axiom :name :done :label label
                                          :formula '(:happens (:go) 1))
                          (ec::make-axiom :name :other :label :theta :formula '(:= 1 1))))))
    (is-true (search "Delta: Happens(Go(),1)." (e-text (theory nil))))
    (signals-with (ec:e-file-error "Theory strange cannot be written" "axiom done" "happens")
      (e-text (theory :theta)))))

(test saving
  (with-e-files (folder ("Old.e" "predicate Old()"))
    (let ((file (concatenate 'string folder "Old.e")))
      (is (equal (truename file) (ec:save-e-theory (household) file)))
      (is (string= (e-text (household)) (uiop:read-file-string file)))
      (signals ec:e-file-error
        (ec:save-e-theory (ec:make-checked-theory
                           :name :unwritable
                           :events '((:go)) :completions '((nil :happens) (:theta :happens))
                           :axioms (list (ec::make-axiom :name :a :label ec::+facts+
                                                         :formula '(:happens (:go) 0))
                                         (ec::make-axiom :name :b :label :theta
                                                         :formula '(:happens (:go) 1))))
                          file))
      (is (string= (e-text (household)) (uiop:read-file-string file)) "the old file is left alone")
      (is (= 1 (length (uiop:directory-files folder))) "no temporary file is left")))
  (with-e-files (folder ("odd [folder]/Old.e" ""))
    (uiop:with-current-directory ((uiop:parse-native-namestring folder))
      (ec:save-e-theory (household) "odd [folder]/*.e")
      (is (equal (theory-parts (ec:parse-e-text (e-text (household))))
                 (theory-parts (ec:read-e-theory "odd [folder]/*.e")))))))

;;; Models

(defparameter *yale* "
sort agent, gun
agent Nathan, Turkey
gun Gun1
fluent Alive(agent), Loaded(gun), Happy()
event Load(gun), Shoot(agent,agent,gun), Sneeze()
predicate Ab(agent), Dead(agent,time)
noninertial Happy
[gun,time] Initiates(Load(gun),Loaded(gun),time).
[agent1,agent2,gun,time] HoldsAt(Loaded(gun),time) ->
Terminates(Shoot(agent1,agent2,gun),Alive(agent2),time).
[gun,time,agent1,agent2] Terminates(Shoot(agent1,agent2,gun),Loaded(gun),time).
[agent] HoldsAt(Alive(agent),0). !HoldsAt(Loaded(Gun1),0).
[agent,time] Dead(agent,time) <-> !HoldsAt(Alive(agent),time).
[time] HoldsAt(Happy(),time).
Ab(Turkey). Ab(Nathan).
Happens(Load(Gun1),0). Happens(Sneeze(),1).
Happens(Shoot(Nathan,Turkey,Gun1),2). Happens(Sneeze(),2).
completion Happens
range time 0 3
")

(test models-are-printed
  (is (string= "model 1:
0
Alive(Nathan).
Alive(Turkey).
Happy().
Happens(Load(Gun1), 0).
1
+Loaded(Gun1).
Happens(Sneeze(), 1).
2
Happens(Shoot(Nathan, Turkey, Gun1), 2).
Happens(Sneeze(), 2).
3
-Alive(Turkey).
-Loaded(Gun1).
P
Ab(Nathan).
Ab(Turkey).
Dead(Turkey, 3).
ReleasedAt(Happy(), 0).
ReleasedAt(Happy(), 1).
ReleasedAt(Happy(), 2).
ReleasedAt(Happy(), 3).
1 models
" (models-text (ec:parse-e-text *yale*))))
  (is (string= "0 models
" (models-text (ec:parse-e-text (concatenate 'string *yale* "!Ab(Turkey).")))))
  (let ((text (models-text (ec:parse-e-text "fluent A(), B()
noninertial A, B
range time 0 1
[time] HoldsAt(A(),time) | HoldsAt(B(),time)."))))
    (is-true (uiop:string-prefix-p (format nil "model 1:~%0~%") text))
    (is-true (search (format nil "~%model 9:~%0~%") text))
    (is-true (uiop:string-suffix-p text (format nil "~%9 models~%")))))

(test models-of-theories-in-lisp-have-e-names
  (let ((text (models-text (household))))
    (is-true (search "Ab1(Grip, 0)." text))
    (is-true (search "Happens(Unload(), 1)." text))
    (is (null (search "R-1" text)))))

(test saving-by-name
  (with-file (file "")
    (ec:define-theory saved-by-name "A fluent." (:fluents (shining)))
    (is (equal (truename file) (ec:save-e-theory 'saved-by-name file)))
    (is (equal '((:|Shining|)) (ec:theory-fluents (ec:read-e-theory file)))))
  (is (search "there is no folder"
              (report-of 'source:source-error
                         (lambda ()
                           (ec:save-e-theory 'saved-by-name "/no-such-folder/x.e"))))))
