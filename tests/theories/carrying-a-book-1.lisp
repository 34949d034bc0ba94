;;;; Nathan carries a book into the kitchen: the move of the book as a conditional effect.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 6, on indirect effects.
;;;; Expected: 1 model.  The book is in the kitchen from 2 on, and stays there.  All rooms are given
;;;; at 0; the constraint that everything is in one room is never at odds with the effects.

(define-theory carrying-a-book-1
  "What an agent holds changes room when the agent does."
  (:sorts (object book) (agent (:parent object) nathan) (room living-room kitchen))
  (:fluents (in-room object room) (holding agent object))
  (:events (pick-up agent object) (let-go-of agent object) (walk agent room room))
  (:axioms
   (initiates (walk ?agent ?room1 ?room2) (in-room ?agent ?room2) ?time)
   (implies (/= ?room1 ?room2)
            (terminates (walk ?agent ?room1 ?room2) (in-room ?agent ?room1) ?time))
   (initiates (pick-up ?agent ?object) (holding ?agent ?object) ?time)
   (terminates (let-go-of ?agent ?object) (holding ?agent ?object) ?time)
   (implies (holds-at (holding ?agent ?object) ?time)
            (initiates (walk ?agent ?room1 ?room2) (in-room ?object ?room2) ?time))
   (implies (and (holds-at (holding ?agent ?object) ?time) (/= ?room1 ?room2))
            (terminates (walk ?agent ?room1 ?room2) (in-room ?object ?room1) ?time))
   (implies (happens (walk ?agent ?room1 ?room2) ?time)
            (and (/= ?room1 ?room2) (holds-at (in-room ?agent ?room1) ?time)))
   (implies (happens (pick-up ?agent ?object) ?time)
            (exists (?room) (and (holds-at (in-room ?agent ?room) ?time)
                                 (holds-at (in-room ?object ?room) ?time))))
   (one-room
    (implies (and (holds-at (in-room ?object ?room1) ?time)
                  (holds-at (in-room ?object ?room2) ?time))
             (= ?room1 ?room2)))
   (nobody-holds-himself (not (holds-at (holding ?agent ?agent) ?time))))
  (:facts
   (initially (in-room nathan living-room))
   (initially (in-room book living-room))
   (initially (forall (?agent ?object) (not (holding ?agent ?object)))))
  (:narrative
   (happens (pick-up nathan book) 0)
   (happens (walk nathan living-room kitchen) 1)
   (happens (let-go-of nathan book) 2))
  (:completion happens)
  (:time 0 3))
