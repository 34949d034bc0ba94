; An event that releases and terminates the same fluent.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 2, on inconsistency in the event
; calculus.
; Expected: 0 models.  By DEC11 and DEC12 the fluent is and is not released at 1.

load foundations/Root.e
load foundations/EC.e

fluent F()
event E()

[time] Releases(E(),F(),time).
[time] Terminates(E(),F(),time).

Happens(E(),0).

completion Happens

range time 0 1
range offset 1 1
