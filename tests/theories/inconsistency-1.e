; An event that initiates and terminates the same fluent.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 2, on inconsistency in the event
; calculus.
; Expected: 0 models.  By DEC9 and DEC10 the fluent is true and false at 1.

load foundations/Root.e
load foundations/EC.e

fluent F()
event E()

[time] Initiates(E(),F(),time).
[time] Terminates(E(),F(),time).

Happens(E(),0).

completion Happens

range time 0 1
range offset 1 1
