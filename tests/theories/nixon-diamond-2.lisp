;;;; The Nixon diamond: Quakers are typically pacifists, Republicans typically not.
;;;;
;;;; Source: R. Reiter, G. Criscuolo, On interacting defaults, 1981.
;;;; Expected: 1 model.  The cancellation rule makes republicans abnormal quakers, so that only the
;;;; second default applies: Nixon is no pacifist.

(define-theory nixon-diamond-2
  "Nixon is a Quaker and a Republican.  Nothing happens."
  (:sorts (person nixon))
  (:predicates (quaker person) (republican person) (pacifist person) (ab1 person) (ab2 person))
  (:axioms
   (implies (and (quaker ?person) (not (ab1 ?person))) (pacifist ?person))
   (implies (and (republican ?person) (not (ab2 ?person))) (not (pacifist ?person)))
   (republicans-are-abnormal-quakers :label theta
    (implies (republican ?person) (ab1 ?person))))
  (:facts
   (quaker nixon)
   (republican nixon))
  (:completion (theta ab1) (theta ab2))
  (:time 0 0))
