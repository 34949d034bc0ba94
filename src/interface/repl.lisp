;;;; The REPL's entry points: FIND-DISCREPANCIES and RUN-PLAN (of the discrepancy layer),
;;;; EXPLORE-PLAN and DEMO.  Plans and domains named by a symbol are loaded from plans/ and models/
;;;; where they are not defined yet.

(in-package #:discrepancy-finder)

(defun version ()
  "Return the version of the system, a string."
  #.(asdf:component-version (asdf:find-system "discrepancy-finder")))

(discrepancy:use-data-directories (list (asdf:system-source-directory "discrepancy-finder")))

(defun explore-plan (plan &rest options &key domain &allow-other-keys)
  "Return an EXPLORATION that has found every trace of PLAN (a symbol) in DOMAIN (a domain or its
name) on which the state constraint :CONSTRAINT (a name, a formula; NIL: the theory's only one)
comes true, and the list of these traces; DESCRIBE shows them in full.  :ARGUMENTS is a list of
(parameter type), the plan's symbolic arguments.  See SYMBOLIC-EXECUTION:MAKE-EXPLORATION for these
and the other options: :TRACES :ORDER :SEED :MAX-PATHS :MAX-STEPS :MAX-JUMPS :MAX-SECONDS
:INTERLEAVINGS :COVERAGE :FILE-OUTPUT :PROGRESS ....  Signals PLAN-NOT-FOUND, DOMAIN-NOT-FOUND,
STATE-CONSTRAINT-NOT-FOUND, UNSUPPORTED-FORM, NONDETERMINISTIC-PLAN, PLAN-BROKE, ACTION-PROBLEM; the
restart STOP-EXPLORING returns what was found so far."
  (let ((exploration (apply #'symbolic:explore-plan (plan:plan-name (discrepancy:ensure-plan plan))
                            :domain (discrepancy:ensure-domain domain)
                            (alexandria:remove-from-plist options :domain))))
    (values exploration (exploration-traces exploration))))

(defun verify-plan (plan &rest options &key domain &allow-other-keys)
  "Return a VERIFICATION whether PLAN (a symbol) has the safety property :PROPERTY in DOMAIN (a
domain or its name) on all paths: a formula over ?time, the name of a state constraint, (:never
constraint), :NO-FAILURE or :NO-ERROR; DESCRIBE shows a counterexample in full.  The other options
are those of EXPLORE-PLAN but :CONSTRAINT and :TRACES, and it signals the same."
  (apply #'symbolic:verify-plan (plan:plan-name (discrepancy:ensure-plan plan))
         :domain (discrepancy:ensure-domain domain)
         (alexandria:remove-from-plist options :domain)))

(defun demo (&key (seed 1) (stream *standard-output*) (command "./discrepancy-finder"))
  "Run both variants of Example 1 with SEED, print their reports and what one sees to STREAM, and
return the two results.  A discrepancy is saved for replay; COMMAND is printed in how to do that."
  (let ((results (loop for reach in '(0.8d0 0.5d0)
                       collect (find-discrepancies 'discrepancy-finder-user::move-the-box
                                                   :domain :two-regions :seed seed
                                                   :parameters (list :reach reach)))))
    (loop for result in results
          for reach in '("0.8 m" "0.5 m")
          do (format stream "~&--- an arm that reaches ~a ---~%" reach)
             (dolist (discrepancy (result-discrepancies result))
               (handler-case (save-discrepancy discrepancy)
                 (error (condition) (warn "~a" (source:condition-sentence condition)))))
             (format stream "~a~%" (result-text result :command command)))
    (format stream "What one sees: the theory lets the robot pick up the box wherever it lies in ~
                    r2; an arm of 0.8 m~%~a, one of 0.5 m ~a.~%"
            (if (eq (result-status (first results)) :certified)
                "does so in every simulation" "does not")
            (if (result-discrepancies (second results))
                "cannot from x = 1.5 m where the box is near an end of r2: the region is too coarse"
                "happened to do so in the few that the paper's rule asks for"))
    results))
