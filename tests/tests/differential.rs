//! The checker and the planner against brute force, on random problems.
//!
//! `HYPERPLAN_SEED` and `HYPERPLAN_CASES` replace the seed and the number of problems, and `HYPERPLAN_FUZZ_SECONDS` that
//! number by a time; a failure prints the problem, ready to be put among the fixtures, and the seed that makes it the
//! first one.

use hyperplan_plan::Quantifiers;
use hyperplan_problem::{NoFiles, Overrides, Problem, Rational, Strategy, Value, read};
use hyperplan_solver::{Spec, discover};
use hyperplan_syntax::SourceMap;
use hyperplan_tests::brute::{Brute, Path};
use hyperplan_tests::judge::{EMBEDDED, Judged, Way, fixture, lowered};
use hyperplan_tests::model;
use hyperplan_tests::random::{Random, problem};
use hyperplan_tests::shrink::shrunk;
use hyperplan_tests::{deadline, number, say};
use hyperplan_verify::{Budget, check, decide};
use std::str::FromStr;
use std::time::Instant;

#[path = "differential/beliefs.rs"]
mod beliefs;
#[path = "differential/costs.rs"]
mod costs;
#[path = "differential/cubes.rs"]
mod cubes;
#[path = "differential/minimize.rs"]
mod minimize;
#[path = "differential/quick.rs"]
mod quick;
#[path = "differential/semantics.rs"]
mod semantics;
#[path = "differential/unbounded.rs"]
mod unbounded;

/// The seeds of the random problems, one each.
fn seeds(cases: u64) -> impl Iterator<Item = u64> {
    let first = number("HYPERPLAN_SEED", 20_260_101);
    let end = deadline();
    let cases = number("HYPERPLAN_CASES", if end.is_some() { u64::MAX } else { cases });
    match end {
        Some(_) => say(&format!("seed {first}, as many cases as there is time for")),
        None => say(&format!("seed {first}, {cases} cases")),
    }
    let in_time = move |_: &u64| end.is_none_or(|end| Instant::now() < end);
    (0..cases).map(move |i| first.wrapping_add(i)).take_while(in_time)
}

/// A small problem for which there is something wrong with the answer, as there is for a larger one. What is no problem
/// any more has no answer.
fn smallest(
    problem: &model::Problem,
    wrong: impl Fn(&model::Problem, &Brute<'_>, &Problem) -> bool,
) -> String {
    let fails = |problem: &model::Problem| {
        let text = problem.to_string();
        let lowered = read(&mut SourceMap::new(), "random.hp", &text, &NoFiles, &Overrides::default());
        let brute = Brute::new(problem, 10_000).filter(|_| !lowered.has_errors());
        brute.is_some_and(|brute| wrong(problem, &brute, &lowered.problem))
    };
    let small = shrunk(problem.clone(), fails);
    let expected = Brute::new(&small, usize::MAX / 8).expect("no limit").verdict();
    format!("the smallest like it:\n{}", fixture(&small.to_string(), expected))
}

/// Each verdict must be common enough for the comparison to mean something.
#[derive(Default)]
struct Tally {
    realizable: u64,
    unrealizable: u64,
}

impl Tally {
    fn add(&mut self, verdict: bool) {
        *if verdict { &mut self.realizable } else { &mut self.unrealizable } += 1;
    }

    fn assert_balanced(&self) {
        let all = self.realizable + self.unrealizable;
        say(&format!("{} realizable, {} unrealizable", self.realizable, self.unrealizable));
        let rare = 5 * self.realizable.min(self.unrealizable) < all;
        assert!(all < 100 || !rare, "one verdict is less than a fifth of all");
    }
}

#[test]
fn the_checker_decides_as_brute_force_does() {
    checker_decides(4000);
}

fn checker_decides(cases: u64) {
    let mut tally = Tally::default();
    for seed in seeds(cases) {
        let random = problem(&mut Random::new(seed));
        let brute = Brute::new(&random, usize::MAX / 8).expect("no limit");
        let expected = brute.verdict();
        let text = fixture(&random.to_string(), expected);
        tally.add(expected);
        let typed = lowered(&text);
        let objective = &typed.objectives[0];
        let answer = decide(&typed, objective, &Budget::default());
        if answer != Ok(Some(expected)) {
            let small = smallest(&random, |_, brute, typed| {
                decide(typed, &typed.objectives[0], &Budget::default()) != Ok(Some(brute.verdict()))
            });
            panic!("seed {seed}: {answer:?}\n{text}{small}");
        }
        check_some_strategies(&random, &brute, &typed, seed, &text);
    }
    tally.assert_balanced();
}

/// Gives the checker paths that may or may not be good strategies.
fn check_some_strategies(random: &model::Problem, brute: &Brute<'_>, typed: &Problem, seed: u64, text: &str) {
    let objective = &typed.objectives[0];
    let leading = objective.leading_block();
    let claimed = random.exists[0];
    let system = &typed.systems[objective.paths[leading[0]].system];
    for i in 0..brute.paths.len().min(4) {
        let chosen: Vec<Path> =
            (0..leading.len()).map(|j| brute.paths[(i * 7 + j * 3) % brute.paths.len()].clone()).collect();
        let traces = leading.iter().zip(&chosen).map(|(&path, chosen)| hyperplan_problem::Trace {
            path,
            states: chosen.states.iter().map(|&s| state(&random.system, s)).collect(),
            actions: chosen.actions.iter().map(|&a| action(typed, random.system.actions[a])).collect(),
        });
        let strategy = Strategy { traces: traces.collect() };
        assert!(strategy.traces.iter().all(|t| t.actions.iter().all(|a| system.actions.contains(a))));
        let verdict = check(typed, objective, &strategy, &Budget::default());
        let expected = brute.refute(&chosen, claimed);
        let holds = matches!(verdict, Ok(hyperplan_verify::Check::Holds));
        let fails = matches!(verdict, Ok(hyperplan_verify::Check::Fails(_)));
        assert_ne!(holds, fails, "seed {seed}: {verdict:?}\n{text}");
        assert_eq!(
            holds,
            expected.is_none(),
            "seed {seed}: {chosen:?}: {verdict:?}, but {expected:?}\n{text}"
        );
    }
}

fn state(system: &model::System, state: usize) -> hyperplan_problem::State {
    let values = system.values(state).into_iter().zip(&system.vars).map(|(value, (_, kind))| match kind {
        model::Kind::Range(_) | model::Kind::Int(_) => {
            Value::Int(i64::try_from(value).expect("values are few and small"))
        }
        model::Kind::Real(_) => {
            Value::Real(Rational::new(i64::try_from(value).expect("values are few and small"), 2))
        }
        model::Kind::Bool => Value::Bool(value == 1),
        model::Kind::Enum(_) => Value::Enum(u32::try_from(value).expect("values are few and small")),
    });
    values.collect()
}

fn action(problem: &Problem, name: &str) -> hyperplan_problem::ActionId {
    problem.action(name).expect("an action of the problem")
}

/// How many answers there were, how many requests were not supported or not decided, and what was wrong.
#[derive(Default)]
struct Answers {
    /// Who is asked whether what is said to be unsatisfiable is so.
    second: Option<Spec>,
    given: u64,
    unsupported: u64,
    unknown: u64,
    wrong: Vec<String>,
    /// The first that was wrong.
    first: Option<(model::Problem, Spec, Way)>,
}

impl Answers {
    /// Compares all ways to solve a problem by one solver with brute force.
    fn compare(&mut self, random: &model::Problem, solver: &Spec, ways: &[Quantifiers], seed: u64) {
        let brute = Brute::new(random, usize::MAX / 8).expect("no limit");
        let expected = brute.verdict();
        let text = fixture(&random.to_string(), expected);
        let typed = lowered(&text);
        for way in Way::all(&typed, solver, ways) {
            match way.judged(random, &brute, &typed, solver, self.second.clone()) {
                Judged::Unknown => self.unknown += 1,
                Judged::Unsupported => self.unsupported += 1,
                Judged::Right => self.given += 1,
                Judged::Wrong(why) => {
                    self.given += 1;
                    self.first.get_or_insert_with(|| (random.clone(), solver.clone(), way));
                    self.wrong.push(format!("{solver:?} {way:?}, seed {seed}: {why}\n{text}"));
                }
            }
        }
    }

    /// A small problem like the first whose answer was wrong.
    fn smallest(&self) -> Option<String> {
        let (problem, solver, way) = self.first.as_ref()?;
        let is_wrong = |problem: &model::Problem, brute: &Brute<'_>, typed: &Problem| {
            matches!(way.judged(problem, brute, typed, solver, self.second.clone()), Judged::Wrong(_))
        };
        Some(format!("{solver:?} {way:?}, {}", smallest(problem, is_wrong)))
    }

    fn report(&self, solver: &str) {
        let Answers { given, unsupported, unknown, wrong, .. } = self;
        say(&format!("{solver}: {given} answers, {unsupported} not supported, {unknown} unknown"));
        let some: Vec<&str> = wrong.iter().take(3).map(String::as_str).collect();
        assert!(
            wrong.is_empty(),
            "{} of {given} answers are wrong, such as\n{}\n{}",
            wrong.len(),
            some.join("\n"),
            self.smallest().unwrap_or_default()
        );
        // Small problems leave no excuse; what is not supported is a matter of the way to solve.
        assert!(unknown * 50 <= given + unknown, "{solver} left {unknown} of {} undecided", given + unknown);
        assert!(*given > 0, "{solver} answered nothing");
    }
}

/// The embedded solver with the best of its back ends, and now and then with the others too.
fn embedded(seed: u64) -> impl Iterator<Item = Spec> {
    let backends = Spec::backends();
    let number = if seed.is_multiple_of(3) { backends.len() } else { 1 };
    backends.into_iter().take(number)
}

#[test]
fn the_embedded_solver_answers_as_brute_force_does() {
    embedded_solver_answers(1000);
}

fn embedded_solver_answers(cases: u64) {
    let mut answers = Answers::default();
    let mut tally = Tally::default();
    for seed in seeds(cases) {
        let random = problem(&mut Random::new(seed));
        tally.add(Brute::new(&random, usize::MAX / 8).expect("no limit").verdict());
        for solver in embedded(seed) {
            answers.compare(&random, &solver, EMBEDDED, seed);
        }
    }
    answers.report("embedded");
    tally.assert_balanced();
}

/// Whether a solver reads another format than SMT-LIB.
fn gets_bits(solver: &Spec) -> bool {
    solver.profile().is_some_and(|profile| profile.format().is_some())
}

#[test]
fn external_solvers_answer_as_brute_force_does() {
    let ways = [Quantifiers::Keep, Quantifiers::Cegis, Quantifiers::Expand];
    let required = std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_some_and(|value| value == "1");
    let mut found = discover();
    found.retain(|solver| !solver.is_embedded);
    for solver in found {
        if solver.path.is_none() {
            // CI asks for these.
            let named = ["z3", "cvc5", "yices", "depqbf", "cryptominisat", "minisat", "picosat"];
            let must = required && named.contains(&solver.name.as_str());
            assert!(!must, "{} is missing", solver.name);
            say(&format!("{} is missing: skipped", solver.name));
            continue;
        }
        let spec = Spec::from_str(&solver.name).expect("a solver that was discovered");
        let mut answers = Answers::default();
        // Those of bits take a process for each check.
        for seed in seeds(if gets_bits(&spec) { 10 } else { 40 }) {
            answers.compare(&problem(&mut Random::new(seed)), &spec, &ways, seed);
        }
        answers.report(&solver.name);
    }
}

/// The same queries go to two solvers: one answers, and the next confirms that what it finds unsatisfiable is so.
#[test]
fn external_solvers_confirm_each_other() {
    let ways = [Quantifiers::Keep, Quantifiers::Cegis, Quantifiers::Expand];
    let found = discover().into_iter().filter(|solver| !solver.is_embedded && solver.path.is_some());
    let mut found: Vec<Spec> =
        found.map(|solver| Spec::from_str(&solver.name).expect("a solver that was discovered")).collect();
    // One of those that get bits stands for all.
    let bits = found.iter().find(|solver| gets_bits(solver)).cloned();
    found.retain(|solver| !gets_bits(solver) || bits.as_ref() == Some(solver));
    for (solver, second) in found.iter().zip(found.iter().cycle().skip(1)) {
        let mut answers = Answers { second: Some(second.clone()), ..Answers::default() };
        for seed in seeds(15) {
            answers.compare(&problem(&mut Random::new(seed)), solver, &ways, seed);
        }
        answers.report(&format!("{}, confirmed by {}", solver.name(), second.name()));
    }
}
