;;;; Names as SMT-LIB has them.
;;;;
;;;; A name in Z3 is any string.  A symbol of SMT-LIB is a simple one, or stands between bars and
;;;; has neither bars, backslashes nor control characters; |a| and a are the same symbol, and the
;;;; symbols of the theories are taken.  So a name keeps its characters where it may, the others are
;;;; written by their codes, {7c} for a bar, and where two names would be written alike, or one
;;;; like a symbol of the theories, a number is added.  Entry point: UNIQUE-SYMBOL.

(in-package #:discrepancy-finder.z3)

(defparameter *theory-symbols*
  '(;; reserved words
    "_" "!" "as" "let" "exists" "forall" "match" "par" "lambda" "choice"
    "BINARY" "DECIMAL" "HEXADECIMAL" "NUMERAL" "STRING"
    ;; core
    "true" "false" "not" "and" "or" "xor" "=>" "=" "distinct" "ite" "Bool"
    ;; numbers
    "Int" "Real" "+" "-" "*" "/" "<" "<=" ">" ">=" "div" "mod" "abs" "to_real" "to_int" "is_int"
    "divisible" "exp" "sin" "cos" "tan" "csc" "sec" "cot" "sqrt" "pi" "^" "**" "iand" "pow2"
    "arcsin" "arccos" "arctan" "arccsc" "arcsec" "arccot" "int2bv" "bv2nat" "nat2bv"
    "/_total" "div_total" "mod_total" "log" "root-obj"
    ;; arrays, sets, sequences, data types, functions, bit-vectors
    "Array" "select" "store" "const" "Set" "Bag" "bag" "Seq" "Tuple" "Relation" "tuple" "is"
    "update"
    "union" "intersection" "setminus" "member" "subset" "singleton" "insert" "card" "complement"
    "emptyset" "univset" "transpose" "tclosure" "join" "product" "iden" "map" "rel" "eqrange"
    "BitVec" "String" "RegLan" "concat" "extract" "repeat" "zero_extend" "sign_extend"
    "rotate_left" "rotate_right" "ext_rotate_left" "ext_rotate_right" "bit2bool" "bvredand"
    "RoundingMode" "fp" "FloatingPoint" "Float16" "Float32" "Float64" "Float128" "to_fp"
    "to_fp_unsigned" "RNE" "RNA" "RTP" "RTN" "RTZ" "@" "->" "wand" "pto" "sep" "pbeq" "pbge"
    "pble" "at-most" "at-least" "implies" "iff" "if" "nil" "witness" "UnitTuple" "emp")
  "Symbols that cannot be declared, in SMT-LIB or in some solver.")

(defparameter *theory-prefixes*
  '("bv" "fp." "str." "re." "seq." "set." "bag." "rel." "table." "tuple." "int." "real." "sep."
    "ff." "array." "roundNearest" "roundToward")
  "Beginnings of further symbols that cannot be declared.")

(defparameter *command-words*
  '("apply" "assert" "assert-not" "assert-soft" "block-model" "block-model-values" "check-sat"
    "check-sat-assuming" "check-synth" "constraint" "declare-codatatype" "declare-codatatypes"
    "declare-const" "declare-datatype" "declare-datatypes" "declare-fun" "declare-heap"
    "declare-map" "declare-pool" "declare-rel" "declare-sort" "declare-tactic" "declare-var"
    "define" "define-const" "define-fun" "define-fun-rec" "define-funs-rec" "define-sort" "display"
    "echo" "eval" "exit" "get-abduct" "get-abduct-next" "get-assertions" "get-assignment"
    "get-difficulty" "get-info" "get-interpolant" "get-interpolant-next" "get-learned-literals"
    "get-model" "get-option" "get-proof" "get-qe" "get-qe-disjunct" "get-unsat-assumptions"
    "get-unsat-core" "get-value" "help" "include" "inv-constraint" "labels" "maximize" "minimize"
    "pop" "push" "query" "reset" "reset-assertions" "rule" "set-feature" "set-info" "set-logic"
    "set-option" "simplify" "synth-fun" "synth-inv")
  "Words that are read as commands where they stand without bars.")

(defun theory-symbol-p (name)
  (or (member name *theory-symbols* :test #'string=)
      (some (lambda (prefix) (uiop:string-prefix-p prefix name)) *theory-prefixes*)))

(defun simple-symbol-p (name)
  "Return true if NAME needs no bars in any solver."
  (flet ((letter-p (character)
           (and (alpha-char-p character) (< (char-code character) 128)))
         (other-p (character)
           (find character "0123456789~!@$%^&*_-+=<>.?/")))
    (and (plusp (length name))
         (letter-p (char name 0))
         (every (lambda (character) (or (letter-p character) (other-p character))) name)
         (not (member name *command-words* :test #'string=)))))

(defun permitted-characters (name)
  "Return NAME with the characters that may not stand between bars, or not first, written by their
codes."
  (with-output-to-string (text)
    (loop for character across name
          for position from 0
          for code = (char-code character)
          do (if (or (< code 32) (<= 127 code 159) (<= #xD800 code #xDFFF)
                     (find character "|\\")
                     (and (zerop position) (find character "@.")))
                 (format text "{~(~x~)}" code)
                 (write-char character text)))))

(defun quoted-symbol (name)
  (if (simple-symbol-p name) name (format nil "|~a|" name)))

(defun unique-symbol (name taken)
  "Return the SMT-LIB symbol for NAME, a string, that is not yet in the hash table TAKEN; enter it."
  (let ((name (permitted-characters name)))
    (loop for count from 1
          for candidate = (if (= count 1) name (format nil "~a!~d" name count))
          unless (or (gethash candidate taken)
                     (and (= count 1) (theory-symbol-p candidate)))
            do (setf (gethash candidate taken) t)
               (return (quoted-symbol candidate)))))
