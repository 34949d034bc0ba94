;;;; Fluents: many at a time, nets that are forgotten, waiting in every order.
;;;;
;;;; What each operator does in its corner cases is shown, and tested, by docs/plan-language.md.

(in-package #:discrepancy-finder.tests)

(def-suite fluents :in all)
(in-suite fluents)

(test a-fluent-serves-one-program-after-the-other
  (let ((fluent (plan:make-fluent :value 0)))
    (loop for i from 1 to 10
          do (is (eql i (plan:top-level
                          (plan:par (progn (plan:wait-for (plan:fl= fluent i))
                                           (plan:value fluent))
                                    (setf (plan:value fluent) i))))))
    (setf (plan:value fluent) 11)
    (is (eql 11 (plan:value fluent)) "it can be set outside of a top-level, too")))

(test nobody-misses-a-value
  "A hundred tasks wait for a value each; each goes on when it has come."
  (let ((fluent (plan:make-fluent :value 0))
        (values (loop for i from 1 to 100 collect i)))
    (is (equal values
               (events-of (lambda ()
                            (plan:top-level
                              (plan:par
                                (plan:par-loop (i (reverse values))
                                  (plan:wait-for (plan:fl= fluent i))
                                  (note-event i))
                                (dolist (i values)
                                  (plan:sleep* 1)
                                  (setf (plan:value fluent) i))))))))))

(test timeouts-in-their-order
  (is (equal '((1 1d0) (2 2d0) (3 3d0))
             (events-of (lambda ()
                          (let ((fluent (plan:make-fluent)))
                            (plan:top-level
                              (plan:par-loop (i '(3 1 2))
                                (plan:wait-for fluent :timeout i)
                                (note-event (list i (plan:now)))))))))))

(test a-buffer-between-two-tasks
  "One task produces, another one consumes; the buffer has one place."
  (let ((buffer (plan:make-fluent)))
    (is (equal (loop for i from 1 to 50 collect (list :put i) collect (list :got i))
               (events-of (lambda ()
                            (plan:top-level
                              (plan:par
                                (loop for i from 1 to 50
                                      do (plan:wait-for (plan:fl-not buffer))
                                         (note-event (list :put i))
                                         (setf (plan:value buffer) i))
                                (loop repeat 50
                                      do (note-event (list :got (plan:wait-for buffer)))
                                         (setf (plan:value buffer) nil))))))))))

(defun chain-of-nets (fluent length)
  "Return a net that adds LENGTH to FLUENT, one after the other."
  (loop repeat length do (setf fluent (plan:fl+ fluent 1)))
  fluent)

(test long-chains-of-nets
  (let* ((fluent (plan:make-fluent :value 0))
         (net (chain-of-nets fluent 10)))
    (is (eql 10 (plan:value net)))
    (is (eql 17 (plan:top-level
                  (plan:par (progn (plan:wait-for (plan:fl> net 15)) (plan:value net))
                            (progn (plan:sleep* 1) (setf (plan:value fluent) 7))))))))

(test a-net-pulses-as-often-as-its-value-changes
  (let* ((fluent (plan:make-fluent :value 0))
         (odd (plan:fl-funcall #'oddp fluent))
         (pulses (plan:pulsed odd :handle-missed-pulses :always)))
    (dolist (value '(2 4 5 7 8))
      (setf (plan:value fluent) value))
    (is (equal '(t t nil)
               (plan:top-level (loop repeat 3 collect (plan:wait-for pulses :timeout 1))))
        "from 4 to 5 and from 7 to 8")))

(test nets-that-nobody-uses-are-forgotten
  (let ((fluent (plan:make-fluent :value 0)))
    (loop repeat 10
          do (loop repeat 1000 do (plan:fl> fluent 1))
             (sb-ext:gc :full t))
    (plan:fl> fluent 1)
    (is (< (length (discrepancy-finder.plan-language::fluent-dependents fluent)) 5000))))

(test waiting-leaves-nothing-behind
  (let ((fluent (plan:make-fluent)))
    (plan:top-level
      (loop repeat 100 do (plan:wait-for fluent :timeout 1/100))
      (plan:pursue (plan:wait-for fluent) (plan:sleep* 1)))
    (is (null (discrepancy-finder.plan-language::waiting-strands fluent)))))

(test whenever-sees-each-pulse
  (let ((fluent (plan:make-fluent :value 0)))
    (is (equal '(1 2 3 4 5)
               (events-of (lambda ()
                            (plan:top-level
                              (plan:pursue
                                (plan:whenever ((plan:pulsed fluent))
                                  (note-event (plan:value fluent)))
                                (loop for i from 1 to 5
                                      do (setf (plan:value fluent) i)
                                         (plan:sleep* 1))))))))))

(test fluents-of-several-tasks
  "A task that waits for the end of others, by their status."
  (is (equal '((:one-of-them 2d0) (:both 3d0))
             (events-of (lambda ()
                          (plan:top-level
                            (plan:with-tags
                              (plan:par
                                (:tag one (plan:sleep* 3))
                                (:tag two (plan:sleep* 2))
                                (progn (plan:wait-for (plan:fl-and (plan:task-dead one)
                                                                   (plan:task-dead two)))
                                       (note-event (list :both (plan:now))))
                                (progn (plan:wait-for (plan:fl-or (plan:task-dead one)
                                                                  (plan:task-dead two)))
                                       (note-event (list :one-of-them (plan:now))))))))))))

(test an-error-in-a-net-ends-the-task-that-waits
  (is (equal '(:waited)
             (events-of
              (lambda ()
                (plan:top-level
                  (plan:with-failure-handling
                      ((division-by-zero () (note-event :waited) (return)))
                    (plan:par (plan:wait-for (plan:fl-funcall #'undefined-inverse
                                                              (plan:make-fluent :value 0)))))))))))

(defun undefined-inverse (x)
  (if (zerop x) (error 'division-by-zero) (/ x)))

(test fluents-are-printed-in-one-line
  (let ((fluent (plan:make-fluent :name "door" :value '(1 2 3 4 5 6 7))))
    (is (string= "#<VALUE-FLUENT door = (1 2 3 4 5 ...)>"
                 (let ((*package* (find-package '#:discrepancy-finder.plan-language)))
                   (princ-to-string fluent))))
    (is (search "= 7" (princ-to-string (plan:fl-funcall #'length fluent))))))

(test what-is-no-fluent
  (signals error (setf (plan:value 1) 2))
  (signals error (plan:pulse 1))
  (signals type-error (plan:pulsed (plan:make-fluent) :handle-missed-pulses :sometimes))
  (signals plan:not-in-top-level (plan:wait-for (plan:make-fluent)))
  (is (eql 1 (plan:wait-for 1)) "what is true needs no task"))
