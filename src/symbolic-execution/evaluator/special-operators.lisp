;;;; The special operators that neither bind variables nor jump, and SBCL's own.

(in-package #:discrepancy-finder.symbolic-execution)

(define-analyzer quote (form scope)
  (constant-code (second form)))

(define-analyzer progn (form scope)
  (analyze-body (rest form) scope))

(define-analyzer if (form scope)
  (unless (<= 3 (length form) 4)
    (unsupported form "IF has two or three arguments"))
  (destructuring-bind (test then &optional else) (rest form)
    (let ((site (make-site form))
          (test (analyze test scope))
          (then (analyze-form then scope))
          (else (analyze-form else scope)))
      (declare (type function test then else))
      (multiple-value-setq (then else) (noting-branches then else))
      (code (frame)
        (let ((value (run test frame)))
          (if (if (symbolic-value-p value) (truth value (site-description site)) value)
              (run then frame)
              (run else frame)))))))

(define-analyzer eval-when (form scope)
  (if (intersection (second form) '(:execute eval))
      (analyze-body (cddr form) scope)
      (constant-code nil)))

(define-analyzer sb-cltl2:compiler-let (form scope)
  (let ((*path* nil) (bindings (mapcar #'alexandria:ensure-list (second form))))
    (progv (mapcar #'first bindings)
        (loop for (nil value) in bindings collect (values (evaluate-form value)))
      (analyze-body (cddr form) scope))))

(define-analyzer load-time-value (form scope)
  (constant-code (let ((*path* nil)) (values (evaluate-form (second form))))))

;;; Types.  What is declared is checked where SBCL checks it, at THE.

(defun analyze-the (type value site scope)
  (let ((code (analyze-form value scope))
        (checked (checked-type type)))
    (if (eq checked t)
        code
        (checking-code code checked site))))

(define-analyzer the (form scope)
  (destructuring-bind (type value) (rest form)
    (analyze-the type value (make-site form) scope)))

;; What setters of typed slots expand into.
(define-analyzer sb-kernel:the* (form scope)
  (destructuring-bind ((type &key derive-type-only truly &allow-other-keys) value) (rest form)
    (if (or derive-type-only truly)
        (analyze-form value scope)
        (analyze-the type value (make-site form) scope))))

(defun checked-type (type)
  "Return the type, of the first value, that THE with TYPE checks."
  (let ((type (if (and (consp type) (eq (first type) 'values))
                  (if (member (second type) '(&optional &rest)) t (second type))
                  (sb-ext:typexpand type))))
    (cond ((and (consp type) (eq (first type) 'function)) 'function)
          ((and (consp type) (eq (first type) 'values)) (checked-type type))
          (t (or type t)))))

(defun checking-code (code type site)
  "Return CODE with a check that the first of its values is of TYPE; a jump is none."
  (declare (type function code))
  (let ((parsed (sb-kernel:specifier-type type)))
    (flet ((check (value)
             (unless (cond ((jump-p value))
                           ((symbolic-value-p value)
                            (truth (lifted-typep value type) (site-description site)))
                           (t (sb-kernel:%%typep value parsed)))
               (error 'type-error :datum value :expected-type type))))
      (code (frame)
        (multiple-value-call (lambda (&rest values)
                               (declare (dynamic-extent values))
                               (check (first values))
                               (values-list values))
          (run code frame))))))

(define-analyzer (sb-ext:truly-the sb-c::with-source-form) (form scope)
  (analyze-body (cddr form) scope))

;;; Functions

(define-analyzer (function sb-c::global-function) (form scope)
  (let ((name (second form)))
    (typecase name
      ((cons (eql lambda)) (analyze-lambda nil (second name) (cddr name) scope))
      ((cons (eql sb-int:named-lambda))
       (analyze-lambda (second name) (third name) (cdddr name) scope))
      (t (let ((meaning (function-meaning name scope)))
           (cond ((place-p meaning) (frame-reader meaning scope))
                 ((typep name '(or symbol (cons (eql setf) (cons symbol null))))
                  (let ((callee (find-callee name)))
                    (code (frame) (function-as-value callee))))
                 (t (unsupported form "it is not the name of a function"))))))))

(define-analyzer sb-int:named-lambda (form scope)
  (analyze-lambda (second form) (third form) (cdddr form) scope))

(defun function-as-value (callee)
  "Return the function of CALLEE for use as a value: Common Lisp's own, since compiled code may ask
which it is.  Who calls it in a plan asks CODE-OF for the version that knows symbolic values."
  (global-function (callee-name callee)))

(defun analyze-local-functions (form scope recursive)
  (let ((definitions (second form)))
    (multiple-value-bind (forms specials) (split-body (cddr form) scope)
      (let* ((names (mapcar #'first definitions))
             (layout (make-layout :size (1+ (length names))))
             (inner (extend-scope
                     scope :layout layout
                     :functions (loop for name in names for index from 1
                                      collect (cons name (make-place layout index)))
                     :augmentation (and names (list :function names))))
             (makers (loop for (name lambda-list . body) in definitions
                           collect (local-function-maker name lambda-list body
                                                         (if recursive inner scope))))
             (inside (analyze-body forms (scope-with-specials inner specials)))
             (size (layout-size layout)))
        (declare (type function inside) (type fixnum size))
        (code (frame)
          (let ((new (make-array size :initial-element nil)))
            (setf (svref new 0) frame)
            (loop for maker in makers for index fixnum from 1
                  do (setf (svref new index) (run maker (if recursive new frame))))
            (run inside new)))))))

(defun local-function-maker (name lambda-list body scope)
  (multiple-value-bind (forms declarations) (alexandria:parse-body body :documentation t)
    (analyze-lambda name lambda-list
                    `(,@declarations
                      (block ,(if (consp name) (second name) name) ,@forms))
                    scope)))

(define-analyzer flet (form scope)
  (analyze-local-functions form scope nil))

(define-analyzer labels (form scope)
  (analyze-local-functions form scope t))

;;; Control

(define-analyzer catch (form scope)
  (let ((tag (analyze (second form) scope)) (inside (analyze-body (cddr form) scope)))
    (declare (type function tag inside))
    (code (frame) (catch (settled (run tag frame) "a catch tag") (run inside frame)))))

(define-analyzer throw (form scope)
  (let ((tag (analyze (second form) scope)) (value (analyze (third form) scope)))
    (declare (type function tag value))
    (code (frame) (throw (settled (run tag frame) "a catch tag") (run value frame)))))

(define-analyzer unwind-protect (form scope)
  (let ((protected (analyze-form (second form) scope))
        (cleanup (analyze `(progn ,@(cddr form)) scope)))
    (declare (type function protected cleanup))
    (code (frame)
      (unwind-protect (run protected frame)
        ;; The plan does not notice that its path is abandoned.
        (unless (and *path* (path-ending *path*))
          (run cleanup frame))))))

;;; Multiple values

(define-analyzer multiple-value-prog1 (form scope)
  (let ((first (analyze (second form) scope))
        (rest (analyze `(progn ,@(cddr form)) scope)))
    (declare (type function first rest))
    (code (frame) (multiple-value-prog1 (run first frame) (run rest frame)))))
