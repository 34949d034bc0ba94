;;;; Preconditions that speak of elements of the theory: what is learned, and from how much.
;;;;
;;;; Transitions are written by hand, in the words of the kitchen: which drawers are open when the
;;;; robot sets out, and where it gets.

(in-package #:discrepancy-finder.tests)

(in-suite edits)

(defun domain-of-bowl-and-spoon ()
  "Return the domain, without its plans: those of other suites have functions of the same names."
  (discrepancy:ensure-domain :bowl-and-spoon))

(defun going (place open-drawers &key from (report nil failed))
  "Return the transition of navigating to PLACE, from the place FROM, with OPEN-DRAWERS; it fails if
there is a REPORT."
  (let* ((domain (domain-of-bowl-and-spoon))
         (before (discrepancy::state-table
                  (loop for atom in (discrepancy::observed-atoms
                                     (discrepancy::domain-observers domain))
                        collect (cons atom
                                      (case (first atom)
                                        (:open (and (member (second atom) open-drawers) t))
                                        (:robot-at (eq (second atom) from))))))))
    (discrepancy::make-transition
     :class :motion :type :going :before before :after before
     :event (unless failed (list :navigate place)) :success (list :navigate place)
     :succeeded-p (not failed) :report (or report "")
     :failure (and failed 'navigation-low-level-failure)
     :outcomes (list (if failed 'navigation-low-level-failure :success)))))

(defun goings (count place open-drawers &rest options)
  (loop repeat count collect (apply #'going place open-drawers options)))

(defun required-for-going (transitions)
  "Return the conditions learned from TRANSITIONS, of which the first has failed, and the pattern."
  (multiple-value-list
   (discrepancy::constant-hypotheses (domain-of-bowl-and-spoon) transitions
                                     (first transitions))))

(test names-in-reports
  (flet ((named-p (text)
           (discrepancy::named-in-p :drawer-2 text)))
    (is-true (named-p "at its goal the robot would touch counter/drawer_2"))
    (is-true (named-p "DRAWER-20 and drawer-2."))
    (is-false (named-p "the robot would touch drawer-20"))
    (is-false (named-p "the-drawer-2"))
    (is-false (named-p ""))
    (is-false (discrepancy::named-in-p 2 "2 times"))))

(test patterns-with-elements
  (let ((theory (symbolic:action-theory-theory (domain-of-bowl-and-spoon))))
    (is (equal '(((:pick-up :?arm :?item) (:?arm :arm) (:?item :item))
                 ((:pick-up :left :?item) (:?item :item))
                 ((:pick-up :?arm :spoon) (:?arm :arm))
                 ((:pick-up :left :spoon)))
               (sort (discrepancy::patterns-for theory '(:pick-up :left :spoon)) #'>
                     :key (lambda (pattern)
                            (+ (* 2 (length pattern)) (count :left (first pattern))))))))
  (is (equal '(((:?item . :spoon)) t)
             (multiple-value-list
              (discrepancy::matching '(:pick-up :left :?item) '(:pick-up :left :spoon)))))
  (is (equal '(nil nil)
             (multiple-value-list
              (discrepancy::matching '(:pick-up :left :?item) '(:pick-up :right :spoon))))))

(test requirements-of-one-argument-leave-others-alone
  (flet ((revised (place)
           (symbolic::revised-outcomes
            `((:success (:navigate ,place) (:parked :left) ()))
            '(:navigate :before-table) '(:not (:open :drawer-2)) '(lost) :also)))
    (is (equal '((:success (:navigate before-table) (:and (:parked :left) (:not (:open :drawer-2)))
                  ())
                 (lost nil (:not (:not (:open :drawer-2))) ()))
               (revised 'before-table)))
    (is (equal '((:success (:navigate :start) (:parked :left) ())) (revised :start)))))

(test an-open-drawer-is-in-the-way
  (let* ((report "at its goal the robot would touch counter/drawer_2")
         (failures (goings 6 :before-workspace '(:drawer-2) :from :before-table :report report))
         (successes (goings 10 :before-workspace '(:drawer-3) :from :before-table))
         (elsewhere (goings 5 :before-table '(:drawer-2) :from :before-drawer-2)))
    (is (equal '((((:not (:open :drawer-2)))) (:navigate :before-workspace))
               (required-for-going (append failures successes elsewhere))))
    ;; Nothing is in its way anywhere: then it is no matter of the place.
    (is (equal '((((:not (:open :drawer-2)))) (:navigate :?place))
               (required-for-going (append failures successes))))
    ;; The report is a hint only: here it is another drawer.
    (is (equal '((((:not (:open :drawer-1)))) (:navigate :?place))
               (required-for-going
                (append (goings 6 :before-workspace '(:drawer-2 :drawer-1) :from :before-table
                                :report report)
                        (goings 10 :before-workspace '(:drawer-2) :from :before-table)
                        (goings 1 :before-workspace '() :from :before-table)))))
    ;; Too few runs, no success, or a success all the same.
    (is (equal '(nil) (required-for-going (append (subseq failures 0 1) successes))))
    (is (equal '(nil) (required-for-going failures)))
    (is (equal '(nil) (required-for-going
                       (append failures successes
                               (goings 1 :before-workspace '(:drawer-2) :from :before-table)
                               (goings 1 :before-workspace '() :from :before-table)))))))

(test runs-that-say-nothing-of-elements-count-for-nothing
  (is (= 1d0 (discrepancy::literal-chance 6 2 2)))
  (is (< (discrepancy::literal-chance 200 10 6) 0.03))
  (is (= 80d0 (discrepancy::literal-chance 80 0 30))))
