;;;; Nathan carries a book into the kitchen: the room of the book as a released fluent.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 6, on indirect effects.
;;;; Expected: 1 model.  Picking up releases the rooms of the book; while it is held a constraint
;;;; says that it is where Nathan is, and no object is in two rooms.  So it is in the kitchen at 2,
;;;; letting go makes that inertial again, and the room it is not in stays excluded.

(define-theory carrying-a-book-2
  "What an agent holds is in the agent's room."
  (:sorts (object book) (agent (:parent object) nathan) (room living-room kitchen))
  (:fluents (in-room object room) (holding agent object))
  (:events (pick-up agent object) (let-go-of agent object) (walk agent room room))
  (:axioms
   (initiates (walk ?agent ?room1 ?room2) (in-room ?agent ?room2) ?time)
   (implies (/= ?room1 ?room2)
            (terminates (walk ?agent ?room1 ?room2) (in-room ?agent ?room1) ?time))
   (initiates (pick-up ?agent ?object) (holding ?agent ?object) ?time)
   (releases (pick-up ?agent ?object) (in-room ?object ?room) ?time)
   (terminates (let-go-of ?agent ?object) (holding ?agent ?object) ?time)
   (implies (holds-at (in-room ?agent ?room) ?time)
            (initiates (let-go-of ?agent ?object) (in-room ?object ?room) ?time))
   (held-things-move-along
    (implies (and (holds-at (holding ?agent ?object) ?time)
                  (holds-at (in-room ?agent ?room) ?time))
             (holds-at (in-room ?object ?room) ?time)))
   (implies (happens (walk ?agent ?room1 ?room2) ?time)
            (and (/= ?room1 ?room2) (holds-at (in-room ?agent ?room1) ?time)))
   (implies (and (holds-at (in-room ?object ?room1) ?time)
                 (holds-at (in-room ?object ?room2) ?time))
            (= ?room1 ?room2)))
  (:facts
   (initially (in-room nathan living-room))
   (initially (in-room book living-room))
   (initially (forall (?agent ?object) (not (holding ?agent ?object)))))
  (:narrative
   (happens (pick-up nathan book) 0)
   (happens (walk nathan living-room kitchen) 1)
   (happens (let-go-of nathan book) 2))
  (:completion happens)
  (:time 0 4))
