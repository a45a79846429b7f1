//! An objective in cases by first actions comes to the same as the whole.

use super::{Tally, seeds};
use hyperplan_plan::{Quantifiers, Verdict, cubes, within};
use hyperplan_problem::Quantifier;
use hyperplan_tests::brute::Brute;
use hyperplan_tests::judge::{lowered, verdict};
use hyperplan_tests::model::Semantics;
use hyperplan_tests::random::{Random, halting_problem, problem, problem_with_semantics};

#[test]
fn cases_come_to_the_whole() {
    let mut tally = Tally::default();
    let mut cut = 0;
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
        let text = problem.to_string();
        let typed = lowered(&text);
        let objective = &typed.objectives[0];
        let at_least = 1 + random.below(12);
        let cases = cubes(&typed, objective, at_least);
        cut += u32::from(cases.len() > 1);
        let verdicts: Vec<Verdict> =
            cases.iter().map(|cube| verdict(&typed, &within(objective, cube), Quantifiers::Auto)).collect();
        let (decides, all) = match objective.paths.first().expect("there is one").quantifier {
            Quantifier::Exists => (Verdict::Realizable, Verdict::Unrealizable),
            Quantifier::Forall => (Verdict::Unrealizable, Verdict::Realizable),
        };
        let together = if verdicts.contains(&decides) { decides } else { all };
        assert!(!verdicts.contains(&Verdict::Unknown), "seed {seed}: {verdicts:?}\n{problem}");
        let expected = Brute::new(&problem, usize::MAX / 8).expect("no limit").verdict();
        let found = together == Verdict::Realizable;
        assert_eq!(found, expected, "seed {seed}: {cases:?} give {verdicts:?}\n{problem}");
        tally.add(expected);
    }
    assert!(cut > 0, "nothing was ever cut");
    tally.assert_balanced();
}
