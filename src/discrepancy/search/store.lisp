;;;; The store: a folder of discrepancies, each in a replay file, that are tried before anything
;;;; else.
;;;;
;;;; A stored discrepancy is tried if it is one of the same plan, domain, state constraint and scene
;;;; parameters.  It is run in the domain of the search, as that is now, from the sample in the
;;;; file: what theory, scene or plan have changed since has its say.  The smallest case of one
;;;; stands beside it, for replay; it is not tried, since the original is.

(in-package #:discrepancy-finder.discrepancy)

(declaim (ftype function smallest-case))

(defun store-file (discrepancy folder)
  "Return the name of a file in FOLDER for DISCREPANCY: made of plan, seed and state hash."
  (format nil "~a~a-~d-~a.json"
          (source:native-name (uiop:ensure-directory-pathname (source:native-path folder)))
          (file-name (plan:plan-name (discrepancy-plan discrepancy)))
          (discrepancy-seed discrepancy)
          (subseq (hash-text (run-hash (discrepancy-run discrepancy))) 0 8)))

(defparameter *small-suffix* "-small.json"
  "How the name of the file of a smallest case ends.")

(defun small-file (file)
  "Return the name of the file for the smallest case of the discrepancy in FILE."
  (concatenate 'string (if (uiop:string-suffix-p file ".json")
                           (subseq file 0 (- (length file) (length ".json")))
                           file)
               *small-suffix*))

(defun store-in-file (discrepancy file)
  (handler-case (progn (ensure-directories-exist (source:native-path file))
                       (save-discrepancy discrepancy file))
    ((or replay-error file-error) (condition)
      (warn "~a is not stored: ~a" file (source:condition-sentence condition)))))

(defun store-discrepancy (discrepancy folder)
  "Write DISCREPANCY to a file in FOLDER, which is made if need be, unless it has a file; and its
smallest case, if it was shrunk, to another one beside that.  Where that cannot be done there is a
warning: what was found is worth more than the file."
  (unless (discrepancy-file discrepancy)
    (store-in-file discrepancy (store-file discrepancy folder)))
  (let ((small (smallest-case discrepancy)))
    (when (and small (discrepancy-file discrepancy))
      (store-in-file small (small-file (discrepancy-file discrepancy))))))

(defun stored-files (folder)
  "Return the names of the replay files in FOLDER, but for those of smallest cases, in the order of
the alphabet."
  (sort (loop for path in (uiop:directory-files (uiop:ensure-directory-pathname
                                                 (source:native-path folder))
                                                "*.json")
              for file = (source:native-name path)
              unless (uiop:string-suffix-p file *small-suffix*) collect file)
        #'string<))

(defun stored-object (file)
  "Return the JSON object in FILE, or NIL if that is none."
  (let ((object (ignore-errors (json:parse (uiop:read-file-string (source:native-path file)
                                                                  :external-format :utf-8)))))
    (and (listp object) object)))

(defun same-parameters-p (object parameters)
  "Return true if the JSON OBJECT has the property list PARAMETERS of scene parameters."
  (and (listp object)
       (= (length object) (/ (length parameters) 2))
       (loop for (name value) on parameters by #'cddr
             always (eql (json:get-key object (ec:name-text name) nil) (decimal-double value)))))

(defun fits-search-p (object search)
  "Return true if the stored OBJECT is of the plan, domain, constraint and parameters of SEARCH."
  (flet ((name (key)
           (let ((part (json:get-key object key nil)))
             (and (listp part) (json:get-key part "name" nil)))))
    (and object
         ;; A smallest case that a user has stored here has actions and is no run of the plan.
         (zerop (length (json:get-key object "actions" '())))
         (equal (name "plan") (ec:name-text (plan:plan-name (search-plan search))))
         (equal (name "domain")
                (ec:name-text (symbolic:action-theory-name (search-domain search))))
         (equal (json:get-key object "constraint" nil) (constraint-text (search-constraint search)))
         (same-parameters-p (json:get-key object "parameters" nil)
                            (search-parameters search)))))

(defun retry-stored (search file)
  "Run the discrepancy in FILE again.  Return the DISCREPANCY, or NIL and why it is none any more."
  (handler-case
      (destructuring-bind (&key trace sample &allow-other-keys) (read-replay-file file)
        (let* ((run (simulate search sample trace))
               (judgement (and (eq (run-validity run) :valid) (judge search run trace))))
          (cond ((null judgement)
                 (values nil (format nil "its initial state is not valid any more: ~a"
                                     (run-validity run))))
                ((eq (judgement-verdict judgement) :discrepancy)
                 (let ((discrepancy (make-find search trace sample run judgement :reused)))
                   (setf (discrepancy-file discrepancy) file
                         (discrepancy-runs discrepancy) (list (cons run judgement)))
                   discrepancy))
                (t (values nil "theory and simulation agree now")))))
    (replay-error (condition)
      (values nil (replay-error-reason condition)))))

(defun reuse-stored (search)
  "Try the stored discrepancies of SEARCH.  Return true if the search is to end."
  (when (search-store search)
    (dolist (file (stored-files (search-store search)))
      (when (and (not (end-reason search))
                 (fits-search-p (stored-object file) search))
        (multiple-value-bind (discrepancy text)
            (in-phase (search :reuse) (retry-stored search file))
          (let* ((kind (and discrepancy (discrepancy-kind discrepancy)))
                 (known (and kind (gethash kind (search-kinds search)))))
            (cond (known (incf (discrepancy-occurrences known)))
                  (t
                   (push (list discrepancy file (or text "theory and simulation disagree still"))
                         (search-reused search))
                   (when discrepancy
                     (setf (gethash kind (search-kinds search)) discrepancy)
                     (confirm-find search discrepancy)
                     (examine-find search discrepancy)
                     (when (enough-kinds-p search)
                       (return t)))))))))))
