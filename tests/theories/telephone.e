; A telephone call, from picking up to hanging up.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 3 (the telephone), after work on the
; specification of telephone services.
; Expected: 1 model; dial tone at 1, ringing at 2, connected at 3, disconnected at 4, both idle at
; 5.

load foundations/Root.e
load foundations/EC.e

sort agent
sort phone
agent Ann, Ben
phone Phone1, Phone2

fluent Idle(phone)
fluent DialTone(phone)
fluent BusySignal(phone)
fluent Ringing(phone,phone)
fluent Connected(phone,phone)
fluent Disconnected(phone)
event PickUp(agent,phone)
event SetDown(agent,phone)
event Dial(agent,phone,phone)

[agent,phone,time]
HoldsAt(Idle(phone),time) -> Initiates(PickUp(agent,phone),DialTone(phone),time).
[agent,phone,time]
HoldsAt(Idle(phone),time) -> Terminates(PickUp(agent,phone),Idle(phone),time).

[agent,phone,time]
HoldsAt(DialTone(phone),time) | HoldsAt(BusySignal(phone),time) |
HoldsAt(Disconnected(phone),time) ->
Initiates(SetDown(agent,phone),Idle(phone),time).
[agent,phone,time] Terminates(SetDown(agent,phone),DialTone(phone),time).
[agent,phone,time] Terminates(SetDown(agent,phone),BusySignal(phone),time).
[agent,phone,time]
HoldsAt(Disconnected(phone),time) -> Terminates(SetDown(agent,phone),Disconnected(phone),time).

[agent,phone1,phone2,time]
HoldsAt(DialTone(phone1),time) & HoldsAt(Idle(phone2),time) ->
Initiates(Dial(agent,phone1,phone2),Ringing(phone1,phone2),time).
[agent,phone1,phone2,time]
HoldsAt(DialTone(phone1),time) & HoldsAt(Idle(phone2),time) ->
Terminates(Dial(agent,phone1,phone2),Idle(phone2),time).
[agent,phone1,phone2,time]
HoldsAt(DialTone(phone1),time) & !HoldsAt(Idle(phone2),time) ->
Initiates(Dial(agent,phone1,phone2),BusySignal(phone1),time).
[agent,phone1,phone2,time]
HoldsAt(DialTone(phone1),time) -> Terminates(Dial(agent,phone1,phone2),DialTone(phone1),time).

[agent,phone1,phone2,time]
HoldsAt(Ringing(phone1,phone2),time) ->
Initiates(PickUp(agent,phone2),Connected(phone1,phone2),time).
[agent,phone1,phone2,time]
HoldsAt(Ringing(phone1,phone2),time) ->
Terminates(PickUp(agent,phone2),Ringing(phone1,phone2),time).

[agent,phone1,phone2,time]
HoldsAt(Connected(phone1,phone2),time) -> Initiates(SetDown(agent,phone1),Idle(phone1),time).
[agent,phone1,phone2,time]
HoldsAt(Connected(phone1,phone2),time) ->
Initiates(SetDown(agent,phone1),Disconnected(phone2),time).
[agent,phone1,phone2,time]
HoldsAt(Connected(phone1,phone2),time) ->
Terminates(SetDown(agent,phone1),Connected(phone1,phone2),time).

[phone,time] !(HoldsAt(Idle(phone),time) & HoldsAt(DialTone(phone),time)).
[phone1,phone2,time]
HoldsAt(Ringing(phone1,phone2),time) | HoldsAt(Connected(phone1,phone2),time) ->
!HoldsAt(Idle(phone1),time) & !HoldsAt(Idle(phone2),time).

[phone] HoldsAt(Idle(phone),0).
[phone] !HoldsAt(DialTone(phone),0).
[phone] !HoldsAt(BusySignal(phone),0).
[phone] !HoldsAt(Disconnected(phone),0).
[phone1,phone2] !HoldsAt(Ringing(phone1,phone2),0).
[phone1,phone2] !HoldsAt(Connected(phone1,phone2),0).

Happens(PickUp(Ann,Phone1),0).
Happens(Dial(Ann,Phone1,Phone2),1).
Happens(PickUp(Ben,Phone2),2).
Happens(SetDown(Ann,Phone1),3).
Happens(SetDown(Ben,Phone2),4).

completion Happens

range time 0 5
range offset 1 1
