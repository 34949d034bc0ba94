; A hungry cat revises its plan when the chair is pushed away.
;
; Source: M. Winikoff, L. Padgham, J. Harland, J. Thangarajah, Declarative and procedural goals in
; intelligent agent systems, 2002; E. Mueller, Commonsense Reasoning, 2006, chapter 11.
; Expected: 1 model; AddPlan P1 at 0, the chair is shifted at 1, DropPlan P1 at 2, AddPlan P1a at 3,
; Eat(Cat,Food2) at 5, DropPlan P1a at 6.

load foundations/Root.e
load foundations/EC.e

sort object
sort agent: object
sort food: object
sort surface
sort plan
reified sort belief

agent Cat
food Food1, Food2
surface Floor, Chair, Shelf, Table
plan P1, P1a

belief BOn(object,surface)
belief BCanJump(surface,surface)
belief BSatiated(agent)

fluent On(object,surface)
fluent CanJump(surface,surface)
fluent Satiated(agent)
fluent Believe(agent,belief)
fluent Goal(agent,belief)
fluent Plan(agent,belief,plan)
event AddPlan(agent,belief,plan)
event DropPlan(agent,belief,plan)
event Jump(agent,surface,surface)
event Eat(agent,food)
event ShiftChair()

; The world.
[agent,surface1,surface2,time]
Initiates(Jump(agent,surface1,surface2),On(agent,surface2),time).
[agent,surface1,surface2,time]
Terminates(Jump(agent,surface1,surface2),On(agent,surface1),time).
[agent,food,time] Initiates(Eat(agent,food),Satiated(agent),time).
[agent,food,surface,time]
HoldsAt(On(food,surface),time) -> Terminates(Eat(agent,food),On(food,surface),time).
[time] Terminates(ShiftChair(),CanJump(Chair,Shelf),time).
[time] Initiates(ShiftChair(),CanJump(Chair,Table),time).

[agent,surface1,surface2,time]
Happens(Jump(agent,surface1,surface2),time) ->
HoldsAt(On(agent,surface1),time) & HoldsAt(CanJump(surface1,surface2),time).

[agent,food,time]
Happens(Eat(agent,food),time) ->
({surface} HoldsAt(On(agent,surface),time) & HoldsAt(On(food,surface),time)).

; Beliefs about it.
[agent,surface1,surface2,time]
Initiates(Jump(agent,surface1,surface2),Believe(agent,BOn(agent,surface2)),time).
[agent,surface1,surface2,time]
Terminates(Jump(agent,surface1,surface2),Believe(agent,BOn(agent,surface1)),time).
[agent,food,time] Initiates(Eat(agent,food),Believe(agent,BSatiated(agent)),time).
[agent,food,surface,time]
HoldsAt(Believe(agent,BOn(food,surface)),time) ->
Terminates(Eat(agent,food),Believe(agent,BOn(food,surface)),time).
[agent,time] Terminates(ShiftChair(),Believe(agent,BCanJump(Chair,Shelf)),time).
[agent,time] Initiates(ShiftChair(),Believe(agent,BCanJump(Chair,Table)),time).

; Plans.
[agent,belief,plan,time]
Initiates(AddPlan(agent,belief,plan),Plan(agent,belief,plan),time).
[agent,belief,plan,time]
Terminates(DropPlan(agent,belief,plan),Plan(agent,belief,plan),time).

Delta: [agent,time]
HoldsAt(Goal(agent,BSatiated(agent)),time) &
!HoldsAt(Believe(agent,BSatiated(agent)),time) &
([plan] !HoldsAt(Plan(agent,BSatiated(agent),plan),time)) &
HoldsAt(Believe(agent,BOn(agent,Floor)),time) &
HoldsAt(Believe(agent,BCanJump(Floor,Chair)),time) &
HoldsAt(Believe(agent,BCanJump(Chair,Shelf)),time) &
HoldsAt(Believe(agent,BOn(Food1,Shelf)),time) ->
Happens(AddPlan(agent,BSatiated(agent),P1),time).

Delta: [agent,time]
HoldsAt(Goal(agent,BSatiated(agent)),time) &
!HoldsAt(Believe(agent,BSatiated(agent)),time) &
([plan] !HoldsAt(Plan(agent,BSatiated(agent),plan),time)) &
HoldsAt(Believe(agent,BOn(agent,Chair)),time) &
HoldsAt(Believe(agent,BCanJump(Chair,Table)),time) &
HoldsAt(Believe(agent,BOn(Food2,Table)),time) ->
Happens(AddPlan(agent,BSatiated(agent),P1a),time).

Delta: [agent,time]
HoldsAt(Plan(agent,BSatiated(agent),P1),time) &
!HoldsAt(Believe(agent,BCanJump(Chair,Shelf)),time) ->
Happens(DropPlan(agent,BSatiated(agent),P1),time).

Delta: [agent,belief,plan,time]
HoldsAt(Plan(agent,belief,plan),time) & HoldsAt(Believe(agent,belief),time) ->
Happens(DropPlan(agent,belief,plan),time).

Delta: [agent,time]
HoldsAt(Plan(agent,BSatiated(agent),P1),time) &
HoldsAt(Believe(agent,BCanJump(Chair,Shelf)),time) &
HoldsAt(Believe(agent,BOn(agent,Floor)),time) ->
Happens(Jump(agent,Floor,Chair),time).

Delta: [agent,time]
HoldsAt(Plan(agent,BSatiated(agent),P1),time) &
HoldsAt(Believe(agent,BCanJump(Chair,Shelf)),time) &
HoldsAt(Believe(agent,BOn(agent,Chair)),time) ->
Happens(Jump(agent,Chair,Shelf),time).

Delta: [agent,time]
HoldsAt(Plan(agent,BSatiated(agent),P1),time) &
!HoldsAt(Believe(agent,BSatiated(agent)),time) &
HoldsAt(Believe(agent,BOn(agent,Shelf)),time) ->
Happens(Eat(agent,Food1),time).

Delta: [agent,time]
HoldsAt(Plan(agent,BSatiated(agent),P1a),time) &
HoldsAt(Believe(agent,BOn(agent,Chair)),time) ->
Happens(Jump(agent,Chair,Table),time).

Delta: [agent,time]
HoldsAt(Plan(agent,BSatiated(agent),P1a),time) &
!HoldsAt(Believe(agent,BSatiated(agent)),time) &
HoldsAt(Believe(agent,BOn(agent,Table)),time) ->
Happens(Eat(agent,Food2),time).

; The beginning.
[agent,surface] HoldsAt(On(agent,surface),0) <-> surface=Floor.
[food,surface]
HoldsAt(On(food,surface),0) <->
(food=Food1 & surface=Shelf) | (food=Food2 & surface=Table).
[surface1,surface2]
HoldsAt(CanJump(surface1,surface2),0) <->
(surface1=Floor & surface2=Chair) | (surface1=Chair & surface2=Shelf).
[agent] !HoldsAt(Satiated(agent),0).
[agent,object,surface]
HoldsAt(Believe(agent,BOn(object,surface)),0) <-> HoldsAt(On(object,surface),0).
[agent,surface1,surface2]
HoldsAt(Believe(agent,BCanJump(surface1,surface2)),0) <-> HoldsAt(CanJump(surface1,surface2),0).
[agent1,agent2] !HoldsAt(Believe(agent1,BSatiated(agent2)),0).
[agent,belief] HoldsAt(Goal(agent,belief),0) <-> belief=BSatiated(agent).
[agent,belief,plan] !HoldsAt(Plan(agent,belief,plan),0).

Delta: Happens(ShiftChair(),1).

completion Delta Happens

range time 0 7
range offset 1 1
