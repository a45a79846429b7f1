//! SAT solvers: what the engine wants of one, and which there are. Another one is a file beside `batsat.rs`, and a row
//! of [`BACKENDS`].

use std::ops::Not;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::batsat::BatSat;
#[cfg(feature = "cadical")]
use super::cadical::Cadical;
use super::worker::{Serve, serve};
use crate::error::Error;

/// A SAT solver that takes more clauses after each answer. Literals are numbers as in DIMACS. It is made, asked and
/// freed in a thread of its own, so that it need not be fit for more than one.
pub(super) trait Backend: Sized {
    /// Its name and version.
    fn signature() -> String;

    /// A solver without clauses, or what is wrong.
    fn new(setup: &Setup) -> Result<Self, String>;

    /// Adds a clause.
    fn clause(&mut self, literals: &[i32]);

    /// Whether the clauses are satisfiable under the assumptions; `None` if it was told to stop.
    fn solve(&mut self, assumptions: &[i32]) -> Option<bool>;

    /// After `Some(true)`: the values of the variables from 1 on; what does not matter is false.
    fn model(&mut self) -> Vec<bool>;
}

/// How a solver is to work.
pub(super) struct Setup {
    /// Of its random choices; 0 is as it would by itself.
    pub(super) seed: u64,
    /// It will be asked more than once, which makes no difference to `BatSat`.
    #[cfg_attr(not(feature = "cadical"), expect(dead_code))]
    pub(super) dialogue: bool,
    /// Set when it is to stop: to be looked at every few milliseconds while it solves.
    pub(super) stop: Arc<AtomicBool>,
}

/// A row of the table.
struct Row {
    /// What users call it; also the cargo feature of one that not every build has.
    name: &'static str,
    built: Option<Built>,
}

/// What there is of a solver in this build.
#[derive(Clone, Copy)]
pub(crate) struct Built {
    signature: fn() -> String,
    /// What its thread does.
    pub(super) serve: Serve,
}

/// What the engine is called where it comes with the best back end of the build.
pub(crate) const BUILTIN: &str = "builtin";

/// All back ends, the best first.
static BACKENDS: &[Row] = &[
    #[cfg(feature = "cadical")]
    Row { name: "cadical", built: Some(Built::of::<Cadical>()) },
    #[cfg(not(feature = "cadical"))]
    Row { name: "cadical", built: None },
    Row { name: "batsat", built: Some(Built::of::<BatSat>()) },
];

impl Built {
    pub(super) const fn of<B: Backend>() -> Built {
        Built { signature: B::signature, serve: serve::<B> }
    }

    /// Our version, which is that of the clauses, and the solver's.
    pub(crate) fn version(&self) -> String {
        format!("{} ({})", env!("CARGO_PKG_VERSION"), (self.signature)())
    }
}

/// What the engine can be called: `builtin`, then each back end.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    std::iter::once(BUILTIN).chain(BACKENDS.iter().map(|row| row.name))
}

/// The back end that a name of the engine stands for, if it is one.
///
/// # Errors
/// Where this build has not got it.
pub(crate) fn backend(name: &str) -> Option<Result<Built, Error>> {
    let mut rows = BACKENDS.iter();
    let row = match name {
        BUILTIN => rows.find(|row| row.built.is_some()),
        _ => rows.find(|row| row.name == name),
    }?;
    let what = || format!("this build has no {name}: it takes the cargo feature {name}");
    Some(row.built.ok_or_else(|| Error::Unsupported { what: what() }))
}

/// A literal: the number of a variable, from 1 on, negative where it is negated.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Lit(i32);

impl Lit {
    /// The literal of a variable, which is not 0.
    pub(super) fn new(variable: i32) -> Lit {
        Lit(variable)
    }

    pub(super) fn number(self) -> i32 {
        self.0
    }

    pub(super) fn variable(self) -> u32 {
        self.0.unsigned_abs()
    }
}

impl Not for Lit {
    type Output = Lit;

    fn not(self) -> Lit {
        Lit(-self.0)
    }
}
