; The bus ride scenario: a disjunctive event axiom, explained by an observation.
;
; Source: G. Kartha, Two counterexamples related to Baker's approach to the frame problem, 1994; in
; the event calculus: M. Shanahan, Solving the Frame Problem, 1997.
; Expected: 1 model, with BoardRed() at 1.

load foundations/Root.e
load foundations/EC.e

fluent HasTicket()
fluent OnRed()
fluent OnYellow()
event BuyTicket()
event Board()
event BoardRed()
event BoardYellow()

[time] Initiates(BuyTicket(),HasTicket(),time).
[time] Initiates(BoardRed(),OnRed(),time).
[time] Initiates(BoardYellow(),OnYellow(),time).
[time] Happens(BoardRed(),time) -> HoldsAt(HasTicket(),time).
[time] Happens(BoardYellow(),time) -> HoldsAt(HasTicket(),time).
[time] !(HoldsAt(OnRed(),time) & HoldsAt(OnYellow(),time)).

Delta: [time] Happens(Board(),time) -> Happens(BoardRed(),time) | Happens(BoardYellow(),time).
Delta: Happens(BuyTicket(),0).
Delta: Happens(Board(),1).

!HoldsAt(HasTicket(),0).
!HoldsAt(OnRed(),0).
!HoldsAt(OnYellow(),0).
HoldsAt(OnRed(),2).

completion Delta Happens

range time 0 2
range offset 1 1
