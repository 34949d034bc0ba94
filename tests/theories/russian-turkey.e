; The Russian turkey scenario: spinning the chamber of the gun makes it unknown whether it is
; loaded.
;
; Source: E. Sandewall, Features and Fluents, 1994; in the event calculus with releases: M.
; Shanahan, The event calculus explained, 1999.
; Expected: 2 models, by Loaded at 3, the only free atom: the turkey dies, or it lives.

load foundations/Root.e
load foundations/EC.e

sort bird
bird Turkey

fluent Loaded()
fluent Alive(bird)
event Load()
event Spin()
event Shoot(bird)

[time] Initiates(Load(),Loaded(),time).
[time] Releases(Spin(),Loaded(),time).
[bird,time] HoldsAt(Loaded(),time) -> Terminates(Shoot(bird),Alive(bird),time).
[bird,time] Terminates(Shoot(bird),Loaded(),time).

HoldsAt(Alive(Turkey),0) & !HoldsAt(Loaded(),0).

Happens(Load(),1).
Happens(Spin(),2).
Happens(Shoot(Turkey),3).

completion Happens

range time 0 5
range offset 1 1
