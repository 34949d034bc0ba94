;;;; Initial states, and the variables for what is open.
;;;;
;;;; What the theory leaves open, at first or later, becomes a Z3 variable in the context of the
;;;; state; a state without a context signals UNDETERMINED there.  The variable of the fluent f is
;;;; named (f) at the first timepoint, (f) at 3 later on, so that the same question gives the same
;;;; variable.  Entry points: SYMBOLIC-STATE, CONCRETE-STATE.

(in-package #:discrepancy-finder.event-calculus)

;;; Variables

(defun fresh-variable (context outline kind number time)
  "Return the Z3 variable for the atom of KIND with NUMBER at TIME, which the theory leaves open.
Signals UNDETERMINED if there is no context."
  (let* ((ground (outline-ground outline))
         (atom (ecase kind
                 ((:fluent :released) (svref (ground-theory-fluents ground) number))
                 ((:number :number-released) (svref (ground-theory-numerics ground) number))
                 (:event (svref (ground-theory-events ground) number))
                 (:predicate (aref (atom-table-atoms (ground-theory-predicates ground)) number))
                 (:static (aref (atom-table-atoms (ground-theory-statics ground)) number)))))
    (unless context
      (error 'undetermined :atom atom :kind kind :time (if (eq kind :static) nil time)
                           :theory (theory-name (ground-theory-theory ground))))
    ;; The names of fluents at the first timepoint are their texts alone; none of these begins with
    ;; a letter or ends with a digit.
    (z3:variable context
                 (format nil "~:[~(~a~) ~;~*~]~a~@[ at ~d~]" (eq kind :fluent) kind
                         (atom-text atom) (if (eq kind :static) nil time))
                 (if (eq kind :number) (z3:real-sort context) (z3:boolean-sort context)))))

;;; Initial states

(defun context-of (propositions)
  (let ((term (find-if #'z3:term-p propositions)))
    (and term (z3:term-context term))))

(defun initial-released (outline context)
  (let ((ground (outline-ground outline)))
    (map 'simple-vector
         (let ((number -1))
           (lambda (release)
             (incf number)
             (ecase release
               ((nil) nil)
               (:always t)
               (:possibly (and (manual-release-p ground number)
                               (fresh-variable context outline :released number
                                               (outline-first-time outline)))))))
         (outline-release outline))))

(defun initial-statics (outline context)
  (let ((statics (copy-seq (outline-statics outline))))
    (dotimes (number (length statics) statics)
      (when (eq (svref statics number) :open)
        (setf (svref statics number)
              (fresh-variable context outline :static number nil))))))

(defun initial-numbers (outline context number-of)
  (let ((numeric -1))
    (map 'simple-vector
         (lambda (atom)
           (incf numeric)
           (if number-of
               (funcall number-of atom)
               (fresh-variable context outline :number numeric (outline-first-time outline))))
         (ground-theory-numerics (outline-ground outline)))))

(defun make-initial-state (ground context values &optional number-of)
  (let* ((outline (ground-outline ground))
         (numbers (initial-numbers outline context number-of)))
    (make-state :outline outline :context context :time (outline-first-time outline)
                :values values :released (initial-released outline context)
                :numbers numbers
                :loose-numbers (make-array (length numbers) :initial-element nil)
                :statics (initial-statics outline context))))

(defun symbolic-state (ground context)
  "Return the initial state of GROUND in which each fluent is a new variable in the Z3 CONTEXT,
named by the fluent's text; numeric fluents have real variables."
  (make-initial-state ground context
                      (map 'simple-vector (lambda (atom) (z3:variable context (atom-text atom)))
                           (ground-theory-fluents ground))))

(defun concrete-state (ground value-of &key context number-of)
  "Return the initial state of GROUND in which the fluent ATOM has the proposition that the
function VALUE-OF returns for it, and the numeric fluent ATOM the rational or real term that the
function NUMBER-OF returns, by default a variable.  CONTEXT is where variables for what is left
open come from, by default that of the propositions.  Signals UNDETERMINED if the theory leaves
something open, whether a fluent is released, a timeless atom is true, or a number, and there is no
context."
  (let ((values (map 'simple-vector value-of (ground-theory-fluents ground))))
    (make-initial-state ground (or context (context-of values)) values number-of)))

(defun ground-numeric-p (ground)
  "Return true if the theory of GROUND has numeric fluents."
  (plusp (length (ground-theory-numerics ground))))
