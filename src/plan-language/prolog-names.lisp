;;;; The names of package CPL in facts of prolog: (not (foo ?x)) means the same goal whether the
;;;; file uses Common Lisp or CPL.

(in-package #:discrepancy-finder.plan-language)

(prolog:alias-predicate 'fail 'prolog:fail)
(loop for (alias name) in '((discrepancy-finder.cpl:not not) (discrepancy-finder.cpl:= =)
                            (discrepancy-finder.cpl:< <) (discrepancy-finder.cpl:> >))
      do (prolog:alias-predicate alias name))
