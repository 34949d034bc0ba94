;;;; Writing what a solver holds as a script for any solver that reads SMT-LIB 2.
;;;;
;;;; Z3's own text of a solver shows what its engine has made of the assertions, in which names may
;;;; collide, and has commands that other solvers do not know.  So the record of the assertions is
;;;; written here: the logic, the declarations, an assertion each, and the check.  A large term that
;;;; occurs twice is defined before its first use.  Entry point: SOLVER-SMT-LIB.
;;;;
;;;; The terms are walked twice: COLLECT enters their NODEs, counts uses and chooses names; then
;;;; each node is written, operands first.  Neither recurs, since terms may be deep.

(in-package #:discrepancy-finder.z3)

(defconstant +short-text+ 40
  "A term whose text is no longer is written at each of its uses.")

(defconstant +long-text+ 2000
  "A term whose text is longer is defined even if it is used once.")

(defstruct (node (:copier nil))
  "A term of the script, with what Z3 says of it."
  (address 0 :type (unsigned-byte 64))
  (sort 0 :type (unsigned-byte 64))
  ;; :NUMERAL, :CONSTANT (a declared one), or the name of the operator.
  (operator nil :type t)
  ;; The numeral's value, the constant's declaration, or the bound of at-most and at-least.
  (parameter nil :type t)
  (operands '() :type list)
  (uses 0 :type fixnum)
  (asserted nil :type boolean)
  (text nil :type (or null string)))

(defstruct (script (:constructor make-script (context uninterpreted elements labels))
                   (:copier nil))
  (context nil :type context :read-only t)
  ;; The number that Z3 has for the kind of declared functions; it depends on the version.
  (uninterpreted 0 :type fixnum :read-only t)
  ;; From the address of the declaration of an element to its enumeration.
  (elements nil :type hash-table :read-only t)
  ;; From the address of the declaration of a tracked assertion's literal to its name.
  (labels nil :type hash-table :read-only t)
  (nodes (make-hash-table) :type hash-table)
  ;; Nodes and (:ASSERT node), in the order in which they are written, latest first.
  (items '() :type list)
  ;; From declarations and enumerations to symbols; the symbols of functions and of sorts.
  (symbols (make-hash-table) :type hash-table)
  (taken (make-hash-table :test 'equal) :type hash-table)
  (taken-sorts (make-hash-table :test 'equal) :type hash-table)
  ;; The enumerations, the declarations, latest first.
  (enumerations '() :type list)
  (declarations '() :type list)
  ;; Which of :INTEGER, :REAL, :NON-LINEAR occur.
  (features '() :type list))

;;; Collecting

(defun read-node (script address)
  "Return a new node for the term at ADDRESS; its operands are addresses."
  (calling-z3 (pointer (script-context script))
    (let ((sort (z3-get-sort pointer address)))
      (if (z3-is-numeral-ast pointer address)
          (make-node :address address :sort sort :operator :numeral
                     :parameter (parse-rational (decode (z3-get-numeral-string pointer address))))
          (let* ((declaration (z3-get-app-decl pointer address))
                 (operator (if (or (= (z3-get-decl-kind pointer declaration)
                                      (script-uninterpreted script))
                                   (gethash declaration (script-elements script)))
                               :constant
                               (decode (z3-get-symbol-string
                                        pointer (z3-get-decl-name pointer declaration))))))
            (make-node :address address :sort sort :operator operator
                       :parameter (cond ((eq operator :constant) declaration)
                                        ((member operator '("at-most" "at-least")
                                                 :test #'equal)
                                         (z3-get-decl-int-parameter pointer declaration 0)))
                       :operands (loop for index below (z3-get-app-num-args pointer address)
                                       collect (z3-get-app-arg pointer address index))))))))

(defun declaration-name (script declaration)
  (or (gethash declaration (script-labels script))
      (calling-z3 (pointer (script-context script))
        (let ((name (symbol-name-in-lisp pointer (z3-get-decl-name pointer declaration))))
          (if (integerp name) (format nil "k!~d" name) name)))))

(defun note-enumeration (script enumeration)
  "Choose the symbols of ENUMERATION and its elements."
  (let ((symbols (script-symbols script)))
    (unless (gethash enumeration symbols)
      (setf (gethash enumeration symbols)
            (unique-symbol (sort-name enumeration) (script-taken-sorts script)))
      (push enumeration (script-enumerations script))
      (loop for name in (sort-elements enumeration)
            for constructor in (sort-constructors enumeration)
            do (setf (gethash constructor symbols)
                     (unique-symbol name (script-taken script)))))))

(defun note-declaration (script declaration)
  "Choose the symbol of DECLARATION, and note what is to be declared."
  (let ((enumeration (gethash declaration (script-elements script)))
        (symbols (script-symbols script)))
    (cond (enumeration (note-enumeration script enumeration))
          ((not (gethash declaration symbols))
           (setf (gethash declaration symbols)
                 (unique-symbol (declaration-name script declaration) (script-taken script)))
           (push declaration (script-declarations script))))))

(defun enumeration-at (script address)
  "Return the enumeration whose sort is at ADDRESS, or NIL."
  (find-if (lambda (sort)
             (and (= (sort-pointer sort) address) (eq (sort-kind sort) :enumeration)))
           (context-sorts (script-context script))))

(defun note-features (script node operands)
  "Note what NODE needs of a logic."
  (let ((operator (node-operator node)))
    (flet ((numeral-p (operand) (eq (node-operator operand) :numeral)))
      (case (calling-z3 (pointer (script-context script))
              (kind-of-sort pointer (node-sort node)))
        (:integer (pushnew :integer (script-features script)))
        (:real (pushnew :real (script-features script)))
        (:enumeration (note-enumeration script (enumeration-at script (node-sort node)))))
      (when (eq operator :constant)
        (note-declaration script (node-parameter node)))
      (when (member operator '("at-most" "at-least") :test #'equal)
        (pushnew :integer (script-features script)))
      (when (or (and (equal operator "*") (> (count-if-not #'numeral-p operands) 1))
                (and (member operator '("/" "div" "mod") :test #'equal)
                     (not (and (numeral-p (second operands))
                               (/= 0 (node-parameter (second operands)))))))
        (pushnew :non-linear (script-features script))))))

(defun collect (script root)
  "Enter ROOT, the address of a term, with all that it is made of."
  (let ((nodes (script-nodes script)) (stack '()))
    (flet ((visit (address)
             (let ((node (gethash address nodes)))
               (unless node
                 (setf node (read-node script address)
                       (gethash address nodes) node)
                 (push (cons node (node-operands node)) stack))
               (incf (node-uses node))
               node)))
      (prog1 (visit root)
        (loop while stack
              do (if (rest (first stack))
                     (visit (pop (rest (first stack))))
                     (let* ((node (first (pop stack)))
                            (operands (loop for address in (node-operands node)
                                            collect (gethash address nodes))))
                       (setf (node-operands node) operands)
                       (note-features script node operands)
                       (push node (script-items script)))))))))

;;; Writing

(defun numeral-text (value real)
  (let ((magnitude (cond ((not real) (format nil "~d" (abs value)))
                         ((integerp value) (format nil "~d.0" (abs value)))
                         (t (format nil "(/ ~d.0 ~d.0)" (abs (numerator value))
                                    (denominator value))))))
    (if (minusp value) (format nil "(- ~a)" magnitude) magnitude)))

(defun sort-symbol (script address)
  "Return the SMT-LIB text of the sort at ADDRESS."
  (let ((kind (calling-z3 (pointer (script-context script))
                (kind-of-sort pointer address))))
    (ecase kind
      (:boolean "Bool")
      (:integer "Int")
      (:real "Real")
      (:enumeration (gethash (enumeration-at script address) (script-symbols script))))))

(defun node-symbols (script node)
  "Return the text of NODE, whose operands are written."
  (let ((operator (node-operator node))
        (operands (mapcar #'node-text (node-operands node))))
    (flet ((counting (relation)
             (format nil "(~a (+~{ (ite ~a 1 0)~} 0) ~d)" relation operands
                     (node-parameter node)))
           (application (operator)
             (if operands (format nil "(~a~{ ~a~})" operator operands) operator)))
      (cond ((eq operator :numeral)
             (numeral-text (node-parameter node)
                           (string= (sort-symbol script (node-sort node)) "Real")))
            ((eq operator :constant)
             (application (gethash (node-parameter node) (script-symbols script))))
            ((string= operator "at-most") (counting "<="))
            ((string= operator "at-least") (counting ">="))
            ((string= operator "if") (application "ite"))
            (t (application operator))))))

(defun write-node (script node stream)
  "Give NODE its text; define it on STREAM before if it is large and used twice, or very large."
  (let ((text (node-symbols script node)))
    (dolist (operand (node-operands node))
      (when (zerop (decf (node-uses operand)))
        (setf (node-text operand) nil)))
    (if (and (node-operands node)
             (or (and (> (node-uses node) 1) (> (length text) +short-text+))
                 (and (not (node-asserted node)) (> (length text) +long-text+))))
        (let ((symbol (unique-symbol "shared" (script-taken script))))
          (format stream "(define-fun ~a () ~a ~a)~%" symbol
                  (sort-symbol script (node-sort node)) text)
          (setf (node-text node) symbol))
        (setf (node-text node) text))))

(defun write-declarations (script stream)
  (let ((symbols (script-symbols script)))
    (dolist (enumeration (reverse (script-enumerations script)))
      (format stream "(declare-datatypes ((~a 0)) ((~{(~a)~^ ~})))~%"
              (gethash enumeration symbols)
              (loop for constructor in (sort-constructors enumeration)
                    collect (gethash constructor symbols))))
    (dolist (declaration (reverse (script-declarations script)))
      (format stream "(declare-fun ~a () ~a)~%" (gethash declaration symbols)
              (sort-symbol script (calling-z3 (pointer (script-context script))
                                    (z3-get-range pointer declaration)))))))

(defun logic-name (script)
  "Return the smallest of SMT-LIB's usual logics that has what SCRIPT needs."
  (let ((features (script-features script)))
    (cond ((script-enumerations script) "ALL")
          ((null features) "QF_UF")
          (t (format nil "QF_~:[L~;N~]~:[~;I~]~:[~;R~]A" (member :non-linear features)
                     (member :integer features) (member :real features))))))

(defun label-name (label number)
  "Return the name that the literal for LABEL, tracked as that NUMBER, has in a script."
  (format nil "~a!~d"
          (typecase label
            (string label)
            (symbol (string-downcase label))
            (t "tracked"))
          number))

(defun start-script (solver)
  "Return an empty script for what SOLVER holds."
  (let* ((context (solver-context solver))
         (sort (sort-pointer (boolean-sort context)))
         (elements (make-hash-table)) (labels (make-hash-table)))
    (dolist (sort (context-sorts context))
      (dolist (constructor (sort-constructors sort))
        (setf (gethash constructor elements) sort)))
    (calling-solver (pointer address solver)
      (dolist (tracked (solver-tracked solver))
        (let ((label (tracked-label tracked)))
          (unless (term-p label)
            (setf (gethash (z3-get-app-decl pointer (tracked-literal tracked)) labels)
                  (label-name label (tracked-number tracked))))))
      (make-script context
                   (z3-get-decl-kind pointer
                                     (z3-get-app-decl
                                      pointer
                                      (z3-mk-const pointer (z3-mk-int-symbol pointer 0) sort)))
                   elements labels))))

(defun recorded-assertions (solver)
  "Return the list of the addresses of the assertions of SOLVER."
  (calling-solver (pointer address solver)
    (loop for index below (z3-ast-vector-size pointer (solver-record solver))
          collect (z3-ast-vector-get pointer (solver-record solver) index))))

(defun solver-smt-lib (solver)
  "Return a complete script of SMT-LIB 2, a string, that asks another solver what CHECK of SOLVER
without assumptions asks: logic, declarations, the assertions in their order, and the check, which
assumes the literals of tracked assertions.  Names keep their characters where SMT-LIB allows that;
see smt-lib-names.lisp.  Signals Z3-ERROR."
  (let ((script (start-script solver)) (assumptions '()))
    (dolist (address (recorded-assertions solver))
      (let ((node (collect script address)))
        (setf (node-asserted node) t)
        (push (list :assert node) (script-items script))))
    (dolist (tracked (reverse (solver-tracked solver)))
      (push (collect script (tracked-literal tracked)) assumptions))
    (with-output-to-string (stream)
      (format stream "(set-logic ~a)~%" (logic-name script))
      (write-declarations script stream)
      (dolist (item (reverse (script-items script)))
        (if (node-p item)
            (write-node script item stream)
            (format stream "(assert ~a)~%" (node-text (second item)))))
      (if assumptions
          (format stream "(check-sat-assuming (~{~a~^ ~}))~%"
                  (mapcar #'node-text (reverse assumptions)))
          (format stream "(check-sat)~%")))))
