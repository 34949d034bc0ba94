; A default whose exception is itself a default, with an exception of its own.
;
; Source: J. McCarthy, Applications of circumscription to formalizing common-sense knowledge, 1986
; (birds, ostriches); E. Mueller, Commonsense Reasoning, 2006, chapter 12, on cancellation.
; Expected: 1 model; at 1 the new and the mended device are on, the old one is not.

load foundations/Root.e
load foundations/EC.e

sort device
device NewOne, OldOne, MendedOne

predicate Ab1(device,time)
predicate Ab2(device,time)
fluent On(device)
fluent OldBattery(device)
fluent Mended(device)
event TurnOn(device)

[device,time] !Ab1(device,time) -> Initiates(TurnOn(device),On(device),time).

Theta: [device,time] HoldsAt(OldBattery(device),time) & !Ab2(device,time) -> Ab1(device,time).
Theta2: [device,time] HoldsAt(Mended(device),time) -> Ab2(device,time).

[device] !HoldsAt(On(device),0).
[device] HoldsAt(OldBattery(device),0) <-> device!=NewOne.
[device] HoldsAt(Mended(device),0) <-> device=MendedOne.

Delta: [device] Happens(TurnOn(device),0).

completion Delta Happens
completion Theta Ab1
completion Theta2 Ab2

range time 0 1
range offset 1 1
