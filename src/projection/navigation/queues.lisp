;;;; Queues: binary heaps of numbers with keys.
;;;;
;;;; DEQUEUE takes the number with the least key; of equal keys the least number, so that the order
;;;; in which they came does not matter.

(in-package #:discrepancy-finder.projection)

(defstruct (queue (:constructor make-queue ()) (:copier nil) (:predicate nil))
  (keys (make-array 1024 :element-type 'double-float) :type doubles)
  (places (make-array 1024 :element-type 'fixnum) :type (simple-array fixnum (*)))
  (size 0 :type fixnum))

(defun grow-queue (queue)
  (flet ((grown (old)
           (replace (make-array (* 2 (length old)) :element-type (array-element-type old)) old)))
    (setf (queue-keys queue) (grown (queue-keys queue))
          (queue-places queue) (grown (queue-places queue)))))

(declaim (inline before-p))
(defun before-p (key place other-key other-place)
  (declare (double-float key other-key) (fixnum place other-place))
  (or (< key other-key) (and (= key other-key) (< place other-place))))

(defun enqueue (queue key place)
  "Put PLACE into QUEUE under KEY."
  (declare (double-float key) (fixnum place) (optimize speed (safety 1))
           (sb-ext:muffle-conditions sb-ext:compiler-note))
  (when (= (queue-size queue) (length (queue-keys queue)))
    (grow-queue queue))
  (let ((keys (queue-keys queue)) (places (queue-places queue)) (index (queue-size queue)))
    (incf (queue-size queue))
    (loop while (plusp index)
          do (let ((parent (ash (1- index) -1)))
               (unless (before-p key place (aref keys parent) (aref places parent))
                 (return))
               (setf (aref keys index) (aref keys parent)
                     (aref places index) (aref places parent)
                     index parent)))
    (setf (aref keys index) key
          (aref places index) place)))

(defun dequeue (queue)
  "Take the place with the least key out of QUEUE; return it, or NIL if there is none."
  (declare (optimize speed (safety 1))
           (sb-ext:muffle-conditions sb-ext:compiler-note))
  (let ((keys (queue-keys queue)) (places (queue-places queue)))
    (unless (zerop (queue-size queue))
      (prog1 (aref places 0)
        (let* ((size (decf (queue-size queue)))
               (key (aref keys size)) (place (aref places size)) (index 0))
          (declare (fixnum index))
          (loop
            (let ((child (1+ (* 2 index))))
              (declare (fixnum child))
              (when (>= child size) (return))
              (when (and (< (1+ child) size)
                         (before-p (aref keys (1+ child)) (aref places (1+ child))
                                   (aref keys child) (aref places child)))
                (incf child))
              (unless (before-p (aref keys child) (aref places child) key place)
                (return))
              (setf (aref keys index) (aref keys child)
                    (aref places index) (aref places child)
                    index child)))
          (setf (aref keys index) key
                (aref places index) place))))))
