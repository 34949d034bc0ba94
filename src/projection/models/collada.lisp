;;;; Damaged Collada files, on which assimp would crash, loop or fill the memory.
;;;;
;;;; CHECK-COLLADA reads such a file as XML before assimp does: what is referred to must be there,
;;;; what is counted must fit into the file, and where numbers are expected there are only numbers.

(in-package #:discrepancy-finder.projection)

(defun file-size (path)
  (with-open-file (stream path :element-type '(unsigned-byte 8))
    (file-length stream)))

(defun map-elements (function element)
  "Call FUNCTION with ELEMENT and with all elements in it."
  (funcall function element)
  (dolist (child (xml-element-children element))
    (map-elements function child)))

(defparameter *collada-attributes*
  '(("float_array" "id" "count") ("accessor" "source" "count") ("input" "semantic" "source")
    ("triangles" "count") ("polylist" "count") ("polygons" "count") ("lines" "count")
    ("source" "id") ("vertices" "id") ("geometry" "id") ("instance_geometry" "url"))
  "Names of elements with the attributes that they must have.")

(defun check-collada-attributes (element ids size)
  "Signal URDF-ERROR if ELEMENT lacks an attribute, refers to what is not in the hash table IDS, or
counts what cannot be in a file of SIZE octets."
  (dolist (name (rest (assoc (xml-element-name element) *collada-attributes* :test #'string=)))
    (required-attribute element name))
  (loop for (name . value) in (xml-element-attributes element)
        do (when (and (member name '("url" "source" "target") :test #'string=)
                      (alexandria:starts-with #\# value)
                      (not (gethash (subseq value 1) ids)))
             (urdf-problem element "<~a> refers to ~a, which is not there"
                           (xml-element-name element) value))
           (when (member name '("count" "stride" "offset" "set") :test #'string=)
             (unless (and (plusp (length value)) (every #'digit-char-p value)
                          (< (length value) 10) (<= (parse-integer value) size))
               (urdf-problem element "<~a> has the ~a ~a" (xml-element-name element) name
                             value)))))

(defun check-collada-numbers (element)
  "Signal URDF-ERROR if ELEMENT is to hold numbers and holds something else."
  (let ((characters (alexandria:switch ((xml-element-name element) :test #'string=)
                      ("p" "0123456789")
                      ("vcount" "0123456789")
                      ("v" "0123456789-")
                      ("float_array" "0123456789+-.eE")
                      ("matrix" "0123456789+-.eE")
                      ("translate" "0123456789+-.eE")
                      ("rotate" "0123456789+-.eE")
                      ("scale" "0123456789+-.eE"))))
    (when characters
      (let ((odd (find-if-not (lambda (character)
                                (or (find character *white-space*) (find character characters)))
                              (xml-element-text element))))
        (when odd
          (urdf-problem element "<~a> holds ~:c where numbers were expected"
                        (xml-element-name element) odd))))))

(defun collada-complaint (path)
  "Return what is wrong with the XML of the Collada file PATH or with its references, or NIL."
  (handler-case
      (let ((ids (make-hash-table :test 'equal)) (root (read-xml path)) (size (file-size path)))
        (map-elements (lambda (element)
                        (when (attribute element "id")
                          (setf (gethash (attribute element "id") ids) t)))
                      root)
        (map-elements (lambda (element)
                        (check-collada-attributes element ids size)
                        (check-collada-numbers element))
                      root)
        nil)
    (urdf-error (condition)
      (format nil "~@[in line ~d, ~]~a" (urdf-error-line condition)
              (urdf-error-reason condition)))))

(defun check-collada (path element)
  (let ((complaint (collada-complaint path)))
    (when complaint
      (urdf-problem element "the mesh ~a cannot be read: ~a" (source:native-name path)
                    complaint))))
