;;;; Symbols: what they are bound to is global, and compiled code may look at it.

(in-package #:discrepancy-finder.symbolic-execution)

(define-transparent symbol-value (symbol))
(define-transparent boundp (symbol))
(define-transparent fboundp (symbol))
(define-transparent symbol-plist (symbol))

(define-transparent (set) (symbol any-value)
  (let ((symbol (settled symbol "a symbol"))
        (value (decided any-value "the value of a global variable")))
    (note-write symbol)
    (set symbol value)))

(define-transparent ((setf symbol-value)) (any-value symbol)
  (let ((symbol (settled symbol "a symbol"))
        (value (decided any-value "the value of a global variable")))
    (note-write symbol)
    (set symbol value)))

(define-transparent (makunbound) (symbol)
  (let ((symbol (settled symbol "a symbol")))
    (note-write symbol)
    (makunbound symbol)))

;;; Property lists

(defun note-plist (symbol)
  (when *path*
    (let ((plist (copy-list (symbol-plist symbol))))
      (note-undo (lambda () (setf (symbol-plist symbol) plist))))))

(define-transparent get (symbol indicator &optional (any-default nil)))

(define-transparent (sb-kernel:%put) (symbol indicator any-value)
  (let ((symbol (settled symbol "a symbol")))
    (note-plist symbol)
    (setf (get symbol (settled indicator "an indicator"))
          (decided any-value "a property of a symbol"))))

(define-transparent (remprop) (symbol indicator)
  (let ((symbol (settled symbol "a symbol")))
    (note-plist symbol)
    (remprop symbol (settled indicator "an indicator"))))

(define-transparent ((setf symbol-plist)) (any-plist symbol)
  (let ((symbol (settled symbol "a symbol")))
    (note-plist symbol)
    (setf (symbol-plist symbol) (decided any-plist "the properties of a symbol"))))

;;; Functions

(defun note-definition (name)
  (when *path*
    (if (fboundp name)
        (let ((old (fdefinition name)))
          (note-undo (lambda () (setf (fdefinition name) old))))
        (note-undo (lambda () (fmakunbound name))))))

(define-transparent ((setf fdefinition)) (function name)
  (note-definition name)
  (setf (fdefinition name) (settled function "a function")))

(define-transparent ((setf symbol-function)) (function name)
  (note-definition name)
  (setf (symbol-function name) (settled function "a function")))

(define-transparent (fmakunbound) (name)
  (note-definition name)
  (fmakunbound name))
