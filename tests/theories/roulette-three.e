; A roulette wheel with three numbers is spun.
;
; Source: E. Mueller, A tool for satisfiability-based commonsense reasoning in the event calculus,
; 2004, and Commonsense Reasoning, 2006, chapter 9 (determining fluents are Shanahan's, 1999).
; Expected: 3 models, one a number.

load foundations/Root.e
load foundations/EC.e

sort wheel
sort number: integer
wheel Wheel1

fluent BallOn(wheel,number)
fluent FallsOn(wheel,number)
noninertial FallsOn
event Spin(wheel)

[wheel,time] {number} HoldsAt(FallsOn(wheel,number),time).

[wheel,number1,number2,time]
HoldsAt(FallsOn(wheel,number1),time) & HoldsAt(FallsOn(wheel,number2),time) ->
number1=number2.

[wheel,number,time]
HoldsAt(FallsOn(wheel,number),time) -> Initiates(Spin(wheel),BallOn(wheel,number),time).

[wheel,number1,number2,time]
HoldsAt(FallsOn(wheel,number1),time) & HoldsAt(BallOn(wheel,number2),time) &
number1!=number2 ->
Terminates(Spin(wheel),BallOn(wheel,number2),time).

[number] HoldsAt(BallOn(Wheel1,number),0) <-> number=0.
HoldsAt(FallsOn(Wheel1,0),1).
HoldsAt(FallsOn(Wheel1,0),2).

Happens(Spin(Wheel1),0).

completion Happens

range time 0 2
range offset 1 1
range number 0 2
