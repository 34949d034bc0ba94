;;;; PNG files: images of 24 bits a pixel, compressed by salza2.

(in-package #:discrepancy-finder.projection)

(deftype octets () '(simple-array (unsigned-byte 8) (*)))

(defun big-endian (number)
  "Return the four octets of NUMBER as a list."
  (loop for position from 24 downto 0 by 8
        collect (ldb (byte 8 position) number)))

(defun octets (&rest parts)
  "Return one vector of PARTS: strings of ASCII characters and sequences of octets."
  (apply #'concatenate 'octets
         (loop for part in parts
               collect (if (stringp part) (map 'list #'char-code part) part))))

(defun png-section (type data)
  "Return the section of TYPE, a string, with DATA, a sequence of octets."
  (let ((body (octets type data))
        (checksum (make-instance 'salza2:crc32-checksum)))
    (salza2:update checksum body 0 (length body))
    (octets (big-endian (length data)) body (salza2:result-octets checksum))))

(defun png-octets (pixels width height)
  "Return the octets of a PNG file that shows PIXELS: three octets each, row by row from the top."
  (let* ((row-length (* 3 width))
         (rows (make-array (* height (1+ row-length)) :element-type '(unsigned-byte 8)
                                                      :initial-element 0)))
    ;; Each row begins with the number of its filter: none.
    (dotimes (row height)
      (replace rows pixels :start1 (1+ (* row (1+ row-length)))
                           :start2 (* row row-length) :end2 (* (1+ row) row-length)))
    (octets '(137) "PNG" '(13 10 26 10)
            (png-section "IHDR" (octets (big-endian width) (big-endian height) '(8 2 0 0 0)))
            (png-section "IDAT" (salza2:compress-data rows 'salza2:zlib-compressor))
            (png-section "IEND" #()))))
