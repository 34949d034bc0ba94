;;;; A default state constraint, cancelled by a strict exception.
;;;;
;;;; Source: R. Reiter, G. Criscuolo, On interacting defaults, 1981; E. Mueller, Commonsense
;;;; Reasoning, 2006, chapter 12, on the ways to write defaults and their cancellation.
;;;; Expected: 1 model.  Adults are employed by default; a student is abnormal in that respect.  Kim
;;;; is employed at 0 and, enrolled at 0, no longer at 1: the default is lost, and nothing says
;;;; otherwise than that students are not employed.  Lou is employed throughout.

(define-theory cancellation-of-state-default
  "Adults are typically employed, students are not."
  (:sorts (person kim lou))
  (:predicates (ab1 person time))
  (:fluents (adult person) (student person))
  (:non-inertial-fluents (employed person))
  (:events (enrol person))
  (:axioms
   (initiates (enrol ?person) (student ?person) ?time)
   (by-default
    (implies (and (holds-at (adult ?person) ?time) (not (ab1 ?person ?time)))
             (holds-at (employed ?person) ?time)))
   (students-are-not
    (implies (holds-at (student ?person) ?time) (not (holds-at (employed ?person) ?time))))
   (cancellation :label theta
    (implies (holds-at (student ?person) ?time) (ab1 ?person ?time))))
  (:facts
   (holds-at (adult ?person) 0)
   (not (holds-at (student ?person) 0)))
  (:narrative (enrolling :label delta (happens (enrol kim) 0)))
  (:completion (delta happens) (theta ab1))
  (:time 0 1))
