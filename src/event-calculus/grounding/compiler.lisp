;;;; Formulas with variables, compiled into functions that make them ground.
;;;;
;;;; COMPILE-FORMULA turns a formula into a function of an environment, a vector with the values of
;;;; its variables, that returns a ground formula.  In relative mode the one time variable is bound
;;;; to 0, so that a time evaluates to the distance from it; in absolute mode times are timepoints.
;;;;
;;;; As in the Discrete Event Calculus Reasoner, an instance of a quantifier is dropped, be it
;;;; universal or existential, if an argument lies outside of its sort, an event would happen at the
;;;; last timepoint or before the first, or a function has no value: the innermost quantifier around
;;;; drops its instance, by a THROW to its level.

(in-package #:discrepancy-finder.event-calculus)

(defvar *relative* t
  "True while axioms are made ground relative to an arbitrary timepoint.")

(defvar *span* (cons 0 0)
  "The first and the last time met since the begin of the instance.")
(declaim (type cons *span*))

(defvar *definitions* '()
  "The effect axioms that the conditions of the instance were replaced by.")

(defstruct (level (:copier nil))
  "A quantifier: its variables and the tag to which its instances are dropped."
  (variables '() :type list :read-only t)
  (tag nil :read-only t))

(defstruct (compilation (:copier nil))
  "LEVELS are the quantifiers around, innermost first; SLOTS is an alist of variables and their
places in the environment."
  (ground nil :type ground-theory :read-only t)
  (levels '() :type list :read-only t)
  (slots '() :type list :read-only t))

(deftype environment () `(simple-vector ,+environment-size+))

(defmacro environment-lambda ((environment) &body body)
  `(lambda (,environment)
     (declare (type environment ,environment) (ignorable ,environment)
              (optimize speed (safety 1)) (sb-ext:muffle-conditions sb-ext:compiler-note))
     ,@body))

(defun compilation-theory (compilation)
  (ground-theory-theory (compilation-ground compilation)))

;;; Counting

(defvar *instances* nil
  "What is being made ground, an axiom or a text, and the number of instances so far; or NIL.")
(declaim (type list *instances*))

(defun heap-nearly-full-p ()
  "Return true if the heap is so full that a garbage collection might not find room to copy into."
  (flet ((full-p ()
           (> (sb-kernel:dynamic-usage) (* 2/5 (sb-ext:dynamic-space-size)))))
    (and (full-p)
         (progn (sb-ext:gc :full t)
                (full-p)))))

(defun count-instance (ground)
  "Count an instance of a quantifier.  Signals THEORY-ERROR if there are too many or the heap, whose
exhaustion would end Lisp, is nearly full."
  (when *instances*
    (let ((count (incf (the fixnum (cdr *instances*)))))
      (flet ((problem (control &rest arguments)
               (apply #'theory-problem (ground-theory-theory ground) (car *instances*) nil control
                      arguments)))
        (when (> count +most-instances+)
          (problem "it has more than ~d instances" +most-instances+))
        (when (and (zerop (mod count 10000)) (heap-nearly-full-p))
          (problem "~d instances of it fill the heap of ~d MB" count
                   (floor (sb-ext:dynamic-space-size) 1000000)))))))

(defun extend-compilation (compilation variables)
  "Return COMPILATION inside of a quantifier of VARIABLES, and the level."
  (let* ((slots (compilation-slots compilation))
         (level (make-level :variables variables :tag (list variables))))
    (dolist (variable variables)
      (when (>= (length slots) +environment-size+)
        (theory-problem (compilation-theory compilation) nil nil
                        "an axiom has more than ~d variables" +environment-size+))
      (setf slots (acons variable (length slots) slots)))
    (values (make-compilation :ground (compilation-ground compilation) :slots slots
                              :levels (cons level (compilation-levels compilation)))
            level)))

(defun term-variables (term)
  (cond ((variable-p term) (list term))
        ((consp term) (remove-duplicates (mapcan #'term-variables (copy-list (rest term)))))))

(defun dropper (compilation)
  "Return a function that drops the instance of the innermost quantifier."
  (let ((tag (level-tag (first (compilation-levels compilation)))))
    (lambda () (throw tag nil))))

;;; Terms

(defun compile-constant (value)
  (environment-lambda (environment) value))

(defun compile-variable (compilation variable)
  (let ((slot (cdr (assoc variable (compilation-slots compilation)))))
    (declare (type (or null (integer 0 63)) slot))
    (unless slot
      (error "The variable ~a is unbound." variable))
    (environment-lambda (environment) (svref environment slot))))

(defun compile-arithmetic (compilation term)
  (let ((operator (first term))
        (parts (mapcar (lambda (part) (compile-term compilation part)) (rest term)))
        (drop (dropper compilation)))
    (environment-lambda (environment)
      (let ((values (loop for part of-type function in parts
                          collect (funcall part environment))))
        (unless (every #'rationalp values)
          (funcall (the function drop)))
        (ecase operator
          (:+ (reduce #'+ values))
          (:- (apply #'- values))
          (:* (reduce #'* values))
          ((:/ :mod) (unless (every #'integerp values)
                       (funcall (the function drop)))
           (when (eql (second values) 0)
                       (funcall (the function drop)))
           (if (eq operator :/)
               (values (truncate (first values) (second values)))
               (rem (first values) (second values)))))))))

(defun compile-arguments (compilation terms sorts)
  "Return a function that returns the list of the values of TERMS, each checked to be of its sort."
  (let* ((theory (compilation-theory compilation))
         (functions
           (loop for term in terms
                 for sort in sorts
                 collect
                 (let ((value (compile-term compilation term))
                       (drop (dropper compilation))
                       (sort sort))
                   (declare (type function value drop))
                   (if (and (variable-p term) (eq (variable-sort theory term) sort))
                       value
                       (environment-lambda (environment)
                         (let ((value (funcall value environment)))
                           (if (element-of-sort-p theory value sort)
                               value
                               (funcall drop)))))))))
    (environment-lambda (environment)
      (loop for function of-type function in functions
            collect (funcall function environment)))))

(defun compile-symbol-term (compilation term declaration)
  "Return a function for TERM, which DECLARATION (name sort*) declares."
  (let ((arguments (compile-arguments compilation (rest term) (rest declaration)))
        (name (first term)))
    (declare (type function arguments))
    (environment-lambda (environment) (cons name (funcall arguments environment)))))

(defun compile-application (compilation term)
  (let* ((theory (compilation-theory compilation))
         (operator (first term))
         (function (find-function theory operator)))
    (cond ((member operator *arithmetic*) (compile-arithmetic compilation term))
          (function
           (let ((key (compile-symbol-term compilation term (first function)))
                 (table (ground-theory-function-values (compilation-ground compilation)))
                 (drop (dropper compilation)))
             (declare (type function key drop))
             (environment-lambda (environment)
               (multiple-value-bind (value known) (gethash (funcall key environment) table)
                 (if known value (funcall drop))))))
          (t (compile-symbol-term compilation term
                                  (or (nth-value 1 (reified-symbol theory operator))
                                      (assoc operator (theory-fluents theory))
                                      (assoc operator (theory-events theory))))))))

(defun compile-term (compilation term)
  "Return a function that returns the value of TERM in an environment."
  (cond ((variable-p term) (compile-variable compilation term))
        ((atom term) (compile-constant term))
        (t (compile-application compilation term))))

;;; Times

(defun note-times (first last)
  (declare (type fixnum first last))
  (let ((span *span*))
    (when (< first (the fixnum (car span))) (setf (car span) first))
    (when (> last (the fixnum (cdr span))) (setf (cdr span) last))))

(defun compile-time (compilation term &key event)
  "Return a function that returns the time TERM, of an event if EVENT is true."
  (let ((value (compile-term compilation term))
        (drop (dropper compilation))
        (duration (if event 1 0)))
    (declare (type function value drop))
    (environment-lambda (environment)
      (let ((time (funcall value environment)))
        (unless (typep time 'fixnum) (funcall drop))
        (let ((end (+ (the fixnum time) duration)))
          (unless (or *relative*
                      (and *horizon* (<= (the fixnum (car *horizon*)) (the fixnum time))
                           (<= end (the fixnum (cdr *horizon*)))))
            (funcall drop))
          (note-times time end)
          time)))))

;;; Atoms

(defun compile-member (compilation term index declarations)
  "Return a function that returns the number of the ground fluent or event TERM."
  (let ((value (if (variable-p term)
                   (compile-term compilation term)
                   (compile-symbol-term compilation term (assoc (first term) declarations))))
        (drop (dropper compilation)))
    (declare (type function value drop))
    (environment-lambda (environment)
      (or (gethash (funcall value environment) index)
          (funcall drop)))))

(defun compile-fluent (compilation term)
  (compile-member compilation term
                  (ground-theory-fluent-index (compilation-ground compilation))
                  (theory-fluents (compilation-theory compilation))))

(defun compile-numeric (compilation term)
  (compile-member compilation term
                  (ground-theory-numeric-index (compilation-ground compilation))
                  (theory-numeric-fluents (compilation-theory compilation))))

(defun compile-event (compilation term)
  (compile-member compilation term
                  (ground-theory-event-index (compilation-ground compilation))
                  (theory-events (compilation-theory compilation))))

(defun compile-timed (kind number time)
  (declare (type function number time))
  (environment-lambda (environment)
    (let ((number (funcall number environment)))
      (list kind number (funcall time environment)))))

(defun compile-predicate (compilation form declaration)
  "Return a function for FORM, an atom of one of the theory's own predicates."
  (let* ((ground (compilation-ground compilation))
         (sorts (rest declaration))
         (name (first form))
         (table (extension-table (ground-theory-theory ground) name))
         (place (and (= 1 (count :time sorts)) (position :time sorts))))
    (cond
      (table
       (let ((arguments (compile-arguments compilation (rest form) sorts)))
         (declare (type function arguments))
         (environment-lambda (environment)
           (values (gethash (funcall arguments environment) table)))))
      (place
       (let ((arguments (compile-arguments compilation
                                           (append (subseq (rest form) 0 place)
                                                   (nthcdr (1+ place) (rest form)))
                                           (remove :time sorts)))
             (time (compile-time compilation (nth place (rest form)))))
         (declare (type function arguments time))
         (environment-lambda (environment)
           (list :predicate
                 (intern-atom (ground-theory-predicates ground)
                              (cons name (funcall arguments environment)))
                 (funcall time environment)))))
      (t
       (let ((arguments (compile-arguments compilation (rest form) sorts)))
         (declare (type function arguments))
         (environment-lambda (environment)
           (list :static (intern-atom (ground-theory-statics ground)
                                      (cons name (funcall arguments environment))))))))))
