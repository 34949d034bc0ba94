;;;; The paper's evaluation: Table I, the paper's figures beside ours.
;;;;
;;;; A PAPER-SEARCH is a row of the table: a plan, its domain and state constraint, and what the
;;;; paper reports.  An ITERATION is a trace that is simulated; simulations are those that look for
;;;; a discrepancy, not the one that confirms it.  TABLE1 runs the searches and prints the table
;;;; (table1-text.lisp); for several seeds also how iterations and simulations are distributed; and
;;;; for comparison how long simulation from random states takes to meet a discrepancy of the kind
;;;; that the search has found.

(in-package #:discrepancy-finder)

(defstruct (paper-search (:copier nil))
  "A row of Table I.  DOMAIN is a domain or its name.  The paper needed ITERATIONS, SIMULATIONS and
SECONDS for FOUND."
  (title "" :type string :read-only t)
  (plan nil :type symbol :read-only t)
  (domain nil :read-only t)
  (constraint nil :type keyword :read-only t)
  (iterations 0 :type (integer 0) :read-only t)
  (simulations 0 :type (integer 0) :read-only t)
  (seconds 0 :type (integer 0) :read-only t)
  (found "" :type string :read-only t))

(defparameter *table1*
  (list (make-paper-search
         :title "setting the table" :plan 'discrepancy-finder-user::setting-the-table
         :domain :kitchen
         :constraint :successful-navigation
         :iterations 1 :simulations 12 :seconds 273 :found "object lost in navigation")
        (make-paper-search
         :title "bowl and spoon" :plan 'discrepancy-finder-user::bowl-and-spoon
         :domain :bowl-and-spoon
         :constraint :successful-navigation
         :iterations 2 :simulations 11 :seconds 197 :found "open drawer blocks the way")
        (make-paper-search
         :title "looking into drawers" :plan 'discrepancy-finder-user::looking-into-drawers
         :domain :kitchen-drawers
         :constraint :successful-grasping
         :iterations 1 :simulations 1 :seconds 22
         :found "discretization too coarse for sight and reach")
        (make-paper-search
         :title "bowl and spoon, modified"
         :plan 'discrepancy-finder-user::bowl-and-spoon-closing
         :domain :bowl-and-spoon-closing
         :constraint :successful-navigation
         :iterations 3 :simulations 20 :seconds 289 :found "nothing"))
  "The rows of Table I.")

(defparameter *table1-confidence* 0.99d0
  "The confidence of the searches of Table I.")

;;; Running a search

(defun run-paper-search (search rule seed)
  "Return the SEARCH-RESULT of SEARCH, by the confidence rule named RULE with SEED."
  (find-discrepancies (paper-search-plan search)
                      :domain (paper-search-domain search)
                      :constraint (paper-search-constraint search)
                      :confidence *table1-confidence* :rule rule :seed seed :budget 10000
                      :shrink nil :explain nil))

(defun looking-simulations (result)
  "Return the number of simulations of RESULT that looked for a discrepancy: not the one that
confirms it."
  (- (result-simulations result)
     (reduce #'+ (remove :confirm (discrepancy:result-phases result)
                         :key #'discrepancy:phase-name :test-not #'eq)
             :key #'discrepancy:phase-simulations)))

(defun found-text (result)
  "Return the kind of the discrepancy of RESULT, or what else the search came to."
  (let ((discrepancy (result-discrepancy result)))
    (cond (discrepancy (discrepancy:kind-text discrepancy))
          ((eq (result-status result) :certified) "nothing")
          (t (format nil "undecided: ~a" (result-reason result))))))

(defun random-simulation (search result seed)
  "Return the BLIND-RESULT of looking for what RESULT of SEARCH has found, or NIL if that is
nothing."
  (when (result-discrepancy result)
    (discrepancy:simulate-blindly (paper-search-plan search)
                                  :domain (paper-search-domain search) :seed seed
                                  :kinds (list (discrepancy:discrepancy-kind
                                                (result-discrepancy result))))))

;;; All of them

(defstruct (table1-row (:copier nil))
  "What SEARCH came to by RULE: RESULTS, a list of (seed . search-result), and RANDOM, a list of
(seed . blind-result or NIL)."
  (search nil :type paper-search :read-only t)
  (rule :paper :type keyword :read-only t)
  (results '() :type list)
  (random '() :type list))

(defun run-row (row seeds brute-force progress)
  "Fill in ROW for SEEDS; PROGRESS is called with the row and the seed before each search."
  (let ((search (table1-row-search row)))
    (dolist (seed seeds row)
      (funcall progress row seed)
      (let ((result (run-paper-search search (table1-row-rule row) seed)))
        (push (cons seed result) (table1-row-results row))
        (when brute-force
          (push (cons seed (random-simulation search result seed)) (table1-row-random row)))))
    (setf (table1-row-results row) (reverse (table1-row-results row))
          (table1-row-random row) (reverse (table1-row-random row)))
    row))

(defun table1-rows (several)
  "Return the rows that are to be run: the four searches by the paper's rule, and with SEVERAL seeds
the last one by the rule :SOUND, too."
  (append (mapcar (lambda (search) (make-table1-row :search search)) *table1*)
          (when several
            (list (make-table1-row :search (first (last *table1*)) :rule :sound)))))

(defun table1 (&key (seed 1) (seeds 1) brute-force (stream *standard-output*)
                 (progress (constantly nil)))
  "Run the searches of the paper's Table I, print the paper's figures beside ours to STREAM, and
return the list of the TABLE1-ROWs.  SEED is that of the first run of each search, an integer of 64
bits.  SEEDS, a positive integer, is the number of runs, with seeds that follow each other; if it is
more than 1 distributions are printed, and the last search is also run by the rule :SOUND.  With
BRUTE-FORCE each discrepancy is also sought by simulation from random initial states.  PROGRESS is
called with a row and a seed before each search.  Signals what FIND-DISCREPANCIES signals."
  (unless (typep seed '(unsigned-byte 64))
    (error 'invalid-argument :name 'seed :value seed :expected "an integer from 0 to 2^64 - 1"))
  (unless (typep seeds '(integer 1))
    (error 'invalid-argument :name 'seeds :value seeds :expected "a positive integer"))
  (let ((rows (loop with all = (loop for number from seed repeat seeds collect number)
                    for row in (table1-rows (> seeds 1))
                    collect (run-row row all (and brute-force (eq (table1-row-rule row) :paper))
                                     progress))))
    (write-string (table1-text rows) stream)
    rows))
