//! What was found: an answer with its paths, in the names of the problem.

use crate::search::{Decided, answer};
use hyperplan_plan as plan;
use hyperplan_problem::answer::{Answer, CostValue, Verdict, WitnessPath};
use hyperplan_problem::{Objective, Problem, Strategy};
use std::time::Duration;

/// An answer for an objective.
#[derive(Debug)]
#[non_exhaustive]
pub struct Outcome {
    /// The answer as `solve --format json` prints it: names, numbers, and how it was found.
    pub answer: Answer,
    /// The same as the search tells it, with typed paths and reasons.
    pub found: plan::Outcome,
}

impl Outcome {
    pub(crate) fn new(
        file: &str,
        (problem, objective): (&Problem, &Objective),
        decided: Decided,
        times: (Duration, Duration),
    ) -> Outcome {
        let Decided { outcome, costs, undecided } = decided;
        let mut answer = answer(file, (problem, objective), &outcome, times);
        answer.costs = costs;
        if let Some(reason) = undecided {
            (answer.reason, answer.reason_code) = (Some(reason.to_string()), Some(reason.code()));
        }
        Outcome { answer, found: outcome }
    }

    /// Whether the objective can be had.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        self.answer.verdict
    }

    /// The paths of the leading block: a plan, or a counterexample; none where there is none.
    #[must_use]
    pub fn paths(&self) -> &[WitnessPath] {
        self.answer.witness.as_deref().unwrap_or_default()
    }

    /// The path of that name.
    #[must_use]
    pub fn path(&self, name: &str) -> Option<&WitnessPath> {
        self.paths().iter().find(|path| path.path == name)
    }

    /// The same paths, typed.
    #[must_use]
    pub fn strategy(&self) -> Option<&Strategy> {
        self.found.witness.as_ref()
    }

    /// What was to be as small as possible.
    #[must_use]
    pub fn costs(&self) -> &[CostValue] {
        &self.answer.costs
    }
}

/// What the checker says of a strategy.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Verification {
    /// It does what the objective asks.
    Holds,
    /// It does not.
    Fails {
        /// Why, in words.
        reason: String,
        /// Paths of the next block that defeat it, if that is why.
        paths: Vec<WitnessPath>,
    },
    /// Nobody knows: there is too much to look at.
    TooLarge,
}
