;;;; From a theory in which no action has an effect to the one written by hand: along the plans of
;;;; the two regions, and by comparing all that can happen.

(in-package #:discrepancy-finder.tests)

(def-suite refinement :in all)
(in-suite refinement)

(defparameter *box-plans*
  '(discrepancy-finder-user::move-the-box discrepancy-finder-user::two-regions-there-and-back
    discrepancy-finder-user::two-regions-in-vain)
  "The plans that exercise the two regions.")

(defun refined (plans &rest options &key (domain :two-regions-minimal) (budget 200)
                &allow-other-keys)
  (apply #'discrepancy:refine-theory plans :domain (discrepancy:ensure-domain domain)
                                           :budget budget
         (alexandria:remove-from-plist options :domain :budget)))

;;; What plans can produce in a domain

(defun fluents-of-state (state)
  (sort (mapcar #'ec:atom-text (ec:state-fluents state)) #'string<))

(defun produced (plan domain)
  "Return all that PLAN can produce in DOMAIN: lists of the states on a trace, its events, and
whether they are successes."
  (sort (loop for trace in (symbolic:exploration-traces
                            (df:explore-plan plan :domain domain :constraint :any-action
                                                  :traces :every-state))
              collect (list (mapcar #'fluents-of-state (symbolic:trace-states trace))
                            (loop for step in (symbolic:trace-steps trace)
                                  collect (list (symbolic:step-event step)
                                                (eq :success (symbolic:step-outcome step))))))
        #'string< :key #'prin1-to-string))

;;; What can happen in a theory at all

(defun successor-of (domain fluents history event)
  "Return the true fluents after EVENT, which follows the events HISTORY from the state in which
FLUENTS are true, or :FORBIDDEN."
  (let ((states (symbolic:states-along
                 (symbolic:action-theory-ground domain) fluents
                 (loop for event in (append history (list event))
                       collect (symbolic:make-trace-step :event event)))))
    (if states
        (fluents-of-state (first (last states)))
        :forbidden)))

(defun all-transitions (domain initial-states)
  "Return (state event next-state-or-:forbidden) for every state that can be reached from
INITIAL-STATES, lists of true fluents, and every event of the theory of DOMAIN."
  (let ((reached (make-hash-table :test 'equal))
        (agenda (loop for fluents in initial-states collect (list fluents '())))
        (transitions '()))
    (loop while agenda
          do (destructuring-bind (fluents history) (pop agenda)
               (loop with state = (if history
                                      (successor-of domain fluents (butlast history)
                                                    (first (last history)))
                                      (sort (mapcar #'ec:atom-text fluents) #'string<))
                     initially (when (gethash state reached) (loop-finish))
                               (setf (gethash state reached) t)
                     for event across (ec:ground-theory-events
                                       (symbolic:action-theory-ground domain))
                     for next = (successor-of domain fluents history event)
                     do (push (list state event next) transitions)
                        (unless (eq next :forbidden)
                          (push (list fluents (append history (list event))) agenda)))))
    (sort transitions #'string< :key #'prin1-to-string)))

(defparameter *start-of-example-1* '((:robot-in :r1) (:box-in :r2))
  "The initial state of Example 1.")

(defun agrees-with-the-hand-written-p (refinement)
  (let ((domain (discrepancy:refinement-domain refinement)))
    (and (every (lambda (plan) (equal (produced plan domain) (produced plan (two-regions))))
                *box-plans*)
         (equal (all-transitions domain (list *start-of-example-1*))
                (all-transitions (two-regions) (list *start-of-example-1*))))))

(test the-comparison-tells-theories-apart
  (let ((minimal (discrepancy:ensure-domain :two-regions-minimal)))
    (mapc #'discrepancy:ensure-plan *box-plans*)
    (dolist (plan *box-plans*)
      (is (produced plan minimal))
      (is (not (equal (produced plan minimal) (produced plan (two-regions))))))
    ;; Without effects there is one state; by hand there are those where the box is held and not.
    (is (= 5 (length (all-transitions minimal (list *start-of-example-1*)))))
    (is (= (* 5 6) (length (all-transitions (two-regions) (list *start-of-example-1*)))))))

(test refinement-arrives-at-the-theory-written-by-hand
  (let ((refinement (refined *box-plans*)))
    (is (eq :refined (discrepancy:refinement-status refinement)))
    (is (agrees-with-the-hand-written-p refinement))
    (is (every (lambda (step)
                 (let ((edit (discrepancy:refinement-step-edit step)))
                   (and (discrepancy:edit-removes-p edit)
                        (zerop (discrepancy:edit-contradicted edit)))))
               (discrepancy:refinement-steps refinement)))
    (is (every (lambda (result) (eq :certified (discrepancy:result-status result)))
               (discrepancy:refinement-results refinement)))
    (is (search (discrepancy:refinement-text refinement)
                (uiop:read-file-string (root-file "docs/refinement.md")))
        "docs/refinement.md does not show:~%~a" (discrepancy:refinement-text refinement))))

(test refinement-arrives-whatever-comes-first
  (let ((refinement (refined (reverse *box-plans*) :seed 3)))
    (is (eq :refined (discrepancy:refinement-status refinement)))
    (is (agrees-with-the-hand-written-p refinement))))

(test a-plan-teaches-only-what-it-exercises
  (let ((refinement (refined 'discrepancy-finder-user::move-the-box)))
    (is (eq :refined (discrepancy:refinement-status refinement)))
    (is (equal (produced 'discrepancy-finder-user::move-the-box
                         (discrepancy:refinement-domain refinement))
               (produced 'discrepancy-finder-user::move-the-box (two-regions))))
    (is (not (agrees-with-the-hand-written-p refinement)))))

(test refinement-of-a-good-theory-changes-nothing
  (let ((refinement (refined 'discrepancy-finder-user::move-the-box :domain :two-regions)))
    (is (eq :refined (discrepancy:refinement-status refinement)))
    (is (null (discrepancy:refinement-steps refinement)))
    (is (eq (two-regions) (discrepancy:refinement-domain refinement)))))

(test refinement-is-bounded
  (let ((refinement (refined *box-plans* :edits 2)))
    (is (eq :undecided (discrepancy:refinement-status refinement)))
    (is (= 2 (length (discrepancy:refinement-steps refinement))))
    (is (search "2 edits were not enough" (discrepancy:refinement-reason refinement))))
  (signals discrepancy:invalid-argument (refined *box-plans* :edits -1)))

;;; All initial states: the regions a little apart, so that no item lies where it can be reached
;;; from the other region, and one that is in the robot's own always can.

(defun domain-apart (name extended)
  "Return the domain NAME like the one named EXTENDED, with a strip between the regions, and with no
initial state but that nothing is held."
  (let ((theory (symbolic:action-theory-theory (discrepancy:ensure-domain extended))))
    (ec:register-theory
     (ec:make-checked-theory :name name
                             :extends (list (ec:revised-theory
                                             theory
                                             :without '(:robot-starts-in-r1 :box-starts-in-r2)))))
    (symbolic:register-action-theory
     (discrepancy::parse-abstraction name `((:extends ,extended) (:theory ,name)
                                            (:region r1 (interval :x 0 0.95))
                                            (:region r2 (interval :x 1.05 2)))))))

(test refinement-from-every-initial-state
  (mapc #'discrepancy:ensure-plan *box-plans*)
  (let* ((minimal (domain-apart :two-regions-apart-minimal :two-regions-minimal))
         (by-hand (domain-apart :two-regions-apart :two-regions))
         (plans '(discrepancy-finder-user::two-regions-there-and-back
                  discrepancy-finder-user::two-regions-from-the-middle))
         (refinement (refined plans :domain minimal :parameters '(:reach 0.66)))
         (domain (discrepancy:refinement-domain refinement))
         (initial-states (loop for robot in '(:r1 :r2)
                               append (loop for box in '(:r1 :r2)
                                            collect `((:robot-in ,robot) (:box-in ,box))))))
    (is (eq :refined (discrepancy:refinement-status refinement)))
    (dolist (plan plans)
      (is (= 4 (length (produced plan by-hand))))
      (is (equal (produced plan by-hand) (produced plan domain))))
    (is (equal (all-transitions by-hand initial-states) (all-transitions domain initial-states)))))
