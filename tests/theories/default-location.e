; Things are where they usually are, unless they are lent.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 12, on default reasoning about state.
; Expected: 1 model; the television is in the living room and on at 1, the radio is off.

load foundations/Root.e
load foundations/EC.e

sort object
sort agent: object
sort device: object
sort room
agent Nathan
device Television, Radio
room LivingRoom, Bedroom

function UsualRoom(device): room
predicate Ab1(device,time)
predicate Lent(device)
fluent InRoom(object,room)
fluent On(device)
event TurnOn(agent,device)

[device] !Ab1(device,0) -> HoldsAt(InRoom(device,UsualRoom(device)),0).

Theta: [device] Lent(device) -> Ab1(device,0).

[object,room1,room2,time]
HoldsAt(InRoom(object,room1),time) & HoldsAt(InRoom(object,room2),time) -> room1=room2.

[agent,device,time]
({room} HoldsAt(InRoom(agent,room),time) & HoldsAt(InRoom(device,room),time)) ->
Initiates(TurnOn(agent,device),On(device),time).

UsualRoom(Television)=LivingRoom.
UsualRoom(Radio)=LivingRoom.
Lent(Radio).
!Lent(Television).
HoldsAt(InRoom(Radio,Bedroom),0).
HoldsAt(InRoom(Nathan,LivingRoom),0).
[device] !HoldsAt(On(device),0).

Delta: Happens(TurnOn(Nathan,Television),0).
Delta: Happens(TurnOn(Nathan,Radio),0).

completion Delta Happens
completion Theta Ab1

range time 0 1
range offset 1 1
