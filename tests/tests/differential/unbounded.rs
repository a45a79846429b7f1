//! Systems with integers and reals: random ones whose paths meet finitely many states all the same.

use super::{Answers, Tally, check_some_strategies, seeds};
use hyperplan_plan::Quantifiers;
use hyperplan_solver::{Spec, discover};
use hyperplan_tests::brute::Brute;
use hyperplan_tests::judge::lowered;
use hyperplan_tests::random::{Random, unbounded_problem};
use hyperplan_tests::say;
use hyperplan_verify::{Budget, decide};
use std::str::FromStr;

#[test]
fn the_checker_decides_unbounded_systems_as_brute_force_does() {
    checker_decides(1000);
}

pub(super) fn checker_decides(cases: u64) {
    let mut tally = Tally::default();
    let mut without_within = 0;
    for seed in seeds(cases) {
        let random = unbounded_problem(&mut Random::new(seed));
        let text = random.to_string();
        let brute = Brute::new(&random, usize::MAX / 8).expect("no limit");
        let expected = brute.verdict();
        tally.add(expected);
        without_within += u32::from(random.within.is_none());
        let typed = lowered(&text);
        let answer = decide(&typed, &typed.objectives[0], &Budget::default());
        assert_eq!(answer, Ok(Some(expected)), "seed {seed}\n{text}");
        // Without `within` a trace has to have the length of its horizon, which brute force does not know.
        if random.within.is_some() {
            check_some_strategies(&random, &brute, &typed, seed, &text);
        }
    }
    tally.assert_balanced();
    say(&format!("{without_within} without `within`"));
    assert!(cases < 1000 || without_within > 50 || std::env::var_os("HYPERPLAN_CASES").is_some());
}

#[test]
fn external_solvers_decide_unbounded_systems_as_brute_force_does() {
    let able = |abilities: &[String]| ["integers", "reals"].iter().all(|a| abilities.iter().any(|b| a == b));
    for solver in discover().into_iter().filter(|solver| solver.path.is_some() && able(&solver.abilities)) {
        let spec = Spec::from_str(&solver.name).expect("a solver that was discovered");
        let mut answers = Answers::default();
        for seed in seeds(20) {
            let random = unbounded_problem(&mut Random::new(seed));
            answers.compare(&random, &spec, &[Quantifiers::Keep, Quantifiers::Cegis], seed);
        }
        say(&format!("{} on systems without bounds", solver.name));
        answers.report(&solver.name);
    }
}
