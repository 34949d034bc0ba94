;;;; Log lines to the letter, levels, the clock, functions at start and end.

(in-package #:discrepancy-finder.tests)

(def-suite roslisp :in all)
(in-suite roslisp)

(defmacro with-log ((&key (time 0)) &body body)
  "Evaluate BODY at TIME with levels of its own and return the list of the log lines."
  `(let ((roslisp::*debug-levels* '())
         (roslisp:*ros-clock* (constantly ,time)))
     (uiop:split-string
      (string-right-trim '(#\Newline)
                         (with-output-to-string (roslisp:*debug-stream*) ,@body))
      :separator '(#\Newline))))

(test log-lines
  (is (equal '("[(PICK-PLACE PICK-UP) INFO] 1.250: Opening gripper LEFT"
               "[(FETCH) WARN] 1.250: twice 2"
               "[ERROR] 1.250: no name"
               "[(KEY) FATAL] 1.250: ")
             (with-log (:time 5/4)
               (roslisp:ros-info (pick-place pick-up) "Opening gripper ~a" 'left)
               (roslisp:ros-warn fetch "twice ~a" (+ 1 1))
               (roslisp:ros-error "no name")
               (roslisp:ros-fatal :key "")))))

(test a-log-line-is-one-line
  (is (equal (list (format nil "[(A) INFO] 0.000: Failed: #<POSE #<3D-VECTOR (0.0d0 0.0d0 0.0d0)> ~
                                #<QUATERNION (0.0d0 0.0d0 0.0d0 1.0d0)>> Retrying  now."))
             (let ((*print-pretty* t) (*read-default-float-format* 'single-float))
               (with-log ()
                 (roslisp:ros-info (a) "~%Failed: ~a~%   Retrying  now.~%"
                                   (transforms:make-identity-pose)))))))

(test log-conditions
  "A form between name and text decides; the arguments of a message not written are not evaluated."
  (let ((evaluated '()))
    (is (equal '("[(A) INFO] 0.000: yes 1")
               (with-log ()
                 (roslisp:ros-info (a) (= 1 1) "yes ~a" (progn (push 1 evaluated) 1))
                 (roslisp:ros-info (a) (= 1 2) "no ~a" (push 2 evaluated))
                 (roslisp:ros-debug (a) "no ~a" (push 3 evaluated)))))
    (is (equal '(1) evaluated)))
  (let ((text "from a variable"))
    (is (equal '("[(A) INFO] 0.000: from a variable")
               (with-log () (roslisp:ros-info (a) text)))))
  (is (equal '() (with-log () (is (null (roslisp:ros-debug "nothing")))))))

(test debug-levels
  (is (equal '("[(A) DEBUG] 0.000: 1" "[(A B) DEBUG] 0.000: 2" "[(A C) WARN] 0.000: 3"
               "[(B) ERROR] 0.000: 4")
             (with-log ()
               (is (eq :info (roslisp:debug-level '(a b))))
               (roslisp:set-debug-level nil :error)
               (roslisp:set-debug-level :a :debug)
               (is (eq :warn (roslisp:set-debug-level '(a c) :warn)))
               (is (eq :debug (roslisp:debug-level '(a b))))
               (roslisp:ros-debug a "1")
               (roslisp:ros-debug (a b) "2")
               (roslisp:ros-info (a c) "not")
               (roslisp:ros-warn (a c) "3")
               (roslisp:ros-warn (b) "not")
               (roslisp:ros-error (b) "4")
               (roslisp:ros-warn "not"))))
  (signals-with (roslisp:unknown-debug-level ":LOUD is no debug level")
    (roslisp:set-debug-level 'a :loud)))

(test malformed-log-calls
  (signals-with (roslisp:malformed-log-call "a format string")
    (macroexpand-1 '(roslisp:ros-info (a))))
  (signals-with (roslisp:malformed-log-call "a format string")
    (macroexpand-1 '(roslisp:ros-info))))

(test log-lines-go-to-the-error-output
  (let ((out (make-string-output-stream)))
    (is (equal (format nil "[(A) INFO] 0.000: x~%")
               (with-output-to-string (*error-output*)
                 (let ((*standard-output* out) (roslisp:*ros-clock* (constantly 0)))
                   (roslisp:ros-info (a) "x")))))
    (is (equal "" (get-output-stream-string out)))))

(test the-clock-of-the-log
  (let ((time 0))
    (let ((roslisp:*ros-clock* (lambda () (incf time 1/2))))
      (is (eql 0.5d0 (roslisp:ros-time)))
      (is (eql 1d0 (roslisp:ros-time))))))

(defvar *started* '())

(defun start-early () (push :early *started*))
(defun start-late () (push :late *started*))

(test functions-at-start-and-end
  (let ((roslisp::*init-functions* '()) (roslisp::*cleanup-functions* '())
        (*started* '()))
    (roslisp:register-ros-init-function 'start-early)
    (roslisp:register-ros-init-function #'start-late)
    (roslisp:register-ros-init-function 'start-early)
    (roslisp:register-ros-cleanup-function 'start-early)
    (roslisp:register-ros-cleanup-function 'start-late)
    (is (null (roslisp:startup-ros :name "cram" :anonymous nil)))
    (is (equal '(:late :early) *started*))
    (setf *started* '())
    (is (null (roslisp:shutdown-ros)))
    (is (equal '(:early :late) *started*))
    (signals-with (roslisp:not-a-function "5 cannot be registered")
      (roslisp:register-ros-init-function 5))))
