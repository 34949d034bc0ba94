;;;; Reasoners: a theory, a horizon, and a solver that holds its clauses.
;;;;
;;;; A REASONER answers questions about the timepoints of its horizon, which can grow.  It owns a Z3
;;;; context, so it is to be closed, or made by WITH-REASONER.  All queries take a theory as well,
;;;; for which a reasoner is made and closed.
;;;;
;;;; The propositional variable of a timeless atom is its code; those of timepoint t begin at
;;;; global size + (t - first timepoint) * step size.

(in-package #:discrepancy-finder.event-calculus)

(defstruct (reasoner (:constructor make-reasoner-parts) (:copier nil))
  "A solver for what a theory says of the timepoints of a horizon: made by MAKE-REASONER, ended by
CLOSE-REASONER."
  (theory nil :type theory :read-only t)
  (ground nil :type ground-theory)
  (horizon nil :type cons)
  (encoder nil :type (or null encoder))
  (context nil :type z3:context :read-only t)
  (solver nil)
  (clause-set nil)
  ;; for each propositional variable whether it occurs in a clause
  (occurring (make-array 64 :element-type 'bit :initial-element 0) :type simple-bit-vector)
  ;; for each propositional variable whether unit propagation has fixed it
  (truths (make-array 64 :element-type '(unsigned-byte 2) :initial-element 0)
   :type (simple-array (unsigned-byte 2) (*)))
  (tracked nil :type boolean :read-only t)
  ;; formulas with timepoints by number that are encoded with the theory
  (assumptions '() :type list :read-only t)
  (named nil :type boolean :read-only t)
  (open-events '() :type list :read-only t)
  (seed nil :type (or null unsigned-byte) :read-only t)
  (timeout nil :type (or null real) :read-only t)
  (logic nil :type (or null string) :read-only t)
  ;; from (number of a numeric fluent . time) to its Z3 term
  (numbers (make-hash-table :test 'equal) :type hash-table :read-only t))

(setf (documentation 'reasoner-theory 'function)
      "Return the theory of a reasoner."
      (documentation 'reasoner-horizon 'function)
      "Return (first . last), the timepoints of a reasoner.")

(defmethod print-object ((reasoner reasoner) stream)
  (print-unreadable-object (reasoner stream :type t)
    (destructuring-bind (first . last) (reasoner-horizon reasoner)
      (format stream "~a, timepoints ~d to ~d"
              (name-text (theory-name (reasoner-theory reasoner))) first last))))

;;; Variables

(declaim (inline code-variable))
(defun code-variable (code time first-time global-size step-size)
  "Return the propositional variable of the positive CODE relative to TIME."
  (declare (type (unsigned-byte 48) code) (type fixnum time first-time)
           (type (unsigned-byte 24) global-size step-size))
  (if (global-code-p code)
      code
      (the fixnum (+ global-size (code-atom code)
                     (the fixnum (* (the fixnum (- (+ time (code-distance code)) first-time))
                                    step-size))))))

(defun encoder-variable (encoder code time)
  (code-variable code time (car (encoder-horizon encoder)) (encoder-global-size encoder)
                 (encoder-step-size encoder)))

(defun copy-template (template encoder time output position occurring)
  "Write the clauses of TEMPLATE relative to TIME into the vector OUTPUT from POSITION on; mark
their variables in OCCURRING.  Return the position after them."
  (declare (type (simple-array fixnum (*)) output) (type fixnum position time)
           (type simple-bit-vector occurring) (optimize speed (safety 1)))
  (let ((first-time (car (encoder-horizon encoder)))
        (global-size (encoder-global-size encoder))
        (step-size (encoder-step-size encoder)))
    (declare (type (unsigned-byte 24) global-size step-size) (type fixnum first-time))
    (sb-kernel:with-array-data ((literals (template-literals template)) (start) (end))
      (declare (ignore start end) (type (simple-array fixnum (*)) literals))
      (dotimes (index (fill-pointer (template-literals template)) position)
        (let ((literal (aref literals index)))
          (setf (aref output position)
                (if (zerop literal)
                    0
                    (let ((variable (code-variable (abs literal) time first-time global-size
                                                   step-size)))
                      (setf (sbit occurring variable) 1)
                      (if (minusp literal) (- variable) variable))))
          (incf position))))))

(defun schedule (encoder from horizon)
  "Return a list of (template . time): the clauses to be added when the last timepoint grows from
FROM, NIL for none so far, to that of HORIZON."
  (destructuring-bind (first . last) horizon
    (append
     (unless from
       (list (cons (encoder-initial encoder) first)
             (cons (encoder-absolute encoder) 0)))
     (loop for template in (reverse (encoder-templates encoder))
           append (loop for time from (max (- first (template-first template))
                                           (if from
                                               (1+ (- from (template-last template)))
                                               most-negative-fixnum))
                          to (- last (template-last template))
                        collect (cons template time))))))

(defun grow-bits (bits size)
  (if (< (length bits) size)
      (replace (make-array (max size (* 2 (length bits))) :element-type 'bit :initial-element 0)
               bits)
      bits))

(defun used-variables (clauses size)
  (let ((bits (make-array size :element-type 'bit :initial-element 0)))
    (loop for literal across (the (simple-array fixnum (*)) clauses)
          do (setf (sbit bits (abs literal)) 1))
    bits))

(defun add-to-solver (reasoner from horizon)
  "Assert the clauses that SCHEDULE names."
  (let* ((encoder (reasoner-encoder reasoner))
         (jobs (schedule encoder from horizon))
         (length (loop for (template) in jobs sum (fill-pointer (template-literals template))))
         (output (make-array length :element-type 'fixnum))
         (position 0)
         (size (+ (encoder-global-size encoder)
                  (* (+ 1 (- (cdr horizon) (car horizon))) (encoder-step-size encoder)))))
    (setf (reasoner-occurring reasoner) (grow-bits (reasoner-occurring reasoner) size))
    (loop for (template . time) in jobs
          do (setf position (copy-template template encoder time output position
                                           (reasoner-occurring reasoner))))
    (unless (reasoner-tracked reasoner)
      (multiple-value-bind (clauses truths) (simplify-clauses output (reasoner-truths reasoner) size)
        (setf output clauses
              (reasoner-truths reasoner) truths)))
    (z3:assert-clauses (reasoner-clause-set reasoner) output)
    (loop with used = (used-variables output size)
          for (template . time) in jobs
          do (assert-comparisons reasoner template time used)
             (dolist (codes (template-exclusions template))
               (let ((variables (loop for code in codes
                                      collect (encoder-variable encoder code time))))
                 (dolist (variable variables)
                   (setf (sbit (reasoner-occurring reasoner) variable) 1))
                 (z3:assert-at-most (reasoner-clause-set reasoner) variables 1))))))

;;; Life

(defun check-horizon (theory horizon)
  "Return HORIZON, the last timepoint, (first last), (first . last) or NIL for the theory's own, as
(first . last).  Signals NO-HORIZON."
  (let* ((own (theory-time-range theory))
         (range (typecase horizon
                  (null own)
                  (integer (cons (if own (car own) 0) horizon))
                  (cons (cons (car horizon)
                              (if (consp (cdr horizon)) (cadr horizon) (cdr horizon)))))))
    (unless (and range (integerp (car range)) (integerp (cdr range)) (<= (car range) (cdr range)))
      (error 'no-horizon :theory (theory-name theory) :horizon horizon))
    range))

(defun assumed-sentences (ground forms horizon)
  "Return FORMS, checked formulas with timepoints by number, as sentences."
  (loop for form in forms
        collect (make-sentence :axiom (make-axiom :name :assumption :formula form)
                               :formula (ground-formula ground form :horizon horizon)
                               :first (car horizon) :last (cdr horizon) :absolute t)))

(defun build (reasoner)
  "Encode the theory of REASONER for its horizon, with a new solver."
  (let ((ground (ground-for-horizon (reasoner-ground reasoner) (reasoner-horizon reasoner)))
        (*horizon* (reasoner-horizon reasoner)))
    (when (reasoner-solver reasoner)
      (z3:close-clause-set (reasoner-clause-set reasoner))
      (z3:close-solver (reasoner-solver reasoner)))
    (let ((solver (z3:make-solver (reasoner-context reasoner) :logic (reasoner-logic reasoner)
                                  :timeout (reasoner-timeout reasoner)
                                  :seed (reasoner-seed reasoner))))
      (setf (reasoner-solver reasoner) solver
            (reasoner-clause-set reasoner) (z3:make-clause-set
                                            solver
                                            :name-of (and (reasoner-named reasoner)
                                                          (lambda (number)
                                                            (variable-text reasoner number))))
            (reasoner-occurring reasoner) (make-array 64 :element-type 'bit :initial-element 0)
            (reasoner-truths reasoner) (make-array 64 :element-type '(unsigned-byte 2)
                                                      :initial-element +unknown+)
            (reasoner-encoder reasoner)
            (encode ground (reasoner-horizon reasoner)
                    :tracked (reasoner-tracked reasoner)
                    :open-events (reasoner-open-events reasoner)
                    :assumptions (assumed-sentences ground (reasoner-assumptions reasoner)
                                                    (reasoner-horizon reasoner))))
      (add-to-solver reasoner nil (reasoner-horizon reasoner))
      reasoner)))

(defun known-events (theory names)
  "Return NAMES as keywords.  Signals UNKNOWN-ATOM if one is no event of THEORY."
  (loop for name in names
        for keyword = (name-keyword name)
        unless (assoc keyword (theory-events theory))
          do (error 'unknown-atom :atom (list keyword) :kind "event" :theory (theory-name theory))
        collect keyword))

(defun make-reasoner (theory &key horizon open-events tracked named seed timeout
                               (logic nil logic-p) ground assumptions)
  "Return a REASONER for THEORY, a theory or its name.  HORIZON is the last timepoint, or a list of
the first and the last one; by default it is the theory's own.  OPEN-EVENTS names events that may
happen although the theory completes happens.  SEED and TIMEOUT (s) are those of Z3, LOGIC picks its
engine: by default QF_FD, or Z3's default engine where there are numeric fluents.  GROUND saves making the theory ground again; TRACKED is for WHY; NAMED gives Z3 the names
of the atoms, which its texts show then.  ASSUMPTIONS are formulas with timepoints by number that are
true, too.  Signals THEORY-NOT-FOUND,
NO-HORIZON, THEORY-ERROR."
  (check-type seed (or null unsigned-byte))
  (check-type timeout (or null (real (0))))
  (let* ((theory (if (theory-p theory) theory (find-theory theory)))
         (horizon (check-horizon theory horizon))
         (open-events (known-events theory open-events))
         (*horizon* horizon)
         (ground (or ground (ground theory)))
         (context (z3:make-context))
         (done nil))
    (unwind-protect
         (prog1 (build (make-reasoner-parts
                        :theory theory :horizon horizon :ground ground :context context
                        :assumptions (loop for form in assumptions
                                           collect (parse-formula form theory
                                                                  :kind :query
                                                                  :blame "the question"))
                        :open-events open-events :tracked tracked :named named :seed seed :timeout timeout
                        :logic (cond (logic-p logic)
                                     ((theory-numeric-fluents theory) nil)
                                     (t "QF_FD"))))
           (setf done t))
      (unless done (z3:close-context context)))))

(defun close-reasoner (reasoner)
  "Release what REASONER holds of Z3; do nothing if that was done before."
  (z3:close-context (reasoner-context reasoner))
  (values))

(defmacro with-reasoner ((variable theory &rest options) &body body)
  "Evaluate BODY with VARIABLE bound to a new reasoner, made with OPTIONS as MAKE-REASONER has them
and closed at the end; return the values of BODY."
  (let ((reasoner (gensym "REASONER")))
    `(let ((,reasoner (make-reasoner ,theory ,@options)))
       (unwind-protect (let ((,variable ,reasoner)) ,@body)
         (close-reasoner ,reasoner)))))

(defun incremental-p (reasoner)
  "Return true if the clauses of a longer horizon include those of a shorter one."
  (let ((encoder (reasoner-encoder reasoner)))
    (and (null (ground-theory-absolute-clauses (reasoner-ground reasoner)))
         (zerop (fill-pointer (template-literals (encoder-absolute encoder)))))))

(defun extend-horizon (reasoner last)
  "Let the timepoint LAST be the last one of REASONER, and return it.  What was asserted stays where
no axiom compares timepoints or names them by number; else it is made anew."
  (let* ((horizon (reasoner-horizon reasoner))
         (old (cdr horizon))
         (new (cons (car horizon) last)))
    (check-type last integer)
    (check-horizon (reasoner-theory reasoner) new)
    (unless (= last old)
      (let ((incremental (and (> last old) (reasoner-encoder reasoner) (incremental-p reasoner)))
            (done nil))
        (unwind-protect
             (progn (setf (reasoner-horizon reasoner) new)
                    (if incremental
                        (add-to-solver reasoner old new)
                        (build reasoner))
                    (setf done t))
          ;; Left half-way, the reasoner is encoded anew by the next question.
          (unless done
            (setf (reasoner-encoder reasoner) nil)))))
    reasoner))

(defun call-with-reasoner (function theory options)
  (if (reasoner-p theory)
      (let ((horizon (getf options :horizon)))
        (when horizon
          (extend-horizon theory (cdr (check-horizon (reasoner-theory theory) horizon))))
        (unless (reasoner-encoder theory)
          (build theory))
        (funcall (the function function) theory))
      (let ((reasoner (apply #'make-reasoner theory options)))
        (unwind-protect (funcall (the function function) reasoner)
          (close-reasoner reasoner)))))

(defmacro with-reasoner-of ((variable theory &rest options) &body body)
  "Evaluate BODY with VARIABLE bound to THEORY, if it is a reasoner, else to one made for it."
  `(call-with-reasoner (lambda (,variable) ,@body) ,theory (list ,@options)))

;;; Atoms of a reasoner

(defun predicate-atom (theory key time)
  "Return the atom of the theory's own predicate whose KEY, without the time, is at TIME."
  (let* ((sorts (rest (assoc (first key) (theory-predicates theory))))
         (place (position :time sorts)))
    (append (subseq key 0 (1+ place)) (list time) (nthcdr (1+ place) key))))

(defun atom-of-code (encoder code time)
  "Return the ground atom of the positive CODE relative to TIME, such as (:holds-at (:f) 3), or NIL
if it is an auxiliary one."
  (let* ((ground (encoder-ground encoder))
         (fluents (encoder-fluent-count encoder))
         (events (encoder-event-count encoder))
         (number (code-atom code)))
    (if (global-code-p code)
        (let ((statics (atom-table-atoms (ground-theory-statics ground))))
          (and (<= 1 number (encoder-static-count encoder))
               (aref statics (1- number))))
        (let ((time (+ time (code-distance code))))
          (cond ((< number fluents)
                 (list :holds-at (svref (ground-theory-fluents ground) number) time))
                ((< (decf number fluents) fluents)
                 (list :released-at (svref (ground-theory-fluents ground) number) time))
                ((< (decf number fluents) events)
                 (list :happens (svref (ground-theory-events ground) number) time))
                ((< (decf number events) (encoder-predicate-count encoder))
                 (predicate-atom (ground-theory-theory ground)
                                 (aref (atom-table-atoms (ground-theory-predicates ground)) number)
                                 time)))))))

(defun variable-code (encoder variable)
  "Return the code and the time of the propositional VARIABLE."
  (let ((rest (- variable (encoder-global-size encoder))))
    (if (minusp rest)
        (values variable 0)
        (multiple-value-bind (step atom) (floor rest (encoder-step-size encoder))
          (values (make-code atom 0) (+ step (car (encoder-horizon encoder))))))))

(defun variable-atom (reasoner variable)
  "Return the ground atom that the propositional VARIABLE stands for, or NIL."
  (let ((encoder (reasoner-encoder reasoner)))
    (multiple-value-bind (code time) (variable-code encoder variable)
      (atom-of-code encoder code time))))

(defun variable-text (reasoner variable)
  (let ((atom (variable-atom reasoner variable)))
    (if atom (atom-text atom) (format nil "aux ~d" variable))))

(defun formula-proposition (reasoner formula)
  "Return the proposition of the ground FORMULA, whose times are timepoints."
  (let ((encoder (reasoner-encoder reasoner))
        (clause-set (reasoner-clause-set reasoner)))
    (labels ((convert (formula)
               (if (atom formula)
                   formula
                   (case (first formula)
                     (:and (z3:conjunction (mapcar #'convert (rest formula))))
                     (:or (z3:disjunction (mapcar #'convert (rest formula))))
                     (:not (z3:negation (convert (second formula))))
                     (:iff (z3:equivalence (convert (second formula)) (convert (third formula))))
                     (:compare (comparison-proposition reasoner (rest formula) 0))
                     (t (let ((code (atom-literal encoder (first formula) (second formula)
                                                  (or (third formula) 0))))
                          (if (integerp code)
                              (z3:clause-set-term clause-set (encoder-variable encoder code 0))
                              code)))))))
      (convert formula))))

(defun map-question-times (function theory form)
  "Call FUNCTION with each timepoint that FORM, a checked question, gives by number, and the event
that is to happen then, or NIL."
  (labels ((look (form)
             (when (consp form)
               (loop for term in (rest form)
                     for sort in (or (argument-sorts theory form) (mapcar (constantly nil)
                                                                          (rest form)))
                     do (if (and (eq sort :time) (integerp term))
                            (funcall (the function function) term
                                     (and (eq (first form) :happens) (second form)))
                            (look term))))))
    (look form)))

(defun check-question-times (theory form horizon)
  "Signal OUTSIDE-HORIZON if FORM, a checked question, gives a timepoint outside of HORIZON."
  (map-question-times (lambda (time event)
                        (unless (<= (car horizon) time (if event (1- (cdr horizon)) (cdr horizon)))
                          (error 'outside-horizon :time time :horizon horizon :event event)))
                      theory form))

(defun question-proposition (reasoner form &key (blame "the question"))
  "Return the proposition of FORM, a formula with timepoints by number.  Signals THEORY-ERROR."
  (let* ((theory (reasoner-theory reasoner))
         (ground (encoder-ground (reasoner-encoder reasoner)))
         (checked (parse-formula form theory :kind :query :blame blame))
         (formula (progn
                    (check-question-times theory checked (reasoner-horizon reasoner))
                    (ground-formula ground checked :horizon (reasoner-horizon reasoner))))
         (encoder (reasoner-encoder reasoner)))
    ;; Atoms of predicates that no axiom mentions have no variables yet.
    (unless (and (= (encoder-predicate-count encoder)
                    (length (atom-table-atoms (ground-theory-predicates ground))))
                 (= (encoder-static-count encoder)
                    (length (atom-table-atoms (ground-theory-statics ground)))))
      (build reasoner))
    (formula-proposition reasoner formula)))
