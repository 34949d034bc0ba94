;;;; Theories that other theories extend.

(in-package #:discrepancy-finder.event-calculus)

(define-theory causal-constraints
  "Effects at the same instant (Thielscher; Shanahan 1999, section 4; Mueller, Commonsense
Reasoning, section 6.5): a fluent is started at a timepoint if it holds or an event initiates it
then, and initiated if it is started and no event terminates it then; stopped and terminated are the
opposites.  Sentences about them make events happen without delay."
  (:predicates (started fluent time) (stopped fluent time)
               (initiated fluent time) (terminated fluent time))
  (:axioms
   (started-or-holding
    (iff (started ?fluent ?time)
         (or (holds-at ?fluent ?time)
             (exists (?event) (and (happens ?event ?time)
                                   (initiates ?event ?fluent ?time))))))
   (stopped-or-not-holding
    (iff (stopped ?fluent ?time)
         (or (not (holds-at ?fluent ?time))
             (exists (?event) (and (happens ?event ?time)
                                   (terminates ?event ?fluent ?time))))))
   (initiated-if-started-only
    (iff (initiated ?fluent ?time)
         (and (started ?fluent ?time)
              (not (exists (?event) (and (happens ?event ?time)
                                         (terminates ?event ?fluent ?time)))))))
   (terminated-if-stopped-only
    (iff (terminated ?fluent ?time)
         (and (stopped ?fluent ?time)
              (not (exists (?event) (and (happens ?event ?time)
                                         (initiates ?event ?fluent ?time)))))))))
