;;;; Every exported symbol says what it is.

(in-package #:discrepancy-finder.tests)

(def-suite documentation :in all)
(in-suite documentation)

(defun layer-packages ()
  (remove-if-not (lambda (package)
                   (and (uiop:string-prefix-p "DISCREPANCY-FINDER" (package-name package))
                        (not (search "-SYSTEM" (package-name package)))
                     (not (search ".TESTS" (package-name package)))
                        (not (search ".BENCH" (package-name package)))))
                 (list-all-packages)))

(defun slot-documentation-of (symbol)
  "Return the documentation of a slot that SYMBOL reads, or NIL."
  (when (fboundp symbol)
    (let ((function (fdefinition symbol)))
      (when (typep function 'generic-function)
        (loop for method in (sb-mop:generic-function-methods function)
              when (typep method 'sb-mop:standard-accessor-method)
                do (let ((text (documentation (sb-mop:accessor-method-slot-definition method) t)))
                     (when text (return text))))))))

(defun condition-reader-p (symbol)
  "Return true if SYMBOL reads a documented slot of a condition class."
  (flet ((reads-p (class)
           (some (lambda (slot)
                   (and (member symbol (sb-kernel::condition-slot-readers slot))
                        (sb-kernel::condition-slot-documentation slot)))
                 (sb-kernel::condition-classoid-slots (sb-kernel:find-classoid class)))))
    (labels ((walk (class)
               (or (and (typep (sb-kernel:find-classoid (class-name class) nil)
                               'sb-kernel::condition-classoid)
                        (reads-p (class-name class)))
                   (some #'walk (sb-mop:class-direct-subclasses class)))))
      (walk (find-class 'condition)))))

(defun restart-name-p (symbol)
  "The names of restarts are explained where they are offered."
  (member symbol '(df:continue-search df:next-trace df:accept discrepancy:skip-sample
                   discrepancy:retry-sample discrepancy:abort-trace
                   discrepancy:finish-replay
                   df:retry-with-timeout df:treat-as-sat plan:rethrow symbolic:stop-exploring)))

(defun documented-p (symbol)
  (or (some (lambda (kind) (documentation symbol kind))
            '(function variable type structure compiler-macro method-combination
              prolog:predicate plan:policy))
      (slot-documentation-of symbol)
      (condition-reader-p symbol)
      (restart-name-p symbol)
      ;; Words of designators, such as (a motion ...).
      (member symbol '(plan:action plan:motion plan:object plan:location plan:human))
      ;; Words of paths in the task tree.
      (member symbol '(plan:tagged plan:goal plan:?designator plan:process-module))
      ;; The role that designators are resolved in where none is named.
      (eq symbol 'desig:default-role)))

(test every-exported-symbol-is-documented
  (dolist (package (layer-packages))
    (is-true (documentation package t) "~a has no documentation" (package-name package))
    (do-external-symbols (symbol package)
      ;; DISCREPANCY-FINDER.CPL passes on Common Lisp.
      (unless (eq (symbol-package symbol) (find-package '#:cl))
        (is-true (documented-p symbol) "~s has no documentation" symbol)))))
