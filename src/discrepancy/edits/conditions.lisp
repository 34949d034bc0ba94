;;;; Conditions: what tells the examples in which something happened from those in which it did not.
;;;;
;;;; A CONDITION is a list of LITERALS, state formulas over the variables of a lifting, all of which
;;;; must hold.  A ROW is an example: a state and bindings of the variables.  BEST-CONDITIONS finds
;;;; the shortest conditions that hold in the required rows and in none of the bad ones.

(in-package #:discrepancy-finder.discrepancy)

(defparameter *condition-length* 3
  "A condition has at most so many literals.")

(defparameter *literals-tried* 120
  "So many literals are tried in conditions of the greatest length.")

(defparameter *conditions-wanted* 6
  "So many conditions are handed out at most.")

(defparameter *separation-chance* 0.05d0
  "A coordinate, or a literal with elements, that separates the runs counts only if it is at most so
likely that one does by chance.")

(defstruct (row (:constructor make-row (table bindings)) (:copier nil))
  "The observed state TABLE and the BINDINGS of the variables of a lifting."
  (table nil :type hash-table :read-only t)
  (bindings '() :type list :read-only t))

;;; Literals

(defun observed-declarations (domain)
  "Return the declarations (name sort*) of the fluents of DOMAIN that can be observed."
  (let ((names (remove-duplicates (mapcar #'first (observed-atoms (domain-observers domain))))))
    (remove-if-not (lambda (declaration) (member (first declaration) names))
                   (ec:theory-fluents (symbolic:action-theory-theory domain)))))

(defun atoms-over (declarations variables)
  "Return all atoms of DECLARATIONS with arguments among VARIABLES, a list of (variable sort)."
  (loop for (name . sorts) in declarations
        append (let ((argument-lists (list '())))
                 (dolist (sort (reverse sorts))
                   (setf argument-lists
                         (loop for (variable own-sort) in variables
                               when (eq own-sort sort)
                                 append (loop for arguments in argument-lists
                                              collect (cons variable arguments)))))
                 (loop for arguments in argument-lists collect (cons name arguments)))))

(defun fresh-variable (sort variables)
  "Return a variable of SORT that is none of VARIABLES, a list of (variable sort)."
  (let ((same (count sort variables :key #'second)))
    (variable-named sort (and (plusp same) (1+ same)))))

(defun existential-formulas (declarations variables)
  "Return the formulas that some element is in one or two relations with VARIABLES."
  (loop for sort in (remove-duplicates (reduce #'append declarations :key #'rest))
        for fresh = (fresh-variable sort variables)
        for atoms = (remove-if-not (lambda (atom) (= 1 (count fresh (rest atom))))
                                   (atoms-over declarations
                                               (append variables (list (list fresh sort)))))
        append (loop for (atom . others) on atoms
                     collect (list :exists (list fresh) atom)
                     append (loop for other in others
                                  collect (list :exists (list fresh) (list :and atom other))))))

(defun condition-literals (domain variables)
  "Return the literals over VARIABLES, a list of (variable sort), the plain ones first: atoms, their
negations, that two variables differ, and that something exists or does not."
  (let* ((declarations (observed-declarations domain))
         (atoms (atoms-over declarations variables))
         (formulas (existential-formulas declarations variables)))
    (flet ((negations (formulas) (mapcar (lambda (formula) (list :not formula)) formulas)))
      (append atoms (negations atoms)
              (loop for ((one one-sort) . others) on variables
                    append (loop for (other other-sort) in others
                                 when (eq one-sort other-sort)
                                   collect (list :/= one other)))
              formulas (negations formulas)))))

;;; The shortest conditions

(defun truth-mask (theory literal rows)
  "Return the integer whose bit I tells that LITERAL is not known to be false in row I of ROWS."
  (loop for row in rows
        for bit = 1 then (ash bit 1)
        unless (null (formula-truth theory literal (row-table row) (row-bindings row)))
          sum bit))

(defun useful-literals (theory literals required bad-rows good-rows)
  "Return the entries (literal bad good place) of those of LITERALS that hold in all rows of
REQUIRED and are false in some of BAD-ROWS, the ones that exclude most of these first.  BAD and GOOD
are the masks of the rows in which a literal may hold."
  (let ((all-bad (1- (ash 1 (length bad-rows)))))
    (stable-sort
     (loop for literal in literals
           for place from 0
           for bad = (truth-mask theory literal bad-rows)
           when (and (/= bad all-bad)
                     (loop for row in required
                           always (eq t (formula-truth theory literal (row-table row)
                                                       (row-bindings row)))))
             collect (list literal bad (truth-mask theory literal good-rows) place))
     #'< :key (lambda (entry) (logcount (second entry))))))

(defun conditions-of-length (length useful bad good)
  "Return the conditions of LENGTH entries of USEFUL that exclude all rows of the mask BAD, those
first that hold in more rows of the mask GOOD, then those of plainer literals."
  (let ((found '()))
    (labels ((extend (chosen bad good places rest left)
               (cond ((zerop bad) (push (list* (logcount good) places (reverse chosen)) found))
                     ((plusp left)
                      (loop for ((literal mask good-mask place) . more) on rest
                            for new-bad = (logand bad mask)
                            unless (= new-bad bad)
                              do (extend (cons literal chosen) new-bad (logand good good-mask)
                                         (+ places place) more (1- left)))))))
      (extend '() bad good 0
              (if (< length *condition-length*)
                  useful
                  (subseq useful 0 (min *literals-tried* (length useful))))
              length))
    (mapcar #'cddr (stable-sort (reverse found)
                                (lambda (one other)
                                  (or (> (first one) (first other))
                                      (and (= (first one) (first other))
                                           (< (second one) (second other)))))))))

(defun best-conditions (domain literals required bad-rows
                        &key good-rows (acceptable (constantly t))
                          (longest *condition-length*))
  "Return the shortest conditions out of LITERALS that hold in all rows of REQUIRED and in none of
BAD-ROWS, and are ACCEPTABLE, by a function of a condition: a list of lists, at most
*CONDITIONS-WANTED* of at most LONGEST literals.  Of those of the same length, the ones
that hold in more of GOOD-ROWS come first."
  (let ((useful (useful-literals (symbolic:action-theory-theory domain) literals required bad-rows
                                 good-rows)))
    (loop for length from 0 to longest
          for wanted = *conditions-wanted*
          for conditions = (loop for condition in (conditions-of-length
                                                   length useful
                                                   (1- (ash 1 (length bad-rows)))
                                                   (1- (ash 1 (length good-rows))))
                                 while (plusp wanted)
                                 when (funcall acceptable condition)
                                   collect condition and do (decf wanted))
          when conditions return conditions)))
