//! What can go wrong between us and a solver.

use std::io;
use std::path::PathBuf;

/// Why a solver does not know an answer.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unknown {
    /// The time is up.
    #[error("timeout")]
    Timeout,
    /// The time is up, and the solver answers only once it gets no more input.
    #[error("timeout: the solver answers only at the end of its input")]
    WaitsForEnd,
    /// The effort that it was allowed is spent.
    #[error("the effort allowed is spent")]
    Effort,
    /// The search was cancelled.
    #[error("interrupted")]
    Interrupted,
    /// The system gave the solver no more memory.
    #[error("out of memory")]
    Memory,
    /// The search has taken the memory that it was allowed.
    #[error("memory limit of {mib} MiB reached")]
    MemoryLimit {
        /// In MiB.
        mib: u64,
    },
    /// The solver's methods do not decide the query, in its words.
    #[error("{0}")]
    Incomplete(String),
    /// The solver's own reason.
    #[error("{0}")]
    Said(String),
    /// The solver does not say why.
    #[error("unknown")]
    Unsaid,
}

impl From<String> for Unknown {
    /// What a solver's words mean.
    fn from(words: String) -> Self {
        match words.as_str() {
            "timeout" => Unknown::Timeout,
            "interrupted" => Unknown::Interrupted,
            "out of memory" => Unknown::Memory,
            "unknown" => Unknown::Unsaid,
            _ if words.contains("incomplete") => Unknown::Incomplete(words),
            _ => Unknown::Said(words),
        }
    }
}

/// A failure of a solver, or of reaching it.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The solver is not installed.
    #[error("solver {name} was not found (tried {}); {hint}", tried.join(", "))]
    Missing {
        /// What was asked for.
        name: String,
        /// Where it was sought.
        tried: Vec<String>,
        /// How to install it.
        hint: String,
    },
    /// The request is beyond the solver or this version.
    #[error("{what}")]
    Unsupported {
        /// What is not supported, and what would do instead.
        what: String,
    },
    /// The solver ended without an answer.
    #[error("solver {name} ended without an answer ({status}){}", said_after(last_words))]
    Crashed {
        /// The solver.
        name: String,
        /// Its exit status.
        status: String,
        /// The last thing that it said, on either stream.
        last_words: String,
    },
    /// The solver reported an error.
    #[error("solver {name} reported an error: {message}")]
    Reported {
        /// The solver.
        name: String,
        /// Its words.
        message: String,
    },
    /// The solver's reply is not what the dialogue calls for.
    #[error("solver {name} gave no proper reply to {asked}{}", said_after(said))]
    Protocol {
        /// The solver.
        name: String,
        /// The command that it replied to.
        asked: String,
        /// What it said.
        said: String,
    },
    /// The solver answered a check that it was not asked.
    #[error("solver {name} answered before it was asked{}", said_after(said))]
    Early {
        /// The solver.
        name: String,
        /// What it said.
        said: String,
    },
    /// The deadline passed while values were read.
    #[error("solver {name} gave no values before the deadline")]
    Deadline {
        /// The solver.
        name: String,
    },
    /// The solver had not enough memory.
    #[error("solver {name} ran out of memory")]
    Memory {
        /// The solver.
        name: String,
    },
    /// A value is a number that has no room here: no fault of the solver.
    #[error("solver {name} has a model with numbers that are too large")]
    LargeNumber {
        /// The solver.
        name: String,
    },
    /// The deadline passed while a query was written.
    #[error("time was up before the query was written")]
    Interrupted,
    /// Values were asked for where the last answer was not sat.
    #[error("solver {name} has no model: its last answer was not sat")]
    NoModel {
        /// The solver.
        name: String,
    },
    /// The embedded SAT solver failed.
    #[error("solver {name} failed: {message}")]
    Engine {
        /// The solver.
        name: String,
        /// Its words.
        message: String,
    },
    /// What was asked and said cannot be kept.
    #[error("cannot keep queries in {}: {source}", folder.display())]
    Keep {
        /// Where it was to be.
        folder: PathBuf,
        /// Why it cannot.
        source: io::Error,
    },
    /// Talking to the operating system failed.
    #[error("{what}: {source}")]
    Io {
        /// What was tried.
        what: String,
        /// Why it failed.
        source: io::Error,
    },
}

impl Error {
    /// Whether the request was at fault rather than the solver.
    #[must_use]
    pub fn is_unsupported(&self) -> bool {
        matches!(self, Error::Unsupported { .. })
    }
}

fn said_after(words: &str) -> String {
    let words = words.trim();
    if words.is_empty() { String::new() } else { format!("; it said: {words}") }
}
