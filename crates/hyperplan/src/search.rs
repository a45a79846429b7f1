//! One objective, decided as all doors decide it, and what is told of that.

use hyperplan_plan::explain::Choice;
use hyperplan_plan::{self as plan, Config, Outcome};
use hyperplan_problem::answer::{
    Answer, Choices, Closest, CostValue, Ordered, Replaced, Seconds, Size, Solver, Start, to_witness,
    write_state,
};
use hyperplan_problem::{Objective, PathId, Problem, Target, display};
use std::time::Duration;

/// What was found for an objective.
#[derive(Debug)]
pub struct Decided {
    /// The answer.
    pub outcome: Outcome,
    /// What was to be as small as possible.
    pub costs: Vec<CostValue>,
    /// Why the costs are perhaps not the least.
    pub undecided: Option<plan::Reason>,
}

/// Decides an objective; where there are targets, with the strategy that costs least. Otherwise one without detours, unless
/// the `first` is wanted.
///
/// # Errors
/// Those of [`plan::solve()`].
pub fn decide(
    problem: &Problem,
    objective: &Objective,
    targets: &[Target],
    config: &Config,
    first: bool,
) -> Result<Decided, plan::Error> {
    if targets.is_empty() {
        let outcome = plan::solve(problem, objective, config)?;
        let outcome = if first { outcome } else { straight(problem, objective, outcome, config) };
        return Ok(Decided { outcome, costs: Vec::new(), undecided: None });
    }
    let plan::Cheapest { outcome, values, undecided } = plan::cheapest(problem, objective, targets, config)?;
    let costs = cost_values((problem, objective), targets, &values);
    Ok(Decided { outcome, costs, undecided })
}

/// What targets come to.
#[must_use]
pub fn cost_values(
    (problem, objective): (&Problem, &Objective),
    targets: &[Target],
    values: &[plan::Value],
) -> Vec<CostValue> {
    let value = |(target, value): (&Target, &plan::Value)| CostValue {
        expression: display::target(problem, objective, target),
        value: value.found,
        least: value.least,
    };
    targets.iter().zip(values).map(value).collect()
}

/// The answer with a strategy without detours, if one is found in little time.
pub fn straight(problem: &Problem, objective: &Objective, outcome: Outcome, config: &Config) -> Outcome {
    let deadline = config.deadline.within(plan::time_for(problem, objective, &outcome));
    plan::straightened(problem, objective, outcome, config, &deadline).outcome
}

/// An outcome as JSON has it. Why it is what it is is told in plain words; who knows how to help may replace them.
#[must_use]
pub fn answer(
    file: &str,
    (problem, objective): (&Problem, &Objective),
    outcome: &Outcome,
    (read, total): (Duration, Duration),
) -> Answer {
    let names = objective.paths.iter().map(|p| p.name.clone());
    let reason = outcome.reason.as_ref();
    Answer {
        file: file.to_owned(),
        objective: objective.name.clone(),
        verdict: outcome.verdict,
        reason: reason.map(ToString::to_string),
        reason_code: reason.map(plan::Reason::code),
        horizon: Ordered(names.zip(outcome.horizons.iter().copied()).collect()),
        witness: outcome.witness.as_ref().map(|s| to_witness(problem, objective, s)),
        verified: outcome.verified,
        solver: Solver { name: outcome.solver.name.clone(), version: outcome.solver.version.clone() },
        quantifiers: outcome.quantifiers,
        states: outcome.states,
        logic: outcome.size.logic.clone(),
        iterations: outcome.iterations,
        size: Size {
            variables: outcome.size.variables,
            clauses: outcome.size.clauses,
            bytes: Some(outcome.size.bytes).filter(|bytes| *bytes > 0),
        },
        seconds: Seconds {
            read: rounded(read.as_secs_f64()),
            encode: rounded(outcome.seconds.encode),
            solve: rounded(outcome.seconds.solve),
            verify: rounded(outcome.seconds.verify),
            total: rounded(total.as_secs_f64()),
        },
        minimized: None,
        costs: Vec::new(),
        several: None,
        certificates: Vec::new(),
        case: None,
        closest: outcome.closest.as_ref().map(|closest| Closest {
            witness: to_witness(problem, objective, &closest.strategy),
            spared: choices(problem, objective, &closest.spared),
        }),
    }
}

/// Choices of the other player as JSON has them.
#[must_use]
pub fn choices(problem: &Problem, objective: &Objective, choices: &[Choice]) -> Choices {
    let name = |path: PathId| objective.paths[path].name.clone();
    let mut listed = Choices::default();
    for choice in choices {
        match choice {
            Choice::Start(path, state) => {
                let system = &problem.systems[objective.paths[*path].system];
                listed.starts.push(Start { path: name(*path), state: write_state(system, state) });
            }
            Choice::Replaced(path, from, time) => {
                listed.replaced.push(Replaced { path: name(*path), from: name(*from), time: *time });
            }
        }
    }
    listed
}

/// To microseconds: what a clock can tell.
fn rounded(seconds: f64) -> f64 {
    (seconds * 1e6).round() / 1e6
}
