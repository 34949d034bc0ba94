; A counter that counts to three and begins again.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, exercises.
; Expected: 1 model; values 0, 1, 2, 3, 0, 1 at 0 to 5, 0 at 6; overflown from 4 on.

load foundations/Root.e
load foundations/EC.e

sort counter
sort value: integer
counter Counter1

fluent Count(counter,value)
fluent Overflown(counter)
event Increment(counter)
event Reset(counter)

[counter,value,time]
HoldsAt(Count(counter,value),time) ->
Initiates(Increment(counter),Count(counter,(value+1)%4),time).
[counter,value,time]
HoldsAt(Count(counter,value),time) -> Terminates(Increment(counter),Count(counter,value),time).
[counter,time]
HoldsAt(Count(counter,3),time) -> Initiates(Increment(counter),Overflown(counter),time).
[counter,time] Initiates(Reset(counter),Count(counter,0),time).
[counter,value,time]
HoldsAt(Count(counter,value),time) & value!=0 ->
Terminates(Reset(counter),Count(counter,value),time).

[value] HoldsAt(Count(Counter1,value),0) <-> value=0.
!HoldsAt(Overflown(Counter1),0).

[time] time<5 -> Happens(Increment(Counter1),time).
Happens(Reset(Counter1),5).

completion Happens

range time 0 6
range offset 1 1
range value 0 3
