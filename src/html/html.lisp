;;;; HTML and SVG from lists.
;;;;
;;;; A NODE is a string, which is escaped; a number; NIL, nothing; a list (:tag (:attribute value
;;;; ...) node ...), an element; or a list of nodes.  Names of attributes that are not lower case
;;;; throughout, as some of SVG's, are strings; an attribute with the value NIL is left out.
;;;; WRITE-NODE is the entry point.

(in-package #:discrepancy-finder.html)

(defun write-escaped (text stream)
  "Write TEXT to STREAM with what has a meaning in HTML as character references."
  (loop for character across text
        do (case character
             (#\& (write-string "&amp;" stream))
             (#\< (write-string "&lt;" stream))
             (#\> (write-string "&gt;" stream))
             (#\" (write-string "&quot;" stream))
             (t (write-char (if (or (graphic-char-p character)
                                    (find character '(#\Tab #\Newline)))
                                character
                                #\Replacement_character)
                            stream)))))

(defun value-string (value)
  "Return the text of VALUE, a string or a number; floats have three places behind the point at
most."
  (etypecase value
    (string value)
    (integer (princ-to-string value))
    (real (let ((text (format nil "~,3f" value)))
            (string-right-trim "." (string-right-trim "0" text))))))

(defun attribute-name (name)
  (if (stringp name) name (string-downcase name)))

(defparameter *void-elements* '(:meta :br :hr :link)
  "Elements of HTML that have no end tag.")

(defun write-element (tag attributes nodes stream)
  (let ((name (string-downcase tag)))
    (format stream "<~a" name)
    (loop for (attribute value) on attributes by #'cddr
          do (when value
               (format stream " ~a=\"" (attribute-name attribute))
               (write-escaped (value-string value) stream)
               (write-char #\" stream)))
    (write-char #\> stream)
    (unless (member tag *void-elements*)
      (dolist (node nodes)
        (write-node node stream))
      (format stream "</~a>" name))
    (when (member tag '(:p :div :section :tr :table :li :ul :h1 :h2 :h3 :pre :svg :g :path
                        :polygon :polyline :circle :text :dl :dd :title :style :header :footer))
      (terpri stream))))

(defun write-node (node stream)
  "Write NODE, in the notation above, to STREAM."
  (cond ((null node))
        ((stringp node) (write-escaped node stream))
        ((numberp node) (write-escaped (value-string node) stream))
        ((eq (first node) :verbatim) (write-string (second node) stream))
        ((keywordp (first node))
         (destructuring-bind (tag attributes . nodes) node
           (write-element tag attributes nodes stream)))
        (t (dolist (part node) (write-node part stream)))))

(defun node-text (node)
  "Return the HTML text of NODE."
  (with-output-to-string (stream) (write-node node stream)))
