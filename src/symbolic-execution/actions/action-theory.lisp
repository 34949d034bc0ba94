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
            :documentation "List of action bindings, the youngest first."))
  (:documentation "A theory and what designators mean in it."))

(defmethod initialize-instance :after ((domain action-theory) &key theory)
  (setf (slot-value domain 'ground) (ec:ground theory)))

(defmethod print-object ((domain action-theory) stream)
  (print-unreadable-object (domain stream :type t)
    (format stream "~a: ~d action~:p" (ec:name-text (action-theory-name domain))
            (length (action-theory-actions domain)))))

(defgeneric region-of-pose (action-theory pose)
  (:documentation "Return the element of a sort of ACTION-THEORY (a keyword) that stands for the
place of POSE, or NIL if none does."))

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

(defun all-action-theories ()
  "Return the list of all registered ACTION-THEORYs."
  (alexandria:hash-table-values *domains*))
