; The Nixon diamond: Quakers are typically pacifists, Republicans typically not.
;
; Source: R. Reiter, G. Criscuolo, On interacting defaults, 1981.
; Expected: 0 models.  No sentence makes anybody abnormal, so both defaults apply, and they
; contradict each other: completion, unlike circumscription with its two minimal models, has none.

load foundations/Root.e
load foundations/EC.e

sort person
person Nixon

predicate Quaker(person)
predicate Republican(person)
predicate Pacifist(person)
predicate Ab1(person)
predicate Ab2(person)

[person] Quaker(person) & !Ab1(person) -> Pacifist(person).
[person] Republican(person) & !Ab2(person) -> !Pacifist(person).

Quaker(Nixon).
Republican(Nixon).

completion Theta Ab1
completion Theta Ab2

range time 0 0
range offset 1 1
