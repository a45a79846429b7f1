//! `within K semantics S` against its definition, and how the semantics relate.

use super::{Answers, Tally, action, embedded, seeds, state};
use hyperplan_problem::{Quantifier, Strategy, Trace};
use hyperplan_tests::brute::{Brute, Path};
use hyperplan_tests::judge::{EMBEDDED, lowered};
use hyperplan_tests::model::{Problem, Semantics};
use hyperplan_tests::random::{Random, halting_problem, problem_with_semantics};
use hyperplan_tests::say;
use hyperplan_verify::{Budget, Check, check, decide};

/// Some choices of paths.
fn tuples<'b>(brute: &'b Brute<'_>, paths: usize, random: &mut Random) -> Vec<Vec<&'b Path>> {
    let mut one = || &brute.paths[random.below(brute.paths.len())];
    (0..24).map(|_| (0..paths).map(|_| one()).collect()).collect()
}

#[test]
fn what_holds_under_one_holds_under_the_next() {
    // How often the next one holds and this one does not.
    let mut apart = [0u32; 3];
    for seed in seeds(2000) {
        let mut random = Random::new(seed);
        let problem = problem_with_semantics(&mut random, Semantics::Pes);
        let brute = Brute::new(&problem, usize::MAX / 8).expect("no limit");
        for tuple in tuples(&brute, problem.exists.len(), &mut random) {
            let truth = Semantics::ALL.map(|s| brute.holds_under(s, &problem.formula, &tuple));
            assert!(truth.is_sorted(), "seed {seed}: {truth:?} for {tuple:?}\n{problem}");
            for (apart, pair) in apart.iter_mut().zip(truth.windows(2)) {
                *apart += u32::from(pair[0] != pair[1]);
            }
        }
    }
    say(&format!("apart: {apart:?}"));
    assert!(apart.iter().all(|&n| n > 0), "two of the semantics never differ: {apart:?}");
}

#[test]
fn the_checker_reads_each_trace_as_defined() {
    checker_reads(2000);
}

pub(super) fn checker_reads(cases: u64) {
    let mut tally = Tally::default();
    for seed in seeds(cases) {
        let mut random = Random::new(seed);
        let semantics = Semantics::ALL[random.below(4)];
        let problem = problem_with_semantics(&mut random, semantics);
        let text = problem.to_string();
        let mut typed = lowered(&text);
        // With every path chosen, the strategy is good if the formula holds.
        let paths = &mut typed.objectives[0].paths;
        paths.iter_mut().for_each(|path| path.quantifier = Quantifier::Exists);
        let objective = &typed.objectives[0];
        let brute = Brute::new(&problem, usize::MAX / 8).expect("no limit");
        for tuple in tuples(&brute, problem.exists.len(), &mut random) {
            let traces = objective.paths.keys().zip(&tuple).map(|(path, chosen)| Trace {
                path,
                states: chosen.states.iter().map(|&s| state(&problem.system, s)).collect(),
                actions: chosen.actions.iter().map(|&a| action(&typed, problem.system.actions[a])).collect(),
            });
            let strategy = Strategy { traces: traces.collect() };
            let verdict = check(&typed, objective, &strategy, &Budget::default());
            let expected = brute.holds_under(semantics, &problem.formula, &tuple);
            tally.add(expected);
            let holds = matches!(verdict, Ok(Check::Holds));
            assert_eq!(holds, expected, "seed {seed}: {verdict:?} for {tuple:?}\n{text}");
        }
    }
    tally.assert_balanced();
}

#[test]
fn the_embedded_solver_finds_what_is_defined() {
    embedded_solver_finds(400);
}

pub(super) fn embedded_solver_finds(cases: u64) {
    let mut answers = Answers::default();
    let mut tally = Tally::default();
    for seed in seeds(cases) {
        let mut random = Random::new(seed);
        let semantics = Semantics::ALL[random.below(4)];
        let problem = problem_with_semantics(&mut random, semantics);
        tally.add(Brute::new(&problem, usize::MAX / 8).expect("no limit").verdict());
        for solver in embedded(seed) {
            answers.compare(&problem, &solver, EMBEDDED, seed);
        }
    }
    answers.report("embedded");
    tally.assert_balanced();
}

#[test]
fn where_all_paths_halt_the_infinite_ones_are_known() {
    let mut tally = Tally::default();
    for seed in seeds(800) {
        let infinite = halting_problem(&mut Random::new(seed));
        let expected = Brute::new(&infinite, usize::MAX / 8).expect("no limit").verdict();
        tally.add(expected);
        // A state is left for a higher one, so that the paths of K steps all have halted.
        let within = u32::try_from(infinite.system.states() - 1).ok();
        for semantics in [Semantics::Hpes, Semantics::Hopt] {
            let problem = Problem { within, semantics: Some(semantics), ..infinite.clone() };
            let brute = Brute::new(&problem, usize::MAX / 8).expect("no limit");
            assert_eq!(brute.verdict(), expected, "seed {seed}\n{problem}");
            let typed = lowered(&problem.to_string());
            let answer = decide(&typed, &typed.objectives[0], &Budget::default());
            assert_eq!(answer, Ok(Some(expected)), "seed {seed}\n{problem}");
        }
    }
    tally.assert_balanced();
}
