; The kitchen sink with its rim at 3.
;
; Source: E. Mueller, G. Sutcliffe, Reasoning in the event calculus using first-order automated
; theorem proving, 2005: problems CSR001 to CSR014 of the TPTP library; the domain is Shanahan's.
; Expected: 1 model; levels 1, 2, 3 at 1, 2, 3; Overflow() at 3; spilling, not filling, level 3 at
; 4.

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

[time] HoldsAt(WaterLevel(3),time) & HoldsAt(Filling(),time) -> Happens(Overflow(),time).

HoldsAt(WaterLevel(0),0).
!HoldsAt(Filling(),0).
!HoldsAt(Spilling(),0).

Happens(TapOn(),0).

completion Happens

range time 0 5
range offset 1 5
range height 0 4
