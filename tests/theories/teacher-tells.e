; A teacher tells a topic to all who are in the room.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, exercises (an existential condition of an
; effect).
; Expected: 1 model; at 1 Ann knows the topic, Ben does not.

load foundations/Root.e
load foundations/EC.e

sort agent
sort teacher: agent
sort student: agent
sort room
sort topic
teacher MissJones
student Ann, Ben
room Classroom, Yard
topic Fractions

fluent InRoom(agent,room)
fluent Know(agent,topic)
event Tell(teacher,topic)

[teacher,student,topic,time]
({room} HoldsAt(InRoom(teacher,room),time) & HoldsAt(InRoom(student,room),time)) ->
Initiates(Tell(teacher,topic),Know(student,topic),time).

[agent,room]
HoldsAt(InRoom(agent,room),0) <->
(agent!=Ben & room=Classroom) | (agent=Ben & room=Yard).
[agent,topic] HoldsAt(Know(agent,topic),0) <-> agent=MissJones.

Happens(Tell(MissJones,Fractions),0).

completion Happens

range time 0 1
range offset 1 1
