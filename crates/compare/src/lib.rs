//! Comparisons of solvers: what was run, and what came of it.
//!
//! [`plan`](plan::plan) says what is to be run, [`run_all`] runs it, each run below a process that
//! [`supervise`](supervise())s it, and a [`Log`] keeps a [`Record`] of each.

mod log;
mod outcome;
pub mod plan;
mod pool;
mod query;
mod record;
mod supervise;
mod tree;

pub use log::{Log, LogError, Past};
pub use pool::{Event, Setting, prepare, run_all};
pub use query::Query;
pub use record::{Answer, Limit, Record, Status};
pub use supervise::supervise;
