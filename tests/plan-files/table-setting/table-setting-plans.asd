;;; A system of plans in the manner of CRAM's own.

(defsystem table-setting-plans
  :license "MIT"
  :description "Plans that fetch things and set a table with them."

  :depends-on (cl-transforms
               cl-transforms-stamped
               roslisp
               roslisp-utilities
               cram-tf
               cram-language
               cram-prolog
               cram-utilities
               cram-designators
               cram-designator-specification
               cram-common-designators
               cram-executive
               cram-process-modules
               cram-projection
               cram-common-failures
               cram-occasions-events
               cram-plan-occasions-events
               cram-robot-interfaces
               cram-object-interfaces)

  :components
  ((:static-file "notes.txt")
   (:module "src"
    :components
    ((:file "plans" :depends-on ("package" "world"))
     (:file "package")
     (:file "world" :depends-on ("package"))
     (:file "process-modules" :depends-on ("package" "world"))
     (:file "high-level-plans" :depends-on ("package" "plans"))
     (:file "designators" :depends-on ("package" "plans" "high-level-plans" "robot"))
     (:file "robot" :depends-on ("package"))
     (:file "demo" :depends-on ("designators" "process-modules"))))))
