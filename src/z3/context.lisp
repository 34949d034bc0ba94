;;;; Contexts: the owner of everything that Z3 makes.
;;;;
;;;; A CONTEXT is what users hold; its FOREIGN-CONTEXT is what the watcher (interrupt.lisp) and the
;;;; finalizer hold, so that neither keeps the context alive.  Entry points: MAKE-CONTEXT,
;;;; CLOSE-CONTEXT, WITH-CONTEXT.  A context serves one thread at a time.
;;;;
;;;; The rules of every call into Z3 are kept by CALLING-Z3:
;;;; - No interrupt may run inside of Z3, since one that unwinds would unwind through C++ frames and
;;;;   one that uses the context would enter Z3 a second time; so calls are made without interrupts.
;;;; - No error handler is installed, for Z3's default handler ends the process; the error code is
;;;;   read after each call, and signaled when interrupts are possible again.
;;;;
;;;; A context that was dropped is not deleted by its finalizer, which runs in any thread at any
;;;; time: that only queues it, and the next MAKE-CONTEXT deletes what is queued.

(in-package #:discrepancy-finder.z3)

(defstruct (foreign-context (:constructor make-foreign-context (pointer kept)) (:copier nil))
  "A Z3 context and who is checking in it."
  (pointer 0 :type (unsigned-byte 64))
  ;; Z3's vector of the terms that live as long as the context.  It is released before the context
  ;; is deleted: Z3 takes milliseconds for each level of the terms that still have references then.
  (kept 0 :type (unsigned-byte 64) :read-only t)
  ;; NIL: nobody; a thread: it is inside of a check (:STARTING just before); :INTERRUPTING: it is,
  ;; and the watcher is telling Z3 to stop; :CLOSED: the context was deleted.
  (checker nil :type t)
  ;; Why the watcher told Z3 to stop, or NIL.
  (stopped nil :type (member nil :interrupt :timeout))
  ;; When the check began, how long it is left alone by interrupts, how long it may take, how many
  ;; there were, how long they took (ns).
  (started 0 :type (unsigned-byte 62))
  (patience 0 :type (unsigned-byte 62))
  (time-limit most-positive-fixnum :type (unsigned-byte 62))
  (check-count 0 :type (unsigned-byte 62))
  (check-time 0 :type (unsigned-byte 62)))

(defstruct (context (:constructor %make-context (foreign)) (:copier nil))
  "A Z3 context: made by MAKE-CONTEXT, ended by CLOSE-CONTEXT."
  (foreign nil :type foreign-context :read-only t)
  ;; The boolean sort, once it was asked for; the other sorts that were asked for, latest first.
  (boolean nil :type t)
  (sorts '() :type list)
  ;; The terms to release at the end of the innermost WITH-RELEASED-TERMS, latest first; :KEPT
  ;; outside of it, where terms live as long as the context.
  (trail :kept :type (or list (eql :kept))))

(declaim (inline context-pointer))
(defun context-pointer (context)
  "Return the address of the Z3 context of CONTEXT, 0 if it is closed."
  (foreign-context-pointer (context-foreign context)))

(declaim (inline context-kept))
(defun context-kept (context)
  "Return the address of the vector of the terms that live as long as CONTEXT."
  (foreign-context-kept (context-foreign context)))

(setf (documentation 'context-p 'function)
      "Return true if its argument is a CONTEXT.")

(defmethod print-object ((context context) stream)
  (print-unreadable-object (context stream :type t :identity t)
    (format stream "~:[open~;closed~] after ~d check~:p"
            (zerop (context-pointer context)) (check-count context))))

(defun check-count (context)
  "Return how many checks were made in CONTEXT, repetitions after an interruption included."
  (foreign-context-check-count (context-foreign context)))

(defun check-seconds (context)
  "Return the wall-clock time (s, a double float) spent inside of Z3's checks in CONTEXT."
  (* 1d-9 (foreign-context-check-time (context-foreign context))))

(defun error-keyword (code)
  (nth code '(:ok :sort-error :index-out-of-bounds :invalid-argument :parser-error :no-parser
              :invalid-pattern :out-of-memory :file-access-error :internal-fatal :invalid-usage
              :reference-error :exception)))

(defun signal-z3-error (code message)
  (if (eql code :closed)
      (misuse :closed-context "the context is closed")
      (error 'z3-error :code (error-keyword code) :message message)))

(defmacro calling-z3 ((pointer context) &body body)
  "Evaluate BODY without interrupts and with POINTER bound to the address of the Z3 context of
CONTEXT; return its value.  Signal Z3-ERROR if CONTEXT is closed or if the last Z3 call of BODY
set an error code."
  (let ((value (gensym "VALUE")) (code (gensym "CODE")) (message (gensym "MESSAGE")))
    `(multiple-value-bind (,value ,code ,message)
         (sb-sys:without-interrupts
           (let ((,pointer (context-pointer ,context)))
             (if (zerop ,pointer)
                 (values nil :closed nil)
                 (let* ((,value (progn ,@body))
                        (,code (z3-get-error-code ,pointer)))
                   (if (zerop ,code)
                       (values ,value nil nil)
                       (values nil ,code (decode (z3-get-error-msg ,pointer ,code))))))))
       (when ,code
         (signal-z3-error ,code ,message))
       ,value)))

;;; Life

(sb-ext:defglobal **open-contexts** '()
  "The foreign contexts that are not deleted.")

(sb-ext:defglobal **open-contexts-lock** (sb-thread:make-mutex :name "open Z3 contexts"))

(sb-ext:defglobal **dropped-contexts** '()
  "The foreign contexts whose contexts were dropped without being closed.")

(defun delete-foreign-context (foreign)
  "Delete FOREIGN with all that it holds.  Return :BUSY if a check is running in it, :CLOSED if it
was deleted before, else NIL."
  (sb-sys:without-interrupts
    (let ((checker (sb-ext:compare-and-swap (foreign-context-checker foreign) nil :closed)))
      (cond ((eq checker :closed) :closed)
            (checker :busy)
            (t (sb-thread:with-mutex (**open-contexts-lock**)
                 (setf **open-contexts** (remove foreign **open-contexts** :count 1)))
               (let ((pointer (shiftf (foreign-context-pointer foreign) 0)))
                 (z3-ast-vector-dec-ref pointer (foreign-context-kept foreign))
                 (z3-del-context pointer))
               nil)))))

(defun delete-dropped-contexts ()
  (loop for foreign = (sb-ext:atomic-pop (symbol-value '**dropped-contexts**))
        while foreign
        do (delete-foreign-context foreign)))

(defun make-context ()
  "Return a new CONTEXT.  It is to be closed by CLOSE-CONTEXT; one that is dropped instead is
deleted by a later MAKE-CONTEXT.  Signals Z3-ERROR."
  (delete-dropped-contexts)
  (sb-sys:without-interrupts
    (let* ((config (z3-mk-config))
           (pointer (foreign:with-c-float-traps
                      (prog1 (z3-mk-context-rc config)
                        (z3-del-config config))))
           (kept (progn (z3-set-error-handler pointer 0)
                        (z3-mk-ast-vector pointer)))
           (foreign (make-foreign-context pointer kept)))
      (z3-ast-vector-inc-ref pointer kept)
      (let ((context (%make-context foreign)))
        (sb-thread:with-mutex (**open-contexts-lock**)
          (push foreign **open-contexts**))
        (sb-ext:finalize context
                         (lambda ()
                           (sb-ext:atomic-push foreign (symbol-value '**dropped-contexts**)))
                         :dont-save t)
        context))))

(defun close-context (context)
  "Delete CONTEXT with its terms and solvers; do nothing if that was done before.  Using any of them
afterwards signals Z3-ERROR, and so does closing a context while a check runs in it."
  (when (eq (delete-foreign-context (context-foreign context)) :busy)
    (misuse :busy-context "the context cannot be closed while a check runs in it"))
  (sb-ext:cancel-finalization context)
  (values))

(defmacro with-context ((variable) &body body)
  "Evaluate BODY with VARIABLE bound to a new CONTEXT, which is closed at the end; return the values
of BODY."
  (let ((context (gensym "CONTEXT")))
    `(let ((,context (make-context)))
       (unwind-protect (let ((,variable ,context)) ,@body)
         (close-context ,context)))))

(defun forget-contexts ()
  "Mark all contexts as closed, without calling Z3: they belong to the process that saved this
image."
  (dolist (foreign (shiftf **open-contexts** '()))
    (setf (foreign-context-pointer foreign) 0
          (foreign-context-checker foreign) :closed))
  (setf **dropped-contexts** '()))

(pushnew 'forget-contexts sb-ext:*init-hooks*)
