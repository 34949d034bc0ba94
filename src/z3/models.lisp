;;;; Models and statistics, read into Lisp.

(in-package #:discrepancy-finder.z3)

(defstruct (algebraic-number (:constructor make-algebraic-number (lower upper text)) (:copier nil))
  "An irrational number as the value of a real term, e.g. the square root of 2: it lies between two
rationals."
  (lower 0 :type rational :read-only t)
  (upper 0 :type rational :read-only t)
  (text "" :type string :read-only t))

(setf (documentation 'algebraic-number-p 'function)
      "Return true if its argument is an ALGEBRAIC-NUMBER."
      (documentation 'algebraic-number-lower 'function)
      "Return a rational that is less than an algebraic number, by at most 10^-20."
      (documentation 'algebraic-number-upper 'function)
      "Return a rational that is greater than an algebraic number, by at most 10^-20."
      (documentation 'algebraic-number-text 'function)
      "Return Z3's text of an algebraic number: the polynomial and which of its roots it is.")

(defmethod print-object ((number algebraic-number) stream)
  (print-unreadable-object (number stream :type t)
    (format stream "~,6f ~a" (algebraic-number-lower number) (algebraic-number-text number))))

;;; Values

(defun parse-rational (text)
  "Return the integer or ratio that TEXT shows."
  (let ((slash (position #\/ text)))
    (if slash
        (/ (parse-integer text :end slash) (parse-integer text :start (1+ slash)))
        (parse-integer text))))

(defun algebraic-value (pointer address)
  (flet ((bound (address)
           (parse-rational (decode (z3-get-numeral-string pointer address)))))
    (z3-inc-ref pointer address)
    (prog1 (make-algebraic-number (bound (z3-get-algebraic-number-lower pointer address 20))
                                  (bound (z3-get-algebraic-number-upper pointer address 20))
                                  (decode (z3-ast-to-string pointer address)))
      (z3-dec-ref pointer address))))

(defun kind-of-sort (pointer sort)
  "Return what Z3's SORT is, as SORT-KIND does; NIL if it is something else."
  (case (z3-get-sort-kind pointer sort)
    (1 :boolean) (2 :integer) (3 :real) (6 :enumeration)))

(defun lisp-value (pointer address)
  "Return the value at ADDRESS in the Z3 context at POINTER as a Lisp object, and true; NIL and NIL
if it is none that Lisp has."
  (case (kind-of-sort pointer (z3-get-sort pointer address))
    (:boolean (case (z3-get-bool-value pointer address)
                (1 (values t t))
                (-1 (values nil t))
                (t (values nil nil))))
    ((:integer :real)
     (cond ((z3-is-numeral-ast pointer address)
            (values (parse-rational (decode (z3-get-numeral-string pointer address))) t))
           ((z3-is-algebraic-number pointer address)
            (values (algebraic-value pointer address) t))
           (t (values nil nil))))
    (:enumeration
     (if (and (z3-is-app pointer address) (zerop (z3-get-app-num-args pointer address)))
         (values (symbol-name-in-lisp
                  pointer (z3-get-decl-name pointer (z3-get-app-decl pointer address)))
                 t)
         (values nil nil)))
    (t (values nil nil))))

;;; Models

(defun read-model (solver)
  "Return the address of the model of SOLVER's last check.  Signal Z3-ERROR if there is none."
  (let ((model (solver-model solver)))
    (case model
      ((nil) (misuse :no-model "there is no model, for the last operation on the solver was not ~
                                a check that found one"))
      (:unread
       (calling-solver (pointer address solver)
         (let ((model (foreign:with-c-float-traps (z3-solver-get-model pointer address))))
           (unless (zerop model)
             (z3-model-inc-ref pointer model)
             (setf (solver-model solver) model)))))
      (t model))))

(defun model-value (solver argument)
  "Return the value of ARGUMENT, a term or constant, in the model that the last CHECK of SOLVER
found: T or NIL, an integer, a rational, or the name (a string) of an enumeration's element; an
irrational real is an ALGEBRAIC-NUMBER.  Where the model leaves a variable open Z3 completes it, and
goes on to give the same value.  Signals Z3-ERROR if there is no model: the last check did not say
:SAT (or by TREAT-AS-SAT only), or assertions or scopes have changed since then."
  (check-type argument (or boolean term rational string))
  (let ((model (read-model solver)))
    (if (term-p argument)
        (let ((term (live-pointer argument (solver-context solver)))
              (place (make-handles 1)))
          (multiple-value-bind (value known)
              (let (value known)
                (sb-sys:with-pinned-objects (place)
                  (calling-z3 (pointer (solver-context solver))
                    (foreign:with-c-float-traps
                      ;; The value needs no reference: Z3 keeps the last result alive.
                      (when (z3-model-eval pointer model term t (sb-sys:vector-sap place))
                        (setf (values value known)
                              (lisp-value pointer (aref place 0)))))))
                (values value known))
            (unless known
              (misuse :exception "the model gives no value to ~a" (term-text argument)))
            value))
        argument)))

(defun tracked-declaration-p (pointer solver declaration)
  "Return true if DECLARATION is that of a literal that was made for a label."
  (some (lambda (tracked)
          (and (not (term-p (tracked-label tracked)))
               (= (z3-get-app-decl pointer (tracked-literal tracked)) declaration)))
        (solver-tracked solver)))

(defun model-values (solver)
  "Return an alist from the names of the variables to which the model of SOLVER's last check gives a
value to their values, as MODEL-VALUE has them, in the order of the names.  Variables of a clause
set without names are integers, and come first.  Signals Z3-ERROR if there is no model."
  (let ((model (read-model solver)) (values '()))
    (calling-solver (pointer address solver)
      (foreign:with-c-float-traps
        (dotimes (index (z3-model-get-num-consts pointer model))
          (let* ((declaration (z3-model-get-const-decl pointer model index))
                 (interpretation (z3-model-get-const-interp pointer model declaration)))
            (unless (or (zerop interpretation)
                        (tracked-declaration-p pointer solver declaration))
              (multiple-value-bind (value known) (lisp-value pointer interpretation)
                (when known
                  (push (cons (symbol-name-in-lisp pointer (z3-get-decl-name pointer declaration))
                              value)
                        values))))))))
    (stable-sort (nreverse values)
                 (lambda (a b)
                   (cond ((and (integerp a) (integerp b)) (< a b))
                         ((integerp a) t)
                         ((integerp b) nil)
                         (t (string< a b))))
                 :key #'car)))

;;; Statistics

(defun statistics-key (text)
  (intern (substitute-if #\- (lambda (character) (find character " ._")) (string-upcase text))
          '#:keyword))

(defun solver-statistics (solver)
  "Return what Z3 counted in SOLVER since it was made, as an alist from keywords, such as :CONFLICTS
or :MAX-MEMORY, to numbers.  Which there are depends on the engine and on the version of Z3.
Signals Z3-ERROR."
  (calling-solver (pointer address solver)
    (foreign:with-c-float-traps
      (let ((statistics (z3-solver-get-statistics pointer address)))
        (z3-stats-inc-ref pointer statistics)
        (prog1 (loop for index below (z3-stats-size pointer statistics)
                     collect (cons (statistics-key
                                    (decode (z3-stats-get-key pointer statistics index)))
                                   (if (z3-stats-is-uint pointer statistics index)
                                       (z3-stats-get-uint-value pointer statistics index)
                                       (z3-stats-get-double-value pointer statistics index))))
          (z3-stats-dec-ref pointer statistics))))))
