; A broken device is turned on: a default effect that is qualified.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 12, on default reasoning (abnormality
; predicates after J. McCarthy 1986).
; Expected: 1 model; at 1 the radio is on and the television is not.

load foundations/Root.e
load foundations/EC.e

sort agent
sort device
agent Nathan
device Television, Radio

predicate Ab1(device,time)
fluent On(device)
fluent Broken(device)
fluent PluggedIn(device)
event TurnOn(agent,device)

[agent,device,time] !Ab1(device,time) -> Initiates(TurnOn(agent,device),On(device),time).

Theta: [device,time] HoldsAt(Broken(device),time) -> Ab1(device,time).
Theta: [device,time] !HoldsAt(PluggedIn(device),time) -> Ab1(device,time).

[device] !HoldsAt(On(device),0).
[device] HoldsAt(PluggedIn(device),0).
HoldsAt(Broken(Television),0).
!HoldsAt(Broken(Radio),0).

Delta: Happens(TurnOn(Nathan,Television),0).
Delta: Happens(TurnOn(Nathan,Radio),0).

completion Delta Happens
completion Theta Ab1

range time 0 1
range offset 1 1
