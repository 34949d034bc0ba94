;;;; Z3's C API: contexts, errors, symbols, parameters.

(in-package #:discrepancy-finder.z3)

;;; Configurations and global parameters

(define-z3-function z3-global-param-set :void (name :pointer) (value :pointer))
(define-z3-function z3-global-param-reset-all :void)
(define-z3-function z3-global-param-get bool (name :pointer) (value :pointer))
(define-versioned-z3-function z3-get-global-param-descrs handle context)
(define-z3-function z3-mk-config handle)
(define-z3-function z3-del-config :void config)
(define-z3-function z3-set-param-value :void config (name :pointer) (value :pointer))

;;; Contexts

(define-z3-function z3-mk-context handle config)
(define-z3-function z3-mk-context-rc handle config)
(define-z3-function z3-del-context :void context)
(define-z3-function z3-update-param-value :void context (name :pointer) (value :pointer))
(define-z3-function z3-interrupt :void context)
(define-z3-function z3-inc-ref :void context ast)
(define-z3-function z3-dec-ref :void context ast)
(define-versioned-z3-function z3-enable-concurrent-dec-ref :void context)

;;; Errors

(define-z3-function z3-get-error-code :int context)
(define-z3-function z3-get-error-msg handle context (code :int))
(define-z3-function z3-set-error :void context (code :int))
(define-z3-function z3-set-error-handler :void context handler)

;;; Symbols

(define-z3-function z3-mk-int-symbol handle context (number :int))
(define-z3-function z3-mk-string-symbol handle context (text :pointer))
(define-z3-function z3-get-symbol-kind :int context symbol)
(define-z3-function z3-get-symbol-int :int context symbol)
(define-z3-function z3-get-symbol-string handle context symbol)

;;; Parameter sets

(define-z3-function z3-mk-params handle context)
(define-z3-function z3-params-inc-ref :void context parameters)
(define-z3-function z3-params-dec-ref :void context parameters)
(define-z3-function z3-params-set-bool :void context parameters key (value bool))
(define-z3-function z3-params-set-uint :void context parameters key (value :uint))
(define-z3-function z3-params-set-double :void context parameters key (value :double))
(define-z3-function z3-params-set-symbol :void context parameters key value)
(define-z3-function z3-params-to-string handle context parameters)
(define-z3-function z3-params-validate :void context parameters descriptions)

;;; Descriptions of parameters

(define-z3-function z3-param-descrs-inc-ref :void context descriptions)
(define-z3-function z3-param-descrs-dec-ref :void context descriptions)
(define-z3-function z3-param-descrs-get-kind :int context descriptions name)
(define-z3-function z3-param-descrs-size :uint context descriptions)
(define-z3-function z3-param-descrs-get-name handle context descriptions (index :uint))
(define-z3-function z3-param-descrs-get-documentation handle context descriptions name)
(define-z3-function z3-param-descrs-to-string handle context descriptions)

;;; Vectors of terms

(define-z3-function z3-mk-ast-vector handle context)
(define-z3-function z3-ast-vector-inc-ref :void context vector)
(define-z3-function z3-ast-vector-dec-ref :void context vector)
(define-z3-function z3-ast-vector-size :uint context vector)
(define-z3-function z3-ast-vector-get handle context vector (index :uint))
(define-z3-function z3-ast-vector-set :void context vector (index :uint) ast)
(define-z3-function z3-ast-vector-resize :void context vector (size :uint))
(define-z3-function z3-ast-vector-push :void context vector ast)
(define-z3-function z3-ast-vector-translate handle context vector target)
(define-z3-function z3-ast-vector-to-string handle context vector)

;;; Maps from terms to terms

(define-z3-function z3-mk-ast-map handle context)
(define-z3-function z3-ast-map-inc-ref :void context map)
(define-z3-function z3-ast-map-dec-ref :void context map)
(define-z3-function z3-ast-map-contains bool context map key)
(define-z3-function z3-ast-map-find handle context map key)
(define-z3-function z3-ast-map-insert :void context map key value)
(define-z3-function z3-ast-map-erase :void context map key)
(define-z3-function z3-ast-map-reset :void context map)
(define-z3-function z3-ast-map-size :uint context map)
(define-z3-function z3-ast-map-keys handle context map)
(define-z3-function z3-ast-map-to-string handle context map)
