; Nathan carries a book into the kitchen: the room of the book as a released fluent.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 6, on indirect effects.
; Expected: 1 model; the book is in the kitchen from 2 on.

load foundations/Root.e
load foundations/EC.e

sort object
sort agent: object
sort room
object Book
agent Nathan
room LivingRoom, Kitchen

fluent InRoom(object,room)
fluent Holding(agent,object)
event PickUp(agent,object)
event LetGoOf(agent,object)
event Walk(agent,room,room)

[agent,room1,room2,time] Initiates(Walk(agent,room1,room2),InRoom(agent,room2),time).
[agent,room1,room2,time]
room1!=room2 -> Terminates(Walk(agent,room1,room2),InRoom(agent,room1),time).
[agent,object,time] Initiates(PickUp(agent,object),Holding(agent,object),time).
[agent,object,room,time] Releases(PickUp(agent,object),InRoom(object,room),time).
[agent,object,time] Terminates(LetGoOf(agent,object),Holding(agent,object),time).
[agent,object,room,time]
HoldsAt(InRoom(agent,room),time) -> Initiates(LetGoOf(agent,object),InRoom(object,room),time).

[agent,object,room,time]
HoldsAt(Holding(agent,object),time) & HoldsAt(InRoom(agent,room),time) ->
HoldsAt(InRoom(object,room),time).

[agent,room1,room2,time]
Happens(Walk(agent,room1,room2),time) -> room1!=room2 & HoldsAt(InRoom(agent,room1),time).

[object,room1,room2,time]
HoldsAt(InRoom(object,room1),time) & HoldsAt(InRoom(object,room2),time) -> room1=room2.

HoldsAt(InRoom(Nathan,LivingRoom),0).
HoldsAt(InRoom(Book,LivingRoom),0).
[agent,object] !HoldsAt(Holding(agent,object),0).

Happens(PickUp(Nathan,Book),0).
Happens(Walk(Nathan,LivingRoom,Kitchen),1).
Happens(LetGoOf(Nathan,Book),2).

completion Happens

range time 0 4
range offset 1 1
