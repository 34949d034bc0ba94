;;;; Ground formulas, taken apart: which atoms and timepoints they speak of.
;;;;
;;;; A formula REACHES to the largest of its distances; it looks AHEAD if that is above 0.

(in-package #:discrepancy-finder.event-calculus)

(defun replace-atom (formula atom value)
  "Return the ground FORMULA with VALUE, T or NIL, for the ground atom ATOM."
  (cond ((atom formula) formula)
        ((equal formula atom) value)
        (t (flet ((parts ()
                    (mapcar (lambda (part) (replace-atom part atom value)) (rest formula))))
             (case (first formula)
               ((:and :or) (fold (first formula) (parts)))
               (:not (fold-not (first (parts))))
               (:iff (apply #'fold-iff (parts)))
               (t formula))))))

(defun map-distances (function formula)
  "Call FUNCTION with kind and distance of all in the ground FORMULA that depends on the time; the
kind of numbers is :VALUE."
  (labels ((look-at-term (term)
             (when (consp term)
               (if (eq (first term) :value)
                   (funcall function :value (third term))
                   (mapc #'look-at-term (rest term))))))
    (map-atoms (lambda (atom)
                 (case (first atom)
                   (:static)
                   (:compare (mapc #'look-at-term (cddr atom)))
                   (t (funcall function (first atom) (third atom)))))
               formula)))

(defun formula-start (formula)
  "Return the least distance in the ground FORMULA, 0 at most."
  (let ((start 0))
    (map-distances (lambda (kind distance)
                     (declare (ignore kind))
                     (setf start (min start distance)))
                   formula)
    start))

(defun mentions-kind-p (formula kinds)
  "Return true if the ground FORMULA has an atom of one of KINDS."
  (map-atoms (lambda (atom)
               (when (member (first atom) kinds) (return-from mentions-kind-p t)))
             formula))

(defun formula-reach (formula)
  "Return the largest distance in the ground FORMULA, NIL if it has no time."
  (let ((reach nil))
    (map-distances (lambda (kind distance)
                     (declare (ignore kind))
                     (setf reach (max distance (or reach distance))))
                   formula)
    reach))

(defun looks-ahead-p (formula)
  (let ((reach (formula-reach formula)))
    (and reach (> reach 0))))

(defun span-end (formula)
  "Return the last distance that the ground FORMULA speaks of, 0 at least; an event at t ends at
t + 1."
  (let ((end 0))
    (map-distances (lambda (kind distance)
                     (setf end (max end (if (eq kind :event) (1+ distance) distance))))
                   formula)
    end))

(defun plain-parts-first (formula)
  "Return the ground FORMULA with the parts of conjunctions and disjunctions ordered: those without
events and predicates first, since they are known before these."
  (if (and (consp formula) (member (first formula) '(:and :or :not :iff)))
      (let ((parts (mapcar #'plain-parts-first (rest formula))))
        (cons (first formula)
              (if (member (first formula) '(:and :or))
                  (stable-sort parts (lambda (a b)
                                       (and (not a) b))
                               :key (lambda (part)
                                      (mentions-kind-p part '(:event :predicate))))
                  parts)))
      formula))
