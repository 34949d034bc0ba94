;;;; Coverage as one self-contained HTML page: the plan files with their forms in colours.
;;;;
;;;; Positions of forms are lines.  Where on its line a form begins is found by its operator,
;;;; where it ends by the parentheses, so that strings and comments are skipped.  The colour of a
;;;; character is that of the innermost form around it.

(in-package #:discrepancy-finder.symbolic-execution)

(defparameter *state-classes*
  '((:covered . "covered") (:one-branch . "one-branch") (:never . "never"))
  "The class of the elements for each state of a form.")

(defparameter *style* "
body { font-family: sans-serif; margin: 2em; color: #222; background: #fff }
pre { border: 1px solid #ccc; padding: 0.5em; overflow-x: auto; line-height: 1.35 }
.number { color: #999 }
.covered { background: #d7f0d7 }
.one-branch { background: #fbeeb5 }
.never { background: #f8cfcf }
"
  "The style sheet of the page.")

(defun escaped (text)
  "Return TEXT with what has a meaning in HTML written as character references."
  (with-output-to-string (stream)
    (html:write-escaped text stream)))

;;; Where forms are

(defun skip-token (text position)
  "Return the position behind the string, comment, character or bar at POSITION of TEXT, or NIL if
there is none."
  (flet ((end (delimiter start)
           (loop with index = start
                 while (< index (length text))
                 do (let ((character (char text index)))
                      (cond ((char= character #\\) (incf index 2))
                            ((char= character delimiter) (return (1+ index)))
                            (t (incf index))))
                 finally (return (length text)))))
    (let ((character (char text position))
          (next (and (< (1+ position) (length text)) (char text (1+ position)))))
      (cond ((char= character #\") (end #\" (1+ position)))
            ((char= character #\|) (end #\| (1+ position)))
            ((char= character #\;)
             (or (position #\Newline text :start position) (length text)))
            ((char= character #\\) (min (length text) (+ position 2)))
            ((and (char= character #\#) (eql next #\\)) (min (length text) (+ position 3)))
            ((and (char= character #\#) (eql next #\|))
             (let ((found (search "|#" text :start2 (+ position 2))))
               (if found (+ found 2) (length text))))))))

(defun map-parentheses (function text)
  "Call FUNCTION with the positions of each opening parenthesis in TEXT and of the one that closes
it, in the order of the closing ones."
  (let ((open '()) (position 0))
    (loop while (< position (length text))
          do (let ((skipped (skip-token text position)))
               (cond (skipped (setf position skipped))
                     (t (case (char text position)
                          (#\( (push position open))
                          (#\) (when open (funcall function (pop open) position))))
                        (incf position)))))))

(defun operator-at (text position)
  "Return the name, without a package, of the symbol behind POSITION in TEXT."
  (let* ((start (or (position-if-not (lambda (character) (find character '(#\Space #\Newline)))
                                     text :start (1+ position))
                    (length text)))
         (end (or (position-if (lambda (character)
                                 (find character '(#\Space #\Newline #\Tab #\( #\) #\")))
                               text :start start)
                  (length text)))
         (name (subseq text start end))
         (colon (position #\: name :from-end t)))
    (if colon (subseq name (1+ colon)) name)))

(defun form-extents (text forms)
  "Return a list of (start end . state) for FORMS, as far as they are found in TEXT."
  (let ((lines (make-array (length text))) (line 1) (places '()) (extents '()))
    (loop for character across text
          for position from 0
          do (setf (svref lines position) line)
             (when (char= character #\Newline) (incf line)))
    (map-parentheses (lambda (start end) (push (list start end) places)) text)
    (setf places (sort places #'< :key #'first))
    (dolist (form forms (nreverse extents))
      (let ((place (find-if (lambda (place)
                              (and (= (svref lines (first place))
                                      (source:source-position-line (covered-form-position form)))
                                   (symbolp (first (covered-form-form form)))
                                   (string-equal (operator-at text (first place))
                                                 (symbol-name (first (covered-form-form form))))))
                            places)))
        (when place
          (setf places (remove place places :test #'eq))
          (push (list* (first place) (second place) (covered-form-state form)) extents))))))

(defun character-states (text forms)
  "Return a vector with the state of the innermost of FORMS around each character of TEXT, or NIL."
  (let ((states (make-array (length text) :initial-element nil)))
    ;; An outer form begins before an inner one.
    (loop for (start end . state) in (sort (form-extents text forms) #'< :key #'first)
          do (fill states state :start start :end (1+ end)))
    states))

;;; The page

(defun write-code-line (text states start end stream)
  "Write TEXT from START to END with an element for each run of characters of the same state."
  (loop while (< start end)
        do (let* ((state (svref states start))
                  (stop (or (position state states :start start :end end :test-not #'eq) end))
                  (part (escaped (subseq text start stop))))
             (if state
                 (format stream "<span class=\"~a\">~a</span>"
                         (cdr (assoc state *state-classes*)) part)
                 (write-string part stream))
             (setf start stop))))

(defun write-code (text forms stream)
  (let ((states (character-states text forms)) (start 0) (number 1))
    (format stream "<pre>")
    (loop while (< start (length text))
          do (let ((end (or (position #\Newline text :start start) (length text))))
               (format stream "<span class=\"number\">~5d</span> " number)
               (write-code-line text states start end stream)
               (terpri stream)
               (setf start (1+ end))
               (incf number)))
    (format stream "</pre>~%")))

(defun write-entries (title entries text stream)
  (when entries
    (format stream "<h2>~a</h2>~%<ul>~%" (escaped title))
    (loop for (entry . covered) in entries
          do (format stream "<li><span class=\"~:[never~;covered~]\">~a</span>~
                             ~:[ (never)~;~]</li>~%"
                     covered (escaped (funcall text entry)) covered))
    (format stream "</ul>~%")))

(defun write-page (coverage stream)
  (let ((title (format nil "Coverage of ~(~a~)" (coverage-plan coverage))))
    (format stream "<!DOCTYPE html>~%<html lang=\"en\">~%<head>~%<meta charset=\"utf-8\">~%~
                    <title>~a</title>~%<style>~a</style>~%</head>~%<body>~%<h1>~a</h1>~%<p>~a</p>~%"
            (escaped title) *style* (escaped title)
            (escaped (format nil "In the domain ~a: ~a." (ec:name-text (coverage-domain coverage))
                             (figures-text coverage))))
    (format stream "<p><span class=\"covered\">evaluated</span> ~
                    <span class=\"one-branch\">evaluated, but a condition took only one way</span> ~
                    <span class=\"never\">never evaluated</span></p>~%")
    (dolist (file (coverage-files coverage))
      (format stream "<h2>~a</h2>~%" (escaped file))
      (write-code (format nil "~{~a~%~}" (file-lines file)) (forms-in-file coverage file) stream))
    (write-entries "Outcomes" (coverage-outcomes coverage) #'identity stream)
    (write-entries "Axioms" (coverage-axioms coverage) #'ec:name-text stream)
    (format stream "</body>~%</html>~%")))

(defun write-coverage-html (coverage file)
  "Write COVERAGE to FILE as one HTML page that needs nothing else, and return FILE's true name.
The plan files are shown with their forms in colours.  FILE is replaced when the page is complete."
  (let* ((path (source:native-path file))
         (temporary (merge-pathnames (format nil "~a.part" (pathname-name path)) path)))
    (unwind-protect
         (progn
           (with-open-file (stream temporary :direction :output :if-exists :supersede
                                             :external-format :utf-8)
             (write-page coverage stream))
           (rename-file temporary (merge-pathnames path (uiop:getcwd)))
           (truename path))
      (uiop:delete-file-if-exists temporary))))
