//! Why something cannot be done, as data with codes that stay what they are.

use crate::others::Undrawn;
use hyperplan_plan as plan;
use hyperplan_problem::answer::WitnessError;
use hyperplan_problem::answer::plans::PlanError;
use hyperplan_solver::{self as solver, ConfigError};
use hyperplan_syntax::{JsonDiagnostic, SourceMap, render, to_json};
use hyperplan_verify as verify;
use std::fmt;
use std::path::PathBuf;

/// Width of rendered messages.
const WIDTH: usize = 100;

/// How many errors are shown as text.
const SHOWN: usize = 100;

/// What is wrong with a problem's text, or doubtful: with places, and advice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Faults {
    list: Vec<JsonDiagnostic>,
    rendered: String,
}

impl Faults {
    pub(crate) fn new(
        sources: &SourceMap,
        file: &str,
        diagnostics: &[hyperplan_syntax::Diagnostic],
    ) -> Faults {
        let list = diagnostics.iter().map(|diagnostic| to_json(sources, file, diagnostic)).collect();
        let shown = &diagnostics[..diagnostics.len().min(SHOWN)];
        Faults { list, rendered: render(sources, shown, false, WIDTH).trim_end().to_owned() }
    }

    /// Each with its code, its place and what helps.
    #[must_use]
    pub fn list(&self) -> &[JsonDiagnostic] {
        &self.list
    }
}

impl fmt::Display for Faults {
    /// With the lines shown and marked.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.rendered)
    }
}

/// Why something cannot be done. That an objective is undecided is no error.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file cannot be read.
    #[error("cannot read {}: {why}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// In words.
        why: String,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {why}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// In words.
        why: String,
    },
    /// The problem has errors.
    #[error("{0}")]
    Faulty(Faults),
    /// There is no such objective, or none was named and there are several.
    #[error("{}", no_objective(name.as_deref(), known))]
    NoObjective {
        /// What was asked for, if a name was.
        name: Option<String>,
        /// Those that there are.
        known: Vec<String>,
    },
    /// A constant cannot be varied as asked.
    #[error("constant {name}: {why}")]
    Constant {
        /// Its name.
        name: String,
        /// What is wrong.
        why: &'static str,
    },
    /// What stands for a system in code is none.
    #[error("system {system}: {why}")]
    Built {
        /// Its name.
        system: String,
        /// What is wrong, in words.
        why: String,
    },
    /// No solver is meant.
    #[error(transparent)]
    Solver(#[from] solver::Error),
    /// A description of solvers is none.
    #[error(transparent)]
    Profile(#[from] ConfigError),
    /// The search failed.
    #[error(transparent)]
    Search(#[from] plan::Error),
    /// The search failed with a value of a constant.
    #[error("with {name} = {value}: {error}")]
    SearchWith {
        /// The constant.
        name: String,
        /// Its value.
        value: i64,
        /// Why.
        error: plan::Error,
    },
    /// Paths are no strategy for the objective.
    #[error("this is no strategy: {0}")]
    NoStrategy(#[from] WitnessError),
    /// Actions alone do not say which paths are meant.
    #[error("this is no strategy: {0}")]
    Incomplete(String),
    /// A text is no strategy.
    #[error("this is no strategy: {0}")]
    NotRead(String),
    /// The checker's numbers are not enough.
    #[error(transparent)]
    Checker(#[from] verify::Error),
    /// Something cannot be drawn.
    #[error(transparent)]
    Drawing(#[from] Undrawn),
    /// Plans cannot be written in a format.
    #[error("the strategy cannot be written so: {0}")]
    Format(#[from] PlanError),
}

impl Error {
    /// The error in a word that stays what it is. Of problems with errors it is the first one's; `faults` has all.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Error::Read { .. } => "cannot-read",
            Error::Write { .. } => "cannot-write",
            Error::Faulty(faults) => faults.list.first().map_or("faulty", |fault| fault.code),
            Error::NoObjective { .. } => "no-objective",
            Error::Constant { .. } => "bad-constant",
            Error::Built { .. } => "bad-system",
            Error::Solver(_) => "no-solver",
            Error::Profile(_) => "bad-profile",
            Error::Search(error) | Error::SearchWith { error, .. } => error.code().name(),
            Error::NoStrategy(_) | Error::Incomplete(_) | Error::NotRead(_) => "no-strategy",
            Error::Checker(_) => "large-numbers",
            Error::Drawing(_) => "cannot-draw",
            Error::Format(_) => "cannot-write-so",
        }
    }

    /// What is wrong with the problem's text, where that is the error.
    #[must_use]
    pub fn faults(&self) -> &[JsonDiagnostic] {
        if let Error::Faulty(faults) = self { faults.list() } else { &[] }
    }
}

fn no_objective(name: Option<&str>, known: &[String]) -> String {
    match (name, known) {
        (_, []) => "the problem has no objective".to_owned(),
        (Some(name), known) => format!("there is no objective `{name}`; there is {}", known.join(", ")),
        (None, known) => format!("there are several objectives; name one of {}", known.join(", ")),
    }
}
