//! Strategies: malformed, failing, and the defeats that show it.

use super::build::{F, b, numbers, problem, strategy, system, trace};
use crate::{Budget, Check, Defeat, Error, check};
use hyperplan_problem::{Mode, PathId, Problem, Trace};
use hyperplan_syntax::ast::BinaryOp;

/// A square with a shortcut: 0 -> 1 -> 3, 0 -> 2 -> 3 by action 1, 0 -> 3 by action 2, 3 loops by action 0; 4 is
/// a dead end behind 2.
const EDGES: [(i64, u32, i64); 7] =
    [(0, 0, 1), (1, 0, 3), (0, 1, 2), (2, 1, 3), (0, 2, 3), (3, 0, 3), (2, 0, 4)];

fn square(prefix: &str, mode: Mode, f: &F) -> Problem {
    problem(system(5, 3, &EDGES, &[0]), prefix, mode, f)
}

fn run(problem: &Problem, traces: &[Trace]) -> Result<Check, Error> {
    check(problem, &problem.objectives[0], &strategy(traces), &Budget::default())
}

/// p reaches 3 within 2 steps, and nobody does so sooner.
fn fastest() -> F {
    let slower = F::Bin(BinaryOp::Until, 0, Some(2), b(F::Not(b(F::At(1, 3)))), b(F::At(0, 3)));
    F::And(vec![F::Fin(0, Some(2), b(F::At(0, 3))), slower])
}

/// A trace must be a path of the system, else a defeat says nothing.
fn assert_is_path(trace: &Trace) {
    let (states, actions) = numbers(trace);
    assert_eq!(states[0], 0);
    for (i, action) in actions.iter().enumerate() {
        assert!(EDGES.contains(&(states[i], *action, states[i + 1])), "{states:?} {actions:?}");
    }
    assert_ne!(states.last(), Some(&4));
}

#[test]
fn a_detour_is_defeated_by_the_shortcut() {
    let problem = square("ea", Mode::Bounded, &fastest());
    assert_eq!(run(&problem, &[trace(0, &[0, 3, 3], &[2, 0])]), Ok(Check::Holds));
    let Ok(Check::Fails(Defeat::Paths(traces))) = run(&problem, &[trace(0, &[0, 1, 3], &[0, 0])]) else {
        panic!("not defeated");
    };
    assert_is_path(&traces[0]);
    assert_eq!(traces[0].path, PathId(1));
    assert_eq!(numbers(&traces[0]).0, [0, 3]);
    let words = Defeat::Paths(traces).describe(&problem.objectives[0]);
    assert_eq!(words, "defeated by a choice of p1");
}

#[test]
fn within_k_a_defeat_has_k_steps() {
    let problem = square("ea", Mode::Within(4), &fastest());
    let detour = trace(0, &[0, 1, 3, 3, 3], &[0, 0, 0, 0]);
    let Ok(Check::Fails(Defeat::Paths(traces))) = run(&problem, &[detour]) else { panic!("not defeated") };
    assert_eq!(numbers(&traces[0]), (vec![0, 3, 3, 3, 3], vec![2, 0, 0, 0]));
}

#[test]
fn a_counterexample_makes_the_rest_fail() {
    // Every p is in 1 or 2 after a step, and so can r be: wrong for the shortcut.
    let f = F::X(b(F::And(vec![F::SameState(0, 1), F::Not(b(F::At(1, 3)))])));
    let problem = square("ae", Mode::Bounded, &f);
    assert_eq!(run(&problem, &[trace(0, &[0, 3], &[2])]), Ok(Check::Holds));
    let Ok(Check::Fails(Defeat::Paths(traces))) = run(&problem, &[trace(0, &[0, 1], &[0])]) else {
        panic!("not defeated");
    };
    assert_eq!(numbers(&traces[0]).0, [0, 1]);
}

#[test]
fn traces_that_are_no_paths_fail() {
    let problem = square("e", Mode::Bounded, &F::X(b(F::At(0, 2))));
    let path = PathId(0);
    let fails = |defeat| Ok(Check::Fails(defeat));
    assert_eq!(run(&problem, &[trace(0, &[1, 3], &[0])]), fails(Defeat::NotInitial { path }));
    assert_eq!(
        run(&problem, &[trace(0, &[0, 2, 1], &[1, 1])]),
        fails(Defeat::NoTransition { path, step: 1 })
    );
    assert_eq!(run(&problem, &[trace(0, &[0, 2], &[0])]), fails(Defeat::NoTransition { path, step: 0 }));
    assert_eq!(run(&problem, &[trace(0, &[0, 2, 4], &[1, 0])]), fails(Defeat::DeadEnd { path }));
    assert_eq!(run(&problem, &[trace(0, &[0, 1], &[0])]), fails(Defeat::Formula));
    assert_eq!(run(&problem, &[trace(0, &[0, 2], &[1])]), Ok(Check::Holds));
    // Within 2 the dead end is as good as anywhere.
    let problem = square("e", Mode::Within(2), &F::X(b(F::At(0, 2))));
    assert_eq!(run(&problem, &[trace(0, &[0, 2, 4], &[1, 0])]), Ok(Check::Holds));
}

#[test]
fn malformed_strategies_are_errors() {
    let problem = square("eea", Mode::Bounded, &fastest());
    let good = || trace(0, &[0, 3], &[2]);
    let expected = || Err(Error::WrongPaths { expected: "p0, p1".into() });
    assert_eq!(run(&problem, &[]), expected());
    assert_eq!(run(&problem, &[good()]), expected());
    assert_eq!(run(&problem, &[good(), good()]), expected());
    let with = |second: Trace| run(&problem, &[good(), second]);
    let path = || "p1".to_string();
    assert_eq!(with(trace(1, &[0], &[0])), Err(Error::Lengths { path: path(), states: 1, actions: 1 }));
    assert_eq!(with(trace(1, &[], &[])), Err(Error::Lengths { path: path(), states: 0, actions: 0 }));
    assert_eq!(with(trace(1, &[0, 9], &[0])), Err(Error::NotAState { path: path(), step: 1 }));
    assert_eq!(with(trace(1, &[0, 1], &[7])), Err(Error::NotAnAction { path: path(), step: 0 }));
    let problem = square("e", Mode::Within(2), &F::At(0, 0));
    let error = Error::WrongLength { path: "p0".into(), steps: 1, needed: 2 };
    assert_eq!(run(&problem, &[trace(0, &[0, 1], &[0])]), Err(error));
}

#[test]
fn a_trace_may_end_where_it_is_no_longer_read() {
    let reach = F::Fin(0, Some(4), b(F::At(0, 3)));
    let problem = square("e", Mode::Bounded, &reach);
    assert_eq!(run(&problem, &[trace(0, &[0, 3], &[2])]), Ok(Check::Holds));
    let error = |steps| Err(Error::WrongLength { path: "p0".into(), steps, needed: 4 });
    assert_eq!(run(&problem, &[trace(0, &[0, 1], &[0])]), error(1));
    // p1 may be anywhere at step 4, so it matters that p0 was not told.
    let both = F::Fin(4, Some(4), b(F::SameState(0, 1)));
    let problem = square("ea", Mode::Bounded, &both);
    assert_eq!(run(&problem, &[trace(0, &[0, 3], &[2])]), error(1));
    // Where another path decides, it does not.
    let either = F::Or(vec![F::Fin(0, Some(4), b(F::At(0, 4))), F::Fin(0, Some(9), b(F::At(1, 3)))]);
    let problem = square("ea", Mode::Bounded, &either);
    assert_eq!(run(&problem, &[trace(0, &[0, 3], &[2])]), Ok(Check::Holds));
}

#[test]
fn a_small_budget_is_reported() {
    let problem = square("ea", Mode::Bounded, &fastest());
    let budget = Budget { moves: 2, ..Budget::default() };
    let strategy = strategy(&[trace(0, &[0, 3, 3], &[2, 0])]);
    let verdict = check(&problem, &problem.objectives[0], &strategy, &budget);
    let Ok(Check::TooLarge { budget: reported, reached }) = verdict else { panic!("{verdict:?}") };
    assert_eq!((reported, reached.moves), (budget, 4));
}
