//! What a check may say, and what it may cost.

use hyperplan_problem::{Objective, PathId, Trace};
use std::fmt;

/// How much a check may explore before it gives up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// States explored, of each system, and joint states of each block of path variables.
    pub states: u64,
    /// Pairs of joint state and value kept, over all steps and levels. Large sets of the first block are kept at a
    /// bit for each joint state: there 32 bits count as one, so that one is 4 bytes there and 8 deeper.
    pub entries: u64,
    /// Joint moves tried, over all steps and levels. Those that a step of the first block shares with the step two
    /// before are not tried again. One of a deeper block costs more, and counts as eight.
    pub moves: u64,
}

impl Default for Budget {
    /// On maps of some 200,000 cells a state takes about 500 bytes, a move that looks like an earlier one 10 to 30 ns;
    /// so this bounds a check to well under a gigabyte and about 15 s.
    fn default() -> Self {
        Budget { states: 1_000_000, entries: 30_000_000, moves: 500_000_000 }
    }
}

/// How far a check got; in the units of [`Budget`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reached {
    /// States explored, of the system or block with the most.
    pub states: u64,
    /// Pairs kept.
    pub entries: u64,
    /// Joint moves tried.
    pub moves: u64,
}

/// The outcome of a check.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Check {
    /// The strategy does what it is claimed to do.
    Holds,
    /// It does not.
    Fails(Defeat),
    /// It could not be told within the budget.
    TooLarge {
        /// What was allowed.
        budget: Budget,
        /// What was used.
        reached: Reached,
    },
}

/// Why a strategy fails.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Defeat {
    /// The trace does not begin in an initial state.
    NotInitial {
        /// The trace.
        path: PathId,
    },
    /// There is no such transition from `states[step]`.
    NoTransition {
        /// The trace.
        path: PathId,
        /// Which of its steps, from 0.
        step: usize,
    },
    /// The last state is not live: the trace is not the beginning of an infinite path.
    DeadEnd {
        /// The trace.
        path: PathId,
    },
    /// Paths of the next block after which the claim is false whatever the remaining blocks do, one trace for each
    /// path variable of that block.
    Paths(Vec<Trace>),
    /// The formula, which reads the traces only, has the wrong value.
    Formula,
}

impl Defeat {
    /// The reason in words, with the objective's own names.
    #[must_use]
    pub fn describe(&self, objective: &Objective) -> String {
        Described { defeat: self, objective }.to_string()
    }
}

struct Described<'a> {
    defeat: &'a Defeat,
    objective: &'a Objective,
}

impl fmt::Display for Described<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |path: &PathId| self.objective.paths.get(*path).map_or("?", |p| p.name.as_str());
        match self.defeat {
            Defeat::NotInitial { path } => {
                write!(f, "path {} does not start in an initial state", name(path))
            }
            Defeat::NoTransition { path, step } => {
                write!(f, "path {} has no such transition at step {step}", name(path))
            }
            Defeat::DeadEnd { path } => {
                write!(f, "path {} ends in a state that cannot go on for ever", name(path))
            }
            Defeat::Paths(traces) => {
                let names: Vec<&str> = traces.iter().map(|t| name(&t.path)).collect();
                write!(f, "defeated by a choice of {}", names.join(", "))
            }
            Defeat::Formula => write!(f, "the formula does not have the claimed value on these paths"),
        }
    }
}

/// Why nothing could be checked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// Not one trace for each path variable of the leading block, in order.
    #[error("the strategy must have one path for each of {expected}, in this order")]
    WrongPaths {
        /// The names of the leading block.
        expected: String,
    },
    /// States and actions do not fit together.
    #[error(
        "path {path} has {states} states and {actions} actions; it must have one more state than actions"
    )]
    Lengths {
        /// The path variable.
        path: String,
        /// Number of states.
        states: usize,
        /// Number of actions.
        actions: usize,
    },
    /// A state without exactly one value of the right type for each variable.
    #[error("state {step} of path {path} is not a state of its system")]
    NotAState {
        /// The path variable.
        path: String,
        /// Its position.
        step: usize,
    },
    /// An action that the path's system does not have.
    #[error("action {step} of path {path} is not an action of its system")]
    NotAnAction {
        /// The path variable.
        path: String,
        /// Its position.
        step: usize,
    },
    /// Under `within K`, not K steps; otherwise, fewer than the objective reads.
    #[error("path {path} has {steps} steps, but the objective needs {needed}")]
    WrongLength {
        /// The path variable.
        path: String,
        /// Steps that it has.
        steps: u64,
        /// Steps that it needs.
        needed: u64,
    },
    /// A number on the way does not fit into 64 bits.
    #[error("a number of system {system} does not fit into 64 bits; it cannot be checked")]
    Overflow {
        /// The system.
        system: String,
    },
    /// The problem breaks its own contract; no lowered problem does.
    #[error("the problem is not well-formed: {what}")]
    Malformed {
        /// What is wrong.
        what: &'static str,
    },
}

/// Why a search stopped early.
#[derive(Debug)]
pub(crate) enum Stop {
    /// The budget is used up.
    Budget,
    /// It cannot go on at all.
    Error(Error),
}

impl From<Error> for Stop {
    fn from(error: Error) -> Self {
        Stop::Error(error)
    }
}
