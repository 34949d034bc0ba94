;;;; Random numbers for blind samples.
;;;;
;;;; A sample must be a pure function of the user's seed, of what is sampled (the trace) and of the
;;;; sample's index, so that samples can be drawn in any order, on any machine, alone.  A
;;;; counter-based generator gives that: random numbers are the encryption of a counter, and there
;;;; is no state.  PHILOX is Philox4x32-10 of Salmon, Moraes, Dror and Shaw, "Parallel random
;;;; numbers: as easy as 1, 2, 3" (SC 2011): a bijection of 128-bit counters for each 64-bit key.
;;;;
;;;; UNIT-FLOAT is the entry point.  It encrypts twice:
;;;;
;;;;   w0 w1 w2 w3 = PHILOX, counter (content low, content high, 0, 0), key (seed low, seed high)
;;;;   result      = PHILOX, counter (index, draw, w2, w3),             key (w0, w1)
;;;;
;;;; For one seed the first step maps contents to distinct (w0 w1 w2 w3), and all four words enter
;;;; the second step: two contents never share a stream, and streams of two seeds are unrelated.

(in-package #:discrepancy-finder.discrepancy)

(deftype word () '(unsigned-byte 32))

(declaim (inline philox-round))
(defun philox-round (c0 c1 c2 c3 k0 k1)
  (declare (type word c0 c1 c2 c3 k0 k1))
  (let ((product0 (* #xd2511f53 c0))
        (product1 (* #xcd9e8d57 c2)))
    (declare (type (unsigned-byte 64) product0 product1))
    (values (logxor (ash product1 -32) c1 k0)
            (ldb (byte 32 0) product1)
            (logxor (ash product0 -32) c3 k1)
            (ldb (byte 32 0) product0))))

(defun philox (c0 c1 c2 c3 k0 k1)
  "Return four random words, as four values, for the counter C0 C1 C2 C3 and the key K0 K1; all of
them are of type (unsigned-byte 32).  Philox4x32-10 of Salmon et al., SC 2011."
  (declare (type word c0 c1 c2 c3 k0 k1))
  (dotimes (i 10 (values c0 c1 c2 c3))
    (multiple-value-setq (c0 c1 c2 c3) (philox-round c0 c1 c2 c3 k0 k1))
    (setf k0 (ldb (byte 32 0) (+ k0 #x9e3779b9))
          k1 (ldb (byte 32 0) (+ k1 #xbb67ae85)))))

(defun content-hash (string)
  "Return the (unsigned-byte 64) FNV-1a hash of STRING in UTF-8."
  (let ((hash #xcbf29ce484222325))
    (declare (type (unsigned-byte 64) hash))
    (loop for octet across (sb-ext:string-to-octets string :external-format :utf-8)
          do (setf hash (ldb (byte 64 0) (* (logxor hash octet) #x100000001b3))))
    hash))

(defun unit-float (seed content index draw)
  "Return a double float in [0, 1[ with 53 random bits, a pure function of the arguments: of the
user's SEED and the hash CONTENT of what is sampled, both (unsigned-byte 64), of the INDEX of the
sample, and of the number DRAW of the draw in this sample, both (unsigned-byte 32).  Signal
TYPE-ERROR for others."
  (check-type seed (unsigned-byte 64) "a non-negative integer below 2^64")
  (check-type content (unsigned-byte 64) "a non-negative integer below 2^64")
  (check-type index (unsigned-byte 32) "a non-negative integer below 2^32")
  (check-type draw (unsigned-byte 32) "a non-negative integer below 2^32")
  (flet ((low (integer) (ldb (byte 32 0) integer))
         (high (integer) (ldb (byte 32 32) integer)))
    (multiple-value-bind (w0 w1 w2 w3)
        (philox (low content) (high content) 0 0 (low seed) (high seed))
      (multiple-value-bind (high low) (philox index draw w2 w3 w0 w1)
        (* (logior (ash high 21) (ash low -11))
           (scale-float 1d0 -53))))))
