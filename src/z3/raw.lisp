;;;; The part of Z3's C API that is used, one function each, named as in z3_api.h.
;;;;
;;;; Each Z3 object is an address (HANDLE).  Nothing is checked here: the callers keep the rules of
;;;; the API, which are no call without a live context, reference counts, the error code read after
;;;; each call, and no interrupt inside a call (see context.lisp).

(in-package #:discrepancy-finder.z3)

(foreign:define-library z3 "the SMT solver Z3" ("libz3.so.4" "libz3.so")
  :hint "apt-get install libz3-4")

(cffi:defctype handle :uint64)

(defmacro define-z3-function ((c-name lisp-name) result &rest parameters)
  "Define LISP-NAME to call C-NAME; inline, so that handles are not boxed."
  `(progn
     (declaim (inline ,lisp-name))
     (cffi:defcfun (,c-name ,lisp-name) ,result ,@parameters)))

;;; Contexts and errors

(define-z3-function ("Z3_mk_config" z3-mk-config) handle)
(define-z3-function ("Z3_del_config" z3-del-config) :void (config handle))
(define-z3-function ("Z3_mk_context_rc" z3-mk-context-rc) handle (config handle))
(define-z3-function ("Z3_del_context" z3-del-context) :void (context handle))
(define-z3-function ("Z3_interrupt" z3-interrupt) :void (context handle))
(define-z3-function ("Z3_set_error_handler" z3-set-error-handler) :void
  (context handle) (handler handle))
(define-z3-function ("Z3_get_error_code" z3-get-error-code) :int (context handle))
(define-z3-function ("Z3_get_error_msg" z3-get-error-msg) handle (context handle) (code :int))

;;; Symbols and parameters

(define-z3-function ("Z3_mk_string_symbol" z3-mk-string-symbol) handle
  (context handle) (text :pointer))
(define-z3-function ("Z3_get_symbol_string" z3-get-symbol-string) handle
  (context handle) (symbol handle))
(define-z3-function ("Z3_mk_params" z3-mk-params) handle (context handle))
(define-z3-function ("Z3_params_inc_ref" z3-params-inc-ref) :void
  (context handle) (parameters handle))
(define-z3-function ("Z3_params_dec_ref" z3-params-dec-ref) :void
  (context handle) (parameters handle))
(define-z3-function ("Z3_params_set_bool" z3-params-set-bool) :void
  (context handle) (parameters handle) (key handle) (value :boolean))
(define-z3-function ("Z3_params_set_uint" z3-params-set-uint) :void
  (context handle) (parameters handle) (key handle) (value :unsigned-int))

;;; Terms

(define-z3-function ("Z3_mk_bool_sort" z3-mk-bool-sort) handle (context handle))
(define-z3-function ("Z3_mk_false" z3-mk-false) handle (context handle))
(define-z3-function ("Z3_mk_const" z3-mk-const) handle
  (context handle) (symbol handle) (sort handle))
(define-z3-function ("Z3_mk_not" z3-mk-not) handle (context handle) (term handle))
(define-z3-function ("Z3_mk_and" z3-mk-and) handle
  (context handle) (count :unsigned-int) (terms :pointer))
(define-z3-function ("Z3_mk_or" z3-mk-or) handle
  (context handle) (count :unsigned-int) (terms :pointer))
(define-z3-function ("Z3_mk_implies" z3-mk-implies) handle
  (context handle) (left handle) (right handle))
(define-z3-function ("Z3_mk_iff" z3-mk-iff) handle (context handle) (left handle) (right handle))
(define-z3-function ("Z3_inc_ref" z3-inc-ref) :void (context handle) (term handle))
(define-z3-function ("Z3_dec_ref" z3-dec-ref) :void (context handle) (term handle))
(define-z3-function ("Z3_get_app_decl" z3-get-app-decl) handle (context handle) (term handle))
(define-z3-function ("Z3_get_decl_name" z3-get-decl-name) handle
  (context handle) (declaration handle))
(define-z3-function ("Z3_get_bool_value" z3-get-bool-value) :int (context handle) (term handle))
(define-z3-function ("Z3_ast_to_string" z3-ast-to-string) handle (context handle) (term handle))

;;; Solvers and models

(define-z3-function ("Z3_mk_solver" z3-mk-solver) handle (context handle))
(define-z3-function ("Z3_mk_solver_for_logic" z3-mk-solver-for-logic) handle
  (context handle) (logic handle))
(define-z3-function ("Z3_solver_inc_ref" z3-solver-inc-ref) :void
  (context handle) (solver handle))
(define-z3-function ("Z3_solver_dec_ref" z3-solver-dec-ref) :void
  (context handle) (solver handle))
(define-z3-function ("Z3_solver_set_params" z3-solver-set-params) :void
  (context handle) (solver handle) (parameters handle))
(define-z3-function ("Z3_solver_assert" z3-solver-assert) :void
  (context handle) (solver handle) (term handle))
(define-z3-function ("Z3_solver_push" z3-solver-push) :void (context handle) (solver handle))
(define-z3-function ("Z3_solver_pop" z3-solver-pop) :void
  (context handle) (solver handle) (count :unsigned-int))
(define-z3-function ("Z3_solver_get_num_scopes" z3-solver-get-num-scopes) :unsigned-int
  (context handle) (solver handle))
(define-z3-function ("Z3_solver_check_assumptions" z3-solver-check-assumptions) :int
  (context handle) (solver handle) (count :unsigned-int) (assumptions :pointer))
(define-z3-function ("Z3_solver_get_reason_unknown" z3-solver-get-reason-unknown) handle
  (context handle) (solver handle))
(define-z3-function ("Z3_solver_to_string" z3-solver-to-string) handle
  (context handle) (solver handle))
(define-z3-function ("Z3_solver_get_model" z3-solver-get-model) handle
  (context handle) (solver handle))
(define-z3-function ("Z3_model_inc_ref" z3-model-inc-ref) :void (context handle) (model handle))
(define-z3-function ("Z3_model_dec_ref" z3-model-dec-ref) :void (context handle) (model handle))
(define-z3-function ("Z3_model_eval" z3-model-eval) :boolean
  (context handle) (model handle) (term handle) (completion :boolean) (value :pointer))
