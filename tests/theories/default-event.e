; A clock that is set rings later, unless something is wrong with it.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 12, on default events.
; Expected: 1 model; only Clock1 rings, at 3; at 4 Ann is awake and Ben asleep.

load foundations/Root.e
load foundations/EC.e

sort agent
sort clock
agent Ann, Ben
clock Clock1, Clock2

predicate Ab1(clock,time)
predicate ClockOf(agent,clock)
fluent Asleep(agent)
fluent BatteryEmpty(clock)
event SetClock(agent,clock)
event Ring(clock)
event WakeUp(agent)

[agent,time] Terminates(WakeUp(agent),Asleep(agent),time).

Delta: [agent,clock,time1,time2]
Happens(SetClock(agent,clock),time1) & time1<time2 & time2=time1+3 & !Ab1(clock,time2) ->
Happens(Ring(clock),time2).

Delta: [agent,clock,time]
Happens(Ring(clock),time) & ClockOf(agent,clock) & HoldsAt(Asleep(agent),time) ->
Happens(WakeUp(agent),time).

Theta: [clock,time] HoldsAt(BatteryEmpty(clock),time) -> Ab1(clock,time).

[agent,clock]
ClockOf(agent,clock) <-> (agent=Ann & clock=Clock1) | (agent=Ben & clock=Clock2).
[agent] HoldsAt(Asleep(agent),0).
[clock] HoldsAt(BatteryEmpty(clock),0) <-> clock=Clock2.

Delta: Happens(SetClock(Ann,Clock1),0).
Delta: Happens(SetClock(Ben,Clock2),0).

completion Delta Happens
completion Theta Ab1

range time 0 4
range offset 1 1
