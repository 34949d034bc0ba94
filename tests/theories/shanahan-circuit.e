; A circuit with a light and a relay that opens a switch of the light's loop.
;
; Source: M. Shanahan, The event calculus explained, 1999; E. Mueller, Commonsense Reasoning, 2006,
; chapter 6, as trigger axioms.
; Expected: 1 model; lit and activated at 2, Open(S2) at 2, S2 open at 3, both off at 4.

load foundations/Root.e
load foundations/EC.e

sort switch
sort light
sort relay
switch S1, S2, S3
light Lamp
relay Relay1

fluent Closed(switch)
fluent Lit(light)
fluent Activated(relay)
event Close(switch)
event Open(switch)
event Light(light)
event Unlight(light)
event Activate(relay)
event Deactivate(relay)

[switch,time] Initiates(Close(switch),Closed(switch),time).
[switch,time] Terminates(Open(switch),Closed(switch),time).
[light,time] Initiates(Light(light),Lit(light),time).
[light,time] Terminates(Unlight(light),Lit(light),time).
[relay,time] Initiates(Activate(relay),Activated(relay),time).
[relay,time] Terminates(Deactivate(relay),Activated(relay),time).

Delta: [light,time]
!HoldsAt(Lit(light),time) & ([switch] HoldsAt(Closed(switch),time)) -> Happens(Light(light),time).

Delta: [light,time]
HoldsAt(Lit(light),time) & ({switch} !HoldsAt(Closed(switch),time)) ->
Happens(Unlight(light),time).

Delta: [relay,time]
!HoldsAt(Activated(relay),time) & ([switch] HoldsAt(Closed(switch),time)) ->
Happens(Activate(relay),time).

Delta: [relay,time]
HoldsAt(Activated(relay),time) & ({switch} !HoldsAt(Closed(switch),time)) ->
Happens(Deactivate(relay),time).

Delta: [time]
HoldsAt(Closed(S2),time) & HoldsAt(Activated(Relay1),time) -> Happens(Open(S2),time).

!HoldsAt(Closed(S1),0) & HoldsAt(Closed(S2),0) & HoldsAt(Closed(S3),0).
!HoldsAt(Lit(Lamp),0) & !HoldsAt(Activated(Relay1),0).

Delta: Happens(Close(S1),0).

completion Delta Happens

range time 0 5
range offset 1 1
