;;;; The C API of the shim, function by function; discrepancy-finder-bullet.h documents them.
;;;;
;;;; All are inlined, because a full call would box each of the doubles that a pose is made of.

(in-package #:discrepancy-finder.bullet)

(foreign:define-library bullet-shim "the Bullet shim"
    ((:beside "libdiscrepancy-finder-bullet.so"))
  :hint "build it by loading the system, or by ./discrepancy-finder")

(defmacro define-raw (lisp-name c-name result &rest arguments)
  "Define the inlined function LISP-NAME that calls C-NAME.  In ARGUMENTS, :POSE stands for the
seven doubles of a pose."
  `(progn
     (declaim (inline ,lisp-name))
     (cffi:defcfun (,c-name ,lisp-name) ,result
       ,@(loop for argument in arguments
               if (eq argument :pose)
                 append '((x :double) (y :double) (z :double)
                          (qx :double) (qy :double) (qz :double) (qw :double))
               else
                 collect argument))))

(define-raw %world-new "dfb_world_new" :pointer (gravity :double) (time-step :double))
(define-raw %world-delete "dfb_world_delete" :int (world :pointer))
(define-raw %step "dfb_step" :int (world :pointer) (steps :int))

(define-raw %shape-delete "dfb_shape_delete" :int (shape :pointer))
(define-raw %shape-box "dfb_shape_box" :int
  (x :double) (y :double) (z :double) (shape :pointer))
(define-raw %shape-sphere "dfb_shape_sphere" :int (radius :double) (shape :pointer))
(define-raw %shape-cylinder "dfb_shape_cylinder" :int
  (radius :double) (height :double) (shape :pointer))
(define-raw %shape-plane "dfb_shape_plane" :int
  (nx :double) (ny :double) (nz :double) (d :double) (shape :pointer))
(define-raw %shape-hull "dfb_shape_hull" :int (count :int) (points :pointer) (shape :pointer))
(define-raw %shape-compound "dfb_shape_compound" :int
  (count :int) (children :pointer) (poses :pointer) (shape :pointer))

(define-raw %body-new "dfb_body_new" :int
  (world :pointer) (shape :pointer) (kind :int) (pose :pointer) (mass :pointer) (material :pointer))
(define-raw %body-move "dfb_body_move" :int (world :pointer) (body :int) :pose)
(define-raw %body-place "dfb_body_place" :int (world :pointer) (body :int) :pose)
(define-raw %body-wake "dfb_body_wake" :int (world :pointer) (body :int))
(define-raw %body-allow-sleep "dfb_body_allow_sleep" :int
  (world :pointer) (body :int) (flag :int))
(define-raw %body-asleep "dfb_body_asleep" :int (world :pointer) (body :int))
(define-raw %body-read "dfb_body_read" :int (world :pointer) (body :int) (state :pointer))

(define-raw %state-read "dfb_state_read" :int (world :pointer) (states :pointer) (length :int))
(define-raw %state-hash "dfb_state_hash" :int (world :pointer) (hash :pointer))
(define-raw %at-rest "dfb_at_rest" :int (world :pointer))

(define-raw %attach "dfb_attach" :int (world :pointer) (parent :int) (child :int))
(define-raw %detach "dfb_detach" :int (world :pointer) (attachment :int))
(define-raw %grip "dfb_grip" :int
  (world :pointer) (parent :int) (child :int) (point :pointer) (axis :pointer)
  (capacity :double) (torsion-radius :double))
(define-raw %attachment-state "dfb_attachment_state" :int
  (world :pointer) (attachment :int) (utilization :pointer))
(define-raw %attachment-load "dfb_attachment_load" :int
  (world :pointer) (attachment :int) (load :pointer))
(define-raw %ignore-collision "dfb_ignore_collision" :int
  (world :pointer) (a :int) (b :int) (flag :int))

(define-raw %penetration "dfb_penetration" :int
  (world :pointer) (a :int) (b :int) (depth :pointer))
(define-raw %deepest-penetration "dfb_deepest_penetration" :int
  (world :pointer) (depth :pointer) (a :pointer) (b :pointer))

(define-raw %cast-ray "dfb_cast_ray" :int
  (world :pointer) (x :double) (y :double) (z :double)
  (to-x :double) (to-y :double) (to-z :double)
  (passed-count :int) (passed :pointer) (body :pointer) (hit :pointer))
(define-raw %cast-rays "dfb_cast_rays" :int
  (world :pointer) (count :int) (rays :pointer)
  (passed-count :int) (passed :pointer) (bodies :pointer) (hits :pointer))

(defun status-name (status)
  "Return the keyword for a negative STATUS of the shim."
  (ecase status
    (-1 :bad-world) (-2 :bad-body) (-3 :bad-shape) (-4 :bad-constraint) (-5 :bad-number)
    (-6 :bad-kind) (-7 :too-small) (-8 :no-memory) (-9 :nothing)
    (-10 :bad-checkpoint) (-20 :bad-link)))
