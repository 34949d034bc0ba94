; The Nixon diamond: Quakers are typically pacifists, Republicans typically not.
;
; Source: R. Reiter, G. Criscuolo, On interacting defaults, 1981.
; Expected: 1 model.  The cancellation rule makes republicans abnormal quakers, so that only the
; second default applies: Nixon is no pacifist.

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
Theta: [person] Republican(person) -> Ab1(person).

Quaker(Nixon).
Republican(Nixon).

completion Theta Ab1
completion Theta Ab2

range time 0 0
range offset 1 1
