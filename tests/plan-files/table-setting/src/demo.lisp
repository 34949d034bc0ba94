(in-package :ts-plans)

(defmacro with-test-robot (&body body)
  `(cpm:with-process-modules-running (base head camera grippers arms)
     (cpl:top-level
       ,@body)))

(defun demo (&key (type :bowl) (blindness 0) arm)
  "Carry something of `type' to another place, and return its designator."
  (reset-world :blindness blindness)
  (let ((?type type)
        (?arm arm)
        (?target-pose (at 3.0 0.5)))
    (with-test-robot
      (exe:perform
       (desig:an action
                 (type transporting)
                 (object (desig:an object (type ?type)))
                 (desig:when ?arm
                   (arm ?arm))
                 (location (desig:a location
                                    (table kitchen-table)
                                    (side (left back))))
                 (target (desig:a location (pose ?target-pose))))))))
