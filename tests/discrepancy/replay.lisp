(in-package #:discrepancy-finder.tests)

(def-suite replay :in all)
(in-suite replay)

(defun stored-discrepancy (file)
  "Find the discrepancy of seed 1 and store it in FILE."
  (let ((discrepancy (df:result-discrepancy (find-in-example 0.5 :seed 1))))
    (df:save-discrepancy discrepancy file)
    discrepancy))

(defmacro with-stored-discrepancy ((file discrepancy) &body body)
  `(uiop:with-temporary-file (:pathname path :type "json")
     (let* ((,file (namestring path))
            (,discrepancy (stored-discrepancy ,file)))
       (declare (ignorable ,discrepancy))
       ,@body)))

(test a-replay-has-the-same-bits
  (with-stored-discrepancy (file discrepancy)
    (let ((result (df:replay file)))
      (is (eq :same-bits (df:replay-status result)))
      (is (= (df:run-hash (df:discrepancy-run discrepancy))
             (df:run-hash (discrepancy:discrepancy-run (discrepancy:replay-discrepancy result)))))
      (is (null (discrepancy::replay-changed-files result))))))

(defun edited (file old new)
  "Replace OLD, which must occur once in FILE, by NEW."
  (let* ((text (uiop:read-file-string file))
         (position (search old text)))
    (assert position () "~s is not in the file" old)
    (with-open-file (stream file :direction :output :if-exists :supersede)
      (write-string (subseq text 0 position) stream)
      (write-string new stream)
      (write-string (subseq text (+ position (length old))) stream))
    file))

(test other-bits-and-other-verdicts-are-told-apart
  (with-stored-discrepancy (file discrepancy)
    (is (eq :same-verdict
            (df:replay-status
             (let ((digit (char (format nil "~(~16,'0x~)"
                                        (df:run-hash (df:discrepancy-run discrepancy)))
                                0)))
               (df:replay (edited file (format nil "\"hash\": \"~a" digit)
                                  (format nil "\"hash\": \"~a"
                                          (if (char= digit #\0) #\1 #\0)))))))))
  (with-stored-discrepancy (file discrepancy)
    (is (eq :other-verdict
            (df:replay-status (df:replay (edited file "\"reach\": 0.5" "\"reach\": 0.9")))))))

(defmacro replay-problem-of ((old new) &rest parts)
  "Check the report for a stored discrepancy in which OLD is replaced by NEW."
  `(with-stored-discrepancy (file discrepancy)
     (signals-with (df:replay-error file ,@parts) (df:replay (edited file ,old ,new)))))

(test a-bad-replay-file-is-refused-whole
  (signals-with (df:replay-error "no/such.json" "no such file") (df:replay "no/such.json"))
  (with-file (file "" "json") (signals-with (df:replay-error file) (df:replay file)))
  (with-file (file "{}" "json")
    (signals-with (df:replay-error file "no replay file") (df:replay file)))
  (with-file (file "[1, 2]" "json") (signals-with (df:replay-error file) (df:replay file)))
  (with-file (file "#.(print 1)" "json") (signals-with (df:replay-error file) (df:replay file)))
  (replay-problem-of ("discrepancy 2\"" "discrepancy 3\"") "no replay file")
  (replay-problem-of ("\"seed\": 1" "\"seed\": -1") "\"seed\"")
  (replay-problem-of ("\"seed\": 1," "") "seed")
  (replay-problem-of ("\"seed\": 1" "\"seed\": #.(print 1)"))
  (replay-problem-of ("\"name\": \"move-the-box\"" "\"name\": \"no-such-plan\"") "no-such-plan")
  (replay-problem-of ("\"name\": \"two-regions\"" "\"name\": \"nowhere\"") "nowhere")
  (replay-problem-of ("\"reach\"" "\"reech\"") "reech")
  (replay-problem-of ("\"(robot-in r1)\"" "\"(robot-in r9)\"") "(robot-in r9)" "fluent")
  (replay-problem-of ("\"(box-in r2)\"" "\"(box-in r1)\"") "does not allow" "initial state")
  (replay-problem-of ("\"(move r2)\"" "\"(move r1)\"") "does not allow" "step 2")
  (replay-problem-of ("\"arguments\": []" "\"arguments\": [true]") "arguments")
  (replay-problem-of ("\"box.x\": " "\"box.x\": 9e300, \"box.w\": ") "6 values")
  (replay-problem-of ("\"box.x\": 1" "\"box.x\": 10000000000") "box.x")
  (replay-problem-of ("\"reach\": 0.5" "\"reach\": -0.5") "reach" "positive")
  (replay-problem-of ("\"(pick-up)\"" "\"(kick)\"") "(kick)" "event")
  (replay-problem-of ("\"outcome\": \"success\"" "\"outcome\": \"sucess\"") "sucess")
  (replay-problem-of ("\"box.x\"" "\"box.w\"") "box.x")
  (replay-problem-of ("\"execution\": \"trace\"" "\"execution\": \"fast\"") "execution")
  (replay-problem-of ("\"box-delivered\"" "\"box-lost\"") "box-lost")
  (replay-problem-of ("\"verdict\": \"discrepancy\"" "\"verdict\": \"maybe\"") "verdict")
  (replay-problem-of ("\"final\": [" "\"final\": [3, ") "final")
  (replay-problem-of ("\"step\": 2" "\"step\": 0") "step")
  (replay-problem-of ("}" "") ""))

(test a-file-keeps-its-old-content-or-gets-the-new
  (uiop:with-temporary-file (:pathname path :type "json")
    (with-open-file (stream path :direction :output :if-exists :supersede)
      (write-string "old" stream))
    (let ((file (namestring path)))
      (signals error (discrepancy::write-file-whole file :not-a-string))
      (is (string= "old" (uiop:read-file-string path)))
      (discrepancy::write-file-whole file "new")
      (is (string= "new" (uiop:read-file-string path)))))
  (signals-with (df:replay-error "/no/such/folder/x.json" "cannot be written")
    (discrepancy::write-file-whole "/no/such/folder/x.json" "text"))
  (signals-with (df:replay-error "folder")
    (discrepancy::write-file-whole (namestring (uiop:temporary-directory)) "text"))
  (let ((odd (format nil "~adf-[~36r].json" (namestring (uiop:temporary-directory))
                     (random (expt 36 8)))))
    (unwind-protect
         (progn (stored-discrepancy odd)
                (is (eq :same-bits (df:replay-status (df:replay odd))) "a name with brackets"))
      (uiop:delete-file-if-exists (uiop:parse-native-namestring odd))))
  (uiop:with-temporary-file (:pathname path)
    (let ((plain (format nil "~a-plain" (namestring path))))
      (unwind-protect
           (progn (discrepancy::write-file-whole plain "text")
                  (is (string= "text" (uiop:read-file-string plain)) "a name without a type"))
        (uiop:delete-file-if-exists plain)))))

(test a-stored-discrepancy-names-what-it-depends-on
  (with-stored-discrepancy (file discrepancy)
    (let ((object (json:parse (uiop:read-file-string file))))
      (is (= 7 (length (json:get-key object "files")))
          "plan, domain, theory, scene, and three models")
      (is (eql 1 (json:get-key object "seed")))
      (is (equalp #("(robot-in r2)" "(box-in r2)")
                  (json:get-key (json:get-key object "run") "final")))))
  (with-stored-discrepancy (file discrepancy)
    (edited file "domain.lisp\": \"" "domain.lisp\": \"x")
    (is (= 1 (length (discrepancy::replay-changed-files (df:replay file)))))))
