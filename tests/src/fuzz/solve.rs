//! Tiny problems, solved in every way that needs no other program and judged by brute force.

use super::choices;
use crate::brute::Brute;
use crate::judge::{EMBEDDED, Judged, Way, fixture, lowered};
use crate::model::{Problem, Semantics};
use crate::random::{halting_problem, problem, problem_with_semantics};
use hyperplan_random::Random;
use hyperplan_solver::Spec;
use hyperplan_verify::{Budget, decide};

/// More paths than brute force looks at all tuples of in no time are left to the differential tests.
const MOST_PATHS: usize = 400;

fn problem_of(random: &mut Random) -> Problem {
    match random.below(4) {
        0 | 1 => problem(random),
        2 => {
            let semantics = Semantics::ALL[random.below(4)];
            problem_with_semantics(random, semantics)
        }
        _ => halting_problem(random),
    }
}

/// The problem that is made.
pub(super) fn made(data: &[u8]) -> String {
    problem_of(&mut choices(data)).to_string()
}

pub(super) fn body(data: &[u8]) {
    let problem = problem_of(&mut choices(data));
    let Some(brute) = Brute::new(&problem, MOST_PATHS) else { return };
    let expected = brute.verdict();
    let text = fixture(&problem.to_string(), expected);
    let typed = lowered(&text);
    let decided = decide(&typed, &typed.objectives[0], &Budget::default());
    assert_eq!(decided, Ok(Some(expected)), "{text}");
    for way in Way::all(&typed, &Spec::Builtin, EMBEDDED) {
        if let Judged::Wrong(why) = way.judged(&problem, &brute, &typed, &Spec::Builtin, None) {
            panic!("{way:?}: {why}\n{text}");
        }
    }
}
