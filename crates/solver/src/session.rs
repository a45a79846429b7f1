//! The common interface of all solvers.

use std::path::PathBuf;

use hyperplan_smt::{Features, Script, Status, Term, Value};
use serde::Deserialize;

use crate::deadline::Deadline;
use crate::error::{Error, Unknown};

/// The answer to a check.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Answer {
    /// Satisfiable: values can be asked for.
    Sat,
    /// Unsatisfiable.
    Unsat,
    /// Neither was found, and why.
    Unknown(Unknown),
}

/// Which solver answered.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Identity {
    /// Its name.
    pub name: String,
    /// Its version; empty if not known.
    pub version: String,
}

/// What a query was like, as the solver got it; ordered by size.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug, Default)]
pub struct QuerySize {
    /// Assertions; of the embedded engine, the clauses that they became.
    pub clauses: usize,
    /// Declared symbols; of the embedded engine, the SAT variables.
    pub variables: usize,
    /// Bytes of SMT-LIB, without what asks for values; 0 of the embedded engine, which gets none.
    pub bytes: usize,
    /// The logic that was set; none of the embedded engine.
    pub logic: Option<String>,
}

/// A dialogue with a solver about one growing script, which may go on in another thread.
pub trait Session: Send {
    /// Feeds what is new in the script since the last call, then asks whether it is satisfiable
    /// under the assumptions, Boolean terms. One session takes one script.
    ///
    /// # Errors
    /// When the solver fails, or cannot do what the script needs. A passed deadline is no error.
    fn check(&mut self, script: &Script, assumptions: &[Term], deadline: &Deadline) -> Result<Answer, Error>;

    /// The same with limited effort, in memory accesses of the embedded engine's search; about 10^8 take a second. Where it is
    /// spent the answer is [`Unknown::Effort`], in every run at the same place, and another check goes on from there. Other
    /// solvers know no such limit.
    ///
    /// # Errors
    /// As of [`Session::check`].
    fn check_within(
        &mut self,
        script: &Script,
        assumptions: &[Term],
        deadline: &Deadline,
        _effort: Option<u64>,
    ) -> Result<Answer, Error> {
        self.check(script, assumptions, deadline)
    }

    /// After [`Answer::Sat`]: the values of declared symbols, in order. A symbol that the solver
    /// was never told of is false or zero.
    ///
    /// # Errors
    /// When the solver fails, or the last answer was not sat.
    fn values(&mut self, script: &Script, symbols: &[Term]) -> Result<Vec<Value>, Error>;

    /// Who answers.
    fn identity(&self) -> Identity;

    /// What it was told up to the last check.
    fn size(&self) -> QuerySize;
}

/// The quantifiers of a script, or those that a solver takes. Each kind includes those before it.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Quantifiers {
    /// No quantifiers.
    None,
    /// Quantifiers that do not stand inside of others: with the symbols, exists-forall.
    ExistsForall,
    /// Any quantifiers.
    Any,
}

/// How to run a solver.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Seed of the solver's random choices, where it has some.
    pub seed: u64,
    /// The script will contain quantifiers.
    pub quantified: bool,
    /// Some of them will stand inside others.
    pub nested: bool,
    /// More than one check will be asked for.
    pub incremental: bool,
    /// What the script may come to need after the first check: the logic is set before that, and has to leave room.
    pub features: Features,
    /// Memory limit of a solver process, in MiB. Of the embedded engine, which shares our memory: how much this
    /// process may grow in physical memory after the session was opened.
    pub memory_mib: Option<u64>,
    /// A directory to keep every query in: one replayable file per solver process, or per check of the
    /// embedded engine.
    pub queries: Option<PathBuf>,
    /// The expected answer, for the `:status` of the kept files.
    pub status: Option<Status>,
}

impl Options {
    /// The quantifiers that the script will have.
    pub(crate) fn quantifiers(&self) -> Quantifiers {
        match (self.quantified, self.nested) {
            (_, true) => Quantifiers::Any,
            (true, false) => Quantifiers::ExistsForall,
            (false, false) => Quantifiers::None,
        }
    }
}
