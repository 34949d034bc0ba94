;;;; The kitchen's theory: each of its 59 sentences is needed.
;;;;
;;;; A SCENARIO is a sentence's name, a narrative (these events happen, one a timepoint, and no
;;;; others), a formula, and whether the theory allows it then.  The theory without the sentence
;;;; must say the contrary.

(in-package #:discrepancy-finder.tests)

(def-suite kitchen-theory :in all)
(in-suite kitchen-theory)

(defun kitchen-theory-file ()
  (asdf:system-relative-pathname "discrepancy-finder" "models/kitchen/theory.lisp"))

(defun kitchen-theory-form ()
  (first (source:read-source (kitchen-theory-file)
                             :package '#:discrepancy-finder.event-calculus)))

(defun kitchen-axioms ()
  "Return the axioms of the kitchen's theory, each (name formula)."
  (rest (find :axioms (kitchen-theory-form)
              :key (lambda (clause) (and (consp clause) (first clause))))))

(defun kitchen-variant-form (narrative without)
  "Return the form that defines what KITCHEN-THEORY returns."
  (append '(ec::define-theory ec::kitchen-variant)
          (loop for clause in (cddr (kitchen-theory-form))
                collect (if (and (consp clause) (eq (first clause) :axioms))
                            (remove-if (lambda (axiom)
                                         (and (consp axiom) (string= (first axiom) without)))
                                       clause)
                            clause))
          `((:completion ec::happens)
            (:narrative ,@(loop for event in narrative
                                for time from 0
                                collect `(ec::happens ,event ,time))))))

(defun kitchen-theory (narrative &key (without '()))
  "Return the kitchen's theory without the axiom WITHOUT, in which the events of NARRATIVE happen,
one a timepoint, and no others."
  (with-file (file (with-standard-io-syntax
                     (let ((*package* (find-package '#:discrepancy-finder.event-calculus)))
                       (prin1-to-string (kitchen-variant-form narrative without)))))
    (ec:load-theory file)))

(defparameter *kitchen-narratives*
  '(:at-the-workspace ((navigate before-workspace) (look surface-view) (detect cereal)
                       (move-torso high) (open-gripper left))
    :cereal-in-hand (:at-the-workspace (pick-up left cereal))
    :carrying (:cereal-in-hand (park left))
    :at-the-table (:carrying (navigate before-table))
    :delivered (:at-the-table (put-down left cereal))
    :at-a-drawer ((navigate before-drawer-1) (open-drawer right drawer-1))
    :spoon-in-hand (:at-a-drawer (look drawer-view) (detect spoon) (open-gripper left)
                    (pick-up left spoon)))
  "Beginnings of narratives, by name.")

(defun kitchen-narrative (parts)
  "Return the list of events that PARTS, events and names of narratives, stand for."
  (loop for part in parts
        append (if (keywordp part)
                   (kitchen-narrative (getf *kitchen-narratives* part))
                   (list part))))

(defparameter *kitchen-scenarios*
  '((surfaces-have-places () (serves start workspace) nil)
    (drawers-have-places () (fronts start drawer-1) nil)
    (near-is-before-its-surface-or-drawer () (holds-at (near cereal) 0) nil)
    (visible-is-near-in-view-and-not-shut-in () (holds-at (visible cereal) 0) nil)
    (reachable-is-near-at-the-right-height-and-not-shut-in () (holds-at (reachable cereal) 0) nil)
    (held-is-in-some-hand () (holds-at (held cereal) 0) nil)
    (free-is-without-an-item () (not (holds-at (free left) 0)) nil)
    (robot-at-one-place () (holds-at (robot-at before-table) 0) nil)
    (camera-faces-one-view () (holds-at (facing surface-view) 0) nil)
    (torso-at-one-height () (holds-at (torso-at high) 0) nil)
    (item-on-one-surface () (holds-at (on cereal table) 0) nil)
    (item-in-one-drawer () (and (holds-at (in spoon drawer-1) 0) (holds-at (in spoon drawer-2) 0))
                        nil)
    (item-on-a-surface-or-in-a-drawer () (holds-at (in cereal drawer-1) 0) nil)
    (robot-starts-at-its-start () (not (holds-at (robot-at start) 0)) nil)
    (camera-starts-ahead () (not (holds-at (facing ahead) 0)) nil)
    (torso-starts-low () (not (holds-at (torso-at low) 0)) nil)
    (arms-start-parked () (not (holds-at (parked left) 0)) nil)
    (grippers-start-closed () (holds-at (gripper-open left) 0) nil)
    (hands-start-empty () (holds-at (holding left cereal) 0) nil)
    (drawers-start-closed () (holds-at (open drawer-1) 0) nil)
    (spoon-starts-in-a-drawer () (forall (?drawer) (not (holds-at (in spoon ?drawer) 0))) nil)
    (others-start-on-the-workspace () (not (holds-at (on cereal workspace) 0)) nil)
    (nothing-detected-yet () (holds-at (detected cereal) 0) nil)
    (nothing-delivered-yet () (holds-at (delivered cereal) 0) nil)
    (navigate-arrives ((navigate before-table)) (holds-at (robot-at before-table) 1) t)
    (navigate-leaves ((navigate before-table)) (holds-at (robot-at before-table) 1) t)
    (navigate-forgets (:at-the-workspace (navigate before-table)) (holds-at (detected cereal) 6)
                      nil)
    (navigate-needs-parked-arms (:cereal-in-hand (navigate before-table))
                                (holds-at (robot-at before-table) 7) nil)
    (look-faces ((navigate before-workspace) (look surface-view))
                (holds-at (facing surface-view) 2) t)
    (look-turns-away ((navigate before-workspace) (look surface-view))
                     (holds-at (facing surface-view) 2) t)
    (look-at-a-surface-before-it ((look surface-view)) (holds-at (facing surface-view) 1) nil)
    (look-into-a-drawer-before-it ((look drawer-view)) (holds-at (facing drawer-view) 1) nil)
    (detect-finds (:at-the-workspace) (holds-at (detected cereal) 3) t)
    (detect-needs-sight ((detect cereal)) (holds-at (detected cereal) 1) nil)
    (torso-moves ((move-torso high)) (holds-at (torso-at high) 1) t)
    (torso-leaves ((move-torso high)) (holds-at (torso-at high) 1) t)
    (gripper-opens ((open-gripper left)) (holds-at (gripper-open left) 1) t)
    (open-gripper-needs-a-free-hand (:cereal-in-hand (open-gripper left))
                                    (holds-at (gripper-open left) 7) nil)
    (park-parks (:cereal-in-hand (park left)) (holds-at (parked left) 7) t)
    (park-closes-the-gripper ((open-gripper left) (park left)) (holds-at (gripper-open left) 2) nil)
    (pick-up-holds (:cereal-in-hand) (holds-at (holding left cereal) 6) t)
    (pick-up-lifts-off (:cereal-in-hand) (holds-at (on cereal workspace) 6) nil)
    (pick-up-takes-out (:spoon-in-hand) (holds-at (in spoon drawer-1) 6) nil)
    (pick-up-closes-the-gripper (:cereal-in-hand) (holds-at (gripper-open left) 6) nil)
    (pick-up-stretches-the-arm (:cereal-in-hand) (holds-at (parked left) 6) nil)
    (pick-up-needs-reach ((navigate before-workspace) (look surface-view) (detect cereal)
                          (open-gripper left) (pick-up left cereal))
                         (holds-at (holding left cereal) 5) nil)
    (pick-up-needs-detection ((navigate before-workspace) (move-torso high) (open-gripper left)
                              (pick-up left cereal))
                             (holds-at (holding left cereal) 4) nil)
    (pick-up-needs-an-open-gripper ((navigate before-workspace) (look surface-view) (detect cereal)
                                    (move-torso high) (pick-up left cereal))
                                   (holds-at (holding left cereal) 5) nil)
    (put-down-releases (:delivered) (holds-at (holding left cereal) 9) nil)
    (put-down-onto-the-surface-here (:delivered) (holds-at (on cereal table) 9) t)
    (put-down-on-the-table-delivers (:delivered) (holds-at (delivered cereal) 9) t)
    (put-down-opens-the-gripper (:delivered) (holds-at (gripper-open left) 9) t)
    (put-down-needs-the-item (:at-the-table (put-down right cereal)) (holds-at (on cereal table) 9)
                             nil)
    (put-down-needs-a-surface (:carrying (navigate start) (put-down left cereal))
                              (not (holds-at (holding left cereal) 9)) nil)
    (drawer-opens (:at-a-drawer) (holds-at (open drawer-1) 2) t)
    (open-drawer-from-before-it ((open-drawer left drawer-1)) (holds-at (open drawer-1) 1) nil)
    (open-drawer-needs-a-free-hand (:carrying (navigate before-drawer-1)
                                    (open-drawer left drawer-1))
                                   (holds-at (open drawer-1) 9) nil)
    (drawer-closes (:at-a-drawer (close-drawer left drawer-1)) (holds-at (open drawer-1) 3) nil)
    (close-drawer-from-before-it (:at-a-drawer (navigate before-drawer-2)
                                  (close-drawer left drawer-1))
                                 (not (holds-at (open drawer-1) 4)) nil))
  "A list of (sentence narrative formula allowed).")

(defun scenario-answer (scenario &key without)
  "Return whether the theory, perhaps WITHOUT a sentence, allows the formula of SCENARIO."
  (destructuring-bind (sentence parts formula allowed) scenario
    (declare (ignore sentence allowed))
    (let ((narrative (kitchen-narrative parts)))
      (and (ec:possible-p (kitchen-theory narrative :without without) formula
                          :horizon (length narrative))
           t))))

(test the-kitchen-theory-has-the-papers-size
  (let ((theory (ec:load-theory (kitchen-theory-file))))
    (is (equal '(7 2 16 10 59) (ec:theory-counts theory)))
    (is (string= "#<THEORY kitchen: 7 sorts, 2 predicates, 16 fluents, 10 events, 59 axioms>"
                 (princ-to-string theory)))))

(test every-sentence-of-the-kitchen-has-a-scenario
  (is (equal (mapcar (lambda (axiom) (symbol-name (first axiom))) (kitchen-axioms))
             (mapcar (lambda (scenario) (symbol-name (first scenario))) *kitchen-scenarios*))))

(test every-sentence-of-the-kitchen-is-needed
  (dolist (scenario *kitchen-scenarios*)
    (let ((sentence (first scenario)) (allowed (fourth scenario)))
      (is (eq allowed (scenario-answer scenario)) "~(~a~): the theory" sentence)
      (is (eq (not allowed) (scenario-answer scenario :without sentence))
          "~(~a~): without it the theory says the same" sentence))))

(test nothing-is-wrong-in-the-kitchen-theory
  "What is open at first is where the spoon is."
  (let ((findings (ec:check-theory (ec:load-theory (kitchen-theory-file)) :horizon 9)))
    (is (= 1 (length findings)))
    (finding-words (first findings) "(in spoon drawer-1)" "(in spoon drawer-3)" "at 0")))
