;;;; A picture is taken in a dark room, without and with flash.
;;;;
;;;; Source: E. Mueller, Commonsense Reasoning, 2006, chapter 8, on the cumulative effects of
;;;; concurrent events.
;;;; Expected: 1 model.  The first picture, at 0, is black; the second, at 1, taken while the flash
;;;; fires, is good at 2.  Neither event alone makes a good picture in the dark.

(define-theory camera-with-flash
  "In the dark the shutter needs the flash at the same time."
  (:sorts (camera camera1))
  (:fluents (dark) (good-picture camera) (black-picture camera))
  (:events (press-shutter camera) (fire-flash camera))
  (:axioms
   (implies (or (not (holds-at (dark) ?time)) (happens (fire-flash ?camera) ?time))
            (initiates (press-shutter ?camera) (good-picture ?camera) ?time))
   (implies (and (holds-at (dark) ?time) (not (happens (fire-flash ?camera) ?time)))
            (initiates (press-shutter ?camera) (black-picture ?camera) ?time)))
  (:facts
   (initially (dark))
   (initially (not (good-picture camera1)))
   (initially (not (black-picture camera1))))
  (:narrative
   (happens (press-shutter camera1) 0)
   (happens (fire-flash camera1) 1)
   (happens (press-shutter camera1) 1))
  (:completion happens)
  (:time 0 2))
