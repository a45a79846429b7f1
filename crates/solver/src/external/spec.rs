//! Which solver to use.

use std::sync::Arc;

use super::profile::Profile;
use crate::embedded::BUILTIN;

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
    /// A program, by its path or with its version, which is like a solver that is known by its name.
    Program(String, Arc<Profile>),
    /// A command line that reads SMT-LIB 2 from standard input. Words are split at blanks; quotes
    /// keep blanks together.
    Command(String),
}

impl Spec {
    /// Whether it is the embedded engine.
    #[must_use]
    pub fn is_embedded(&self) -> bool {
        matches!(self, Spec::Builtin | Spec::Backend(_))
    }

    /// What the solver is called before it was asked.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Spec::Builtin => BUILTIN,
            Spec::Backend(name) => name,
            Spec::Profile(name) => name,
            Spec::Configured(profile) => profile.name(),
            Spec::Program(line, _) | Spec::Command(line) => line,
        }
    }
}
