; The supermarket trolley: pushed and pulled at the same time it spins.
;
; Source: M. Shanahan, Solving the Frame Problem, 1997, and The event calculus explained, 1999.
; Expected: 1 model; spinning from 6 on, never forwards or backwards.

load foundations/Root.e
load foundations/EC.e

fluent Forwards()
fluent Backwards()
fluent Spinning()
event Push()
event Pull()

[time] !Happens(Pull(),time) -> Initiates(Push(),Forwards(),time).
[time] !Happens(Pull(),time) -> Terminates(Push(),Backwards(),time).
[time] !Happens(Pull(),time) -> Terminates(Push(),Spinning(),time).
[time] !Happens(Push(),time) -> Initiates(Pull(),Backwards(),time).
[time] !Happens(Push(),time) -> Terminates(Pull(),Forwards(),time).
[time] !Happens(Push(),time) -> Terminates(Pull(),Spinning(),time).
[time] Happens(Push(),time) -> Initiates(Pull(),Spinning(),time).
[time] Happens(Push(),time) -> Terminates(Pull(),Forwards(),time).
[time] Happens(Push(),time) -> Terminates(Pull(),Backwards(),time).

!HoldsAt(Forwards(),0).
!HoldsAt(Backwards(),0).
!HoldsAt(Spinning(),0).

Happens(Push(),5).
Happens(Pull(),5).
Happens(Push(),10).
Happens(Pull(),10).

completion Happens

range time 0 12
range offset 1 1
