//! The checker and the planner against brute force, on random problems.
//!
//! `HYPERPLAN_SEED` and `HYPERPLAN_CASES` replace the seed and the number of problems, and `HYPERPLAN_FUZZ_SECONDS` that
//! number by a time; a failure prints the problem, ready to be put among the fixtures, and the seed that makes it the
//! first one.

use hyperplan_plan::{Config, Error, Fault, Limits, Outcome, Quantifiers, States, Verdict, solve};
use hyperplan_problem::{NoFiles, Objective, Overrides, Problem, Rational, Strategy, Value, read};
use hyperplan_solver::{Deadline, Spec, discover};
use hyperplan_syntax::SourceMap;
use hyperplan_tests::brute::{Brute, Path};
use hyperplan_tests::model;
use hyperplan_tests::random::{Random, problem};
use hyperplan_tests::shrink::shrunk;
use hyperplan_tests::{deadline, number, say};
use hyperplan_verify::{Budget, check, decide};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::str::FromStr;
use std::time::{Duration, Instant};

#[path = "differential/beliefs.rs"]
mod beliefs;
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

/// The problem as a fixture: with a comment that says how it has to be answered.
fn fixture(text: &str, expected: bool) -> String {
    let verdict = if expected { "realizable" } else { "unrealizable" };
    text.replacen("objective o", &format!("// o: {verdict}\nobjective o"), 1)
}

fn lowered(text: &str) -> Problem {
    let lowered = read(&mut SourceMap::new(), "random.hp", text, &NoFiles, &Overrides::default());
    assert!(!lowered.has_errors(), "{text}\n{:#?}", lowered.diagnostics);
    lowered.problem
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

/// A trace as brute force knows it.
fn path(system: &model::System, objective: &Problem, trace: &hyperplan_problem::Trace) -> Path {
    let index = |value: &Value| match value {
        Value::Bool(b) => usize::from(*b),
        Value::Int(n) => usize::try_from(*n).expect("values are few and small"),
        Value::Enum(i) => usize::try_from(*i).expect("values are few and small"),
        Value::Real(r) => usize::try_from((r * 2).to_integer()).expect("values are few and small"),
    };
    let state = |values: &hyperplan_problem::State| {
        system.state(&values.iter().map(index).collect::<Vec<_>>()).expect("a state of the system")
    };
    let action = |id: &hyperplan_problem::ActionId| {
        let name = &objective.actions[*id];
        system.actions.iter().position(|a| a == name).expect("an action of the system")
    };
    Path {
        states: trace.states.iter().map(state).collect(),
        actions: trace.actions.iter().map(action).collect(),
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

/// One way to solve: how quantifiers are decided, how states are written, and budgets.
#[derive(Clone, Copy, Debug)]
struct Way {
    quantifiers: Quantifiers,
    states: Option<States>,
    limits: Limits,
}

impl Way {
    /// All that a solver might be asked. The embedded one is also asked without pruning, and with budgets that are
    /// soon exceeded.
    fn all(solver: &Spec, quantifiers: &[Quantifiers]) -> Vec<Way> {
        let usual = Limits::default();
        let unpruned = Limits { prune: false, ..usual };
        let tight = Limits { layer_states: 40, pairs: 12, swept: 30, residuals: 8, ..usual };
        let mut ways = Vec::new();
        for &quantifiers in quantifiers {
            if quantifiers == Quantifiers::Explicit {
                let states = Some(States::Onehot);
                ways.extend([usual, unpruned].map(|limits| Way { quantifiers, states, limits }));
                continue;
            }
            for states in [States::Onehot, States::Enum, States::Bitvec, States::Int, States::Real] {
                ways.push(Way { quantifiers, states: Some(states), limits: usual });
            }
            if solver.is_embedded() {
                ways.push(Way { quantifiers, states: Some(States::Onehot), limits: unpruned });
                ways.push(Way { quantifiers, states: None, limits: tight });
            }
        }
        ways
    }

    fn answer(
        self,
        problem: &Problem,
        objective: &Objective,
        solver: &Spec,
        cross_check: Option<Spec>,
    ) -> Result<Outcome, Error> {
        let Way { quantifiers, states, limits } = self;
        let deadline = Deadline::after(Duration::from_secs(60));
        let config =
            Config { cross_check, quantifiers, states, limits, deadline, ..Config::new(solver.clone()) };
        solve(problem, objective, &config)
    }
}

/// The verdict of the embedded solver on an objective that must be decided.
fn verdict(problem: &Problem, objective: &Objective, quantifiers: Quantifiers) -> Verdict {
    let deadline = Deadline::after(Duration::from_secs(60));
    let config = Config { quantifiers, deadline, ..Config::new(Spec::Builtin) };
    solve(problem, objective, &config).expect("it is supported").verdict
}

enum Judged {
    Unknown,
    Unsupported,
    Right,
    Wrong(String),
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
        for way in Way::all(solver, ways) {
            let finite = typed.systems.iter().all(hyperplan_problem::System::is_finite);
            // The embedded solver has no numbers, and what is not finite is nothing else.
            let numbers = way.states.is_some_and(States::is_arithmetic);
            if numbers && solver.is_embedded() || !numbers && !finite {
                continue;
            }
            match self.judged(way, random, &brute, &typed, solver) {
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

    /// What an answer is worth.
    fn judged(
        &self,
        way: Way,
        random: &model::Problem,
        brute: &Brute<'_>,
        typed: &Problem,
        solver: &Spec,
    ) -> Judged {
        let second = self.second.clone();
        let answer =
            catch_unwind(AssertUnwindSafe(|| way.answer(typed, &typed.objectives[0], solver, second)));
        match answer {
            Ok(Ok(Outcome { verdict: Verdict::Unknown, .. })) => Judged::Unknown,
            Ok(Err(error)) if error.fault() == Fault::Request => Judged::Unsupported,
            Ok(answer) => {
                wrong(answer, random, brute, typed, brute.verdict()).map_or(Judged::Right, Judged::Wrong)
            }
            Err(_) => Judged::Wrong("it panics".to_owned()),
        }
    }

    /// A small problem like the first whose answer was wrong.
    fn smallest(&self) -> Option<String> {
        let (problem, solver, way) = self.first.as_ref()?;
        let is_wrong = |problem: &model::Problem, brute: &Brute<'_>, typed: &Problem| {
            matches!(self.judged(*way, problem, brute, typed, solver), Judged::Wrong(_))
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

/// What is wrong with an answer, if something is.
fn wrong(
    answer: Result<Outcome, Error>,
    random: &model::Problem,
    brute: &Brute<'_>,
    typed: &Problem,
    expected: bool,
) -> Option<String> {
    let outcome = match answer {
        Ok(outcome) => outcome,
        Err(error) => return Some(error.to_string()),
    };
    if (outcome.verdict == Verdict::Realizable) != expected {
        return Some(format!("the verdict is {:?}", outcome.verdict));
    }
    match &outcome.witness {
        Some(strategy) => {
            let paths: Vec<Path> = strategy.traces.iter().map(|t| path(&random.system, typed, t)).collect();
            brute.refute(&paths, expected).map(|why| format!("witness {paths:?}: {why}"))
        }
        None => (expected == random.exists[0]).then(|| "no witness".into()),
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
    let ways = [Quantifiers::Auto, Quantifiers::Cegis, Quantifiers::Expand, Quantifiers::Explicit];
    let mut answers = Answers::default();
    let mut tally = Tally::default();
    for seed in seeds(cases) {
        let random = problem(&mut Random::new(seed));
        tally.add(Brute::new(&random, usize::MAX / 8).expect("no limit").verdict());
        for solver in embedded(seed) {
            answers.compare(&random, &solver, &ways, seed);
        }
    }
    answers.report("embedded");
    tally.assert_balanced();
}

#[test]
fn external_solvers_answer_as_brute_force_does() {
    let ways = [Quantifiers::Keep, Quantifiers::Cegis, Quantifiers::Expand];
    let required = std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_some_and(|value| value == "1");
    let mut found = discover();
    found.retain(|solver| !solver.is_embedded);
    for solver in found {
        if solver.path.is_none() {
            // CI asks for these three.
            let must = required && ["z3", "cvc5", "yices"].contains(&solver.name.as_str());
            assert!(!must, "{} is missing", solver.name);
            say(&format!("{} is missing: skipped", solver.name));
            continue;
        }
        let spec = Spec::from_str(&solver.name).expect("a solver that was discovered");
        let mut answers = Answers::default();
        for seed in seeds(40) {
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
    let found: Vec<Spec> =
        found.map(|solver| Spec::from_str(&solver.name).expect("a solver that was discovered")).collect();
    for (solver, second) in found.iter().zip(found.iter().cycle().skip(1)) {
        let mut answers = Answers { second: Some(second.clone()), ..Answers::default() };
        for seed in seeds(15) {
            answers.compare(&problem(&mut Random::new(seed)), solver, &ways, seed);
        }
        answers.report(&format!("{}, confirmed by {}", solver.name(), second.name()));
    }
}
