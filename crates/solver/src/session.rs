//! The common interface of all solvers.

use std::path::PathBuf;
use std::str::FromStr;
use std::sync::Arc;

use hyperplan_smt::{Script, Status, Term, Value};
use serde::Deserialize;

use crate::deadline::Deadline;
use crate::embedded::{BUILTIN, Engine, backend, names};
use crate::error::{Error, Unknown};
use crate::external::{self, Profile};

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

/// Which solver to use.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Spec {
    /// The embedded engine with the best of its SAT solvers.
    Builtin,
    /// The embedded engine with the SAT solver of that name: `cadical`, `batsat`.
    Backend(&'static str),
    /// A solver that hyperplan knows: `z3`, `cvc5`, `yices`, `bitwuzla`.
    Profile(String),
    /// A solver that a configuration file describes.
    Configured(Arc<Profile>),
    /// A command line that reads SMT-LIB 2 from standard input. Words are split at blanks; quotes
    /// keep blanks together.
    Command(String),
}

impl Spec {
    /// A solver for integers and reals that is found on this machine, the first that hyperplan knows.
    #[must_use]
    pub fn for_arithmetic() -> Option<Spec> {
        external::for_arithmetic().map(|name| Spec::Profile(name.to_owned()))
    }

    /// The embedded engine with each SAT solver of this build.
    #[must_use]
    pub fn backends() -> Vec<Spec> {
        let specs = names().filter_map(|name| Spec::embedded(name)?.ok());
        specs.filter(|spec| *spec != Spec::Builtin).collect()
    }

    /// Whether it is the embedded engine.
    #[must_use]
    pub fn is_embedded(&self) -> bool {
        matches!(self, Spec::Builtin | Spec::Backend(_))
    }

    /// The embedded engine as it is called, if the name is one of its names.
    ///
    /// # Errors
    /// Where this build has not got it.
    pub fn embedded(name: &str) -> Option<Result<Spec, Error>> {
        let known = names().find(|known| *known == name)?;
        let spec = if known == BUILTIN { Spec::Builtin } else { Spec::Backend(known) };
        Some(backend(known)?.map(|_| spec))
    }

    /// What the solver is called before it was asked.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Spec::Builtin => BUILTIN,
            Spec::Backend(name) => name,
            Spec::Profile(name) => name,
            Spec::Configured(profile) => profile.name(),
            Spec::Command(line) => line,
        }
    }
}

impl FromStr for Spec {
    type Err = Error;

    fn from_str(text: &str) -> Result<Spec, Error> {
        let text = text.trim();
        if text.is_empty() {
            return Err(Error::Unsupported { what: "the solver's name is empty".to_owned() });
        }
        if let Some(embedded) = Spec::embedded(text) {
            return embedded;
        }
        if let Some(profile) = external::profile(text) {
            return Ok(Spec::Profile(profile.name.clone()));
        }
        if external::split_list(text).len() > 1 {
            let what = format!("one solver is wanted here, not a list ({text})");
            return Err(Error::Unsupported { what });
        }
        Ok(Spec::Command(text.to_owned()))
    }
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

    /// Refuses quantifiers beyond those that the solver takes, and names solvers that take them.
    pub(crate) fn demand_at_most(&self, taken: Quantifiers, solver: &str) -> Result<(), Error> {
        if self.quantifiers() <= taken {
            return Ok(());
        }
        let beyond = match taken {
            Quantifiers::None => "quantifiers",
            _ => "quantifiers inside quantifiers",
        };
        let others = external::that_take(self.quantifiers()).join(", ");
        Err(Error::Unsupported {
            what: format!("the {solver} solver cannot handle {beyond}: use one of {others}"),
        })
    }
}

/// Starts a session. The solver must be installed.
///
/// # Errors
/// When the solver is missing, or cannot do what the options say.
pub fn open(spec: &Spec, options: &Options) -> Result<Box<dyn Session>, Error> {
    match spec {
        Spec::Builtin | Spec::Backend(_) => {
            let name = spec.name();
            let backend = backend(name).ok_or_else(|| unknown(name))??;
            Ok(Box::new(Engine::new(name, backend, options)?))
        }
        Spec::Profile(name) => match external::profile(name) {
            Some(profile) => external::open_profile(profile, options),
            None => Err(unknown(name)),
        },
        Spec::Configured(profile) => external::open_profile(profile, options),
        Spec::Command(line) => external::open_command(line, options),
    }
}

fn unknown(name: &str) -> Error {
    Error::Unsupported { what: format!("no solver {name} is known") }
}
