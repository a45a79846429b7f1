//! Claims about costs: that nothing cheaper exists.

use crate::error::Error;
use crate::reading::last_reads;
use hyperplan_problem::{Mode, Objective, PathId, Problem, Target, bounded, extended};
use serde::{Deserialize, Serialize};

/// What a cost, as it is written in objectives, is at most.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bound {
    /// The sum of costs.
    pub cost: String,
    /// Its bound.
    pub most: i64,
}

/// The problem and the objective with the demand that costs are at most so large: those of all steps up to the last at which the
/// objective reads any of the paths whose costs these are.
///
/// # Errors
/// If that is too late.
pub fn with_bounds(
    problem: &Problem,
    objective: &Objective,
    bounds: &[(Target, i64)],
) -> Result<(Problem, Objective), Error> {
    let steps = last_reads(objective)?;
    let mut paths: Vec<PathId> =
        bounds.iter().flat_map(|(target, _)| &target.terms).map(|&(_, path, _)| path).collect();
    paths.sort_unstable();
    paths.dedup();
    let time = paths.iter().map(|path| steps[usize::from(*path)]).max().unwrap_or(0);
    paths.retain(|path| objective.mode == Mode::Bounded && steps[usize::from(*path)] < time);
    let longer = (!paths.is_empty()).then(|| extended(problem, objective, &paths, time));
    Ok(bounded(problem, longer.as_ref().unwrap_or(objective), bounds, time))
}
