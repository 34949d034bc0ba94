;;;; Dynamic bindings and tasks.
;;;;
;;;; In CRAM a task is a thread, so that a task does not see the special variables that the tasks
;;;; above it have bound with LET.  Here most tasks run on the thread of their parent.  CALL-HIDING
;;;; makes the bindings made since a given depth of the binding stack invisible for the time of a
;;;; call: it puts SBCL's marker for "no thread-local value" into their thread-local slots, so that
;;;; the variables read and write their global values (or gives them back the values that they had
;;;; outside of the top-level).  CAPTURED-BINDINGS and CALL-WITH-CAPTURED
;;;; carry what was bound outside of a program's top level over to another thread.
;;;;
;;;; Variables of SBCL's own packages (handlers, restarts, interrupts) are never touched.

(in-package #:discrepancy-finder.plan-language)

(defconstant +entry-size+ (* 2 sb-vm:n-word-bytes)
  "The size of an entry of the binding stack: the old value and the index of the variable's
thread-local slot.")

(declaim (inline thread-slots binding-stack-start binding-depth slot-value-at))

(defun thread-slots ()
  (sb-vm::current-thread-offset-sap sb-vm::thread-this-slot))

(defun binding-stack-start ()
  (sb-vm::current-thread-offset-sap sb-vm::thread-binding-stack-start-slot))

(defun binding-depth ()
  "Return the size (bytes) of the binding stack of this thread."
  (sb-sys:sap- (sb-kernel::binding-stack-pointer-sap) (binding-stack-start)))

(defun slot-value-at (index)
  (sb-sys:sap-ref-lispobj (thread-slots) index))

(declaim (type simple-vector *internal-variables*))
(sb-ext:defglobal *internal-variables* (make-array 4096 :initial-element :unknown)
  "For each index of a thread-local slot, in words, whether its variable is internal to SBCL.")

(defun internal-symbol-p (symbol)
  (let ((package (and symbol (symbol-package symbol))))
    (and package
         (let ((name (package-name package)))
           (and (> (length name) 3) (string= "SB-" name :end2 3))))))

(defun internal-variable-p (index)
  "Return true if the thread-local slot at INDEX (bytes) belongs to a variable of SBCL's own."
  (let* ((word (ash index (- sb-vm:word-shift)))
         (known (svref *internal-variables* word)))
    (if (eq known :unknown)
        (setf (svref *internal-variables* word)
              (internal-symbol-p (sb-impl::find-symbol-from-tls-index index)))
        known)))

(defun map-bindings (function depth)
  "Call FUNCTION with the slot index of each binding of this thread that was made above DEPTH and is
no business of SBCL's."
  (declare (function function) (fixnum depth))
  (let ((start (binding-stack-start)))
    (loop for offset of-type fixnum from depth below (binding-depth) by +entry-size+
          do (let ((index (logand #xffffffff
                                  (sb-sys:sap-ref-word start (+ offset sb-vm:n-word-bytes)))))
               (unless (or (zerop index) (internal-variable-p index))
                 (funcall function index))))))

(defun bound-slots (depth)
  "Return the list of the (index . value) of the variables that were bound above DEPTH and are not
hidden."
  (let ((slots '()))
    (map-bindings (lambda (index)
                    (unless (or (assoc index slots)
                                (= (sb-sys:sap-ref-word (thread-slots) index)
                                   sb-vm:no-tls-value-marker))
                      (push (cons index (slot-value-at index)) slots)))
                  depth)
    slots))

(defun call-hiding (depth outside function)
  "Call FUNCTION without arguments while the bindings that this thread has made above DEPTH are
invisible: their variables have the values of OUTSIDE, captured bindings, or else their global ones.
Return what it returns."
  (declare (function function))
  (let ((slots (bound-slots depth)))
    (if slots
        (unwind-protect
             (progn
               (loop for (index) in slots
                     for captured = (assoc index outside)
                     do (if captured
                            (setf (sb-sys:sap-ref-lispobj (thread-slots) index) (cdr captured))
                            (setf (sb-sys:sap-ref-word (thread-slots) index)
                                  sb-vm:no-tls-value-marker)))
               (funcall function))
          (loop for (index . value) in slots
                do (setf (sb-sys:sap-ref-lispobj (thread-slots) index) value)))
        (funcall function))))

(defun captured-bindings ()
  "Return the dynamic bindings that are in force, for CALL-WITH-CAPTURED."
  (bound-slots 0))

(defun call-with-captured (bindings function)
  "Call FUNCTION with BINDINGS in force in this thread, which has no bindings of its own."
  (declare (function function))
  (unwind-protect
       (progn
         (loop for (index . value) in bindings
               do (setf (sb-sys:sap-ref-lispobj (thread-slots) index) value))
         (funcall function))
    (loop for (index) in bindings
          do (setf (sb-sys:sap-ref-word (thread-slots) index) sb-vm:no-tls-value-marker))))
