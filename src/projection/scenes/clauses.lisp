;;;; The clauses of a scene file, and what is wrong with them.
;;;;
;;;; A CLAUSE such as (:item cup "cup.urdf" (:at 0 0 1)) has a kind, a name, a file and OPTIONS,
;;;; lists that begin with a keyword.  SCENE-PROBLEM knows the line on which a form begins.

(in-package #:discrepancy-finder.projection)

(defun scene-problem (file form control &rest arguments)
  "Signal a SCENE-ERROR about FORM in FILE, with the line where the form begins if it is a list."
  (let ((position (source:form-position form))
        (*package* (find-package '#:discrepancy-finder.projection))
        (*read-default-float-format* 'double-float)
        (*print-pretty* nil) (*print-length* 6) (*print-level* 3))
    (error 'scene-error :file (source:native-name file)
                        :line (and position (source:source-position-line position))
                        :reason (substitute #\Space #\Newline
                                            (apply #'format nil control arguments)))))

(defun check-proper (form file)
  "Signal SCENE-ERROR at a list within FORM that has a dot in it."
  (when (consp form)
    (unless (alexandria:proper-list-p form)
      (scene-problem file form "there is a dot in ~(~s~)" form))
    (dolist (part form)
      (check-proper part file))))

(defun clause-options (clause)
  (cdddr clause))

(defun check-options (clause options known file)
  "Signal SCENE-ERROR unless each of OPTIONS, which are in CLAUSE, is a list that begins with one of
the keywords KNOWN; none but :arm can occur twice."
  (loop for (option . more) on options
        do (unless (and (consp option) (member (first option) known))
             (scene-problem file (if (consp option) option clause)
                            "~(~s~) ~(~a~) has no option ~(~s~); it can have~{ ~(~s~)~^,~}"
                            (first clause) (second clause)
                            (if (consp option) (first option) option) known))
           (let ((again (find (first option) (remove-if-not #'consp more) :key #'first)))
             (when (and again (not (eq (first option) :arm)))
               (scene-problem file again "~(~s~) ~(~a~) has two options ~(~s~)"
                              (first clause) (second clause) (first option))))))

(defun find-option (options name)
  "Return the first of OPTIONS that begins with the keyword NAME, or NIL."
  (find name options :key #'first))

(defun option-value (clause name file)
  "Return the arguments of the option NAME of CLAUSE."
  (let ((option (find-option (clause-options clause) name)))
    (unless option
      (scene-problem file clause "~(~s~) ~(~a~) needs an option (~(~s~) ...)"
                     (first clause) (second clause) name))
    (rest option)))

(defun coordinate-p (object)
  (and (realp object) (< -1000000000 object 1000000000)))

(defun clause-pose (clause file)
  "Return the pose that the :at option of CLAUSE gives."
  (let ((numbers (option-value clause :at file)))
    (unless (and (<= 3 (length numbers) 4)
                 (every #'coordinate-p numbers))
      (scene-problem file clause "(:at x y z [yaw]) was expected in ~(~s~) ~(~a~)"
                     (first clause) (second clause)))
    (destructuring-bind (x y z &optional (yaw 0)) numbers
      (make-pose x y z :yaw yaw))))

(defun option-names (clause name file &optional count)
  "Return the arguments of the option NAME of CLAUSE, symbols, as keywords, NIL without option;
COUNT is how many there must be."
  (let ((option (find-option (clause-options clause) name)))
    (unless (and (every #'parameter-name-p (rest option))
                 (or (null option) (null count) (= (length (rest option)) count)))
      (scene-problem file option "(~(~s~) name~:[*~;~]) was expected in ~(~s~) ~(~a~)"
                     name count (first clause) (second clause)))
    (mapcar #'source:name-keyword (rest option))))

(defun option-name (clause name file)
  "Return the argument of the option NAME of CLAUSE, a symbol, as a keyword, NIL without option."
  (first (option-names clause name file 1)))
