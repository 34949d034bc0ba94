;;;; Conditions with elements of the theory: what an action requires for one of its arguments, or of
;;;; one thing that it does not speak of, such as that it is not drawer-2 that stands open.
;;;;
;;;; Such conditions are many, and a few runs are separated by one of them anyhow.  So they are only
;;;; asked for where nothing over variables separates the runs; they have one literal; and it must
;;;; be unlikely that one of so many separates the runs by chance.  Runs around a failure count as
;;;; others do: each could have refuted the literal.  A PATTERN here is an event in which some of
;;;; the variables are replaced by the elements that the failure had; more general ones come first.
;;;; Where the failure names an element, the literals that speak of it are preferred: that is a
;;;; hint; what is required is always true before each success and false before each failure.
;;;; Entry point: CONSTANT-HYPOTHESES.

(in-package #:discrepancy-finder.discrepancy)

(defparameter *constant-literals* 400
  "So many literals with elements are tried for a pattern at most.")

(defparameter *constant-conditions* 2
  "So many conditions with elements are handed out at most.")

(defun mentions-element-p (formula)
  "Return true if the atom or state formula FORMULA has an element among its arguments."
  (and (consp formula)
       (case (first formula)
         ((:and :or :not) (some #'mentions-element-p (rest formula)))
         (:exists (mentions-element-p (third formula)))
         (t (notevery #'variable-p (rest formula))))))

(defun named-in-p (element text)
  "Return true if TEXT speaks of ELEMENT: has its name, with - or _ between words."
  (let ((name (if (symbolp element) (ec:name-text element) (return-from named-in-p nil)))
        (text (substitute #\- #\_ (string-downcase text))))
    (flet ((part-of-name-p (place)
             (and (< -1 place (length text))
                  (let ((character (char text place)))
                    (or (alphanumericp character) (char= character #\-))))))
      (loop for start = (search name text) then (search name text :start2 (1+ start))
            while start
              thereis (not (or (part-of-name-p (1- start))
                               (part-of-name-p (+ start (length name)))))))))

(defun beginning (list count)
  "Return the first COUNT elements of LIST, or all."
  (loop for element in list repeat count collect element))

(defun patterns-for (theory event)
  "Return the patterns of EVENT as (pattern . variables), the general ones first; VARIABLES is a
list of (variable sort)."
  (multiple-value-bind (general lifting) (general-pattern theory event)
    (let ((choices (list '())))
      ;; Which of the arguments are elements: all sets of them.
      (loop repeat (length lifting)
            do (setf choices (append (mapcar (lambda (choice) (cons nil choice)) choices)
                                     (mapcar (lambda (choice) (cons t choice)) choices))))
      (loop for choice in (stable-sort choices #'< :key (lambda (choice) (count t choice)))
            collect (cons (cons (first general)
                                (loop for element-p in choice
                                      for variable in (rest general)
                                      for element in (rest event)
                                      collect (if element-p element variable)))
                          (loop for element-p in choice
                                for (variable sort) in lifting
                                unless element-p collect (list variable sort)))))))

(defun constant-literals (domain variables report)
  "Return literals with elements, and maybe some of VARIABLES, a list of (variable sort): those
first that speak of what the text REPORT names, and of these the negated ones, since what an action
does not mention is rather in its way than needed; and the number of those that speak of what is
named."
  (let* ((theory (symbolic:action-theory-theory domain))
         (declarations (observed-declarations domain))
         (elements (loop for sort in (remove-duplicates (reduce #'append declarations :key #'rest))
                         append (loop for element in (ec:sort-elements theory sort)
                                      collect (list element sort))))
         (named (remove-if-not (lambda (element) (named-in-p element report))
                               (mapcar #'first elements)))
         (atoms (remove-if-not #'mentions-element-p
                               (atoms-over declarations (append variables elements)))))
    (flet ((literals (atoms)
             (append (mapcar (lambda (atom) (list :not atom)) atoms) atoms))
           (named-p (atom) (intersection (rest atom) named)))
      (let ((first (literals (remove-if-not #'named-p atoms)))
            (others (literals (remove-if #'named-p atoms))))
        (values (beginning (append first others) *constant-literals*)
                (min *constant-literals* (length first)))))))

(defun literal-chance (count successes failures)
  "Return a bound of the probability that one of COUNT literals, which have nothing to do with it,
is true before each of so many SUCCESSES and false before each of so many FAILURES."
  (/ (float count 1d0) (alexandria:binomial-coefficient (+ successes failures) failures)))

(defun constant-hypotheses (domain transitions transition)
  "Return (values conditions pattern): what the success of the action of TRANSITION, which has
failed, requires, by all of TRANSITIONS; each a list of one literal over PATTERN.  There are none
where too few of TRANSITIONS speak for them."
  (loop with theory = (symbolic:action-theory-theory domain)
        with ours = (remove transition transitions :test-not #'same-action-p)
        with patterns = (patterns-for theory (transition-success transition))
        for (pattern . variables) in patterns
        for successes = (success-rows ours pattern t)
        for failures = (success-rows ours pattern nil)
        do (multiple-value-bind (literals named)
               (constant-literals domain variables (transition-report transition))
             (flet ((conditions (literals)
                      (beginning (best-conditions domain literals successes failures :longest 1)
                                 *constant-conditions*)))
               (when (and successes
                          (<= (literal-chance (* (length patterns) (length literals))
                                              (length successes) (length failures))
                              *separation-chance*))
                 (let ((conditions (or (conditions (subseq literals 0 named))
                                       (conditions (append (condition-literals domain variables)
                                                           (nthcdr named literals))))))
                   (when conditions
                     (return (values conditions pattern)))))))))
