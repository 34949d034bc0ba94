;;;; Bowl and spoon: the bowl is lost on the way or an open drawer blocks the way, as physics has
;;;; it; the theory that takes both into account allows whatever happens.

(in-package #:discrepancy-finder.tests)

(def-suite bowl-and-spoon :in all)
(in-suite bowl-and-spoon)

(defparameter *leaving-open* 'discrepancy-finder-user::bowl-and-spoon)
(defparameter *closing* 'discrepancy-finder-user::bowl-and-spoon-closing)

(defun bowl-and-spoon (name)
  "Return the domain NAME, :bowl-and-spoon or :bowl-and-spoon-closing; load its plans, too."
  (discrepancy:ensure-plan *closing*)
  (discrepancy:ensure-domain name))

(defun bowl-and-spoon-exploration (plan domain)
  (df:explore-plan plan :domain (bowl-and-spoon domain) :constraint :successful-navigation))

(defun drawer-of-the-spoon (trace)
  (third (find :in (ec:state-fluents (symbolic:trace-initial-state trace)) :key #'first)))

(defun bowl-and-spoon-runs (plan domain trace count &rest parameters)
  "Return COUNT runs of PLAN from samples of TRACE, with the scene PARAMETERS; and the domain."
  (let ((domain (discrepancy:domain-with-parameters (bowl-and-spoon domain) parameters)))
    (values (loop for index below count
                  collect (discrepancy:execute-sample
                           domain plan
                           (discrepancy:draw-sample
                            (discrepancy:initial-parameters domain trace) 1 7 index)
                           :trace trace))
            domain)))

(defun judged (domain run trace)
  "Return the verdict on RUN by the theory of DOMAIN, the kind of the divergence, its event, and the
predicates of its fluents."
  (let* ((judgement (discrepancy:judge-run domain run trace))
         (divergence (discrepancy:judgement-divergence judgement)))
    (list* (discrepancy:judgement-verdict judgement)
           (when divergence
             (list (discrepancy:divergence-kind divergence)
                   (plan:desig-prop-value
                    (discrepancy:run-step-designator
                     (nth (discrepancy:divergence-step divergence) (discrepancy:run-steps run)))
                    :type)
                   (mapcar #'caar (discrepancy:divergence-fluents divergence)))))))

;;; What the theories have to say

(test the-spoon-is-in-one-of-three-drawers
  (let ((exploration (bowl-and-spoon-exploration *leaving-open* :bowl-and-spoon)))
    (is-true (df:exploration-complete-p exploration))
    (is (equal '(:drawer-1 :drawer-2 :drawer-3)
               (mapcar #'drawer-of-the-spoon (df:exploration-traces exploration))))
    (is (equal '(23 31 39)
               (loop for trace in (df:exploration-traces exploration)
                     collect (length (symbolic:trace-steps trace)))))))

(test an-object-that-may-be-lost-doubles-the-traces
  "With the spoon lost the plan ends at the table."
  (let ((exploration (bowl-and-spoon-exploration *closing* :bowl-and-spoon-closing)))
    (is-true (df:exploration-complete-p exploration))
    (is (equal '((:drawer-1 25) (:drawer-1 14) (:drawer-2 33) (:drawer-2 22)
                 (:drawer-3 41) (:drawer-3 30))
               (loop for trace in (df:exploration-traces exploration)
                     collect (list (drawer-of-the-spoon trace)
                                   (length (symbolic:trace-steps trace))))))))

(test an-open-drawer-before-the-workspace-ends-the-plan-that-knows-of-it
  "Of the plan that leaves the drawer open there is no longer a trace to the workspace with the
spoon in the middle drawer."
  (let ((exploration (bowl-and-spoon-exploration *leaving-open* :bowl-and-spoon-closing)))
    (is-true (df:exploration-complete-p exploration))
    (is (equal '((:drawer-1 2) (:drawer-1 1) (:drawer-2 1) (:drawer-3 2) (:drawer-3 1))
               (loop for trace in (df:exploration-traces exploration)
                     collect (list (drawer-of-the-spoon trace)
                                   (count :before-table
                                          (remove :navigate (symbolic:trace-steps trace)
                                                  :test-not #'eq
                                                  :key (lambda (step)
                                                         (first (symbolic:step-event step))))
                                          :key (lambda (step)
                                                 (second (symbolic:step-event step))))))))))

(test nothing-is-wrong-in-the-theory-that-has-learnt
  "What is open at first is where the spoon is."
  (let ((findings (df:check-theory (symbolic:action-theory-theory
                                    (bowl-and-spoon :bowl-and-spoon-closing))
                                   :horizon 11)))
    (is (= 1 (length findings)))
    (is (search "(in spoon drawer-1)" (df:finding-text (first findings))))))

;;; What the world has to say

(test an-open-drawer-blocks-the-way-to-the-workspace
  (let ((trace (second (df:exploration-traces
                        (bowl-and-spoon-exploration *leaving-open* :bowl-and-spoon)))))
    (multiple-value-bind (runs domain)
        (bowl-and-spoon-runs *leaving-open* :bowl-and-spoon trace 3)
      (dolist (run runs)
        (is (equal '(:discrepancy :outcome :going (:robot-at :robot-at))
                   (judged domain run trace)))
        (is (eq 'plan:navigation-pose-unreachable
                (discrepancy:run-step-outcome (first (last (discrepancy:run-steps run))))))))))

(test the-bowl-is-lost-on-the-way-if-the-grip-is-weak
  "The weakest grip that the scene allows loses the bowl at the door sill.  The theory that has
learnt from it allows that the bowl is lost, and that it is carried."
  (let ((trace (first (df:exploration-traces
                       (bowl-and-spoon-exploration *leaving-open* :bowl-and-spoon))))
        (verdicts '()))
    (loop for (force friction) in '((15 0.4) (35 0.6))
          do (multiple-value-bind (runs domain)
                 (bowl-and-spoon-runs *leaving-open* :bowl-and-spoon trace 3
                                      :grip-force force :finger-friction friction)
               (dolist (run runs)
                 (push (judged domain run trace) verdicts)
                 (is (equal '(:consistent)
                            (judged (bowl-and-spoon :bowl-and-spoon-closing) run trace))))))
    (is (equal '((:consistent) (:discrepancy :state :going (:holding)))
               (remove-duplicates verdicts :test #'equal)))))

(test with-drawers-closed-and-losses-allowed-nothing-is-found
  (dolist (trace (df:exploration-traces
                  (bowl-and-spoon-exploration *closing* :bowl-and-spoon-closing)))
    (multiple-value-bind (runs domain)
        (bowl-and-spoon-runs *closing* :bowl-and-spoon-closing trace (if *long* 60 1))
      (dolist (run runs)
        (is (eq :valid (discrepancy:run-validity run)))
        (is (equal '(:consistent) (judged domain run trace)))))))

(test a-drawer-that-was-opened-stays-open
  "The hand does not take the drawer along when it leaves the handle, whatever arm it belongs to and
wherever the robot stands."
  (bowl-and-spoon :bowl-and-spoon)
  (loop for (arm x y height) in '((:left -1.14 -0.05 0.3) (:left -1.1 -0.2 0.3)
                                  (:right -1.06 0.2 0.3) (:right -1.08 -0.2 0.3))
        do (with-kitchen (projection)
             (let ((?pose (geometry:make-pose x y 0 :yaw 3.13)))
               (plan:perform (plan:a motion (type going) (pose ?pose))))
             (funcall 'discrepancy-finder-user::lift-torso height)
             (funcall 'discrepancy-finder-user::open-the-drawer :drawer-2 arm)
             (is (< 0.39 (projection:observed-joint projection "drawer_2_joint"))
                 "~(~a~) arm, robot at ~a ~a" arm x y))))

(defun spoon-fetched (index)
  "Take the spoon out of drawer 1 and close that, with tolerances and places drawn for INDEX.
Return what the robot holds then and how far (m) the drawer is open."
  (flet ((place (draw low high) (drawn "parts" index draw low high)))
    (with-kitchen (projection
                   :parameters (drawn-tolerances "parts" index)
                   :poses (list :robot (geometry:make-pose (place 50 -0.8 -0.7)
                                                           (place 51 -0.05 0.05) 0
                                                           :yaw (place 52 3.09 3.19))
                                :spoon (geometry:make-pose (place 1 -2.14 -2.1)
                                                           (+ -0.6 (place 2 -0.03 0.03)) 0.6105
                                                           :yaw (place 3 1.47 1.67))
                                :bowl (geometry:make-pose (place 4 -2.15 -2.05)
                                                          (place 5 -0.4 -0.3) 0.8835
                                                          :yaw (place 6 -0.5 0.5))))
      (funcall 'discrepancy-finder-user::park-the-arm :left)
      (funcall 'discrepancy-finder-user::park-the-arm :right)
      (funcall 'discrepancy-finder-user::take-the-spoon nil)
      (list (projection:held-items projection)
            (projection:observed-joint projection "drawer_1_joint")))))

(test no-tolerance-hinders-the-arms-at-a-drawer
  "With 64 an arm planned a way that grazed the drawer, and stopped on it; with 214 a contact was
seen where two bodies were 4 mm apart."
  (bowl-and-spoon :bowl-and-spoon-closing)
  (loop for index in (append '(64 214) (when *long* (alexandria:iota 300)))
        for (held opening) = (spoon-fetched index)
        do (is (equal '((:left . :spoon)) held) "~a: ~a" index held)
           (is (< opening 1d-3) "~a: ~a" index opening)))

;;; Searches

(defun found-kind (seed)
  "Return the action and the fluent, or the failure, in which the search with SEED finds theory and
simulation to part, and the number of its iterations."
  (let* ((result (df:find-discrepancies *leaving-open* :domain (bowl-and-spoon :bowl-and-spoon)
                                        :constraint :successful-navigation :confidence 0.99
                                        :seed seed))
         (discrepancy (df:result-discrepancy result)))
    (list (rest (judged (discrepancy:discrepancy-domain discrepancy)
                        (df:discrepancy-run discrepancy) (df:discrepancy-trace discrepancy)))
          (df:result-iterations result))))

(test searches-find-both-kinds
  "Of 20 searches 14 certify the trace with the spoon in the first drawer and find in the next one
that the way is blocked; 6 find before that the bowl is lost."
  (if *long*
      (let ((kinds (loop for seed from 1 to 20 collect (found-kind seed))))
        (is (subsetp kinds '(((:state :going (:holding)) 1)
                             ((:outcome :going (:robot-at :robot-at)) 2))
                     :test #'equal))
        (is (< 1 (count 1 kinds :key #'second) 15)))
      (is (equal '((:state :going (:holding)) 1) (found-kind 8)))))

(test the-modified-plan-is-certified
  "Twenty searches find nothing; by :SOUND each takes 917 simulations."
  (if *long*
      (loop for seed from 1 to 20
            do (dolist (rule '(:paper :sound))
                 (let ((result (df:find-discrepancies
                                *closing* :domain (bowl-and-spoon :bowl-and-spoon-closing)
                                :constraint :successful-navigation :confidence 0.99 :rule rule
                                :seed seed :budget 10000)))
                   (is (eq :certified (df:result-status result)) "~(~a~), seed ~d: ~a" rule seed
                       (df:result-text result)))))
      (skip "Only the long run tests this.")))

(test what-blocks-the-way-is-named
  "The theory gets a precondition that speaks of the drawer, if there are runs enough that tell."
  (let* ((discrepancy (df:result-discrepancy
                       (df:find-discrepancies *leaving-open*
                                              :domain (bowl-and-spoon :bowl-and-spoon)
                                              :constraint :successful-navigation
                                              :confidence 0.99 :seed 2)))
         (explanation (discrepancy:explain-discrepancy discrepancy :max-runs 5))
         (edit (first (discrepancy:explanation-edits explanation)))
         (edited (discrepancy:edited-domain (discrepancy:discrepancy-domain discrepancy) edit)))
    (is (eq :requirement (discrepancy:edit-kind edit)))
    (is (search "event (navigate before-workspace), requires (not (open drawer-2)); else it ends in"
                (discrepancy:edit-text edit)))
    (is-true (discrepancy:edit-removes-p edit))
    (is (zerop (discrepancy:edit-contradicted edit)))
    (is (eq :may-fail (discrepancy:edit-kind
                       (second (discrepancy:explanation-edits explanation))))
        "what leaves nothing open is preferred")
    (z3:with-context (context)
      (is (null (discrepancy::first-divergence edited (discrepancy:discrepancy-run discrepancy)
                                               context))))
    ;; One failure alone is separated from others by many things.
    (is (equal '(:may-fail)
               (mapcar #'discrepancy:edit-kind
                       (discrepancy:explanation-edits
                        (discrepancy:explain-discrepancy discrepancy :max-runs 0)))))))
