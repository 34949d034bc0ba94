; Two abnormality predicates that are completed over the same sentences.
;
; Source: as cancellation-by-default; a test of completion.
; Expected: 4 models: a ground clause supports each of its positive literals, so at 0 and at 1 the
; old device is abnormal in one respect or in the other.

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
Theta: [device,time] HoldsAt(Mended(device),time) -> Ab2(device,time).

[device] !HoldsAt(On(device),0).
[device] HoldsAt(OldBattery(device),0) <-> device!=NewOne.
[device] HoldsAt(Mended(device),0) <-> device=MendedOne.

Delta: [device] Happens(TurnOn(device),0).

completion Delta Happens
completion Theta Ab1
completion Theta Ab2

range time 0 1
range offset 1 1
