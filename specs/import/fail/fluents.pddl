(define (domain d)
  (:predicates (at ?x))
  (:functions (total-cost)))
