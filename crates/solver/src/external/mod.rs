//! Solvers as processes, spoken to in SMT-LIB 2 over pipes.

mod catalog;
mod dialogue;
mod discover;
mod exchange;
mod facts;
mod model;
mod one_shot;
mod probe;
mod process;
mod profile;
mod program;
mod reply;
mod standalone;
mod version;
mod watchdog;

pub(crate) use catalog::split_list;
pub use catalog::{Catalog, ConfigError};
pub(crate) use dialogue::{open_command, open_profile};
pub(crate) use discover::for_arithmetic;
pub use discover::{Found, discover};
pub use facts::Facts;
pub use model::{PrintedModel, PrintedModelError};
pub use process::end_with_parent;
pub use profile::{Install, Profile};
pub(crate) use profile::{profile, that_take};
#[doc(hidden)]
pub use reply::understand_output;
pub use standalone::Standalone;
