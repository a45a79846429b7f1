//! Comparisons of solvers: what was run, and what came of it.

pub mod benchexec;
mod contest;
mod html;
mod judge;
pub mod plot;
mod record;
pub mod report;
mod score;
pub mod table;

pub use contest::{Cell, Contest, Contestant, Instance};
pub use judge::{Claim, Fault, Finding, Judgement, Kind, judge};
pub use record::{Answer, Limit, Record, Status};
pub use score::{Parallel, Score, Scores, Sequential, scores};

/// What a terminal shows of a comparison: what is wrong, then the scores.
pub fn summary(records: &[Record]) -> String {
    let contest = Contest::new(records);
    table::summary(&contest, &judge::judge_contest(&contest))
}
