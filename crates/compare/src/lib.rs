//! Comparisons of solvers: what was run, and what came of it.
//!
//! [`plan`](plan::plan) says what is to be run, [`run_all`] runs it, each run below a process that
//! [`supervise`](supervise())s it, and a [`Log`] keeps a [`Record`] of each. From the records come judgement, scores,
//! tables and plots.
//!
//! Several machines do it together: [`list`] is the plan as a file, [`share`] cuts it, [`work`] hands it out, and [`merge`]
//! makes one of their logs.

pub mod benchexec;
mod cases;
pub mod contest;
pub mod difficulty;
pub mod division;
mod folders;
pub mod foreign;
mod heard;
mod html;
mod judge;
mod lanes;
pub mod latex;
mod links;
pub mod list;
mod log;
mod machine;
pub mod merge;
mod packed;
mod paths;
pub mod plan;
pub mod plot;
mod pool;
mod query;
mod reading;
mod record;
pub mod report;
pub mod score;
pub mod share;
pub mod slurm;
mod supervise;
pub mod table;
mod terminal;
mod tree;
mod witness;
pub mod work;

pub use cases::together;
pub use judge::{Claim, Fault, Finding, Judgement, Kind, judge};
pub use lanes::{Finish, Foreman, Lanes};
pub use log::{Log, LogError, Past};
pub use machine::{cores, processor};
pub use pool::{Event, Setting, prepare, run_all, tidy};
pub use query::Query;
pub use record::{Answer, Limit, Record, RunStatus, checked};
pub use supervise::supervise;

use contest::Contest;

/// What a terminal shows of a comparison: what is wrong, the results if they are few, the scores. Tables are made to fit
/// into that width; without one they have everything.
pub fn summary(records: &[Record], width: Option<usize>) -> String {
    let contest = Contest::new(records);
    terminal::summary(&contest, &judge::judge_contest(&contest), width)
}
