;;; Plans made of other plans.

(in-package :ts-plans)

(cpl:def-cram-function search-for-object (?object-designator ?search-location
                                          &optional (retries 3))
  "Look for the object from one solution of `?search-location' after the other."
  (cpl:with-failure-handling
      ((desig:designator-error (e)
         (roslisp:ros-warn (ts-plans search-for-object) "Desig ~a could not be resolved: ~a"
                           ?search-location e)
         (cpl:fail 'common-fail:object-nowhere-to-be-found
                   :object ?object-designator
                   :description (format nil "Search location of ~a is unusable."
                                        ?object-designator))))
    (cpl:with-retry-counters ((outer-search-location-retries retries))
      (cpl:with-failure-handling
          (((or common-fail:navigation-goal-in-collision
                common-fail:looking-high-level-failure
                common-fail:perception-low-level-failure) (e)
             (cpl:do-retry outer-search-location-retries
               (roslisp:ros-warn (ts-plans search-for-object) "~a" e)
               (let ((?next-location (desig:next-solution ?search-location)))
                 (if ?next-location
                     (progn
                       (setf ?search-location ?next-location)
                       (cpl:retry))
                     (roslisp:ros-warn (ts-plans search-for-object) "No more places"))))
             (cpl:fail 'common-fail:object-nowhere-to-be-found
                       :object ?object-designator
                       :description (format nil "Could not find ~a." ?object-designator))))
        (exe:perform
         (desig:an action
                   (type navigating)
                   (location ?search-location)))
        (exe:perform
         (desig:an action
                   (type turning-towards)
                   (target ?search-location)))
        (exe:perform
         (desig:an action
                   (type detecting)
                   (object ?object-designator)))))))

(cpl:def-cram-function transport (?object-designator
                                  ?search-location
                                  ?delivering-location
                                  ?arm)
  "Fetch the object and put it at `?delivering-location'."
  (let ((?found-object-designator
          (exe:perform
           (desig:an action
                     (type searching)
                     (object ?object-designator)
                     (location ?search-location)))))
    (roslisp:ros-info (ts-plans transport) "Found ~a." ?found-object-designator)
    (cpl:with-failure-handling
        ((common-fail:object-unreachable (e)
           (declare (ignore e))
           (roslisp:ros-error (ts-plans transport) "Could not fetch ~a." ?object-designator)
           (return nil)))
      (let ((?fetched-object
              (exe:perform
               (desig:an action
                         (type picking-up)
                         (desig:when ?arm
                           (arm ?arm))
                         (object ?found-object-designator)))))
        (unwind-protect
             (exe:perform
              (desig:an action
                        (type navigating)
                        (location ?delivering-location)))
          (roslisp:ros-info (ts-plans transport) "Arrived"))
        (exe:perform
         (desig:an action
                   (type placing)
                   (object ?fetched-object)
                   (target ?delivering-location)))
        (desig:current-desig ?fetched-object)))))
