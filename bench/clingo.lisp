;;;; The same open questions for clingo, an answer set solver, where that program is installed.
;;;;
;;;; The ground theory is written as facts and constraints; DEC5 to DEC12 are constraints over
;;;; choices of what holds and happens, which answer set solvers like better at long horizons than
;;;; rules of inertia.  Entry point: CLINGO-MILLISECONDS.

(in-package #:discrepancy-finder.bench)

(defparameter *clingo-axioms* "
time(0..last).
{ holds(F,T) } :- fluent(F), time(T).
{ happens(E,T) : event(E) } 1 :- time(T), T < last.
:- initiated(F,T), not holds(F,T+1), T < last.
:- terminated(F,T), holds(F,T+1), T < last.
:- holds(F,T), not terminated(F,T), not holds(F,T+1), T < last.
:- fluent(F), time(T), not holds(F,T), not initiated(F,T), holds(F,T+1), T < last.
#show happens/2.
" "What every theory without releases shares.")

(defun clingo-literal (formula)
  "Return the literal for FORMULA, an atom or a negated one, at time T."
  (ecase (first formula)
    (:not (format nil "not ~a" (clingo-literal (second formula))))
    (:fluent (format nil "holds(~d,T)" (second formula)))
    (:event (format nil "happens(~d,T)" (second formula)))))

(defun clingo-conjunction (formula)
  "Return the literals of FORMULA, a conjunction, T or a literal."
  (cond ((eq formula t) '())
        ((eq (first formula) :and) (mapcar #'clingo-literal (rest formula)))
        (t (list (clingo-literal formula)))))

(defun complement-conjunctions (formula)
  "Return conjunctions, lists of literals, one of which is true just where FORMULA is not."
  (ecase (first formula)
    (:and (mapcan #'complement-conjunctions (copy-list (rest formula))))
    (:or (reduce (lambda (conjunctions more)
                   (alexandria:map-product #'append conjunctions more))
                 (mapcar #'complement-conjunctions (rest formula))))
    (:not (list (list (clingo-literal (second formula)))))
    ((:fluent :event) (list (list (clingo-literal (list :not formula)))))))

(defun write-clingo-program (ground goal last stream)
  "Write to STREAM the question whether GOAL, a ground formula about time 0, can be true at LAST."
  (format stream "#const last = ~d.~%fluent(0..~d).~%event(0..~d).~a" last
          (1- (length (ec:ground-theory-fluents ground)))
          (1- (length (ec:ground-theory-events ground)))
          *clingo-axioms*)
  (loop for effects across (ec::ground-theory-effects ground)
        do (dolist (effect effects)
             (format stream "~a(~d,T) :- happens(~d,T)~{, ~a~}.~%"
                     (ecase (ec::effect-kind effect)
                       (:initiates "initiated") (:terminates "terminated"))
                     (ec::effect-fluent effect) (ec::effect-event effect)
                     (clingo-conjunction (ec::effect-guard effect)))))
  (flet ((require-at (when formula)
           (dolist (literals (complement-conjunctions formula))
             (format stream ":- ~a~{, ~a~}.~%" when literals))))
    (dolist (sentence (ec::ground-theory-sentences ground))
      (require-at "time(T)" (ec::sentence-formula sentence)))
    (dolist (sentence (ec::ground-theory-initial-conditions ground))
      (require-at "T = 0" (ec::sentence-formula sentence)))
    (require-at "T = last" goal)))

(defun clingo-installed-p ()
  (zerop (nth-value 2 (uiop:run-program '("sh" "-c" "command -v clingo")
                                        :ignore-error-status t))))

(defun clingo-milliseconds (ground goal last seed)
  "Return the processor time (ms) that clingo needs to read the question and to find a model, by its
own account."
  (uiop:with-temporary-file (:stream stream :pathname file :type "lp")
    (write-clingo-program ground goal last stream)
    :close-stream
    (let* ((output (uiop:run-program (list "clingo" (format nil "--seed=~d" seed)
                                           (namestring file) "1")
                                     :output :string :ignore-error-status t))
           (start (search "CPU Time" output)))
      (unless (search "SATISFIABLE" output)
        (error "clingo said: ~a" output))
      (when (search "UNSATISFIABLE" output)
        (error "clingo finds no model at ~d" last))
      (let ((digits (subseq output (1+ (position #\: output :start start))
                            (position #\s output :start start))))
        (* 1d3 (let ((*read-default-float-format* 'double-float))
                 (read-from-string digits)))))))
