; A hot-air balloon that leaves the range of heights.
;
; Source: as hot-air-balloon; a test of ground instances that are dropped.
; Expected: 16 models: at 3 and at 4 no instance of the trajectory has a height in its range, and
; the height is 0, 1, 2 or none.

load foundations/Root.e
load foundations/EC.e
load foundations/ECTraj.e

sort height: integer

fluent HeaterOn()
fluent Height(height)
noninertial Height
event TurnHeaterOn()

[time] Initiates(TurnHeaterOn(),HeaterOn(),time).

[height,offset,time]
HoldsAt(Height(height),time) -> Trajectory(HeaterOn(),time,Height(height+offset),offset).

[height1,height2,time]
HoldsAt(Height(height1),time) & HoldsAt(Height(height2),time) -> height1=height2.

HoldsAt(Height(0),0).
!HoldsAt(HeaterOn(),0).

Happens(TurnHeaterOn(),0).

completion Happens

range time 0 4
range offset 1 4
range height 0 2
