;;;; Edits that refine a region: theory and simulation agree where a coordinate of a body lies in
;;;; one part of it, and part where it lies in the other.
;;;;
;;;; A coordinate SEPARATES the runs if the values of those that agree lie in a range that has none
;;;; of the others, or the other way round.  The edit adds a fluent, that the coordinate is in this
;;;; range, and lets the precondition or the effect depend on it.  Checked against the runs, the
;;;; fluent is as it was in the beginning; what the actions do to it, the next search tells.
;;;;
;;;; Few runs are separated by some coordinate anyhow: where that is likely a coordinate must be
;;;; DECIDING, known from runs in which it was changed and nothing else.  One that decides and does
;;;; not separate, since others have a say in where the boundary is, has a SAFE range, in which all
;;;; runs agree: outside of it the action may fail.

(in-package #:discrepancy-finder.discrepancy)

(defun separation-chance (parameters agreeing others)
  "Return a bound of the probability that one of so many PARAMETERS, which have nothing to do with
it, separates so many AGREEING runs from so many OTHERS: in a random order the ones or the others
stand next to each other."
  (/ (* parameters (+ agreeing others 2d0))
     (alexandria:binomial-coefficient (+ agreeing others) others)))

(defun sample-coordinate (sample body axis)
  "Return the value that SAMPLE gives the coordinate AXIS of BODY, or NIL."
  (loop for parameter in (sample-parameters sample)
        for value across (sample-values sample)
        when (and (eq (parameter-body parameter) body) (eq (parameter-axis parameter) axis))
          return value))

(defun range-around (inside outside low high)
  "Return (min max margin): a range that holds the numbers INSIDE and none of OUTSIDE, halfway
between these, and the least distance of its ends from them; LOW and HIGH are its ends where nothing
is outside.  Return NIL if there is none, or nothing is outside."
  (let* ((first (reduce #'min inside)) (last (reduce #'max inside))
         (below (remove-if (lambda (value) (>= value first)) outside))
         (above (remove-if (lambda (value) (<= value last)) outside)))
    (when (and outside (= (length outside) (+ (length below) (length above))))
      (let ((lower (and below (reduce #'max below)))
            (upper (and above (reduce #'min above))))
        (list (if lower (/ (+ lower first) 2) low)
              (if upper (/ (+ upper last) 2) high)
              (/ (min (if lower (- first lower) (- high low))
                      (if upper (- upper last) (- high low)))
                 2))))))

(defun separating-ranges (parameters agreeing others)
  "Return (margin parameter min max inside) for each of PARAMETERS that separates the samples
AGREEING from OTHERS, the clearest first: INSIDE is true if AGREEING are in the range.  MARGIN is a
part of the parameter's range."
  (flet ((values-in (samples parameter)
           (loop for sample in samples
                 collect (sample-coordinate sample (parameter-body parameter)
                                            (parameter-axis parameter)))))
    (stable-sort
     (loop for parameter in parameters
           for low = (parameter-min parameter) for high = (parameter-max parameter)
           for good = (values-in agreeing parameter) for bad = (values-in others parameter)
           for inside = (and (notany #'null (append good bad)) (range-around good bad low high))
           for range = (or inside
                           (and (notany #'null (append good bad))
                                (range-around bad good low high)))
           when range
             collect (destructuring-bind (min max margin) range
                       (list (/ margin (- high low)) parameter min max (and inside t))))
     #'> :key #'first)))

(defun safe-range (parameter value agreeing others)
  "Return (min max): the range of PARAMETER around VALUE, which agrees, without any of the samples
OTHERS, its ends halfway between these and the next ones of AGREEING; or NIL if there is none."
  (flet ((values-in (samples)
           (loop for sample in samples
                 collect (sample-coordinate sample (parameter-body parameter)
                                            (parameter-axis parameter)))))
    (let* ((bad (values-in others))
           (below (remove-if-not (lambda (bad) (<= bad value)) bad))
           (above (remove-if-not (lambda (bad) (>= bad value)) bad))
           (lower (and below (reduce #'max below)))
           (upper (and above (reduce #'min above)))
           (good (cons value (remove-if-not (lambda (good)
                                              (and (or (null lower) (> good lower))
                                                   (or (null upper) (< good upper))))
                                            (values-in agreeing)))))
      (when (and bad (< (or lower (1- value)) value (or upper (1+ value))))
        (list (if lower (/ (+ lower (reduce #'min good)) 2) (parameter-min parameter))
              (if upper (/ (+ upper (reduce #'max good)) 2) (parameter-max parameter)))))))

(defun range-support (range agreeing others)
  "Return (agreeing number agreeing-outside number-outside) of the samples AGREEING and OTHERS, of
which some are in RANGE."
  (flet ((inside (samples)
           (count-if (lambda (sample)
                       (in-coordinate-range-p
                        range (sample-coordinate sample (coordinate-range-body range)
                                                 (coordinate-range-axis range))))
                     samples)))
    (let ((good (inside agreeing)) (bad (inside others)))
      (list good (+ good bad)
            (- (length agreeing) good)
            (- (+ (length agreeing) (length others)) good bad)))))

(defun body-coordinate-p (parameter)
  "Return true if PARAMETER is a coordinate of a body; a drawn tolerance, for example, is none."
  (and (keywordp (parameter-body parameter)) (assoc (parameter-axis parameter) *axes*) t))

(defun separable-parameters (sample samples)
  "Return the parameters of SAMPLE that are coordinates of bodies and were drawn, not the same in
all SAMPLES."
  (remove-if-not (lambda (parameter)
                   (and (body-coordinate-p parameter) (not (fixed-p parameter))
                        (rest (remove-duplicates
                               (loop for sample in samples
                                     collect (sample-coordinate sample (parameter-body parameter)
                                                                (parameter-axis parameter)))))))
                 (sample-parameters sample)))

(defun new-range (theory parameter min max)
  "Return a coordinate range from MIN to MAX for PARAMETER, with a fluent that THEORY has not."
  (let ((name (loop for number from 1
                    for name = (intern (format nil "~a-~a-IN-RANGE~[~;~:;-~:*~d~]"
                                               (parameter-body parameter) (parameter-axis parameter)
                                               number)
                                       :keyword)
                    unless (assoc name (ec:theory-fluents theory)) return name)))
    (make-coordinate-range :atom (list name) :body (parameter-body parameter)
                           :axis (parameter-axis parameter) :min min :max max)))

;;; What depends on the new fluent

(defun refined-effect (domain change agreeing)
  "Return (sentences replaced) by which the theory has CHANGE only where the literal AGREEING is
false."
  (let* ((theory (symbolic:action-theory-theory domain))
         (transition (change-transition change))
         (atom (change-atom change))
         (event (transition-event transition))
         (seen (change-seen change))
         (lifting (lifting theory (list (cons :event event) (cons :fluent atom))))
         (lifted-event (lifted theory event :event lifting))
         (lifted-fluent (lifted theory atom :fluent lifting)))
    (if (eq seen (transition-truth transition atom))
        (let ((names (effect-axiom-names theory (not seen) transition atom)))
          (list (loop for name in names
                      for axiom = (find name (ec:theory-axioms theory) :key #'ec:axiom-name)
                      collect (list name (list :implies (timed agreeing)
                                               (ec:axiom-formula axiom))))
                names))
        (list (list (list (axiom-name-for theory (list (first event) (effect-predicate seen)
                                                       (first atom))
                                          '())
                          (effect-sentence (effect-predicate seen) lifted-event lifted-fluent
                                           (list (if seen (list :not lifted-fluent) lifted-fluent)
                                                 (if (eq (first agreeing) :not)
                                                     (second agreeing)
                                                     (list :not agreeing))))))
              '()))))

(defun refined-effects (domain transition divergence agreeing)
  "Return the parts (kind sentences replaced) of the edit by which the effects that DIVERGENCE is
about come about only where the literal AGREEING is false."
  (let ((theory (symbolic:action-theory-theory domain)))
    (merged-repairs
     (loop for change in (remove-duplicates
                          (loop for (atom nil seen) in (divergence-fluents divergence)
                                collect (make-change :atom atom :seen (and seen t)
                                                     :transition transition))
                          :test #'equal :from-end t
                          :key (lambda (change) (change-kind theory change)))
           collect (cons :region (refined-effect domain change agreeing))))))

(defun region-edit (domain transition divergence transitions range inside mode)
  "Return the parts (kind sentences replaced requirements ranges) of the edit by which theory and
simulation agree in RANGE, a coordinate range, or, unless INSIDE, outside of it; or NIL.  MODE is
:ALSO or :UNLESS, as for a requirement."
  (let* ((theory (symbolic:action-theory-theory domain))
         (agreeing (if inside
                       (coordinate-range-atom range)
                       (list :not (coordinate-range-atom range)))))
    (cond ((and (eq (divergence-kind divergence) :outcome) (transition-succeeded-p transition))
           nil)
          ((eq (divergence-kind divergence) :outcome)
           (append (requirement-parts domain :region transition
                                      (general-pattern theory (transition-success transition))
                                      (list agreeing) (failure-names transitions transition)
                                      mode)
                   (list (list range))))
          ((and (transition-event transition) (eq mode :also))
           (append (refined-effects domain transition divergence agreeing)
                   (list '() (list range)))))))

(defun parameter-in (parameters parameter)
  "Return that of PARAMETERS that is the same coordinate as PARAMETER, or NIL."
  (find-if (lambda (other)
             (and (eq (parameter-body other) (parameter-body parameter))
                  (eq (parameter-axis other) (parameter-axis parameter))))
           parameters))

(defun proposed-ranges (theory parameters good bad deciding)
  "Return (range inside mode) for the coordinate ranges, arguments of REGION-EDIT, by which the
samples GOOD, with which the theory agrees, and BAD can be told apart."
  (let* ((deciding (loop for (parameter . value) in deciding
                         for own = (parameter-in parameters parameter)
                         when own collect (cons own value)))
         (separating (if (<= (separation-chance (length parameters) (length good) (length bad))
                             *separation-chance*)
                         (separating-ranges parameters good bad)
                         ;; That all is well on both sides of a few failures, nobody has tried.
                         (remove-if-not #'fifth
                                        (separating-ranges (mapcar #'car deciding) good bad)))))
    (append (loop for (nil parameter min max inside) in separating
                  collect (list (new-range theory parameter min max) inside :also))
            (loop for (parameter . value) in deciding
                  for (min max) = (and (not (find parameter separating :key #'second))
                                       (safe-range parameter value good bad))
                  when min collect (list (new-range theory parameter min max) t :unless)))))

(defun region-edits (domain transition divergence run runs agreed &optional deciding)
  "Return the parts of edits that refine a region for DIVERGENCE of RUN, one of RUNS, at TRANSITION.
AGREED tells how far the theory agrees with RUNS.  Only runs from the same discrete initial state
are compared: where bodies are in other regions it is not their coordinates that matter.  DECIDING
is a list of (parameter . value): with the value, all else as in RUN, theory and simulation agree."
  (let* ((alike (mapcar (lambda (other)
                          (equal (run-initial-state other) (run-initial-state run)))
                        runs))
         (own (nth (position run runs) agreed))
         (past (* 2 (1+ (divergence-step divergence))))
         (good (loop for run in runs for far in agreed for alike-p in alike
                     when (and alike-p (>= far past)) collect (run-sample run)))
         (bad (loop for run in runs for far in agreed for alike-p in alike
                    when (and alike-p (= far own)) collect (run-sample run)))
         (parameters (separable-parameters (run-sample run) (append good bad)))
         (transitions (loop for run in runs append (remove nil (run-transitions domain run)))))
    (when good
      (loop for (range inside mode) in (proposed-ranges (symbolic:action-theory-theory domain)
                                                        parameters good bad deciding)
            repeat 2
            for parts = (region-edit domain transition divergence transitions range inside mode)
            when parts collect (append parts (list (range-support range good bad)))))))
