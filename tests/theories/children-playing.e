; Two children play: what must have happened?
;
; Source: S. Frank, M. Koppen, L. Noordman, W. Vonk, Modeling knowledge-based inferences in story
; comprehension, 2003 (the story world of Bob and Jilly), as constraints between timepoints.
; Expected: 1 model; sunny and soccer at 0, the computer game at 1.

load foundations/Root.e
load foundations/EC.e

sort child
child Bob, Jilly

fluent Sunny()
fluent Raining()
fluent Outside()
fluent Soccer()
fluent HideAndSeek()
fluent ComputerGame()
fluent Win(child)
noninertial Sunny, Raining, Outside, Soccer, HideAndSeek, ComputerGame, Win

[time] HoldsAt(Raining(),time) -> !HoldsAt(Outside(),time).
[time] HoldsAt(Soccer(),time) -> HoldsAt(Outside(),time).
[time] HoldsAt(ComputerGame(),time) -> !HoldsAt(Outside(),time).
[time] !(HoldsAt(Win(Bob),time) & HoldsAt(Win(Jilly),time)).

[child,time]
HoldsAt(Win(child),time) ->
HoldsAt(Soccer(),time-1) | HoldsAt(ComputerGame(),time-1).

xor Sunny, Raining
xor Soccer, HideAndSeek, ComputerGame

HoldsAt(Outside(),0).
[child] !HoldsAt(Win(child),0).
HoldsAt(Win(Bob),1).
HoldsAt(Raining(),1).
!HoldsAt(HideAndSeek(),1).

range time 0 1
range offset 1 1
