; An alarm clock with a snooze button.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, exercises of chapter 4.
; Expected: 1 model; beeping at 2, not at 3 and 4, at 5, not from 6 on.

load foundations/Root.e
load foundations/EC.e

sort clock
clock Clock1

fluent AlarmOn(clock)
fluent Beeping(clock)
event StartBeeping(clock)
event Snooze(clock)
event TurnOff(clock)

[clock,time] Initiates(StartBeeping(clock),Beeping(clock),time).
[clock,time] Terminates(Snooze(clock),Beeping(clock),time).
[clock,time] Terminates(TurnOff(clock),Beeping(clock),time).
[clock,time] Terminates(TurnOff(clock),AlarmOn(clock),time).

[clock,time1,time2]
Happens(Snooze(clock),time1) & time1<time2 & time2-time1=2 & HoldsAt(AlarmOn(clock),time2) ->
Happens(StartBeeping(clock),time2).

HoldsAt(AlarmOn(Clock1),0).
!HoldsAt(Beeping(Clock1),0).

Happens(StartBeeping(Clock1),1).
Happens(Snooze(Clock1),2).
Happens(TurnOff(Clock1),5).

completion Happens

range time 0 7
range offset 1 1
