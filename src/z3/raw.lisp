;;;; How the functions of Z3's C API are defined; the functions stand in the other files raw-*.lisp,
;;;; by the topics of z3_api.h, one line each, under the names of z3_api.h with hyphens.
;;;;
;;;; Each Z3 object is an address (HANDLE), and so is each C string that Z3 returns; arrays, C
;;;; strings and places for results that are passed to Z3 are pointers.  Nothing is checked here:
;;;; the callers keep the rules of the API, which are no call without a live context, reference
;;;; counts, the error code read after each call, and no interrupt inside a call (see context.lisp).
;;;;
;;;; Not mirrored: strings, sequences and regular expressions, floating-point numbers, relations and
;;;; fixed points, callbacks of any kind.

(in-package #:discrepancy-finder.z3)

(foreign:define-library z3 "the SMT solver Z3" ("libz3.so.4" "libz3.so")
  :hint "apt-get install libz3-4")

(cffi:defctype handle :uint64)

;; C's `bool' is one byte; the bits above it are undefined in a result.
(cffi:defctype bool (:boolean :uint8))

(eval-when (:compile-toplevel :load-toplevel :execute)
  (defun z3-c-name (lisp-name)
    "Return the name in C of the function LISP-NAME: that of Z3-MK-NOT is \"Z3_mk_not\"."
    (substitute #\_ #\- (concatenate 'string "Z3"
                                     (string-downcase (subseq (symbol-name lisp-name) 2)))))

  (defun z3-parameters (parameters)
    "Return PARAMETERS with their types; a bare symbol is a handle."
    (loop for parameter in parameters
          collect (if (symbolp parameter) (list parameter 'handle) parameter))))

(defmacro define-z3-function (name result &rest parameters)
  "Define NAME to call the C function of that name; inline, so that handles are not boxed."
  `(progn
     (declaim (inline ,name))
     (cffi:defcfun (,(z3-c-name name) ,name) ,result ,@(z3-parameters parameters))))

(defun missing-function (c-name)
  (misuse :missing-function "libz3 ~a has no function ~a" (z3-version) c-name))

(defmacro define-versioned-z3-function (name result &rest parameters)
  "Define NAME to call the C function of that name, which some versions of libz3 lack: it is looked
up at each call, and Z3-ERROR is signaled if it is missing."
  (let ((c-name (z3-c-name name)) (parameters (z3-parameters parameters)))
    `(defun ,name ,(mapcar #'first parameters)
       (cffi:foreign-funcall-pointer
        (or (cffi:foreign-symbol-pointer ,c-name) (missing-function ,c-name))
        ()
        ,@(loop for (parameter type) in parameters collect type collect parameter)
        ,result))))

;;; Versions and memory

(define-z3-function z3-get-version :void
  (major :pointer) (minor :pointer) (build :pointer) (revision :pointer))
(define-z3-function z3-get-full-version handle)
(define-z3-function z3-get-estimated-alloc-size :uint64)
(define-z3-function z3-reset-memory :void)
(define-z3-function z3-finalize-memory :void)
(define-z3-function z3-toggle-warning-messages :void (enabled bool))
(define-z3-function z3-enable-trace :void (tag :pointer))
(define-z3-function z3-disable-trace :void (tag :pointer))
(define-z3-function z3-open-log bool (file :pointer))
(define-z3-function z3-append-log :void (text :pointer))
(define-z3-function z3-close-log :void)

(defun z3-version ()
  "Return the version of the libz3 in use as a string, e.g. \"4.8.12.0\"."
  (cffi:with-foreign-object (numbers :uint 4)
    (flet ((place (index) (cffi:mem-aptr numbers :uint index)))
      (z3-get-version (place 0) (place 1) (place 2) (place 3))
      (format nil "~{~d~^.~}" (loop for index below 4
                                    collect (cffi:mem-aref numbers :uint index))))))
