; A coin is thrown onto a chess board: it comes to lie on black, on white, or on both.
;
; Source: R. Reiter's example, in M. Shanahan, Solving the Frame Problem, 1997; with determining
; fluents as in Shanahan, The event calculus explained, 1999.
; Expected: 3 models: black, white, both.  The determining fluents are fixed where nothing is
; thrown.

load foundations/Root.e
load foundations/EC.e

fluent OnBlack()
fluent OnWhite()
fluent FallsOnBlack()
fluent FallsOnWhite()
noninertial FallsOnBlack, FallsOnWhite
event Throw()

[time] HoldsAt(FallsOnBlack(),time) | HoldsAt(FallsOnWhite(),time).
[time] HoldsAt(FallsOnBlack(),time) -> Initiates(Throw(),OnBlack(),time).
[time] HoldsAt(FallsOnWhite(),time) -> Initiates(Throw(),OnWhite(),time).

!HoldsAt(OnBlack(),0).
!HoldsAt(OnWhite(),0).
HoldsAt(FallsOnBlack(),0).
HoldsAt(FallsOnWhite(),0).
HoldsAt(FallsOnBlack(),2).
HoldsAt(FallsOnWhite(),2).

Happens(Throw(),1).

completion Happens

range time 0 2
range offset 1 1
