(defpackage #:discrepancy-finder.designators
  (:documentation "Designators of CRAM: symbolic descriptions of actions, motions, locations,
objects and humans, and how they are resolved.")
  (:use #:cl #:discrepancy-finder.geometry)
  (:shadow #:the)
  (:import-from #:discrepancy-finder.prolog
                #:lazy-list #:lazy-cons #:next #:fin #:lazy-car #:lazy-cdr #:lazy-mapcar
                #:lazy-mapcan #:lazy-filter
                #:prolog #:var-value #:unify-p #:*break-on-lisp-errors* #:predicate
                #:def-fact-group #:<- #:lisp-fun #:lisp-pred #:lisp-type #:bound)
  (:local-nicknames (#:source #:discrepancy-finder.source))
  (:export
   ;; forms
   #:a #:an #:the #:all #:when
   #:action #:motion #:location #:object #:human
   #:declare-designator-keys #:known-keys
   ;; designators
   #:designator #:action-designator #:motion-designator #:location-designator
   #:object-designator #:human-designator
   #:make-designator #:make-quantified-designator #:with-designators
   #:designator-class-keyword #:description-text
   #:properties #:description #:quantifier #:parent #:successor #:effective #:timestamp #:data
   #:desig-prop-value #:desig-prop-values #:with-desig-props
   ;; chains
   #:equate #:on-equate-designators #:current-desig #:first-desig #:desig-equal
   #:get-equal-designators #:newest-effective-designator #:*timestamp-function*
   ;; descriptions
   #:copy-designator #:merge-desig-descriptions #:extend-designator-properties
   #:update-designator-properties #:make-effective-designator #:matches-description-p
   ;; resolution
   #:reference #:next-solution #:designator-groundings #:resolve-designator #:user-grounded-p
   #:*default-role* #:default-role
   #:designated-pose #:object-designator-data #:object-identifier #:object-pose
   ;; predicates of prolog
   #:action-grounding #:default-action-grounding #:motion-grounding #:location-grounding
   #:desig-prop #:property #:desig-location-prop
   #:current-designator #:desig-solution #:desig-reference #:desig-solution-not-rejected
   #:designator? #:action-desig? #:motion-desig? #:loc-desig? #:obj-desig? #:human-desig?
   ;; locations
   #:register-location-generator #:delete-location-generator-function
   #:enable-location-generator-function #:disable-location-generator-function
   #:list-location-generators
   #:register-location-validation-function #:delete-location-validation-function
   #:enable-location-validation-function #:disable-location-validation-function
   #:list-location-validation-functions #:validate-location-designator-solution
   #:*location-generator-max-retries* #:*print-location-validation-function-results*
   ;; conditions
   #:malformed-designator #:malformed-designator-plan
   #:malformed-designator-form #:malformed-designator-expected
   #:malformed-designator-position
   #:unknown-designator-key #:unknown-designator-key-plan
   #:unknown-designator-key-key #:unknown-designator-key-suggestion
   #:unknown-designator-key-form #:unknown-designator-key-position
   #:designator-error #:designator-error-designator
   #:invalid-location-function #:invalid-location-function-function
   #:invalid-location-function-problem
   #:property-type-error #:property-type-error-designator #:property-type-error-key
   #:property-type-error-value #:property-type-error-expected))
