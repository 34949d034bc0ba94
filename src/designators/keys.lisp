;;;; The keys that designators of each class are known to have.
;;;;
;;;; Who writes plans and groundings invents keys freely, so that an unknown key is no error.  But a
;;;; key that is nearly a known one is a slip more often than an invention: the macros A, AN, ...
;;;; warn of it when they are expanded.  DECLARE-DESIGNATOR-KEYS makes keys known.

(in-package #:discrepancy-finder.designators)

(defvar *known-keys* (make-hash-table :test 'eq)
  "The list of the known keys for each keyword of a designator class.")

(defun add-known-keys (class keys)
  (let ((class (check-class class)))
    (dolist (key keys class)
      (pushnew (source:name-keyword key) (gethash class *known-keys*)))))

(defun known-keys (class)
  "Return the list of the keys that designators of CLASS (:motion, ...) are known to have.  Signals
MALFORMED-DESIGNATOR for another class."
  (copy-list (gethash (check-class class) *known-keys*)))

(defmacro declare-designator-keys (class &rest keys)
  "Make KEYS known as keys of designators of CLASS (action, motion, location, object or human), all
unevaluated, so that no form is suspected of meaning another key."
  `(eval-when (:compile-toplevel :load-toplevel :execute)
     (add-known-keys ',class ',keys)))

;;; Keys much like known ones

(defun edit-distance (first second)
  "Return the cost of making the string FIRST the string SECOND: 1 for a character that is inserted,
removed or swapped with its neighbour, 2 for one that is replaced."
  (let* ((width (1+ (length second)))
         (before-last (make-array width :initial-element 0))
         (last (make-array width :initial-element 0))
         (row (make-array width)))
    (dotimes (column width)
      (setf (svref row column) column))
    (loop
      for index from 1 to (length first)
      for character = (char first (1- index))
      do (rotatef before-last last row)
         (setf (svref row 0) index)
         (loop for column from 1 below width
               for other = (char second (1- column))
               do (setf (svref row column)
                        (if (char= character other)
                            (svref last (1- column))
                            (1+ (min (svref last column) (svref row (1- column))))))
                  (when (and (> index 1) (> column 1)
                             (char= character (char second (- column 2)))
                             (char= other (char first (- index 2))))
                    (setf (svref row column)
                          (min (svref row column)
                               (1+ (svref before-last (- column 2))))))))
    (svref row (1- width))))

(defun tolerance (length)
  "Return up to which edit distance a slip is likely in a word of LENGTH.  Of short ones many differ
by a character: :in, :on; :side, :size.  To replace one counts as two slips."
  (cond ((< length 4) 0) ((< length 6) 1) (t 2)))

(defun plural-of-p (first second)
  (string= first (concatenate 'string second "S")))

(defun similar-key (class key)
  "Return the known key of CLASS that KEY was probably meant to be, or NIL if KEY is known or like
none.  A plural or singular of a known key is taken for intended."
  (let ((name (symbol-name key))
        (known (gethash class *known-keys*))
        (best nil)
        (best-distance nil))
    (unless (member key known)
      ;; By name, so that of equally near keys it is always the same one.
      (dolist (candidate (sort (copy-list known) #'string<) best)
        (let* ((other (symbol-name candidate))
               (limit (if (< (min (length name) (length other)) 3)
                            0
                            (tolerance (max (length name) (length other))))))
          (when (or (plural-of-p name other) (plural-of-p other name))
            (return nil))
          ;; The first character is seldom wrong: :weight is not :height.
          (when (and (plusp limit) (char= (char name 0) (char other 0))
                     (<= (abs (- (length name) (length other))) limit))
            (let ((distance (edit-distance name other)))
              (when (and (<= distance limit) (or (null best) (< distance best-distance)))
                (setf best candidate
                      best-distance distance)))))))))

(defvar *warned-forms* (make-hash-table :test 'eq :weakness :key :synchronized t)
  "The properties that were warned of: a form may be expanded often.")

(defvar *plan* nil
  "The name of the plan that the form which is being expanded stands in, or NIL.")

(defun check-key (class key property form)
  "Warn if KEY, of the list PROPERTY of the designator FORM of CLASS, is much like a known key."
  (let ((suggestion (similar-key class key)))
    (when (and suggestion (not (gethash property *warned-forms*)))
      (setf (gethash property *warned-forms*) t)
      (warn 'unknown-designator-key
            :key key :suggestion suggestion :form form :plan *plan*
            :position (or (source:form-position property) (source:form-position form))))))
