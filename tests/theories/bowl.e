; A bowl of soup is lifted at both sides at once.
;
; Source: M. Gelfond, V. Lifschitz, A. Rabinov, What are the limitations of the situation calculus?,
; 1991; in the event calculus: R. Miller, M. Shanahan, 1999.
; Expected: 1 model; raised, not spilt, at 1.

load foundations/Root.e
load foundations/EC.e

sort vessel
vessel Bowl

fluent Raised(vessel)
fluent Spilt(vessel)
event LiftLeft(vessel)
event LiftRight(vessel)

[vessel,time]
Happens(LiftRight(vessel),time) -> Initiates(LiftLeft(vessel),Raised(vessel),time).
[vessel,time]
!Happens(LiftRight(vessel),time) -> Initiates(LiftLeft(vessel),Spilt(vessel),time).
[vessel,time]
!Happens(LiftLeft(vessel),time) -> Initiates(LiftRight(vessel),Spilt(vessel),time).

!HoldsAt(Raised(Bowl),0).
!HoldsAt(Spilt(Bowl),0).

Happens(LiftLeft(Bowl),0).
Happens(LiftRight(Bowl),0).

completion Happens

range time 0 1
range offset 1 1
