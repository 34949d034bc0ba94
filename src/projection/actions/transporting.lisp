;;;; The action transporting: find an object, fetch it and deliver it.

(in-package #:discrepancy-finder.projection)

(def-cram-function find-and-fetch (?object ?location ?arm)
  "Search for the object ?OBJECT at ?LOCATION, fetch it and return its new designator."
  (let ((?found (perform (an action (type searching) (object ?object) (location ?location)))))
    (perform (an action (type fetching) (object ?found) (when ?arm (arm ?arm))))))

(def-cram-function transport (?object ?location ?target ?arm ?container)
  "Bring the object ?OBJECT from ?LOCATION to ?TARGET, with ?ARM if that is not NIL.  If ?LOCATION
is in ?CONTAINER, which is NIL otherwise, open that before and close it afterwards, whatever
happens."
  (let ((?fetched
          (if ?container
              (progn
                (perform (an action (type accessing) (location ?location) (distance 0.3)))
                (unwind-protect (find-and-fetch ?object ?location ?arm)
                  (perform (an action (type sealing) (location ?location) (distance 0.3)))))
              (find-and-fetch ?object ?location ?arm))))
    (perform (an action (type delivering) (object ?fetched) (target ?target)))))
