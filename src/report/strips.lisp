;;;; Strips: for each parameter that is drawn, where on its range samples passed and failed.

(in-package #:discrepancy-finder.report)

(defparameter *strip-width* 300
  "The length of a strip in pixels.")

(defun number-with-unit (number unit)
  (format nil "~,3f~@[ ~a~]" number unit))

(defun strip-node (marks min max)
  "Return a strip from MIN to MAX with MARKS, a list of (value verdict title): what failed is above
the line, all else below it, and a cross is on the first mark if that failed."
  (flet ((place (value)
           (+ 8 (* (- *strip-width* 16) (/ (- value min) (- max min))))))
    `(:svg (:class "strip" :width ,*strip-width* :height 22
            "viewBox" ,(format nil "0 0 ~d 22" *strip-width*) :role "img")
           (:line (:x1 8 :x2 ,(- *strip-width* 8) :y1 11 :y2 11 :class "axis"))
           ,(loop for (value verdict title) in marks
                  for x = (place value)
                  for (y1 y2 class) = (ecase verdict
                                        (:failed '(2 11 "tick-failed"))
                                        (:passed '(11 20 "tick-passed"))
                                        (:left '(11 20 "tick-left")))
                  collect `(:line (:x1 ,x :x2 ,x :y1 ,y1 :y2 ,y2 :class ,class)
                                  (:title () ,title)))
           ,(loop for (value verdict title) in marks
                  for x = (place value)
                  repeat 1
                  when (eq verdict :failed)
                    collect `(:path (:d ,(format nil "M~,1f,6L~,1f,16M~,1f,16L~,1f,6"
                                                 (- x 5) (+ x 5) (- x 5) (+ x 5))
                                     :class "failed")
                                    (:title () ,title))))))

(defun sample-value (sample name)
  "Return the value of the parameter NAME in SAMPLE, or NIL."
  (loop for parameter in (discrepancy:sample-parameters sample)
        for value across (discrepancy:sample-values sample)
        when (string= (discrepancy:parameter-name parameter) name)
          return value))

(defun strips-node (parameters samples)
  "Return a table of strips: PARAMETERS is an array of JSON objects, SAMPLES a list of (sample
verdict); the values of the first sample are told as numbers if it failed."
  (flet ((key (parameter name) (json:get-key parameter name)))
    (let ((failing (and (eq (second (first samples)) :failed) (first (first samples)))))
      `(:table (:class "strips")
         (:thead () (:tr () (:th () "Parameter") (:th (:class "number") "from")
                         (:th () ,(if failing
                                      "samples: failed above, passed below"
                                      "samples"))
                         (:th (:class "number") "to")
                         ,(and failing '(:th (:class "number") "in the discrepancy"))))
         (:tbody ()
           ,(loop for parameter across parameters
                  for name = (key parameter "name")
                  for unit = (let ((unit (key parameter "unit"))) (and (stringp unit) unit))
                  for (min max) = (list (key parameter "min") (key parameter "max"))
                  collect
                  `(:tr ()
                     (:td () (:code () ,name)
                        ,(and (stringp (key parameter "meaning"))
                              `(:span (:class "meaning") " " ,(key parameter "meaning"))))
                     (:td (:class "number") ,(number-with-unit min unit))
                     (:td ()
                       ,(strip-node (loop for (sample verdict) in samples
                                          for value = (sample-value sample name)
                                          when value
                                            collect (list value verdict
                                                          (sample-title sample verdict)))
                                    min max))
                     (:td (:class "number") ,(number-with-unit max unit))
                     ,(and failing
                           `(:td (:class "number strong")
                                 ,(number-with-unit (sample-value failing name) unit))))))))))
