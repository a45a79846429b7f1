//! How far a search is, told as it goes to whoever watches.

use hyperplan_problem::Strategy;
use std::collections::VecDeque;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What is being done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stage {
    /// States are listed, and those found that can matter.
    #[default]
    Preparing,
    /// A search without queries, which may look at so many chances of the other player.
    Playing {
        /// How many.
        chances: usize,
    },
    /// A solver is at work.
    Asking,
    /// The strategy found is being checked.
    Verifying,
}

/// How far a search is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Standing {
    /// What is being done.
    pub stage: Stage,
    /// Checks that solvers were asked for.
    pub checks: usize,
    /// Variables of the largest query so far, as a solver got it; zero where that is not known.
    pub variables: usize,
    /// Where the least value is wanted: smaller ones are refuted, if any were.
    pub least: Option<i64>,
    /// The value that is asked for now.
    pub value: Option<i64>,
    /// The best value found.
    pub best: Option<i64>,
    /// Strategies found before, where several are wanted.
    pub strategies: usize,
    /// Candidates to which the other player had to find an answer.
    pub candidates: usize,
}

impl fmt::Display for Standing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.strategies > 0 {
            write!(f, "another than the {} found, ", self.strategies)?;
        }
        let values = [("with", self.value), ("none below", self.least), ("best so far", self.best)];
        for (what, value) in values {
            if let Some(value) = value {
                write!(f, "{what} {value}, ")?;
            }
        }
        match self.stage {
            Stage::Preparing => write!(f, "finding out which states can matter")?,
            Stage::Playing { chances } => write!(f, "searching without a solver (up to {chances} chances)")?,
            Stage::Asking => write!(f, "asking a solver")?,
            Stage::Verifying => write!(f, "verifying what was found")?,
        }
        match (self.checks, self.variables) {
            (0, _) => Ok(()),
            (checks, 0) => write!(f, "; queries so far: {checks}"),
            (checks, variables) => {
                write!(f, "; queries so far: {checks}, of up to {variables} variables")
            }
        }?;
        match self.candidates {
            0 => Ok(()),
            candidates => write!(f, "; candidates so far: {candidates}"),
        }
    }
}

/// The last candidates are the best: they cope with what defeated those before.
const KEPT: usize = 4;

/// Where a search tells how far it is. Copies share what is told.
#[derive(Clone, Debug, Default)]
pub struct Watch {
    standing: Arc<Mutex<Standing>>,
    candidates: Arc<Mutex<VecDeque<Strategy>>>,
}

impl Watch {
    /// How far it is now.
    #[must_use]
    pub fn standing(&self) -> Standing {
        locked(&self.standing).clone()
    }

    /// The last candidates for paths of the leading block: what is known of each is that some paths of the other player do not
    /// defeat it.
    #[must_use]
    pub fn candidates(&self) -> Vec<Strategy> {
        locked(&self.candidates).iter().cloned().collect()
    }

    pub(crate) fn tell(&self, tell: impl FnOnce(&mut Standing)) {
        tell(&mut locked(&self.standing));
    }

    pub(crate) fn stage(&self, stage: Stage) {
        self.tell(|standing| standing.stage = stage);
    }

    pub(crate) fn candidate(&self, candidate: Strategy) {
        self.tell(|standing| standing.candidates += 1);
        let mut candidates = locked(&self.candidates);
        if candidates.len() == KEPT {
            candidates.pop_front();
        }
        candidates.push_back(candidate);
    }
}

/// What was told is whole even where somebody panicked.
fn locked<T>(told: &Mutex<T>) -> MutexGuard<'_, T> {
    told.lock().unwrap_or_else(PoisonError::into_inner)
}
