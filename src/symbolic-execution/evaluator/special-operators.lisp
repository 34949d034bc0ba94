;;;; The special operators that plans and the expansions of plan forms use.

(in-package #:discrepancy-finder.symbolic-execution)

(define-analyzer quote (form scope)
  (constant-closure (second form)))

(define-analyzer progn (form scope)
  (analyze-body (rest form) scope))

(define-analyzer if (form scope)
  (destructuring-bind (test then &optional else) (rest form)
    (let ((description (describe-form form))
          (test (analyze test scope)) (then (analyze then scope)) (else (analyze else scope)))
      (lambda (frame)
        (let ((value (funcall (the function test) frame)))
          (if (if (symbolic-value-p value) (truth value description) value)
              (funcall (the function then) frame)
              (funcall (the function else) frame)))))))

(define-analyzer the (form scope)
  (analyze (third form) scope))

(define-analyzer sb-ext:truly-the (form scope)
  (analyze (third form) scope))

(define-analyzer sb-kernel:the* (form scope)
  (analyze (third form) scope))

(define-analyzer sb-c::with-source-form (form scope)
  (analyze-body (cddr form) scope))

(define-analyzer eval-when (form scope)
  (if (intersection (second form) '(:execute eval))
      (analyze-body (cddr form) scope)
      (constant-closure nil)))

(define-analyzer load-time-value (form scope)
  (constant-closure (funcall (analyze (second form) (make-scope)) (vector nil))))

;;; Variables

(defun binding-parts (binding)
  (if (consp binding) (values (first binding) (second binding)) (values binding nil)))

(define-analyzer let (form scope)
  (multiple-value-bind (forms declarations) (alexandria:parse-body (cddr form))
    (call-with-bindings
     scope declarations
     (mapcar (lambda (binding) (values (binding-parts binding))) (second form))
     (mapcar (lambda (binding) (analyze (nth-value 1 (binding-parts binding)) scope))
             (second form))
     (lambda (inner) (analyze-body forms inner)))))

(define-analyzer let* (form scope)
  (multiple-value-bind (forms declarations) (alexandria:parse-body (cddr form))
    (labels ((bind (bindings scope)
               (if bindings
                   (multiple-value-bind (name init) (binding-parts (first bindings))
                     (call-with-bindings scope declarations (list name)
                                         (list (analyze init scope))
                                         (lambda (inner) (bind (rest bindings) inner))))
                   (analyze-body forms (extend-scope scope '() :declare (declaration-specifiers
                                                                         declarations))))))
      (bind (second form) scope))))

(define-analyzer setq (form scope)
  (let ((assignments
          (loop for (name value) on (rest form) by #'cddr
                collect (if (eq (variable-kind name scope) :symbol-macro)
                            (analyze `(setf ,name ,value) scope)
                            (analyze-assignment name (analyze value scope) scope)))))
    (lambda (frame)
      (let ((value nil))
        (dolist (assignment assignments value)
          (setf value (funcall (the function assignment) frame)))))))

(defun analyze-assignment (name value scope)
  (if (eq (variable-kind name scope) :lexical)
      (let ((writer (multiple-value-call #'frame-writer (variable-address name scope))))
        (lambda (frame) (funcall writer frame (funcall (the function value) frame))))
      (lambda (frame)
        (let ((new (decided (funcall (the function value) frame) "a special variable")))
          (note-write name)
          (setf (symbol-value name) new)))))

(define-analyzer locally (form scope)
  (multiple-value-bind (forms declarations) (alexandria:parse-body (rest form))
    (analyze-body forms (extend-scope scope '() :declare (declaration-specifiers declarations)))))

(define-analyzer symbol-macrolet (form scope)
  (multiple-value-bind (forms declarations) (alexandria:parse-body (cddr form))
    (analyze-body forms (extend-scope scope '() :symbol-macro (second form)
                                                :declare (declaration-specifiers declarations)))))

(define-analyzer macrolet (form scope)
  (analyze-body
   (alexandria:parse-body (cddr form))
   (extend-scope scope '()
                 :macro (loop for (name lambda-list . body) in (second form)
                              collect (list name
                                            (sb-cltl2:enclose
                                             (sb-cltl2:parse-macro name lambda-list body
                                                                   (scope-environment scope))
                                             (scope-environment scope)))))))

;;; Functions

(define-analyzer function (form scope)
  (let ((name (second form)))
    (cond ((and (consp name) (eq (first name) 'lambda))
           (analyze-lambda nil (second name) (cddr name) scope))
          ((and (consp name) (eq (first name) 'sb-int:named-lambda))
           (analyze-lambda (second name) (third name) (cdddr name) scope))
          ((if (symbolp name)
               (eq (local-kind name scope) :function)
               (function-address name scope))
           (multiple-value-call #'frame-reader (function-address name scope)))
          (t (lambda (frame) (declare (ignore frame)) (global-function name))))))

(defun local-function-makers (definitions scope)
  (loop for (name lambda-list . body) in definitions
        collect (multiple-value-bind (forms declarations) (alexandria:parse-body body
                                                                                 :documentation t)
                  (analyze-lambda name lambda-list
                                  `(,@declarations (block ,(if (consp name) (second name) name)
                                                     ,@forms))
                                  scope))))

(defun analyze-local-functions (form scope recursive)
  (let* ((names (mapcar #'first (second form)))
         (inner (extend-scope scope (mapcar (lambda (name) (list :function name)) names)
                              :function names))
         (makers (local-function-makers (second form) (if recursive inner scope)))
         (run (analyze-body (alexandria:parse-body (cddr form)) inner))
         (size (1+ (length names))))
    (lambda (frame)
      (let ((new (make-array size)))
        (setf (svref new 0) frame)
        (loop for maker in makers for index from 1
              do (setf (svref new index) (funcall maker (if recursive new frame))))
        (funcall run new)))))

(define-analyzer flet (form scope)
  (analyze-local-functions form scope nil))

(define-analyzer labels (form scope)
  (analyze-local-functions form scope t))

;;; Control.  A block or tagbody that is entered puts a fresh object into its frame; leaving it is a
;;; throw to that object.

(define-analyzer block (form scope)
  (destructuring-bind (name . body) (rest form)
    (let ((run (analyze-body body (extend-scope scope (list (list :block name))))))
      (lambda (frame)
        (let ((tag (list name)))
          (catch tag (funcall (the function run) (vector frame tag))))))))

(define-analyzer return-from (form scope)
  (destructuring-bind (name &optional value) (rest form)
    (multiple-value-bind (depth index)
        (find-address scope (lambda (key)
                              (and (consp key) (eq (first key) :block) (eq (second key) name))))
      (unless depth (unsupported form "there is no such block around it"))
      (let ((tag (frame-reader depth index)) (value (analyze value scope)))
        (lambda (frame) (throw (funcall tag frame) (funcall (the function value) frame)))))))

(define-analyzer tagbody (form scope)
  (let* ((tags (remove-if #'consp (rest form)))
         (inner (extend-scope scope (list (list* :tags tags))))
         (segments (let ((segments (list '())))
                     (dolist (part (rest form)
                                   (mapcar (lambda (forms) (analyze-body (reverse forms) inner))
                                           (nreverse segments)))
                       (if (consp part)
                           (push part (first segments))
                           (push '() segments))))))
    (lambda (frame)
      (let* ((id (list :tagbody))
             (new (vector frame id))
             (next 0))
        (loop while next
              do (setf next (catch id
                              (dolist (segment (nthcdr next segments) nil)
                                (funcall (the function segment) new)))))
        nil))))

(define-analyzer go (form scope)
  (let ((tag (second form)))
    (flet ((tags-p (key) (and (consp key) (eq (first key) :tags) (member tag (rest key)))))
      (multiple-value-bind (depth index) (find-address scope #'tags-p)
        (unless depth (unsupported form "there is no such tag around it"))
        (let* ((reader (frame-reader depth index))
               (key (find-if #'tags-p (nth depth (scope-frames scope))))
               (segment (1+ (position tag (rest key)))))
          (lambda (frame)
            (when *path* (count-jump *path*))
            (throw (funcall reader frame) segment)))))))

(define-analyzer catch (form scope)
  (let ((tag (analyze (second form) scope)) (run (analyze-body (cddr form) scope)))
    (lambda (frame) (catch (funcall tag frame) (funcall run frame)))))

(define-analyzer throw (form scope)
  (let ((tag (analyze (second form) scope)) (value (analyze (third form) scope)))
    (lambda (frame) (throw (funcall tag frame) (funcall value frame)))))

(define-analyzer unwind-protect (form scope)
  (let ((protected (analyze (second form) scope)) (cleanup (analyze-body (cddr form) scope)))
    (lambda (frame)
      (unwind-protect (funcall protected frame)
        ;; The plan does not notice that its path is abandoned.
        (unless (and *path* (path-ending *path*))
          (funcall cleanup frame))))))

(define-analyzer progv (form scope)
  (let ((names (analyze (second form) scope)) (values (analyze (third form) scope))
        (run (analyze-body (cdddr form) scope)))
    (lambda (frame)
      (let ((names (funcall names frame)))
        (with-forgotten-writes (names)
          (progv names (decided (funcall values frame) "a special variable")
            (funcall run frame)))))))

;;; Multiple values

(define-analyzer multiple-value-prog1 (form scope)
  (let ((first (analyze (second form) scope)) (rest (analyze-body (cddr form) scope)))
    (lambda (frame) (multiple-value-prog1 (funcall first frame) (funcall rest frame)))))

(define-analyzer multiple-value-call (form scope)
  (let ((function (analyze (second form) scope))
        (arguments (analyze-arguments (cddr form) scope))
        (description (describe-form form)))
    (lambda (frame)
      (let ((function (funcall function frame)))
        (call-function (if (symbolp function) (global-function function) function)
                       (loop for argument in arguments
                             append (multiple-value-list (funcall argument frame)))
                       description)))))
