//! What is asked for, and what comes out.

use crate::choice::Closest;
use crate::fact::{Because, Note, Reason};
use crate::watch::Watch;
use hyperplan_encode::{Among, Graphs, Limits};
pub use hyperplan_problem::answer::{Quantifiers, States, Verdict, Verified};
use hyperplan_problem::{PathId, Strategy};
use hyperplan_solver::{Deadline, Identity, QuerySize, Spec};
use std::path::PathBuf;
use typed_index_collections::TiVec;

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
    /// The choices of the leading block that are looked at.
    pub among: Among,
    /// Where it is told how far the search is.
    pub watch: Watch,
    /// Systems that were enumerated; who asks several questions about the same ones shares it.
    pub graphs: Graphs,
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
            among: Among::default(),
            watch: Watch::default(),
            graphs: Graphs::default(),
        }
    }
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
    pub reason: Option<Reason>,
    /// The steps of each path; `None` for one that the objective does not read.
    pub horizons: TiVec<PathId, Option<u32>>,
    /// The paths of the leading block: a strategy, or a counterexample.
    pub witness: Option<Strategy>,
    /// How the witness was checked.
    pub verified: Option<Verified>,
    /// Where it is not known whether there is a strategy: a candidate that fails against few choices of the other player only.
    pub closest: Option<Closest>,
    /// Who answered.
    pub solver: Identity,
    /// How quantifiers were decided.
    pub quantifiers: Quantifiers,
    /// Why they were decided so, where the choice was ours.
    pub because: Option<Because>,
    /// How states were written.
    pub states: States,
    /// Rounds: checks of the outermost query.
    pub iterations: u32,
    /// The largest query, as the solver got it.
    pub size: QuerySize,
    /// Where the time went.
    pub seconds: Seconds,
    /// What the user should know besides.
    pub notes: Vec<Note>,
}
