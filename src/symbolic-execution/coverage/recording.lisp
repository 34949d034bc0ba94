;;;; Recording which forms of plans are evaluated, which ways their conditions take, which outcomes
;;;; steps have and which axioms these make use of.
;;;;
;;;; A RECORDER belongs to an exploration that records its coverage.  While it is in force, forms
;;;; that have a source position are made into code that notes in a FORM-RECORD when it runs;
;;;; without one code is as it always is.  See coverage.lisp for what is made of it.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (form-record (:copier nil))
  "FORM begins at POSITION; COVERED is true once it was evaluated.  BRANCHES are pairs: whether a
condition in it was true, and whether it was false.  NUMBER is greater than that of forms around."
  (number 0 :type fixnum :read-only t)
  (form nil :type cons :read-only t)
  (position nil :read-only t)
  (covered nil :type boolean)
  (branches '() :type list))

(defstruct (recorder (:copier nil))
  "RECORDS are those of forms, by the form.  PLANS are the interpreted functions of plans that note
what they do.  OUTCOMES are (class type . number) of the outcomes that were taken, AXIOMS the axioms
that were made use of, PERSISTENCES has what persisted by inertia as its keys; see grounds.lisp."
  (records (make-hash-table :test 'eq :synchronized t) :type hash-table :read-only t)
  (plans (make-hash-table :test 'eq :synchronized t) :type hash-table :read-only t)
  (outcomes '() :type list)
  (axioms '() :type list)
  (persistences (make-hash-table :test 'equal) :type hash-table :read-only t))

(defvar *recorder* nil
  "The RECORDER in force, or NIL.")

(defvar *record* nil
  "The FORM-RECORD of the innermost form with a source position that is being analyzed, or NIL.")

(defparameter *branching-operators*
  '(if when unless cond case ecase ccase typecase etypecase ctypecase and or)
  "Operators whose forms are expected to be evaluated in more than one way.")

(defun form-record (form)
  "Return the record of FORM, which is going to be analyzed, or NIL if nothing is to be noted."
  (let ((position (and *recorder* (source:form-position form))))
    (and position
         (or (gethash form (recorder-records *recorder*))
             (setf (gethash form (recorder-records *recorder*))
                   (make-form-record :form form :position position
                                     :number (hash-table-count
                                              (recorder-records *recorder*))))))))

(declaim (inline note-form))
(defun note-form (record)
  "Note that the form of RECORD is evaluated."
  (setf (form-record-covered record) t))

(defun noting-code (code record)
  "Return code that does what CODE does and notes it in RECORD."
  (declare (type function code))
  (lambda (frame)
    (note-form record)
    (funcall code frame)))

(defmacro with-form-noted ((form) &body body)
  "Evaluate BODY, which returns the code of FORM, and return that, or code that notes when it runs."
  `(call-with-form-noted ,form (lambda () ,@body)))

(defun call-with-form-noted (form analyze)
  (let ((record (and *recorder* (form-record form))))
    (if record
        (let ((*record* record))
          (multiple-value-call (lambda (code &rest more)
                                 (apply #'values (noting-code code record) more))
            (funcall (the function analyze))))
        (funcall (the function analyze)))))

(defun noting-branches (then else)
  "Return the codes THEN and ELSE of an IF that is being analyzed, or codes that note in the record
of the form around it which one runs."
  (declare (type function then else))
  (let ((record *record*))
    (if (and record (member (first (form-record-form record)) *branching-operators*))
        (let ((branch (cons nil nil)))
          (setf (form-record-branches record)
                (append (form-record-branches record) (list branch)))
          (values (lambda (frame) (setf (car branch) t) (funcall then frame))
                  (lambda (frame) (setf (cdr branch) t) (funcall else frame))))
        (values then else))))

;;; Steps

(defun note-axioms (recorder axioms)
  (dolist (axiom axioms)
    (pushnew axiom (recorder-axioms recorder))))

(defun persistences (state next)
  "Return a list of (:inertia fluent event truth) for the names of fluents that have the same truth
value, T or NIL, in STATE and in NEXT, and those of the events in between (NIL if nothing happened);
a fluent that is open in both counts for both values."
  (let ((events (or (loop for (event . proposition) in (ec:state-happenings next)
                          when proposition collect (first event))
                    '(nil)))
        (entries '()))
    (loop for atom across (ec:ground-theory-fluents (ec:state-ground state))
          for before across (ec:state-values state)
          for after across (ec:state-values next)
          do (dolist (truth '(t nil))
               (when (and (or (eq before truth) (z3:term-p before))
                          (or (eq after truth) (z3:term-p after)))
                 (dolist (event events)
                   (pushnew (list :inertia (first atom) event truth) entries :test #'equal)))))
    entries))

(defun note-persistences (recorder state next)
  "Note in RECORDER what persists from STATE to NEXT."
  (dolist (entry (persistences state next))
    (setf (gethash entry (recorder-persistences recorder)) t)))

(defun note-step-taken (recorder state outcome next)
  "Note in RECORDER that OUTCOME led from STATE to NEXT."
  (let ((binding (outcome-binding outcome)))
    (pushnew (list* (action-binding-class binding) (action-binding-type binding)
                    (outcome-number outcome))
             (recorder-outcomes recorder) :test #'equal)
    (note-axioms recorder (ec:axioms-used state next))
    (note-persistences recorder state next)))

(defun note-considered (recorder ground outcomes)
  "Note in RECORDER that the OUTCOMES of an action were considered."
  (dolist (outcome outcomes)
    (when (outcome-event outcome)
      (note-axioms recorder (ec:axioms-about-event ground (outcome-event outcome))))))

(defun note-beginning (recorder ground)
  "Note in RECORDER what the theory GROUND says of initial states."
  (note-axioms recorder (ec:initial-axioms ground)))
