;;;; The timeline: a trace, step by step, in the theory and in the simulation.
;;;;
;;;; All that is shown here comes from the JSON of the result.  States are arrays of true fluents; a
;;;; step shows what has changed by it.

(in-package #:discrepancy-finder.report)

(defun key (object &rest names)
  "Return what is in OBJECT under the first of NAMES, in that under the second, and so on; NIL where
something is null."
  (dolist (name names object)
    (setf object (json:get-key object name))
    (when (eq object :null) (return nil))))

(defun texts (array)
  (coerce array 'list))

(defun capitalized (text)
  (if (string= text "") text (concatenate 'string (string-upcase (subseq text 0 1))
                                          (subseq text 1))))

;;; Designators

(defun designator-type (text)
  "Return the value of the first key type in the designator TEXT, or TEXT."
  (let* ((start (search "(type " text))
         (end (and start (position-if (lambda (character) (find character " )"))
                                      text :start (+ start 6)))))
    (if end (subseq text (+ start 6) end) text)))

(defun step-name-node (step)
  (let ((text (key step "designator")))
    `((:span (:class "action") ,(designator-type text)) " "
      (:span (:class "designator") ,text) " "
      ,(and (key step "file")
            (let ((place (format nil "~a:~d" (key step "file") (key step "line"))))
              ;; With its folders the name is longer than all else in the row.
              `(:span (:class "place" :title ,place)
                 ,(subseq place (1+ (or (position #\/ place :from-end t) -1)))))))))

;;; States

(defun changes (before after)
  "Return the list of (sign . fluent) of the fluents that are in only one of BEFORE and AFTER, lists
of texts."
  (append (loop for fluent in after
                unless (member fluent before :test #'string=) collect (cons "+" fluent))
          (loop for fluent in before
                unless (member fluent after :test #'string=) collect (cons "−" fluent))))

(defun change-nodes (changes marked)
  "Return chips for CHANGES; those of the fluents MARKED stand out."
  (if changes
      (loop for (sign . fluent) in changes
            collect `(:span (:class ,(format nil "chip ~:[false~;true~]~:[~; marked~]"
                                             (string= sign "+")
                                             (member fluent marked :test #'string=)))
                            ,sign " " ,fluent)
            collect " ")
      nil))

(defun outcome-node (step)
  (let ((outcome (key step "outcome")))
    (if (string= outcome "success")
        '(:span (:class "success") "success")
        `(:span (:class "failure") ,outcome))))

;;; Rows

(defun hidden-changes-node (changes)
  "Return a line that tells CHANGES of fluents that cannot be observed."
  (and changes
       `(:div (:class "hidden")
          "not observed: "
          ,(format nil "~:{~a ~a~:^, ~}" (loop for (sign . fluent) in changes
                                               collect (list sign fluent))))))

(defun theory-cell (step before marked observable)
  "Return the cell that tells STEP of the theory; OBSERVABLE are the fluents that can be observed,
or :ALL."
  (let* ((changes (changes before (texts (key step "state"))))
         (seen (remove-if-not (lambda (change)
                                (or (eq observable :all)
                                    (member (cdr change) observable :test #'string=)))
                              changes)))
    `(:td () (:div () (:code () ,(or (key step "event") "nothing happens")) " · "
                ,(outcome-node step))
            (:div (:class "changes") ,(change-nodes seen marked))
            ,(hidden-changes-node (set-difference changes seen)))))

(defun failure-message (text outcome)
  "Return TEXT, which tells a failure, without the name of its class OUTCOME at the beginning."
  (let ((beginning (format nil "~a: " outcome)))
    (if (uiop:string-prefix-p beginning text)
        (subseq text (length beginning))
        text)))

(defun simulation-cell (step before marked class)
  `(:td (:class ,class)
     (:div () ,(outcome-node step))
     ,(and (key step "failure")
           `(:div (:class "message") ,(failure-message (key step "failure") (key step "outcome"))))
     (:div (:class "changes") ,(change-nodes (changes before (texts (key step "state")))
                                             marked))))

(defun divergence-note (divergence)
  "Return the sentences that tell what DIVERGENCE is."
  `(:div (:class "note")
     ,(if (string= (key divergence "kind") "outcome")
          "The theory forbids this outcome."
          "The theory forbids the state after this step.")
     ,(loop for fluent across (key divergence "fluents")
            collect (destructuring-bind (text theory simulation) (coerce fluent 'list)
                      `(" " (:code () ,text)
                            ,(format nil " is ~(~a~) in the theory, ~(~a~) in the simulation."
                                     theory simulation))))))

(defun diverging-fluents (divergence)
  (and divergence
       (loop for fluent across (key divergence "fluents") collect (svref fluent 0))))

(defun row-node (number theory simulation before divergence observable)
  "Return the row of step NUMBER.  BEFORE are the states before it, lists of texts, in theory and
simulation; THEORY and SIMULATION the step there, or NIL; OBSERVABLE the fluents that the simulation
shows, or :ALL if there was none."
  (let* ((here (and divergence (= number (key divergence "step"))))
         (ran (listp observable))
         (marked (and here (diverging-fluents divergence))))
    `((:tr (:id ,(and here (format nil "step-~d" number))
            :class ,(cond (here "diverging") ((and ran (null simulation)) "not-run")))
        (:td (:class "number") ,number)
        (:td () ,(step-name-node (or theory simulation)))
        ,(if theory
             (theory-cell theory (first before) marked observable)
             '(:td (:class "quiet") "not in the trace"))
        ,(cond (simulation (simulation-cell simulation (second before) marked
                                            (if here "parting" "agreeing")))
               (ran '(:td (:class "quiet") "not reached"))))
      ,(and here `(:tr (:class "diverging note-row")
                    (:td ()) (:td (:colspan 3) ,(divergence-note divergence)))))))

(defun state-after (side number)
  "Return the state of SIDE, an object, after its step NUMBER, counted from 1."
  (texts (if (zerop number)
             (key side "initial")
             (key (svref (key side "steps") (1- number)) "state"))))

(defun timeline-node (theory simulation divergence)
  "Return the table of the steps of THEORY and SIMULATION, objects of a result; SIMULATION and
DIVERGENCE may be NIL."
  (let ((theory-steps (key theory "steps"))
        (simulation-steps (if simulation (key simulation "steps") #())))
    `(:table (:class "timeline")
       (:thead () (:tr () (:th (:class "number") "Step") (:th () "Action")
                       (:th () "In the theory")
                       ,(and simulation
                             `(:th () ,(format nil "In the simulation of sample ~d"
                                               (key simulation "sample"))))))
       (:tbody ()
         ,(loop for number from 1 to (max (length theory-steps) (length simulation-steps))
                for in-theory = (<= number (length theory-steps))
                for simulated = (<= number (length simulation-steps))
                collect (row-node number
                                  (and in-theory (svref theory-steps (1- number)))
                                  (and simulated (svref simulation-steps (1- number)))
                                  (list (and in-theory (state-after theory (1- number)))
                                        (and simulated (state-after simulation (1- number))))
                                  divergence
                                  (if simulation
                                      (texts (key simulation "observable"))
                                      :all)))))))

;;; States side by side

(defun truth-node (known true)
  (cond ((not known) '(:td (:class "quiet") "not observed"))
        (true '(:td (:class "is-true") "true"))
        (t '(:td (:class "is-false") "false"))))

(defun states-node (theory simulation observable)
  "Return a table of the fluents that are true in one of the states THEORY and SIMULATION, lists of
texts; in the simulation only OBSERVABLE ones are known."
  (flet ((in-p (fluent state) (and (member fluent state :test #'string=) t)))
    `(:table (:class "states")
       (:thead () (:tr () (:th () "Fluent") (:th () "Theory") (:th () "Simulation")))
       (:tbody ()
         ,(loop for fluent in (sort (union (copy-list theory) (copy-list simulation)
                                           :test #'string=)
                                    #'string<)
                for known = (in-p fluent observable)
                for differs = (and known (not (eq (in-p fluent theory)
                                                  (in-p fluent simulation))))
                collect `(:tr (:class ,(and differs "differs"))
                           (:td () (:code () ,fluent))
                           ,(truth-node t (in-p fluent theory))
                           ,(truth-node known (in-p fluent simulation))))))))
