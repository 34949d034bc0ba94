; Happiness as a derived fluent.
;
; Source: M. Shanahan, The event calculus explained, 1999, on state constraints.
; Expected: 1 model; Fred is happy at 2.

load foundations/Root.e
load foundations/EC.e

sort person
person Fred

fluent Hungry(person)
fluent Cold(person)
fluent Happy(person)
noninertial Happy
event Feed(person)
event Clothe(person)

[person,time]
HoldsAt(Happy(person),time) <->
!HoldsAt(Hungry(person),time) & !HoldsAt(Cold(person),time).

[person,time] Terminates(Feed(person),Hungry(person),time).
[person,time] Terminates(Clothe(person),Cold(person),time).

HoldsAt(Hungry(Fred),0).
!HoldsAt(Cold(Fred),0).

Delta: Happens(Feed(Fred),1).

completion Delta Happens

range time 0 2
range offset 1 1
