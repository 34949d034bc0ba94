;;;; Reading an XML file, by expat.
;;;;
;;;; READ-XML returns the root of a file as an XML-ELEMENT (xml.lisp).  Expat calls back at the
;;;; beginning and at the end of each element and for text; the functions that it calls only take
;;;; notes in a READING and never leave through expat's frames: a problem is noted, and signaled
;;;; when expat has returned.  A DOCTYPE that declares something or names another file is refused,
;;;; so that neither a file of the machine nor a small file that stands for a huge one gets in.

(in-package #:discrepancy-finder.projection)

(foreign:define-library expat "the XML parser expat" ("libexpat.so.1" "libexpat.so")
  :hint "apt-get install libexpat1")

(cffi:defcfun ("XML_ParserCreate" %expat-create) :pointer (encoding :pointer))
(cffi:defcfun ("XML_ParserFree" %expat-free) :void (parser :pointer))
(cffi:defcfun ("XML_SetElementHandler" %expat-set-element-handler) :void
  (parser :pointer) (start :pointer) (end :pointer))
(cffi:defcfun ("XML_SetCharacterDataHandler" %expat-set-text-handler) :void
  (parser :pointer) (handler :pointer))
(cffi:defcfun ("XML_SetStartDoctypeDeclHandler" %expat-set-doctype-handler) :void
  (parser :pointer) (handler :pointer))
(cffi:defcfun ("XML_Parse" %expat-parse) :int
  (parser :pointer) (text :pointer) (length :int) (final :int))
(cffi:defcfun ("XML_StopParser" %expat-stop) :int (parser :pointer) (resumable :uchar))
(cffi:defcfun ("XML_GetErrorCode" %expat-error-code) :int (parser :pointer))
(cffi:defcfun ("XML_ErrorString" %expat-error-string) :string (code :int))
(cffi:defcfun ("XML_GetCurrentLineNumber" %expat-current-line) :unsigned-long (parser :pointer))

(defconstant +greatest-depth+ 200
  "How deep elements can be nested.")

(defconstant +unknown-encoding+ 18
  "Expat's XML_ERROR_UNKNOWN_ENCODING.")

(defstruct (reading (:copier nil))
  "What PARSER has met: OPEN are the elements that are not closed yet, innermost first, TEXTS the
pieces of text in each, newest first; ROOT the first element; PROBLEM a list of a line, a format
control and its arguments, or NIL."
  (parser nil :read-only t)
  (open '() :type list)
  (texts '() :type list)
  (root nil)
  (problem nil :type list))

(defvar *reading* nil
  "The READING of the parser that runs in this thread.")

(defun note-problem (control &rest arguments)
  "Note a problem at the present line, and stop the parser."
  (let ((parser (reading-parser *reading*)))
    (setf (reading-problem *reading*) (list* (%expat-current-line parser) control arguments))
    (%expat-stop parser 0)))

(defun attribute-list (attributes)
  "Return the alist of the names and values in the foreign array ATTRIBUTES."
  (flet ((text (index)
           (let ((pointer (cffi:mem-aref attributes :pointer index)))
             (unless (cffi:null-pointer-p pointer)
               (cffi:foreign-string-to-lisp pointer :encoding :utf-8)))))
    (loop for index from 0 by 2
          for name = (text index)
          while name
          collect (cons name (text (1+ index))))))

(cffi:defcallback start-element :void ((data :pointer) (name :string) (attributes :pointer))
  (declare (ignore data))
  (unless (reading-problem *reading*)
    (let ((element (make-xml-element :name name :attributes (attribute-list attributes)
                                     :line (%expat-current-line (reading-parser *reading*)))))
      (if (reading-open *reading*)
          (push element (xml-element-children (first (reading-open *reading*))))
          (setf (reading-root *reading*) element))
      (push element (reading-open *reading*))
      (push '() (reading-texts *reading*))
      (when (> (length (reading-open *reading*)) +greatest-depth+)
        (note-problem "its elements are nested more than ~d deep" +greatest-depth+)))))

(defun joined (pieces)
  "Return the strings PIECES, the last one first, as one.  There can be as many as lines in a file."
  (let* ((end (loop for piece in pieces sum (length piece)))
         (text (make-string end)))
    (dolist (piece pieces text)
      (decf end (length piece))
      (replace text (the string piece) :start1 end))))

(cffi:defcallback end-element :void ((data :pointer) (name :pointer))
  (declare (ignore data name))
  (unless (reading-problem *reading*)
    (let ((element (pop (reading-open *reading*)))
          (text (joined (pop (reading-texts *reading*)))))
      (setf (xml-element-children element) (nreverse (xml-element-children element))
            (xml-element-text element) (string-trim *white-space* text)))))

(cffi:defcallback character-data :void ((data :pointer) (text :pointer) (length :int))
  (declare (ignore data))
  (unless (reading-problem *reading*)
    (push (cffi:foreign-string-to-lisp text :count length :encoding :utf-8)
          (first (reading-texts *reading*)))))

(cffi:defcallback start-doctype :void
    ((data :pointer) (name :pointer) (system :pointer) (public :pointer) (internal :int))
  (declare (ignore data name))
  (unless (and (cffi:null-pointer-p system) (cffi:null-pointer-p public) (zerop internal))
    (note-problem "a DOCTYPE with declarations or an external file is not followed")))

(defun file-octets (file)
  "Return the octets of FILE.  Signals URDF-ERROR."
  (let ((path (source:native-path file)))
    (when (uiop:directory-exists-p (uiop:ensure-directory-pathname path))
      (urdf-problem nil "it is a folder"))
    (handler-case (alexandria:read-file-into-byte-vector path)
      (file-error () (urdf-problem nil (if (uiop:file-exists-p path)
                                           "it cannot be read"
                                           "no such file")))
      (stream-error () (urdf-problem nil "it cannot be read")))))

(defun expat-problem (parser)
  "Return the problem that PARSER has met, as NOTE-PROBLEM notes it."
  (let ((code (%expat-error-code parser)))
    (list (%expat-current-line parser)
          (if (= code +unknown-encoding+)
              "the encoding is not read; UTF-8 is"
              "it is not well-formed XML: ~a")
          (%expat-error-string code))))

(defun parse-octets (octets)
  "Return the READING of OCTETS."
  (let ((parser (%expat-create (cffi:null-pointer))))
    (unwind-protect
         (let ((*reading* (make-reading :parser parser)))
           (%expat-set-element-handler parser (cffi:callback start-element)
                                       (cffi:callback end-element))
           (%expat-set-text-handler parser (cffi:callback character-data))
           (%expat-set-doctype-handler parser (cffi:callback start-doctype))
           ;; An interrupt must not unwind through expat either.
           (when (zerop (sb-sys:without-interrupts
                          (cffi:with-pointer-to-vector-data (text octets)
                            (%expat-parse parser text (length octets) 1))))
             (unless (reading-problem *reading*)
               (setf (reading-problem *reading*) (expat-problem parser))))
           *reading*)
      (%expat-free parser))))

(defun read-xml (file)
  "Return the root XML-ELEMENT of FILE.  Signals URDF-ERROR."
  (let* ((octets (coerce (file-octets file) '(simple-array (unsigned-byte 8) (*))))
         (reading (parse-octets octets)))
    (when (reading-problem reading)
      (apply #'urdf-problem (reading-problem reading)))
    (reading-root reading)))
