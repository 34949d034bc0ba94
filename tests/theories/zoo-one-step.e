; A small zoo: what can happen at one timepoint?
;
; Source: V. Akman, S. Erdogan, J. Lee, V. Lifschitz, H. Turner, Representing the Zoo World and the
; Traffic World in the language of the Causal Calculator, 2004; the Zoo World is E. Sandewall's.
; Here there are four positions in a row, P1 and P2 in the cage, P3 and P4 outside, a gate between
; P2 and P3, an elephant at P1 and its keeper at P3; the gate is closed.
; Expected: 6 models.  Events are open; the keeper stays, moves to P4 or opens the gate, the
; elephant stays or moves to P2, 3 x 2.  DoneBy is defined by equalities of events, of which those
; with an elephant that opens a gate have no ground instance.

load foundations/Root.e
load foundations/EC.e

sort animal
sort human: animal
sort position
sort gate
animal Elephant
human Keeper
position P1, P2, P3, P4
gate Gate1

predicate Neighbor(position,position)
predicate Passage(gate,position,position)
predicate DoneBy(event,animal)
fluent At(animal,position)
fluent Opened(gate)
event Move(animal,position)
event Open(human,gate)
event Close(human,gate)

[event,animal]
DoneBy(event,animal) <->
({position} event=Move(animal,position)) |
({gate} event=Open(animal,gate)) |
({gate} event=Close(animal,gate)).

[event1,event2,animal,time]
Happens(event1,time) & Happens(event2,time) &
DoneBy(event1,animal) & DoneBy(event2,animal) ->
event1=event2.

[animal,position,time] Initiates(Move(animal,position),At(animal,position),time).
[animal,position1,position2,time]
HoldsAt(At(animal,position1),time) & position1!=position2 ->
Terminates(Move(animal,position2),At(animal,position1),time).
[human,gate,time] Initiates(Open(human,gate),Opened(gate),time).
[human,gate,time] Terminates(Close(human,gate),Opened(gate),time).

[animal,position1,position2,time]
Happens(Move(animal,position2),time) & HoldsAt(At(animal,position1),time) ->
Neighbor(position1,position2).

[animal,gate,position1,position2,time]
Happens(Move(animal,position2),time) & HoldsAt(At(animal,position1),time) &
Passage(gate,position1,position2) ->
HoldsAt(Opened(gate),time).

[human,gate,time]
Happens(Open(human,gate),time) | Happens(Close(human,gate),time) ->
({position1,position2}
 HoldsAt(At(human,position1),time) & Passage(gate,position1,position2)).

[human,gate,time] Happens(Open(human,gate),time) -> !HoldsAt(Opened(gate),time).
[human,gate,time] Happens(Close(human,gate),time) -> HoldsAt(Opened(gate),time).

[animal,time] {position} HoldsAt(At(animal,position),time).
[animal,position1,position2,time]
HoldsAt(At(animal,position1),time) & HoldsAt(At(animal,position2),time) ->
position1=position2.

[animal1,animal2,position,time]
HoldsAt(At(animal1,position),time) & HoldsAt(At(animal2,position),time) -> animal1=animal2.

[animal1,animal2,position1,position2,time]
HoldsAt(At(animal1,position1),time) & HoldsAt(At(animal2,position2),time) &
animal1!=animal2 & HoldsAt(At(animal1,position2),time+1) ->
!HoldsAt(At(animal2,position1),time+1).

[position1,position2]
Neighbor(position1,position2) <->
(position1=P1 & position2=P2) | (position1=P2 & position2=P1) |
(position1=P2 & position2=P3) | (position1=P3 & position2=P2) |
(position1=P3 & position2=P4) | (position1=P4 & position2=P3).

[gate,position1,position2]
Passage(gate,position1,position2) <->
(position1=P2 & position2=P3) | (position1=P3 & position2=P2).

HoldsAt(At(Keeper,P3),0).
HoldsAt(At(Elephant,P1),0).
!HoldsAt(Opened(Gate1),0).

range time 0 1
range offset 1 1
