;;;; What the scenarios are checked with: theories from files, and models as texts.
;;;;
;;;; Models of a theory in Lisp and of one from a .e file are compared by the .e names of their
;;;; atoms.  Entry point: DEFINE-SCENARIO.

(in-package #:discrepancy-finder.tests)

;;; Names and models as text

(defun capitalize-words (text)
  "Return TEXT in lower case with a capital at the beginning and after each hyphen: P1A is P1a."
  (let ((text (string-downcase text)))
    (loop for start = 0 then (1+ hyphen)
          for hyphen = (position #\- text :start start)
          do (setf (char text start) (char-upcase (char text start)))
          while hyphen)
    text))

(defun e-name-text (name)
  "Return the name that the keyword NAME has in a .e file: :push-box is PushBox."
  (let ((text (symbol-name name)))
    (if (some #'lower-case-p text)
        text
        (remove #\- (capitalize-words text)))))

(defun e-atom (atom)
  "Return the text of the ground ATOM, a tree of keywords and integers."
  (etypecase atom
    (integer (format nil "~d" atom))
    (symbol (e-name-text atom))
    (cons (format nil "~a~@[(~{~a~^,~})~]"
                  (e-name-text (first atom)) (mapcar #'e-atom (rest atom))))))

(defun model-texts (model)
  "Return the sorted texts of the atoms that are true in MODEL."
  (destructuring-bind (first . last) (ec:model-horizon model)
    (sort (append (loop for time from first to last
                        append (loop for fluent in (ec:model-fluents model time)
                                     collect (e-atom (list :holds-at fluent time)))
                        append (loop for event in (ec:model-events model time)
                                     collect (e-atom (list :happens event time))))
                  (mapcar #'e-atom (ec:model-literals model)))
          #'string<)))

(defun all-models (theory)
  "Return the models of THEORY as a sorted list of texts, so that EQUAL compares sets of models."
  (sort (loop for model in (ec:models theory :limit 1000)
              collect (format nil "~{~a~^ ~}" (model-texts model)))
        #'string<))

(defun e-formula (form)
  "Return FORM, a formula with the names of a theory in Lisp, with those of its .e file."
  (let ((words '(and or not implies iff forall exists = /= < <= > >= holds-at released-at happens)))
    (cond ((integerp form) form)
          ((consp form)
           (if (member (first form) '(forall exists))
               (list (first form) (second form) (e-formula (third form)))
               (mapcar #'e-formula form)))
          ((or (member form words) (char= #\? (char (symbol-name form) 0))) form)
          (t (intern (e-name-text form) :keyword)))))

;;; Checking a scenario

(defun scenario-file (name type)
  (root-file (format nil "tests/theories/~(~a~).~a" name type)))

(defun printed-theory (theory)
  "Return the theory that is read from the .e text printed of THEORY."
  (with-file (file (with-output-to-string (stream) (ec:write-e-theory theory stream)) "e")
    (ec:load-e-theory file)))

(defun check-formulas (theory always sometimes translate)
  (ec:with-reasoner (reasoner theory)
    (dolist (form always)
      (is-true (ec:entailed-p reasoner (funcall translate form))
               "~a does not hold in all models" form))
    (dolist (form sometimes)
      (is-true (ec:possible-p reasoner (funcall translate form)) "~a is impossible" form)
      (is-true (ec:possible-p reasoner (funcall translate (list 'not form)))
               "~a holds in all models" form))))

(defun check-models (expected theory what)
  "Check that THEORY, which is that of WHAT, has the EXPECTED models."
  (let ((difference (set-exclusive-or expected (all-models theory) :test #'string=)))
    (is (null difference) "~a: ~d models differ, one is ~a"
        what (length difference) (first difference))))

(defun check-scenario (name count always sometimes)
  (let* ((theory (ec:load-theory (scenario-file name "lisp")))
         (e-theory (ec:load-e-theory (scenario-file name "e")))
         (models (all-models theory)))
    (is (= count (length models)) "~d models, ~d were expected" (length models) count)
    (is (= count (ec:count-models theory)))
    (check-models models e-theory "the .e file")
    (check-models models (printed-theory theory) "what is printed of the Lisp file")
    (check-models models (printed-theory e-theory) "what is printed of the .e file")
    (check-formulas theory always sometimes #'identity)
    (check-formulas e-theory always sometimes #'e-formula)))

(defmacro define-scenario (name count &key always sometimes)
  "Define a test of the scenario NAME: it has COUNT models, all the formulas ALWAYS hold in each of
them, and each of the formulas SOMETIMES in some of them only."
  `(test ,(intern (format nil "SCENARIO-~a" name))
     (check-scenario ',name ,count ',always ',sometimes)))
