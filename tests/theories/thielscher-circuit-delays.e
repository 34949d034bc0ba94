; Thielscher's circuit with trigger axioms: every effect takes a timepoint.
;
; Source: M. Thielscher, Ramification and causality, 1997; E. Mueller, Commonsense Reasoning, 2006,
; chapter 6, where this writing shows what causal constraints are needed for.
; Expected: 1 model, with the anomaly that the lamp is lit at 2 and 3; off at 4.

load foundations/Root.e
load foundations/EC.e

sort switch
switch S1, S2, S3

fluent Closed(switch)
fluent Lit()
fluent Activated()
event Close(switch)
event Open(switch)
event Light()
event Unlight()
event Activate()
event Deactivate()

[switch,time] Initiates(Close(switch),Closed(switch),time).
[switch,time] Terminates(Open(switch),Closed(switch),time).
[time] Initiates(Light(),Lit(),time).
[time] Terminates(Unlight(),Lit(),time).
[time] Initiates(Activate(),Activated(),time).
[time] Terminates(Deactivate(),Activated(),time).

[time]
!HoldsAt(Lit(),time) & HoldsAt(Closed(S1),time) & HoldsAt(Closed(S2),time) ->
Happens(Light(),time).

[time]
HoldsAt(Lit(),time) & (!HoldsAt(Closed(S1),time) | !HoldsAt(Closed(S2),time)) ->
Happens(Unlight(),time).

[time]
!HoldsAt(Activated(),time) & HoldsAt(Closed(S1),time) & HoldsAt(Closed(S3),time) ->
Happens(Activate(),time).

[time]
HoldsAt(Activated(),time) & (!HoldsAt(Closed(S1),time) | !HoldsAt(Closed(S3),time)) ->
Happens(Deactivate(),time).

[time] HoldsAt(Activated(),time) & HoldsAt(Closed(S2),time) -> Happens(Open(S2),time).

!HoldsAt(Closed(S1),0) & HoldsAt(Closed(S2),0) & HoldsAt(Closed(S3),0).
!HoldsAt(Lit(),0) & !HoldsAt(Activated(),0).

Happens(Close(S1),0).

completion Happens

range time 0 5
range offset 1 1
