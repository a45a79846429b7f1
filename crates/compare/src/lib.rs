//! Comparisons of solvers: what was run, and what came of it.
//!
//! [`plan`](plan::plan) says what is to be run, [`run_all`] runs it, each run below a process that
//! [`supervise`](supervise())s it, and a [`Log`] keeps a [`Record`] of each. From the records come judgement, scores,
//! tables and plots.

pub mod benchexec;
mod contest;
mod html;
mod judge;
mod log;
mod outcome;
pub mod plan;
pub mod plot;
mod pool;
mod query;
mod record;
pub mod report;
mod score;
mod supervise;
pub mod table;
mod tree;

pub use contest::{Cell, Contest, Contestant, Instance};
pub use judge::{Claim, Fault, Finding, Judgement, Kind, judge};
pub use log::{Log, LogError, Past};
pub use pool::{Event, Setting, prepare, run_all};
pub use query::Query;
pub use record::{Answer, Limit, Record, Status};
pub use score::{Parallel, Score, Scores, Sequential, scores};
pub use supervise::supervise;

/// What a terminal shows of a comparison: what is wrong, then the scores.
pub fn summary(records: &[Record]) -> String {
    let contest = Contest::new(records);
    table::summary(&contest, &judge::judge_contest(&contest))
}
