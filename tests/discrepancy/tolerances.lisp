;;;; Tests of tolerances: drawn with the samples, told in reports, replayed.

(in-package #:discrepancy-finder.tests)

(def-suite tolerances :in all)
(in-suite tolerances)

(defvar *tolerant-domain* nil)

(defun replaced-once (text old new)
  "Return TEXT with OLD, which it has once, replaced by NEW."
  (let ((position (search old text)))
    (concatenate 'string (subseq text 0 position) new (subseq text (+ position (length old))))))

(defun tolerant-domain ()
  "Return the domain of Example 1 with a scene whose reach is between 0.45 and 0.5 m."
  (or *tolerant-domain*
      (flet ((model-text (name)
               (uiop:read-file-string (root-file (format nil "models/two-regions/~a" name)))))
        (with-file (scene (loop with text = (replaced-once (model-text "scene.lisp")
                                                      "(:fixture bench"
                                                      "(:tolerances
                                                         (reach 0.45 0.9 \"of the arm, m\"))
                                                       (:fixture bench")
                                for file in '("\"bench.urdf" "\"robot.urdf" "\"box.urdf")
                                do (setf text (replaced-once text file
                                                        (format nil "\"~a~a"
                                                                (root-file "models/two-regions/")
                                                                (subseq file 1))))
                                finally (return text)))
          (with-file (domain (replaced
                              (replaced
                               (replaced-once (model-text "domain.lisp")
                                         "define-abstraction two-regions"
                                         "define-abstraction tolerant-regions")
                               "\"theory.lisp\""
                               (format nil "~s" (root-file "models/two-regions/theory.lisp")))
                              "\"scene.lisp\"" (format nil "~s" scene)))
            (let ((text (uiop:read-file-string domain)))
              (loop while (search "(:domain two-regions)" text)
                    do (setf text (replaced-once text "(:domain two-regions)"
                                            "(:domain tolerant-regions)")))
              (with-file (file text)
                (setf *tolerant-domain* (discrepancy:load-domain file)))))))))

(defun find-in-tolerant-domain (&rest options)
  (discrepancy:ensure-plan 'discrepancy-finder-user::move-the-box)
  (apply #'discrepancy:find-discrepancies 'discrepancy-finder-user::move-the-box
         :domain (tolerant-domain) options))

(test tolerances-are-drawn-with-each-sample
  (let* ((domain (tolerant-domain))
         (trace (discrepancy:trace-result-trace
                 (first (discrepancy:result-traces
                         (find-in-tolerant-domain :budget 1)))))
         (parameters (discrepancy:initial-parameters domain trace))
         (reach (first (last parameters))))
    (is (= 6 (length parameters)) "five coordinates and a tolerance")
    (is-true (discrepancy:tolerance-p reach))
    (is (string= "reach" (discrepancy:parameter-name reach)))
    (let ((drawn (loop for index below 50
                       collect (getf (discrepancy:sample-tolerances
                                      (discrepancy:draw-sample parameters 1 2 index))
                                     :reach))))
      (is (every (lambda (value) (<= 0.45 value 0.9)) drawn))
      (is (= 50 (length (remove-duplicates drawn)))))
    (is (= 5 (length (discrepancy:initial-parameters
                      (discrepancy:domain-with-parameters domain '(:reach 0.8)) trace)))
        "what the user has set is not drawn")))

(test a-discrepancy-tells-its-tolerances-and-replays-with-them
  (let* ((result (find-in-tolerant-domain :seed 1 :rule :zero-failure))
         (discrepancy (discrepancy:result-discrepancy result))
         (reach (getf (discrepancy:run-tolerances (discrepancy:discrepancy-run discrepancy))
                      :reach)))
    (is (eq :discrepancy (discrepancy:result-status result)))
    (is (= reach (getf (discrepancy:sample-tolerances (discrepancy:discrepancy-sample discrepancy))
                       :reach)))
    (let ((text (discrepancy:result-text result)))
      (is (search "reach from 0.45 to 0.9 drawn for each simulation" text))
      (is (search (format nil "reach = ~,4f (of the arm, m)" reach) text)))
    (with-file (file "" "json")
      (discrepancy:save-discrepancy discrepancy file)
      (is (search "\"tolerances\"" (uiop:read-file-string file)))
      (is (eq :same-bits (discrepancy:replay-status (discrepancy:replay file))))
      (signals-with (discrepancy:replay-error "reach" "0.45")
        (discrepancy:replay (edited file (format nil "\"reach\": ~f" reach)
                                    "\"reach\": 0.95"))))))

(test the-final-sentence-names-the-tolerances
  (flet ((headline (&rest options)
           (subseq (discrepancy:result-text (apply #'find-in-tolerant-domain options)) 0 120)))
    (is (null (search "drawn" (headline :parameters '(:reach 0.85)))))
    (is (search "NO DISCREPANCY" (headline :parameters '(:reach 0.85))))))

(test a-single-run-draws-nothing
  (discrepancy:ensure-plan 'discrepancy-finder-user::move-the-box)
  (flet ((run-of (&rest options)
           (apply #'discrepancy:run-plan 'discrepancy-finder-user::move-the-box
                  :domain (tolerant-domain) options)))
    (is (= 0.8d0 (getf (discrepancy:run-tolerances (run-of)) :reach)))
    (is (search "tolerances reach = 0.8" (discrepancy:run-text (run-of))))
    (is (= 0.5d0 (getf (discrepancy:run-tolerances (run-of :parameters '(:reach 0.5)))
                       :reach)))
    (signals-with (projection:impossible-parameter "reach" "2")
      (run-of :parameters '(:reach 2)))))
