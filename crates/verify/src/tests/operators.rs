//! Every operator at the ends of its interval and of the trace, on the one path 0 1 2 3 3 3 ...

use super::build::{F, b, problem, system};
use crate::{Budget, decide};
use hyperplan_problem::Mode;
use hyperplan_syntax::ast::BinaryOp;

const LINE: [(i64, u32, i64); 4] = [(0, 0, 1), (1, 0, 2), (2, 0, 3), (3, 0, 3)];

fn on_line(mode: Mode, f: &F) -> bool {
    let problem = problem(system(4, 1, &LINE, &[0]), "e", mode, f);
    decide(&problem, &problem.objectives[0], &Budget::default()).unwrap().unwrap()
}

/// The operators on `s == n`.
fn at(n: i64) -> Box<F> {
    b(F::At(0, n))
}

fn fin(lo: u32, hi: impl Into<Option<u32>>, n: i64) -> F {
    F::Fin(lo, hi.into(), at(n))
}

fn glob(lo: u32, hi: impl Into<Option<u32>>, n: i64) -> F {
    F::Glob(lo, hi.into(), at(n))
}

fn bin(op: BinaryOp, lo: u32, hi: impl Into<Option<u32>>, a: F, c: F) -> F {
    F::Bin(op, lo, hi.into(), b(a), b(c))
}

fn not(f: F) -> F {
    F::Not(b(f))
}

#[test]
fn bounded_operators_at_the_ends_of_their_intervals() {
    let holds = |f: &F| on_line(Mode::Bounded, f);
    assert!(holds(&fin(0, 2, 2)) && !holds(&fin(0, 1, 2)) && !holds(&fin(2, 3, 1)) && holds(&fin(1, 1, 1)));
    assert!(
        holds(&glob(3, 9, 3)) && !holds(&glob(2, 9, 3)) && holds(&glob(0, 0, 0)) && !holds(&glob(0, 1, 0))
    );
    let below = |n| F::Not(at(n));
    let until = |lo, hi, a, c| bin(BinaryOp::Until, lo, hi, a, c);
    assert!(holds(&until(0, 2, below(2), F::At(0, 2))) && !holds(&until(0, 1, below(2), F::At(0, 2))));
    // The left operand counts from now on, not from the interval's beginning, and not where the right one holds.
    assert!(!holds(&until(2, 3, below(0), F::At(0, 2))) && holds(&until(2, 3, below(2), F::At(0, 2))));
    assert!(!holds(&until(1, 1, F::At(0, 1), F::At(0, 1))) && holds(&until(0, 0, F::At(0, 9), F::At(0, 0))));
    let release = |lo, hi, a, c| bin(BinaryOp::Release, lo, hi, a, c);
    assert!(holds(&release(0, 9, F::At(0, 1), below(2))) && !holds(&release(0, 9, F::At(0, 2), below(2))));
    assert!(
        holds(&release(2, 9, F::At(0, 1), F::At(0, 9))) && !holds(&release(1, 9, F::At(0, 1), F::At(0, 9)))
    );
    let weak = |lo, hi, a, c| bin(BinaryOp::WeakUntil, lo, hi, a, c);
    assert!(holds(&weak(0, 1, below(2), F::At(0, 9))) && !holds(&weak(0, 2, below(2), F::At(0, 9))));
    assert!(holds(&weak(0, 2, below(2), F::At(0, 2))) && !holds(&weak(3, 3, below(2), F::At(0, 3))));
    let strong = |lo, hi, a, c| bin(BinaryOp::StrongRelease, lo, hi, a, c);
    assert!(holds(&strong(0, 2, F::At(0, 1), below(2))) && !holds(&strong(0, 2, F::At(0, 2), below(2))));
    assert!(!holds(&strong(2, 3, F::At(0, 1), below(2))) && !holds(&strong(0, 1, F::At(0, 2), below(3))));
    assert!(holds(&F::X(at(1))) && holds(&F::N(at(1))) && !holds(&F::N(at(0))));
}

#[test]
fn within_cuts_the_trace() {
    let holds = |k: u32, f: &F| on_line(Mode::Within(k), f);
    assert!(holds(2, &fin(0, None, 2)) && !holds(1, &fin(0, None, 2)) && !holds(1, &fin(0, 5, 2)));
    assert!(holds(1, &glob(2, None, 9)) && holds(1, &glob(2, 7, 9)) && !holds(2, &glob(2, 7, 9)));
    assert!(
        !holds(0, &F::X(at(1)))
            && holds(0, &F::N(at(1)))
            && holds(1, &F::X(at(1)))
            && !holds(1, &F::N(at(0)))
    );
    assert!(holds(0, &not(F::X(at(1)))) && !holds(0, &not(F::N(at(1)))));
    let tautology = F::Or(vec![F::At(0, 0), not(F::At(0, 0))]);
    // X true holds but at the last position.
    let strong = F::X(b(tautology.clone()));
    assert!(holds(2, &F::Glob(0, Some(1), b(strong.clone()))) && !holds(2, &F::Glob(0, None, b(strong))));
    let until = |lo, hi: Option<u32>, c| bin(BinaryOp::Until, lo, hi, tautology.clone(), c);
    assert!(!holds(1, &until(2, None, tautology.clone())) && holds(2, &until(2, None, tautology.clone())));
    let contradiction = || not(tautology.clone());
    let release = |lo, hi: Option<u32>, a, c| bin(BinaryOp::Release, lo, hi, a, c);
    assert!(holds(1, &release(2, None, contradiction(), contradiction())));
    assert!(!holds(2, &release(2, None, contradiction(), contradiction())));
    assert!(holds(2, &release(0, None, contradiction(), not(F::At(0, 3)))));
    assert!(!holds(3, &release(0, None, contradiction(), not(F::At(0, 3)))));
    let weak = |k, a, c| holds(k, &bin(BinaryOp::WeakUntil, 0, None, a, c));
    assert!(weak(2, not(F::At(0, 3)), F::At(0, 9)) && !weak(3, not(F::At(0, 3)), F::At(0, 9)));
    let strong = |k, a, c| holds(k, &bin(BinaryOp::StrongRelease, 0, None, a, c));
    assert!(strong(2, F::At(0, 2), not(F::At(0, 3))) && !strong(1, F::At(0, 2), not(F::At(0, 3))));
}

#[test]
fn nothing_was_taken_at_time_0() {
    let holds = |f: &F| on_line(Mode::Bounded, f);
    assert!(!holds(&F::Took(0, 0)) && holds(&F::X(b(F::Took(0, 0)))));
    assert!(holds(&F::SameAction(0, 0)) && holds(&F::Enabled(0, 0)) && holds(&F::SameState(0, 0)));
}
