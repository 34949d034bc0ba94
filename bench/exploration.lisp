;;;; Benchmarks of exploration: plans in CPL on all inputs at once.
;;;;
;;;; BRANCHES has twelve independent two-way branches, SEARCH-AND-TIDY is the plan of
;;;; progression.lisp as it would be written for a robot: there the theory is asked by hand, here by
;;;; the evaluator, action bindings and replay.  Entry point: PRINT-EXPLORATION-BENCHMARKS.

(in-package #:discrepancy-finder.bench)

(defclass household-domain (symbolic:action-theory) ())

(defun household-domain ()
  "Return the domain of the household whose objects are in unknown places, with its plans."
  (symbolic:register-action-theory
   (make-instance 'household-domain :name :household
                                    :theory (ec:find-theory :household-unknown)))
  (plan:load-plan (namestring (asdf:system-relative-pathname "discrepancy-finder"
                                                             "bench/household-plans.lisp")))
  (symbolic:find-action-theory :household))

(defun exploration-figures (plan &rest options)
  "Explore PLAN in the household and return the statistics, a property list, with the processor
time in s as :PROCESSOR-SECONDS."
  (let* ((domain (household-domain)) (exploration nil)
         (milliseconds (processor-milliseconds
                        (lambda ()
                          (setf exploration (apply #'symbolic:explore-plan plan :domain domain
                                                                                options))))))
    (list* :processor-seconds (/ milliseconds 1d3)
           (symbolic:exploration-statistics exploration))))

(defun print-figures (stream name figures)
  (flet ((figure (key) (or (getf figures key) 0)))
    (format stream "~25a ~d paths, ~d dead ends in ~,2f s (processor ~,2f s), ~,2f ms a path, ~d % ~
                    in Z3; ~d decisions, ~d checks, ~,2f checks a decision~%"
            name (figure :paths) (figure :dead-ends) (figure :seconds) (figure :processor-seconds)
            (/ (* 1d3 (figure :processor-seconds)) (max (figure :paths) 1))
            (round (* 100 (figure :solver-seconds)) (max (figure :seconds) 1d-9))
            (figure :decisions) (figure :checks) (figure :checks-per-decision))))

(defparameter *flags*
  (loop for number below 12
        collect (list (intern (format nil "?FLAG-~d" number) '#:discrepancy-finder-user) 'boolean))
  "The symbolic arguments of the plan BRANCHES.")

(defun first-trace-seconds ()
  "Return the seconds until the first trace of a plan of sixty actions, and its steps."
  (let* ((domain (household-domain)) (trace nil)
         (seconds (seconds-of
                   (lambda ()
                     (let ((exploration (symbolic:make-exploration
                                         'discrepancy-finder-user::sixty-actions domain
                                         :constraint '(exists (?spot)
                                                       (happens (look ?spot) ?time)))))
                       (unwind-protect (setf trace (symbolic:next-trace exploration))
                         (symbolic:close-exploration exploration)))))))
    (values seconds (length (symbolic:trace-steps trace)))))

(defun tidying-plan-figures (objects)
  "Return the statistics of the exploration of the plan search-and-tidy for OBJECTS objects.  Where
an event is forbidden, a violation in progression.lisp, the path is a dead end here, so that there
are as many more paths."
  (exploration-figures (ecase objects
                         (1 'discrepancy-finder-user::tidy-one)
                         (2 'discrepancy-finder-user::tidy-two)
                         (3 'discrepancy-finder-user::tidy-three))
                       :constraint '(exists (?object) (happens (put-down ?object) ?time))))

(defun print-exploration-benchmarks (&optional (stream *standard-output*))
  (print-figures stream "4096 paths"
                 (exploration-figures 'discrepancy-finder-user::branches
                                      :arguments *flags*
                                      :constraint '(happens (look r0) ?time)))
  (loop for objects from 1 to 3
        do (print-figures stream (format nil "search and tidy ~d, CPL" objects)
                          (tidying-plan-figures objects)))
  (multiple-value-bind (seconds steps) (first-trace-seconds)
    (format stream "first trace               of ~d actions in ~,3f s~%" steps seconds)))
