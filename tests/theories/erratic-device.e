; An erratic device is turned on: it works or it does not.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 12, on default reasoning.
; Expected: 2 models: on, or abnormal and off, at 1.

load foundations/Root.e
load foundations/EC.e

sort agent
sort device
agent Nathan
device Device1

predicate Ab1(device,time)
fluent On(device)
fluent Erratic(device)
fluent Fails(device)
noninertial Fails
event TurnOn(agent,device)

[agent,device,time] !Ab1(device,time) -> Initiates(TurnOn(agent,device),On(device),time).

Theta: [device,time]
HoldsAt(Erratic(device),time) & HoldsAt(Fails(device),time) -> Ab1(device,time).

[device] !HoldsAt(On(device),0).
[device] HoldsAt(Erratic(device),0).
[device] HoldsAt(Fails(device),1).

Delta: Happens(TurnOn(Nathan,Device1),0).

completion Delta Happens
completion Theta Ab1

range time 0 1
range offset 1 1
