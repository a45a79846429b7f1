//! The embedded engine: scripts of Booleans and bit-vectors, by bit-blasting and SAT.
//!
//! The SAT solver is `CaDiCaL`, or `BatSat` in builds that have only Rust: the `backend`, the same four functions in
//! either module.

#[cfg(not(feature = "cadical"))]
#[path = "batsat.rs"]
mod backend;
#[cfg(feature = "cadical")]
#[path = "cadical.rs"]
mod backend;
mod bits;
mod budget;
mod cnf;
mod engine;

pub(crate) use engine::Engine;
