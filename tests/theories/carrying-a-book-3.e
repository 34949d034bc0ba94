; The second half of carrying a book: a run that begins with a released fluent.
;
; Source: as carrying-a-book-2; released initial states chain runs of the reference reasoner, as in
; its treatment of the Zoo World.
; Expected: 1 model; the book is in the living room at 0, in the kitchen from 1 on.

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
manualrelease InRoom
event LetGoOf(agent,object)
event Walk(agent,room,room)

[agent,room1,room2,time] Initiates(Walk(agent,room1,room2),InRoom(agent,room2),time).
[agent,room1,room2,time]
room1!=room2 -> Terminates(Walk(agent,room1,room2),InRoom(agent,room1),time).
[agent,object,time] Terminates(LetGoOf(agent,object),Holding(agent,object),time).
[agent,object,room,time]
HoldsAt(InRoom(agent,room),time) -> Initiates(LetGoOf(agent,object),InRoom(object,room),time).

[agent,object,room,time]
HoldsAt(Holding(agent,object),time) & HoldsAt(InRoom(agent,room),time) ->
HoldsAt(InRoom(object,room),time).

[object,room1,room2,time]
HoldsAt(InRoom(object,room1),time) & HoldsAt(InRoom(object,room2),time) -> room1=room2.

[room] ReleasedAt(InRoom(Book,room),0).
[agent,room] !ReleasedAt(InRoom(agent,room),0).
HoldsAt(InRoom(Nathan,LivingRoom),0).
HoldsAt(Holding(Nathan,Book),0).
!HoldsAt(Holding(Nathan,Nathan),0).

Happens(Walk(Nathan,LivingRoom,Kitchen),0).
Happens(LetGoOf(Nathan,Book),1).

completion Happens

range time 0 3
range offset 1 1
