; An apple is dropped and hits the ground.
;
; Source: E. Mueller, Event calculus reasoning through satisfiability, 2004, and Commonsense
; Reasoning, 2006, chapter 7; M. Shanahan 1990.
; Expected: 1 model; heights 3, 2, 1, 0 at 0 to 3; HitGround(Apple) at 3; not falling at 4.

load foundations/Root.e
load foundations/EC.e
load foundations/ECTraj.e

sort agent
sort object
sort height: integer
agent Nathan
object Apple

fluent Falling(object)
fluent Height(object,height)
event Drop(agent,object)
event HitGround(object)

[agent,object,time] Initiates(Drop(agent,object),Falling(object),time).
[agent,object,height,time] Releases(Drop(agent,object),Height(object,height),time).
[object,time] Terminates(HitGround(object),Falling(object),time).
[object,height,time]
HoldsAt(Height(object,height),time) -> Initiates(HitGround(object),Height(object,height),time).

[object,height1,height2,offset,time]
HoldsAt(Height(object,height1),time) & height2 = height1-offset ->
Trajectory(Falling(object),time,Height(object,height2),offset).

[object,height1,height2,time]
HoldsAt(Height(object,height1),time) & HoldsAt(Height(object,height2),time) ->
height1=height2.

Delta: [object,time]
HoldsAt(Falling(object),time) & HoldsAt(Height(object,0),time) ->
Happens(HitGround(object),time).

!HoldsAt(Falling(Apple),0).
HoldsAt(Height(Apple,3),0).

Delta: Happens(Drop(Nathan,Apple),0).

completion Delta Happens

range time 0 5
range offset 1 5
range height 0 3
