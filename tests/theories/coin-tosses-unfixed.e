; Two tosses of a coin whose determining fluent is fixed nowhere.
;
; Source: as coin-tosses; a test of which atoms exist.
; Expected: 8 models: ItsHeads is free at 0, 1 and 2, where the effect axioms have instances, and is
; no atom at the last timepoint.

load foundations/Root.e
load foundations/EC.e

fluent Heads()
fluent ItsHeads()
noninertial ItsHeads
event Toss()

[time] HoldsAt(ItsHeads(),time) -> Initiates(Toss(),Heads(),time).
[time] !HoldsAt(ItsHeads(),time) -> Terminates(Toss(),Heads(),time).

HoldsAt(Heads(),0).

Happens(Toss(),1).
Happens(Toss(),2).

completion Happens

range time 0 3
range offset 1 1
