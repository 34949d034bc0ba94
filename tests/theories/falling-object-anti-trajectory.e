; An apple loses its support and falls to the ground: falling as an antitrajectory.
;
; Source: E. Mueller, Event calculus reasoning through satisfiability, 2004 (falling object with an
; antitrajectory); antitrajectories are R. Miller's and M. Shanahan's, 1999.
; Expected: 1 model; heights 3, 2, 1, 0 at 0 to 3; HitGround(Apple) at 3; not falling at 4.

load foundations/Root.e
load foundations/EC.e
load foundations/ECTraj.e

sort object
sort height: integer
object Apple

fluent Supported(object)
fluent Height(object,height)
fluent Falling(object)
noninertial Falling
event LetGo(object)
event HitGround(object)

[object,time] Terminates(LetGo(object),Supported(object),time).
[object,height,time] Releases(LetGo(object),Height(object,height),time).
[object,time] Initiates(HitGround(object),Supported(object),time).
[object,height,time]
HoldsAt(Height(object,height),time) -> Initiates(HitGround(object),Height(object,height),time).

[object,time] HoldsAt(Falling(object),time) <-> !HoldsAt(Supported(object),time).

[object,height1,height2,offset,time]
HoldsAt(Height(object,height1),time) & height2 = height1-offset ->
AntiTrajectory(Supported(object),time,Height(object,height2),offset).

[object,height1,height2,time]
HoldsAt(Height(object,height1),time) & HoldsAt(Height(object,height2),time) ->
height1=height2.

[object,time]
HoldsAt(Falling(object),time) & HoldsAt(Height(object,0),time) ->
Happens(HitGround(object),time).

HoldsAt(Supported(Apple),0).
HoldsAt(Height(Apple,3),0).

Happens(LetGo(Apple),0).

completion Happens

range time 0 5
range offset 1 5
range height 0 3
