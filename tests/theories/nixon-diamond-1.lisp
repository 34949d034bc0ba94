;;;; The Nixon diamond: Quakers are typically pacifists, Republicans typically not.
;;;;
;;;; Source: R. Reiter, G. Criscuolo, On interacting defaults, 1981.
;;;; Expected: 0 models.  No sentence makes anybody abnormal, so both defaults apply, and they
;;;; contradict each other: completion, unlike circumscription with its two minimal models, has
;;;; none.

(define-theory nixon-diamond-1
  "Nixon is a Quaker and a Republican.  Nothing happens."
  (:sorts (person nixon))
  (:predicates (quaker person) (republican person) (pacifist person) (ab1 person) (ab2 person))
  (:axioms
   (implies (and (quaker ?person) (not (ab1 ?person))) (pacifist ?person))
   (implies (and (republican ?person) (not (ab2 ?person))) (not (pacifist ?person))))
  (:facts
   (quaker nixon)
   (republican nixon))
  (:completion (theta ab1) (theta ab2))
  (:time 0 0))
