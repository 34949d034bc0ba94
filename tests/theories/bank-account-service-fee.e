; A bank charges a fee, once a month, when the balance is below the minimum.
;
; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 4, on triggered events.
; Expected: 1 model; the fee is charged at 1 and at 3; balances of Account1: 5, 2, 1, 1, 0.

load foundations/Root.e
load foundations/EC.e

sort account
sort value: integer
account Account1, Account2

function MinimumBalance(account): value
function ServiceFee(account): value

fluent Balance(account,value)
fluent ServiceFeeCharged(account)
event Transfer(account,account,value)
event ChargeServiceFee(account)
event MonthlyReset(account)

[account1,account2,value1,value2,time]
HoldsAt(Balance(account1,value1),time) & account1!=account2 & value2>0 & value1>=value2 ->
Initiates(Transfer(account1,account2,value2),Balance(account1,value1-value2),time).

[account1,account2,value1,value2,time]
HoldsAt(Balance(account1,value1),time) & account1!=account2 & value2>0 & value1>=value2 ->
Terminates(Transfer(account1,account2,value2),Balance(account1,value1),time).

[account1,account2,value1,value2,value3,time]
HoldsAt(Balance(account1,value1),time) & HoldsAt(Balance(account2,value3),time) &
account1!=account2 & value2>0 & value1>=value2 ->
Initiates(Transfer(account1,account2,value2),Balance(account2,value3+value2),time).

[account1,account2,value1,value2,value3,time]
HoldsAt(Balance(account1,value1),time) & HoldsAt(Balance(account2,value3),time) &
account1!=account2 & value2>0 & value1>=value2 ->
Terminates(Transfer(account1,account2,value2),Balance(account2,value3),time).

[account,value1,value2,time]
HoldsAt(Balance(account,value1),time) & HoldsAt(Balance(account,value2),time) -> value1=value2.

[account,value,time]
HoldsAt(Balance(account,value),time) & value<MinimumBalance(account) &
!HoldsAt(ServiceFeeCharged(account),time) ->
Happens(ChargeServiceFee(account),time).

[account,time] Initiates(ChargeServiceFee(account),ServiceFeeCharged(account),time).
[account,time] Terminates(MonthlyReset(account),ServiceFeeCharged(account),time).

[account,value,time]
HoldsAt(Balance(account,value),time) ->
Initiates(ChargeServiceFee(account),Balance(account,value-ServiceFee(account)),time).

[account,value,time]
HoldsAt(Balance(account,value),time) ->
Terminates(ChargeServiceFee(account),Balance(account,value),time).

MinimumBalance(Account1)=3.
MinimumBalance(Account2)=0.
ServiceFee(Account1)=1.
ServiceFee(Account2)=1.

[account] !HoldsAt(ServiceFeeCharged(account),0).
HoldsAt(Balance(Account1,5),0).
HoldsAt(Balance(Account2,1),0).

Happens(Transfer(Account1,Account2,3),0).
Happens(MonthlyReset(Account1),2).

completion Happens

range time 0 4
range offset 1 1
range value 0 6
