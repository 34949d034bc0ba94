(in-package :cl-user)

(defpackage table-setting-plans
  (:nicknames #:ts-plans)
  (:use #:common-lisp #:cram-prolog)
  (:export
   ;; plans
   #:go-to-target #:perceive #:look-at #:pick-up #:place #:search-for-object #:transport
   #:move-arms-in-sequence
   ;; process modules
   #:base #:head #:camera #:arms #:grippers
   ;; demo
   #:with-test-robot #:demo #:reset-world #:*events*))
