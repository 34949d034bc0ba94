;;;; Review: verdicts on plans, in the light of the discrepancies of the model.
;;;;
;;;; What is verified is verified in the theory.  A verdict RESTS ON the axioms, the inertia and the
;;;; action bindings that say something of the paths behind it: of all paths if the plan is
;;;; verified, of the counterexample if there is one.  A stored discrepancy whose explanation names
;;;; one of these, and which shows again when it is replayed, puts the verdict in DOUBT.  Entry
;;;; points: REVIEW-PLAN verifies and reviews, REVIEW-OF-VERIFICATION reviews.

(in-package #:discrepancy-finder.discrepancy)

(defstruct (doubt (:copier nil))
  "That the discrepancy in FILE has GROUNDS, as EXPLANATION-GROUNDS has them, in common with a
verdict.  STATUS is what replaying it came to, see REPLAY-STATUS; KIND tells it in words, PARAMETERS
the scene's that it was found with, if it was not the scene as it is."
  (file "" :type string :read-only t)
  (grounds '() :type list :read-only t)
  (status :same-bits :type keyword :read-only t)
  (kind "" :type string :read-only t)
  (parameters nil :type (or null string) :read-only t))

(setf (documentation 'doubt-file 'function)
      "Return the name of the file of a stored discrepancy."
      (documentation 'doubt-grounds 'function)
      "Return what a verdict and a discrepancy both rest on, as EXPLANATION-GROUNDS has it."
      (documentation 'doubt-status 'function)
      "Return what came of replaying a discrepancy: :SAME-BITS or :SAME-VERDICT.")

(defmethod print-object ((doubt doubt) stream)
  (print-unreadable-object (doubt stream :type t)
    (format stream "~a:~{ ~a~^,~}" (doubt-file doubt)
            (mapcar #'ground-text (doubt-grounds doubt)))))

(defstruct (review (:copier nil))
  "A VERIFICATION and the DOUBTS about its verdict.  REPLAYED counts the stored discrepancies that
were replayed, GONE is a list of (file . why) for those that do not show again."
  (verification nil :read-only t)
  (doubts '() :type list :read-only t)
  (replayed 0 :type (integer 0) :read-only t)
  (gone '() :type list :read-only t))

(setf (documentation 'review-verification 'function)
      "Return the VERIFICATION that was reviewed."
      (documentation 'review-doubts 'function)
      "Return the list of the DOUBTs about a verdict; NIL if no stored discrepancy touches it.")

(defun review-verdict (review)
  "Return the verdict that was reviewed, see VERIFICATION-VERDICT, and as a second value true if it
is in doubt."
  (values (symbolic:verification-verdict (review-verification review))
          (and (review-doubts review) t)))

(defmethod print-object ((review review) stream)
  (print-unreadable-object (review stream :type t)
    (multiple-value-bind (verdict doubtful) (review-verdict review)
      (format stream "~(~a~)~:[~;, in doubt~]" verdict doubtful))))

;;; What a verdict rests on

(defun verdict-grounds (verification)
  "Return what the verdict of VERIFICATION rests on."
  (let ((exploration (symbolic:verification-exploration verification))
        (counterexample (symbolic:verification-counterexample verification)))
    (if counterexample
        (symbolic:trace-grounds counterexample (symbolic:exploration-domain exploration))
        (symbolic:exploration-grounds exploration))))

(defun axiom-named (theory name)
  (find name (ec:theory-axioms theory) :key #'ec:axiom-name))

(defun common-grounds (grounds discrepancy theory)
  "Return those of the grounds of DISCREPANCY that are among GROUNDS, those of a verdict in THEORY;
axioms of the same name are the same only if they say the same."
  (let ((other (symbolic:action-theory-theory (discrepancy-domain discrepancy))))
    (loop for ground in (getf (theory-side discrepancy) :grounds)
          when (and (member ground grounds :test #'equal)
                    (or (not (eq (first ground) :axiom))
                        (equal (ec:axiom-formula (axiom-named theory (second ground)))
                               (ec:axiom-formula (axiom-named other (second ground))))))
            collect ground)))

;;; Stored discrepancies

(defun stored-domain-name (object)
  "Return the name of the domain in the JSON OBJECT of a replay file, or NIL."
  (let ((part (and object (json:get-key object "domain" nil))))
    (and (listp part) (json:get-key part "name" nil))))

(defun related-domain-p (name domain)
  "Return true if NAME is that of DOMAIN, or that of a known domain that has axioms in common with
it."
  (or (equal name (ec:name-text (symbolic:action-theory-name domain)))
      (let ((other (find name (symbolic:all-action-theories)
                         :key (lambda (other) (ec:name-text (symbolic:action-theory-name other)))
                         :test #'equal)))
        (and other
             (intersection (ec:theory-axioms (symbolic:action-theory-theory other))
                           (ec:theory-axioms (symbolic:action-theory-theory domain))
                           :test #'equal :key #'ec:axiom-formula)
             t))))

(defun review-file (file grounds domain)
  "Return the DOUBT that the discrepancy in FILE casts on a verdict in DOMAIN that rests on GROUNDS,
or NIL, and why it does not show again, a text, or NIL."
  (handler-case
      (let* ((result (replay file))
             (discrepancy (replay-discrepancy result)))
        (if (null discrepancy)
            (values nil (format nil "it does not show again: the run is ~(~a~) now"
                                (replay-verdict result)))
            (let ((common (common-grounds grounds discrepancy
                                          (symbolic:action-theory-theory domain))))
              (and common
                   (make-doubt :file file :grounds common :status (replay-status result)
                               :kind (kind-text discrepancy)
                               :parameters (parameters-text
                                            (discrepancy-parameters discrepancy)))))))
    (error (condition)
      (values nil (source:condition-sentence condition)))))

;;; Entry points

(defparameter *default-store* "discrepancies/"
  "The folder that holds the stored discrepancies unless another one is named.")

(defun review-of-verification (verification &key (store *default-store*) files)
  "Return the REVIEW of VERIFICATION, which was made with the option :COVERAGE T, by the
discrepancies in the folder STORE, or in FILES, of its domain and of those that share axioms with
it.  Each is replayed; the plans and domains that the files name are loaded unless they are defined.
Signals COVERAGE-NOT-RECORDED."
  (let* ((grounds (verdict-grounds verification))
         (domain (symbolic:exploration-domain (symbolic:verification-exploration verification)))
         (doubts '()) (gone '()) (replayed 0))
    (dolist (file (or files (and store (stored-files store))))
      (when (related-domain-p (stored-domain-name (stored-object file)) domain)
        (incf replayed)
        (multiple-value-bind (doubt why) (review-file file grounds domain)
          (cond (doubt (push doubt doubts))
                (why (push (cons file why) gone))))))
    (make-review :verification verification :doubts (nreverse doubts) :replayed replayed
                 :gone (nreverse gone))))

(defun review-plan (plan &rest options &key domain (store *default-store*) files
                    &allow-other-keys)
  "Verify PLAN (a symbol) in DOMAIN (a domain or its name) and return the REVIEW of the verdict by
the discrepancies in the folder STORE, or in FILES.  The other options are those of VERIFY-PLAN:
PROPERTY and the bounds.  Signals what VERIFY-PLAN signals."
  (review-of-verification
   (apply #'symbolic:verify-plan (plan:plan-name (ensure-plan plan))
          :domain (ensure-domain domain) :coverage t
          (alexandria:remove-from-plist options :domain :store :files :coverage))
   :store store :files files))

;;; Words

(defun doubt-text (doubt)
  "Return what DOUBT says, as a sentence."
  (format nil "~a: ~a~@[, with ~a~]; replayed, it shows again~:[~;, bit for bit~].  Both rest on ~
               ~{~a~^, ~}."
          (doubt-file doubt) (doubt-kind doubt) (doubt-parameters doubt)
          (eq (doubt-status doubt) :same-bits) (mapcar #'ground-text (doubt-grounds doubt))))

(defun review-text (review)
  "Return REVIEW in words, a text of several lines: the verification, as DESCRIBE shows it, and what
there is to doubt."
  (with-output-to-string (stream)
    (describe (review-verification review) stream)
    (cond ((review-doubts review)
           (format stream "IN DOUBT: the verdict rests on what a simulation contradicts.~%")
           (dolist (doubt (review-doubts review))
             (format stream "  ~a~%" (doubt-text doubt))))
          (t (format stream "No stored discrepancy touches the verdict (~d replayed).~%"
                     (review-replayed review))))
    (loop for (file . why) in (review-gone review)
          do (format stream "  ~a: ~a~%" file (string-right-trim "." why)))))

(defun review-json (review)
  "Return REVIEW as a JSON object with the keys verdict, doubts, replayed and gone."
  (json:object
   "verdict" (string-downcase (symbolic:verification-verdict (review-verification review)))
   "in-doubt" (json-boolean (review-doubts review))
   "doubts" (map 'vector
                 (lambda (doubt)
                   (json:object "file" (doubt-file doubt) "kind" (doubt-kind doubt)
                                "parameters" (json-or-null (doubt-parameters doubt))
                                "status" (string-downcase (doubt-status doubt))
                                "grounds" (map 'vector #'ground-json (doubt-grounds doubt))))
                 (review-doubts review))
   "replayed" (review-replayed review)
   "gone" (loop for (file . why) in (review-gone review) collect (cons file why))))
