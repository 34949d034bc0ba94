;;;; Hash tables: keys are decided before use, values are handed on.

(in-package #:discrepancy-finder.symbolic-execution)

(defun decided-key (key table)
  "Return KEY as TABLE can compare it."
  (cond ((not (symbolic-run-p)) key)
        ((symbolic-value-p key) (settled key "a key of a hash table"))
        ((member (hash-table-test table) '(eq eql)) key)
        (t (decided key "a key of a hash table"))))

(define-transparent (gethash) (any-key table &optional any-default)
  (if (symbolic-run-p)
      (let ((table (settled table "a hash table")))
        (gethash (decided-key any-key table) table any-default))
      (gethash any-key table any-default)))

(define-transparent (sb-impl::gethash3) (any-key table any-default)
  (let ((table (settled table "a hash table")))
    (gethash (decided-key any-key table) table any-default)))

(defun note-entry (key table)
  "Note that the entry of KEY in TABLE must be as it is after the run."
  (when *path*
    (multiple-value-bind (old present) (gethash key table)
      (note-undo (if present
                     (lambda () (setf (gethash key table) old))
                     (lambda () (remhash key table)))))))

(define-transparent (sb-kernel:%puthash) (any-key table any-value)
  (if *path*
      (let* ((table (settled table "a hash table")) (key (decided-key any-key table)))
        (note-entry key table)
        (setf (gethash key table) any-value))
      (setf (gethash any-key table) any-value)))

(define-transparent ((setf gethash)) (any-value any-key table &optional default)
  (declare (ignore default))
  (let* ((table (settled table "a hash table")) (key (decided-key any-key table)))
    (note-entry key table)
    (setf (gethash key table) any-value)))

(define-transparent (remhash) (any-key table)
  (let* ((table (settled table "a hash table")) (key (decided-key any-key table)))
    (note-entry key table)
    (remhash key table)))

(define-transparent (clrhash) (table)
  (let ((table (settled table "a hash table")))
    (when *path*
      (let ((entries (loop for key being the hash-keys of table using (hash-value value)
                           collect (cons key value))))
        (note-undo (lambda ()
                     (clrhash table)
                     (loop for (key . value) in entries do (setf (gethash key table) value))))))
    (clrhash table)))

(define-transparent hash-table-count (table))
(define-transparent hash-table-size (table))
(define-transparent hash-table-test (table))
(define-transparent sb-impl::hash-table-pairs (table))
(register-lifted 'sb-int:unbound-marker-p :transparent nil)
