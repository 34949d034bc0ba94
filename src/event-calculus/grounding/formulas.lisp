;;;; Compiling formulas; see compiler.lisp for what is compiled and when instances are dropped.
;;;;
;;;; The conditions of an implication or of an existential conjunction that only compare terms are
;;;; filters: they are tried as soon as their variables are bound, and an equation with a variable
;;;; binds it, so that (= ?height2 (- ?height1 ?offset)) costs no loop over heights.
;;;; Entry points: COMPILE-FORMULA, COMPILE-INSTANCES.

(in-package #:discrepancy-finder.event-calculus)

;;; Comparisons

(defun compile-comparison (compilation form)
  (if (mentions-value-p form)
      (compile-numeric-comparison compilation form)
      (compile-constant-comparison compilation form)))

(defun compile-constant-comparison (compilation form)
  (let ((left (compile-term compilation (second form)))
        (right (compile-term compilation (third form)))
        (drop (dropper compilation))
        (operator (first form)))
    (declare (type function left right drop))
    (environment-lambda (environment)
      (let ((p (funcall left environment)) (q (funcall right environment)))
        (case operator
          (:= (equal p q))
          (:/= (not (equal p q)))
          (t (unless (and (rationalp p) (rationalp q)) (funcall drop))
           (ecase operator
             (:< (< p q)) (:<= (<= p q)) (:> (> p q)) (:>= (>= p q)))))))))

(defun form-variables (form)
  "Return the variables of FORM without quantifiers."
  (remove-duplicates (mapcan #'term-variables (copy-list (rest form)))))

;;; Effects in conditions

(defun effects-of (ground kind event fluent)
  "Return the effects of KIND that the ground EVENT has on the ground FLUENT in GROUND."
  (remove-if-not (lambda (effect)
                   (and (eq (effect-kind effect) kind) (= (effect-fluent effect) fluent)))
                 (svref (ground-theory-effects ground) event)))

(defun within-horizon-p (formula time)
  "Return true if the ground FORMULA about TIME speaks of no timepoint after the horizon."
  (map-atoms (lambda (atom)
               (when (and (not *relative*) *horizon* (integerp (third atom))
                          (> (+ time (third atom) (if (eq (first atom) :event) 1 0))
                             (cdr *horizon*)))
                 (return-from within-horizon-p nil)))
             formula)
  t)

(defun effect-proposition (ground kind event fluent time)
  "Return the ground formula that EVENT has an effect of KIND on FLUENT at TIME."
  (fold :or (loop for effect in (effects-of ground kind event fluent)
                  when (if (effect-time effect)
                           (eql (effect-time effect) time)
                           (within-horizon-p (effect-guard effect) time))
                    do (pushnew (effect-axiom effect) *definitions*)
                    and collect (shift-formula (effect-guard effect)
                                               (if (effect-time effect) 0 time)))))

(defun interval-proposition (ground kind first fluent last)
  "Return the ground formula that some event has an effect of KIND on FLUENT at a timepoint from
FIRST to LAST."
  (fold :or (loop for time from first to last
                  nconc (loop for effect in (svref (ground-theory-effects-on ground) fluent)
                              when (and (eq (effect-kind effect) kind)
                                        (or (null (effect-time effect))
                                            (eql (effect-time effect) time))
                                        (or *relative* (null *horizon*)
                                            (<= (car *horizon*) time (1- (cdr *horizon*)))))
                                collect (progn
                                          (note-times time (1+ time))
                                          (pushnew (effect-axiom effect) *definitions*)
                                          (fold :and
                                                (list (list :event (effect-event effect) time)
                                                      (shift-formula (effect-guard effect)
                                                                     (if (effect-time effect)
                                                                         0
                                                                         time)))))))))

(defun compile-effect-condition (compilation form)
  (let ((ground (compilation-ground compilation))
        (event (compile-event compilation (second form)))
        (fluent (compile-fluent compilation (third form)))
        (time (compile-time compilation (fourth form)))
        (kind (first form)))
    (declare (type function event fluent time))
    (environment-lambda (environment)
      (effect-proposition ground kind (funcall event environment) (funcall fluent environment)
                          (funcall time environment)))))

(defun compile-interval-condition (compilation form)
  "Compile stopped-in and its kin: DEC1, DEC2."
  (let ((ground (compilation-ground compilation))
        (first (compile-time compilation (second form)))
        (fluent (compile-fluent compilation (third form)))
        (last (compile-time compilation (fourth form)))
        (kind (if (member (first form) '(:stopped-in :clipped)) :terminates :initiates))
        (start (if (member (first form) '(:stopped-in :started-in)) 1 0)))
    (declare (type function first fluent last))
    (environment-lambda (environment)
      (interval-proposition ground kind (+ start (funcall first environment))
                            (funcall fluent environment) (1- (funcall last environment))))))

(defun compile-predication (compilation form)
  (let ((theory (compilation-theory compilation)))
    (case (first form)
      ((:holds-at :released-at)
       (compile-timed (if (eq (first form) :holds-at) :fluent :released)
                      (compile-fluent compilation (second form))
                      (compile-time compilation (third form))))
      (:happens (compile-timed :event (compile-event compilation (second form))
                               (compile-time compilation (third form) :event t)))
      ((:initiates :terminates :releases) (compile-effect-condition compilation form))
      ((:stopped-in :started-in :clipped :declipped)
       (compile-interval-condition compilation form))
      (t (let ((declaration (assoc (first form) (theory-predicates theory))))
           (if declaration
               (compile-predicate compilation form declaration)
               ;; in a state formula
               (compile-timed :fluent (compile-fluent compilation form)
                              (compile-constant 0))))))))

;;; Quantifiers

(defun filters-of (form universal)
  "Return the conditions without which an instance of FORM is true (UNIVERSAL) or false."
  (flet ((conjuncts (form)
           (if (eq (first form) :and) (rest form) (list form))))
    (remove-if-not #'static-form-p
                   (if universal
                       (and (eq (first form) :implies) (consp (second form))
                            (conjuncts (second form)))
                       (conjuncts form)))))

(defun assigned-term (filter variable bound)
  "Return the term that FILTER equates VARIABLE to if all its variables are BOUND."
  (when (eq (first filter) :=)
    (loop for (a b) in (list (rest filter) (reverse (rest filter)))
          when (and (eq a variable) (subsetp (term-variables b) bound))
            return b)))

(defun order-variables (variables filters bound)
  "Return a list of (variable term-or-NIL filters-to-try): how to bind VARIABLES."
  (let ((steps '()))
    (loop while variables
          do (let* ((assigned (loop for variable in variables
                                    thereis (loop for filter in filters
                                                  for term = (assigned-term filter variable bound)
                                                  when term return (list variable term filter))))
                    (variable (if assigned (first assigned) (first variables))))
               (setf variables (remove variable variables))
               (push variable bound)
               (let ((ready (remove-if-not (lambda (filter)
                                             (subsetp (form-variables filter) bound))
                                           filters)))
                 (setf filters (set-difference filters ready))
                 (push (list variable (second assigned) (remove (third assigned) ready))
                       steps))))
    (nreverse steps)))

(defun compile-instances (compilation variables filters level)
  "Return a function of a function and an environment that calls the function for each binding of
VARIABLES in the environment that passes FILTERS.  A THROW to the tag of LEVEL skips one."
  (let ((theory (compilation-theory compilation))
        (tag (level-tag level))
        (bound (set-difference (mapcar #'car (compilation-slots compilation)) variables)))
    (labels ((build (steps)
               (if (null steps)
                   (lambda (function environment)
                     (declare (type function function))
                     (catch tag (funcall function environment)))
                   (destructuring-bind (variable term filters) (first steps)
                     (let ((slot (cdr (assoc variable (compilation-slots compilation))))
                           (sort (variable-sort theory variable))
                           (value (and term (compile-term compilation term)))
                           (tests (loop for filter in filters
                                        collect (compile-formula compilation filter)))
                           (next (build (rest steps))))
                       (declare (type (integer 0 63) slot) (type function next)
                                (type (or null function) value))
                       (flet ((try (element function environment)
                                (declare (type environment environment))
                                (setf (svref environment slot) element)
                                (when (catch tag
                                        (loop for test of-type function in tests
                                              always (funcall test environment)))
                                  (funcall next function environment))))
                         (if value
                             (lambda (function environment)
                               (let ((element (catch tag (funcall value environment))))
                                 (when (and element (element-of-sort-p theory element sort))
                                   (try element function environment))))
                             (lambda (function environment)
                               (dolist (element (sort-elements theory sort))
                                 (try element function environment))))))))))
      (build (order-variables variables filters bound)))))

(defun compile-quantifier (compilation form)
  (destructuring-bind (quantifier variables body) form
    (multiple-value-bind (inner level) (extend-compilation compilation variables)
      (let* ((ground (compilation-ground compilation))
             (universal (eq quantifier :forall))
             (instances (compile-instances inner variables (filters-of body universal) level))
             (body (compile-formula inner body)))
        (declare (type function instances body))
        (environment-lambda (environment)
          (let ((parts '()))
            (funcall instances
                     (lambda (environment)
                       (count-instance ground)
                       (push (funcall body environment) parts))
                     environment)
            (fold (if universal :and :or) (nreverse parts))))))))

;;; Connectives

(defun compile-formula (compilation form)
  "Return a function of an environment that returns the ground formula of FORM."
  (flet ((parts ()
           (mapcar (lambda (part) (compile-formula compilation part)) (rest form))))
    (case (first form)
      ((:and :or)
       (let ((operator (first form)) (parts (parts)))
         (environment-lambda (environment)
           (fold operator (loop for part of-type function in parts
                                collect (funcall part environment))))))
      (:not
       (let ((part (first (parts))))
         (declare (type function part))
         (environment-lambda (environment) (fold-not (funcall part environment)))))
      ((:implies :iff)
       (destructuring-bind (p q) (parts)
         (declare (type function p q))
         (if (eq (first form) :implies)
             (environment-lambda (environment)
               (let ((premise (funcall p environment)))
                 (fold :or (list (fold-not premise) (funcall q environment)))))
             (environment-lambda (environment)
               (fold-iff (funcall p environment) (funcall q environment))))))
      ((:forall :exists) (compile-quantifier compilation form))
      ((:= :/= :< :<= :> :>=) (compile-comparison compilation form))
      (t (compile-predication compilation form)))))

(defun ground-formula (ground form &key bindings (time 0) horizon)
  "Return the checked formula FORM as a ground formula of GROUND.  BINDINGS is an alist of its free
variables.  ?time is bound to TIME; with HORIZON, a pair of timepoints, times are timepoints within
it, else distances.  A formula with an argument outside of its sort is NIL."
  (let* ((bindings (acons :?time time bindings))
         (environment (make-array +environment-size+ :initial-element nil))
         (*relative* (null horizon))
         (*horizon* (or horizon *horizon*))
         (*instances* (cons "a formula" 0))
         (*span* (cons 0 0)))
    (multiple-value-bind (compilation level)
        (extend-compilation (make-compilation :ground ground) (mapcar #'car bindings))
      (loop for (variable . value) in bindings
            do (setf (svref environment (cdr (assoc variable (compilation-slots compilation))))
                     value))
      (let ((function (compile-formula compilation form)))
        (catch (level-tag level)
          (funcall (the function function) environment))))))
