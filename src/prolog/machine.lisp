;;;; The proof of a query.
;;;;
;;;; A FRAME is a list of goals to prove and the frame after it; no frame at all is a solution.  A
;;;; CHOICE is a frame to go on with if the current one fails.  Both are chained in the heap, so
;;;; that the depth of a proof is not bounded by the control stack.  A goal is a template with its
;;;; environment, a term, or a function, called with the proof and the next frame.
;;;;
;;;; Each step sets the frame only when it is done.  So a proof that was left by a non-local exit
;;;; out of a Lisp function can be asked again and tries the same goal once more.
;;;;
;;;; The entry point is PROLOG.

(in-package #:discrepancy-finder.prolog)

(defstruct (frame (:constructor make-frame (goals environment barrier next)) (:copier nil))
  "GOALS, terms or, with an ENVIRONMENT, templates.  BARRIER: the choices to which a cut goes back."
  (goals '() :type list :read-only t)
  (environment nil :type (or null simple-vector) :read-only t)
  (barrier nil :read-only t)
  (next nil :type (or null frame) :read-only t))

(defstruct (choice (:constructor make-choice (frame trail previous)) (:copier nil))
  "The frame to go on with, the trail to which bindings are undone, and the choice before."
  (frame nil :type (or null frame) :read-only t)
  (trail '() :type list :read-only t)
  (previous nil :type (or null choice) :read-only t))

(defmethod print-object ((frame frame) stream)
  (print-unreadable-object (frame stream :type t)
    (format stream "~d goal~:p" (length (frame-goals frame)))))

(defmethod print-object ((choice choice) stream)
  (print-unreadable-object (choice stream :type t)))

(defun push-choice (proof frame &optional (trail (proof-trail proof)))
  (setf (proof-choices proof) (make-choice frame trail (proof-choices proof))))

(defun backtrack (proof)
  "Go on with the latest choice of PROOF and return true, or return false if there is none."
  (let ((choice (proof-choices proof)))
    (when choice
      (setf (proof-choices proof) (choice-previous choice))
      (undo-to proof (choice-trail choice))
      (setf (proof-frame proof) (choice-frame choice))
      t)))

;;; Clauses

(defun slot-term (slot environment)
  "Return the term in SLOT of ENVIRONMENT, a new variable if there is none."
  (let* ((index (slot-index slot))
         (term (svref environment index)))
    (if (eq term '%unbound)
        (setf (svref environment index) (make-variable (slot-name slot)))
        term)))

(defun instantiate (template environment)
  "Return the term for TEMPLATE in ENVIRONMENT."
  (flet ((leaf (template)
           (typecase template
             (slot (slot-term template environment))
             (constant (constant-value template))
             ((eql %anything) (make-variable '?_))
             (t template))))
    (if (atom template)
        (leaf template)
        (let* ((start (list (instantiate (car template) environment)))
               (cell start))
          (loop
            (setf template (cdr template))
            (when (atom template)
              (setf (cdr cell) (leaf template))
              (return start))
            (setf cell (setf (cdr cell)
                             (list (instantiate (car template) environment)))))))))

(defun match (proof template term environment)
  "Unify TEMPLATE in ENVIRONMENT with TERM; return true or false."
  (loop
    (typecase template
      (slot
       (let ((value (svref environment (slot-index template))))
         (return (cond ((eq value '%unbound)
                        (setf (svref environment (slot-index template)) term)
                        t)
                       (t (unify-terms proof value term))))))
      (cons
       (setf term (deref term))
       (cond ((consp term)
              (unless (match proof (car template) (car term) environment)
                (return nil))
              (setf template (cdr template)
                    term (cdr term)))
             ((variable-p term)
              (return (bind proof term (instantiate template environment))))
             (t (return nil))))
      (constant
       (return (unify-terms proof (constant-value template) term)))
      ((eql %anything)
       (return t))
      (t
       (setf term (deref term))
       (return (cond ((eq template term) t)
                     ((variable-p term) (assign proof term template))
                     (t (leaves-unify-p template term))))))))

(defun fitting (clauses key)
  "Return the rest of CLAUSES that begins with the first that may fit KEY."
  (loop until (or (null clauses) (keys-fit-p key (clause-key (first clauses))))
        do (pop clauses))
  clauses)

(defun enter (proof clause environment barrier next)
  (setf (proof-frame proof)
        (if (clause-goals clause)
            (make-frame (clause-goals clause) environment barrier next)
            next))
  t)

(defun try-clauses (proof arguments clauses key next)
  "Prove by the first of CLAUSES whose head fits ARGUMENTS, with the others as a choice."
  (let ((barrier (proof-choices proof))
        (mark (proof-trail proof)))
    (setf clauses (fitting clauses key))
    (loop
      (when (null clauses)
        (return nil))
      (let* ((clause (pop clauses))
             (environment (make-array (clause-size clause) :initial-element '%unbound)))
        (setf clauses (fitting clauses key)
              (proof-trailing proof) (and clauses t))
        (let ((fits (match proof (clause-parameters clause) arguments environment)))
          (setf (proof-trailing proof) nil)
          (cond (fits
                 (when clauses
                   (let ((others clauses))
                     (push-choice proof
                                  (make-frame (list (lambda (proof next)
                                                      (try-clauses proof arguments others key
                                                                   next)))
                                              nil nil next)
                                  mark)))
                 (return (enter proof clause environment barrier next)))
                (clauses (undo-to proof mark))))))))

;;; Goals

(defun malformed (goal control &rest arguments)
  (error 'malformed-goal :goal (externalise goal) :reason (apply #'format nil control arguments)))

(defun proper-arguments (goal)
  "Return the list of the arguments of GOAL and its length."
  (let ((length 0))
    (loop for tail = (cdr goal) then (cdr tail)
          while (consp tail)
          do (incf length)
          finally (when (null tail)
                    (return-from proper-arguments (values (cdr goal) length))))
    ;; The end of the list is a variable: make it a list, if it is one.
    (let ((arguments (loop for tail = (deref (cdr goal)) then (deref (cdr tail))
                           while (consp tail)
                           collect (car tail)
                           finally (when tail
                                     (malformed goal "its arguments are no list")))))
      (values arguments (length arguments)))))

(defun fail-unknown (proof goal predicate)
  (unless (extendable-p (car goal))
    (warn 'unknown-predicate
          :goal (externalise goal) :query (proof-query proof)
          :arities (and predicate
                        (sort (remove-duplicates
                               (loop for (nil . clauses) in (predicate-sections predicate)
                                     append (remove nil (mapcar #'clause-arity clauses))))
                              #'<))))
  nil)

(defun prove-goal (proof goal barrier next)
  "Prove the term GOAL as far as one step goes; set the frame and return true, or return false."
  (setf goal (deref goal))
  (when (and (symbolp goal) goal)
    (setf goal (list goal)))
  (unless (consp goal)
    (malformed goal (if (variable-p goal) "it is an unbound variable" "it is no list")))
  (let* ((functor (deref (car goal)))
         (predicate (if (and (symbolp functor) functor)
                        (find-predicate functor)
                        (malformed goal "its predicate is no name"))))
    (unless (eq functor (car goal))
      (setf goal (cons functor (cdr goal))))
    (multiple-value-bind (arguments arity) (proper-arguments goal)
      (cond ((null predicate)
             (fail-unknown proof goal predicate))
            ((predicate-control predicate)
             (funcall (predicate-control predicate) proof goal arguments barrier next))
            (t (let ((bucket (predicate-bucket predicate arity)))
                 (if (bucket-clauses bucket)
                     (let ((key (if arguments (term-key (first arguments)) '%any)))
                       (try-clauses proof arguments (candidates bucket key) key next))
                     (fail-unknown proof goal predicate))))))))

(defun next-frame (frame)
  "Return the frame after the first goal of FRAME."
  (if (rest (frame-goals frame))
      (make-frame (rest (frame-goals frame)) (frame-environment frame)
                  (frame-barrier frame) (frame-next frame))
      (frame-next frame)))

(defun run (proof)
  "Go on with PROOF and return true if a solution is found, false if there are no more."
  (loop
    (let ((frame (proof-frame proof)))
      (when (null frame)
        (return t))
      (let ((goal (first (frame-goals frame)))
            (next (next-frame frame)))
        (unless (if (functionp goal)
                    (funcall goal proof next)
                    (prove-goal proof
                                (if (frame-environment frame)
                                    (instantiate goal (frame-environment frame))
                                    goal)
                                (frame-barrier frame) next))
          (unless (backtrack proof)
            (return nil)))))))

(defun solutions (proof names)
  "Return the lazy list of the binding sets that PROOF finds for NAMES."
  (if (run proof)
      (let ((solution (names-solution names)))
        (if (proof-choices proof)
            (lazy-cons solution
                       (progn
                         ;; Without a frame the last solution was delivered; with one, a Lisp
                         ;; function left the search for the next.
                         (unless (proof-frame proof) (backtrack proof))
                         (solutions proof names)))
            (list solution)))
      '()))

(defun prolog (query &optional bindings)
  "Return the lazy list of the binding sets that make the goal QUERY true under BINDINGS, or NIL if
there is none.  VAR-VALUE finds the value of a variable of QUERY in a binding set; a binding set of
a query without variables is NIL.  The first solution is computed at once, each other one, with the
side effects of its Lisp functions, when it is asked for.  Warns by UNKNOWN-PREDICATE and
LISP-ERROR-IN-GOAL; signals MALFORMED-GOAL."
  (let* ((names (make-names bindings))
         (proof (make-proof query)))
    (setf (proof-frame proof) (make-frame (list (internalise query names)) nil nil nil))
    (solutions proof names)))
