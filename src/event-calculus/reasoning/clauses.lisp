;;;; Clauses about an arbitrary timepoint.
;;;;
;;;; The axioms are put into clauses once, relative to a timepoint, and copied for each timepoint
;;;; of the horizon, so that a long horizon costs one addition a literal.  A literal is an integer,
;;;; negative for a negation, whose lower bits say which atom and whose upper bits say how far from
;;;; the timepoint: a CODE.  Codes without a time are GLOBAL: timeless atoms.  A TEMPLATE is the
;;;; clauses whose timepoints span the same distances.
;;;;
;;;; Parts of formulas that are neither literals nor clauses get auxiliary atoms of their own, each
;;;; with the clauses by which it implies its part; so a model of the clauses is one of the
;;;; formulas, and each model of the formulas is one of the clauses.

(in-package #:discrepancy-finder.event-calculus)

(defconstant +code-bits+ 24
  "The number of bits of a code that say which atom.")

(defconstant +code-bias+ (expt 2 20)
  "What is added to a distance in the upper bits of a code.")

(declaim (inline make-code code-atom code-distance global-code-p))

(defun make-code (atom distance)
  (declare (type (unsigned-byte 24) atom) (type (signed-byte 20) distance))
  (logior atom (ash (+ distance +code-bias+) +code-bits+)))

(defun code-atom (code)
  (declare (type (unsigned-byte 48) code))
  (ldb (byte +code-bits+ 0) code))

(defun code-distance (code)
  (declare (type (unsigned-byte 48) code))
  (- (ash code (- +code-bits+)) +code-bias+))

(defun global-code-p (code)
  (declare (type (unsigned-byte 48) code))
  (< code (ash 1 +code-bits+)))

(defstruct (template (:copier nil))
  "Clauses whose timepoints are at distances FIRST to LAST."
  (first 0 :type fixnum :read-only t)
  (last 0 :type fixnum :read-only t)
  (literals (make-array 64 :element-type 'fixnum :adjustable t :fill-pointer 0)
   :type (and vector (not simple-array)) :read-only t)
  (known (make-term-table) :type hash-table :read-only t)
  ;; lists of codes of which at most one is true
  (exclusions '() :type list)
  ;; (code operator term term): atoms that are true where a comparison is
  (comparisons '() :type list))

(defstruct (source (:copier nil))
  "Where clauses come from.  KIND is :SENTENCE, :INITIALLY, :EFFECT (DEC9 to DEC12), :TRAJECTORY,
:INERTIA (DEC5, DEC6), :RELEASE (DEC7, DEC8), :NOT-RELEASED, :COMPLETION or :EXCLUSION; THING is the
sentence, the effect, the number of the fluent, ....  CODE is that of the selector."
  (kind nil :type keyword :read-only t)
  (thing nil :read-only t)
  (code 0 :type fixnum :read-only t)
  (template nil :type template :read-only t)
  ;; the timepoint of what is not an instance of a template for all timepoints, or NIL
  (date nil :type (or null fixnum) :read-only t)
  (start 0 :type fixnum)
  (end 0 :type fixnum))

(defstruct (encoder (:copier nil))
  "What the axioms of GROUND become.  FLUENT-COUNT and the like are those of the ground atoms; the
atoms of a timepoint are numbered: fluents, their releases, events, predicates, releases of numeric
fluents, auxiliary ones."
  (ground nil :type ground-theory :read-only t)
  (horizon nil :type (or null cons) :read-only t)
  (tracked nil :type boolean :read-only t)
  (fluent-count 0 :type fixnum :read-only t)
  (event-count 0 :type fixnum :read-only t)
  (predicate-count 0 :type fixnum :read-only t)
  (static-count 0 :type fixnum :read-only t)
  (numeric-count 0 :type fixnum :read-only t)
  (step-size 0 :type fixnum)
  (global-size 0 :type fixnum)
  (templates '() :type list)
  (initial (make-template) :type template :read-only t)
  (absolute (make-template) :type template :read-only t)
  (sources (make-array 16 :adjustable t :fill-pointer 0) :type vector :read-only t)
  ;; the template in work, whether it is for one timepoint only, and the source of its clauses
  (template nil :type (or null template))
  (once nil :type boolean)
  (selector nil :type (or null fixnum))
  (date nil :type (or null fixnum))
  ;; the code of an atom taken as false
  (falsified nil :type (or null fixnum)))

(defun find-template (encoder first last)
  (or (find-if (lambda (template)
                 (and (= (template-first template) first) (= (template-last template) last)))
               (encoder-templates encoder))
      (let ((template (make-template :first first :last last)))
        (push template (encoder-templates encoder))
        template)))

(defun new-code (encoder)
  "Return the code of a new auxiliary atom."
  (if (encoder-once encoder)
      (prog1 (encoder-global-size encoder)
        (incf (encoder-global-size encoder)))
      (prog1 (make-code (encoder-step-size encoder) 0)
        (incf (encoder-step-size encoder)))))

(defun add-clause (encoder literals)
  "Add the clause of the list LITERALS, codes and constants, to the template in work."
  (let ((clause (remove-duplicates (remove nil literals))))
    (unless (member t clause)
      (when (encoder-selector encoder)
        (push (- (encoder-selector encoder)) clause))
      (let* ((template (encoder-template encoder))
             (known (template-known template))
             (key (and (null (nthcdr 4 clause)) (sort (copy-list clause) #'<))))
        (unless (and key (gethash key known))
          (when key (setf (gethash key known) t))
          (dolist (literal clause)
            (vector-push-extend literal (template-literals template)))
          (vector-push-extend 0 (template-literals template)))))))

(defun call-with-source (encoder template once kind thing function)
  (setf (encoder-template encoder) template
        (encoder-once encoder) once)
  (if (encoder-tracked encoder)
      (let ((source (make-source :kind kind :thing thing :code (new-code encoder)
                                 :date (and once (encoder-date encoder))
                                 :template template :start (fill-pointer
                                                            (template-literals template)))))
        (setf (encoder-selector encoder) (source-code source))
        (funcall function)
        (setf (source-end source) (fill-pointer (template-literals template))
              (encoder-selector encoder) nil)
        (if (> (source-end source) (source-start source))
            (vector-push-extend source (encoder-sources encoder))))
      (funcall function)))

(defmacro with-source ((encoder template once kind thing) &body body)
  "Evaluate BODY, which adds clauses to TEMPLATE; ONCE is true if it is for one timepoint only.
KIND and THING say where the clauses come from."
  `(call-with-source ,encoder ,template ,once ,kind ,thing (lambda () ,@body)))

;;; Literals

(defun negate (literal)
  (case literal ((t) nil) ((nil) t) (t (- literal))))

(defun atom-literal (encoder kind index distance)
  "Return the code of an atom, or T or NIL if its truth is known."
  (let* ((fluents (encoder-fluent-count encoder))
         (code (ecase kind
                 (:fluent (make-code index distance))
                 (:released
                  (ecase (svref (ground-theory-release (encoder-ground encoder)) index)
                    ((nil) nil)
                    (:always t)
                    (:possibly (make-code (+ fluents index) distance))))
                 (:event (make-code (+ (* 2 fluents) index) distance))
                 (:predicate (make-code (+ (* 2 fluents) (encoder-event-count encoder) index)
                                        distance))
                 (:number-released
                  (make-code (+ (* 2 fluents) (encoder-event-count encoder)
                                (encoder-predicate-count encoder) index)
                             distance))
                 ;; The code 0 would have no negation.
                 (:static (1+ index)))))
    (if (and (integerp code) (eql code (encoder-falsified encoder)))
        nil
        code)))

(defun negated (formula)
  "Return the negation of the ground FORMULA, moved inwards once."
  (if (atom formula)
      (not formula)
      (case (first formula)
        (:not (second formula))
        (:and (cons :or (mapcar #'negated (rest formula))))
        (:or (cons :and (mapcar #'negated (rest formula))))
        (:iff (list :iff (negated (second formula)) (third formula)))
        (t (list :not formula)))))

(defun formula-literal (encoder formula shift)
  "Return a literal that implies the ground FORMULA, moved by SHIFT timepoints: a code, T or NIL."
  (if (atom formula)
      formula
      (ecase (first formula)
        ((:fluent :released :event :predicate)
         (atom-literal encoder (first formula) (second formula) (+ (third formula) shift)))
        (:static (atom-literal encoder :static (second formula) 0))
        (:not (let ((part (second formula)))
                (if (member (first part) '(:and :or :not :iff))
                    (formula-literal encoder (negated part) shift)
                    (negate (formula-literal encoder part shift)))))
        (:and (let ((literals '()))
                (dolist (part (rest formula) (conjunction-literal encoder literals))
                  (let ((literal (formula-literal encoder part shift)))
                    (case literal
                      ((nil) (return nil))
                      ((t))
                      (t (push literal literals)))))))
        (:or (let ((literals '()))
               (dolist (part (rest formula) (disjunction-literal encoder literals))
                 (let ((literal (formula-literal encoder part shift)))
                   (case literal
                     ((t) (return t))
                     ((nil))
                     (t (push literal literals)))))))
        (:iff (formula-literal encoder (iff-implications formula) shift))
        (:compare (comparison-literal encoder (rest (shift-formula formula shift)))))))

(defun comparison-literal (encoder comparison)
  "Return the code of an atom that is true just if COMPARISON, (operator term term), is."
  (let ((template (encoder-template encoder)))
    (or (car (find comparison (template-comparisons template) :key #'rest :test #'equal))
        (let ((code (new-code encoder)))
          (push (cons code comparison) (template-comparisons template))
          code))))

(defun iff-implications (formula)
  (destructuring-bind (p q) (rest formula)
    (list :and (list :or (negated p) q) (list :or p (negated q)))))

(defun conjunction-literal (encoder literals)
  (case (length literals)
    (0 t)
    (1 (first literals))
    (t (let ((code (new-code encoder)))
         (dolist (literal literals code)
           (add-clause encoder (list (- code) literal)))))))

(defun disjunction-literal (encoder literals)
  (case (length literals)
    (0 nil)
    (1 (first literals))
    (t (let ((code (new-code encoder)))
         (add-clause encoder (cons (- code) literals))
         code))))

(defun compound-p (formula)
  (and (consp formula)
       (or (member (first formula) '(:and :iff :or))
           (and (eq (first formula) :not) (compound-p (second formula))))))

(defun assert-formula (encoder formula shift &optional literals)
  "Add clauses for the disjunction of the list LITERALS and the ground FORMULA, moved by SHIFT
timepoints."
  (cond ((eq formula t))
        ((null formula) (add-clause encoder literals))
        (t (case (first formula)
             (:and (dolist (part (rest formula))
                     (assert-formula encoder part shift literals)))
             (:iff (assert-formula encoder (iff-implications formula) shift literals))
             (:or
              ;; The last compound part is spread out, the others become auxiliary atoms.
              (let* ((parts (rest formula))
                     (spread (find-if #'compound-p parts :from-end t)))
                (dolist (part parts)
                  (unless (eq part spread)
                    (push (formula-literal encoder part shift) literals)))
                (if spread
                    (assert-formula encoder spread shift literals)
                    (add-clause encoder literals))))
             (t (if (and (eq (first formula) :not) (compound-p (second formula)))
                    (assert-formula encoder (negated (second formula)) shift literals)
                    (add-clause encoder
                                (cons (formula-literal encoder formula shift) literals))))))))
