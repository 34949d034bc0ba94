;;;; The command table1: its text, for one seed and for several, and the searches of the paper.

(in-package #:discrepancy-finder.tests)

(def-suite table1 :in all)
(in-suite table1)

(defun small-table1 ()
  "Return rows of the table that take no time: Example 1 of the paper with a short and a long arm."
  (flet ((row (title reach found)
           (discrepancy-finder::make-paper-search
            :title title :plan 'discrepancy-finder-user::move-the-box
            :domain (discrepancy:domain-with-parameters
                     (discrepancy:ensure-domain :two-regions) (list :reach reach))
            :constraint :box-delivered :iterations 1 :simulations 5 :seconds 10 :found found)))
    (list (row "a short arm" 0.5d0 "a box out of reach") (row "a long arm" 0.8d0 "nothing"))))

(defun decimal-word-p (word)
  "Return true if WORD is a number with a point, such as 0.04 or 12.30;"
  (and (find #\. word)
       (every (lambda (char) (or (digit-char-p char) (find char ".;"))) word)))

(defun table1-lines (&rest options)
  "Return the lines that TABLE1 prints for SMALL-TABLE1, empty ones left out, as lists of words; the
numbers with a point, most of them seconds, are #."
  (let ((discrepancy-finder::*table1* (small-table1)))
    (loop for line in (uiop:split-string
                       (with-output-to-string (stream)
                         (apply #'df:table1 :stream stream options))
                       :separator '(#\Newline))
          for words = (loop for word in (uiop:split-string line)
                            unless (string= word "")
                              collect (if (decimal-word-p word) "#" word))
          when words collect (format nil "~{~a~^ ~}" words))))

(defparameter *one-seed-lines*
  '("Table I, rule paper, confidence 0.99, seed 1"
    "paper ours"
    "plan iter. sim. s iter. sim. s found"
    "a short arm 1 5 10 1 1 # pick-up ends with manipulation-pose-unreachable"
    "a long arm 1 5 10 1 5 # nothing"
    "in all 2 10 20 2 6 #"
    "a short arm"
    "paper: a box out of reach"
    #.(format nil "ours: step 2, (an action (type picking-up) (object (an object (type box)))); ~
                   (holding-box) is true in the theory, false in the simulation")
    "manipulation-pose-unreachable: the box is # m from the shoulder, which reaches # m"
    "a long arm"
    "paper: nothing"
    "ours: nothing")
  "What TABLE1 prints for one seed.")

(test one-seed-fills-a-table
  (is (equal *one-seed-lines* (table1-lines))))

(defparameter *several-seeds-lines*
  '("Seeds 1 to 3: smallest / middle / mean / largest"
    "a short arm, rule paper"
    "iterations 1 / 1 / # / 1"
    "simulations 1 / 2 / # / 5"
    "seconds # in all"
    "found pick-up ends with manipulation-pose-unreachable: 3 times"
    "a long arm, rule paper"
    "iterations 1 / 1 / # / 1"
    "simulations 5 / 5 / # / 5"
    "seconds # in all"
    "found nothing: 3 times"
    "a long arm, rule sound"
    "iterations 1 / 1 / # / 1"
    "simulations 117 / 117 / # / 117"
    "seconds # in all"
    "found nothing: 3 times"
    "Simulation from random initial states over the whole state space, until there is a"
    "discrepancy of the same kind"
    "a short arm"
    "simulations 1 / 5 / # / 7"
    "seconds # 36 initial states drawn in vain"
    "met pick-up, manipulation-pose-unreachable: 3 times"
    "met move, navigation-goal-not-reached: 1 time"
    "a long arm"
    "nothing to look for")
  "What TABLE1 prints below that for several seeds, with the baseline.")

(test several-seeds-show-distributions
  (is (equal (append *one-seed-lines* *several-seeds-lines*)
             (table1-lines :seeds 3 :brute-force t))))

(test distributions-are-told-by-four-numbers
  (is (equal "1 / 3 / 4.0 / 10" (discrepancy-finder::distribution-text '(10 1 2 4 3))))
  (is (equal '((b . 3) (a . 1)) (discrepancy-finder::counted '(b a b b)))))

(test the-readme-shows-table1
  "The rows of the plans in which something is found; the last takes long."
  (flet ((rows (lines)
           (loop for line in lines
                 for words = (remove "" (uiop:split-string line) :test #'string=)
                 when (find (first words) '("setting" "bowl" "looking") :test #'equal)
                   collect (substitute-if "#" #'decimal-word-p words))))
    (let ((discrepancy-finder::*table1* (subseq discrepancy-finder::*table1* 0 3)))
      (is (equal (subseq (rows (readme-block "Table I,")) 0 3)
                 (subseq (rows (uiop:split-string
                                (with-output-to-string (stream) (df:table1 :stream stream))
                                :separator '(#\Newline)))
                         0 3))))))

(test table1-takes-positive-numbers-of-seeds
  (signals-with (df:invalid-argument "seeds")
    (df:table1 :seeds 0))
  (signals-with (df:invalid-argument "seed")
    (df:table1 :seed -1)))

(defun kitchen-row (rows rule number)
  (nth number (remove rule rows :key #'discrepancy-finder::table1-row-rule :test-not #'eq)))

(defun kinds-of (row)
  "Return the list of the kinds of the discrepancies that ROW has found, :NONE where there is none."
  (loop for (nil . result) in (discrepancy-finder::table1-row-results row)
        collect (let ((discrepancy (df:result-discrepancy result)))
                  (cond (discrepancy (discrepancy:discrepancy-kind discrepancy))
                        ((eq (df:result-status result) :certified) :none)
                        (t :undecided)))))

(test the-paper-s-results-come-out
  "Plan 1 loses an object on the way, plan 2 also stops before an open drawer, plan 3 does not see
or reach the spoon, and nothing is found along the modified plan, by either rule."
  (when *long*
    (let ((rows (df:table1 :seeds 20 :stream (make-broadcast-stream))))
      (is (every (lambda (kind) (equal kind '(:navigate :holding)))
                 (kinds-of (kitchen-row rows :paper 0))))
      (let ((kinds (kinds-of (kitchen-row rows :paper 1))))
        (is (find '(:navigate :holding) kinds :test #'equal))
        (is (find-if (lambda (kind) (and (consp kind) (eq (first kind) :navigate)
                                         (not (eq (second kind) :holding))))
                     kinds)
            "~a" kinds))
      (is (every (lambda (kind) (and (consp kind) (member (first kind) '(:detect :pick-up))))
                 (kinds-of (kitchen-row rows :paper 2)))
          "~a" (kinds-of (kitchen-row rows :paper 2)))
      (dolist (row (list (kitchen-row rows :paper 3) (kitchen-row rows :sound 0)))
        (is (every (lambda (kind) (eq kind :none)) (kinds-of row)) "~a" (kinds-of row))))))
