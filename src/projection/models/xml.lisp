;;;; XML elements that know their lines, and how to take them apart.
;;;;
;;;; READ-XML (xml-reader.lisp) returns the root element of a file.  Text between elements is
;;;; dropped, URDF has none.  URDF-PROBLEM signals what is wrong with an element; it names the file,
;;;; the line and the link or joint in which it is.

(in-package #:discrepancy-finder.projection)

(defstruct (xml-element (:copier nil))
  "An element: its NAME with prefix, if any, its ATTRIBUTES, a list of (name . value), its CHILDREN,
and the LINE of the file in which it begins."
  (name "" :type string :read-only t)
  (attributes '() :type list :read-only t)
  (children '() :type list)
  (line nil :type (or null integer) :read-only t))

(defmethod print-object ((element xml-element) stream)
  (print-unreadable-object (element stream :type t)
    (format stream "<~a>~@[ in line ~d~]" (xml-element-name element) (xml-element-line element))))

(defvar *model-file* ""
  "The name of the file that is being read.")

(defvar *model-part* nil
  "The link or joint that is being read, such as \"link base_link\", or NIL.")

(defun urdf-complaint (place control &rest arguments)
  "Return the URDF-ERROR that URDF-PROBLEM signals."
  (let ((*read-default-float-format* 'double-float))
    (make-condition 'urdf-error :file *model-file* :element *model-part*
                                :line (if (xml-element-p place) (xml-element-line place) place)
                                :reason (substitute #\Space #\Newline
                                                    (apply #'format nil control arguments)))))

(defun urdf-problem (place control &rest arguments)
  "Signal a URDF-ERROR about the file that is being read; PLACE is an element, a line or NIL."
  (error (apply #'urdf-complaint place control arguments)))

;;; Taking elements apart

(defun children (element name)
  "Return the children of ELEMENT that have NAME."
  (remove name (xml-element-children element) :key #'xml-element-name :test-not #'string=))

(defun child (element name)
  "Return the only child of ELEMENT with NAME, or NIL."
  (let ((children (children element name)))
    (when (rest children)
      (urdf-problem (second children) "there are two <~a>" name))
    (first children)))

(defun attribute (element name &optional default)
  "Return the attribute NAME of ELEMENT, a string, or DEFAULT."
  (let ((entry (assoc name (xml-element-attributes element) :test #'string=)))
    (if entry (cdr entry) default)))

(defun required-attribute (element name)
  (or (attribute element name)
      (urdf-problem element "<~a> has no attribute ~a" (xml-element-name element) name)))

(defun name-attribute (element name)
  "Return the attribute NAME of ELEMENT, which is a name of something."
  (let ((value (string-trim '(#\Space #\Tab #\Newline #\Return)
                            (required-attribute element name))))
    (if (string= value "")
        (urdf-problem element "the attribute ~a of <~a> is empty" name (xml-element-name element))
        value)))
