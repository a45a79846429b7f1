//! The embedded engine: scripts of Booleans and bit-vectors, by bit-blasting and SAT.
//!
//! Terms become clauses (`cnf`, `bits`), which one of several SAT solvers gets (`backend` has their table), in a thread
//! of its own (`worker`).

mod backend;
mod batsat;
mod bits;
mod budget;
#[cfg(feature = "cadical")]
mod cadical;
mod cnf;
mod engine;
mod worker;

pub(crate) use backend::{BUILTIN, backend, names};
pub(crate) use engine::Engine;
