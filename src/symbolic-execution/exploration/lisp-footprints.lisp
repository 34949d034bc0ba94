;;;; What a form of a plan reads and writes outside of itself.
;;;;
;;;; The branches of a parallel form can change places if neither writes a variable that the other
;;;; uses.  A form is walked for the variables that it does not bind itself, and so are the plans
;;;; and helpers that it calls.  Objects are looked at only as far as this: a form that calls
;;;; nothing but functions known to change no object changes none.  What calls another function
;;;; may do anything: its use of Lisp is UNKNOWN.  Entry points: FORM-USE, FUNCTION-USE,
;;;; USES-CONFLICT-P.

(in-package #:discrepancy-finder.symbolic-execution)

(defstruct (lisp-use (:copier nil))
  "The variables that a piece of code reads and writes, or UNKNOWN-P."
  (reads '() :type list)
  (writes '() :type list)
  (unknown-p nil))

(defparameter *pure-functions*
  '(list list* cons append car cdr first second third fourth fifth rest last nth nthcdr length
    reverse member assoc rassoc getf copy-list subseq elt aref svref gethash null not consp atom
    listp symbolp keywordp numberp integerp stringp eq eql equal equalp + - * / 1+ 1- < > <= >= = /=
    min max abs mod rem floor ceiling round truncate zerop plusp minusp evenp oddp identity values
    values-list string= string symbol-name char string-upcase string-downcase find position count
    mapcar mapc mapcan some every notany notevery find-if remove remove-if remove-if-not reduce
    funcall apply format print princ error warn signal make-list vector union intersection
    set-difference remove-duplicates complement constantly
    plan:make-designator plan:desig-prop-value plan:desig-prop-values plan:perform plan:fail
    plan::call-par plan::call-par-loop plan::call-pursue plan::call-try-all plan::call-try-in-order
    plan:call-with-failure-handlers plan:call-in-task plan::run-child plan:wait-for plan:value
    plan::conclude plan:get-counter plan:current-desig
    discrepancy-finder.cpl:< discrepancy-finder.cpl:> discrepancy-finder.cpl:+
    discrepancy-finder.cpl:- discrepancy-finder.cpl:* discrepancy-finder.cpl:/
    discrepancy-finder.cpl:= discrepancy-finder.cpl:eq discrepancy-finder.cpl:eql
    discrepancy-finder.cpl:not discrepancy-finder.designators::make-quantified-designator
    discrepancy-finder.geometry:make-pose discrepancy-finder.geometry:pose-x
    discrepancy-finder.geometry:pose-y discrepancy-finder.geometry:pose-z)
  "Functions that change no object that they are given, and call just the functions in their
arguments.")

(defparameter *calling-functions*
  '(mapcar mapc mapcan some every notany notevery find-if remove-if remove-if-not reduce funcall
    apply complement member assoc find position count remove remove-duplicates)
  "Functions that call functions that they are given.")

(defvar *function-uses* nil
  "While a form is walked, an alist from the names of the functions that it calls to their uses.")

(defun merge-use (use other)
  (setf (lisp-use-reads use) (union (lisp-use-reads use) (lisp-use-reads other))
        (lisp-use-writes use) (union (lisp-use-writes use) (lisp-use-writes other))
        (lisp-use-unknown-p use) (or (lisp-use-unknown-p use) (lisp-use-unknown-p other)))
  use)

(defun local-function-p (name environment)
  (multiple-value-bind (kind local) (sb-cltl2:function-information name environment)
    (and (eq kind :function) local)))

(defun known-function-form-p (form environment)
  "Return true if FORM, an argument, is known to be a function whose calls are walked or pure."
  (and (consp form)
       (case (first form)
         (quote (or (not (symbolp (second form))) (member (second form) *pure-functions*)))
         (function (let ((name (second form)))
                     (or (and (consp name) (not (eq (first name) 'setf)))
                         (local-function-p name environment)
                         (member name *pure-functions*)
                         (plan:plan-source name))))
         (lambda t))))

(defun note-call (use form environment)
  "Add to USE what the call FORM of a global function does."
  (let ((name (first form)))
    (cond ((local-function-p name environment))
          ((member name *pure-functions*)
           (when (and (member name *calling-functions*)
                      (not (if (member name '(funcall apply mapcar mapc mapcan some every notany
                                              notevery find-if remove-if remove-if-not reduce
                                              complement))
                               (known-function-form-p (second form) environment)
                               (loop for argument in (cddr form)
                                     always (or (keywordp argument) (atom argument)
                                                (not (member (first argument)
                                                             '(function lambda)))
                                                (known-function-form-p argument environment))))))
             (setf (lisp-use-unknown-p use) t)))
          (t (merge-use use (function-use name))))))

(defun walk-for-use (use form environment)
  (flet ((visit (form context environment)
           (cond ((lisp-use-unknown-p use)
                  (return-from walk-for-use use))
                 ((symbolp form)
                  (unless (or (constantp form) (sb-walker:var-lexical-p form environment))
                    (if (eq context :set)
                        (pushnew form (lisp-use-writes use))
                        (pushnew form (lisp-use-reads use)))))
                 ((atom form))
                 ((consp (first form)))
                 ((eq (first form) 'function)
                  (let ((name (second form)))
                    (when (and (symbolp name) (not (local-function-p name environment)))
                      (note-call use (list name) environment))))
                 ;; What is left runs its cleanup forms.
                 ((eq (first form) 'unwind-protect) (setf (lisp-use-unknown-p use) t))
                 ((special-operator-p (first form)))
                 ((macro-function (first form) environment))
                 (t (note-call use form environment)))
           form))
    (sb-walker:walk-form form environment #'visit)
    use))

(defun form-use (form)
  "Return the LISP-USE of FORM, which stands in code that was walked or is a branch."
  (let ((*function-uses* (or *function-uses* (list (list nil))))
        (use (make-lisp-use)))
    (handler-case (walk-for-use use form nil)
      (error () (setf (lisp-use-unknown-p use) t)))
    use))

(defun function-use (name)
  "Return the LISP-USE of a call of the global function NAME."
  (let ((plan (and (symbolp name) (plan:plan-source name)))
        (known (assoc name *function-uses* :test #'equal)))
    (cond (known (or (cdr known) (make-lisp-use))) ; a recursive call adds nothing
          ((null plan) (make-lisp-use :unknown-p t))
          (t (let* ((*function-uses* (acons name nil (or *function-uses* (list (list nil)))))
                    (use (form-use `(lambda ,(plan:plan-lambda-list plan)
                                      ,@(plan:plan-body plan)))))
               use)))))

(defun apart-p (use)
  "Return true if code with USE looks at nothing outside of itself."
  (and (not (lisp-use-unknown-p use)) (null (lisp-use-reads use)) (null (lisp-use-writes use))))

(defun uses-conflict-p (one other)
  "Return true if code with the LISP-USEs ONE and OTHER may not change places."
  (flet ((overlap-p (writes use)
           (or (intersection writes (lisp-use-reads use))
               (intersection writes (lisp-use-writes use)))))
    (and (not (apart-p one)) (not (apart-p other))
         (or (lisp-use-unknown-p one) (lisp-use-unknown-p other)
             (overlap-p (lisp-use-writes one) other)
             (overlap-p (lisp-use-writes other) one))
         t)))
