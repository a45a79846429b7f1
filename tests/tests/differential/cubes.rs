//! An objective in cases comes to the same as the whole.

use super::{Tally, seeds};
use hyperplan_plan::{Config, Quantifiers, States, Verdict, case, solve};
use hyperplan_problem::Quantifier;
use hyperplan_solver::{Deadline, Spec};
use hyperplan_tests::brute::Brute;
use hyperplan_tests::judge::lowered;
use hyperplan_tests::model::Semantics;
use hyperplan_tests::random::{Random, halting_problem, problem, problem_with_semantics};
use std::time::Duration;

/// Cut by where paths are, and, where states are written by variable, by what paths do.
#[test]
fn cases_come_to_the_whole() {
    let mut tally = Tally::default();
    let mut cut = [0; 2];
    for seed in seeds(400) {
        let mut random = Random::new(seed);
        let problem = match random.below(3) {
            0 => problem(&mut random),
            1 => halting_problem(&mut random),
            _ => {
                let semantics = Semantics::ALL[random.below(4)];
                problem_with_semantics(&mut random, semantics)
            }
        };
        let typed = lowered(&problem.to_string());
        let objective = &typed.objectives[0];
        let states = [None, None, Some(States::Bitvec)][random.below(3)];
        let ways = [Quantifiers::Auto, Quantifiers::Cegis, Quantifiers::Expand];
        let quantifiers = ways[random.below(3)];
        let deadline = Deadline::after(Duration::from_secs(60));
        let config = Config { quantifiers, states, deadline, ..Config::new(Spec::Builtin) };
        let number = 1 + random.below(12);
        let verdict = |index: usize| {
            let (own, config) = case(&typed, objective, (index, number), &config).expect("it is small");
            let places = config.among.cube != Default::default();
            let actions = states.is_some() && own.formula.nodes.len() > objective.formula.nodes.len();
            cut = [cut[0] + u32::from(places), cut[1] + u32::from(actions)];
            solve(&typed, &own, &config).expect("it is supported").verdict
        };
        let verdicts: Vec<Verdict> = (0..number).map(verdict).collect();
        let (decides, all) = match objective.paths.first().expect("there is one").quantifier {
            Quantifier::Exists => (Verdict::Realizable, Verdict::Unrealizable),
            Quantifier::Forall => (Verdict::Unrealizable, Verdict::Realizable),
        };
        let together = if verdicts.contains(&decides) { decides } else { all };
        assert!(!verdicts.contains(&Verdict::Unknown), "seed {seed}: {verdicts:?}\n{problem}");
        let expected = Brute::new(&problem, usize::MAX / 8).expect("no limit").verdict();
        let found = together == Verdict::Realizable;
        assert_eq!(found, expected, "seed {seed}: {number} cases give {verdicts:?}\n{problem}");
        tally.add(expected);
    }
    assert!(cut[0] > 0 && cut[1] > 0, "nothing was ever cut: {cut:?}");
    tally.assert_balanced();
}
