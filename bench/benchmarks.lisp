;;;; The benchmarks of `discrepancy-finder bench`.
;;;;
;;;; The machine may have other users: of several rounds the median counts, and where there is a
;;;; peer it runs in turn with us, in short rounds, and the ratio of processor times, pair by pair,
;;;; is what to look at.  Other times are of the wall clock.

(in-package #:discrepancy-finder.bench)

(defun median (numbers)
  (let ((sorted (sort (copy-list numbers) #'<)))
    (nth (floor (length sorted) 2) sorted)))

(defun seconds-of (function)
  (let ((start (foreign:monotonic-seconds)))
    (funcall function)
    (- (foreign:monotonic-seconds) start)))

(defun median-seconds (function &key (rounds 9))
  "Return the median of the seconds that ROUNDS calls of FUNCTION take, after one that is not
counted."
  (funcall function)
  (median (loop repeat rounds collect (seconds-of function))))

(defun foreign-call-nanoseconds ()
  "Return the time (ns) of a trivial call into Z3, and of reading the pose of a body from Bullet."
  (let ((calls 1000000))
    (flet ((per-call (seconds) (/ (* 1d9 seconds) calls)))
      (z3:with-context (context)
        (let ((pointer (z3::context-pointer context)))
          (bullet:with-world (world)
            (let ((body (bullet:add-body world "box" '(:box 1d0 1d0 1d0) (geometry:identity-pose)
                                         :mass 1d0)))
              (values
               (per-call (median-seconds (lambda ()
                                           (dotimes (i calls) (z3::z3-get-error-code pointer)))))
               (per-call (median-seconds (lambda ()
                                           (dotimes (i calls) (bullet:body-pose body)))))))))))))

(defun ast-node-microseconds ()
  "Return the processor time (us) of making one node of a Z3 term: by the functions on terms, which
own references and check sorts, and by raw calls."
  (let ((count 2000))
    (z3:with-context (context)
      (let ((terms (loop for index below (1+ count)
                         collect (z3:variable context (format nil "p~d" index)))))
        (flet ((per-node (function)
                 (/ (median (loop repeat 9
                                  collect (z3:with-released-terms (context)
                                            (processor-milliseconds function))))
                    (* 2 count 1d-3))))
          (values
           (per-node (lambda ()
                       (loop for (p q) on terms
                             while q do (z3:conjunction (list p (z3:negation q))))))
           (z3::calling-z3 (pointer context)
             (foreign:with-c-float-traps
               (cffi:with-foreign-object (arguments :pointer 2)
                 (per-node
                  (lambda ()
                    (loop for (p q) on terms
                          while q
                          do (let ((negation (z3::z3-mk-not pointer (z3::term-pointer q))))
                               (z3::z3-inc-ref pointer negation)
                               (setf (cffi:mem-aref arguments :uint64 0) (z3::term-pointer p)
                                     (cffi:mem-aref arguments :uint64 1) negation)
                               (z3::z3-inc-ref pointer
                                               (z3::z3-mk-and pointer 2 arguments)))))))))))))))

(defun compiled-peer (name)
  "Compile NAME.cpp, if it has changed, and return the program's path."
  (let ((source (asdf:system-relative-pathname "discrepancy-finder"
                                               (format nil "bench/~a.cpp" name)))
        (program (asdf:system-relative-pathname "discrepancy-finder" (format nil "build/~a" name))))
    (unless (and (uiop:file-exists-p program)
                 (> (file-write-date program) (file-write-date source)))
      (ensure-directories-exist program)
      (uiop:run-program (list (or (uiop:getenvp "CXX") "g++") "-std=c++17" "-O2"
                              "-DBT_USE_DOUBLE_PRECISION" "-isystem" "/usr/include/bullet"
                              (namestring source) "-o" (namestring program)
                              "-lBulletDynamics-float64" "-lBulletCollision-float64"
                              "-lLinearMath-float64")
                        :error-output *error-output*))
    program))

(defun compare-steps (&key (rounds 31) (steps 20000))
  "Return the median steps/s through Lisp and in plain C++, and the median ratio of the times, pair
by pair."
  (let ((program (compiled-peer "steps")) (ours '()) (theirs '()))
    (lisp-steps-per-second steps)
    (loop repeat rounds
          do (push (lisp-steps-per-second steps) ours)
             (push (plain-steps-per-second steps program) theirs))
    (values (median ours) (median theirs) (median (mapcar #'/ theirs ours)))))

(defun example-trace ()
  (first (df:exploration-traces (df:explore-plan 'discrepancy-finder-user::move-the-box
                                                 :domain :two-regions))))

(defun samples-per-second (&key (samples 40))
  "Return how many samples of Example 1 a second are drawn, simulated and judged."
  (let* ((trace (example-trace))
         (domain (discrepancy:ensure-domain :two-regions))
         (parameters (discrepancy:initial-parameters domain trace)))
    (z3:with-context (context)
      (/ samples
         (seconds-of (lambda ()
                       (dotimes (index samples)
                         (discrepancy:judge-run
                          domain
                          (discrepancy:execute-sample
                           domain 'discrepancy-finder-user::move-the-box
                           (discrepancy:draw-sample parameters 1 1 index) :trace trace)
                          trace :context context))))))))

(defun print-benchmarks (&optional (stream *standard-output*))
  "Run the benchmarks and print their figures to STREAM."
  (multiple-value-bind (z3 bullet) (foreign-call-nanoseconds)
    (format stream "foreign call              ~,1f ns (Z3, error code), ~,1f ns (Bullet, pose of a ~
                    body)~%" z3 bullet))
  (multiple-value-bind (terms raw) (ast-node-microseconds)
    (format stream "node of a Z3 term         ~,2f us, ~,2f us by raw calls~%" terms raw))
  (multiple-value-bind (ours theirs ratio) (compare-steps)
    (format stream "Bullet steps              ~,0f /s through Lisp, ~,0f /s in plain C++, ~
                    time ratio ~,3f~%" ours theirs ratio))
  (format stream "samples of Example 1      ~,1f /s, each ~,1f s simulated at 240 Hz~%"
          (samples-per-second)
          (discrepancy:run-seconds (df:run-plan 'discrepancy-finder-user::move-the-box
                                                :domain :two-regions)))
  (format stream "symbolic execution        ~,2f ms for Example 1~%"
          (* 1d3 (median-seconds (lambda () (example-trace)) :rounds 21)))
  (print-search-benchmarks stream)
  (print-transport-benchmarks stream)
  (print-plan-benchmarks stream)
  (print-evaluator-benchmarks stream)
  (print-bounded-benchmarks stream)
  (print-progression-benchmarks stream)
  (print-exploration-benchmarks stream)
  (print-calibration stream))
