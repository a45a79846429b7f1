//! What is asked for, and what comes out.

use hyperplan_encode::{self as encode, Limits, States};
use hyperplan_problem::{PathId, Strategy};
use hyperplan_solver::{self as solver, Deadline, Identity, Spec, Told};
use std::fmt;
use std::path::PathBuf;
use typed_index_collections::TiVec;

/// How quantifiers are decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantifiers {
    /// hyperplan chooses.
    Auto,
    /// The solver gets them, as in the paper's formula (16).
    Keep,
    /// Universal ones become conjunctions over finitely many cases.
    Expand,
    /// Universal ones by counterexamples.
    Cegis,
}

impl fmt::Display for Quantifiers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Quantifiers::Auto => "auto",
            Quantifiers::Keep => "keep",
            Quantifiers::Expand => "expand",
            Quantifiers::Cegis => "cegis",
        })
    }
}

/// How to solve.
#[derive(Clone, Debug)]
pub struct Config {
    /// The solver.
    pub solver: Spec,
    /// Solvers that search at the same time; the first verified answer counts.
    pub rivals: Vec<Spec>,
    /// The solver that is asked whether what is said to be unsatisfiable is so.
    pub cross_check: Option<Spec>,
    /// How quantifiers are decided.
    pub quantifiers: Quantifiers,
    /// How states are written; without, hyperplan chooses.
    pub states: Option<States>,
    /// When to give up.
    pub deadline: Deadline,
    /// Whether the strategy is verified before it is returned.
    pub verify: bool,
    /// Seed of the solver.
    pub seed: u64,
    /// Memory limit of each solver process, in MiB; for the embedded engine, how much this process may grow.
    pub memory_mib: Option<u64>,
    /// Where every query sent is kept.
    pub queries: Option<PathBuf>,
    /// Budgets of the encoding.
    pub limits: Limits,
}

impl Config {
    /// All choices left to hyperplan, no limits, strategies verified.
    #[must_use]
    pub fn new(solver: Spec) -> Self {
        Config {
            solver,
            rivals: Vec::new(),
            cross_check: None,
            quantifiers: Quantifiers::Auto,
            states: None,
            deadline: Deadline::never(),
            verify: true,
            seed: 0,
            memory_mib: None,
            queries: None,
            limits: Limits::default(),
        }
    }
}

/// The answer to an objective.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// There is a strategy, or the property holds.
    Realizable,
    /// There is none, or it does not.
    Unrealizable,
    /// Undecided.
    Unknown,
}

/// How a witness was checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verified {
    /// By the independent checker, exactly.
    BySearch,
    /// By a second query, where the checker would have to enumerate too much.
    BySolver,
}

/// Wall time of the stages, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seconds {
    /// Enumerating states and building queries.
    pub encode: f64,
    /// Waiting for solvers.
    pub solve: f64,
    /// Checking the strategy.
    pub verify: f64,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The answer.
    pub verdict: Verdict,
    /// Why it is unknown, or what the answer rests on where that is unusual.
    pub reason: Option<String>,
    /// The steps of each path; `None` for one that the objective does not read.
    pub horizons: TiVec<PathId, Option<u32>>,
    /// The paths of the leading block: a strategy, or a counterexample.
    pub witness: Option<Strategy>,
    /// How the witness was checked.
    pub verified: Option<Verified>,
    /// Who answered.
    pub solver: Identity,
    /// How quantifiers were decided.
    pub quantifiers: Quantifiers,
    /// Why they were decided so, where the choice was ours.
    pub because: Option<&'static str>,
    /// How states were written.
    pub states: States,
    /// Rounds: checks of the outermost query.
    pub iterations: u32,
    /// The largest query, as the solver got it.
    pub told: Told,
    /// Where the time went.
    pub seconds: Seconds,
    /// What the user should know besides.
    pub notes: Vec<String>,
}

/// Why there is no answer at all.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The request cannot be met by this version.
    #[error("{0}")]
    Unsupported(String),
    /// The objective cannot be encoded as asked.
    #[error(transparent)]
    Encode(#[from] encode::Error),
    /// A solver failed.
    #[error(transparent)]
    Solver(#[from] solver::Error),
    /// A solver's model does not satisfy what it was asked, or describes no path.
    #[error("solver {solver} gave a wrong model: {what}")]
    WrongModel {
        /// The solver.
        solver: String,
        /// What is wrong with it.
        what: String,
    },
    /// Two solvers contradict each other.
    #[error("solvers {unsat} and {sat} disagree: {unsat} says unsat, {sat} says sat, {what}")]
    Disagreement {
        /// Who says unsat.
        unsat: String,
        /// Who says sat.
        sat: String,
        /// What the model of the latter is worth, and where the query is kept.
        what: String,
    },
    /// All solvers of a race failed.
    #[error("no solver gave an answer: {}", listed(.0))]
    Race(Vec<(String, Error)>),
    /// The time was up before there was anything to show.
    #[error("stopped ({0}) before the query was built")]
    Late(String),
    /// A file could not be read or written.
    #[error("{0}")]
    Io(String),
    /// Our own checker refutes our answer.
    #[error("this is a bug in hyperplan: the strategy found fails verification: {0}; please report it")]
    Bug(String),
}

impl Error {
    /// The exit code of the command: 2 for what is not supported or too large as asked, 3 for what was
    /// interrupted, 4 for a solver's fault, 5 for ours.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Encode(encode::Error::Interrupted) | Error::Late(_) => 3,
            Error::Unsupported(_) | Error::Encode(_) | Error::Io(_) => 2,
            Error::Solver(error) if error.is_unsupported() => 2,
            Error::Solver(_) | Error::WrongModel { .. } | Error::Disagreement { .. } => 4,
            Error::Race(errors) => errors.iter().map(|(_, error)| error.exit_code()).max().unwrap_or(4),
            Error::Bug(_) => 5,
        }
    }
}

fn listed(errors: &[(String, Error)]) -> String {
    let each = errors.iter().map(|(name, error)| format!("{name}: {error}"));
    each.collect::<Vec<_>>().join("; ")
}
