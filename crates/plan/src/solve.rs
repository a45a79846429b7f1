//! The front door: one solver's search, or several that race.

use crate::choice::Closest;
use crate::config::{Config, Outcome, Verdict, Verified};
use crate::explain::closest;
use crate::fact::{Error, Note};
use crate::minimize::{self, Least, MinimizeError, ProblemOf};
use crate::race::search_or_race;
use hyperplan_problem::{Objective, PathId, Problem};
use hyperplan_verify::{Budget, holds_for_all_outcomes};
use std::ops::RangeInclusive;

/// Decides an objective. A strategy (or counterexample) in the outcome has been verified, unless the configuration
/// says not to.
///
/// # Errors
/// What is not supported, failures of solvers, and answers that fail verification; being undecided is no error.
pub fn solve(problem: &Problem, objective: &Objective, config: &Config) -> Result<Outcome, Error> {
    let outcome = search_or_race(problem, objective, config)?;
    Ok(with_closest(problem, objective, outcome, config))
}

/// What it may cost to find that a strategy relies on outcomes.
const OUTCOMES: Budget = Budget { states: 100_000, entries: 1_000_000, moves: 2_000_000 };

/// Where nothing was decided, what is known of the candidates that were met. One of them may do, though no solver had the time to
/// say so.
fn with_closest(problem: &Problem, objective: &Objective, outcome: Outcome, config: &Config) -> Outcome {
    if outcome.verdict != Verdict::Unknown {
        return outcome;
    }
    match closest(problem, objective, &config.watch.candidates()) {
        Some(Closest { strategy, spared }) if spared.is_empty() => {
            let mut notes = outcome.notes;
            notes.retain(|note| !matches!(note, Note::Stopped(_) | Note::LongHorizon { .. }));
            let relies = |path: &PathId| {
                let held = holds_for_all_outcomes(problem, objective, &strategy, &[*path], &OUTCOMES);
                matches!(held, Ok(Some(false)))
            };
            let relying = objective.leading_block().into_iter().filter(relies);
            notes
                .extend(relying.map(|path| Note::PicksOutcomes { path: objective.paths[path].name.clone() }));
            let (verdict, verified) = (Verdict::Realizable, Some(Verified::BySearch));
            Outcome { verdict, reason: None, witness: Some(strategy), verified, notes, ..outcome }
        }
        closest => Outcome { closest, ..outcome },
    }
}

/// The least value of the range for which the objective of that name is realizable. The deadline is for all values
/// together. Of an empty range the first value is asked.
///
/// # Errors
/// Those of the problems, for a value that has to be asked, and those of [`solve()`].
pub fn minimize<E>(
    objective: &str,
    range: RangeInclusive<i64>,
    problem_of: ProblemOf<'_, E>,
    config: &Config,
) -> Result<Least, MinimizeError<E>> {
    let least = minimize::minimize(objective, range, problem_of, config)?;
    let Some(objective) = least.problem.objective(objective) else { return Ok(least) };
    let outcome = with_closest(&least.problem, objective, least.outcome, config);
    Ok(Least { outcome, ..least })
}
