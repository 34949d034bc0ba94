;;;; Lambda expressions: interpreted functions with full lambda lists.
;;;;
;;;; A function with a few required parameters has the code of just so many arguments, which become
;;;; its frame.  Any other one gets a list of its arguments, from which each of its parameters takes
;;;; what is its own, in order.

(in-package #:discrepancy-finder.symbolic-execution)

(defun analyze-lambda (name lambda-list body scope)
  "Return the code that makes the interpreted function with LAMBDA-LIST and BODY.  It prints as
NAME, unless that is NIL."
  (multiple-value-bind (forms declarations documentation)
      (alexandria:parse-body body :documentation t)
    (let ((specials (declared-specials declarations))
          (*exits* '()) (*tails* '()) (*jumps* 0))
      (multiple-value-bind (required optional rest keys allow-other-keys aux keyp)
          (handler-case (alexandria:parse-ordinary-lambda-list lambda-list)
            (error (condition)
              (error 'sb-int:simple-program-error
                     :format-control "Malformed lambda list ~s: ~a"
                     :format-arguments (list lambda-list condition))))
        (naming-code
         (if (or optional rest keyp aux
                 (notevery #'symbolp required)
                 (some (lambda (name) (special-p name specials)) required)
                 (/= (length required) (length (remove-duplicates required))))
             (analyze-general-lambda forms specials scope
                                     (make-parameters required optional rest keys
                                                      allow-other-keys keyp aux))
             (analyze-simple-lambda required forms specials scope))
         name documentation)))))

(defun naming-code (maker name documentation)
  "Return the code MAKER, which makes a function, such that this gets NAME and DOCUMENTATION."
  (declare (type function maker))
  (if (or name documentation)
      (code (frame) (named-function (run maker frame) name documentation))
      maker))

(defun function-code (scope context maker run)
  "Return the code that makes a function: MAKER makes it of a frame and RUN, the code of its body,
which is of CONTEXT.  One that was made before a run of a plan and closes over variables remembers
their values there."
  (declare (type function maker run))
  (let* ((captured (context-captured context))
         (readers (loop for (exit) in captured collect (tag-reader exit scope)))
         (indices (loop for (nil . place) in captured collect (place-index place)))
         (remembering (code (frame)
                        (when *path* (note-frames (svref frame 0)))
                        (run run frame)))
         (closed (and (scope-layouts scope) t)))
    (if captured
        (code (frame)
          (make-interpreted-function
           (funcall maker frame (code-with-tags (if (or *path* (not closed)) run remembering)
                                                indices (evaluate-arguments readers frame)))))
        (code (frame)
          (make-interpreted-function
           (funcall maker frame (if (or *path* (not closed)) run remembering)))))))

(defun code-with-tags (run indices tags)
  "Return the code that stores TAGS at INDICES of its frame and then does what RUN does."
  (declare (type function run))
  (code (frame)
    (loop for tag in tags for index fixnum in indices
          do (setf (svref frame index) tag))
    (run run frame)))

(defvar *noted-frames* (make-hash-table :test 'eq :weakness :key :synchronized t)
  "The path on which the values in a frame were last noted.")

(defun note-frames (frame)
  "Note what is in FRAME and those around it, which are older than the path, to be restored."
  (loop while frame
        do (unless (eq (gethash frame *noted-frames*) *path*)
             (setf (gethash frame *noted-frames*) *path*)
             (let ((frame frame) (contents (copy-seq (the frame frame))))
               (note-undo (lambda () (replace (the frame frame) contents)))))
           (setf frame (svref (the frame frame) 0))))

(defun analyze-simple-lambda (required forms specials scope)
  (multiple-value-bind (inner layout) (scope-with-frame scope required)
    (let* ((context (make-context :layout layout))
           (inner (extend-scope inner :context context))
           (run (analyze-body forms (scope-with-specials inner specials)))
           (size (layout-size layout)))
      (declare (type function run) (type fixnum size))
      (function-code
       scope context
       (if (= size (1+ (length required)))
           (case (length required)
             (0 (lambda (frame run)
                  (declare (type function run))
                  (lambda () (run run (vector frame)))))
             (1 (lambda (frame run)
                  (declare (type function run))
                  (lambda (a) (run run (vector frame a)))))
             (2 (lambda (frame run)
                  (declare (type function run))
                  (lambda (a b) (run run (vector frame a b)))))
             (3 (lambda (frame run)
                  (declare (type function run))
                  (lambda (a b c) (run run (vector frame a b c)))))
             (t (list-taker size (length required))))
           (list-taker size (length required)))
       run))))

(defun list-taker (size count)
  "Return a function that makes a function of COUNT arguments with a frame of SIZE."
  (declare (type fixnum size count))
  (lambda (frame run)
    (declare (type function run))
    (lambda (&rest arguments)
      (declare (dynamic-extent arguments))
      (let ((new (make-array size :initial-element nil)))
        (setf (svref new 0) frame)
        (unless (= (length arguments) count)
          (wrong-argument-count (length arguments)))
        (loop for argument in arguments for index fixnum from 1
              do (setf (svref new index) argument))
        (run run new)))))

(defun wrong-argument-count (count)
  (error 'sb-int:simple-program-error :format-control "invalid number of arguments: ~s"
                                      :format-arguments (list count)))

;;; Other lambda lists.  Element 1 of the frame is the list of the arguments not taken yet, element
;;; 2 says whether the last parameter was given.

(defstruct (parameters (:constructor make-parameters
                           (required optional rest keys allow-other-keys keyp aux))
                       (:copier nil))
  "The parts of an ordinary lambda list, as ALEXANDRIA:PARSE-ORDINARY-LAMBDA-LIST returns them."
  required optional rest keys allow-other-keys keyp aux)

(defun analyze-general-lambda (forms specials scope parameters)
  (let* ((layout (make-layout :size 3))
         (context (make-context :layout layout))
         (inner (extend-scope scope :layout layout :context context))
         (run (bind-in-order (parameter-bindings parameters) inner specials
                             (lambda (scope)
                               (analyze-body forms (scope-with-specials scope specials)))))
         (size (layout-size layout))
         (minimum (length (parameters-required parameters)))
         (maximum (and (not (parameters-rest parameters)) (not (parameters-keyp parameters))
                       (+ minimum (length (parameters-optional parameters))))))
    (declare (type function run) (type fixnum size minimum))
    (function-code
     scope context
     (lambda (frame run)
       (declare (type function run))
       (lambda (&rest arguments)
         (let ((count (length arguments))
               (new (make-array size :initial-element nil)))
           (when (or (< count minimum) (and maximum (> count (the fixnum maximum))))
             (wrong-argument-count count))
           (setf (svref new 0) frame
                 (svref new 1) arguments)
           (run run new))))
     run)))

(defun parameter-bindings (parameters)
  "Return the bindings of PARAMETERS, as BIND-IN-ORDER wants them."
  (append (loop for name in (parameters-required parameters)
                collect (cons name (constantly (code (frame) (pop (svref frame 1))))))
          (loop for (name default suppliedp) in (parameters-optional parameters)
                append (parameter-binding name default suppliedp #'take-optional))
          (and (parameters-rest parameters)
               (list (cons (parameters-rest parameters)
                           (constantly (code (frame) (svref frame 1))))))
          (and (parameters-keyp parameters)
               (list (cons (gensym "KEYS") (constantly (keyword-check parameters)))))
          (loop for ((keyword name) default suppliedp) in (parameters-keys parameters)
                append (parameter-binding name default suppliedp (keyword-taker keyword)))
          (loop for (name form) in (parameters-aux parameters)
                collect (let ((form form))
                          (cons name (lambda (scope) (analyze form scope)))))))

(defun parameter-binding (name default suppliedp taker)
  "Return the bindings of NAME and of SUPPLIEDP, unless that is NIL.  TAKER is a function of a frame
that returns the argument and whether it was given."
  (declare (type function taker))
  (cons (cons name
              (lambda (scope)
                (let ((default (analyze default scope)))
                  (declare (type function default))
                  (code (frame)
                    (multiple-value-bind (value given) (funcall taker frame)
                      (let ((value (if given value (run default frame))))
                        (setf (svref frame 2) given)
                        value))))))
        (and suppliedp
             (list (cons suppliedp (constantly (code (frame) (svref frame 2))))))))

(defun take-optional (frame)
  (declare (type frame frame))
  (let ((arguments (svref frame 1)))
    (if arguments
        (progn (setf (svref frame 1) (rest arguments))
               (values (first arguments) t))
        (values nil nil))))

(defun keyword-taker (keyword)
  (lambda (frame)
    (declare (type frame frame))
    (loop for (key value) on (svref frame 1) by #'cddr
          when (eq key keyword)
            return (values value t))))

(defun keyword-check (parameters)
  "Return the code that signals a PROGRAM-ERROR if the arguments left are no keyword arguments of
PARAMETERS."
  (let ((known (mapcar #'caar (parameters-keys parameters)))
        (allow-other-keys (parameters-allow-other-keys parameters)))
    (code (frame)
      (let ((arguments (svref frame 1)))
        (unless (evenp (length arguments))
          (error 'sb-int:simple-program-error :format-control "odd number of &KEY arguments"))
        (unless (or allow-other-keys (getf arguments :allow-other-keys))
          (loop for (key) on arguments by #'cddr
                unless (or (member key known) (eq key :allow-other-keys))
                  do (error 'sb-int:simple-program-error
                            :format-control "unknown &KEY argument: ~s"
                            :format-arguments (list key))))
        nil))))

;;; Plans

(defvar *interpreted-plans* (make-hash-table :test 'eq :weakness :key :synchronized t)
  "The interpreted function of each PLAN that was called.")

(defun interpreted-plan (plan)
  "Return the interpreted function of PLAN."
  (let ((plans (if *recorder* (recorder-plans *recorder*) *interpreted-plans*)))
    (or (gethash plan plans)
        (setf (gethash plan plans)
              (run (local-function-maker (plan:plan-name plan) (plan:plan-lambda-list plan)
                                         (plan:plan-body plan) (make-scope))
                   (vector nil))))))
