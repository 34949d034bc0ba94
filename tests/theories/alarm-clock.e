; An alarm clock is set and beeps at the time it is set to.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 4, on triggered events.
; Expected: 1 model; StartBeeping(Clock1) at 2, and only there; beeping at 3, not at 4.

load foundations/Root.e
load foundations/EC.e

sort clock
clock Clock1

fluent AlarmTime(clock,time)
fluent AlarmOn(clock)
fluent Beeping(clock)
event SetAlarmTime(clock,time)
event TurnOnAlarm(clock)
event TurnOffAlarm(clock)
event StartBeeping(clock)

[clock,time,time2] Initiates(SetAlarmTime(clock,time2),AlarmTime(clock,time2),time).

[clock,time,time1,time2]
HoldsAt(AlarmTime(clock,time1),time) & time1!=time2 ->
Terminates(SetAlarmTime(clock,time2),AlarmTime(clock,time1),time).

[clock,time] Initiates(TurnOnAlarm(clock),AlarmOn(clock),time).
[clock,time] Terminates(TurnOffAlarm(clock),AlarmOn(clock),time).
[clock,time] Initiates(StartBeeping(clock),Beeping(clock),time).
[clock,time] Terminates(TurnOffAlarm(clock),Beeping(clock),time).

[clock,time,time1,time2]
HoldsAt(AlarmTime(clock,time1),time) & HoldsAt(AlarmTime(clock,time2),time) -> time1=time2.

[clock,time]
HoldsAt(AlarmTime(clock,time),time) & HoldsAt(AlarmOn(clock),time) ->
Happens(StartBeeping(clock),time).

HoldsAt(AlarmTime(Clock1,0),0).
!HoldsAt(AlarmOn(Clock1),0).
!HoldsAt(Beeping(Clock1),0).

Happens(SetAlarmTime(Clock1,2),0).
Happens(TurnOnAlarm(Clock1),1).
Happens(TurnOffAlarm(Clock1),3).

completion Happens

range time 0 4
range offset 1 1
