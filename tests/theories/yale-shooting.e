; The Yale shooting scenario, with the sneeze that Shanahan puts between loading and shooting.
;
; Source: S. Hanks, D. McDermott, Nonmonotonic logic and temporal projection, 1987; the narrative is
; that of M. Shanahan, Solving the Frame Problem, 1997, chapter 1.
; Expected: 1 model.  The turkey is not alive, and the gun is empty, at 3: everything is given.

load foundations/Root.e
load foundations/EC.e

sort bird
bird Turkey

fluent Loaded()
fluent Alive(bird)
event Load()
event Sneeze()
event Shoot(bird)

[time] Initiates(Load(),Loaded(),time).
[bird,time] HoldsAt(Loaded(),time) -> Terminates(Shoot(bird),Alive(bird),time).
[bird,time] Terminates(Shoot(bird),Loaded(),time).

HoldsAt(Alive(Turkey),0).
!HoldsAt(Loaded(),0).

Happens(Load(),0).
Happens(Sneeze(),1).
Happens(Shoot(Turkey),2).

completion Happens

range time 0 3
range offset 1 1
