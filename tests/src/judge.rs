//! Answers of the planner on random problems, judged by brute force.

use crate::brute::{Brute, Path};
use crate::model;
use hyperplan_plan::{Config, Error, Fault, Limits, Outcome, Pruning, Quantifiers, States, Verdict, solve};
use hyperplan_problem::{NoFiles, Objective, Overrides, Problem, System, Value, read};
use hyperplan_solver::{Deadline, Spec};
use hyperplan_syntax::SourceMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;

/// The problem as a fixture: with a comment that says how it has to be answered.
#[must_use]
pub fn fixture(text: &str, expected: bool) -> String {
    let verdict = if expected { "realizable" } else { "unrealizable" };
    text.replacen("objective o", &format!("// o: {verdict}\nobjective o"), 1)
}

/// What a text means that has no errors.
///
/// # Panics
/// If it has.
#[must_use]
pub fn lowered(text: &str) -> Problem {
    let lowered = read(&mut SourceMap::new(), "random.hp", text, &NoFiles, &Overrides::default());
    assert!(!lowered.has_errors(), "{text}\n{:#?}", lowered.diagnostics);
    lowered.problem
}

/// One way to solve: how quantifiers are decided, how states are written, and budgets.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// How quantifiers are decided.
    pub quantifiers: Quantifiers,
    /// How states are written.
    pub states: Option<States>,
    /// Budgets.
    pub limits: Limits,
}

/// The ways to decide quantifiers for which the embedded solver is enough.
pub const EMBEDDED: &[Quantifiers] =
    &[Quantifiers::Auto, Quantifiers::Cegis, Quantifiers::Expand, Quantifiers::Explicit];

impl Way {
    /// All that a solver might be asked of a problem. The embedded one is also asked without pruning, and with budgets
    /// that are soon exceeded.
    #[must_use]
    pub fn all(problem: &Problem, solver: &Spec, quantifiers: &[Quantifiers]) -> Vec<Way> {
        let usual = Limits::default();
        let unpruned = Limits { pruning: Pruning::Light, ..usual };
        let tight = Limits { layer_states: 40, pairs: 12, swept: 30, residuals: 8, chances: 0, ..usual };
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
        // The embedded solver has no numbers, and what is not finite is nothing else.
        let finite = problem.systems.iter().all(System::is_finite);
        ways.retain(|way| {
            let numbers = way.states.is_some_and(States::is_arithmetic);
            if numbers { !solver.is_embedded() } else { finite }
        });
        ways
    }

    fn answer(self, problem: &Problem, solver: &Spec, cross_check: Option<Spec>) -> Result<Outcome, Error> {
        let Way { quantifiers, states, limits } = self;
        let deadline = Deadline::after(Duration::from_secs(60));
        let config =
            Config { cross_check, quantifiers, states, limits, deadline, ..Config::new(solver.clone()) };
        solve(problem, &problem.objectives[0], &config)
    }

    /// What the answer of a solver is worth, if need be confirmed by a second one.
    #[must_use]
    pub fn judged(
        self,
        random: &model::Problem,
        brute: &Brute<'_>,
        typed: &Problem,
        solver: &Spec,
        second: Option<Spec>,
    ) -> Judged {
        match catch_unwind(AssertUnwindSafe(|| self.answer(typed, solver, second))) {
            Ok(Ok(Outcome { verdict: Verdict::Unknown, .. })) => Judged::Unknown,
            Ok(Err(error)) if error.fault() == Fault::Request => Judged::Unsupported,
            Ok(answer) => {
                wrong(answer, random, brute, typed, brute.verdict()).map_or(Judged::Right, Judged::Wrong)
            }
            Err(_) => Judged::Wrong("it panics".to_owned()),
        }
    }
}

/// The verdict of the embedded solver on an objective that must be decided.
///
/// # Panics
/// If that is not supported.
#[must_use]
pub fn verdict(problem: &Problem, objective: &Objective, quantifiers: Quantifiers) -> Verdict {
    let deadline = Deadline::after(Duration::from_secs(60));
    let config = Config { quantifiers, deadline, ..Config::new(Spec::Builtin) };
    solve(problem, objective, &config).expect("it is supported").verdict
}

/// What an answer is worth.
#[derive(Clone, Debug)]
pub enum Judged {
    /// There is none.
    Unknown,
    /// That is not supported.
    Unsupported,
    /// Brute force agrees.
    Right,
    /// It does not, and why.
    Wrong(String),
}

/// What is wrong with an answer, if something is.
#[must_use]
pub fn wrong(
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

/// A trace as brute force knows it.
///
/// # Panics
/// If it is none of the system.
#[must_use]
pub fn path(system: &model::System, objective: &Problem, trace: &hyperplan_problem::Trace) -> Path {
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
