;;;; Theories as no one would write them, but a program or a slip of the hand might.

(in-package #:discrepancy-finder.tests)

(def-suite hostile-theories :in all)
(in-suite hostile-theories)

(defun circular (&rest elements)
  "Return a list of ELEMENTS without end."
  (let ((list (copy-list elements)))
    (setf (cdr (last list)) list)))

(defun nested (operator depth form)
  "Return FORM, DEPTH times inside of OPERATOR."
  (dotimes (level depth form)
    (setf form (list operator form))))

(defun refused (clauses &rest parts)
  "Check that the theory with CLAUSES is refused in a sentence that contains PARTS."
  (let ((report (report-of 'ec:theory-error
                           (lambda () (sb-ext:with-timeout 20 (ec::parse-theory 'bad clauses))))))
    (is (null (flaw report (cons "theory bad" parts))) "~a" report)))

(test circular-lists
  (refused (list (circular :fluents '(f))) "circular")
  (refused (list (list :fluents (circular 'f))) "circular")
  (refused (list '(:fluents (f)) (list :axioms (circular 'and '(holds-at (f) 0)))) "circular")
  (refused (list (list :sorts (circular 'place 'hall))) "circular")
  (let ((form (list 'not nil)))
    (setf (second form) form)
    (refused (list '(:fluents (f)) (list :axioms (list 'endless form))) "axiom endless" "deep")))

(test nesting
  "A hundred levels are fine; what is too deep for the stack is refused."
  (flet ((theory (depth)
           (list '(:fluents (f)) '(:time 0 0)
                 (list :axioms (list 'deep (nested 'not depth '(holds-at (f) 0)))))))
    (always (ec::parse-theory 'inline (theory 100)) (holds-at (f) 0))
    (always (ec::parse-theory 'inline (theory 101)) (not (holds-at (f) 0)))
    (refused (theory 1000000) "axiom deep" "deep"))
  (with-file (file (format nil "(define-theory bad (:fluents (f)) (:time 0 0)~%~
                                (:axioms (n ~{~a~}(holds-at (f) 0)~{~a~})))"
                           (make-list 5000 :initial-element "(not ")
                           (make-list 5000 :initial-element ")")))
    (always (ec:load-theory file) (implies (holds-at (f) 0) (holds-at (f) 0)))))

(test numbers-that-are-none
  (refused (list '(:fluents (f))
                 (list :axioms (list 'a (list 'holds-at '(f)
                                              sb-ext:double-float-positive-infinity))))
           "axiom a")
  (refused (list '(:fluents (f)) (list :axioms (list 'a (list 'holds-at '(f) #c(1 2)))))
           "axiom a" "#C(1 2)"))

(test things-that-are-neither-names-nor-lists
  (dolist (thing (list #\x #(1 2) "x" (make-hash-table) #p"x" #'car))
    (refused (list '(:fluents (f)) (list :axioms (list 'a (list 'holds-at (list 'f) thing))))
             "axiom a")
    (refused (list (list :fluents (list 'f thing))) ":fluents")
    (refused (list (list :sorts (list 'place thing))) ":sorts")
    (refused (list (list thing)) ":sorts" ":axioms")
    (refused (list '(:fluents (f)) thing) ":axioms")))

(test names-of-theories-that-are-none
  (signals-with (error "\"lamp\"") (ec::parse-theory "lamp" '((:fluents (f)))))
  (signals-with (error "3") (ec:find-theory 3))
  (signals-with (error "\"lamp\"") (ec:models "lamp")))

(test many-variables
  (flet ((theory (count)
           (list '(:sorts (s a)) '(:predicates (p s)) '(:time 0 0)
                 (list :axioms
                       (list 'wordy
                             (list 'implies
                                   (cons 'and
                                         (loop for number below count
                                               collect (list 'p (intern (format nil "?S~d" number)
                                                                        '#:keyword))))
                                   '(p a)))))))
    (is (= 2 (ec:count-models (ec::parse-theory 'inline (append (theory 60)
                                                                '((:axioms (or (p a) (not (p a)))
                                                                   (iff (p a) (q)))
                                                                  (:predicates (q))))))))
    (signals-with (ec:theory-error "axiom wordy" "64 variables")
      (ec:models (ec::parse-theory 'inline (theory 70))))))

(test huge-numbers
  "Nothing is enumerated that nobody asks for."
  (let ((theory (inline-theory (:sorts (height (:range 0 1000000000000)))
                               (:functions ((top) height)) (:predicates (p))
                               (:fluents (f))
                               (:axioms (implies (> (top) 999999999999) (holds-at (f) 0)))
                               (:facts (= (top) 1000000000000))
                               (:time 0 1))))
    (always theory (holds-at (f) 1))))

(test instances-can-be-too-many
  "A sentence, and not the end of the heap."
  (signals-with (ec:theory-error "huge" "above" "instances")
    (ec::parse-theory 'huge '((:sorts (height (:range 0 1000000000000)))
                              (:fluents (above height height)) (:time 0 1)))))

(test what-would-exhaust-the-heap-is-refused
  (flet ((refused (words theory)
           (is (search words (report-of 'ec:theory-error (lambda () (ec:consistent-p theory)))))))
    (refused "the timepoints 0 to 100000000 need some"
             (inline-theory (:fluents (on)) (:axioms (lit (holds-at (on) ?time)))
               (:time 0 100000000)))
    (refused "axiom swapped: it has more than 1000000 instances"
             (inline-theory (:sorts (number (:range 0 99)))
               (:predicates (near number number))
               (:axioms (swapped (implies (and (near ?number1 ?number2) (near ?number3 ?number4))
                                          (= ?number1 ?number4))))
               (:time 0 1)))))

(test long-atoms-are-told-apart-quickly
  "EQUAL tables of SBCL look at four elements of a list only."
  (is (< 900 (length (remove-duplicates
                      (loop for number below 1000
                            collect (ec::term-hash (list :p 0 0 0 0 number))))))))
