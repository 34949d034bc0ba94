;;;; Predicate completion: circumscription where a predicate occurs positively in heads only.
;;;;
;;;; An atom p is true only if some sentence supports it.  In the Discrete Event Calculus Reasoner a
;;;; sentence in clauses supports p by each clause with p, where the other literals are false.  In
;;;; a model of the sentence that is so just if the sentence, with false in the place of p, is
;;;; false; so p is completed as
;;;;   p -> not S1[p := false] or not S2[p := false] or ...
;;;; without clauses.  A disjunctive sentence makes its events exclusive, as it does there.
;;;;
;;;; Where the supports of an atom lie at the same distances whatever the timepoint, the completion
;;;; is a template; else it is made for each timepoint of the horizon.

(in-package #:discrepancy-finder.event-calculus)

(defun map-positive-atoms (function formula &optional (positive t))
  "Call FUNCTION with each atom of the ground FORMULA that occurs positively."
  (when (consp formula)
    (case (first formula)
      (:not (map-positive-atoms function (second formula) (not positive)))
      ((:and :or)
       (dolist (part (rest formula)) (map-positive-atoms function part positive)))
      (:iff (dolist (part (rest formula))
              (map-positive-atoms function part t)
              (map-positive-atoms function part nil)))
      (t (when positive (funcall function formula))))))

(defun completed-kind (predicate declaration)
  (cond ((eq predicate :happens) :event)
        ((= 1 (count :time (rest declaration))) :predicate)
        (t :static)))

(defun completed-atoms (ground predicate kind open-events)
  "Return the numbers of the ground atoms of PREDICATE."
  (flet ((numbers (atoms)
           (loop for atom across atoms
                 for index from 0
                 when (eq (first atom) predicate) collect index)))
    (ecase kind
      (:event (loop for event across (ground-theory-events ground)
                    for index from 0
                    unless (member (first event) open-events) collect index))
      (:predicate (numbers (atom-table-atoms (ground-theory-predicates ground))))
      (:static (numbers (atom-table-atoms (ground-theory-statics ground)))))))

(defun supports (ground kind label &optional (sentences (ground-theory-sentences ground)))
  "Return a table from the number of an atom of KIND to the list of (sentence . distance) in which
it occurs positively, in those of SENTENCES whose axiom has LABEL."
  (let ((table (make-hash-table)))
    (dolist (sentence sentences table)
      (let ((own (let ((axiom (sentence-axiom sentence)))
                   (and (axiom-p axiom) (axiom-label axiom)))))
        (when (if label (eq own label) (not (eq own +facts+)))
          (map-positive-atoms
           (lambda (atom)
             (when (eq (first atom) kind)
               (pushnew (cons sentence (or (third atom) 0))
                        (gethash (second atom) table) :test #'equal)))
           (sentence-formula sentence)))))))

(defun regular-support-p (support duration)
  "Return true if SUPPORT is there whatever the timepoint of the atom, which lasts for DURATION."
  (destructuring-bind (sentence . distance) support
    (and (not (sentence-absolute sentence))
         (>= (- (sentence-first sentence) distance) 0)
         (<= (- (sentence-last sentence) distance) duration))))

(defun encode-completion (encoder code supports)
  "Add that the atom CODE is true only if one of SUPPORTS, a list of (sentence . shift), makes it."
  (let ((literals '()))
    (setf (encoder-falsified encoder) code)
    (loop for (sentence . shift) in supports
          do (push (formula-literal encoder (negated (sentence-formula sentence)) shift) literals))
    (setf (encoder-falsified encoder) nil)
    (add-clause encoder (cons (- code) literals))))

(defun valid-support-shift (support time horizon)
  "Return by how much to move the sentence of SUPPORT so that it supports an atom at TIME, or NIL."
  (destructuring-bind (sentence . distance) support
    (if (sentence-absolute sentence)
        (and (= distance time) 0)
        (let ((shift (- time distance)))
          (and (>= (+ shift (sentence-first sentence)) (car horizon))
               (<= (+ shift (sentence-last sentence)) (cdr horizon))
               shift)))))

(defun encode-dated-completions (encoder kind number supports last)
  "Add the completion of an atom for each timepoint of the horizon up to LAST."
  (loop with horizon = (encoder-horizon encoder)
        for time from (car horizon) to last
        do (with-source (encoder (encoder-absolute encoder) t :completion (list kind number time))
             (encode-completion encoder (atom-literal encoder kind number time)
                                (loop for support in supports
                                      for shift = (valid-support-shift support time horizon)
                                      when shift collect (cons (car support) shift))))))

(defun timeless-supports (supports horizon)
  "Return the list of (sentence . shift) in which SUPPORTS support an atom without a time."
  (loop for (sentence) in supports
        nconc (if (sentence-absolute sentence)
                  (list (cons sentence 0))
                  (loop for shift from (- (car horizon) (sentence-first sentence))
                          to (- (cdr horizon) (sentence-last sentence))
                        collect (cons sentence shift)))))

(defun encode-predicate-completion (encoder label predicate open-events)
  (let* ((ground (encoder-ground encoder))
         (kind (completed-kind predicate
                               (assoc predicate (theory-predicates
                                                 (ground-theory-theory ground)))))
         (duration (if (eq kind :event) 1 0))
         (table (supports ground kind label))
         (initial (supports ground kind label (ground-theory-initial-conditions ground))))
    (dolist (number (completed-atoms ground predicate kind open-events))
      (let ((supports (gethash number table)))
        (cond ((eq kind :static)
               (with-source (encoder (encoder-absolute encoder) t :completion (list kind number))
                 (encode-completion encoder (atom-literal encoder :static number 0)
                                    (append (timeless-supports supports
                                                               (encoder-horizon encoder))
                                            (loop for (sentence) in (gethash number initial)
                                                  collect (cons sentence
                                                                (car (encoder-horizon
                                                                      encoder))))))))
              ((every (lambda (support) (regular-support-p support duration)) supports)
               (with-source (encoder (find-template encoder 0 duration) nil
                                     :completion (list kind number))
                 (encode-completion encoder (atom-literal encoder kind number 0)
                                    (loop for (sentence . distance) in supports
                                          collect (cons sentence (- distance))))))
              (t (encode-dated-completions encoder kind number supports
                                           (- (cdr (encoder-horizon encoder)) duration))))))))

(defun encode-completions (encoder open-events)
  "Add the completions that the theory declares."
  (let ((theory (ground-theory-theory (encoder-ground encoder))))
    (loop for (label predicate) in (theory-completions theory)
          unless (member predicate *effect-predicates*)
            do (encode-predicate-completion encoder label predicate open-events))))
