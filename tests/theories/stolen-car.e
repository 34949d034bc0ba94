; The stolen car scenario: explain why a parked car is gone.
;
; Source: H. Kautz, The logic of persistence, 1986; as abduction in M. Shanahan, Solving the Frame
; Problem, 1997.
; Expected: 1 model, with Steal() at 1: it cannot be stolen at 0, when it is not parked.

load foundations/Root.e
load foundations/EC.e

fluent Parked()
event Park()
event Steal()

[time] Initiates(Park(),Parked(),time).
[time] Terminates(Steal(),Parked(),time).
[time] Happens(Park(),time) -> !HoldsAt(Parked(),time).
[time] Happens(Steal(),time) -> HoldsAt(Parked(),time).

!HoldsAt(Parked(),0).
Happens(Park(),0).
!HoldsAt(Parked(),2).

range time 0 2
range offset 1 1
