//! The common interface of all solvers.

use std::path::PathBuf;
use std::str::FromStr;

use hyperplan_smt::{Script, Status, Term, Value};

use crate::deadline::Deadline;
use crate::error::Error;
use crate::external;

/// The answer to a check.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Answer {
    /// Satisfiable: values can be asked for.
    Sat,
    /// Unsatisfiable.
    Unsat,
    /// Neither was found: `timeout`, `interrupted`, or the solver's own reason.
    Unknown(String),
}

/// Which solver answered.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Identity {
    /// Its name.
    pub name: String,
    /// Its version; empty if not known.
    pub version: String,
}

/// A dialogue with a solver about one growing script.
pub trait Session {
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
}

/// Which solver to use.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Spec {
    /// The embedded engine.
    Builtin,
    /// A solver that hyperplan knows: `z3`, `cvc5`, `yices`, `bitwuzla`.
    Profile(String),
    /// A command line that reads SMT-LIB 2 from standard input. Words are split at blanks; quotes
    /// keep blanks together.
    Command(String),
}

impl FromStr for Spec {
    type Err = Error;

    fn from_str(text: &str) -> Result<Spec, Error> {
        let text = text.trim();
        if text.is_empty() {
            return Err(Error::Unsupported { what: "the solver's name is empty".to_owned() });
        }
        if text == "builtin" {
            return Ok(Spec::Builtin);
        }
        if let Some(profile) = external::profile(text) {
            return Ok(Spec::Profile(profile.name.to_owned()));
        }
        if text.contains(',') {
            let what = format!("several solvers at once ({text}) are not supported yet; name one");
            return Err(Error::Unsupported { what });
        }
        Ok(Spec::Command(text.to_owned()))
    }
}

/// How to run a solver.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Seed of the solver's random choices, where it has some.
    pub seed: u64,
    /// The script will contain quantifiers.
    pub quantified: bool,
    /// More than one check will be asked for.
    pub incremental: bool,
    /// Memory limit of a solver process, in MiB. The embedded engine shares our memory and has none.
    pub memory_mib: Option<u64>,
    /// A directory to keep everything that is sent in, one replayable file per solver process.
    pub queries: Option<PathBuf>,
    /// The expected answer, for the `:status` of the kept files.
    pub status: Option<Status>,
}

/// Starts a session. The solver must be installed.
///
/// # Errors
/// When the solver is missing, or cannot do what the options say.
pub fn open(spec: &Spec, options: &Options) -> Result<Box<dyn Session>, Error> {
    match spec {
        Spec::Builtin => builtin(options),
        Spec::Profile(name) => external::open_profile(name, options),
        Spec::Command(line) => external::open_command(line, options),
    }
}

#[cfg(any(feature = "cadical", feature = "batsat"))]
fn builtin(options: &Options) -> Result<Box<dyn Session>, Error> {
    Ok(Box::new(crate::embedded::Engine::new(options)?))
}

#[cfg(not(any(feature = "cadical", feature = "batsat")))]
fn builtin(_: &Options) -> Result<Box<dyn Session>, Error> {
    let what = "this build has no embedded solver (features cadical, batsat): use z3, cvc5 or yices";
    Err(Error::Unsupported { what: what.to_owned() })
}
