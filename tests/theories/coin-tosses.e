; Three tosses of a coin.
;
; Source: G. Kartha 1994, in M. Shanahan, Solving the Frame Problem, 1997; with a determining fluent
; as in Shanahan, The event calculus explained, 1999.
; Expected: 8 models, two outcomes for each of the tosses at 1, 2 and 3.

load foundations/Root.e
load foundations/EC.e

sort coin
coin Coin1

fluent Heads(coin)
fluent ItsHeads(coin)
noninertial ItsHeads
event Toss(coin)

[coin,time] HoldsAt(ItsHeads(coin),time) -> Initiates(Toss(coin),Heads(coin),time).
[coin,time] !HoldsAt(ItsHeads(coin),time) -> Terminates(Toss(coin),Heads(coin),time).

HoldsAt(Heads(Coin1),0).
HoldsAt(ItsHeads(Coin1),0).
HoldsAt(ItsHeads(Coin1),4).

Happens(Toss(Coin1),1).
Happens(Toss(Coin1),2).
Happens(Toss(Coin1),3).

completion Happens

range time 0 4
range offset 1 1
