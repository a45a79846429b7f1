//! The embedded engine: scripts of Booleans and bit-vectors, by bit-blasting and SAT.
//!
//! Terms become clauses (`circuit`), which one of several SAT solvers gets (`table` has them), in a thread
//! of its own (`worker`).

mod backend;
mod batsat;
#[cfg(feature = "cadical")]
mod cadical;
mod engine;
mod refute;
mod table;
#[cfg(feature = "cadical")]
mod trace;
#[cfg(feature = "cadical")]
mod traced;
#[cfg(feature = "cadical")]
mod turns;
mod worker;

pub(crate) use engine::Engine;
pub use refute::Refuter;
pub(crate) use table::{BUILTIN, backend, for_dialogue, names};
