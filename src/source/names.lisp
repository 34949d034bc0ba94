(in-package #:discrepancy-finder.source)

(defun name-keyword (name)
  "Return the keyword that has the name of the symbol NAME.  Names that users write are compared by
their characters, whatever package they were read in."
  (if (keywordp name) name (intern (symbol-name name) :keyword)))
