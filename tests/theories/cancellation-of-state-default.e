; A default state constraint, cancelled by a strict exception.
;
; Source: R. Reiter, G. Criscuolo, On interacting defaults, 1981; E. Mueller, Commonsense Reasoning,
; 2006, chapter 12, on the ways to write defaults and their cancellation.
; Expected: 1 model; Kim is employed at 0 and not at 1, Lou at both.

load foundations/Root.e
load foundations/EC.e

sort person
person Kim, Lou

predicate Ab1(person,time)
fluent Adult(person)
fluent Student(person)
fluent Employed(person)
noninertial Employed
event Enrol(person)

[person,time] Initiates(Enrol(person),Student(person),time).

[person,time]
HoldsAt(Adult(person),time) & !Ab1(person,time) -> HoldsAt(Employed(person),time).

[person,time] HoldsAt(Student(person),time) -> !HoldsAt(Employed(person),time).

Theta: [person,time] HoldsAt(Student(person),time) -> Ab1(person,time).

[person] HoldsAt(Adult(person),0).
[person] !HoldsAt(Student(person),0).

Delta: Happens(Enrol(Kim),0).

completion Delta Happens
completion Theta Ab1

range time 0 1
range offset 1 1
