//! The embedded engine: scripts of Booleans and bit-vectors, by bit-blasting and SAT.

mod backend;
mod bits;
mod cnf;
mod engine;

pub(crate) use engine::Engine;
