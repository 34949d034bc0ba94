; The monkey and the bananas: planning.
;
; Source: J. McCarthy 1963; E. Giunchiglia, J. Lee, V. Lifschitz, N. McCain, H. Turner, Nonmonotonic
; causal theories, 2004.
; Expected: 1 model: Walk(L3), PushBox(L2), ClimbOn(), GraspBananas() at 0 to 3.

load foundations/Root.e
load foundations/EC.e

sort object
sort place
object Monkey, Bananas, Box
place L1, L2, L3

fluent At(object,place)
fluent OnBox()
fluent HasBananas()
event Walk(place)
event PushBox(place)
event ClimbOn()
event ClimbOff()
event GraspBananas()

[object,place1,place2,time]
HoldsAt(At(object,place1),time) & HoldsAt(At(object,place2),time) -> place1=place2.

[place,time]
HoldsAt(OnBox(),time) & HoldsAt(At(Box,place),time) -> HoldsAt(At(Monkey,place),time).

[place,time]
HoldsAt(HasBananas(),time) & HoldsAt(At(Monkey,place),time) -> HoldsAt(At(Bananas,place),time).

[place,time] Initiates(Walk(place),At(Monkey,place),time).
[place1,place2,time] place1!=place2 -> Terminates(Walk(place1),At(Monkey,place2),time).
[place,time]
Happens(Walk(place),time) -> !HoldsAt(At(Monkey,place),time) & !HoldsAt(OnBox(),time).

[place,time] Initiates(PushBox(place),At(Box,place),time).
[place,time] Initiates(PushBox(place),At(Monkey,place),time).
[place1,place2,time] place1!=place2 -> Terminates(PushBox(place1),At(Box,place2),time).
[place1,place2,time] place1!=place2 -> Terminates(PushBox(place1),At(Monkey,place2),time).
[place,time]
Happens(PushBox(place),time) ->
({place1} HoldsAt(At(Monkey,place1),time) & HoldsAt(At(Box,place1),time)) &
!HoldsAt(At(Monkey,place),time) &
!HoldsAt(OnBox(),time).

[time] Initiates(ClimbOn(),OnBox(),time).
[time]
Happens(ClimbOn(),time) ->
!HoldsAt(OnBox(),time) &
({place} HoldsAt(At(Monkey,place),time) & HoldsAt(At(Box,place),time)).

[time] Terminates(ClimbOff(),OnBox(),time).
[time] Happens(ClimbOff(),time) -> HoldsAt(OnBox(),time).

[time] Initiates(GraspBananas(),HasBananas(),time).
[place,time] Releases(GraspBananas(),At(Bananas,place),time).
[time]
Happens(GraspBananas(),time) ->
!HoldsAt(HasBananas(),time) &
HoldsAt(OnBox(),time) &
({place} HoldsAt(At(Monkey,place),time) & HoldsAt(At(Bananas,place),time)).

[event1,event2,time] Happens(event1,time) & Happens(event2,time) -> event1=event2.

HoldsAt(At(Monkey,L1),0).
HoldsAt(At(Bananas,L2),0).
HoldsAt(At(Box,L3),0).
!HoldsAt(OnBox(),0).
!HoldsAt(HasBananas(),0).
HoldsAt(HasBananas(),4).

range time 0 4
range offset 1 1
