//! Solvers as processes, spoken to in SMT-LIB 2 over pipes.

mod dialogue;
mod discover;
mod process;
mod profile;
mod reply;
mod sexpr;

pub(crate) use dialogue::{open_command, open_profile};
pub(crate) use discover::for_arithmetic;
pub use discover::{Found, discover};
pub(crate) use profile::{profile, that_take};
#[doc(hidden)]
pub use reply::understand_output;
