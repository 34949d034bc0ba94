;;;; Which grasps fit: the open hand gets there without touching the thing.
;;;;
;;;; This is a question about two shapes and nothing else, so FITTING-GRASPS answers it in a small
;;;; world of its own and remembers the answer for the hand and the shape.

(in-package #:discrepancy-finder.projection)

(defparameter *least-rays-on-pads* 2
  "A thing between the pads must be met by so many of the rays between them, at the least.")

(defun hand-parts (hand)
  (append (hand-palm hand) (hand-fingers hand)))

(defun add-hand (world hand)
  "Add the parts of HAND to WORLD; return the list of (pose . body)."
  (loop for (pose shape) in (hand-parts hand)
        for index from 0
        collect (cons pose (bullet:add-body world (format nil "hand/~d" index) shape pose
                                            :kind :kinematic))))

(defun place-hand (bodies tool)
  (loop for (pose . body) in bodies do (bullet:place-body body (compose tool pose))))

(defun touching-hand-p (bodies thing)
  (some (lambda (entry) (plusp (bullet:penetration (cdr entry) thing))) bodies))

(defun grasp-fits-p (world hand bodies thing grasp)
  "Return true if HAND comes to GRASP without touching the body THING and has it between its pads."
  (let ((hits (bullet:cast-rays world (pad-rays hand (grasp-tool grasp))
                                :passed (mapcar #'cdr bodies))))
    (and (>= (count thing hits) *least-rays-on-pads*)
         (loop for step from 0 to 4
               never (progn
                       (place-hand bodies (advanced (grasp-tool grasp)
                                                    (* -1/4 step (grasp-depth grasp))))
                       (touching-hand-p bodies thing))))))

(defun find-grasps (hand shape)
  "Return the grasps of SHAPE that HAND gets to, in the order of CANDIDATE-GRASPS."
  (bullet:with-world (world)
    (let ((thing (bullet:add-body world "thing" shape (identity-pose) :kind :static))
          (bodies (add-hand world hand)))
      (remove-if-not (lambda (grasp) (grasp-fits-p world hand bodies thing grasp))
                     (candidate-grasps hand shape)))))

(defvar *fitting-grasps* (make-hash-table :test #'eq :weakness :key :synchronized t)
  "For each shape that was looked at a list of (hand . grasps).")

(defun fitting-grasps (hand shape)
  "Return the list of the grasps of SHAPE that HAND gets to, remembered from the last time."
  (let ((known (assoc hand (gethash shape *fitting-grasps*))))
    (cdr (or known
             (first (push (cons hand (find-grasps hand shape))
                          (gethash shape *fitting-grasps*)))))))
