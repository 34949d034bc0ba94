;;;; Reasoners: a theory, a horizon, and a solver that holds its clauses.
;;;;
;;;; A REASONER answers questions about the timepoints of its horizon, which can grow.  It owns a Z3
;;;; context, so it is to be closed, or made by WITH-REASONER.  All queries take a theory as well,
;;;; for which a reasoner is made and closed.

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
  (closed nil :type boolean)
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
  (numbers (make-term-table) :type hash-table :read-only t))

(setf (documentation 'reasoner-theory 'function)
      "Return the theory of a reasoner."
      (documentation 'reasoner-horizon 'function)
      "Return (first . last), the timepoints of a reasoner.")

(defmethod print-object ((reasoner reasoner) stream)
  (print-unreadable-object (reasoner stream :type t)
    (destructuring-bind (first . last) (reasoner-horizon reasoner)
      (format stream "~a, timepoints ~d to ~d"
              (name-text (theory-name (reasoner-theory reasoner))) first last))))

;;; Life

(defun check-horizon (theory horizon)
  "Return HORIZON, the last timepoint, (first last), (first . last) or NIL for the theory's own, as
(first . last).  Signals NO-HORIZON."
  (let* ((own (theory-time-range theory))
         (range (typecase horizon
                  (null own)
                  (integer (cons (if own (car own) 0) horizon))
                  (cons (if (and (consp (cdr horizon)) (null (cddr horizon)))
                            (cons (first horizon) (second horizon))
                            horizon)))))
    (unless (and range (integerp (car range)) (integerp (cdr range)) (<= (car range) (cdr range)))
      (error 'no-horizon :theory (theory-name theory) :horizon horizon))
    range))

(defparameter *solver-options* '(("simplify.delay" . 3000))
  "Options of Z3's engine for finite domains: to simplify the clauses takes longer than most
questions do, so it is put off until after so many conflicts.")

(defconstant +assumption+ :|(:assumption)|
  "The name of the axiom that stands for an assumption, which no theory can give.")

(defun assumed-sentences (ground forms horizon)
  "Return FORMS, checked formulas with timepoints by number, as sentences."
  (loop for form in forms
        collect (make-sentence :axiom (make-axiom :name +assumption+ :formula form)
                               :formula (ground-formula ground form :horizon horizon)
                               :first (car horizon) :last (cdr horizon) :absolute t)))

(defun horizon-dependent-p (theory)
  "Return true if atoms or distances of THEORY depend on the horizon."
  (flet ((dependent-p (declaration) (intersection '(:time :offset) (rest declaration))))
    (or (some #'dependent-p (append (theory-fluents theory) (theory-events theory)
                                    (theory-numeric-fluents theory)))
        (and (null (theory-offset-range theory))
             (some (lambda (axiom)
                     (some (lambda (variable) (eq (variable-sort theory variable) :offset))
                           (free-variables (axiom-formula axiom))))
                   (theory-axioms theory))))))

(defun build (reasoner)
  "Encode the theory of REASONER for its horizon, with a new solver."
  (when (horizon-dependent-p (reasoner-theory reasoner))
    (let ((*horizon* (reasoner-horizon reasoner)) (theory (reasoner-theory reasoner)))
      (clrhash (theory-elements theory))
      (clrhash (theory-element-tables theory))
      (setf (reasoner-ground reasoner) (ground theory))))
  (let ((ground (ground-for-horizon (reasoner-ground reasoner) (reasoner-horizon reasoner)))
        (*horizon* (reasoner-horizon reasoner)))
    (when (reasoner-solver reasoner)
      (z3:close-clause-set (reasoner-clause-set reasoner))
      (z3:close-solver (reasoner-solver reasoner)))
    (let ((solver (z3:make-solver (reasoner-context reasoner) :logic (reasoner-logic reasoner)
                                  :timeout (reasoner-timeout reasoner)
                                  :seed (reasoner-seed reasoner)
                                  :options (and (equal (reasoner-logic reasoner) "QF_FD")
                                                *solver-options*))))
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
engine: by default QF_FD, or Z3's default engine where there are numeric fluents.  GROUND saves
making the theory ground again; TRACKED is for WHY; NAMED gives Z3 the names of the atoms, which its
texts show then.  ASSUMPTIONS are formulas with timepoints by number that are true, too.  Signals
THEORY-NOT-FOUND, NO-HORIZON, THEORY-ERROR."
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
                        :open-events open-events :tracked tracked :named named :seed seed
                        :timeout timeout
                        :logic (cond (logic-p logic)
                                     ((theory-numeric-fluents theory) nil)
                                     (t "QF_FD"))))
           (setf done t))
      (unless done (z3:close-context context)))))

(defun check-open (reasoner)
  (when (reasoner-closed reasoner)
    (error 'closed-reasoner :theory (theory-name (reasoner-theory reasoner)))))

(defun close-reasoner (reasoner)
  "Release what REASONER holds of Z3; do nothing if that was done before."
  (setf (reasoner-closed reasoner) t)
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
    (and (not (horizon-dependent-p (reasoner-theory reasoner)))
         (null (ground-theory-absolute-clauses (reasoner-ground reasoner)))
         (zerop (fill-pointer (template-literals (encoder-absolute encoder)))))))

(defun extend-horizon (reasoner last)
  "Let the timepoint LAST be the last one of REASONER, and return it.  What was asserted stays where
no axiom compares timepoints or names them by number; else it is made anew."
  (let* ((horizon (reasoner-horizon reasoner))
         (old (cdr horizon))
         (new (cons (car horizon) last)))
    (check-type last integer)
    (check-open reasoner)
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
        (check-open theory)
        (when horizon
          (let ((asked (check-horizon (reasoner-theory theory) horizon)))
            (unless (equal asked (reasoner-horizon theory))
              (error 'outside-horizon :time (cdr asked) :horizon (reasoner-horizon theory)))))
        (unless (reasoner-encoder theory)
          (build theory))
        (funcall (the function function) theory))
      (let ((reasoner (apply #'make-reasoner theory options)))
        (unwind-protect (funcall (the function function) reasoner)
          (close-reasoner reasoner)))))

(defmacro with-reasoner-of ((variable theory &rest options) &body body)
  "Evaluate BODY with VARIABLE bound to THEORY, if it is a reasoner, else to one made for it."
  `(call-with-reasoner (lambda (,variable) ,@body) ,theory (list ,@options)))
