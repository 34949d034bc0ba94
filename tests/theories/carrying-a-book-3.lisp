;;;; The second half of carrying a book: a run that begins with a released fluent.
;;;;
;;;; Source: as carrying-a-book-2; released initial states chain runs of the reference reasoner, as
;;;; in its treatment of the Zoo World.
;;;; Expected: 1 model.  Nathan holds the book at 0, so its room is released then: nothing is said
;;;; about it automatically for the fluent in-room, and the theory says what is released.  The book
;;;; comes with him into the kitchen and stays there when he lets go of it.

(define-theory carrying-a-book-3
  "In-room is released at 0 for the book, and not for Nathan."
  (:sorts (object book) (agent (:parent object) nathan) (room living-room kitchen))
  (:fluents (in-room object room) (holding agent object))
  (:manual-release in-room)
  (:events (let-go-of agent object) (walk agent room room))
  (:axioms
   (initiates (walk ?agent ?room1 ?room2) (in-room ?agent ?room2) ?time)
   (implies (/= ?room1 ?room2)
            (terminates (walk ?agent ?room1 ?room2) (in-room ?agent ?room1) ?time))
   (terminates (let-go-of ?agent ?object) (holding ?agent ?object) ?time)
   (implies (holds-at (in-room ?agent ?room) ?time)
            (initiates (let-go-of ?agent ?object) (in-room ?object ?room) ?time))
   (implies (and (holds-at (holding ?agent ?object) ?time)
                 (holds-at (in-room ?agent ?room) ?time))
            (holds-at (in-room ?object ?room) ?time))
   (implies (and (holds-at (in-room ?object ?room1) ?time)
                 (holds-at (in-room ?object ?room2) ?time))
            (= ?room1 ?room2)))
  (:facts
   (released-at (in-room book ?room) 0)
   (not (released-at (in-room ?agent ?room) 0))
   (holds-at (in-room nathan living-room) 0)
   (holds-at (holding nathan book) 0)
   (not (holds-at (holding nathan nathan) 0)))
  (:narrative
   (happens (walk nathan living-room kitchen) 0)
   (happens (let-go-of nathan book) 1))
  (:completion happens)
  (:time 0 3))
