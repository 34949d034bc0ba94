; Patting one's head while rubbing one's stomach.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 8, on concurrency constraints.
; Expected: 0 models: nobody can do both at once.

load foundations/Root.e
load foundations/EC.e

sort agent
agent Nathan

event PatHead(agent)
event RubStomach(agent)

[agent,time] !(Happens(PatHead(agent),time) & Happens(RubStomach(agent),time)).

Happens(PatHead(Nathan),0).
Happens(RubStomach(Nathan),0).

completion Happens

range time 0 1
range offset 1 1
