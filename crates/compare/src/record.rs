//! One finished run, as a line of a comparison's log.

use std::borrow::Cow;
use std::fmt;

use hyperplan_problem::answer::{Case, ReasonCode};
use serde::{Deserialize, Serialize};

use hyperplan_outlet::one_line;

/// What a run ended with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RunStatus {
    /// Satisfiable; of an objective: realizable.
    Sat,
    /// Unsatisfiable; of an objective: unrealizable.
    Unsat,
    /// The solver gave up by itself.
    Unknown,
    /// Out of time, wall or CPU.
    Timeout,
    /// Out of memory.
    Memout,
    /// The solver crashed, was missing, or said nothing that could be understood.
    #[default]
    Error,
    /// The request made no sense for this solver or encoding; not counted against the solver.
    Unsupported,
}

/// An answer that is known to be right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Answer {
    /// Satisfiable, realizable.
    Sat,
    /// Unsatisfiable, unrealizable.
    Unsat,
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.serialize(f)
    }
}

impl fmt::Display for RunStatus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.serialize(f)
    }
}

/// The limits of one run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Wall time, in seconds.
    pub wall_s: Option<f64>,
    /// CPU time of the whole process group, in seconds.
    pub cpu_s: Option<f64>,
    /// Peak memory of the whole process group, in MiB.
    pub memory_mib: Option<u64>,
}

/// One finished run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The file, and for a problem file the objective: `specs/rooms.hp#fastest`.
    pub instance: String,
    /// Where the instance belongs in tables by family: its folder.
    pub family: String,
    /// Of the file's bytes, in hexadecimal.
    pub sha256: String,
    /// The logic of what the solver got, where known.
    pub logic: Option<String>,
    /// How states were to be written; `None` for a query.
    pub states: Option<String>,
    /// How quantifiers were to be decided; `None` for a query.
    pub quantifiers: Option<String>,
    /// The largest horizon of a path.
    pub horizon: Option<u64>,
    /// The constants that were set, `T=12`, in order.
    pub set: Vec<String>,
    /// The solver, as it was asked for.
    pub solver: String,
    /// What the solver says its version is.
    pub version: Option<String>,
    /// Further options of the run, as on a command line.
    pub options: String,
    /// The seed.
    pub seed: u64,
    /// Which of the repetitions, from 0.
    pub repetition: u32,
    /// How it ended.
    pub status: RunStatus,
    /// The right answer, where it is known.
    pub expected: Option<Answer>,
    /// How the witness was checked (`by-search`, `by-solver`); of a query, `model`: it asked for the model, which was evaluated.
    /// `refuted` where it fails.
    pub verified: Option<String>,
    /// Wall time, in seconds.
    pub wall_s: f64,
    /// CPU time, user and system, of the whole process group, in seconds.
    pub cpu_s: f64,
    /// Peak memory of the whole process group, in MiB.
    pub memory_mib: f64,
    /// The limits that it ran under.
    pub limit: Limit,
    /// The exit code; `None` where a signal ended it.
    pub exit_code: Option<i32>,
    /// The signal that ended it.
    pub signal: Option<i32>,
    /// The machine.
    pub host: String,
    /// Symbols of the largest query.
    pub variables: Option<u64>,
    /// Assertions of the largest query.
    pub assertions: Option<u64>,
    /// Bytes of the largest query, where it was written as text.
    pub bytes: Option<u64>,
    /// The last thing that was said, where the run did not end with an answer; what is wrong with a model, or why it was not
    /// checked.
    pub message: Option<String>,
    /// Where its queries are kept, relative to the log.
    pub queries: Option<String>,
    /// Tells this run from all others: a digest of everything that its outcome depends on.
    #[serde(default)]
    pub key: String,
    /// What became of `auto`, or was asked for: how states were written, where the run got so far as to say.
    #[serde(default)]
    pub states_used: Option<String>,
    /// In the same way, how quantifiers were decided.
    #[serde(default)]
    pub quantifiers_used: Option<String>,
    /// Of the wall time, what was spent waiting for the solver's answers, in seconds; `None` for a query.
    #[serde(default)]
    pub solver_s: Option<f64>,
    /// How often the outermost query was asked; `None` for a query.
    #[serde(default)]
    pub rounds: Option<u64>,
    /// Why there is no answer, in a word; `None` for a query.
    #[serde(default)]
    pub reason_code: Option<ReasonCode>,
    /// The model of the machine's processors, where it says.
    #[serde(default)]
    pub processor: Option<String>,
    /// When it ended, in milliseconds since 1970.
    #[serde(default)]
    pub ended_ms: Option<u64>,
    /// The case of the objective that it was about, where it got so far as to say.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub case: Option<Case>,
}

/// What became of a witness, in words, from how a record says that it was checked.
#[must_use]
pub fn checked(verified: &str) -> Cow<'_, str> {
    match verified {
        "refuted" => "refuted".into(),
        "model" => "model checked".into(),
        how => format!("verified {}", one_line(how)).into(),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A run with that key.
    pub(crate) fn record(key: &str) -> Record {
        Record {
            instance: "rooms.hp#sp".to_owned(),
            family: ".".to_owned(),
            sha256: "00".to_owned(),
            logic: None,
            states: Some("auto".to_owned()),
            quantifiers: Some("auto".to_owned()),
            horizon: Some(6),
            set: Vec::new(),
            solver: "z3".to_owned(),
            version: None,
            options: String::new(),
            seed: 0,
            repetition: 0,
            status: RunStatus::Sat,
            expected: None,
            verified: None,
            wall_s: 0.5,
            cpu_s: 0.25,
            memory_mib: 20.5,
            limit: Limit::default(),
            exit_code: Some(0),
            signal: None,
            host: "here".to_owned(),
            variables: None,
            assertions: None,
            bytes: None,
            message: None,
            queries: None,
            key: key.to_owned(),
            states_used: None,
            quantifiers_used: None,
            solver_s: None,
            rounds: None,
            reason_code: None,
            processor: None,
            ended_ms: None,
            case: None,
        }
    }

    #[test]
    fn later_fields_may_be_missing() {
        let mut line = serde_json::to_value(record("")).expect("it is JSON");
        let fields = line.as_object_mut().expect("it is an object");
        for field in [
            "key",
            "states_used",
            "quantifiers_used",
            "solver_s",
            "rounds",
            "reason_code",
            "processor",
            "ended_ms",
        ] {
            assert!(fields.remove(field).is_some());
        }
        assert_eq!(serde_json::from_value::<Record>(line).expect("it is a record"), record(""));
    }
}
