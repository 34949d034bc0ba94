;;;; The page: a search's result for a browser, in one file that needs nothing else.
;;;;
;;;; WRITE-REPORT is the entry point.  All words and numbers come from the JSON of the result
;;;; (RESULT-JSON), which the page also holds; pictures come from running samples once more
;;;; (shots.lisp).

(in-package #:discrepancy-finder.report)

(defun legend-node (verdicts failing)
  "Return what the marks of a map mean in which samples have VERDICTS; FAILING is true if it shows a
discrepancy."
  (flet ((entry (width text mark)
           `(:span () (:svg (:width ,width :height 12) ,mark) ,text)))
    `(:div (:class "legend")
       ,(and (member :failed verdicts)
             (entry 12 "sample that failed" '(:path (:d "M1,1L11,11M1,11L11,1" :class "failed"))))
       ,(and (member :passed verdicts)
             (entry 12 "sample that passed" '(:circle (:cx 6 :cy 6 :r 3.5 :class "passed"))))
       ,(and (member :left verdicts)
             (entry 12 "left the trace" '(:circle (:cx 6 :cy 6 :r 3.5 :class "left"))))
       ,(entry 22 "way of the base"
               `(:line (:x1 0 :x2 22 :y1 6 :y2 6
                        :class ,(if failing "trail failing" "trail main"))))
       ,(entry 12 "base after the steps with these numbers"
               '(:circle (:cx 6 :cy 6 :r 4 :class "stop")))
       ,(entry 22 "base and items at the end"
               '(:rect (:x 1 :y 1 :width 20 :height 10 :class "robot-after")))
       ,(entry 22 "region of the theory"
               '(:rect (:x 1 :y 1 :width 20 :height 10 :class "region inside"))))))

;;; The head of the page

(defun verdict-title (status)
  (cond ((string= status "discrepancy") "Discrepancy found")
        ((string= status "certified") "No discrepancy found")
        (t "Undecided")))

(defun banner-node (result)
  `(:header (:class ,(format nil "banner ~a" (key result "status")))
     (:div (:class "kicker") ,(format nil "Plan ~a against theory ~a" (key result "plan" "name")
                                      (key result "domain" "theory")))
     (:h1 () ,(verdict-title (key result "status")))
     ,(if (plusp (length (key result "discrepancies")))
          (summary-node (svref (key result "discrepancies") 0))
          `((:p () ,(after-colon (key result "headline")))
            ,(and (key result "statement") `(:p () ,(key result "statement")))))
     ,(and (key result "stopped")
           `(:p () ,(format nil "The search ended before its time: ~a." (key result "stopped"))))))

(defun after-colon (text)
  "Return what follows the first colon in TEXT, as a sentence, or TEXT."
  (let ((colon (position #\: text)))
    (if colon
        (capitalized (string-left-trim " " (subseq text (1+ colon))))
        text)))

(defun figures-node (result)
  (flet ((figure (name value)
           `(:div () (:dt () ,name) (:dd () ,value))))
    `(:dl (:class "figures")
       ,(figure "Iterations" (key result "iterations"))
       ,(figure "Simulations" (key result "simulations"))
       ,(and (key result "acceptance_rate")
             (figure "Valid samples" (format nil "~,1f %" (* 100 (key result "acceptance_rate")))))
       ,(figure "Whole search" (format nil "~,2f s" (key result "seconds" "all")))
       ,(figure "in symbolic execution" (format nil "~,2f s" (key result "seconds" "symbolic")))
       ,(figure "in simulation" (format nil "~,2f s" (key result "seconds" "simulation"))))))

(defun place-text (object)
  "Return the file and line in OBJECT, or NIL."
  (and (key object "file")
       (format nil "~a~@[:~d~]" (key object "file")
               (and (json:get-key object "line" nil) (key object "line")))))

(defun facts-node (result)
  (flet ((fact (name &rest nodes)
           `(:tr () (:th () ,name) (:td () ,@nodes)))
         (named (object)
           `((:code () ,(key object "name"))
             ,(and (place-text object) `(:span (:class "place") " " ,(place-text object))))))
    `(:table (:class "facts")
       ,(fact "Plan" (named (key result "plan")))
       ,(fact "Domain" (named (key result "domain")))
       ,(fact "State constraint" `(:code () ,(key result "constraint")))
       ,(fact "Confidence rule" (format nil "~a at ~a" (key result "rule")
                                        (value-string (key result "confidence"))))
       ,(fact "Samples" (format nil "~a, seed ~d" (key result "sampler") (key result "seed")))
       ,(and (key result "parameters")
             (fact "Scene parameters"
                   (format nil "~:{~a = ~a~:^, ~}"
                           (loop for (name . value) in (key result "parameters")
                                 collect (list name (value-string value))))))
       ,(fact "Exploration"
              (if (eq (key result "exploration" "complete") :true)
                  "complete"
                  (format nil "not complete~@[: ~{~a~^, ~}~]"
                          (texts (key result "exploration" "gaps")))))
       ,(and (plusp (length (key result "reused")))
             (fact "From the store"
                   `(:ul () ,(loop for entry across (key result "reused")
                                   collect `(:li () (:code () ,(key entry "file")) ": "
                                                 ,(key entry "verdict"))))))
       ,(fact "Phases"
              (format nil "~{~a~^, ~}"
                      (loop for phase across (key result "phases")
                            when (plusp (key phase "seconds"))
                              collect (format nil "~a ~,2f s" (key phase "name")
                                              (key phase "seconds"))))))))

;;; Discrepancies

(defun summary-node (found)
  "Return the paragraph that says what happened."
  (let ((divergence (key found "divergence")))
    `(:p () ,(format nil "Theory and simulation part at step ~d, "
                     (key divergence "step"))
         (:strong () ,(designator-type (key divergence "designator"))) ". "
         ,(if (string= (key divergence "kind") "outcome")
              `(,(format nil "The theory forbids how the simulation ends it: ~a."
                         (or (key divergence "failure") "success")))
              "The theory forbids the state that the simulation is in after it.")
         ,(loop for fluent across (key divergence "fluents")
                collect (destructuring-bind (text theory simulation) (coerce fluent 'list)
                          `(" " (:code () ,text)
                                ,(format nil " is ~(~a~) in the theory, ~(~a~) in the simulation."
                                         theory simulation)))))))

(defun replay-node (found command)
  `((:h3 () "Replay")
    ,(if (key found "file")
         `(:pre (:class "command") ,(format nil "~a replay ~a" command (key found "file")))
         '(:p () "The discrepancy was not stored."))
    (:p (:class "quiet")
        ,(if (eq (key found "confirmed") :true)
             "Run twice with the same bits; state hash "
             "A second run had other bits, so the simulation is not deterministic; state hash ")
        (:code () ,(key found "simulation" "hash")) ".")))

(defun states-section (found)
  "Return the states of both sides after the step where they part, and at the end."
  (let* ((theory (key found "theory"))
         (simulation (key found "simulation"))
         (step (key found "divergence" "step"))
         (last (length (key simulation "steps"))))
    (flet ((states (title number)
             `((:h3 () ,title)
               ,(states-node (state-after theory number) (state-after simulation number)
                             (texts (key simulation "observable"))))))
      `(,(and (<= step (length (key theory "steps")))
              (states (format nil "State after step ~d" step) step))
        ,(and (= last (length (key theory "steps"))) (/= last step)
              (states "State at the end" last))))))

(defun samples-section (domain trace parameters shots diverging)
  "Return map and strips for SHOTS of TRACE; PARAMETERS is an array of objects of the result."
  (and shots
       `((:h3 () ,(if diverging "Where samples passed and failed" "Where samples passed"))
         ,(map-node domain trace shots diverging)
         ,(legend-node (mapcar #'shot-verdict shots) diverging)
         ,(and (plusp (length parameters))
               (strips-node parameters (loop for shot in shots
                                             collect (list (shot-sample shot)
                                                           (shot-verdict shot))))))))

(defun discrepancy-section (number found discrepancy shots command)
  "Return the section for DISCREPANCY, of which the object FOUND tells; it has NUMBER."
  `(:section (:id ,(format nil "discrepancy-~d" number))
     (:h2 () ,(format nil "Discrepancy ~d: ~a~@[, ~d times~]" number (key found "kind")
                      (let ((times (key found "occurrences"))) (and (> times 1) times))))
     ,(and (> number 1) (summary-node found))
     ,(explanation-nodes (key found "explanation"))
     ,(replay-node found command)
     ,(samples-section (discrepancy:discrepancy-domain discrepancy)
                       (discrepancy:discrepancy-trace discrepancy)
                       (key found "parameters") shots (key found "divergence" "step"))
     (:h3 () "Step by step")
     ,(timeline-node (key found "theory") (key found "simulation") (key found "divergence"))
     ,(states-section found)
     ,(shrunk-nodes (key found "shrunk") command)))

;;; Traces without discrepancies

(defun trace-section (number trace-json shots domain trace starts)
  "Return the section of TRACE; STARTS is a text of what is open of its initial state, or NIL."
  `(:section (:id ,(format nil "trace-~d" number))
     (:h2 () ,(format nil "Trace ~d: ~a" number (key trace-json "status")))
     (:p () ,(format nil "~a.  ~d simulation~:p agree~:*~[~;s~:;~] with the theory~@[, ~d ~
                          sample~:p rejected~]~@[, ~d left the trace~]."
                     (capitalized (key trace-json "reason")) (key trace-json "samples")
                     (positive (key trace-json "rejected"))
                     (positive (key trace-json "left_trace"))))
     ,@(and starts `((:p () ,(format nil "Valid samples by what is open initially: ~a." starts))))
     (:p () ,(format nil "Whatever the rule says: ~a." (key trace-json "statement")))
     ,(loop for warning across (key trace-json "warnings")
            collect `(:p (:class "warning") ,warning))
     ,(samples-section domain trace (key trace-json "parameters") shots nil)
     (:h3 () "Step by step")
     ,(timeline-node (key trace-json "theory") (key trace-json "simulation") nil)))

(defun positive (number)
  (and (plusp number) number))

;;; The whole

(defun discrepancy-sections (result object command)
  (loop for discrepancy in (discrepancy:result-discrepancies result)
        for found across (key object "discrepancies")
        for number from 1
        collect (discrepancy-section number found discrepancy
                                     (discrepancy-shots result discrepancy)
                                     command)))

(defun trace-sections (result object)
  "Return the sections for the traces of RESULT in which no discrepancy was found."
  (loop for trace-result in (discrepancy:result-traces result)
        for trace-json across (key object "traces")
        for number from 1
        unless (discrepancy:trace-result-discrepancies trace-result)
          collect (trace-section number trace-json (trace-shots result trace-result)
                                 (discrepancy:result-domain result)
                                 (discrepancy:trace-result-trace trace-result)
                                 (discrepancy:trace-result-starts-text trace-result))))

(defun page-node (result object command)
  "Return the page of RESULT, whose JSON is OBJECT."
  (let ((title (format nil "~a: plan ~a" (verdict-title (key object "status"))
                       (key object "plan" "name"))))
    `(:html (:lang "en")
       (:head ()
         (:meta (:charset "utf-8"))
         (:meta (:name "viewport" :content "width=device-width, initial-scale=1"))
         (:title () ,title)
         (:style () (:verbatim ,*style*)))
       (:body ()
         (:main ()
           ,(banner-node object)
           ,(figures-node object)
           ,(discrepancy-sections result object command)
           ,(trace-sections result object)
           (:section (:id "search") (:h2 () "The search") ,(facts-node object))
           (:footer () "discrepancy-finder. The result as JSON is in this page, in the element "
                    "with the id result."))
         (:script (:type "application/json" :id "result")
           (:verbatim ,(script-text (json:encode object))))))))

(defun script-text (text)
  "Return the JSON TEXT as it can stand in a script element: without the beginning of an end tag."
  (with-output-to-string (stream)
    (loop for character across text
          do (if (char= character #\<)
                 (write-string "\\u003c" stream)
                 (write-char character stream)))))

(defun write-report (result file &key (command "./discrepancy-finder"))
  "Write RESULT, a SEARCH-RESULT, to FILE as one HTML page that needs nothing else, and return its
name.  The page shows verdict and sentence, what happened, a map with regions, samples and paths,
the steps on both sides, and how COMMAND replays it; it holds the JSON of RESULT.  For the pictures
some samples are run again.  Signals REPLAY-ERROR if FILE cannot be written."
  (let ((page (node-text (page-node result (discrepancy:result-json result) command))))
    (discrepancy:write-file-whole file (format nil "<!DOCTYPE html>~%~a" page))
    (source:native-name (source:native-path file))))
