;;;; Lexical scopes of the evaluator, at the time when a form is made into a closure.
;;;;
;;;; At run time lexical variables and local functions live in FRAMES, simple vectors linked through
;;;; their element 0.  A LAYOUT describes one frame; it may grow until the forms inside have been
;;;; analyzed.  A PLACE is a layout and an index in it; in a scope its address is the number of
;;;; frames to go up and that index.  What macros want to know of a scope is an environment object
;;;; of SBCL's, which is made when one asks for it.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (layout (:copier nil))
  "The number of elements of a frame; element 0 is the outer frame."
  (size 1 :type fixnum))

(defun add-element (layout)
  "Add an element to LAYOUT and return its index."
  (1- (incf (layout-size layout))))

(defstruct (place (:constructor make-place (layout index)) (:copier nil))
  "Where a variable, a local function or the tag of a block is at run time."
  (layout nil :type layout :read-only t)
  (index 0 :type fixnum :read-only t))

(defstruct (context (:copier nil))
  "A function around a form: LAYOUT is that of its arguments, CAPTURED an alist from the exits
outside of it that are taken from inside to the places of their tags in that frame."
  (layout nil :type layout :read-only t)
  (captured '() :type list))

(defstruct (scope (:copier nil))
  "LAYOUTS are those of the visible frames, the innermost first.  VARIABLES, FUNCTIONS, BLOCKS and
TAGS are alists from name to place (or :SPECIAL, :SYMBOL-MACRO, :MACRO) or exit.  CONTEXT is the
innermost function.  AUGMENTATION is what the environment has more than that of OUTER."
  (layouts '() :type list :read-only t)
  (variables '() :type list :read-only t)
  (functions '() :type list :read-only t)
  (blocks '() :type list :read-only t)
  (tags '() :type list :read-only t)
  (context nil :type (or null context) :read-only t)
  (outer nil :type (or null scope) :read-only t)
  (augmentation '() :type list :read-only t)
  (known-environment :none))

(defun scope-environment (scope)
  "Return the environment object of SCOPE, for macros."
  (with-accessors ((known scope-known-environment) (outer scope-outer)
                   (augmentation scope-augmentation))
      scope
    (when (eq known :none)
      (let ((environment (and outer (scope-environment outer))))
        (setf known (if augmentation
                        (apply #'sb-cltl2:augment-environment environment augmentation)
                        environment))))
    known))

(defun extend-scope (scope &key layout variables functions blocks tags augmentation
                             (context (scope-context scope)))
  "Return SCOPE with more in it; LAYOUT is that of a new frame."
  (make-scope :layouts (if layout (cons layout (scope-layouts scope)) (scope-layouts scope))
              :variables (append variables (scope-variables scope))
              :functions (append functions (scope-functions scope))
              :blocks (append blocks (scope-blocks scope))
              :tags (append tags (scope-tags scope))
              :context context :outer scope :augmentation augmentation))

;;; Names

(defun global-variable-kind (symbol)
  (let ((kind (sb-int:info :variable :kind symbol)))
    (case kind
      (:macro :symbol-macro)
      (t kind))))

(defun globally-special-p (symbol)
  (member (global-variable-kind symbol) '(:special :always-bound :global)))

(defun variable-meaning (symbol scope)
  "Return the place of SYMBOL in SCOPE, or :SPECIAL, :SYMBOL-MACRO, :CONSTANT or :UNKNOWN."
  (let ((entry (assoc symbol (scope-variables scope) :test #'eq)))
    (if entry (cdr entry) (global-variable-kind symbol))))

(defun function-meaning (name scope)
  "Return the place of the local function NAME in SCOPE, :MACRO for a local macro, or NIL."
  (cdr (assoc name (scope-functions scope) :test #'equal)))

(defun scope-with-variable (scope name)
  "Return SCOPE with a lexical variable NAME more in its innermost frame, and the index."
  (let* ((layout (first (scope-layouts scope)))
         (index (add-element layout)))
    (values (extend-scope scope :variables (acons name (make-place layout index) '())
                                :augmentation (list :variable (list name)))
            index)))

(defun scope-with-specials (scope names)
  "Return SCOPE in which the variables NAMES are special."
  (if names
      (extend-scope scope
                    :variables (loop for name in names collect (cons name :special))
                    ;; SBCL does not like to be told of what is special anyway.
                    :augmentation (let ((news (remove-if #'globally-special-p names)))
                                    (and news `(:declare ((special ,@news))))))
      scope))

;;; Frames

(deftype frame () 'simple-vector)

(defmacro code ((frame) &body body)
  "A function of FRAME that evaluates BODY: what a form is made into."
  `(lambda (,frame) (declare (type frame ,frame) (ignorable ,frame)) ,@body))

(defmacro run (code frame)
  "Evaluate CODE in FRAME."
  `(funcall (the function ,code) ,frame))

(declaim (inline frame-up))
(defun frame-up (frame depth)
  (declare (type frame frame) (type fixnum depth))
  (loop repeat depth do (setf frame (the frame (svref frame 0))))
  frame)

(defun frame-reader (place scope)
  "Return the code that reads PLACE."
  (let ((depth (position (place-layout place) (scope-layouts scope)))
        (index (place-index place)))
    (declare (type fixnum depth index))
    (macrolet ((up (count)
                 (let ((form 'frame))
                   (loop repeat count do (setf form `(the frame (svref ,form 0))))
                   form)))
      (case depth
        (0 (case index
             (1 (code (frame) (svref frame 1)))
             (2 (code (frame) (svref frame 2)))
             (t (code (frame) (svref frame index)))))
        (1 (case index
             (1 (code (frame) (svref (up 1) 1)))
             (2 (code (frame) (svref (up 1) 2)))
             (t (code (frame) (svref (up 1) index)))))
        (2 (code (frame) (svref (up 2) index)))
        (3 (code (frame) (svref (up 3) index)))
        (t (code (frame) (svref (frame-up frame depth) index)))))))

(defun frame-writer (place scope value)
  "Return the code that stores the value of the code VALUE in PLACE and returns it."
  (declare (type function value))
  (let ((depth (position (place-layout place) (scope-layouts scope)))
        (index (place-index place)))
    (declare (type fixnum depth index))
    (case depth
      (0 (code (frame) (values (setf (svref frame index) (run value frame)))))
      (1 (code (frame)
           (values (setf (svref (the frame (svref frame 0)) index) (run value frame)))))
      (t (code (frame)
           (values (setf (svref (frame-up frame depth) index) (run value frame))))))))

(defun analyze-in-frame (scope analyzer)
  "Return the code that makes a frame and then runs the code that ANALYZER, a function of the inner
scope and layout, returns."
  (let* ((layout (make-layout))
         (inner (funcall analyzer (extend-scope scope :layout layout)))
         (size (layout-size layout)))
    (declare (type function inner) (type fixnum size))
    (code (frame)
      (let ((new (make-array size :initial-element nil)))
        (setf (svref new 0) frame)
        (run inner new)))))
