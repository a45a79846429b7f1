//! Which SAT solvers there are. Another one is a file beside `batsat.rs`, and a row of [`BACKENDS`].

use super::backend::Backend;
use super::batsat::BatSat;
#[cfg(feature = "cadical")]
use super::cadical::Cadical;
#[cfg(feature = "cadical")]
use super::turns::Turns;
use super::worker::{Serve, serve};
use crate::error::Error;

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

/// What the embedded engine is called where it comes with the best SAT solver of the build.
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
    const fn of<B: Backend>() -> Built {
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

/// What the engine comes with for a dialogue, where nobody names a back end: in this build, all there are.
#[cfg(feature = "cadical")]
pub(crate) fn for_dialogue() -> Option<Built> {
    Some(Built::of::<Turns>())
}

/// What the engine comes with for a dialogue, where nobody names a back end: in this build, what it always comes with.
#[cfg(not(feature = "cadical"))]
pub(crate) fn for_dialogue() -> Option<Built> {
    None
}
