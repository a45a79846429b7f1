//! Comparisons of solvers: what was run, and what came of it.

pub mod benchexec;
pub mod contest;
mod html;
mod judge;
pub mod plot;
mod record;
pub mod report;
pub mod score;
pub mod table;

pub use judge::{Claim, Fault, Finding, Judgement, Kind, judge};
pub use record::{Answer, Limit, Record, Status};

use contest::Contest;

/// What a terminal shows of a comparison: what is wrong, the results if they are few, the scores.
pub fn summary(records: &[Record]) -> String {
    let contest = Contest::new(records);
    table::summary(&contest, &judge::judge_contest(&contest))
}
