//! Questions to the search, each with a part of the time that is left.

use crate::config::{Config, Outcome, Verdict};
use crate::fact::{Error, Fault, Reason};
use crate::race::search_or_race;
use hyperplan_problem::{Objective, Problem};
use hyperplan_solver::{Deadline, Unknown};
use std::time::Duration;

/// A question may take one in so many parts of the time that is left.
const SHARE: u32 = 4;

/// Asks about one problem.
pub(super) struct Asker<'a> {
    pub(super) problem: &'a Problem,
    pub(super) config: &'a Config,
    /// The end of the questions that are asked now.
    pub(super) deadline: Deadline,
}

impl<'a> Asker<'a> {
    pub(super) fn new(problem: &'a Problem, config: &'a Config) -> Self {
        Asker { problem, config, deadline: config.deadline.clone() }
    }

    /// Gives the questions that follow one in so many parts of the time that is left for all.
    pub(super) fn begin(&mut self, share: u32) {
        let all = &self.config.deadline;
        self.deadline = all.remaining().map_or_else(|| all.clone(), |left| all.within(left / share));
    }

    /// The answer for an objective of the problem: a strategy was verified, and that there is none is the search's word.
    /// `Err` where it is not known.
    pub(super) fn ask(&self, objective: &Objective) -> Result<Result<Outcome, Reason>, Error> {
        if self.deadline.passed() {
            return Ok(Err(self.deadline.reason().into()));
        }
        let share = self.deadline.remaining().map_or(Duration::MAX, |left| left / SHARE);
        let config = Config { deadline: self.deadline.within(share), ..self.config.clone() };
        match search_or_race(self.problem, objective, &config) {
            Ok(Outcome { verdict: Verdict::Unknown, reason, .. }) => {
                Ok(Err(reason.unwrap_or(Reason::Solver(Unknown::Unsaid))))
            }
            Ok(outcome) => Ok(Ok(outcome)),
            Err(error) if error.fault() <= Fault::Time => Ok(Err(config.deadline.reason().into())),
            Err(error) => Err(error),
        }
    }

    /// Whether an objective has no strategy; `None` where that is not known.
    pub(super) fn impossible(&self, objective: &Objective) -> Result<Option<bool>, Error> {
        Ok(self.ask(objective)?.ok().map(|outcome| outcome.verdict == Verdict::Unrealizable))
    }
}

/// What of a list is needed, one by one; and whether each of it was found to be. `without` says of a rest whether it is
/// enough, if that is known; more of the list than is enough is enough, too. Nothing more is asked once the deadline has passed.
///
/// What is not needed is left out in large pieces first, then in smaller ones.
pub(super) fn needed<T: Clone>(
    all: Vec<T>,
    deadline: &Deadline,
    mut without: impl FnMut(&[T]) -> Result<Option<bool>, Error>,
) -> Result<(Vec<T>, bool), Error> {
    let mut kept = all;
    let mut size = kept.len().div_ceil(2).max(1);
    loop {
        let (mut at, mut sure) = (0, true);
        while at < kept.len() {
            if deadline.passed() {
                return Ok((kept, false));
            }
            let end = (at + size).min(kept.len());
            let rest = [&kept[..at], &kept[end..]].concat();
            match without(&rest)? {
                Some(true) => kept = rest,
                known => {
                    sure &= known.is_some();
                    at = end;
                }
            }
        }
        if size == 1 {
            return Ok((kept, sure));
        }
        size = size.div_ceil(2);
    }
}

#[cfg(test)]
mod tests {
    use super::{Deadline, needed};

    #[test]
    fn what_is_needed_is_kept() {
        let never = Deadline::never();
        for (length, core) in [(1, vec![0]), (7, vec![6]), (16, vec![0, 3, 15]), (9, Vec::new())] {
            let mut without = |rest: &[usize]| Ok(Some(core.iter().all(|one| rest.contains(one))));
            let found = needed((0..length).collect(), &never, &mut without).expect("nothing fails");
            assert_eq!(found, (core.clone(), true));
        }
        let mut nothing = |_: &[usize]| Ok(None);
        assert_eq!(
            needed(vec![1, 2, 3], &never, &mut nothing).expect("nothing fails"),
            (vec![1, 2, 3], false)
        );
    }
}
