; A commuter turns back once and gets to work at the second attempt: a compound event.
;
; Source: M. Shanahan, The event calculus explained, 1999, on compound events (the commuter).
; Expected: 1 model; Journey(3,5), and no other journey: that from 0 is clipped at 1.

load foundations/Root.e
load foundations/EC.e
load foundations/ECTraj.e

predicate Journey(time,time)
fluent Travelling()
fluent AtWork()
event Leave()
event TurnBack()
event Arrive()

[time] Initiates(Leave(),Travelling(),time).
[time] Terminates(TurnBack(),Travelling(),time).
[time] Terminates(Arrive(),Travelling(),time).
[time] Initiates(Arrive(),AtWork(),time).
[time] Happens(Arrive(),time) -> HoldsAt(Travelling(),time).

[time1,time2]
Journey(time1,time2) <->
Happens(Leave(),time1) & Happens(Arrive(),time2) & time1<time2 &
!Clipped(time1,Travelling(),time2).

!HoldsAt(Travelling(),0).
!HoldsAt(AtWork(),0).

Delta: Happens(Leave(),0).
Delta: Happens(TurnBack(),1).
Delta: Happens(Leave(),3).
Delta: Happens(Arrive(),5).

completion Delta Happens

range time 0 6
range offset 1 1
