; A derived fluent that is left inertial.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 2, on inconsistency in the event
; calculus.
; Expected: 0 models: G is false at 1 by inertia and true at 1 by the constraint.

load foundations/Root.e
load foundations/EC.e

fluent F()
fluent G()
event E()

[time] Initiates(E(),F(),time).
[time] HoldsAt(F(),time) <-> HoldsAt(G(),time).

!HoldsAt(F(),0).

Happens(E(),0).

completion Happens

range time 0 1
range offset 1 1
