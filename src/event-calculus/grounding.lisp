;;;; Grounding: a theory with finite sorts becomes propositional.
;;;;
;;;; GROUND turns a theory into a GROUND-THEORY: its ground fluents and events are numbered, effect
;;;; axioms become a table event -> (initiates/terminates, fluent, condition), the rest sentences.
;;;; A ground formula is T, NIL, (:fluent index offset), (:event index offset), or :and, :or, :not,
;;;; :iff of ground formulas; what is constant is folded away.  OFFSET is the distance from ?time.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (ground-theory (:copier nil))
  "A theory in which all variables are replaced by elements."
  (theory nil :type theory :read-only t)
  (fluents #() :type simple-vector :read-only t)
  (events #() :type simple-vector :read-only t)
  (fluent-index nil :type hash-table :read-only t)
  (event-index nil :type hash-table :read-only t)
  ;; for each event a list of (:initiates|:terminates fluent-index condition)
  (effects #() :type simple-vector)
  ;; lists of (axiom . ground formula)
  (initial-conditions '() :type list)
  (state-sentences '() :type list)
  (step-sentences '() :type list))

(setf (documentation 'ground-theory-theory 'function)
      "Return the theory that was made ground."
      (documentation 'ground-theory-fluents 'function)
      "Return the vector of the ground fluents, each a list of keywords."
      (documentation 'ground-theory-events 'function)
      "Return the vector of the ground events, each a list of keywords.")

(defmethod print-object ((ground ground-theory) stream)
  (print-unreadable-object (ground stream :type t)
    (format stream "~a: ~d ground fluent~:p, ~d ground event~:p"
            (name-text (theory-name (ground-theory-theory ground)))
            (length (ground-theory-fluents ground)) (length (ground-theory-events ground)))))

(defun map-bindings (function variables theory)
  "Call FUNCTION with each alist that binds VARIABLES to elements of their sorts in THEORY."
  (labels ((walk (rest bindings)
             (if rest
                 (dolist (element (sort-elements theory (variable-sort-name (first rest))))
                   (walk (rest rest) (acons (first rest) element bindings)))
                 (funcall function bindings))))
    (walk variables '())))

(defun ground-atoms (theory declarations)
  (coerce (loop for (name . sorts) in declarations
                append (let ((tuples '(())))
                         (dolist (sort (reverse sorts))
                           (setf tuples (loop for element in (sort-elements theory sort)
                                              append (loop for tuple in tuples
                                                           collect (cons element tuple)))))
                         (loop for tuple in tuples collect (cons name tuple))))
          'simple-vector))

(defun index-table (atoms)
  (let ((table (make-hash-table :test 'equal)))
    (loop for atom across atoms for index from 0 do (setf (gethash atom table) index))
    table))

(defun find-fluent (ground atom)
  "Return the number of the ground fluent ATOM, a list of symbols, in GROUND.  Signals
UNKNOWN-ATOM."
  (or (gethash (mapcar #'name-keyword atom) (ground-theory-fluent-index ground))
      (error 'unknown-atom :atom atom :kind "fluent"
                           :theory (theory-name (ground-theory-theory ground)))))

(defun find-event (ground atom)
  "Return the number of the ground event ATOM, a list of symbols, in GROUND.  Signals
UNKNOWN-ATOM."
  (or (gethash (mapcar #'name-keyword atom) (ground-theory-event-index ground))
      (error 'unknown-atom :atom atom :kind "event"
                           :theory (theory-name (ground-theory-theory ground)))))

(defun event-number (ground event)
  "Return the number of the ground EVENT, a list of symbols, in GROUND, or NIL if EVENT is NIL.
Signals UNKNOWN-ATOM."
  (and event (find-event ground event)))

;;; Ground formulas

(defun fold (operator parts)
  "Return the conjunction (OPERATOR :and) or disjunction (:or) of PARTS, constants folded."
  (let ((absorbing (eq operator :or))
        (kept '()))
    (dolist (part parts (cond ((null kept) (not absorbing))
                              ((null (rest kept)) (first kept))
                              (t (cons operator (nreverse kept)))))
      (cond ((eq part absorbing) (return absorbing))
            ((eq part (not absorbing)))
            (t (pushnew part kept :test #'equal))))))

(defun fold-not (part)
  (cond ((eq part t) nil)
        ((null part) t)
        ((eq (first part) :not) (second part))
        (t (list :not part))))

(defun instantiate (atom bindings)
  (sublis bindings atom))

(defun ground-formula (ground form &optional bindings)
  "Return the checked formula FORM as a ground formula of GROUND; BINDINGS is an alist of its free
variables."
  (flet ((inner (part) (ground-formula ground part bindings))
         (quantified ()
           (let ((parts '()))
             (map-bindings (lambda (more)
                             (push (ground-formula ground (third form) (append more bindings))
                                   parts))
                           (second form) (ground-theory-theory ground))
             (nreverse parts))))
    (case (first form)
      ((:and :or) (fold (first form) (mapcar #'inner (rest form))))
      (:not (fold-not (inner (second form))))
      (:implies (fold :or (list (fold-not (inner (second form))) (inner (third form)))))
      (:iff (let ((a (inner (second form))) (b (inner (third form))))
              (cond ((eq a t) b) ((eq b t) a)
                    ((null a) (fold-not b)) ((null b) (fold-not a))
                    (t (list :iff a b)))))
      (:forall (fold :and (quantified)))
      (:exists (fold :or (quantified)))
      (:= (eq (instantiate (second form) bindings) (instantiate (third form) bindings)))
      (:/= (not (eq (instantiate (second form) bindings) (instantiate (third form) bindings))))
      (:holds-at (list :fluent (find-fluent ground (instantiate (second form) bindings))
                       (time-offset (third form))))
      (:happens (list :event (find-event ground (instantiate (second form) bindings))
                      (time-offset (third form))))
      (t (list :fluent (find-fluent ground (instantiate form bindings)) 0)))))

(defun free-variables (form &optional bound)
  "Return the free variables of FORM, without ?time, in order of appearance."
  (cond ((and (keywordp form) (variable-p form))
         (unless (or (eq form :?time) (member form bound)) (list form)))
        ((atom form) '())
        ((member (first form) '(:forall :exists))
         (free-variables (third form) (append (second form) bound)))
        (t (remove-duplicates (mapcan (lambda (part) (free-variables part bound)) form)
                              :from-end t))))

(defun map-instances (function axiom theory)
  (map-bindings function (free-variables (axiom-formula axiom)) theory))

(defun mentions-event-p (formula)
  (and (consp formula)
       (or (eq (first formula) :event) (some #'mentions-event-p (rest formula)))))

;;; Grounding a theory

(defun ground-effect (ground axiom)
  (multiple-value-bind (kind condition head) (axiom-parts axiom)
    (declare (ignore kind))
    (map-instances
     (lambda (bindings)
       (let ((guard (if (eq condition t) t (ground-formula ground condition bindings))))
         (when guard
           (push (list (first head)
                       (find-fluent ground (instantiate (third head) bindings))
                       guard)
                 (svref (ground-theory-effects ground)
                        (find-event ground (instantiate (second head) bindings)))))))
     axiom (ground-theory-theory ground))))

(defun ground-sentences (ground axiom formula)
  (let ((sentences '()))
    (map-instances (lambda (bindings)
                     (let ((sentence (ground-formula ground formula bindings)))
                       (unless (eq sentence t) (push (cons axiom sentence) sentences))))
                   axiom (ground-theory-theory ground))
    (nreverse sentences)))

(defun ground (theory)
  "Return the GROUND-THEORY of THEORY."
  (let* ((fluents (ground-atoms theory (theory-fluents theory)))
         (events (ground-atoms theory (theory-events theory)))
         (ground (make-ground-theory :theory theory :fluents fluents :events events
                                     :fluent-index (index-table fluents)
                                     :event-index (index-table events)
                                     :effects (make-array (length events) :initial-element '()))))
    (dolist (axiom (theory-axioms theory))
      (multiple-value-bind (kind condition head) (axiom-parts axiom)
        (declare (ignore condition))
        (ecase kind
          (:effect (ground-effect ground axiom))
          (:initially
           (setf (ground-theory-initial-conditions ground)
                 (append (ground-theory-initial-conditions ground)
                         (ground-sentences ground axiom (second head)))))
          (:sentence
           (dolist (sentence (ground-sentences ground axiom head))
             (if (mentions-event-p (cdr sentence))
                 (setf (ground-theory-step-sentences ground)
                       (append (ground-theory-step-sentences ground) (list sentence)))
                 (setf (ground-theory-state-sentences ground)
                       (append (ground-theory-state-sentences ground) (list sentence)))))))))
    ground))
