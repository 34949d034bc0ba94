;;;; Deciding what is inside of objects: no compiled code may find a symbolic value.
;;;;
;;;; DECIDED walks everything that can be reached from a value through conses, arrays, hash tables,
;;;; structures and instances, each object once, and puts what was decided in the place of each
;;;; symbolic value: objects stay the same.  That need not be undone after the run: who has put a
;;;; symbolic value into an older object has noted how to undo that.  Objects of the Lisp system and
;;;; of this one are not entered, since nobody can put a symbolic value there.

(in-package #:discrepancy-finder.symbolic-execution)

(defmacro note-place (place)
  "Note that PLACE, a call of a reader whose arguments are evaluated once, must have its present
value after the run."
  (let ((old (gensym "OLD"))
        (arguments (loop for nil in (rest place) collect (gensym "ARGUMENT"))))
    `(when *path*
       (let* (,@(mapcar #'list arguments (rest place))
              (,old (,(first place) ,@arguments)))
         (note-undo (lambda () (setf (,(first place) ,@arguments) ,old)))))))

(defun decided (value description)
  "Return VALUE, with every symbolic value that can be reached from it decided."
  (cond ((not (symbolic-run-p)) value)
        ((symbolic-value-p value) (decided-inside (settled value description) description))
        (t (decided-inside value description))))

(defgeneric entered-class-p (class)
  (:documentation "Return true if instances of CLASS may hold symbolic values.")
  (:method ((class class))
    (let ((package (and (class-name class) (symbol-package (class-name class)))))
      (or (subtypep class 'condition)
          (not (and package (system-package-p package)))))))

(defun system-package-p (package)
  "Return true if PACKAGE belongs to Lisp itself or to this system; instances of classes named in
those are not entered, but for designators."
  (let ((name (package-name package)))
    (and (or (sb-ext:package-locked-p package)
             (uiop:string-prefix-p "SB-" name)
             (uiop:string-prefix-p "DISCREPANCY-FINDER." name)
             (uiop:string-prefix-p "BORDEAUX-THREADS" name))
         (not (member name '("DISCREPANCY-FINDER.DESIGNATORS" "DISCREPANCY-FINDER.GEOMETRY"
                             "DISCREPANCY-FINDER.TESTS")
                      :test #'string=)))))

(defvar *entered-classes* (make-hash-table :test 'eq :weakness :key :synchronized t)
  "Whether instances of a class are entered.")

(defun entered-instance-p (object)
  (let ((class (class-of object)))
    (multiple-value-bind (entered known) (gethash class *entered-classes*)
      (if known
          entered
          (setf (gethash class *entered-classes*) (and (entered-class-p class) t))))))

(declaim (inline compound-p))
(defun compound-p (object)
  "Return true if OBJECT can hold others."
  (typecase object
    ((or null symbol number character string function) nil)
    (cons t)
    (array (eq (array-element-type object) t))
    (hash-table t)
    ((or structure-object standard-object condition) (entered-instance-p object))
    (t nil)))

(defun decided-inside (root description)
  "Return ROOT, which is not symbolic, with what is inside of it decided."
  (when (compound-p root)
    (let ((seen (make-hash-table :test 'eq)) (pending (list root)))
      (flet ((look (value)
               (let ((value (settled value description)))
                 (when (and (compound-p value) (not (gethash value seen)))
                   (setf (gethash value seen) t)
                   (push value pending))
                 value)))
        (setf (gethash root seen) t)
        (loop while pending
              do (decide-parts (pop pending) #'look)))))
  root)

(defun decide-parts (object look)
  "Put what the function LOOK returns for it in the place of each part of OBJECT."
  (declare (function look))
  (macrolet ((look-at (place)
               `(let* ((old ,place) (new (funcall look old)))
                  (unless (eq old new)
                    (setf ,place new)))))
    (typecase object
      (cons (look-at (cdr object))
            (look-at (car object)))
      (simple-vector
       (loop for index from (1- (length object)) downto 0
             do (let ((index index)) (look-at (svref object index)))))
      (array
       (loop for index from (1- (array-total-size object)) downto 0
             do (let ((index index)) (look-at (row-major-aref object index)))))
      (hash-table
       (dolist (key (loop for key being the hash-keys of object collect key))
         (let ((key key))
           (funcall look key)
           (look-at (gethash key object)))))
      (structure-object
       (dolist (slot (structure-slots (type-of object)))
         (let ((index (sb-kernel:dsd-index slot)))
           (look-at (sb-kernel:%instance-ref object index)))))
      (t
       (dolist (slot (sb-mop:class-slots (class-of object)))
         (let ((name (sb-mop:slot-definition-name slot)))
           (when (slot-boundp object name)
             (look-at (slot-value object name)))))))))

(defun structure-slots (name)
  "Return the slots, as SBCL describes them, of the structure class NAME that hold Lisp objects."
  (remove-if-not (lambda (slot) (eq (sb-kernel:dsd-raw-type slot) t))
                 (sb-kernel:dd-slots (sb-kernel:find-defstruct-description name))))
