//! Runs scripts: the embedded engine, and SMT solvers as processes.
//!
//! [`open`] starts a [`Session`] for a [`Spec`]; a session takes a growing
//! [`Script`](hyperplan_smt::Script), answers under assumptions before a [`Deadline`], and gives the
//! values of symbols. [`discover`] lists the solvers of this machine. A [`Catalog`] knows solvers by name, those of
//! configuration files too.
//!
//! No answer is trusted here: whoever asks should evaluate the script under the values.

mod circuit;
mod deadline;
mod embedded;
mod error;
mod external;
mod open;
mod propositional;
mod session;
mod transcript;

pub use deadline::Deadline;
pub use embedded::Refuter;
pub use error::{Error, Unknown};
#[doc(hidden)]
pub use external::understand_output;
pub use external::{
    Catalog, ConfigError, Found, Install, PrintedModel, PrintedModelError, Profile, Response, Said, Spec,
    Standalone, discover, end_with_parent, responses, says_what_to_run,
};
pub use open::open;
pub use propositional::{Format, Propositional};
pub use session::{Answer, Identity, Options, QuerySize, Session};
pub use transcript::keep_query;
