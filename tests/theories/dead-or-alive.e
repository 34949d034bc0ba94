; The shooting scenario with a derived fluent: to be dead is not to be alive.
;
; Source: M. Shanahan, Solving the Frame Problem, 1997, on state constraints (after A. Baker 1991).
; Expected: 1 model; dead at 3.  Dead is not inertial; the constraint fixes it at every timepoint.

load foundations/Root.e
load foundations/EC.e

sort person
person Sam

fluent Loaded()
fluent Alive(person)
fluent Dead(person)
noninertial Dead
event Load()
event Wait()
event Shoot(person)

[person,time] HoldsAt(Dead(person),time) <-> !HoldsAt(Alive(person),time).
[time] Initiates(Load(),Loaded(),time).
[person,time] HoldsAt(Loaded(),time) -> Terminates(Shoot(person),Alive(person),time).
[person,time] Terminates(Shoot(person),Loaded(),time).

HoldsAt(Alive(Sam),0).
!HoldsAt(Loaded(),0).

Delta: Happens(Load(),0).
Delta: Happens(Wait(),1).
Delta: Happens(Shoot(Sam),2).

completion Delta Happens

range time 0 3
range offset 1 1
