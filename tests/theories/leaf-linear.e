; A leaf hangs for a while and falls at a constant speed.
;
; Source: E. Mueller, A tool for satisfiability-based commonsense reasoning in the event calculus,
; 2004 (the falling leaf).
; Expected: 1 model; height 4 until 2, then 3, 2, 1, 0; HitGround(Leaf) at 6.

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
HoldsAt(Height(object,height1),time) & height2 = height1-offset ->
Trajectory(Falling(object),time,Height(object,height2),offset).

[object,height1,height2,time]
HoldsAt(Height(object,height1),time) & HoldsAt(Height(object,height2),time) ->
height1=height2.

[object,time]
HoldsAt(Falling(object),time) & HoldsAt(Height(object,0),time) ->
Happens(HitGround(object),time).

!HoldsAt(Falling(Leaf),0).
HoldsAt(Height(Leaf,4),0).

Happens(StartFalling(Leaf),2).

completion Happens

range time 0 7
range offset 1 7
range height 0 4
