;;;; BLOCK and RETURN-FROM, TAGBODY and GO, by the ways out of jumps.lisp.

(in-package #:discrepancy-finder.symbolic-execution)

(defun tag-place (exit context)
  "Return the place of the tag of EXIT for forms of CONTEXT.  A function remembers the tags that it
needs when it is made: the block or tagbody may be entered again in the same frame."
  (cond ((eq context (exit-context exit))
         (or (exit-place exit)
             (setf (exit-place exit)
                   (make-place (exit-layout exit) (add-element (exit-layout exit))))))
        ((cdr (assoc exit (context-captured context))))
        (t (let* ((layout (context-layout context))
                  (place (make-place layout (add-element layout))))
             (push (cons exit place) (context-captured context))
             place))))

(defun tag-reader (exit scope)
  "Return the code that reads the tag of EXIT."
  (frame-reader (tag-place exit (scope-context scope)) scope))

(defun analyze-with-frame (scope analyzer)
  "Call ANALYZER with SCOPE, or one with a new frame if SCOPE has none, and return its code."
  (if (scope-layouts scope)
      (funcall analyzer scope)
      (analyze-in-frame scope analyzer)))

;;; Blocks

(define-analyzer block (form scope)
  (destructuring-bind (name . body) (rest form)
    (unless (symbolp name) (unsupported form "the name of a block is a symbol"))
    (analyze-with-frame
     scope
     (lambda (scope)
       (let* ((exit (make-exit :layout (first (scope-layouts scope))
                               :context (scope-context scope)))
              (inner (extend-scope scope :blocks (acons name exit '())))
              (run (let ((*exits* (cons exit *exits*)) (*tails* (cons exit *tails*)))
                     (analyze-body body inner))))
         (block-code name exit run))))))

(defun finish-block (exit &optional (first nil anyp) (second nil secondp) &rest more)
  "Return the values that a block with EXIT returns if its last form returns those given."
  (declare (dynamic-extent more))
  (cond ((and (jump-p first) (eq (jump-exit first) exit)) (values-list second))
        (more (multiple-value-call #'values first second (values-list more)))
        (secondp (values first second))
        (anyp first)
        (t (values))))

(defun block-code (name exit run)
  (declare (type function run))
  (let ((run (if (exit-seen exit)
                 (code (frame) (multiple-value-call #'finish-block exit (run run frame)))
                 run)))
    (declare (type function run))
    (if (exit-place exit)
        (let ((index (place-index (exit-place exit))))
          (code (frame)
            (let ((tag (list name)))
              (setf (svref frame index) tag)
              (catch tag (run run frame)))))
        run)))

(define-analyzer return-from (form scope)
  (destructuring-bind (name &optional value) (rest form)
    (let ((exit (cdr (assoc name (scope-blocks scope)))))
      (unless exit (unsupported form "there is no such block around it"))
      (cond ((member exit *tails*) (analyze-form value scope))
            ((member exit *exits*)
             (setf (exit-seen exit) t)
             (incf *jumps*)
             (let ((value (analyze value scope)) (jump (make-jump exit 0)))
               (declare (type function value))
               (code (frame) (values jump (multiple-value-list (run value frame))))))
            (t (let ((tag (tag-reader exit scope))
                     (value (analyze value scope)))
                 (declare (type function value tag))
                 (code (frame) (throw (run tag frame) (run value frame)))))))))

;;; Tagbodies

(defun tag-p (thing)
  (or (symbolp thing) (integerp thing)))

(define-analyzer tagbody (form scope)
  (let ((tags (remove-if-not #'tag-p (rest form))))
    (unless (= (length tags) (length (remove-duplicates tags)))
      (unsupported form "a tag occurs twice in it")))
  (analyze-with-frame
   scope
   (lambda (scope)
     (let* ((exit (make-exit :layout (first (scope-layouts scope))
                               :context (scope-context scope)))
            (tags (remove-if-not #'tag-p (rest form)))
            (inner (extend-scope scope
                                 :tags (loop for tag in tags for segment from 1
                                             collect (list* tag exit segment))))
            (segments (let ((*exits* (cons exit *exits*)) (*tails* '()))
                        (mapcar (lambda (forms) (analyze-body forms inner))
                                (segments (rest form))))))
       (tagbody-code exit (coerce segments 'simple-vector))))))

(defun segments (parts)
  "Return the lists of the forms of a tagbody before, between and after its tags.  The value of the
last form of each must not be taken for one of the tagbody's."
  (let ((segments (list '())))
    (dolist (part parts (mapcar #'reverse (nreverse segments)))
      (if (tag-p part)
          (push '() segments)
          (push part (first segments))))))

(defun tagbody-code (exit segments)
  (declare (type simple-vector segments))
  (let ((count (length segments)))
    (flet ((run-segments (frame next)
             (declare (type fixnum next))
             (loop
               (when (= next count)
                 (return nil))
               (multiple-value-bind (value payload) (run (svref segments next) frame)
                 (cond ((not (jump-p value)) (incf next))
                       ((eq (jump-exit value) exit) (setf next (jump-segment value)))
                       (t (return (values value payload))))))))
      (if (exit-place exit)
          (let ((index (place-index (exit-place exit))))
            (code (frame)
              (let ((tag (list :tagbody)) (next 0))
                (setf (svref frame index) tag)
                (loop
                  (multiple-value-bind (target payload)
                      (catch tag
                        (multiple-value-bind (value payload) (run-segments frame next)
                          (return (if (jump-p value) (values value payload) nil))))
                    (declare (ignore payload))
                    (setf next target))))))
          (code (frame) (run-segments frame 0))))))

(define-analyzer go (form scope)
  (let* ((tag (second form))
         (entry (cdr (assoc tag (scope-tags scope) :test #'eql))))
    (unless entry (unsupported form "there is no such tag around it"))
    (destructuring-bind (exit . segment) entry
      (if (member exit *exits*)
          (let ((jump (make-jump exit segment)))
            (incf *jumps*)
            (code (frame)
              (when *path* (count-jump *path*))
              jump))
          (let ((tag (tag-reader exit scope)))
            (declare (type function tag))
            (code (frame)
              (when *path* (count-jump *path*))
              (throw (run tag frame) segment)))))))
