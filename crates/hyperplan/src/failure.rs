//! How a command fails: with a message and an exit status.

use std::fmt;
use std::process::ExitCode;

/// Exit statuses, as the README lists them; the largest of several counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Exit {
    /// Realizable, or the property holds, or the command did what it was to do.
    Good = 0,
    /// Unrealizable, or the property does not hold.
    Unrealizable = 1,
    /// Bad usage, bad input, or not supported.
    Input = 2,
    /// Undecided.
    Undecided = 3,
    /// A solver failed.
    Solver = 4,
    /// A bug of ours.
    Bug = 5,
}

impl From<Exit> for ExitCode {
    fn from(status: Exit) -> ExitCode {
        ExitCode::from(status as u8)
    }
}

/// Why a command stopped.
#[derive(Debug)]
pub(crate) struct Failure {
    /// The exit status.
    pub(crate) status: Exit,
    /// The message, on one line; empty where everything was said already, as diagnostics.
    pub(crate) message: String,
    /// Lines below it, made harmless, if there is more to say.
    pub(crate) details: String,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        if self.details.is_empty() { Ok(()) } else { write!(f, "\n\n{}", self.details) }
    }
}

impl Failure {
    pub(crate) fn new(status: Exit, message: impl fmt::Display) -> Self {
        Failure { status, message: message.to_string(), details: String::new() }
    }

    /// Bad usage or input.
    pub(crate) fn input(message: impl fmt::Display) -> Self {
        Failure::new(Exit::Input, message)
    }

    /// Bad input, and the messages were printed.
    pub(crate) fn said() -> Self {
        Failure::input("")
    }
}

/// A result of a command or a part of one.
pub(crate) type Result<T = Exit, E = Failure> = std::result::Result<T, E>;
