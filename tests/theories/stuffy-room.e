; The stuffy room scenario: an indirect effect of closing the second of two vents.
;
; Source: M. Ginsberg, D. Smith, Reasoning about action I: a possible worlds approach, 1988; in the
; event calculus: M. Shanahan, Solving the Frame Problem, 1997.
; Expected: 1 model; stuffy at 2.

load foundations/Root.e
load foundations/EC.e

sort vent
vent Vent1, Vent2

fluent Blocked(vent)
fluent Stuffy()
noninertial Stuffy
event Start()
event Close(vent)

[vent,time] vent=Vent1 -> Initiates(Start(),Blocked(vent),time).
[vent,time] vent!=Vent1 -> Terminates(Start(),Blocked(vent),time).
[vent,time] Initiates(Close(vent),Blocked(vent),time).
[time] HoldsAt(Stuffy(),time) <-> ([vent] HoldsAt(Blocked(vent),time)).

[vent] !HoldsAt(Blocked(vent),0).

Happens(Start(),0).
Happens(Close(Vent2),1).

completion Happens

range time 0 3
range offset 1 1
