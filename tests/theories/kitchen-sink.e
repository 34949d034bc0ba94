; The kitchen sink: water rises while the tap is on, until it overflows.
;
; Source: M. Shanahan, Representing continuous change in the event calculus, 1990, and The event
; calculus explained, 1999 (trajectories); the numbers are those of T.-W. Kim, J. Lee, R. Palla,
; Circumscriptive event calculus as answer set programming, 2009.
; Expected: 1 model; Overflow() at 15, and only there.

load foundations/Root.e
load foundations/EC.e
load foundations/ECTraj.e

sort height: integer

fluent Filling()
fluent Spilling()
fluent WaterLevel(height)
event TapOn()
event TapOff()
event Overflow()

[time] Initiates(TapOn(),Filling(),time).
[height,time] Releases(TapOn(),WaterLevel(height),time).
[time] Terminates(TapOff(),Filling(),time).
[height,time] HoldsAt(WaterLevel(height),time) -> Initiates(TapOff(),WaterLevel(height),time).
[time] Terminates(Overflow(),Filling(),time).
[height,time] HoldsAt(WaterLevel(height),time) -> Initiates(Overflow(),WaterLevel(height),time).
[time] Initiates(Overflow(),Spilling(),time).

[height1,height2,offset,time]
HoldsAt(WaterLevel(height1),time) & height2 = height1+offset ->
Trajectory(Filling(),time,WaterLevel(height2),offset).

[height1,height2,time]
HoldsAt(WaterLevel(height1),time) & HoldsAt(WaterLevel(height2),time) -> height1=height2.

[time] HoldsAt(WaterLevel(10),time) & HoldsAt(Filling(),time) -> Happens(Overflow(),time).

HoldsAt(WaterLevel(0),0).
!HoldsAt(Filling(),0).
!HoldsAt(Spilling(),0).

Happens(TapOn(),5).

completion Happens

range time 0 25
range offset 1 25
range height 0 10
