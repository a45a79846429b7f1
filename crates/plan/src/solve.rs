//! The front door: one solver's search, or several that race.

use crate::config::{Config, Outcome, Verdict, Verified};
use crate::explain::{Closest, closest};
use crate::fact::{Error, Note};
use crate::race::race;
use crate::search::search;
use hyperplan_problem::{Objective, PathId, Problem};
use hyperplan_verify::{Budget, holds_for_all_outcomes};

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
pub(crate) fn with_closest(
    problem: &Problem,
    objective: &Objective,
    outcome: Outcome,
    config: &Config,
) -> Outcome {
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

/// As [`solve`], without what is known of candidates.
pub(crate) fn search_or_race(
    problem: &Problem,
    objective: &Objective,
    config: &Config,
) -> Result<Outcome, Error> {
    if config.rivals.is_empty() {
        search(problem, objective, config)
    } else {
        race(problem, objective, config)
    }
}
