;;;; CASE, ECASE and TYPEP.
;;;;
;;;; SBCL expands CASE into a table with hash codes of its own, which means nothing to a symbolic
;;;; key: here it is what the standard says, one comparison after the other.

(in-package #:discrepancy-finder.symbolic-execution)

(defun clause-keys (clause)
  "Return the list of the keys of CLAUSE."
  (let ((keys (first clause)))
    (if (listp keys) keys (list keys))))

(defun otherwise-clause-p (clause)
  (member (first clause) '(t otherwise)))

(defun case-code (key clauses otherwise site)
  "Return the code of a CASE.  CLAUSES is a list of (keys . code); KEY and OTHERWISE are codes, the
latter a function of frame and key."
  (declare (type function key otherwise))
  (code (frame)
    (let ((key (run key frame)))
      (if (symbolic-value-p key)
          (loop for (keys . body) in clauses
                when (symbolic-member-p key keys site)
                  return (run body frame)
                finally (return (funcall otherwise frame key)))
          (loop for (keys . body) in clauses
                when (loop for candidate in keys thereis (eql key candidate))
                  return (run body frame)
                finally (return (funcall otherwise frame key)))))))

(defun symbolic-member-p (key keys site)
  "Return true if the symbolic KEY is one of KEYS, decided one by one."
  (loop for candidate in keys
          thereis (truth (funcall (the function (or (lifted-function 'eql) #'eql)) key candidate)
                         (site-description site))))

(defun case-clauses (clauses scope)
  (loop for clause in clauses
        collect (cons (clause-keys clause) (analyze-body (rest clause) scope))))

(define-analyzer case (form scope)
  (destructuring-bind (key . clauses) (rest form)
    (let* ((last (first (last clauses)))
           (otherwise (and last (otherwise-clause-p last) last))
           (default (analyze-body (rest otherwise) scope)))
      (declare (type function default))
      (case-code (analyze key scope)
                 (case-clauses (remove otherwise clauses) scope)
                 (lambda (frame key) (declare (ignore key)) (run default frame))
                 (make-site form)))))

(define-analyzer ecase (form scope)
  (destructuring-bind (key . clauses) (rest form)
    (let* ((clauses (case-clauses clauses scope))
           (keys (loop for (keys) in clauses append keys)))
      (case-code (analyze key scope) clauses
                 (lambda (frame key)
                   (declare (ignore frame))
                   (sb-kernel::ecase-failure key keys))
                 (make-site form)))))

;;; TYPEP with a constant type, as TYPECASE and CHECK-TYPE use it

(define-analyzer typep (form scope)
  (if (typep form '(cons t (cons t (cons (cons (eql quote) (cons t null)) null))))
      (let ((callee (find-callee 'typep))
            (site (make-site form))
            (value (analyze (second form) scope))
            (type (second (third form)))
            (parsed nil))
        (declare (type function value))
        (code (frame)
          (let ((value (run value frame)))
            (if (symbolic-run-p)
                (call-callee callee site value type)
                (sb-kernel:%%typep value (or parsed (setf parsed (parsed-type type))))))))
      (global-call-code (find-callee 'typep) (make-site form) (analyze-all (rest form) scope))))

(defun parsed-type (type)
  (sb-kernel:specifier-type type))
