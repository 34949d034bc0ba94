;;;; Plan 1 of the paper's evaluation: what goes wrong when the table is set.

(in-package #:discrepancy-finder.tests)

(def-suite setting-the-table :in all)
(in-suite setting-the-table)

(defun kitchen-search (&rest options)
  "Search for discrepancies along the plan SETTING-THE-TABLE."
  (apply #'discrepancy:find-discrepancies 'discrepancy-finder-user::setting-the-table
         :domain :kitchen :constraint :successful-navigation :confidence 0.99d0
         :shrink nil :explain nil options))

(defun initial-drawer (trace)
  "Return the drawer in which the spoon is in the beginning of TRACE."
  (find-if (lambda (drawer)
             (ec:fluent-value (symbolic:trace-initial-state trace) (list :in :spoon drawer)))
           '(:drawer-1 :drawer-2 :drawer-3)))

(test setting-the-table-has-a-trace-for-each-drawer
  (let* ((exploration (symbolic:explore-plan
                       (plan:plan-name (discrepancy:ensure-plan
                                        'discrepancy-finder-user::setting-the-table))
                       :domain (discrepancy:ensure-domain :kitchen)
                       :constraint :successful-navigation))
         (traces (symbolic:exploration-traces exploration)))
    (is (symbolic:exploration-complete-p exploration))
    (is (equal '(:drawer-1 :drawer-2 :drawer-3) (mapcar #'initial-drawer traces)))
    ;; Each further drawer is gone to, opened, looked into and closed.
    (is (equal '(47 55 63) (mapcar (lambda (trace) (length (symbolic:trace-steps trace)))
                                   traces)))
    (let ((parameters (discrepancy:initial-parameters (discrepancy:ensure-domain :kitchen)
                                                      (third traces))))
      (let ((y (find "spoon.y" parameters :key #'discrepancy:parameter-name :test #'string=)))
        (is (< (abs (- 0.57d0 (discrepancy:parameter-min y))) 1d-9))
        (is (< (abs (- 0.63d0 (discrepancy:parameter-max y))) 1d-9))))))

(test an-object-is-lost-on-the-way-to-the-table
  "Of 300 samples of the three traces 84 end so, and none in another discrepancy."
  (loop for seed from 1 to (if *long* 100 3)
        for result = (kitchen-search :seed seed)
        for discrepancy = (discrepancy:result-discrepancy result)
        do (is (equal '(:navigate :holding)
                      (and discrepancy (discrepancy:discrepancy-kind discrepancy)))
               "seed ~d: ~a" seed result)
           (is (and discrepancy (discrepancy:discrepancy-confirmed-p discrepancy)))))

(test a-firm-grip-sets-the-table
  "With the firmest grip of the scene nothing is lost, and there is nothing else to find."
  (let ((result (kitchen-search :parameters '(:grip-force 35d0 :finger-friction 0.6d0)
                                :budget (if *long* 300 9))))
    (is (null (discrepancy:result-discrepancies result)))
    (is (every (lambda (trace) (zerop (discrepancy::trace-result-left-trace trace)))
               (discrepancy:result-traces result)))))

(test the-table-is-set
  "The plan as a whole: at its end everything stands on the table."
  (let ((run (discrepancy:run-plan 'discrepancy-finder-user::setting-the-table
                                   :domain :kitchen
                                   :state '((:robot :x -0.75 :y 0) (:bowl :x -2.1 :y -0.35)
                                            (:cereal :x -2.1 :y 0.32) (:milk :x -2.14 :y 0.02)
                                            (:spoon :x -2.12 :y 0.6))
                                   :parameters '(:grip-force 35d0 :finger-friction 0.6d0))))
    (is (eq :finished (discrepancy:run-ending run)))
    (dolist (item '(:bowl :cereal :milk :spoon))
      (is (member (list :on item :table)
                  (discrepancy:observed-fluents (discrepancy:run-final-state run))
                  :test #'equal)
          "~(~a~): ~a" item (discrepancy:observed-fluents (discrepancy:run-final-state run))))))

;;; Coordinates in the middle of a region

(defun domain-with-spoon-coordinates (coordinates)
  (discrepancy::parse-abstraction
   'spoons `((:theory "theory.lisp") (:scene "scene.lisp")
             (:region drawer-1 (box (x -2.4 -1.5) (z 0.58 0.7)))
             (:placement (in spoon ?drawer) :body spoon :coordinates ,coordinates))
   :file (root-file "models/kitchen/spoons.lisp")))

(test the-middle-of-a-region-is-as-wide-as-one-says
  (let ((placement (first (discrepancy::domain-observers
                           (domain-with-spoon-coordinates '((x (middle 0.1)) (y 0)))))))
    (loop for parameter in (discrepancy::placement-parameters
                            placement (first (discrepancy::placement-regions placement)))
          for (min max) in '((-2d0 -1.9d0) (0d0 0d0))
          do (is (< (abs (- min (discrepancy:parameter-min parameter))) 1d-9))
             (is (< (abs (- max (discrepancy:parameter-max parameter))) 1d-9))))
  (signals-with (discrepancy:abstraction-error "the coordinate y is bounded by no region")
    (domain-with-spoon-coordinates '((x -2 -1.9) (y (middle 0.1)))))
  (signals discrepancy:abstraction-error
    (domain-with-spoon-coordinates '((x (middle 0))))))
