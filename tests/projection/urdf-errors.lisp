;;;; URDF files that are wrong: each is refused in one sentence that names file, line and part.

(in-package #:discrepancy-finder.tests)

(def-suite urdf :in all)
(in-suite urdf)

(defun urdf-lines (&rest lines)
  "Return the text of a URDF file with LINES, the first of which is line 2."
  (format nil "<robot name=\"r\">~%~{~a~%~}</robot>" lines))

(defun collision-of (geometry)
  (format nil "<collision><geometry>~a</geometry></collision>" geometry))

(defun link-with (&rest content)
  (format nil "<link name=\"a\">~{~a~}</link>" content))

(defun joint-with (content &key (type "revolute") (name "j") (parent "a") (child "b"))
  (format nil "<joint name=\"~a\" type=\"~a\"><parent link=\"~a\"/><child link=\"~a\"/>~a</joint>"
          name type parent child content))

(defparameter *two-links* "<link name=\"a\"/><link name=\"b\"/>")

(defparameter *limit* "<limit lower=\"-1\" upper=\"1\"/>")

(defparameter *wrong-urdf-files*
  `(;; XML
    ("" ":1: " "it is empty")
    ("robot" ":1: " "does not begin with <")
    ("<robot name=\"r\"><link" ":1: " "not well-formed XML" "<link>")
    ("<robot name=\"r\">" ":1: " "<robot>, which begins here, is not closed")
    (,(format nil "<robot>~%<link name=\"a\">~%</robot>") ":3: " "</link> was expected" "line 2")
    (,(format nil "<robot>~%~%<link name=a/></robot>") ":3: " "not in quotes")
    (,(format nil "<robot>~%<link name=\"a/></robot>") ":2: " "not closed")
    (,(format nil "<robot>~%<link name=\"a\" name=\"b\"/></robot>") ":2: " "two attributes name")
    (,(format nil "<robot>~%<link name=\"a\"x=\"b\"/></robot>") ":2: " "a space is missing")
    (,(format nil "<robot>~%<!-- <link/></robot>") ":2: " "the comment" "not closed")
    (,(format nil "<robot>~%<![CDATA[</robot>") ":2: " "CDATA")
    (,(format nil "<robot>~%</robot>~%<robot/>") ":3: " "after the root element")
    (,(format nil "<robot>~%~%~a</robot>" (code-char 0)) ":3: " "character of code 0")
    ("<robot name=\"&nosuch;\"/>" ":1: " "entity &nosuch;")
    ("<robot name=\"&#0;\"/>" ":1: " "&#0; is no character")
    ("<robot name=\"a & b\"/>" ":1: " "&")
    (,(format nil "<?xml version=\"1.0\"?>~%<!DOCTYPE robot [<!ENTITY e SYSTEM ~
                   \"file:///etc/passwd\">]>~%<robot name=\"&e;\"/>")
     ":2: " "DOCTYPE" "not followed")
    ("<!DOCTYPE robot SYSTEM \"http://example.org/x.dtd\"><robot/>" ":1: " "not followed")
    ("<?xml version=\"1.0\" encoding=\"ebcdic\"?><robot/>" ":1: " "the encoding ebcdic")
    (,(format nil "~{~a~}" (loop repeat 100000 collect "<robot>")) ":1: " "more than 200 deep")
    ;; the root
    ("<sdf version=\"1\"/>" ":1: " "<sdf>, not <robot>")
    ("<robot><link name=\"a\"/></robot>" ":1: " "no attribute name")
    ("<robot name=\" \"><link name=\"a\"/></robot>" ":1: " "name of <robot> is empty")
    ("<robot name=\"r\"/>" ":1: " "it has no link")
    ;; xacro
    (,(format nil "<robot name=\"r\" xmlns:xacro=\"http://ros.org/wiki/xacro\">~%~
                   <xacro:include filename=\"a.xacro\"/></robot>") ":2: " "<xacro:include>" "xacro")
    (,(urdf-lines "<link name=\"${prefix}_link\"/>") ":2: " "xacro" "${prefix}")
    ;; links
    (,(urdf-lines "<link/>") ":2: " "a link: " "no attribute name")
    (,(urdf-lines "<link name=\"\"/>") ":2: " "is empty")
    (,(urdf-lines "<link name=\"a\"/>" "<link name=\"a\"/>") ":3: " "the link a" "line 2")
    (,(urdf-lines "<link name=\"a\"/>" "<link name=\"b\"/>") ":3: " "no joint is above a")
    (,(urdf-lines (link-with "<collision/>")) ":2: link a: " "without geometry")
    (,(urdf-lines (link-with (collision-of ""))) "link a" "without geometry")
    (,(urdf-lines (link-with (collision-of "<box size=\"1 1 1\"/><box size=\"1 1 1\"/>")))
     "link a" "several shapes")
    (,(urdf-lines (link-with (collision-of "<plane/>"))) "link a" "<plane>" "box, cylinder")
    (,(urdf-lines (link-with (collision-of "<box/>"))) "link a" "<box> has no attribute size")
    (,(urdf-lines (link-with (collision-of "<box size=\"1 1\"/>"))) "\"1 1\"" "3 numbers")
    (,(urdf-lines (link-with (collision-of "<box size=\"1 1 1 1\"/>"))) "3 numbers")
    (,(urdf-lines (link-with (collision-of "<box size=\"1 0 1\"/>"))) "a size of 0.0")
    (,(urdf-lines (link-with (collision-of "<box size=\"1 1 1e7\"/>"))) "million metres")
    (,(urdf-lines (link-with (collision-of "<sphere radius=\"-1\"/>"))) "a size of -1.0")
    (,(urdf-lines "<link name=\"a\">" "<collision><geometry>"
                  "<cylinder radius=\"0\" length=\"1\"/></geometry></collision></link>")
     ":4: link a: " "a size of 0.0")
    (,(urdf-lines (link-with (collision-of "<cylinder radius=\"1\"/>"))) "no attribute length")
    (,(urdf-lines (link-with "<collision><origin xyz=\"0 0\"/></collision>")) "3 numbers")
    (,(urdf-lines (link-with "<collision><origin xyz=\"0 0 1e9\"/></collision>")) "too large")
    (,(urdf-lines (link-with "<collision><origin/><origin/></collision>")) "two <origin>")
    (,(urdf-lines (link-with "<inertial><mass value=\"-2\"/></inertial>")) ":2: link a: "
     "its mass is -2.0 kg")
    (,(urdf-lines (link-with "<inertial><mass/></inertial>")) "<mass> has no attribute value")
    (,(urdf-lines (link-with "<inertial/><inertial/>")) "two <inertial>")
    (,(urdf-lines (link-with "<inertial><inertia ixx=\"1\"/></inertial>")) "no attribute iyy")
    (,(urdf-lines (link-with "<visual><material name=\"m\"><color rgba=\"1 0 0\"/></material>~
                              </visual>")) "4 numbers")
    ;; numbers
    ,@(loop for number in '("" "x" "1,5" "1.2.3" "--1" "1e" "e5" "." "+" "nan" "inf" "0x10" "#.1"
                            "1d0" "1/2" "1 2")
            collect (list (urdf-lines (link-with "<inertial><mass value=\"" number
                                                 "\"/></inertial>"))
                          ":2: link a: " "is no number"))
    ,@(loop for number in '("1e400" "1e309" "-1e999999999999" "1.8e308")
            collect (list (urdf-lines (link-with "<inertial><mass value=\"" number
                                                 "\"/></inertial>"))
                          ":2: link a: " number "too large"))
    ;; joints
    (,(urdf-lines *two-links* "<joint name=\"j\"/>") ":3: joint j: " "no attribute type")
    (,(urdf-lines *two-links* "<joint type=\"fixed\"/>") ":3: a joint: " "no attribute name")
    ,@(loop for type in '("planar" "floating" "ball" "Fixed")
            collect (list (urdf-lines *two-links* (joint-with "" :type type))
                          ":3: joint j: " "the type " type "not supported"))
    (,(urdf-lines *two-links* "<joint name=\"j\" type=\"fixed\"><child link=\"b\"/></joint>")
     "joint j" "no parent")
    (,(urdf-lines *two-links* "<joint name=\"j\" type=\"fixed\"><parent/><child link=\"b\"/>~
                               </joint>") "<parent> has no attribute link")
    (,(urdf-lines *two-links* (joint-with "" :type "fixed" :parent "c")) ":3: joint j: "
     "no link c")
    ,@(loop for type in '("revolute" "prismatic")
            collect (list (urdf-lines *two-links* (joint-with "" :type type)) ":3: joint j: "
                          "needs a limit"))
    (,(urdf-lines *two-links* (joint-with "<limit lower=\"1\" upper=\"-1\"/>"))
     ":3: joint j: " "above the upper")
    (,(urdf-lines *two-links* (joint-with "<limit lower=\"a\" upper=\"1\"/>")) "no number")
    (,(urdf-lines *two-links* (joint-with "<limit lower=\"0\" upper=\"1e9\"/>")) "too far")
    (,(urdf-lines *two-links* (joint-with "<limit effort=\"-1\"/>")) "effort of <limit> is -1")
    (,(urdf-lines *two-links* (joint-with (format nil "~a<axis xyz=\"0 0 0\"/>" *limit*)))
     ":3: joint j: " "no direction")
    (,(urdf-lines *two-links* (joint-with (format nil "~a<axis xyz=\"0 0 1e-200\"/>" *limit*)))
     "axis" "length 1")
    (,(urdf-lines *two-links* (joint-with (format nil "~a<axis xyz=\"1 1\"/>" *limit*)))
     "3 numbers")
    (,(urdf-lines *two-links* (joint-with (format nil "~a<dynamics damping=\"-1\"/>" *limit*)))
     "damping of <dynamics>" "below 0")
    (,(urdf-lines *two-links* (joint-with "" :type "fixed")
                  (joint-with "" :type "fixed" :name "k" :parent "b" :child "a"))
     ":3: joint j: " "cycle")
    (,(urdf-lines *two-links* "<link name=\"c\"/>"
                  (joint-with "" :type "fixed" :parent "b" :child "c")
                  (joint-with "" :type "fixed" :name "k" :parent "c" :child "b"))
     ":4: joint j: " "cycle")
    (,(urdf-lines *two-links* (joint-with "" :type "fixed" :parent "a" :child "a")) "one tree")
    (,(urdf-lines *two-links* (joint-with "" :type "fixed") (joint-with "" :type "fixed"))
     ":4: " "joint j is there already, in line 3")
    (,(urdf-lines *two-links* (joint-with "" :type "fixed")
                  (joint-with "" :type "fixed" :name "k"))
     ":4: joint k: " "the child of the joint j already")
    ;; joints that follow others
    (,(urdf-lines *two-links* (joint-with (format nil "~a<mimic joint=\"k\"/>" *limit*)))
     ":3: joint j: " "the joint k, which does not exist")
    (,(urdf-lines *two-links* (joint-with (format nil "~a<mimic joint=\"j\"/>" *limit*)))
     ":3: joint j: " "follows itself")
    (,(urdf-lines *two-links* "<link name=\"c\"/><link name=\"d\"/>"
                  (joint-with (format nil "~a<mimic joint=\"k\"/>" *limit*))
                  (joint-with (format nil "~a<mimic joint=\"l\"/>" *limit*) :name "k" :child "c")
                  (joint-with (format nil "~a<mimic joint=\"k\"/>" *limit*) :name "l" :child "d"))
     ":4: joint j: " "follow each other")
    (,(urdf-lines *two-links* "<link name=\"c\"/>" (joint-with "" :type "fixed")
                  (joint-with (format nil "~a<mimic joint=\"j\"/>" *limit*) :name "k" :child "c"))
     ":5: joint k: " "which is fixed")
    (,(urdf-lines *two-links* (joint-with (format nil "~a<mimic joint=\"j\" multiplier=\"x\"/>"
                                                  *limit*)))
     "\"x\" is no number")
    ;; meshes
    (,(urdf-lines (link-with (collision-of "<mesh/>"))) "no attribute filename")
    (,(urdf-lines "" (link-with (collision-of "<mesh filename=\"no-such.stl\"/>")))
     ":3: link a: " "no file no-such.stl")
    (,(urdf-lines (link-with (collision-of "<mesh filename=\"package://no_such/a.stl\"/>")))
     ":2: link a: " "the package no_such" "ROS_PACKAGE_PATH")
    (,(urdf-lines (link-with (collision-of "<mesh filename=\"package://a.stl\"/>")))
     ":2: link a: " "no file in a package")
    (,(urdf-lines (link-with (collision-of "<mesh filename=\"http://example.org/a.stl\"/>")))
     "cannot be fetched")
    (,(urdf-lines (link-with (collision-of "<mesh filename=\"/etc/passwd\"/>"))) "of no kind")
    (,(urdf-lines (link-with (collision-of "<mesh filename=\"/etc\"/>"))) "no file /etc"))
  "Texts of URDF files, each with what its error says.")

(test each-wrong-urdf-file-is-refused-in-one-sentence
  (loop for (text . parts) in *wrong-urdf-files*
        do (with-file (file (format nil text) "urdf")
             (let ((report (report-of 'projection:urdf-error
                                      (lambda () (projection:read-urdf file)))))
               (is-true report "this was read: ~a" (subseq text 0 (min 300 (length text))))
               (dolist (part (cons file parts))
                 (is (search part (or report "")) "~s is not in: ~a" part report))
               (is (null (find #\Newline (or report ""))) "more than one line: ~a" report)
               (is (and report (alexandria:ends-with #\. report)) "no sentence: ~a" report)))))

(defun write-octets (file octets)
  (with-open-file (stream file :direction :output :if-exists :supersede
                               :element-type '(unsigned-byte 8))
    (write-sequence (coerce octets '(vector (unsigned-byte 8))) stream)))

(test wrong-bytes-are-no-text
  (with-file (file "" "urdf")
    (flet ((octets (&rest parts)
             (write-octets file (loop for part in parts
                                      append (if (stringp part)
                                                 (map 'list #'char-code part)
                                                 (list part))))))
      (octets "<robot name=\"" 255 "\"><link name=\"a\"/></robot>")
      (signals-with (projection:urdf-error file "not a UTF-8 text") (projection:read-urdf file))
      (octets "<robot name=\"" 195 "\"><link name=\"a\"/></robot>")
      (signals-with (projection:urdf-error file "not a UTF-8 text") (projection:read-urdf file))
      (octets "<?xml version=\"1.0\" encoding=\"iso-8859-1\"?><robot name=\"" 252
              "\"><link name=\"a\"/></robot>")
      (is (string= "ü" (projection:urdf-model-name (projection:read-urdf file))))
      (octets 239 187 191 "<robot name=\"r\"><link name=\"a\"/></robot>")
      (is (string= "r" (projection:urdf-model-name (projection:read-urdf file)))
          "a byte order mark is no text")
      (write-octets file (list* 255 254 (loop for character across
                                              "<robot name=\"r\"><link name=\"a\"/></robot>"
                                              append (list (char-code character) 0))))
      (is (string= "r" (projection:urdf-model-name (projection:read-urdf file))) "UTF-16"))))

(test each-beginning-of-a-urdf-file-is-refused-in-one-sentence
  (let ((text (uiop:read-file-string (root-file "models/two-regions/box.urdf"))))
    (loop for end from 0 below (length (string-right-trim '(#\Newline) text))
          do (with-file (file (subseq text 0 end) "urdf")
               (let ((report (report-of 'projection:urdf-error
                                        (lambda () (projection:read-urdf file)))))
                 (unless (and (search file (or report "")) (null (find #\Newline report)))
                   (fail "The first ~d characters: ~a" end report)))))
    (pass)))

(test files-that-cannot-be-read
  (signals-with (projection:urdf-error "no/such.urdf" "no such file")
    (projection:read-urdf "no/such.urdf"))
  (signals-with (projection:urdf-error "it is a folder")
    (projection:read-urdf (uiop:native-namestring (uiop:temporary-directory)))))
