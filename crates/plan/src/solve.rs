//! The front door: one solver's search, or several that race.

use crate::config::{Config, Outcome};
use crate::fact::Error;
use crate::race::race;
use crate::search::search;
use hyperplan_problem::{Objective, Problem};

/// Decides an objective. A strategy (or counterexample) in the outcome has been verified, unless the configuration
/// says not to.
///
/// # Errors
/// What is not supported, failures of solvers, and answers that fail verification; being undecided is no error.
pub fn solve(problem: &Problem, objective: &Objective, config: &Config) -> Result<Outcome, Error> {
    if config.rivals.is_empty() {
        search(problem, objective, config)
    } else {
        race(problem, objective, config)
    }
}
