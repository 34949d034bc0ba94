;;;; Reasons in words: atoms, instances of axioms, instances of the schemas of the calculus.

(in-package #:discrepancy-finder.event-calculus)

(defun time-words (atom)
  "Return the text of the ground ATOM and that of its timepoint, or NIL."
  (case (first atom)
    ((:holds-at :happens :released-at)
     (values (atom-text (second atom)) (third atom)))
    (t (values (atom-text atom) nil))))

(defun literal-words (atom positive)
  "Return a clause of English that ATOM is true, or false."
  (multiple-value-bind (text time) (time-words atom)
    (atom-words (first atom) positive text time)))

(defun atom-words (kind positive text time)
  (case kind
    (:holds-at (format nil "~a is ~:[false~;true~] at ~d" text positive time))
    (:happens (format nil "~a ~:[does not happen~;happens~] at ~d" text positive time))
    (:released-at (format nil "~a is ~:[not ~;~]released at ~d" text positive time))
    (t (format nil "~a is ~:[false~;true~]" text positive))))

(defun ground-formula-text (encoder formula shift)
  "Return the text of the ground FORMULA, moved by SHIFT timepoints, as a formula."
  (labels ((form (formula)
             (cond ((eq formula t) '(:and))
                   ((null formula) '(:or))
                   ((member (first formula) '(:and :not :iff))
                    (cons (first formula) (mapcar #'form (rest formula))))
                   ((eq (first formula) :or) (implication (rest formula)))
                   ((eq (first formula) :compare)
                    (cons (second formula)
                          (loop for term in (cddr formula)
                                collect (ground-term-form (encoder-ground encoder) term shift))))
                   (t (let ((code (atom-literal encoder (first formula) (second formula)
                                                (if (eq (first formula) :static)
                                                    0
                                                    (+ shift (third formula))))))
                        (if (integerp code)
                            (atom-of-code encoder code 0)
                            (if code '(:and) '(:or)))))))
           (implication (parts)
             (let* ((negative (remove-if-not (lambda (part)
                                               (and (consp part) (eq (first part) :not)))
                                             parts))
                    (positive (set-difference parts negative))
                    (premises (mapcar (lambda (part) (form (second part))) negative))
                    (conclusions (mapcar #'form positive)))
               (flet ((join (operator forms)
                        (if (rest forms) (cons operator forms) (first forms))))
                 (cond ((null negative) (cons :or conclusions))
                       ((null positive) (list :not (join :and premises)))
                       (t (list :implies (join :and premises) (join :or conclusions))))))))
    (formula-text (form formula))))

(defun bindings-text (bindings time)
  (format nil "~{~a = ~a~^, ~}"
          (append (loop for (variable . value) in bindings
                        append (list (name-text variable) (term-text value)))
                  (and time (list "?time" time)))))

(defun ground-term-form (ground term shift)
  "Return the ground TERM, moved by SHIFT timepoints, as a term."
  (cond ((rationalp term) term)
        ((eq (first term) :value)
         (list :value-at (svref (ground-theory-numerics ground) (second term))
               (+ shift (third term))))
        (t (cons (first term)
                 (mapcar (lambda (part) (ground-term-form ground part shift)) (rest term))))))

(defun effect-words (effect time ground)
  "Return the words that EFFECT, relative to TIME, takes place."
  (let ((event (atom-text (svref (ground-theory-events ground) (effect-event effect))))
        (happening (or (effect-time effect) time)))
    (flet ((numeric ()
             (atom-text (svref (ground-theory-numerics ground) (effect-fluent effect)))))
      (cond ((eq (effect-kind effect) :assigns)
             (format nil "~a assigns ~a to ~a at ~d" event
                     (formula-text (ground-term-form ground (effect-term effect)
                                                     (effect-shift effect time)))
                     (numeric) happening))
            ((member effect (svref (ground-theory-effects ground) (effect-event effect)))
             (format nil "~a ~(~a~) ~a at ~d" event (effect-kind effect)
                     (atom-text (svref (ground-theory-fluents ground) (effect-fluent effect)))
                     happening))
            (t (format nil "~a releases ~a at ~d" event (numeric) happening))))))

(defun change-words (change time ground)
  "Return the words for what the trajectory CHANGE, begun at TIME, leads to."
  (let* ((time (or (gradual-change-time change) time))
         (end (+ time (gradual-change-offset change)))
         (number (gradual-change-fluent change)))
    (format nil "the ~(~a~) of ~a ~:[makes ~a true~*~;gives ~a the value ~a~] at ~d"
            (gradual-change-kind change)
            (atom-text (svref (ground-theory-fluents ground) (gradual-change-cause change)))
            (gradual-change-term change)
            (atom-text (svref (if (gradual-change-term change)
                                  (ground-theory-numerics ground)
                                  (ground-theory-fluents ground))
                              number))
            (and (gradual-change-term change)
                 (formula-text (ground-term-form ground (gradual-change-term change)
                                                 (if (gradual-change-time change) 0 time))))
            end)))

(defun axiom-words (axiom)
  "Return the words that name AXIOM; one without a name is named by its place."
  (let ((name (name-text (axiom-name axiom))))
    (if (and (every #'digit-char-p name) (axiom-position axiom))
        (format nil "axiom ~a at ~a" name (axiom-position axiom))
        (format nil "axiom ~a" name))))

(defun reason-axiom (reason)
  "Return the axiom of REASON, or NIL if it is an instance of a schema of the calculus."
  (source-axiom (ground-reason-source reason)))

(defun source-axiom (source)
  "Return the axiom that SOURCE is an instance of, or NIL."
  (let ((thing (source-thing source)))
    (typecase thing
      (sentence (let ((axiom (sentence-axiom thing))) (and (axiom-p axiom) axiom)))
      (effect (effect-axiom thing))
      (axiom thing)
      (gradual-change (gradual-change-axiom thing)))))

(defun reason-entry (reasoner reason)
  "Return (name instance) for the core of an explanation."
  (let* ((encoder (reasoner-encoder reasoner))
         (ground (encoder-ground encoder))
         (source (ground-reason-source reason))
         (thing (source-thing source))
         (time (ground-reason-time reason))
         (axiom (reason-axiom reason)))
    (flet ((fluent (number) (atom-text (svref (ground-theory-fluents ground) number))))
      (list
       (if axiom (axiom-name axiom) (source-kind source))
       (ecase (source-kind source)
         ((:sentence :initially)
          (format nil "~a~@[, for ~a~]"
                  (ground-formula-text encoder (sentence-formula thing)
                                       (if (eq (source-kind source) :initially)
                                           (car (reasoner-horizon reasoner))
                                           time))
                  (and (sentence-bindings thing)
                       (bindings-text (sentence-bindings thing)
                                      (if (sentence-absolute thing) nil time)))))
         (:effect (effect-words thing time ground))
         (:trajectory (change-words thing time ground))
         (:begin (effect-words thing time ground))
         (:stop (format nil "~a lasts from ~d until an event ends it" (fluent thing) time))
         (:inertia (format nil "~a persists from ~d to ~d unless an event changes it"
                           (fluent thing) time (1+ time)))
         (:release (format nil "~a stays released, or not, from ~d to ~d unless an event changes ~
                                that" (fluent thing) time (1+ time)))
         (:numeric-inertia
          (format nil "~a keeps its value from ~d to ~d unless an event changes it"
                  (atom-text (svref (ground-theory-numerics ground) thing)) time (1+ time)))
         (:number-not-released
          (format nil "~a is not released at first"
                  (atom-text (svref (ground-theory-numerics ground) thing))))
         (:not-released (format nil "~a is not released at first" (fluent thing)))
         (:completion
          (destructuring-bind (kind number &optional dated) thing
            (let ((code (atom-literal encoder kind number (or dated time))))
              (format nil "~a only if an axiom makes it so"
                      (formula-text (atom-of-code encoder code 0))))))
         ((:exclusion :exactly-one)
          (format nil "~:[at most~;exactly~] one of ~:[~{~a~^, ~}~;the events~*~] at ~d"
                  (eq (source-kind source) :exactly-one) (axiom-p thing)
                  (if (listp thing) (mapcar #'name-text thing) '()) time)))))))
