; A leaf falls faster and faster.
;
; Source: E. Mueller, Event calculus reasoning through satisfiability, 2004 (the falling leaf).
; Expected: 1 model; heights 9, 8, 5, 0 at 0 to 3; HitGround(Leaf) at 3.

load foundations/Root.e
load foundations/EC.e
load foundations/ECTraj.e

sort object
sort height: integer
object Leaf

fluent Falling(object)
fluent Height(object,height)
event StartFalling(object)
event HitGround(object)

[object,time] Initiates(StartFalling(object),Falling(object),time).
[object,height,time] Releases(StartFalling(object),Height(object,height),time).
[object,time] Terminates(HitGround(object),Falling(object),time).
[object,height,time]
HoldsAt(Height(object,height),time) -> Initiates(HitGround(object),Height(object,height),time).

[object,height1,height2,offset,time]
HoldsAt(Height(object,height1),time) & height2 = height1-offset*offset ->
Trajectory(Falling(object),time,Height(object,height2),offset).

[object,height1,height2,time]
HoldsAt(Height(object,height1),time) & HoldsAt(Height(object,height2),time) ->
height1=height2.

[object,time]
HoldsAt(Falling(object),time) & HoldsAt(Height(object,0),time) ->
Happens(HitGround(object),time).

!HoldsAt(Falling(Leaf),0).
HoldsAt(Height(Leaf,9),0).

Happens(StartFalling(Leaf),0).

completion Happens

range time 0 4
range offset 1 4
range height 0 9
