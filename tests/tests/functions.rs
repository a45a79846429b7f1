//! Benchmarks in which paths are functions against brute force, on random problems: z3 and cvc5 say whether they are
//! satisfiable, and their models, in which functions are defined, are read back.
//!
//! `HYPERPLAN_SEED` and `HYPERPLAN_CASES` replace the seed and the number of problems.

use hyperplan_plan::{EmitConfig, Fault, Paths, Quantifiers, States, Status, Track, emit, strategy_of_model};
use hyperplan_problem::Problem;
use hyperplan_smt::{Evaluation, Model, Verdict, check_partial_model, read_script};
use hyperplan_solver::{Deadline, PrintedModel, Spec, discover};
use hyperplan_tests::brute::{Brute, Path};
use hyperplan_tests::judge::{lowered, path};
use hyperplan_tests::random::{Random, problem};
use hyperplan_tests::{model, number, say};
use std::collections::BTreeMap;
use std::fs;
use std::process::Command;
use std::str::FromStr;

/// How many problems are enough for all logics to occur.
const CASES: u64 = 16;

/// How long a solver may think about a query, which are small.
const MILLISECONDS: u32 = 1_000;

/// A solver with what it is to be told.
type Solver = (&'static str, Vec<String>);

fn solvers() -> Vec<Solver> {
    let all =
        [("z3", vec![format!("-t:{MILLISECONDS}")]), ("cvc5", vec![format!("--tlimit={MILLISECONDS}")])];
    let found: Vec<Spec> = discover()
        .into_iter()
        .filter(|found| found.path.is_some())
        .filter_map(|found| Spec::from_str(&found.name).ok())
        .collect();
    all.into_iter().filter(|(name, _)| found.iter().any(|spec| spec.name() == *name)).collect()
}

/// What a solver prints for a file.
fn printed((name, options): &Solver, query: &str) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("query.smt2");
    fs::write(&file, query).expect("the folder is ours");
    let output = Command::new(name).args(options).arg(&file).output().expect("it was found");
    String::from_utf8(output.stdout).expect("solvers speak ASCII")
}

/// One way of writing a query.
#[derive(Clone, Copy, Debug)]
struct Way {
    states: States,
    paths: Paths,
    quantifiers: Quantifiers,
}

impl Way {
    fn all() -> impl Iterator<Item = Way> {
        let states = [States::Bitvec, States::Int, States::Real].into_iter();
        let paths = |states| [Paths::Functions, Paths::Policies].map(|paths| (states, paths));
        states.flat_map(paths).flat_map(|(states, paths)| {
            [Quantifiers::Keep, Quantifiers::Expand].map(|quantifiers| Way { states, paths, quantifiers })
        })
    }

    /// The query, and its logic; `None` where it cannot be written so.
    fn query(self, problem: &Problem) -> Option<(String, String)> {
        let Way { states, paths, quantifiers } = self;
        let config = EmitConfig {
            states: Some(states),
            paths,
            quantifiers,
            track: Track::Model,
            status: Some(Status::Unknown),
            ..EmitConfig::new("2026-11-28")
        };
        let mut emitted = match emit(problem, &problem.objectives[0], &config) {
            Err(error) if error.fault() == Fault::Request => return None,
            emitted => emitted.unwrap_or_else(|error| panic!("{self:?}: {error}")),
        };
        let mut text = Vec::new();
        emitted.write(&mut text).expect("memory");
        Some((String::from_utf8(text).expect("it is ASCII"), emitted.logic))
    }
}

/// What is wrong with a model, if something is: as a model of the text, and as paths.
fn wrong(
    random: &model::Problem,
    brute: &Brute<'_>,
    typed: &Problem,
    query: &str,
    output: &str,
) -> Option<String> {
    let printed = match PrintedModel::read(output) {
        Ok(printed) => printed,
        Err(error) => return Some(error.to_string()),
    };
    let benchmark = read_script(query).unwrap_or_else(|error| panic!("{error}\n{query}"));
    let terms = &benchmark.script.terms;
    let mut model = Model::new();
    for &function in &benchmark.functions {
        match printed.function(terms, function) {
            Ok(definition) => definition.into_iter().for_each(|d| model.define(function, d.clone())),
            Err(error) => return Some(error.to_string()),
        }
    }
    if let Some(violated) = check_partial_model(&benchmark.script, &model).violated {
        return Some(format!("assertion {violated} is false"));
    }
    let evaluation = Evaluation::new(terms, &model);
    let undecided = |literals: &&[_]| evaluation.clause(literals) != Verdict::True;
    // Those with quantifiers are left.
    if let Some(literals) = benchmark.script.assertions(0).find(undecided)
        && !literals.iter().any(|&t| terms.is_quantified(t))
    {
        return Some("an assertion is not true".to_owned());
    }
    let objective = &typed.objectives[0];
    let strategy = match strategy_of_model(typed, objective, &printed, &Deadline::never()) {
        Ok(strategy) => strategy,
        Err(error) => return Some(error.to_string()),
    };
    let paths: Vec<Path> = strategy.traces.iter().map(|trace| path(&random.system, typed, trace)).collect();
    brute.refute(&paths, random.exists[0])
}

#[test]
fn functions_are_decided_as_brute_force_does() {
    let solvers = solvers();
    let first = number("HYPERPLAN_SEED", 20_261_128);
    let cases = number("HYPERPLAN_CASES", CASES);
    say(&format!("seed {first}, {cases} cases, {} solvers", solvers.len()));
    let (mut logics, mut answers, mut skolem) = (BTreeMap::<String, [u32; 2]>::new(), [0_u32; 3], 0_u32);
    for seed in (0..cases).map(|i| first.wrapping_add(i)) {
        let random = problem(&mut Random::new(seed));
        let brute = Brute::new(&random, usize::MAX / 8).expect("no limit");
        let typed = lowered(&random.to_string());
        // A counterexample is asked for where the first quantifier is universal.
        let expected = brute.verdict() == random.exists[0];
        let nested = typed.objectives[0].blocks().len() > 2;
        for way in Way::all() {
            let Some((query, logic)) = way.query(&typed) else { continue };
            logics.entry(logic).or_default()[usize::from(expected)] += 1;
            for solver in &solvers {
                let output = printed(solver, &query);
                let who = || format!("seed {seed}, {}, {way:?}\n{random}\n{query}\n{output}", solver.0);
                match output.lines().next() {
                    Some("sat") => {
                        assert!(expected, "{}", who());
                        let wrong = wrong(&random, &brute, &typed, &query, &output);
                        assert_eq!(wrong, None, "{}", who());
                        answers[1] += 1;
                        skolem += u32::from(nested && way.quantifiers == Quantifiers::Keep);
                    }
                    Some("unsat") => {
                        assert!(!expected, "{}", who());
                        answers[0] += 1;
                    }
                    Some("unknown" | "timeout") | None => answers[2] += 1,
                    Some(_) if output.contains("timeout") => answers[2] += 1,
                    Some(_) => panic!("{}", who()),
                }
            }
        }
    }
    say(&format!(
        "{logics:?} unsatisfiable and satisfiable; {answers:?} unsat, sat, undecided; {skolem} sat of three blocks"
    ));
    if cases >= CASES && !solvers.is_empty() {
        for logic in ["QF_UFBV", "UFBV", "QF_UFLIA", "UFLIA", "QF_UFLRA", "UFLRA"] {
            let both = logics.get(logic).is_some_and(|found| found.iter().all(|&count| count > 0));
            assert!(both, "{logic}: {logics:?}");
        }
        let [unsat, sat, undecided] = answers;
        assert!(unsat > 50 && sat > 50 && undecided < unsat + sat, "{answers:?}");
        assert!(skolem > 0, "no function of a universal path was found");
    }
}
