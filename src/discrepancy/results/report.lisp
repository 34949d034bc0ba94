;;;; Reports: what a search found, in words and numbers with units.

(in-package #:discrepancy-finder.discrepancy)

(defun hash-text (hash)
  (format nil "~(~16,'0x~)" hash))

(defun state-text (atoms)
  (format nil "~:[nothing~;~:*~{~a~^ ~}~]" (mapcar #'ec:atom-text atoms)))

(defun parameters-text (parameters)
  "Return a text for the property list PARAMETERS of scene parameters, or NIL."
  (and parameters
       (format nil "~{~a~^, ~}"
               (loop for (name value) on parameters by #'cddr
                     collect (format nil "~a = ~a" (ec:name-text name) (number-text value))))))

(defun source-text (name position-or-file)
  (format nil "~(~a~)~@[ (~a)~]" name (and position-or-file (princ-to-string position-or-file))))

(defun describe-trace (trace stream)
  (format stream "  trace~%    initially ~a~%"
          (state-text (ec:state-fluents (symbolic:trace-initial-state trace))))
  (loop for step in (symbolic:trace-steps trace)
        for number from 1
        do (format stream "    ~d. ~a~%       ~a~@[, at ~a~]~%" number
                   (symbolic:step-designator step) (symbolic:step-text step)
                   (and (symbolic:step-position step)
                        (princ-to-string (symbolic:step-position step)))))
  (format stream "    finally ~a~%"
          (state-text (ec:state-fluents (symbolic:trace-final-state trace)))))

(defun region-seen (domain state body)
  "Return the first region of DOMAIN in which BODY was seen in STATE, or NIL."
  (loop for placement in (placements domain)
        for region = (and (eq (placement-body placement) body)
                          (find-if (lambda (region)
                                     (cdr (assoc (placement-atom placement region) state
                                                 :test #'equal)))
                                   (placement-regions placement)))
        when region return region))

(defun describe-sample (domain run stream &optional targeted-p)
  "Tell the sample that RUN began with, and where its bodies were seen when the world had settled:
at a border that need not be the region of the pose that was drawn.  Targeted samples have numbers
of their own."
  (let ((sample (run-sample run)))
    (format stream "  initial state of the simulation~@[ (~a)~]~%"
            (and (sample-index sample)
                 (format nil "~:[~;targeted ~]sample ~d" targeted-p (sample-index sample))))
    (loop for parameter in (sample-parameters sample)
          for value across (sample-values sample)
          unless (fixed-p parameter)
            do (format stream "    ~a~@[ (~a)~]~%" (value-text parameter value)
                       (parameter-meaning parameter)))
    (loop for body in (remove-duplicates
                       (remove-if-not #'keywordp (mapcar #'parameter-body
                                                         (sample-parameters sample))))
          for region = (region-seen domain (run-initial-state run) body)
          do (format stream "    ~a is in ~:[no region~;~:*~a~]~%" (ec:name-text body)
                     (and region (ec:name-text (region-name region)))))))

(defun describe-divergence (discrepancy stream)
  (let* ((divergence (judgement-divergence (discrepancy-judgement discrepancy)))
         (run (discrepancy-run discrepancy))
         (step (nth (divergence-step divergence) (run-steps run))))
    (format stream "  theory and simulation part at step ~d, ~a~%" (1+ (divergence-step divergence))
            (run-step-designator step))
    (ecase (divergence-kind divergence)
      (:outcome
       (format stream "    the simulation ends it with ~:[success~;~:*~a~], which the theory ~
                       forbids~%"
               (run-step-failure step)))
      (:state
       (format stream "    the theory forbids the state after it~%")))
    (loop for (atom theory simulation) in (divergence-fluents divergence)
          do (format stream "    ~a: theory ~:[false~;true~], simulation ~:[false~;true~]~%"
                     (ec:atom-text atom) theory simulation))))

(defun describe-shrinking (discrepancy stream)
  "Tell what of DISCREPANCY is not as plan and scene have it, if it was shrunk."
  (when (discrepancy-actions discrepancy)
    (format stream "  these actions are performed without the plan~%"))
  (when (discrepancy-left-out discrepancy)
    (format stream "  left out of the world: ~{~a~^, ~}~%"
            (mapcar #'ec:name-text (discrepancy-left-out discrepancy)))))

(defun discrepancy-text (discrepancy &key (command "./discrepancy-finder"))
  "Return a text of several lines that tells DISCREPANCY: the trace, the initial state, where theory
and simulation part, both final states, and how COMMAND replays it."
  (with-output-to-string (stream)
    (describe-trace (discrepancy-trace discrepancy) stream)
    (describe-shrinking discrepancy stream)
    (describe-sample (discrepancy-domain discrepancy) (discrepancy-run discrepancy) stream
                     (eq (discrepancy-origin discrepancy) :targeted))
    (describe-divergence discrepancy stream)
    (format stream "  final state~%    theory:     ~a~%    simulation: ~a~@[ (stopped after step ~
                    ~d)~]~%"
            (state-text (ec:state-fluents
                         (symbolic:trace-final-state (discrepancy-trace discrepancy))))
            (state-text (observed-fluents (run-final-state (discrepancy-run discrepancy))))
            (and (eq (run-ending (discrepancy-run discrepancy)) :left-trace)
                 (length (run-steps (discrepancy-run discrepancy)))))
    (format stream "  run twice: ~:[different bits, so the simulation is not deterministic~;~
                    the same bits~], state hash ~a~%"
            (discrepancy-confirmed-p discrepancy)
            (hash-text (run-hash (discrepancy-run discrepancy))))
    (when (discrepancy-file discrepancy)
      (format stream "  replay it with: ~a replay ~a~%" command (discrepancy-file discrepancy)))))

(defun acceptance-text (result)
  "Return a text of the part of the samples of RESULT that were valid, or NIL if all were."
  (let ((rate (result-acceptance-rate result)))
    (and rate (< rate 1)
         (format nil "~a % of the samples drawn were valid"
                 (percent-text (/ (floor (* 1000 rate)) 1000d0))))))

(defun trace-result-starts-text (result)
  "Return a text of the initial states that the samples of RESULT were drawn from, if there are
several: in which fluents they differ, and how many samples of each were valid; else NIL."
  (let* ((starts (trace-result-starts result))
         (states (loop for start in starts
                       collect (ec:state-fluents (symbolic:trace-initial-state
                                                  (start-trace start))))))
    (flet ((everywhere-p (atom)
             (every (lambda (state) (member atom state :test #'equal)) states)))
      (and (rest starts)
           (format nil "~{~a (~d)~^ or ~}"
                   (loop for start in starts
                         for state in states
                         collect (state-text (remove-if #'everywhere-p state))
                         collect (start-accepted start)))))))

(defun trace-result-text (result number confidence)
  "Return a text of some lines that tells RESULT, of trace NUMBER of a search with CONFIDENCE."
  (with-output-to-string (stream)
    (format stream "  trace ~d: ~(~a~), ~a~%" number (trace-result-status result)
            (trace-result-reason result))
    (format stream "    ~d simulation~:p that agree~:*~[~;s~:;~]~@[, ~d rejected~]~@[, ~d left the ~
                    trace~]~%"
            (trace-result-samples result)
            (let ((rejected (trace-result-rejected result))) (and (plusp rejected) rejected))
            (let ((left (trace-result-left-trace result))) (and (plusp left) left)))
    (format stream "~@[    valid samples by what is open initially: ~a~%~]"
            (trace-result-starts-text result))
    (unless (eq (trace-result-status result) :discrepancy)
      (format stream "    sound: ~a~%" (trace-result-statement result confidence)))
    (format stream "~{    warning: ~a~%~}" (trace-result-warnings result))))

(defun drawn-text (result)
  "Return a text that tells which tolerances the simulations of RESULT have drawn, or NIL."
  (let ((tolerances (tolerance-parameters (domain-scene (result-domain result)))))
    (and tolerances
         (format nil "~{~a~^, ~} drawn for each simulation"
                 (loop for parameter in tolerances
                       collect (format nil "~a from ~a to ~a" (parameter-name parameter)
                                       (number-text (parameter-min parameter))
                                       (number-text (parameter-max parameter))))))))

(defun headline (result)
  (ecase (result-status result)
    (:discrepancy (let ((kinds (length (result-kinds result))))
                    (format nil "DISCREPANCY: theory and simulation disagree~[~;~:;, in ~:*~d ~
                                 ways~]."
                            kinds)))
    (:certified (format nil "NO DISCREPANCY: the rule ~(~a~) is satisfied at ~a % confidence for ~
                             every trace~@[, with ~a~]."
                        (result-rule-name result)
                        (percent-text (result-confidence result))
                        (drawn-text result)))
    (:undecided (format nil "UNDECIDED: ~a." (result-reason result)))))

(defun time-text (result)
  "Return a text that tells where the time of RESULT went."
  (let* ((symbolic (result-symbolic-seconds result))
         (simulation (result-simulation-seconds result)))
    (format nil "~,3f s in symbolic execution, ~,3f s in simulation, ~,3f s in all (~,3f s of it ~
                 in Z3)"
            symbolic simulation (result-seconds result) (result-solver-seconds result))))

(defun extra-simulations-text (result)
  "Return a text of the simulations that shrink and explain, or NIL."
  (let ((texts (loop for (name . words) in '((:shrink . "to shrink") (:explain . "to explain"))
                     for phase = (find name (result-phases result) :key #'phase-name)
                     when (plusp (phase-simulations phase))
                       collect (format nil "~d ~a" (phase-simulations phase) words))))
    (and texts (format nil "~{~a~^, ~}" texts))))

(declaim (ftype function explanation-text shrinking-text))

(defun describe-discrepancy (discrepancy command stream)
  "Print DISCREPANCY with what was found out of it."
  (format stream "  kind: ~a~[~;~:;, found ~:*~d times~]~%" (kind-text discrepancy)
          (discrepancy-occurrences discrepancy))
  (write-string (discrepancy-text discrepancy :command command) stream)
  (when (discrepancy-explanation discrepancy)
    (write-string (explanation-text (discrepancy-explanation discrepancy)) stream)
    (fresh-line stream))
  (when (discrepancy-shrunk discrepancy)
    (write-string (shrinking-text (discrepancy-shrunk discrepancy) :command command) stream)
    (fresh-line stream)))

(defun result-text (result &key (command "./discrepancy-finder"))
  "Return the report of RESULT, a text of several lines."
  (let ((domain (result-domain result))
        (discrepancies (result-discrepancies result)))
    (with-output-to-string (stream)
      (format stream "~a~%" (headline result))
      (when (rest (result-traces result))
        (format stream "~@[  sound: ~a~%~]" (result-statement result)))
      (format stream "  plan ~a~%" (source-text (plan:plan-name (result-plan result))
                                                (plan:plan-position (result-plan result))))
      (format stream "  domain ~a~@[, with ~a~]~%"
              (source-text (symbolic:action-theory-name domain) (domain-file domain))
              (parameters-text (result-parameters result)))
      (format stream "~@[  tolerances ~a~%~]" (drawn-text result))
      (format stream "  state constraint ~a, rule ~(~a~), confidence ~a, seed ~d~%"
              (constraint-text (result-constraint result)) (result-rule-name result)
              (number-text (result-confidence result)) (result-seed result))
      (format stream "  ~d iteration~:p, ~d simulation~:p~@[, and ~a~]~@[; ~a~]~%"
              (result-iterations result) (result-simulations result)
              (extra-simulations-text result) (acceptance-text result))
      (format stream "  ~a~%" (time-text result))
      (loop for (nil file text) in (result-reused result)
            do (format stream "  stored ~a: ~a~%" file text))
      (loop for trace in (result-traces result)
            for number from 1
            unless (eq (trace-result-status trace) :discrepancy)
              do (write-string (trace-result-text trace number (result-confidence result)) stream)
                 (unless discrepancies
                   (describe-trace (trace-result-trace trace) stream)))
      (dolist (discrepancy discrepancies)
        (describe-discrepancy discrepancy command stream)))))

(defun run-text (run)
  "Return the report of RUN, a text of several lines."
  (with-output-to-string (stream)
    (format stream "~@[tolerances ~a~%~]" (parameters-text (run-tolerances run)))
    (format stream "initially ~a~%" (state-text (observed-fluents (run-initial-state run))))
    (if (eq (run-validity run) :valid)
        (loop for step in (run-steps run)
              for number from 1
              do (format stream "  ~d. ~a~%     ~:[success~;~:*~a~]; ~a~%" number
                         (run-step-designator step) (run-step-failure step)
                         (state-text (observed-fluents (run-step-state step)))))
        (format stream "  not run: ~a~%" (run-validity run)))
    (format stream "finally ~a (~(~a~), ~,2f s simulated, state hash ~a)~%"
            (state-text (observed-fluents (run-final-state run))) (run-ending run)
            (run-seconds run) (hash-text (run-hash run)))))
