//! Objectives over systems whose variables are of different types: searches by counterexamples, benchmarks of these, and
//! models, with every external solver that is there. The checker says what is right.
//!
//! `HYPERPLAN_SEED` and `HYPERPLAN_CASES` replace the seed and the number of problems.

use hyperplan_plan::{
    Config, EmitConfig, Error, Fault, Quantifiers, States, Status, Track, Verdict, emit, solve,
    strategy_of_model,
};
use hyperplan_problem::{NoFiles, Overrides, Problem, read};
use hyperplan_solver::{Catalog, Deadline, PrintedModel, Spec, discover};
use hyperplan_syntax::SourceMap;
use hyperplan_tests::mixed::Mixed;
use hyperplan_tests::random::Random;
use hyperplan_tests::{number, say};
use hyperplan_verify::{Budget, Check, check, decide};
use std::fs;
use std::process::Command;
use std::str::FromStr;
use std::time::Duration;

fn seeds(cases: u64) -> impl Iterator<Item = u64> {
    let first = number("HYPERPLAN_SEED", 20_261_127);
    let cases = number("HYPERPLAN_CASES", cases);
    say(&format!("seed {first}, {cases} cases"));
    (0..cases).map(move |i| first.wrapping_add(i))
}

fn lowered(text: &str) -> Problem {
    let lowered = read(&mut SourceMap::new(), "mixed.hp", text, &NoFiles, &Overrides::default());
    assert!(!lowered.has_errors(), "{text}\n{:#?}", lowered.diagnostics);
    lowered.problem
}

/// The external solvers that know integers and reals.
fn solvers() -> Vec<Spec> {
    let able = |abilities: &[String]| ["integers", "reals"].iter().all(|a| abilities.iter().any(|b| a == b));
    let found = discover().into_iter().filter(|found| found.path.is_some() && able(&found.abilities));
    found.map(|found| Spec::from_str(&found.name).expect("a solver that was discovered")).collect()
}

/// How states may be written where numbers are as they are.
fn states(mixed: &Mixed, bounded: bool) -> Vec<States> {
    match bounded {
        true => vec![States::Onehot, States::Enum, States::Bitvec, States::Int, States::Real],
        false if mixed.has_int() => vec![States::Int],
        false => vec![States::Int, States::Real],
    }
}

#[test]
fn searches_by_counterexamples_decide_as_the_checker_does() {
    let solvers = solvers();
    let (mut given, mut unknown, mut verdicts) = (0_u32, 0_u32, [0_u32; 2]);
    for seed in seeds(20) {
        let mixed = Mixed::alternating(&mut Random::new(seed));
        for bounded in [true, false] {
            let text = mixed.text(bounded);
            let problem = lowered(&text);
            let objective = &problem.objectives[0];
            let expected = decide(&problem, objective, &Budget::default()).expect("numbers are small");
            let expected = expected.unwrap_or_else(|| panic!("seed {seed} is too large\n{text}"));
            verdicts[usize::from(expected)] += 1;
            // Of what the embedded solver could write other tests think.
            let arithmetic = states(&mixed, bounded).into_iter().filter(|states| states.is_arithmetic());
            for (solver, states) in solvers.iter().flat_map(|s| arithmetic.clone().map(move |how| (s, how))) {
                let config = Config {
                    quantifiers: Quantifiers::Cegis,
                    states: Some(states),
                    deadline: Deadline::after(Duration::from_secs(60)),
                    ..Config::new(solver.clone())
                };
                let who = format!("{solver:?} states {states}, seed {seed}");
                let outcome = solve(&problem, objective, &config);
                let outcome = outcome.unwrap_or_else(|error| panic!("{who}: {error}\n{text}"));
                let right = if expected { Verdict::Realizable } else { Verdict::Unrealizable };
                match outcome.verdict {
                    Verdict::Unknown => unknown += 1,
                    verdict => assert_eq!(verdict, right, "{who}\n{text}"),
                }
                given += 1;
            }
        }
    }
    say(&format!("{given} answers, {unknown} unknown; {verdicts:?} unrealizable and realizable"));
    assert!(unknown * 50 <= given, "{unknown} of {given} are undecided");
}

/// What a solver prints for a file.
fn printed(solver: &Spec, text: &str, incremental: bool) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("query.smt2");
    fs::write(&file, text).expect("the folder is ours");
    let program = Catalog::default().standalone(solver).expect("it was found").expect("it is external");
    let file = file.to_str().expect("it is plain");
    let (arguments, input) = program.arguments(file, incremental && solver.name() != "z3");
    let mut command = Command::new(&program.program);
    // Version 1.0.3 of cvc5 does not read every text from its standard input.
    command.args(arguments).args(input.then_some(file));
    String::from_utf8(command.output().expect("it was found").stdout).expect("solvers speak ASCII")
}

#[test]
fn everyone_agrees_on_what_is_said_in_a_search() {
    let solvers = solvers();
    let mut dialogues = 0;
    for seed in seeds(30) {
        let mixed = Mixed::alternating(&mut Random::new(seed));
        let problem = lowered(&mixed.text(false));
        let config = EmitConfig { track: Track::Incremental, ..EmitConfig::new("2026-11-27") };
        let mut emitted = match emit(&problem, &problem.objectives[0], &config) {
            // Not every search asks twice.
            Err(error) if error.fault() == Fault::Request => continue,
            emitted => emitted.unwrap_or_else(|error| panic!("seed {seed}: {error}\n{}", mixed.text(false))),
        };
        let mut text = Vec::new();
        emitted.write(&mut text).expect("memory");
        let text = String::from_utf8(text).expect("it is ASCII");
        let said = |line: &str| Some(line.strip_prefix("(set-info :status ")?.strip_suffix(')')?.to_owned());
        let expected: Vec<String> = text.lines().filter_map(said).collect();
        for solver in &solvers {
            let printed = printed(solver, &text, true);
            assert_eq!(printed.lines().collect::<Vec<_>>(), expected, "{solver:?}, seed {seed}\n{text}");
        }
        dialogues += 1;
    }
    say(&format!("{dialogues} dialogues"));
}

#[test]
fn models_of_all_solvers_are_understood() {
    let solvers = solvers();
    let mut models = 0;
    for seed in seeds(20) {
        let mixed = Mixed::existential(&mut Random::new(seed));
        for bounded in [true, false] {
            let text = mixed.text(bounded);
            let problem = lowered(&text);
            let objective = &problem.objectives[0];
            for states in states(&mixed, bounded) {
                let config = EmitConfig {
                    track: Track::Model,
                    states: Some(states),
                    status: Some(Status::Unknown),
                    ..EmitConfig::new("2026-11-27")
                };
                let mut emitted =
                    emit(&problem, objective, &config).unwrap_or_else(|e| panic!("seed {seed}: {e}\n{text}"));
                let mut query = Vec::new();
                emitted.write(&mut query).expect("memory");
                let query = String::from_utf8(query).expect("it is ASCII");
                for solver in &solvers {
                    // Not every solver has datatypes.
                    if states == States::Enum && *solver == Spec::Profile("yices".to_owned()) {
                        continue;
                    }
                    let output = printed(solver, &query, false);
                    if !output.starts_with("sat") {
                        assert!(output.starts_with("unsat"), "{solver:?}: {output}\n{query}");
                        continue;
                    }
                    let who = format!("{solver:?} states {states}, seed {seed}: {output}\n{text}");
                    let model = PrintedModel::read(&output).unwrap_or_else(|e| panic!("{e}: {who}"));
                    let strategy = strategy_of_model(&problem, objective, &model, &Deadline::never());
                    let strategy = strategy.unwrap_or_else(|error: Error| panic!("{error}: {who}"));
                    let verdict = check(&problem, objective, &strategy, &Budget::default());
                    assert!(matches!(verdict, Ok(Check::Holds)), "{verdict:?}: {who}");
                    models += 1;
                }
            }
        }
    }
    say(&format!("{models} models"));
    assert!(solvers.is_empty() || models > 0);
}
