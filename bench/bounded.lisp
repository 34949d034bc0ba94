;;;; Benchmarks of the bounded engine: one open question at a horizon, shortest plans, grounding.
;;;;
;;;; The peers of the questions run in turn with us: Z3 fed in the plain way (the same clauses, each
;;;; a term of its own, without unit propagation before), and clingo where that program is
;;;; installed.  Times are processor time.

(in-package #:discrepancy-finder.bench)

(defparameter *household-goals*
  '((10 (position o0 r3))
    (20 (and (position o1 r4) (not (open d0))))
    (40 (and (position o0 d1) (position o1 r4) (not (open d1)) (not (open d0))))
    (80 (and (position o0 d1) (position o1 d2) (position o2 r3) (position o3 d0)
         (not (open d0)) (not (open d1)) (not (open d2)))))
  "Goals for the household by horizon; the shortest plans have 7, 10 and 23 steps, that of the last
one is not known.")

(defun processor-milliseconds (function)
  "Return the processor time (ms) of a call of FUNCTION, without garbage from before."
  (sb-ext:gc :full t)
  (let ((start (foreign:processor-seconds)))
    (funcall function)
    (* 1d3 (- (foreign:processor-seconds) start))))

(defun open-question (last goal seed)
  "Return the processor time (ms) of building the household for the timepoints 0 to LAST, and of
finding events after which GOAL holds."
  (let* ((reasoner nil)
         (ground (ec:ground (ec:find-theory :household-at-home)))
         (build (processor-milliseconds
                 (lambda ()
                   (setf reasoner (ec:make-reasoner :household-at-home :horizon last :seed seed
                                                                       :ground ground)))))
         (goal (ec::goal-at goal (ec:find-theory :household-at-home) last)))
    (unwind-protect
         (values build
                 (processor-milliseconds
                  (lambda () (ec:models reasoner :limit 1 :complete nil :where goal))))
      (ec:close-reasoner reasoner))))

(defun clause-lists (clauses)
  "Return the clauses of the vector CLAUSES as lists of literals."
  (let ((lists '()) (clause '()))
    (loop for literal across clauses
          do (if (zerop literal)
                 (push (shiftf clause '()) lists)
                 (push literal clause)))
    (nreverse lists)))

(defun plain-question (last goal seed)
  "Do as OPEN-QUESTION, with a term of Z3 for each clause and no propagation."
  (ec:with-reasoner (reasoner :household-at-home :horizon last)
    (let* ((encoder (ec::reasoner-encoder reasoner))
           (jobs (ec::schedule encoder nil (cons 0 last)))
           (clauses (clause-lists (ec::clauses-of-jobs encoder jobs
                                                       (ec::reasoner-occurring reasoner))))
           (goal (ec::question-formula reasoner
                                       (ec::goal-at goal (ec:find-theory :household-at-home)
                                                    last))))
      (z3:with-context (context)
        (z3:with-solver (solver context :logic "QF_FD" :seed seed)
          (z3:with-clause-set (variables solver)
            (flet ((literal (literal) (z3:clause-set-term variables literal)))
              (values (processor-milliseconds
                       (lambda ()
                         (dolist (clause clauses)
                           (z3:solver-assert solver
                                             (z3:disjunction (mapcar #'literal clause))))
                         (ec::map-exclusions (lambda (literals)
                                               (z3:assert-at-most variables literals 1))
                                             encoder jobs)))
                      (progn
                        (z3:solver-assert solver
                                          (ec::formula-proposition reasoner goal
                                                                   :literal-term #'literal))
                        (processor-milliseconds (lambda () (z3:check solver))))))))))))

(defun shortest-plan-seconds ()
  "Return the processor time (s) of finding the shortest plan of 23 steps by growing the horizon,
and its length."
  (let ((length nil))
    (values (* 1d-3 (processor-milliseconds
                     (lambda ()
                       (setf length (nth-value 1 (ec:abduce :household-at-home
                                                            (second (third *household-goals*))
                                                            :horizon 40 :minimal nil))))))
            length)))

(ec:define-theory falling-apple
  "An apple that falls from 40, a height for each of 41 values, and hits the ground."
  (:sorts (height (:range 0 40)))
  (:fluents (falling) (height height))
  (:events (drop) (hit))
  (:axioms
   (initiates (drop) (falling) ?time)
   (releases (drop) (height ?height) ?time)
   (implies (and (holds-at (height ?height1) ?time) (= ?height2 (- ?height1 ?offset)))
            (trajectory (falling) ?time (height ?height2) ?offset))
   (implies (and (holds-at (height ?height1) ?time) (holds-at (height ?height2) ?time))
            (= ?height1 ?height2))
   (implies (and (holds-at (falling) ?time) (holds-at (height 0) ?time)) (happens (hit) ?time))
   (terminates (hit) (falling) ?time)
   (implies (holds-at (height ?height) ?time) (initiates (hit) (height ?height) ?time)))
  (:facts (holds-at (height 40) 0) (not (holds-at (falling) 0)))
  (:narrative (happens (drop) 0))
  (:completion happens)
  (:time 0 41))

(ec:define-theory falling-apple-in-numbers
  "The same with one number a timepoint."
  (:fluents (falling))
  (:numeric-fluents (height))
  (:events (drop) (hit))
  (:axioms
   (initiates (drop) (falling) ?time)
   (releases (drop) (height) ?time)
   (trajectory (falling) ?time (= (height) (- (value-at (height) ?time) ?offset)) ?offset)
   (implies (and (holds-at (falling) ?time) (<= (value-at (height) ?time) 0))
            (happens (hit) ?time))
   (terminates (hit) (falling) ?time)
   (assigns (hit) (height) 0 ?time))
  (:facts (= (value-at (height) 0) 40) (not (holds-at (falling) 0)))
  (:narrative (happens (drop) 0))
  (:completion happens)
  (:time 0 41))

(defun scenario-files ()
  (uiop:directory-files (asdf:system-relative-pathname "discrepancy-finder" "tests/theories/")
                        "*.e"))

(defun scenarios-seconds ()
  "Return the processor time (s) of reading all classical scenarios and finding their models, and
their number."
  (let ((files (scenario-files)))
    (values (* 1d-3 (processor-milliseconds
                     (lambda ()
                       (dolist (file files)
                         (ec:models (ec:read-e-theory file) :limit nil)))))
            (length files))))

(defun ground-goal (goal)
  (let ((theory (ec:find-theory :household-at-home)))
    (ec:ground-formula (ec:ground theory) (ec:parse-formula goal theory))))

(defun question-figures (last goal seed clingo-p)
  "Return the times (ms) of building and asking, the same for the plain way, and that of clingo or
NIL."
  (append (multiple-value-list (open-question last goal seed))
          (multiple-value-list (plain-question last goal seed))
          (list (and clingo-p
                     (clingo-milliseconds (ec:ground (ec:find-theory :household-at-home))
                                          (ground-goal goal) last seed)))))

(defun print-open-questions (stream)
  (loop with clingo-p = (clingo-installed-p)
        for (last goal) in *household-goals*
        for rounds = (loop for seed from 1 to 5
                           collect (question-figures last goal seed clingo-p))
        do (flet ((median-of (function) (median (mapcar function rounds))))
             (format stream "open events, T = ~d       build ~,0f ms, question ~,0f ms; term by ~
                             term ~,0f and ~,0f ms, ratio of sums ~,2f~@[; clingo ~,0f ms, ratio ~
                             ~,2f~]~%"
                     last
                     (median-of #'first) (median-of #'second)
                     (median-of #'third) (median-of #'fourth)
                     (median-of (lambda (figures)
                                  (destructuring-bind (a b c d e) figures
                                    (declare (ignore e))
                                    (/ (+ a b) (+ c d)))))
                     (and clingo-p (median-of #'fifth))
                     (and clingo-p
                          (median-of (lambda (figures)
                                       (/ (+ (first figures) (second figures))
                                          (fifth figures)))))))))

(defun print-bounded-benchmarks (stream)
  (print-open-questions stream)
  (multiple-value-bind (seconds length) (shortest-plan-seconds)
    (format stream "shortest plan             ~d steps, ~,2f s with all shorter horizons~%" length
            seconds))
  (format stream "trajectory, 41 x 42       ~,0f ms with a fluent for each height, ~,0f ms with ~
                  one real a timepoint~%"
          (processor-milliseconds (lambda () (ec:count-models :falling-apple)))
          (processor-milliseconds (lambda () (ec:count-models :falling-apple-in-numbers))))
  (multiple-value-bind (seconds count) (scenarios-seconds)
    (format stream "classical scenarios       ~d files read and all models found in ~,2f s~%" count
            seconds)))
