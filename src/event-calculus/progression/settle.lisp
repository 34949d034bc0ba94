;;;; Settling: finding values that the sentences leave no choice about, without Z3.
;;;;
;;;; A released fluent may have any value that the state constraints allow.  Often that is one: of
;;;; the heights of an object one is given by a trajectory, and a constraint excludes the others.
;;;; SETTLE does unit propagation with constants; what is left open gets a Z3 variable.

(in-package #:discrepancy-finder.event-calculus)

(defun truth (formula value-of)
  "Return T, NIL or :UNKNOWN for the ground FORMULA.  The function VALUE-OF gives that for an
atom."
  (declare (type function value-of))
  (if (atom formula)
      formula
      (case (first formula)
        (:not (let ((value (truth (second formula) value-of)))
                (if (eq value :unknown) value (not value))))
        ((:and :or)
         (let* ((absorbing (eq (first formula) :or))
                (result (not absorbing)))
           (dolist (part (rest formula) result)
             (let ((value (truth part value-of)))
               (cond ((eq value absorbing) (return absorbing))
                     ((eq value :unknown) (setf result :unknown)))))))
        (:iff (let ((p (truth (second formula) value-of)) (q (truth (third formula) value-of)))
                (if (or (eq p :unknown) (eq q :unknown)) :unknown (eq p q))))
        (t (funcall value-of formula)))))

(defun forced-value (formula kind index value-of)
  "Return the value that FORMULA forces on the atom of KIND with the number INDEX, and true if it
does."
  (declare (type function value-of))
  (flet ((truth-with (value)
           (truth formula (lambda (atom)
                            (if (and (eq (first atom) kind) (eql (second atom) index))
                                value
                                (funcall value-of atom))))))
    (cond ((null (truth-with nil)) (values t t))
          ((null (truth-with t)) (values nil t))
          (t (values nil nil)))))

(defun settle (values open formulas-of kind)
  "Replace :OPEN in the vector VALUES by T or NIL where the formulas force it.  OPEN is the list of
the numbers of the open atoms, all of KIND and of one timepoint; the function FORMULAS-OF returns
those that mention the atom of a number.  Return the numbers of those left open."
  (declare (type simple-vector values) (type function formulas-of))
  (flet ((value-of (atom)
           (let ((value (if (eq (first atom) kind) (svref values (second atom)) :unknown)))
             (if (typep value 'boolean) value :unknown)))
         (open-p (index) (eq (svref values index) :open)))
    (let ((agenda open))
      (loop while agenda
            do (let ((again nil))
                 (dolist (index agenda)
                   (when (open-p index)
                     (dolist (formula (funcall formulas-of index))
                       (multiple-value-bind (value forced)
                           (forced-value formula kind index #'value-of)
                         (when forced
                           (setf (svref values index) value
                                 again t)
                           (return))))))
                 (setf agenda (and again (remove-if-not #'open-p agenda))))))
    (remove-if-not #'open-p open)))
