(in-package #:discrepancy-finder.tests)

(def-suite json :in all)
(in-suite json)

(defun json-bits (number)
  "Return the 64 bits of the double float NUMBER as an integer."
  (logior (ash (ldb (byte 32 0) (sb-kernel:double-float-high-bits number)) 32)
          (sb-kernel:double-float-low-bits number)))

(defun random-finite-double (state)
  (loop
    (let ((number (sb-kernel:make-double-float (- (random (ash 1 32) state) (ash 1 31))
                                               (random (ash 1 32) state))))
      (unless (or (sb-ext:float-infinity-p number) (sb-ext:float-nan-p number))
        (return number)))))

(defun random-denormal (state)
  (sb-kernel:make-double-float (if (zerop (random 2 state)) 0 (- (ash 1 31)))
                               (1+ (random (ash 1 (1+ (random 31 state))) state))))

(defun random-json-text (state)
  "Return a random string; control characters, quotes and characters beyond 16 bits are likely."
  (coerce (loop repeat (random 8 state)
                collect (loop for code = (random (aref #(32 128 #x10000 #x110000) (random 4 state))
                                                 state)
                              unless (<= #xd800 code #xdfff) return (code-char code)))
          'simple-string))

(defun random-json-value (state depth)
  (ecase (random (if (plusp depth) 8 6) state)
    (0 (random-finite-double state))
    (1 (- (random (expt 10 (1+ (random 30 state))) state) 1000))
    ((2 3) (random-json-text state))
    (4 (aref #(:true :false :null) (random 3 state)))
    (5 (random-denormal state))
    (6 (coerce (loop repeat (random 5 state) collect (random-json-value state (1- depth)))
               'simple-vector))
    (7 (loop for i below (random 5 state)
             collect (cons (format nil "~a~d" (random-json-text state) i)
                           (random-json-value state (1- depth)))))))

(defun same-json-p (a b)
  "True if A and B are the same JSON value: the same types, the same bits, keys in the same order."
  (typecase a
    (string (and (typep b 'simple-string) (string= a b)))
    (vector (and (typep b 'simple-vector) (= (length a) (length b)) (every #'same-json-p a b)))
    (cons (and (consp b) (same-json-p (car a) (car b)) (same-json-p (cdr a) (cdr b))))
    (t (eql a b))))

(test json-reading
  (is (same-json-p '(("a" . 1) ("b" . #(1 2.5d0 "x" :true :false :null)) ("c") ("d" . #()))
                   (json:parse " {\"a\" : 1,
\"b\":[1, 2.5 ,\"x\",true,false,null],\"c\":{},\"d\":[]} ")))
  (is (eql -0d0 (json:parse "-0.0")))
  (is (eql 0 (json:parse "-0")))
  (is (eql 1d300 (json:parse "1E+300")))
  (is (eql 100d0 (json:parse "1e2")))
  (is (eql 0.1d0 (json:parse "0.1")))
  (is (eql (expt 10 40) (json:parse (format nil "~d" (expt 10 40)))))
  (is (eql 0d0 (json:parse "1e-400")))
  (is (null (json:parse "{}")))
  (is (equalp #() (json:parse "[ ]")))
  (is (string= (coerce '(#\" #\\ #\/ #\Backspace #\Page #\Newline #\Return #\Tab) 'string)
               (json:parse "\"\\\"\\\\\\/\\b\\f\\n\\r\\t\"")))
  (is (string= (string (code-char #x1f600)) (json:parse "\"\\ud83D\\uDE00\"")))
  (is (string= (string (code-char #xe9)) (json:parse "\"\\u00e9\"")))
  (is (member (json:library-name) '("yason" "cl-json") :test #'string=)))

(test json-number-syntax-does-not-depend-on-the-reader
  (let ((*read-base* 16) (*read-default-float-format* 'single-float) (*print-base* 2)
        (*print-radix* t))
    (is (eql 10 (json:parse "10")))
    (is (eql 0.1d0 (json:parse "0.1")))
    (is (string= "[10,0.1]" (json:encode (vector 10 0.1d0))))))

(test json-reading-refuses
  (dolist (text (list "" " " "-" "+5" "01" "-01" "1." ".5" "1e" "1e+" "0x10" "1_0" "1d0" "1/2"
                      "1e999" "-1e999" "[1e999]" "NaN" "Infinity" "-Infinity" "nan" "nul" "True"
                      "nullx" "'a'" "#.(+ 1 2)" "#c(1 2)" "|a|" "(1)"
                      "1 2" "[1] x" "{} {}" "[1,]" "[,1]" "[1 2]" "[1" "[" "]" "[1}" "{" "}"
                      "{\"a\"" "{\"a\":" "{\"a\":1" "{\"a\":1," "{\"a\":1,}" "{\"a\" 1}" "{a:1}"
                      "{'a':1}" "{1:1}" "{null:1}" "{\"a\":}" "\"" "\"a" "\"\\" "\"\\u12" "\"\\x\""
                      "\"\\u12g4\"" "\"\\u+123\"" "\"\\ud800\"" "\"\\ud800x\"" "\"\\ud800\\n\""
                      "\"\\udc00\"" "\"\\ud800\\ud800\"" "\"\\U0041\""
                      (format nil "\"a~%b\"") (format nil "\"a~cb\"" (code-char 0))
                      (format nil "\"~c\"" (code-char #xd800))
                      (format nil "~c1" (code-char #xfeff))
                      (format nil "~c" (code-char #x661)) ; a digit, but an Arabic one
                      (format nil "[~c1]" (code-char #xa0))
                      "{\"a\":1,\"a\":2}" "{\"a\":1,\"\\u0061\":2}" "[{\"x\":{\"k\":1,\"k\":1}}]"
                      (make-string 100000 :initial-element #\[)
                      (make-string 100000 :initial-element #\1)
                      (format nil "~a1~a" (make-string 513 :initial-element #\[)
                              (make-string 513 :initial-element #\]))
                      (with-output-to-string (stream)
                        (dotimes (i 100000) (write-string "{\"a\":" stream)))))
    (signals (json:json-error "~s is not refused" (subseq text 0 (min 40 (length text))))
      (json:parse text)))
  (is (json:parse (format nil "~a1~a" (make-string 512 :initial-element #\[)
                          (make-string 512 :initial-element #\])))))

(test json-infinities-are-refused-without-traps
  (sb-int:with-float-traps-masked (:overflow :invalid :divide-by-zero :inexact)
    (signals json:json-error (json:parse "1e999"))))

(test json-every-truncation-is-refused
  (let ((text (json:encode (json:object "a" (vector 1 -0.5d-7 :null)
                                        "b" (format nil "x~c" (code-char #x1f600))))))
    (dotimes (end (length text))
      (signals json:json-error (json:parse (subseq text 0 end))))))

(defun json-message (text)
  (handler-case (json:parse text)
    (json:json-error (condition)
      (cons (json:json-error-position condition) (princ-to-string condition)))))

(test json-messages
  (is (equal '(4 . "JSON at character 4: a value is expected, not the character #\\].")
             (json-message "[1, ]")))
  (is (equal '(2 . "JSON at character 2: a comma or #\\] is expected, but the text ends.")
             (json-message "[1")))
  (is (equal '(2 . "JSON at character 2: the end of the text is expected, not the character #\\2.")
             (json-message "1 2")))
  (is (equal '(1 . "JSON at character 1: a string is expected, not the character #\\a.")
             (json-message "{a:1}")))
  (is (equal '(1 . "JSON at character 1: a surrogate stands alone.")
             (json-message "\"\\ud800\"")))
  (is (equal '(512 . "JSON at character 512: arrays and objects are nested deeper than 512.")
             (json-message (make-string 100000 :initial-element #\[))))
  (is (equal '(nil . "JSON: the key \"a\" occurs twice in an object.")
             (json-message "{\"a\":1,\"a\":1}")))
  (is (equal '(nil . "JSON: a number is beyond the range of a double float.")
             (json-message "1e999"))))

(test json-writing
  (is (string= "{\"b\":1,\"a\":[1.0,\"x\",true,{},[],null,false]}"
               (json:encode (json:object "b" 1
                                         "a" (vector 1d0 "x" :true '() #() :null :false)))))
  (is (string= "\"\\\"\\\\/\\n\\u0001\\u007f\\u00e9\\ud83d\\ude00\""
               (json:encode (coerce (list #\" #\\ #\/ #\Newline (code-char 1) (code-char 127)
                                          (code-char #xe9) (code-char #x1f600))
                                    'string))))
  (is (string= "[0.5,-2.0]"
               (json:encode (make-array 2 :element-type 'double-float
                                          :initial-contents '(0.5d0 -2d0)))))
  (is (string= "7" (with-output-to-string (stream) (json:write-value 7 stream)))))

(test json-writing-pretty
  (is (string= "{
  \"seed\": 1,
  \"empty\": {},
  \"none\": [],
  \"row\": [1, 2.0, \"x\"],
  \"rows\": [
    [1, 2],
    {
      \"k\": null
    }
  ]
}"
               (json:encode (json:object "seed" 1 "empty" '() "none" #() "row" (vector 1 2d0 "x")
                                         "rows" (vector #(1 2) (json:object "k" :null)))
                            :pretty t))))

(test json-writing-refuses
  (let ((circular (list (cons "a" 1))))
    (setf (cdr circular) circular)
    (dolist (value (list 0.5 1/2 #c(1 2) t :yes 'a #\a
                         sb-ext:double-float-positive-infinity
                         sb-ext:double-float-negative-infinity
                         (sb-kernel:make-double-float -524288 0) ; a NaN
                         (string (code-char #xdc00))
                         '(1 2) '("a" "b") '(("a" . 1) . 2) '((:a . 1)) circular
                         '(("a" . 1) ("a" . 2))
                         (vector 1 0.5) (list (cons "a" 1/2))
                         (let ((deep #())) (dotimes (i 513 deep) (setf deep (vector deep))))))
      (signals json:json-error (json:encode value))))
  (is (string= "JSON: there is no JSON text for a single float."
               (handler-case (json:encode 0.5) (json:json-error (c) (princ-to-string c)))))
  (is (string= "" (with-output-to-string (stream)
                    (signals json:json-error (json:write-value (vector 1 0.5) stream))))))

(test json-objects
  (let ((object (json:object "a" 1 "b" '())))
    (is (eql 1 (json:get-key object "a")))
    (is (eql nil (json:get-key object "b" :default)))
    (is (eql :default (json:get-key object "c" :default)))
    (is (eql nil (json:get-key object "c" nil)))
    (is (string= "JSON: the key \"c\" is missing."
                 (handler-case (json:get-key object "c")
                   (json:json-error (condition) (princ-to-string condition)))))
    (is (string= "JSON: the key \"c\" is sought in an array, which is not an object."
                 (handler-case (json:get-key #() "c" 1)
                   (json:json-error (condition) (princ-to-string condition)))))
    (signals json:json-error (json:object "a" 1 "a" 2))))

(test json-doubles-keep-their-bits
  (let ((state (sb-ext:seed-random-state 1)))
    (flet ((check (number)
             (let ((text (json:encode number)))
               (unless (and (eql (json-bits number) (json-bits (json:parse text)))
                            (not (find #\d text)))
                 (fail "~s is written as ~a" number text)))))
      (mapc #'check (list 0d0 -0d0 1d0 1d300 1d-300 1d7 1d-3 123456789d0 5d-324
                          most-positive-double-float most-negative-double-float
                          least-positive-double-float least-negative-double-float
                          least-positive-normalized-double-float double-float-epsilon pi
                          2.225073858507201d-308))
      (loop repeat 2000
            do (check (random-finite-double state))
               (check (random-denormal state)))))
  (is (string= "1.0e300" (json:encode 1d300)))
  (is (string= "-0.0" (json:encode -0d0)))
  (is (string= "0.1" (json:encode 0.1d0))))

(test json-values-survive
  (let ((state (sb-ext:seed-random-state 2)))
    (loop repeat 2000
          for value = (random-json-value state 4)
          for pretty in '#1=(nil t . #1#)
          for text = (json:encode value :pretty pretty)
          do (unless (and (same-json-p value (json:parse text))
                          (every (lambda (c) (or (<= 32 (char-code c) 126) (char= c #\Newline)))
                                 text))
               (fail "~a does not survive" text))
          finally (pass))))
