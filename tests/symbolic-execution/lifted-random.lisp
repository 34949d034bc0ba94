;;;; Random expressions over symbolic arguments against brute force.

(in-package #:discrepancy-finder.tests)

(in-suite lifted-functions)

(defparameter *expression-grammar*
  '((:number
     (x y x y 0 1 2 -1 3 1/2)
     (x (+ :number :number) (- :number :number) (* :number :number) (/ :number :divisor)
      (if :boolean :number :number) (max :number :number) (min :number :number) (abs :number)
      (1+ :number) (1- :number) (- :number) (signum :number) (floor :number :divisor)
      (ceiling :number :divisor) (round :number :divisor) (truncate :number :divisor)
      (mod :number :divisor) (rem :number :divisor) (length :list) (count :any :list)
      (reduce #'+ (remove-if-not #'realp :list) :initial-value :number)
      (reduce #'max (mapcar (lambda (p) (if (realp p) p 0)) :list) :initial-value :number)
      (or (position :any :list) :number)
      (case :any (:a :number) ((1 :b nil) :number) (t :number))
      (let ((x :number)) :number) (aref (vector :number :number) (mod x 2))
      (let ((h (make-hash-table :test 'equal))) (setf (gethash :any h) :number)
        (gethash :any h :number))
      (let ((z :any)) (if (numberp z) z :number))
      (getf (list :element :number :b :number) :element :number)))
    (:divisor (2 3 -2 1/2) (2 3 -3 (1+ x)))
    (:element
     (e f :a :b e :c)
     (e f (if :boolean :element :element) (first (list :element :any))
      (nth (mod x 3) (list :a :element :c)) (find :element (list :a :element))
      (cdr (assoc :any (list (cons :a :element) (cons 1 :b) (cons :any :c))))))
    (:any (x e b f) (:number :number :element :element :boolean))
    (:boolean
     (b b (not b) t)
     (b (not :any) (< :number :number) (> :number :number) (= :number :number)
      (<= :number :number) (/= :number :number) (eq :element :any) (eql :any :any)
      (equal :any :any) (equalp :list :list) (equal :list :list) (and :any :boolean)
      (or :any :boolean) (numberp :any) (keywordp :any) (atom :any) (null :any)
      (typep :any '(integer 0 2)) (typep :any '(or (integer 1) (member :b nil)))
      (typep :any '(not keyword)) (typep :any 'boolean) (typep :number 'ratio)
      (some #'numberp :list) (every #'identity :list) (notany #'null :list)
      (if (member :any :list) t nil) (zerop :number) (plusp :number) (minusp :number)
      (let ((z :number)) (and (integerp z) (evenp z))) (subsetp :list :list)
      (consp (compiled-type :any)) (funcall (lambda (p q) (eql p q)) :any :any)))
    (:list
     ((list x y) (list e :a) '(1 :a 2 nil) (list b f) (list x e y))
     ((list :any :any) (cons :any :list) (append :list :list) (remove :any :list)
      (mapcar (lambda (p) (list p :any)) :list) (mapcar (lambda (p) (eql p :any)) :list)
      (remove-duplicates :list) (reverse :list) (member :any :list) (union :list :list)
      (substitute :any :any :list) (remove-if #'numberp :list)
      (sort (remove-if-not #'realp :list) #'<) (set-difference :list :list)
      (let ((l (list :any 1))) (setf (car l) :any) l) (adjoin :any :list)
      (loop for p in :list when (eql p :any) collect p) (intersection :list :list)
      (coerce (vector :any :any) 'list) (multiple-value-list (floor :number 2))
      (let ((h (make-hash-table))) (setf (gethash :any h) :any)
        (loop for v being the hash-values of h using (hash-key k) collect (list k v))))))
  "For each nonterminal the forms without and those with others inside of them.")

(defun random-lifted-expression (nonterminal depth state)
  "Return a random form of NONTERMINAL by *EXPRESSION-GRAMMAR* that is about DEPTH deep."
  (destructuring-bind (simple others) (rest (assoc nonterminal *expression-grammar*))
    (let ((forms (if (plusp depth) others simple)))
      (labels ((fill-in (form)
                 (cond ((consp form)
                        (if (eq (first form) 'quote)
                            form
                            (cons (fill-in (car form)) (fill-in (cdr form)))))
                       ((and (keywordp form) (assoc form *expression-grammar*))
                        (random-lifted-expression form (1- depth) state))
                       (t form))))
        (fill-in (nth (random (length forms) state) forms))))))

(defun random-expression-problems (count depth seed)
  "Return the problems of COUNT random expressions."
  (let ((state (sb-ext:seed-random-state seed)))
    (loop repeat count
          for nonterminal = (nth (random 3 state) '(:number :boolean :list))
          for problem = (expression-problem (random-lifted-expression nonterminal depth state))
          when problem collect problem)))

(test random-expressions-as-by-brute-force
  (is (equal '() (random-expression-problems 120 3 5))))
