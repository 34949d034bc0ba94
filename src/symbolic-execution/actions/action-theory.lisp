;;;; Action theories, also called domains: a theory and what designators mean in it.
;;;;
;;;; An ACTION-THEORY is registered under its name; its action bindings belong to it.

(in-package #:discrepancy-finder.symbolic-execution)

(defclass action-theory ()
  ((name :initarg :name :reader action-theory-name :type keyword
         :documentation "The name, a keyword.")
   (theory :initarg :theory :reader action-theory-theory :type ec:theory
           :documentation "The THEORY.")
   (ground :reader action-theory-ground :type ec:ground-theory
           :documentation "The same, ground.")
   (actions :initarg :actions :initform '() :accessor action-theory-actions
            :documentation "List of action bindings, the youngest first.")
   (formulas :initform (make-hash-table :test 'equal :synchronized t)
             :reader action-theory-formulas
             :documentation "The ground formula of each state formula that was asked for."))
  (:documentation "A theory and what designators mean in it."))

(defmethod initialize-instance :after ((domain action-theory) &key theory)
  (setf (slot-value domain 'ground) (ec:ground theory)))

(defmethod print-object ((domain action-theory) stream)
  (print-unreadable-object (domain stream :type t)
    (format stream "~a: ~d action~:p" (ec:name-text (action-theory-name domain))
            (length (action-theory-actions domain)))))

(defun ground-state-formula (domain formula blame)
  "Return FORMULA, T, NIL or a state formula as it is written, as a ground formula of the theory of
DOMAIN.  BLAME is a function that returns the text that names it in errors.  Signals THEORY-ERROR."
  (if (typep formula 'boolean)
      formula
      (let ((known (action-theory-formulas domain)))
        (or (gethash formula known)
            (setf (gethash (copy-tree formula) known)
                  (ec:ground-formula (action-theory-ground domain)
                                     (ec:parse-formula formula (action-theory-theory domain)
                                                       :blame (funcall blame))))))))

(defgeneric region-of-pose (action-theory pose &optional sort)
  (:documentation "Return the element (a keyword) of ACTION-THEORY that stands for the place of
POSE, one of SORT (a symbol) if that is given, or NIL if none does."))

(defvar *domains* (make-hash-table :test 'eq)
  "The action theory of each name, a keyword.")

(defun find-action-theory (name)
  "Return the ACTION-THEORY (the domain) named by the symbol NAME.  Signals DOMAIN-NOT-FOUND."
  (or (gethash (ec:name-keyword name) *domains*)
      (error 'domain-not-found :name name)))

;;; Registry

(defun register-action-theory (domain)
  "Make DOMAIN the ACTION-THEORY of its name, and return it."
  (setf (gethash (action-theory-name domain) *domains*) domain))

(defun make-domain (theory &optional (name theory))
  "Return a new domain named NAME, a symbol, of the theory named THEORY, and register it.  It has no
scene and, at first, no action bindings: plans can be explored in it, not projected.  Signals
THEORY-NOT-FOUND."
  (let ((theory (ec:find-theory theory)))
    (register-action-theory
     (make-instance 'action-theory :name (ec:name-keyword name) :theory theory))))

(defun all-action-theories ()
  "Return the list of all registered ACTION-THEORYs."
  (alexandria:hash-table-values *domains*))
