; A picture is taken in a dark room, without and with flash.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 8, on the cumulative effects of
; concurrent events.
; Expected: 1 model; a black picture at 1, a good one at 2.

load foundations/Root.e
load foundations/EC.e

sort camera
camera Camera1

fluent Dark()
fluent GoodPicture(camera)
fluent BlackPicture(camera)
event PressShutter(camera)
event FireFlash(camera)

[camera,time]
!HoldsAt(Dark(),time) | Happens(FireFlash(camera),time) ->
Initiates(PressShutter(camera),GoodPicture(camera),time).

[camera,time]
HoldsAt(Dark(),time) & !Happens(FireFlash(camera),time) ->
Initiates(PressShutter(camera),BlackPicture(camera),time).

HoldsAt(Dark(),0).
!HoldsAt(GoodPicture(Camera1),0).
!HoldsAt(BlackPicture(Camera1),0).

Happens(PressShutter(Camera1),0).
Happens(FireFlash(Camera1),1).
Happens(PressShutter(Camera1),1).

completion Happens

range time 0 2
range offset 1 1
