//! What a run's output means.

use serde::Deserialize;
use std::collections::BTreeMap;

use crate::query::Query;
use crate::record::{Answer, Status};
use crate::supervise::{Exceeded, Measured};

/// The longest message that is remembered.
const MESSAGE: usize = 500;

/// What a run came to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) status: Status,
    pub(crate) expected: Option<Answer>,
    pub(crate) verified: Option<String>,
    pub(crate) version: Option<String>,
    pub(crate) states: Option<String>,
    pub(crate) quantifiers: Option<String>,
    pub(crate) horizon: Option<u64>,
    pub(crate) variables: Option<u64>,
    pub(crate) assertions: Option<u64>,
    pub(crate) bytes: Option<u64>,
    pub(crate) logic: Option<String>,
    pub(crate) solver_s: Option<f64>,
    pub(crate) rounds: Option<u64>,
    pub(crate) message: Option<String>,
}

impl Outcome {
    pub(crate) fn new(status: Status, message: Option<String>) -> Outcome {
        Outcome {
            status,
            expected: None,
            verified: None,
            version: None,
            states: None,
            quantifiers: None,
            horizon: None,
            variables: None,
            assertions: None,
            bytes: None,
            logic: None,
            solver_s: None,
            rounds: None,
            message,
        }
    }
}

impl Outcome {
    /// With the size of a query.
    pub(crate) fn sized(self, query: &Query) -> Outcome {
        Outcome {
            logic: query.logic.clone(),
            variables: Some(query.variables),
            assertions: Some(query.assertions),
            bytes: Some(query.bytes),
            ..self
        }
    }
}

/// The part of `solve --format json` that is of interest.
#[derive(Deserialize)]
struct Said {
    verdict: Verdict,
    reason: Option<String>,
    horizon: BTreeMap<String, Option<u64>>,
    verified: Option<String>,
    solver: Solver,
    quantifiers: String,
    states: String,
    logic: Option<String>,
    iterations: u64,
    size: Size,
    seconds: Seconds,
}

#[derive(Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Verdict {
    Realizable,
    Unrealizable,
    Unknown,
}

#[derive(Deserialize)]
struct Solver {
    version: String,
}

#[derive(Deserialize)]
struct Size {
    variables: u64,
    clauses: u64,
    bytes: Option<u64>,
}

#[derive(Deserialize)]
struct Seconds {
    solve: f64,
}

/// What `hyperplan solve --format json` came to.
pub(crate) fn of_problem(measured: &Measured, over: bool) -> Outcome {
    let said = measured.stdout.lines().find_map(|line| serde_json::from_str::<Said>(line).ok());
    let status = limits(measured, over).or_else(|| {
        Some(match (measured.exit_code?, said.as_ref()?.verdict) {
            (0, Verdict::Realizable) => Status::Sat,
            (1, Verdict::Unrealizable) => Status::Unsat,
            (3, Verdict::Unknown) => match said.as_ref()?.reason.as_deref() {
                Some("timeout") => Status::Timeout,
                Some("out of memory") => Status::Memout,
                _ => Status::Unknown,
            },
            _ => Status::Error,
        })
    });
    let status = status.unwrap_or(match measured.exit_code {
        Some(2) => Status::Unsupported,
        Some(3) => Status::Unknown,
        _ => Status::Error,
    });
    let errors = last_error(&measured.stderr);
    let reason = said.as_ref().and_then(|said| said.reason.clone());
    let message = match status {
        Status::Sat | Status::Unsat => None,
        Status::Error => errors.or(reason).or_else(|| silent(measured)),
        _ => reason.or(errors),
    };
    let refuted = match measured.exit_code {
        Some(5) => true,
        Some(4) => message.as_deref().is_some_and(|message| message.contains("wrong model")),
        _ => false,
    };
    let mut outcome = Outcome::new(status, message.map(shortened));
    if refuted {
        outcome.verified = Some("refuted".to_owned());
    }
    let Some(said) = said else { return outcome };
    let some = |text: String| Some(text).filter(|text| !text.is_empty());
    Outcome {
        verified: outcome.verified.take().or(said.verified),
        version: some(said.solver.version),
        states: some(said.states),
        quantifiers: some(said.quantifiers),
        horizon: said.horizon.into_values().flatten().max(),
        variables: Some(said.size.variables),
        assertions: Some(said.size.clauses),
        bytes: said.size.bytes,
        logic: said.logic,
        solver_s: Some(said.seconds.solve),
        rounds: Some(said.iterations),
        ..outcome
    }
}

/// What a solver said to a query. What it complains of after its answer, such as a model that it cannot give, does not
/// count; before it, the answer is to something else than was asked. Of several checks only an answer that contradicts
/// what is known counts: one status cannot stand for all of them.
pub(crate) fn of_query(measured: &Measured, query: &Query, over: bool) -> Outcome {
    let answers: Vec<Status> = measured.stdout.lines().filter_map(answer).collect();
    let error = early_error(&measured.stdout, query.checks.len());
    if query.checks.len() > 1 {
        return of_several(&answers, query, error.is_some());
    }
    let expected = query.checks.first().copied().flatten();
    let trouble = |status, message: Option<String>| {
        let message = message.or_else(|| last_error(&measured.stderr)).or_else(|| silent(measured));
        Outcome { expected, ..Outcome::new(status, message.map(shortened)) }
    };
    if let Some(status) = limits(measured, over) {
        return Outcome { expected, ..Outcome::new(status, None) };
    }
    let all = format!("{}\n{}", error.unwrap_or_default(), measured.stderr).to_lowercase();
    let said = answers.first().copied().filter(|_| !query.checks.is_empty() && error.is_none());
    let Some(status) = said else {
        let status = match () {
            () if answers.contains(&Status::Timeout) => Status::Timeout,
            () if ["out of memory", "bad_alloc", "memory exhausted"].iter().any(|w| all.contains(w)) => {
                Status::Memout
            }
            () if ["unsupported", "not supported"].iter().any(|w| all.contains(w)) => Status::Unsupported,
            () => Status::Error,
        };
        return trouble(status, error.map(str::to_owned));
    };
    if measured.signal.is_some() {
        return trouble(Status::Error, None);
    }
    if answers.iter().any(|answer| *answer != status) {
        return trouble(Status::Error, Some("it gave several answers to one check".to_owned()));
    }
    Outcome { expected, ..Outcome::new(status, None) }
}

/// The first error before as many answers as there are checks.
fn early_error(stdout: &str, checks: usize) -> Option<&str> {
    let mut answers = 0;
    let before = stdout.lines().take_while(|line| {
        let early = answers < checks.max(1);
        answers += usize::from(answer(line).is_some());
        early
    });
    before.map(str::trim).find(|line| line.starts_with("(error"))
}

/// Several checks in one file are not supported, but what contradicts a known status is told of.
fn of_several(answers: &[Status], query: &Query, failed: bool) -> Outcome {
    let checks = query.checks.len();
    let mut pairs = answers.iter().copied().zip(query.checks.iter().copied()).zip(1..);
    let wrong = pairs.find(|((said, known), _)| known.is_some_and(|known| contradicts(*said, known)));
    match wrong.filter(|_| !failed) {
        Some(((status, expected), check)) => {
            Outcome { expected, ..Outcome::new(status, Some(format!("check {check} of {checks}"))) }
        }
        None => Outcome::new(
            Status::Unsupported,
            Some(format!("{checks} checks in one file; only answers against a known status count")),
        ),
    }
}

fn contradicts(said: Status, known: Answer) -> bool {
    matches!((said, known), (Status::Sat, Answer::Unsat) | (Status::Unsat, Answer::Sat))
}

/// The answer that a line is.
fn answer(line: &str) -> Option<Status> {
    match line.trim() {
        "sat" => Some(Status::Sat),
        "unsat" => Some(Status::Unsat),
        "unknown" => Some(Status::Unknown),
        "timeout" => Some(Status::Timeout),
        _ => None,
    }
}

/// Whether a limit decided; what was said after the time was over does not count.
fn limits(measured: &Measured, over: bool) -> Option<Status> {
    match measured.exceeded {
        Some(Exceeded::Time) => Some(Status::Timeout),
        Some(Exceeded::Memory) => Some(Status::Memout),
        // Failures stay failures, whenever they come.
        None if over && !matches!(measured.exit_code, Some(4..) | None) => Some(Status::Timeout),
        None => None,
    }
}

/// The last error on standard error, or else the last line.
fn last_error(stderr: &str) -> Option<String> {
    let lines = || stderr.lines().map(str::trim).filter(|line| !line.is_empty()).rev();
    let error = lines().find_map(|line| line.strip_prefix("error: "));
    error.or_else(|| lines().next()).map(str::to_owned)
}

/// How a program ended that said nothing.
fn silent(measured: &Measured) -> Option<String> {
    Some(match (measured.signal, measured.exit_code) {
        (Some(signal), _) => format!("ended by signal {signal}"),
        (None, Some(code)) => format!("no answer, exit status {code}"),
        (None, None) => "no answer".to_owned(),
    })
}

fn shortened(message: String) -> String {
    match message.char_indices().nth(MESSAGE) {
        Some((end, _)) => format!("{}...", &message[..end]),
        None => message,
    }
}

#[cfg(test)]
mod tests;
