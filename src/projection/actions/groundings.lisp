;;;; Which action designator means which plan of this folder.
;;;;
;;;; These are facts of DEFAULT-ACTION-GROUNDING: where a user has an ACTION-GROUNDING for the same
;;;; designator, that is what it means.

(in-package #:discrepancy-finder.projection)

(prolog:def-fact-group mobile-manipulation (desig:default-action-grounding)

  (prolog:<- (value-or-nil ?action ?key ?value)
    (prolog:lisp-fun plan:desig-prop-value ?action ?key ?value))

  (prolog:<- (newest ?action ?key ?newest)
    (desig:desig-prop ?action (?key ?designator))
    (desig:current-designator ?designator ?newest))

  (prolog:<- (desig:default-action-grounding ?action (go-to-target ?target))
    (desig:desig-prop ?action (:type :going))
    (newest ?action :target ?target))

  (prolog:<- (desig:default-action-grounding ?action (go-to-target ?pose))
    (desig:desig-prop ?action (:type :going))
    (desig:desig-prop ?action (:pose ?pose)))

  (prolog:<- (desig:default-action-grounding ?action (go-without-collisions ?location))
    (desig:desig-prop ?action (:type :navigating))
    (newest ?action :location ?location))

  (prolog:<- (desig:default-action-grounding ?action (look ?key ?value))
    (desig:desig-prop ?action (:type :looking))
    (member ?key (:target :pose :object :frame :direction :joint-angles))
    (desig:desig-prop ?action (?key ?value)))

  (prolog:<- (desig:default-action-grounding ?action (turn-towards ?target))
    (desig:desig-prop ?action (:type :turning-towards))
    (desig:desig-prop ?action (:target ?target)))

  (prolog:<- (desig:default-action-grounding ?action (perceive ?object))
    (desig:desig-prop ?action (:type :detecting))
    (newest ?action :object ?object))

  (prolog:<- (desig:default-action-grounding ?action (search-for-object ?object ?location))
    (desig:desig-prop ?action (:type :searching))
    (newest ?action :object ?object)
    (newest ?action :location ?location))

  (prolog:<- (desig:default-action-grounding ?action
                                             (manipulate-environment ?opening ?container ?arm
                                                                     ?distance))
    (member (?type ?opening) ((:accessing :opening) (:sealing :closing)))
    (desig:desig-prop ?action (:type ?type))
    (newest ?action :location ?location)
    (newest ?location :in ?container)
    (value-or-nil ?action :arm ?arm)
    (value-or-nil ?action :distance ?distance))

  (prolog:<- (desig:default-action-grounding ?action
                                             (fetch ?object ?arm ?robot-location
                                                    ?pick-up-action))
    (desig:desig-prop ?action (:type :fetching))
    (newest ?action :object ?object)
    (value-or-nil ?action :arm ?arm)
    (value-or-nil ?action :robot-location ?robot-location)
    (value-or-nil ?action :pick-up-action ?pick-up-action))

  (prolog:<- (desig:default-action-grounding ?action
                                             (deliver ?object ?target ?robot-location
                                                      ?place-action))
    (desig:desig-prop ?action (:type :delivering))
    (newest ?action :object ?object)
    (newest ?action :target ?target)
    (value-or-nil ?action :robot-location ?robot-location)
    (value-or-nil ?action :place-action ?place-action))

  (prolog:<- (desig:default-action-grounding ?action
                                             (transport ?object ?location ?target ?arm
                                                        ?container))
    (desig:desig-prop ?action (:type :transporting))
    (newest ?action :object ?object)
    (newest ?action :location ?location)
    (newest ?action :target ?target)
    (value-or-nil ?action :arm ?arm)
    (value-or-nil ?location :in ?container)))
