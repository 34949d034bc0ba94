; Thielscher's circuit with causal constraints in both directions.
;
; Source: M. Shanahan, The ramification problem in the event calculus, 1999; the circuit is M.
; Thielscher's, Ramification and causality, 1997.
; Expected: 1 model: relay on and second switch open from 1 on, the light never on.

option encoding 3
load foundations/Root.e
load foundations/EC.e
load foundations/ECCausal.e

fluent Switch1()
fluent Switch2()
fluent Switch3()
fluent Relay()
fluent Light()
event Close1()
event Open1()
event Close2()
event Open2()
event LightOn()
event LightOff()
event RelayOn()
event RelayOff()

[time] Initiates(Close1(),Switch1(),time).
[time] Terminates(Open1(),Switch1(),time).
[time] Initiates(Close2(),Switch2(),time).
[time] Terminates(Open2(),Switch2(),time).
[time] Initiates(LightOn(),Light(),time).
[time] Terminates(LightOff(),Light(),time).
[time] Initiates(RelayOn(),Relay(),time).
[time] Terminates(RelayOff(),Relay(),time).

Delta: [time]
Stopped(Light(),time) & Initiated(Switch1(),time) & Initiated(Switch2(),time) ->
Happens(LightOn(),time).

Delta: [time]
Started(Light(),time) & (Terminated(Switch1(),time) | Terminated(Switch2(),time)) ->
Happens(LightOff(),time).

Delta: [time]
Stopped(Relay(),time) & Initiated(Switch1(),time) & Initiated(Switch3(),time) ->
Happens(RelayOn(),time).

Delta: [time]
Started(Relay(),time) & (Terminated(Switch1(),time) | Terminated(Switch3(),time)) ->
Happens(RelayOff(),time).

Delta: [time] Started(Switch2(),time) & Initiated(Relay(),time) -> Happens(Open2(),time).

!HoldsAt(Switch1(),0) & HoldsAt(Switch2(),0) & HoldsAt(Switch3(),0).
!HoldsAt(Relay(),0) & !HoldsAt(Light(),0).

Delta: Happens(Close1(),0).

completion Delta Happens

range time 0 3
range offset 1 1
