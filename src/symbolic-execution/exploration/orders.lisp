;;;; Orders: which of the pending prefixes is run next.
;;;;
;;;; A FRONTIER holds the pending prefixes, reversed lists of decisions.  :DEPTH-FIRST goes on where
;;;; the last run was, :BREADTH-FIRST takes the shortest prefix, :RANDOM any one, :COVERAGE one that
;;;; opens an option that no run has taken yet, if there is such a one.  Each order is a function of
;;;; the plan, and of the seed.  Entry points: MAKE-FRONTIER, ADD-PREFIXES, NEXT-PREFIX.

(in-package #:discrepancy-finder.symbolic-execution)

(defclass frontier ()
  ((prefixes :initform '() :accessor frontier-prefixes))
  (:documentation "Pending prefixes, as a stack: the order :DEPTH-FIRST."))

(defgeneric add-prefix (frontier prefix)
  (:documentation "Add PREFIX to FRONTIER.")
  (:method ((frontier frontier) prefix) (push prefix (frontier-prefixes frontier))))

(defgeneric next-prefix (frontier)
  (:documentation "Take the prefix to be run next from FRONTIER, which is not empty.")
  (:method ((frontier frontier)) (pop (frontier-prefixes frontier))))

(defgeneric frontier-size (frontier)
  (:documentation "Return the number of prefixes in FRONTIER.")
  (:method ((frontier frontier)) (length (frontier-prefixes frontier))))

(defgeneric frontier-empty-p (frontier)
  (:documentation "Return true if no prefix is in FRONTIER.")
  (:method ((frontier frontier)) (null (frontier-prefixes frontier))))

(defgeneric note-run (frontier decisions)
  (:documentation "Let FRONTIER know that a run has taken DECISIONS.")
  (:method ((frontier frontier) decisions) (declare (ignore decisions))))

(defgeneric add-prefixes (frontier prefixes)
  (:documentation "Add PREFIXES, of which the first shall come first, to FRONTIER.")
  (:method ((frontier frontier) prefixes)
    (dolist (prefix (reverse prefixes))
      (add-prefix frontier prefix))))

;;; Breadth first

(defclass breadth-first-frontier (frontier)
  ((queues :initform (make-array 16 :adjustable t :fill-pointer 0) :reader frontier-queues
           :documentation "For each length of a prefix a pair: the first and last cons of a list.")
   (shortest :initform 0 :accessor frontier-shortest)
   (size :initform 0 :accessor frontier-size))
  (:documentation "Prefixes by their length, those of the same length as they come."))

(defmethod add-prefix ((frontier breadth-first-frontier) prefix)
  (let ((queues (frontier-queues frontier)) (length (length prefix)) (cell (list prefix)))
    (loop while (<= (length queues) length) do (vector-push-extend (cons nil nil) queues))
    (let ((queue (aref queues length)))
      (if (car queue)
          (setf (cddr queue) cell)
          (setf (car queue) cell))
      (setf (cdr queue) cell))
    (setf (frontier-shortest frontier) (min length (frontier-shortest frontier)))
    (incf (frontier-size frontier))))

(defmethod add-prefixes ((frontier breadth-first-frontier) prefixes)
  (dolist (prefix prefixes)
    (add-prefix frontier prefix)))

(defmethod next-prefix ((frontier breadth-first-frontier))
  (loop until (car (aref (frontier-queues frontier) (frontier-shortest frontier)))
        do (incf (frontier-shortest frontier)))
  (decf (frontier-size frontier))
  (pop (car (aref (frontier-queues frontier) (frontier-shortest frontier)))))

(defmethod frontier-empty-p ((frontier breadth-first-frontier))
  (zerop (frontier-size frontier)))

;;; At random

(defclass random-frontier (frontier)
  ((prefixes :initform (make-array 16 :adjustable t :fill-pointer 0))
   (state :initarg :state :reader frontier-state))
  (:documentation "Prefixes that are taken at random."))

(defmethod add-prefix ((frontier random-frontier) prefix)
  (vector-push-extend prefix (frontier-prefixes frontier)))

(defmethod next-prefix ((frontier random-frontier))
  (let* ((prefixes (frontier-prefixes frontier))
         (index (random (length prefixes) (frontier-state frontier))))
    (rotatef (aref prefixes index) (aref prefixes (1- (length prefixes))))
    (vector-pop prefixes)))

(defmethod frontier-empty-p ((frontier random-frontier))
  (zerop (length (frontier-prefixes frontier))))

;;; Guided by coverage

(defclass coverage-frontier (frontier)
  ((taken :initform (make-hash-table :test 'equal) :reader frontier-taken
          :documentation "The options that runs have taken.")
   (novel :initform '() :accessor frontier-novel
          :documentation "Prefixes that end in an option which was new when they came."))
  (:documentation "Prefixes that end in an option that was never taken come first."))

(defun option-key (decision)
  (cons (decision-choice decision) (decision-description decision)))

(defun novel-p (frontier prefix)
  (not (and prefix (gethash (option-key (first prefix)) (frontier-taken frontier)))))

(defmethod add-prefix ((frontier coverage-frontier) prefix)
  (if (novel-p frontier prefix)
      (push prefix (frontier-novel frontier))
      (call-next-method)))

(defmethod next-prefix ((frontier coverage-frontier))
  (loop
    (if (null (frontier-novel frontier))
        (return (call-next-method))
        (let ((prefix (pop (frontier-novel frontier))))
          (when (novel-p frontier prefix)
            (return prefix))
          (push prefix (frontier-prefixes frontier))))))

(defmethod frontier-size ((frontier coverage-frontier))
  (+ (length (frontier-novel frontier)) (call-next-method)))

(defmethod frontier-empty-p ((frontier coverage-frontier))
  (and (null (frontier-novel frontier)) (call-next-method)))

(defmethod note-run ((frontier coverage-frontier) decisions)
  (dolist (decision decisions)
    (setf (gethash (option-key decision) (frontier-taken frontier)) t)))

(defun make-frontier (order seed)
  "Return a frontier of ORDER with the empty prefix in it; SEED is for :RANDOM."
  (let ((frontier (ecase order
                    (:depth-first (make-instance 'frontier))
                    (:breadth-first (make-instance 'breadth-first-frontier))
                    (:random (make-instance 'random-frontier
                                            :state (sb-ext:seed-random-state seed)))
                    (:coverage (make-instance 'coverage-frontier)))))
    (add-prefix frontier '())
    frontier))
