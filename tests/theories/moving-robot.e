; A robot with two wheels.
;
; Source: M. Shanahan, Solving the Frame Problem, 1997, on concurrent events (the robot with two
; wheels of his and R. Miller's); E. Mueller, Commonsense Reasoning, 2006, chapter 8.
; Expected: 1 model; Location(Robot1,2,1) and Direction(Robot1,1) at 3.

load foundations/Root.e
load foundations/EC.e

sort robot
sort direction: integer
sort coordinate: integer
sort step: integer
robot Robot1

function East(direction): step
function West(direction): step
function North(direction): step
function South(direction): step

fluent Direction(robot,direction)
fluent Location(robot,coordinate,coordinate)
event MoveLeftWheel(robot)
event MoveRightWheel(robot)

; The steps of the directions 0 east, 1 north, 2 west, 3 south.
East(0)=1.
East(1)=0.
East(2)=0.
East(3)=0.
West(0)=0.
West(1)=0.
West(2)=1.
West(3)=0.
North(0)=0.
North(1)=1.
North(2)=0.
North(3)=0.
South(0)=0.
South(1)=0.
South(2)=0.
South(3)=1.

; The right wheel alone turns left, the left wheel alone turns right.
[robot,direction1,direction2,time]
!Happens(MoveLeftWheel(robot),time) & HoldsAt(Direction(robot,direction1),time) &
direction2 = (direction1+1)%4 ->
Initiates(MoveRightWheel(robot),Direction(robot,direction2),time).

[robot,direction,time]
!Happens(MoveLeftWheel(robot),time) & HoldsAt(Direction(robot,direction),time) ->
Terminates(MoveRightWheel(robot),Direction(robot,direction),time).

[robot,direction1,direction2,time]
!Happens(MoveRightWheel(robot),time) & HoldsAt(Direction(robot,direction1),time) &
direction2 = (direction1+3)%4 ->
Initiates(MoveLeftWheel(robot),Direction(robot,direction2),time).

[robot,direction,time]
!Happens(MoveRightWheel(robot),time) & HoldsAt(Direction(robot,direction),time) ->
Terminates(MoveLeftWheel(robot),Direction(robot,direction),time).

; Both wheels move forwards.
[robot,direction,coordinate1,coordinate2,coordinate3,coordinate4,time]
Happens(MoveLeftWheel(robot),time) &
HoldsAt(Location(robot,coordinate1,coordinate2),time) &
HoldsAt(Direction(robot,direction),time) &
coordinate3 = coordinate1+East(direction)-West(direction) &
coordinate4 = coordinate2+North(direction)-South(direction) ->
Initiates(MoveRightWheel(robot),Location(robot,coordinate3,coordinate4),time).

[robot,coordinate1,coordinate2,time]
Happens(MoveLeftWheel(robot),time) & HoldsAt(Location(robot,coordinate1,coordinate2),time) ->
Terminates(MoveRightWheel(robot),Location(robot,coordinate1,coordinate2),time).

[robot,direction1,direction2,time]
HoldsAt(Direction(robot,direction1),time) & HoldsAt(Direction(robot,direction2),time) ->
direction1=direction2.

[robot,coordinate1,coordinate2,coordinate3,coordinate4,time]
HoldsAt(Location(robot,coordinate1,coordinate2),time) &
HoldsAt(Location(robot,coordinate3,coordinate4),time) ->
coordinate1=coordinate3 & coordinate2=coordinate4.

HoldsAt(Location(Robot1,1,0),0).
HoldsAt(Direction(Robot1,0),0).

Happens(MoveLeftWheel(Robot1),0).
Happens(MoveRightWheel(Robot1),0).
Happens(MoveRightWheel(Robot1),1).
Happens(MoveLeftWheel(Robot1),2).
Happens(MoveRightWheel(Robot1),2).

completion Happens

range time 0 3
range offset 1 1
range direction 0 3
range coordinate 0 3
range step 0 1
