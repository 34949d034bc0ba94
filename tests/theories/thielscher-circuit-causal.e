; Thielscher's circuit with causal constraints: indirect effects at the same timepoint.
;
; Source: M. Thielscher, Ramification and causality, 1997; E. Mueller, Commonsense Reasoning, 2006,
; chapter 6; Started, Stopped, Initiated and Terminated are Shanahan's (1999).
; Expected: 1 model; the relay is on and S2 open from 1 on; the lamp is never lit.

load foundations/Root.e
load foundations/EC.e
load foundations/ECCausal.e

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
event Activate(relay)

[switch,time] Initiates(Close(switch),Closed(switch),time).
[switch,time] Terminates(Open(switch),Closed(switch),time).
[light,time] Initiates(Light(light),Lit(light),time).
[relay,time] Initiates(Activate(relay),Activated(relay),time).

Delta: [time]
Stopped(Lit(Lamp),time) & Initiated(Closed(S1),time) & Initiated(Closed(S2),time) ->
Happens(Light(Lamp),time).

Delta: [time]
Started(Closed(S2),time) & Initiated(Activated(Relay1),time) -> Happens(Open(S2),time).

Delta: [time]
Stopped(Activated(Relay1),time) & Initiated(Closed(S1),time) & Initiated(Closed(S3),time) ->
Happens(Activate(Relay1),time).

!HoldsAt(Closed(S1),0).
HoldsAt(Closed(S2),0).
HoldsAt(Closed(S3),0).
!HoldsAt(Lit(Lamp),0).
!HoldsAt(Activated(Relay1),0).

Delta: Happens(Close(S1),0).

completion Delta Happens

range time 0 3
range offset 1 1
