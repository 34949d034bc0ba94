;;;; Why, and what is left: explanations and shrunk discrepancies on a page.

(in-package #:discrepancy-finder.report)

(defun sentences-node (sentences)
  `(:ul () ,(loop for sentence across sentences collect `(:li () ,sentence))))

;;; Explanations

(defun claim-fluents-text (claim)
  (format nil "~{~a~^, or ~}"
          (loop for fluent across (key claim "fluents")
                collect (format nil "~a is ~(~a~)" (svref fluent 0) (svref fluent 1)))))

(defun claims-node (explanation)
  "Return what the theory says at the divergent step, and why."
  (let ((ending (key explanation "ending")))
    `(,(and ending
            `((:p () ,(format nil "The theory does not allow that step ~d ends so:"
                              (key explanation "step")))
              ,(sentences-node (key ending "reasons"))))
      ,(loop for claim across (key explanation "claims")
             collect `((:p () ,(format nil "The theory ~:[says~;would have said~] that ~a after ~
                                            step ~d:"
                                       ending (claim-fluents-text claim)
                                       (key explanation "step")))
                       ,(sentences-node (key claim "reasons")))))))

(defun as-sentence (text)
  (format nil "~a." (string-right-trim "." (capitalized text))))

(defun edit-node (edit)
  "Return a box for EDIT; one that removes the discrepancy and contradicts no run stands out."
  `(:div (:class ,(if (and (eq (key edit "removes") :true) (zerop (key edit "contradicted")))
                      "edit removes"
                      "edit"))
     (:pre (:class "text") ,(key edit "text"))
     (:div (:class "quiet") ,(as-sentence (key edit "verdict")))))

(defun explanation-nodes (explanation)
  "Return what the object EXPLANATION, which may be NIL, says."
  (and explanation
       `((:h3 () "Why")
         ,(claims-node explanation)
         ,(and (plusp (length (key explanation "coordinates")))
               `((:h3 () "What decides")
                 ,(sentences-node (map 'vector (lambda (entry) (key entry "text"))
                                       (key explanation "coordinates")))))
         ,(and (plusp (length (key explanation "edits")))
               `((:h3 () "What could be changed in the theory")
                 ,(map 'list #'edit-node (key explanation "edits")))))))

;;; Shrunk discrepancies

(defun boundary-sentence (change)
  (format nil "~a: ~,4f with the discrepancy, ~,4f without." (key change "parameter")
          (key change "failing") (key change "passing")))

(defun shrunk-nodes (shrunk command)
  "Return what the object SHRUNK, which may be NIL, says; COMMAND replays."
  (when shrunk
    (destructuring-bind (before after) (coerce (key shrunk "steps") 'list)
      `((:h3 () "The smallest case")
        (:p () ,(format nil "~d of ~d step~:p ~:[are~;is~] left~@[; ~{~a~^, ~} left out of the ~
                             world~]." after before (= after 1)
                        (texts (key shrunk "left-out"))))
        (:ol () ,(loop for step across (key shrunk "discrepancy" "trace" "steps")
                       collect `(:li () (:code () ,(key step "designator")))))
        ,(and (key shrunk "boundary")
              `((:p () "The nearest sample that passes differs in")
                ,(sentences-node (map 'vector #'boundary-sentence (key shrunk "boundary")))))
        ,(and (json:get-key shrunk "file" nil) (key shrunk "file")
              `(:pre (:class "command")
                     ,(format nil "~a replay ~a" command (key shrunk "file"))))))))
