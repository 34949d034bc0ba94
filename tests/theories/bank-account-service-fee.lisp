;;;; A bank charges a fee, once a month, when the balance is below the minimum.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 4, on triggered events.
;;;; Expected: 1 model.  A transfer at 0 takes the balance of the first account from 5 to 2, below
;;;; its minimum 3; the fee 1 is charged at 1 and, after the reset at 2, again at 3: balances 5, 2,
;;;; 1, 1, 0.  The fluent that a fee was charged guards the trigger in between.

(define-theory bank-account-service-fee
  "Balances are a functional fluent; minimum and fee are tabulated functions."
  (:sorts (account account1 account2) (value (:range 0 6)))
  (:functions ((minimum-balance account) value) ((service-fee account) value))
  (:fluents (balance account value) (service-fee-charged account))
  (:events (transfer account account value) (charge-service-fee account) (monthly-reset account))
  (:axioms
   (implies (and (holds-at (balance ?account1 ?value1) ?time) (/= ?account1 ?account2)
                 (> ?value2 0) (>= ?value1 ?value2))
            (initiates (transfer ?account1 ?account2 ?value2)
                       (balance ?account1 (- ?value1 ?value2)) ?time))
   (implies (and (holds-at (balance ?account1 ?value1) ?time) (/= ?account1 ?account2)
                 (> ?value2 0) (>= ?value1 ?value2))
            (terminates (transfer ?account1 ?account2 ?value2) (balance ?account1 ?value1) ?time))
   (implies (and (holds-at (balance ?account1 ?value1) ?time)
                 (holds-at (balance ?account2 ?value3) ?time) (/= ?account1 ?account2)
                 (> ?value2 0) (>= ?value1 ?value2))
            (initiates (transfer ?account1 ?account2 ?value2)
                       (balance ?account2 (+ ?value3 ?value2)) ?time))
   (implies (and (holds-at (balance ?account1 ?value1) ?time)
                 (holds-at (balance ?account2 ?value3) ?time) (/= ?account1 ?account2)
                 (> ?value2 0) (>= ?value1 ?value2))
            (terminates (transfer ?account1 ?account2 ?value2) (balance ?account2 ?value3) ?time))
   (implies (and (holds-at (balance ?account ?value1) ?time)
                 (holds-at (balance ?account ?value2) ?time))
            (= ?value1 ?value2))
   (below-minimum
    (implies (and (holds-at (balance ?account ?value) ?time)
                  (< ?value (minimum-balance ?account))
                  (not (holds-at (service-fee-charged ?account) ?time)))
             (happens (charge-service-fee ?account) ?time)))
   (initiates (charge-service-fee ?account) (service-fee-charged ?account) ?time)
   (terminates (monthly-reset ?account) (service-fee-charged ?account) ?time)
   (implies (holds-at (balance ?account ?value) ?time)
            (initiates (charge-service-fee ?account)
                       (balance ?account (- ?value (service-fee ?account))) ?time))
   (implies (holds-at (balance ?account ?value) ?time)
            (terminates (charge-service-fee ?account) (balance ?account ?value) ?time)))
  (:facts
   (= (minimum-balance account1) 3)
   (= (minimum-balance account2) 0)
   (= (service-fee account1) 1)
   (= (service-fee account2) 1)
   (not (holds-at (service-fee-charged ?account) 0))
   (holds-at (balance account1 5) 0)
   (holds-at (balance account2 1) 0))
  (:narrative
   (happens (transfer account1 account2 3) 0)
   (happens (monthly-reset account1) 2))
  (:completion happens)
  (:time 0 4))
