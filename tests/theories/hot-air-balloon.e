; A hot-air balloon rises while its heater is on and sinks while it is off.
;
; Source: R. Miller, M. Shanahan, The event calculus in classical logic, 1999 (antitrajectories); E.
; Mueller, Commonsense Reasoning, 2006, chapter 7.
; Expected: 1 model; heights 0, 1, 2, 1 at 0 to 3.

load foundations/Root.e
load foundations/EC.e
load foundations/ECTraj.e

sort balloon
sort height: integer
balloon Montgolfier

fluent HeaterOn(balloon)
fluent Height(balloon,height)
noninertial Height
event TurnHeaterOn(balloon)
event TurnHeaterOff(balloon)

[balloon,time] Initiates(TurnHeaterOn(balloon),HeaterOn(balloon),time).
[balloon,time] Terminates(TurnHeaterOff(balloon),HeaterOn(balloon),time).

[balloon,height1,height2,offset,time]
HoldsAt(Height(balloon,height1),time) & height2 = height1+offset ->
Trajectory(HeaterOn(balloon),time,Height(balloon,height2),offset).

[balloon,height1,height2,offset,time]
HoldsAt(Height(balloon,height1),time) & height2 = height1-offset ->
AntiTrajectory(HeaterOn(balloon),time,Height(balloon,height2),offset).

[balloon,height1,height2,time]
HoldsAt(Height(balloon,height1),time) & HoldsAt(Height(balloon,height2),time) ->
height1=height2.

HoldsAt(Height(Montgolfier,0),0).
!HoldsAt(HeaterOn(Montgolfier),0).

Happens(TurnHeaterOn(Montgolfier),0).
Happens(TurnHeaterOff(Montgolfier),2).

completion Happens

range time 0 3
range offset 1 3
range height 0 4
