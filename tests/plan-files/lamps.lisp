;;; Plans about the lamps of the theory LAMPS, written for CRAM's packages, with helper functions.

(in-package :cl-user)

(defpackage #:lamp-plans
  (:use #:common-lisp #:cram-designators #:cram-prolog #:cram-utilities)
  (:import-from #:cpl #:with-failure-handling #:with-retry-counters #:do-retry #:retry
                #:def-cram-function #:def-top-level-cram-function)
  (:import-from #:exe #:perform))

(in-package #:lamp-plans)

(defparameter *gentle* t "Whether smashing is out of the question.")

(defun opposite (?flag)
  "Helpers may be called with a symbolic value."
  (declare (type boolean ?flag))
  (if ?flag nil t))

(defun which-lamp (first &key ((:second ?second) (opposite first)) &allow-other-keys)
  (cond ((not first) :b)
        (?second :b)
        (t :a)))

(defun toggle (?lamp)
  (perform (a motion (type toggling) (lamp ?lamp))))

(defmacro define-lamp-helper (name (&rest parameters) &body body)
  `(defun ,name ,parameters
     ,@body))

(define-lamp-helper wreck (?lamp)
  (unless *gentle*
    (perform (a motion (type smashing) (lamp ?lamp)))))

(let ((calls 0))
  (defun count-call ()
    (incf calls)))

(def-cram-function toggle-carefully (?lamp &key ((:retries retries) 1) ((:wreck wreck)))
  (declare (type keyword ?lamp)
           (type (integer 0) retries))
  "Toggle `?lamp', and once more if that fails."
  (count-call)
  (with-retry-counters ((toggle-retries retries))
    (with-failure-handling
        (((or common-fail:gripper-goal-not-reached
              common-fail:gripper-closed-completely) (e)
           (declare (ignore e))
           (do-retry toggle-retries
             (when wreck
               (wreck ?lamp))
             (retry))
           (return :given-up)))
      (toggle ?lamp)
      (return-from toggle-carefully :done))))

(def-top-level-cram-function lamp-plan (?which)
  (let ((?lamp (which-lamp ?which)))
    (cpl:seq
      (cpl:with-tags
        (:tag toggling
          (perform (an action (type toggling-carefully) (lamp ?lamp))))))))

(defun indifferent (?flag)
  (declare (ignore ?flag))
  :b)

(def-top-level-cram-function indifferent-plan (?flag)
  (toggle (indifferent ?flag)))

(def-fact-group lamp-actions (action-grounding)
  (<- (action-grounding ?designator (toggle-carefully ?lamp :retries ?retries))
    (desig-prop ?designator (:type :toggling-carefully))
    (spec:property ?designator (:lamp ?lamp))
    (once (or (desig-prop ?designator (:retries ?retries))
              (equal ?retries 1)))))

(defun smallest-retries (designator)
  "Return the number of retries that the action DESIGNATOR would have."
  (with-vars-bound (?retries)
      (lazy-car (prolog `(action-grounding ,designator (toggle-carefully ?_ :retries ?retries))))
    ?retries))
