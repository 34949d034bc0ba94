; A workflow: sequence, parallel split, join, choice.
;
; Source: N. K. Cicekli, Y. Yildirim, Formalizing workflows using the event calculus, 2000; E.
; Mueller, Commonsense Reasoning, 2006, chapter 14.
; Expected: 1 model: A 0-1, B 2-3 and C 2-4, D 5-6, E 7-8.

load foundations/Root.e
load foundations/EC.e

sort activity
activity A, B, C, D, E, F

fluent Active(activity)
fluent Completed(activity)
fluent Urgent()
event Start(activity)
event End(activity)

[activity,time] Initiates(Start(activity),Active(activity),time).
[activity,time] Terminates(End(activity),Active(activity),time).
[activity,time] Initiates(End(activity),Completed(activity),time).

[activity,time]
Happens(Start(activity),time-1) & activity!=C -> Happens(End(activity),time).

[time] Happens(Start(C),time-2) -> Happens(End(C),time).

[activity,time]
Happens(End(A),time-1) & (activity=B | activity=C) -> Happens(Start(activity),time).

[time]
HoldsAt(Completed(B),time) & HoldsAt(Completed(C),time) &
!(HoldsAt(Completed(B),time-1) & HoldsAt(Completed(C),time-1)) ->
Happens(Start(D),time).

[time] Happens(End(D),time-1) & HoldsAt(Urgent(),time) -> Happens(Start(E),time).
[time] Happens(End(D),time-1) & !HoldsAt(Urgent(),time) -> Happens(Start(F),time).

HoldsAt(Urgent(),0).
[activity] !HoldsAt(Active(activity),0).
[activity] !HoldsAt(Completed(activity),0).

Happens(Start(A),0).

completion Happens

range time 0 9
range offset 1 1
