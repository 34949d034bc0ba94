; The supermarket trolley, pushed, then pulled, then both.
;
; Source: E. Mueller, G. Sutcliffe, Reasoning in the event calculus using first-order automated
; theorem proving, 2005: problems CSR015 to CSR023 of the TPTP library; the domain is Shanahan's.
; Expected: 1 model; forwards at 1; backwards, not forwards at 2; spinning only at 3.

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

Happens(Push(),0).
Happens(Pull(),1).
Happens(Push(),2).
Happens(Pull(),2).

completion Happens

range time 0 3
range offset 1 1
