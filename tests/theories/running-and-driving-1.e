; To go somewhere is to run there or to drive there.
;
; Source: R. Miller, M. Shanahan, Some alternative formulations of the event calculus, 2002, on
; disjunctive event axioms; E. Mueller, Commonsense Reasoning, 2006, chapter 9.
; Expected: 1 model.  He is tired at 1, which running makes and driving does not: he ran.

load foundations/Root.e
load foundations/EC.e

sort agent
sort place
agent James
place Home, Bookstore

fluent Tired(agent)
fluent At(agent,place)
event Go(agent,place)
event Run(agent,place)
event Drive(agent,place)

[agent,place,time] Initiates(Run(agent,place),Tired(agent),time).
[agent,place,time] Initiates(Go(agent,place),At(agent,place),time).
[agent,place1,place2,time]
place1!=place2 -> Terminates(Go(agent,place1),At(agent,place2),time).

Delta: [agent,place,time]
Happens(Go(agent,place),time) ->
Happens(Run(agent,place),time) | Happens(Drive(agent,place),time).

HoldsAt(At(James,Home),0).
!HoldsAt(At(James,Bookstore),0).
!HoldsAt(Tired(James),0).
HoldsAt(Tired(James),1).

Delta: Happens(Go(James,Bookstore),0).

completion Delta Happens

range time 0 1
range offset 1 1
