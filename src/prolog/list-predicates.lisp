;;;; Built-in predicates about lists.  Lazy lists are lists, and computed as far as it is needed.

(in-package #:discrepancy-finder.prolog)

(defun try-elements (proof term list next)
  "Unify TERM with the first element of LIST, with the others as a choice.  A list that ends in an
unbound variable goes on for ever."
  (let ((cell (deref list)))
    (when (variable-p cell)
      (let ((longer (cons (make-variable '?element) (make-variable '?rest))))
        (assign proof cell longer)
        (setf cell longer)))
    (when (consp cell)
      (let ((others (variable-target (cdr cell))))
        (when others
          (push-choice proof (make-frame (list (lambda (proof next)
                                                 (try-elements proof term others next)))
                                         nil nil next)))
        (when (unify-terms proof term (car cell))
          (setf (proof-frame proof) next)
          t)))))

(define-control member (proof barrier next) (element list)
  "The element is in the list; true once for each place where it is."
  (try-elements proof element list next))

(def-fact-group lists ()
  (<- (append () ?list ?list))
  (<- (append (?first . ?rest) ?list (?first . ?more))
    (append ?rest ?list ?more)))

(setf (documentation 'append 'predicate)
      "(append first second list): the list has the elements of the first and then those of the
second list; each of the three may be unknown.")

(define-test length (proof) (list number)
  "The list has that number of elements.  If the list ends in an unbound variable, it gets as many
elements as the number asks for."
  (let* ((count 0)
         (end (loop for cell = (deref list) then (deref (cdr cell))
                    while (consp cell) do (incf count)
                    finally (return cell)))
         (wanted (deref number)))
    (cond ((null end) (unify-terms proof number count))
          ((and (variable-p end) (integerp wanted) (>= wanted count))
           (unify-terms proof end (loop repeat (- wanted count)
                                        collect (make-variable '?element)))))))

(defun extreme (function arguments)
  "Return the value of FUNCTION, MIN or MAX, for ARGUMENTS, numbers or one list of them."
  (reduce function (if (and (null (rest arguments)) (listp (first arguments)))
                       (force-ll (first arguments))
                       arguments)))

(define-test max (proof) (number-or-list &rest numbers-and-result)
  "The last argument is the greatest of the numbers before, or of the list of numbers before."
  (let ((all (cons number-or-list numbers-and-result)))
    (unify-value proof 'max (lambda (&rest numbers) (extreme #'max numbers))
                 (butlast all) (first (last all)))))

(define-test min (proof) (number-or-list &rest numbers-and-result)
  "The last argument is the least of the numbers before, or of the list of numbers before."
  (let ((all (cons number-or-list numbers-and-result)))
    (unify-value proof 'min (lambda (&rest numbers) (extreme #'min numbers))
                 (butlast all) (first (last all)))))

(define-test reduce (proof) (function list result)
  "The result is that of REDUCE."
  (unify-value proof 'reduce
               (lambda (function list) (reduce (function-of function) (force-ll list)))
               (list function list) result))

(define-test sort (proof) (list predicate sorted)
  "The third argument is the list in the order by the Lisp predicate; equal elements keep theirs."
  (unify-value proof 'sort
               (lambda (list predicate)
                 (stable-sort (copy-list (force-ll list)) (function-of predicate)))
               (list list predicate) sorted))
