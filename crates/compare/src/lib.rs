//! Comparisons of solvers: what was run, and what came of it.

mod record;

pub use record::{Answer, Limit, Record, Status};
