; One of two packages has the bomb, dunking disarms it, and may clog the toilet.
(define (domain bomb-toilet)
  (:requirements :typing :conditional-effects :negative-preconditions :non-deterministic)
  (:types package toilet - object)
  (:predicates (armed ?p - package) (clogged ?t - toilet) (near ?t - toilet))
  (:action dunk
    :parameters (?p - package ?t - toilet)
    :precondition (and (near ?t) (not (clogged ?t)))
    :effect (and (when (armed ?p) (not (armed ?p))) (oneof (clogged ?t) (and))))
  (:action flush
    :parameters (?t - toilet)
    :effect (not (clogged ?t))))

(define (problem bomb-2)
  (:domain bomb-toilet)
  (:objects one two - package sink hole - toilet)
  (:init (near hole) (not (near sink)) (oneof (armed one) (armed two)))
  (:goal (forall (?p - package) (not (armed ?p)))))
