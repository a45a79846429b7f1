//! What a run's output means.

use hyperplan_problem::answer::{self, Case, Failed, ReasonCode, Verdict};
use serde::de::DeserializeOwned;

use crate::heard::Heard;
use crate::query::Query;
use crate::record::{Answer, RunStatus};
use crate::supervise::{Exceeded, Measured};

/// The longest message that is remembered.
const MESSAGE: usize = 500;
/// Words, in small letters, by which solvers say that they do not take such a query; the last two are those of yices.
const REFUSALS: [&str; 4] = ["unsupported", "not supported", "unknown logic", "not an exists/forall problem"];

/// What a run came to.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Reading {
    pub(crate) status: RunStatus,
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
    pub(crate) reason_code: Option<ReasonCode>,
    pub(crate) message: Option<String>,
    pub(crate) case: Option<Case>,
}

impl Reading {
    pub(crate) fn new(status: RunStatus, message: Option<String>) -> Reading {
        Reading { status, message, ..Reading::default() }
    }

    /// With the size of a query.
    pub(crate) fn sized(self, query: &Query) -> Reading {
        Reading {
            logic: query.logic.clone(),
            variables: Some(query.variables),
            assertions: Some(query.assertions),
            bytes: Some(query.bytes),
            ..self
        }
    }
}

/// What `hyperplan solve --format json` came to.
pub(crate) fn of_problem(measured: &Measured, over: bool) -> Reading {
    let said = first_line::<answer::Answer>(measured);
    let failed = first_line::<Failed>(measured);
    let code = said.as_ref().map_or_else(|| Some(failed.as_ref()?.reason_code), |said| said.reason_code);
    let status = limits(measured, over).or_else(|| {
        Some(match (measured.exit_code?, said.as_ref()?.verdict) {
            (0, Verdict::Realizable) => RunStatus::Sat,
            (1, Verdict::Unrealizable) => RunStatus::Unsat,
            (3, Verdict::Unknown) => match code {
                Some(ReasonCode::Timeout) => RunStatus::Timeout,
                Some(ReasonCode::OutOfMemory) => RunStatus::Memout,
                _ => RunStatus::Unknown,
            },
            _ => RunStatus::Error,
        })
    });
    let status = status.unwrap_or(match measured.exit_code {
        Some(2) => RunStatus::Unsupported,
        Some(3) => RunStatus::Unknown,
        _ => RunStatus::Error,
    });
    let errors = last_error(&measured.stderr);
    let reason = said.as_ref().and_then(|said| said.reason.clone());
    let message = match status {
        RunStatus::Sat | RunStatus::Unsat => None,
        RunStatus::Error => errors.or(reason).or_else(|| silent(measured)),
        _ => reason.or(errors),
    };
    let refuted = measured.exit_code == Some(5) || code == Some(ReasonCode::WrongModel);
    let verified = refuted.then(|| "refuted".to_owned());
    let reading = Reading { verified, reason_code: code, ..Reading::new(status, message.map(shortened)) };
    let Some(said) = said else { return reading };
    let some = |text: String| Some(text).filter(|text| !text.is_empty());
    let count = |n: usize| Some(n as u64);
    Reading {
        verified: reading.verified.or_else(|| said.verified.map(|how| how.name().to_owned())),
        version: some(said.solver.version),
        states: some(said.states.to_string()),
        quantifiers: some(said.quantifiers.to_string()),
        horizon: said.horizon.0.iter().filter_map(|(_, steps)| steps.map(u64::from)).max(),
        variables: count(said.size.variables),
        assertions: count(said.size.clauses),
        bytes: said.size.bytes.and_then(count),
        logic: said.logic,
        solver_s: Some(said.seconds.solve),
        rounds: Some(u64::from(said.iterations)),
        case: said.case,
        ..reading
    }
}

/// What the first line of output says that says such a thing.
fn first_line<T: DeserializeOwned>(measured: &Measured) -> Option<T> {
    measured.stdout.lines().find_map(|line| serde_json::from_str(line).ok())
}

/// What a solver said to a query. An error before its answer means that the answer is to something else than was asked;
/// one after it is told where it is about the model. Of several checks only an answer that contradicts what is known
/// counts: one status cannot stand for all of them.
pub(crate) fn of_query(measured: &Measured, query: &Query, heard: &Heard, over: bool) -> Reading {
    let Heard { answers, early, .. } = heard;
    if query.checks.len() > 1 {
        return of_several(answers, query, early.is_some());
    }
    let expected = query.checks.first().copied().flatten();
    let trouble = |status, message: Option<String>| {
        let message = message.or_else(|| last_error(&measured.stderr)).or_else(|| silent(measured));
        Reading { expected, ..Reading::new(status, message.map(shortened)) }
    };
    if let Some(status) = limits(measured, over) {
        return Reading { expected, ..Reading::new(status, None) };
    }
    let all = format!("{}\n{}", early.as_deref().unwrap_or_default(), measured.stderr).to_lowercase();
    let Some(&status) = answers.first().filter(|_| early.is_none()) else {
        let status = match () {
            () if answers.contains(&RunStatus::Timeout) => RunStatus::Timeout,
            () if ["out of memory", "bad_alloc", "memory exhausted"].iter().any(|w| all.contains(w)) => {
                RunStatus::Memout
            }
            () if REFUSALS.iter().any(|words| all.contains(words)) => RunStatus::Unsupported,
            () => RunStatus::Error,
        };
        return trouble(status, early.clone());
    };
    if measured.signal.is_some() {
        return trouble(RunStatus::Error, None);
    }
    if heard.contradicts {
        return trouble(RunStatus::Error, Some("it gave several answers to one check".to_owned()));
    }
    let late = heard.late.as_ref().filter(|_| status == RunStatus::Sat);
    let message =
        late.map(|error| shortened(format!("after its answer the solver reported an error: {error}")));
    Reading { expected, ..Reading::new(status, message) }
}

/// Several checks in one file are not supported, but what contradicts a known status is told of.
fn of_several(answers: &[RunStatus], query: &Query, failed: bool) -> Reading {
    let checks = query.checks.len();
    let mut pairs = answers.iter().copied().zip(query.checks.iter().copied()).zip(1..);
    let wrong = pairs.find(|((said, known), _)| known.is_some_and(|known| contradicts(*said, known)));
    match wrong.filter(|_| !failed) {
        Some(((status, expected), check)) => {
            Reading { expected, ..Reading::new(status, Some(format!("check {check} of {checks}"))) }
        }
        None => Reading::new(
            RunStatus::Unsupported,
            Some(format!("{checks} checks in one file; only answers against a known status count")),
        ),
    }
}

fn contradicts(said: RunStatus, known: Answer) -> bool {
    matches!((said, known), (RunStatus::Sat, Answer::Unsat) | (RunStatus::Unsat, Answer::Sat))
}

/// Whether a limit decided; what was said after the time was over does not count.
fn limits(measured: &Measured, over: bool) -> Option<RunStatus> {
    match measured.exceeded {
        Some(Exceeded::Time) => Some(RunStatus::Timeout),
        Some(Exceeded::Memory) => Some(RunStatus::Memout),
        // Failures stay failures, whenever they come.
        None if over && !matches!(measured.exit_code, Some(4..) | None) => Some(RunStatus::Timeout),
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
