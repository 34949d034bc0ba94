; Approval and disapproval at the same time confuse.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 8, on concurrent events.
; Expected: 1 model; the child is confused at 1, neither glad nor sad.

load foundations/Root.e
load foundations/EC.e

sort agent
agent Mother, Father, Child

fluent Glad(agent)
fluent Sad(agent)
fluent Confused(agent)
event ApproveOf(agent,agent)
event DisapproveOf(agent,agent)

[agent1,agent2,time]
!({agent3} Happens(DisapproveOf(agent3,agent2),time)) ->
Initiates(ApproveOf(agent1,agent2),Glad(agent2),time).

[agent1,agent2,time]
!({agent3} Happens(ApproveOf(agent3,agent2),time)) ->
Initiates(DisapproveOf(agent1,agent2),Sad(agent2),time).

[agent1,agent2,agent3,time]
Happens(DisapproveOf(agent3,agent2),time) ->
Initiates(ApproveOf(agent1,agent2),Confused(agent2),time).

[agent] !HoldsAt(Glad(agent),0).
[agent] !HoldsAt(Sad(agent),0).
[agent] !HoldsAt(Confused(agent),0).

Happens(ApproveOf(Mother,Child),0).
Happens(DisapproveOf(Father,Child),0).

completion Happens

range time 0 2
range offset 1 1
