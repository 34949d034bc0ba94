;;;; Reading an XML file.
;;;;
;;;; READ-XML returns the root of a file as an XML-ELEMENT (xml.lisp).  It reads what XML 1.0 allows
;;;; in a document without declarations; it opens no other file and expands nothing but the five
;;;; predefined entities and character references.  A DOCTYPE that declares entities or names
;;;; another file is refused, so that neither a file of the machine nor a small file that stands
;;;; for a huge one gets in.  A CURSOR goes through the text once; it counts the lines.

(in-package #:discrepancy-finder.projection)

(defparameter *greatest-depth* 200
  "How deep elements can be nested.")

(defstruct (cursor (:constructor make-cursor (text)) (:copier nil))
  "A POSITION in TEXT, and the number of the LINE in which the position COUNTED is."
  (text "" :type simple-string :read-only t)
  (position 0 :type fixnum)
  (line 1 :type fixnum)
  (counted 0 :type fixnum))

(defun current-line (cursor)
  "Return the line in which CURSOR is, counted from 1."
  (incf (cursor-line cursor)
        (count #\Newline (cursor-text cursor)
               :start (cursor-counted cursor) :end (cursor-position cursor)))
  (setf (cursor-counted cursor) (cursor-position cursor))
  (cursor-line cursor))

(defun malformed (line control &rest arguments)
  (urdf-problem line "it is not well-formed XML: ~?" control arguments))

;;; Text

(defun file-octets (file)
  (let ((path (source:native-path file)))
    (when (uiop:directory-exists-p (uiop:ensure-directory-pathname path))
      (urdf-problem nil "it is a folder"))
    (handler-case (alexandria:read-file-into-byte-vector path)
      (file-error () (urdf-problem nil (if (uiop:file-exists-p path)
                                           "it cannot be read"
                                           "no such file")))
      (stream-error () (urdf-problem nil "it cannot be read")))))

(defun declared-encoding (octets)
  "Return the encoding that the XML declaration at the start of OCTETS names, or NIL."
  (let* ((head (map 'string #'code-char (subseq octets 0 (min 200 (length octets)))))
         (end (and (alexandria:starts-with-subseq "<?xml" head) (search "?>" head)))
         (start (and end (search "encoding" head :end2 end)))
         (open (and start (position-if (lambda (character) (find character "'\""))
                                       head :start start :end end)))
         (close (and open (position (char head open) head :start (1+ open) :end end))))
    (and close (subseq head (1+ open) close))))

(defun encoding (octets)
  "Return the external format in which OCTETS are written."
  (flet ((begins-with (&rest octets-of-mark)
           (alexandria:starts-with-subseq octets-of-mark octets :test #'eql)))
    (let ((name (declared-encoding octets)))
      (cond ((begins-with #xff #xfe) :utf-16le)
            ((begins-with #xfe #xff) :utf-16be)
            ((or (null name) (member name '("utf-8" "us-ascii" "ascii") :test #'equalp)) :utf-8)
            ((member name '("iso-8859-1" "latin1") :test #'equalp) :latin-1)
            (t (urdf-problem 1 "the encoding ~a is not read; UTF-8 is" name))))))

(defun allowed-character-p (character)
  (let ((code (char-code character)))
    (or (<= 32 code #xd7ff) (member code '(9 10 13)) (<= #xe000 code #xfffd) (> code #xffff))))

(defun file-text (file)
  "Return the text of FILE without a byte order mark.  Signals URDF-ERROR."
  (let* ((octets (file-octets file))
         (text (handler-case (sb-ext:octets-to-string octets :external-format (encoding octets))
                 (urdf-error (condition) (error condition))
                 (error () (urdf-problem nil "it is not a UTF-8 text"))))
         (text (coerce (string-left-trim '(#\Zero_width_no-break_space) text) 'simple-string))
         (odd (position-if-not #'allowed-character-p text)))
    (when odd
      (malformed (1+ (count #\Newline text :end odd)) "the character of code ~d"
                 (char-code (char text odd))))
    text))

;;; Steps of a cursor

(defun next (cursor)
  "Return the character at CURSOR, or NIL at the end."
  (let ((position (cursor-position cursor)))
    (and (< position (length (cursor-text cursor)))
         (schar (cursor-text cursor) position))))

(defun at-p (cursor text)
  "Return true if TEXT begins at CURSOR."
  (let ((end (+ (cursor-position cursor) (length text))))
    (and (<= end (length (cursor-text cursor)))
         (string= text (cursor-text cursor) :start2 (cursor-position cursor) :end2 end))))

(defun accept (cursor text)
  "Move CURSOR behind TEXT and return true if it is there."
  (and (at-p cursor text)
       (incf (cursor-position cursor) (length text))))

(defun skip-past (cursor text what)
  "Return what is between CURSOR and the next TEXT, and move behind it; WHAT is not closed without."
  (let* ((start (cursor-position cursor))
         (end (or (search text (cursor-text cursor) :start2 start)
                  (malformed (current-line cursor) "~a that begins here is not closed" what))))
    (setf (cursor-position cursor) (+ end (length text)))
    (subseq (cursor-text cursor) start end)))

(defun white-p (character)
  (find character '(#\Space #\Newline #\Tab #\Return)))

(defun skip-white (cursor)
  "Move CURSOR over white space and return true if there was any."
  (loop while (and (next cursor) (white-p (next cursor)))
        count (incf (cursor-position cursor)) into skipped
        finally (return (plusp skipped))))

(defun name-start-p (character)
  (or (alpha-char-p character) (find character "_:") (> (char-code character) 127)))

(defun name-part-p (character)
  (or (name-start-p character) (digit-char-p character) (find character "-.")))

(defun accept-name (cursor what)
  "Return the name at CURSOR and move behind it; WHAT was expected there."
  (let ((start (cursor-position cursor)))
    (unless (and (next cursor) (name-start-p (next cursor)))
      (malformed (current-line cursor) "~:[the file ends~;~:*~a was found~] where ~a was expected"
                 (next cursor) what))
    (loop while (and (next cursor) (name-part-p (next cursor)))
          do (incf (cursor-position cursor)))
    (subseq (cursor-text cursor) start (cursor-position cursor))))

;;; Attributes

(defun referenced-character (name line)
  "Return the character that the reference &NAME; stands for."
  (let* ((number (and (> (length name) 1) (char= (char name 0) #\#)))
         (hexadecimal (and number (char= (char name 1) #\x)))
         (code (and number
                    (<= (length name) 9)
                    (ignore-errors (parse-integer name :start (if hexadecimal 2 1)
                                                       :radix (if hexadecimal 16 10))))))
    (cond ((and code (< 0 code char-code-limit) (allowed-character-p (code-char code)))
           (code-char code))
          (number (malformed line "&~a; is no character" name))
          ((cdr (assoc name '(("lt" . #\<) ("gt" . #\>) ("amp" . #\&) ("quot" . #\") ("apos" . #\'))
                       :test #'string=)))
          (t (urdf-problem line "the entity &~a; is not known; no entities are read but those of ~
                                 XML itself" name)))))

(defun expanded (text line)
  "Return TEXT with its references replaced and its white space as spaces."
  (with-output-to-string (stream)
    (loop with position = 0
          while (< position (length text))
          do (let ((character (char text position)))
               (cond ((char= character #\&)
                      (let ((end (or (position #\; text :start position)
                                     (malformed line "an & that begins no reference"))))
                        (write-char (referenced-character (subseq text (1+ position) end) line)
                                    stream)
                        (setf position end)))
                     ((white-p character) (write-char #\Space stream))
                     (t (write-char character stream)))
               (incf position)))))

(defun attribute-value (cursor name)
  "Return the value, in quotes, of the attribute NAME at CURSOR."
  (let ((line (current-line cursor))
        (quote (cond ((accept cursor "\"") "\"")
                     ((accept cursor "'") "'")
                     (t (malformed (current-line cursor) "the value of the attribute ~a is not in ~
                                                          quotes" name)))))
    (let ((value (skip-past cursor quote (format nil "the value of the attribute ~a" name))))
      (when (find #\< value)
        (malformed line "the value of the attribute ~a holds a <, or is not closed" name))
      (expanded value line))))

(defun accept-attributes (cursor element-name)
  "Return the list of the (name . value) at CURSOR, in the start tag of ELEMENT-NAME."
  (let ((attributes '()))
    (loop
      (let ((space (skip-white cursor)))
        (when (or (null (next cursor)) (find (next cursor) "/>"))
          (return (nreverse attributes)))
        (unless space
          (malformed (current-line cursor) "a space is missing in <~a>" element-name))
        (let ((name (accept-name cursor "the name of an attribute")))
          (when (assoc name attributes :test #'string=)
            (malformed (current-line cursor) "<~a> has two attributes ~a" element-name name))
          (skip-white cursor)
          (unless (accept cursor "=")
            (malformed (current-line cursor) "the attribute ~a has no value" name))
          (skip-white cursor)
          (push (cons name (attribute-value cursor name)) attributes))))))

;;; Markup

(defun skip-aside (cursor)
  "Move CURSOR over a comment or processing instruction and return true if it is at one."
  (cond ((accept cursor "<!--") (skip-past cursor "-->" "the comment") t)
        ((accept cursor "<?") (skip-past cursor "?>" "the processing instruction") t)))

(defun skip-doctype (cursor)
  "Move CURSOR over a DOCTYPE that declares nothing."
  (when (accept cursor "<!DOCTYPE")
    (let* ((line (current-line cursor))
           (text (skip-past cursor ">" "the DOCTYPE")))
      (when (or (find #\[ text) (search "SYSTEM" text) (search "PUBLIC" text))
        (urdf-problem line "a DOCTYPE with declarations or with an external file is not followed")))))

(defun skip-asides (cursor)
  (loop do (skip-white cursor)
        while (skip-aside cursor)))

(defun skip-text (cursor)
  "Move CURSOR to the next markup; the references in the text before it must be right."
  (let* ((start (cursor-position cursor))
         (line (current-line cursor))
         (end (or (position #\< (cursor-text cursor) :start start)
                  (length (cursor-text cursor)))))
    (setf (cursor-position cursor) end)
    (when (find #\& (cursor-text cursor) :start start :end end)
      (expanded (subseq (cursor-text cursor) start end) line))))

(defun start-tag (cursor)
  "Return the element whose start tag is at CURSOR, and true if it is empty."
  (let ((line (current-line cursor)))
    (accept cursor "<")
    (let* ((name (accept-name cursor "the name of an element"))
           (attributes (accept-attributes cursor name))
           (element (make-xml-element :name name :attributes attributes :line line)))
      (cond ((accept cursor "/>") (values element t))
            ((accept cursor ">") (values element nil))
            (t (malformed line "the tag <~a> is not closed" name))))))

(defun end-tag (cursor open)
  "Move CURSOR, behind </, over the rest of the end tag of the element OPEN."
  (let* ((line (current-line cursor))
         (name (accept-name cursor "the name of an element")))
    (skip-white cursor)
    (unless (and (accept cursor ">") (string= name (xml-element-name open)))
      (malformed line "</~a> was found where </~a> was expected, which ends what begins in line ~d"
                 name (xml-element-name open) (xml-element-line open)))
    (setf (xml-element-children open) (nreverse (xml-element-children open)))))

(defun read-element (cursor)
  "Return the element that begins at CURSOR, with all that is in it."
  (multiple-value-bind (root empty) (start-tag cursor)
    (let ((open (if empty '() (list root))))
      (loop while open
            do (skip-text cursor)
               (cond ((null (next cursor))
                      (malformed (xml-element-line (first open)) "<~a>, which begins here, is not ~
                                                                  closed"
                                 (xml-element-name (first open))))
                     ((skip-aside cursor))
                     ((accept cursor "<![CDATA[") (skip-past cursor "]]>" "the CDATA section"))
                     ((accept cursor "</") (end-tag cursor (pop open)))
                     (t (multiple-value-bind (element empty) (start-tag cursor)
                          (push element (xml-element-children (first open)))
                          (unless empty
                            (push element open)
                            (when (nthcdr *greatest-depth* open)
                              (urdf-problem element "its elements are nested more than ~d deep"
                                            *greatest-depth*)))))))
      root)))

(defun read-xml (file)
  "Return the root XML-ELEMENT of FILE.  Signals URDF-ERROR."
  (let ((cursor (make-cursor (file-text file))))
    (skip-asides cursor)
    (skip-doctype cursor)
    (skip-asides cursor)
    (unless (eql (next cursor) #\<)
      (malformed (current-line cursor) "~:[it is empty~;it does not begin with <~]"
                 (next cursor)))
    (prog1 (read-element cursor)
      (skip-asides cursor)
      (when (next cursor)
        (malformed (current-line cursor) "there is something after the root element")))))
