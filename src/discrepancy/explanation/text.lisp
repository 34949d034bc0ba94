;;;; Explanations in words, and as JSON.

(in-package #:discrepancy-finder.discrepancy)

;;; What the theory says

(defun truth-text (truth)
  (if truth "true" "false"))

(defun event-text (event)
  (if event (ec:atom-text event) "a step in which nothing happens"))

(defun without-mentions (text prefix)
  "Return TEXT without the mentions of axioms whose names begin with PREFIX, \" (because of axiom
observed-in-the-run-3)\"."
  (let ((mention (format nil " (because of axiom ~(~a~)" prefix)))
    (loop for start = (search mention text)
          while start
          do (let ((end (position #\) text :start start)))
               (setf text (concatenate 'string (subseq text 0 start) (subseq text (1+ end))))))
    text))

(defun told-sentence-p (sentence)
  "Return true if SENTENCE only says that something is as it was seen in the run."
  (loop for prefix in (list *fact-prefix* *event-prefix*)
        thereis (search (format nil "because of axiom ~(~a~)" prefix) sentence)))

(defun replaced-text (text old new)
  "Return TEXT with NEW in the place of each OLD."
  (loop for start = (search old text)
        while start
        do (setf text (concatenate 'string (subseq text 0 start) new
                                   (subseq text (+ start (length old))))))
  text)

(defun derivation-texts (claim)
  "Return the sentences by which the reasoner derives CLAIM, but for what was seen in the run."
  (remove-duplicates
   (loop for explanation in (claim-explanations claim)
         append (loop for sentence in (ec:explanation-sentences explanation)
                      for text = (replaced-text (without-mentions sentence *fact-prefix*)
                                                (format nil "axiom ~(~a~)" *outcome-name*)
                                                "how the step ended")
                      unless (told-sentence-p text) collect text))
   :test #'string= :from-end t))

(defun inertia-text (atom truth event)
  (format nil "~a persists by inertia through ~a: no axiom ~:[initiates~;terminates~] it."
          (ec:atom-text atom) (event-text event) truth))

(defun persists-p (claim atom event)
  "Return true if ATOM persists through EVENT by inertia in CLAIM."
  (find-if (lambda (entry) (and (equal (first entry) atom) (equal (third entry) event)))
           (claim-persistent claim)))

(defun claim-texts (claim event)
  "Return the sentences why the theory claims CLAIM after EVENT."
  (destructuring-bind (&optional fluent &rest more) (claim-fluents claim)
    (cond ((null (claim-explanations claim))
           '("The theory leaves it open; the trace has one of the possibilities."))
          ((and fluent (null more) (persists-p claim (car fluent) event))
           (list (inertia-text (car fluent) (cdr fluent) event)))
          ((derivation-texts claim))
          (t (list (format nil "It rests on ~{~a~^, ~}."
                           (or (mapcar #'ground-text (claim-grounds claim))
                               '("what was seen"))))))))

(defun origin-text (origin)
  (format nil "~a is ~a ~:[from the beginning~*~*~;since step ~:*~d, ~a~@[ (axiom~p ~{~a~^, ~
               ~})~]~]."
          (ec:atom-text (origin-atom origin)) (truth-text (origin-truth origin))
          (and (origin-step origin) (1+ (origin-step origin)))
          (event-text (origin-event origin))
          (and (origin-axioms origin) (length (origin-axioms origin)))
          (mapcar #'ec:name-text (origin-axioms origin))))

(defparameter *origins-shown* 8
  "So many facts that a claim rests on are told.")

(defun origin-texts (claim)
  (let ((origins (claim-origins claim)))
    (append (loop for origin in origins
                  repeat *origins-shown* collect (origin-text origin))
            (and (> (length origins) *origins-shown*)
                 (list (format nil "~d more facts are as they were seen."
                               (- (length origins) *origins-shown*)))))))

(defun claim-headline (claim)
  (format nil "~{~a is ~a~^, or ~}"
          (loop for (atom . truth) in (claim-fluents claim)
                collect (ec:atom-text atom) collect (truth-text truth))))

(defun ending-texts (explanation)
  "Return the sentences why the theory does not allow the step of EXPLANATION to end as it did."
  (let ((ending (explanation-ending explanation))
        (outcomes (explanation-outcomes explanation)))
    (cond (outcomes
           (append
            (list (format nil "The action binding has no such outcome: it has ~{~(~a~)~^, ~}."
                          outcomes))
            (and ending
                 (list (format nil "By the action binding it succeeds where ~a, as it was there."
                               (explanation-condition explanation))))
            (and ending (claim-axioms ending) (derivation-texts ending))
            (and ending (origin-texts ending))))
          ((null ending) '("No reason was found."))
          (t (append
              (and (explanation-condition explanation)
                   (list (format nil "By the action binding it can end so only where ~a."
                                 (explanation-condition explanation))))
              (and (claim-axioms ending)
                   (derivation-texts ending))
              (origin-texts ending))))))

;;; Coordinates and edits

(defun quantity-text (parameter value)
  "Return the text of VALUE of PARAMETER with its unit."
  (subseq (value-text parameter value) (+ 3 (length (parameter-name parameter)))))

(defun seen-text (influence)
  "Return what the search had seen of the parameter of INFLUENCE, as a clause, or NIL."
  (let ((parameter (first (influence-parameters influence))))
    (and (influence-seen influence)
         (format nil "~{~a~^, ~}"
                 (loop for (count least greatest) in (influence-seen influence)
                       for agrees = t then nil
                       collect (format nil "in the ~d run~:p that ~:[did not~;agreed~] it was ~
                                            ~:[from ~a to ~;~*~]~a"
                                       count agrees (= least greatest)
                                       (quantity-text parameter least)
                                       (quantity-text parameter greatest)))))))

(defun influence-text (influence)
  "Return what INFLUENCE says, as a sentence."
  (let ((parameters (influence-parameters influence)))
    (flet ((all-text (values)
             (format nil "~{~a~^ and ~}" (mapcar #'value-text parameters values))))
      (if (rest parameters)
          (format nil "Together: ~a fails still, ~a agrees."
                  (all-text (influence-failing influence))
                  (all-text (influence-agreeing influence)))
          (destructuring-bind (here failing agreeing)
              (loop for values in (list (influence-here influence) (influence-failing influence)
                                        (influence-agreeing influence))
                    collect (quantity-text (first parameters) (first values)))
            (format nil "~a, ~a here: ~a ~:[fails still~;fails~], ~a agrees~@[; ~a~]."
                    (parameter-name (first parameters)) here failing (string= here failing)
                    agreeing (seen-text influence)))))))

(defun runs-text (explanation)
  (format nil "Of the ~d run~:p of this trace ~d agree~p; ~d further run~:p ~
               ~:*~[were~;was~:;were~] made for this."
          (+ (explanation-agreeing explanation) (explanation-differing explanation))
          (explanation-agreeing explanation)
          (if (= 1 (explanation-agreeing explanation)) 2 1)
          (explanation-probes explanation)))

(defun explanation-text (explanation)
  "Return EXPLANATION in words, a text of several lines."
  (with-output-to-string (stream)
    (flet ((lines (indent texts)
             (dolist (text texts)
               (format stream "~a~a~%" (make-string indent :initial-element #\Space) text))))
      (format stream "  why (timepoint n is after step n)~%")
      (when (eq (explanation-kind explanation) :outcome)
        (format stream "    the theory forbids that step ~d, ~a, ends with ~a~%"
                (1+ (explanation-step explanation)) (explanation-action explanation)
                (string-right-trim "." (explanation-outcome explanation)))
        (lines 6 (ending-texts explanation)))
      (dolist (claim (explanation-claims explanation))
        (format stream "    the theory ~:[says~;would have said~] that ~a after step ~d~%"
                (eq (explanation-kind explanation) :outcome) (claim-headline claim)
                (1+ (explanation-step explanation)))
        (lines 6 (append (claim-texts claim (explanation-event explanation))
                         (origin-texts claim))))
      (format stream "  coordinates that decide, all else as in this sample~%")
      (lines 4 (or (mapcar #'influence-text (explanation-influences explanation))
                   '("none was found.")))
      (lines 4 (list (runs-text explanation)))
      (when (explanation-edits explanation)
        (format stream "  candidate edits~[~:;~:*, checked against ~d run~:p of other traces, ~
                        too~]~%"
                (explanation-others explanation))
        (loop for edit in (explanation-edits explanation)
              for number from 1
              do (format stream "    ~d. ~a~%       ~a~%" number (edit-text edit)
                         (edit-verdict-text edit)))))))

;;; JSON

(defun ground-json (ground)
  (destructuring-bind (kind name &optional other truth) ground
    (ecase kind
      (:axiom (json:object "axiom" (ec:name-text name)))
      (:inertia (json:object "inertia" (ec:name-text name)
                             "through" (json-or-null (and other (ec:name-text other)))
                             "truth" (json-boolean truth)))
      (:binding (json:object "binding" (format nil "~a ~a" (ec:name-text name)
                                               (ec:name-text other)))))))

(defun claim-json (claim event)
  (json:object
   "fluents" (map 'vector (lambda (fluent)
                            (vector (ec:atom-text (car fluent)) (json-boolean (cdr fluent))))
                  (claim-fluents claim))
   "reasons" (coerce (append (claim-texts claim event) (origin-texts claim)) 'vector)
   "grounds" (map 'vector #'ground-json (claim-grounds claim))))

(defun influence-json (influence)
  (json:object
   "parameters" (map 'vector #'parameter-name (influence-parameters influence))
   "failing" (coerce (influence-failing influence) 'vector)
   "agreeing" (coerce (influence-agreeing influence) 'vector)
   "text" (influence-text influence)))

(defun edit-json (edit)
  (json:object
   "text" (edit-text edit)
   "removes" (json-boolean (edit-removes-p edit))
   "contradicted" (edit-contradicted edit)
   "runs" (edit-runs edit)
   "support" (if (edit-support edit) (coerce (edit-support edit) 'vector) :null)
   "verdict" (edit-verdict-text edit)))

(defun explanation-json (explanation)
  "Return EXPLANATION as a JSON object: the keys are step, action, kind, ending (null where the
states differ), claims, grounds, coordinates, runs and edits."
  (json:object
   "step" (1+ (explanation-step explanation))
   "action" (explanation-action explanation)
   "kind" (string-downcase (explanation-kind explanation))
   "ending" (if (eq (explanation-kind explanation) :outcome)
                (json:object "outcome" (explanation-outcome explanation)
                             "reasons" (coerce (ending-texts explanation) 'vector))
                :null)
   "claims" (map 'vector (lambda (claim) (claim-json claim (explanation-event explanation)))
                 (explanation-claims explanation))
   "grounds" (map 'vector #'ground-json (explanation-grounds explanation))
   "coordinates" (map 'vector #'influence-json (explanation-influences explanation))
   "runs" (json:object "agreeing" (explanation-agreeing explanation)
                       "differing" (explanation-differing explanation)
                       "further" (explanation-probes explanation))
   "edits" (map 'vector #'edit-json (explanation-edits explanation))))
