//! What counts as a path.

use super::build::{F, S, b, is, problem, system};
use crate::{Budget, Error, decide};
use hyperplan_problem::{Expr, Leaf, Mode, System, Type, Update, Value, Var, VarId};

fn holds(system: System, prefix: &str, mode: Mode, f: &F) -> bool {
    let problem = problem(system, prefix, mode, f);
    decide(&problem, &problem.objectives[0], &Budget::default()).unwrap().unwrap()
}

/// 0 goes to 1, a dead end after one more step, or to 2, which loops.
fn fork() -> System {
    system(4, 2, &[(0, 0, 1), (1, 0, 3), (0, 1, 2), (2, 0, 2)], &[0])
}

#[test]
fn dead_ends_are_no_part_of_infinite_paths() {
    let one = F::X(b(F::At(0, 1)));
    assert!(!holds(fork(), "e", Mode::Bounded, &one));
    assert!(holds(fork(), "a", Mode::Bounded, &F::X(b(F::At(0, 2)))));
    // The state 0 itself is live, so there is no reading ahead of what the formula asks.
    assert!(holds(fork(), "e", Mode::Bounded, &F::At(0, 0)));
}

#[test]
fn within_k_a_path_needs_k_steps_only() {
    let one = F::X(b(F::At(0, 1)));
    assert!(holds(fork(), "e", Mode::Within(1), &one) && holds(fork(), "e", Mode::Within(2), &one));
    assert!(!holds(fork(), "e", Mode::Within(3), &one));
    assert!(!holds(fork(), "a", Mode::Within(2), &F::X(b(F::At(0, 2)))));
    assert!(holds(fork(), "a", Mode::Within(3), &F::X(b(F::At(0, 2)))));
}

#[test]
fn without_any_path_forall_holds_and_exists_does_not() {
    for (edges, init) in [(vec![], vec![0]), (vec![(0, 0, 0)], vec![])] {
        let nowhere = || system(2, 1, &edges, &init);
        let truth = F::Or(vec![F::At(0, 0), F::Not(b(F::At(0, 0)))]);
        assert!(!holds(nowhere(), "e", Mode::Bounded, &truth));
        assert!(holds(nowhere(), "a", Mode::Bounded, &F::Not(b(truth.clone()))));
        assert!(holds(nowhere(), "ae", Mode::Bounded, &truth));
    }
    assert!(holds(system(2, 1, &[], &[0]), "e", Mode::Within(0), &F::At(0, 0)));
}

#[test]
fn choices_are_bounded_by_the_type_and_absorbing_states_loop() {
    let mut choosy = system(3, 2, &[], &[0]);
    choosy.clauses = system(3, 2, &[(0, 0, 0)], &[0]).clauses.into_iter().collect();
    choosy.clauses[0].guard = Expr::TRUE;
    // s' in -5..5, of which 0..2 are values of s.
    choosy.clauses[0].updates =
        vec![(S, Update::Within(Expr::Const(Value::Int(-5)), Expr::Const(Value::Int(5))))];
    let reaches = |n| F::X(b(F::At(0, n)));
    assert!(holds(choosy.clone(), "e", Mode::Bounded, &reaches(2)));
    assert!(!holds(choosy.clone(), "e", Mode::Bounded, &reaches(3)));
    // s' = s + 1 is no transition in 2, unless 2 absorbs; then every action stays, action 1 too.
    let next = Expr::Add(vec![Expr::Leaf(Leaf::Var(S)), Expr::Const(Value::Int(1))]);
    choosy.clauses[0].updates = vec![(S, Update::Assign(next))];
    assert!(!holds(choosy.clone(), "e", Mode::Bounded, &F::At(0, 0)));
    choosy.absorb = is(Leaf::Var(S), 2);
    let stays = F::Fin(0, Some(3), b(F::And(vec![F::At(0, 2), F::Took(0, 1)])));
    assert!(holds(choosy.clone(), "e", Mode::Bounded, &stays));
    assert!(!holds(choosy, "a", Mode::Bounded, &stays));
}

#[test]
fn large_types_do_not_matter_where_init_fixes_them() {
    let mut large = system(3, 1, &[(0, 0, 0)], &[0]);
    large.vars.push(Var {
        name: "n".into(),
        ty: Type::Range { lo: 0, hi: 1 << 40 },
        sums: None,
        span: super::build::span(),
    });
    let all = problem(large.clone(), "e", Mode::Bounded, &F::At(0, 0));
    assert_eq!(decide(&all, &all.objectives[0], &Budget::default()), Ok(None));
    large.init = Expr::And(vec![is(Leaf::Var(S), 0), is(Leaf::Var(VarId(1)), 7)]);
    assert!(holds(large, "e", Mode::Bounded, &F::At(0, 0)));
}

#[test]
fn an_unbounded_operator_needs_within() {
    let unbounded = problem(fork(), "e", Mode::Bounded, &F::Fin(0, None, b(F::At(0, 0))));
    let answer = decide(&unbounded, &unbounded.objectives[0], &Budget::default());
    assert!(matches!(answer, Err(Error::Malformed { .. })));
}
