//! At the end of a search without an answer: a candidate that the search met, and the choices of the other player to which it
//! loses.
//!
//! All that is said was found by the checker, on the whole objective: the candidate wins against all paths that make none of
//! these choices, and loses to some path that makes one, of each and no other.

use super::failure::compares_actions;
use super::opponent::{mattering, without};
use crate::choice::{Choice, Closest};
use crate::prepare::is_existential;
use hyperplan_problem::{Objective, PathId, Problem, Strategy, Trace};
use hyperplan_verify::{self as verify, Budget, Check, Defeat};
use std::time::{Duration, Instant};

/// More choices than these are nothing that anybody would want to read.
const MOST: usize = 5;

/// What one question to the checker may cost: some hundredths of a second.
const CHECK: Budget = Budget { states: 100_000, entries: 1_000_000, moves: 2_000_000 };

/// When no other question is begun: nobody waits for this.
const PATIENCE: Duration = Duration::from_millis(250);

/// Of candidates, the later the better, one that loses to fewest choices; `None` where there is none that loses to few, or that
/// was not found out in a quarter of a second.
#[must_use]
pub fn closest(problem: &Problem, objective: &Objective, candidates: &[Strategy]) -> Option<Closest> {
    if !is_existential(objective) || objective.blocks().len() < 2 {
        return None;
    }
    let judge = Judge { problem, objective, end: Instant::now() + PATIENCE };
    let judged = candidates.iter().rev().map_while(|strategy| {
        let in_time = Instant::now() < judge.end;
        in_time.then(|| Some(Closest { strategy: strategy.clone(), spared: judge.spared(strategy)? }))
    });
    judged.flatten().min_by_key(|closest| closest.spared.len())
}

struct Judge<'a> {
    problem: &'a Problem,
    objective: &'a Objective,
    end: Instant,
}

impl Judge<'_> {
    /// Choices without which the strategy wins, none of which can be left out.
    fn spared(&self, strategy: &Strategy) -> Option<Vec<Choice>> {
        let mut spared = Vec::new();
        while let Some(defeat) = self.defeat(strategy, &spared)? {
            if spared.len() == MOST {
                return None;
            }
            spared.push(self.choice(strategy, &defeat)?);
        }
        // A path may make several of them: what came later may be enough.
        for at in (0..spared.len()).rev() {
            let mut rest = spared.clone();
            rest.remove(at);
            if self.defeat(strategy, &rest)?.is_none() {
                spared = rest;
            }
        }
        self.leaves_some(&spared).then_some(spared)
    }

    /// Paths of the other player that make none of these choices and defeat the strategy, if there are some; `None` where that
    /// was not found out.
    fn defeat(&self, strategy: &Strategy, spared: &[Choice]) -> Option<Option<Vec<Trace>>> {
        if Instant::now() > self.end {
            return None;
        }
        let weaker = without(self.problem, self.objective, spared);
        match verify::check(self.problem, &weaker, strategy, &CHECK) {
            Ok(Check::Holds) => Some(None),
            Ok(Check::Fails(Defeat::Paths(paths))) => Some(Some(paths)),
            Ok(Check::Fails(_) | Check::TooLarge { .. }) | Err(_) => None,
        }
    }

    /// What paths that defeat the strategy do: something else than the path whose actions theirs are compared with, or they begin
    /// where they do.
    fn choice(&self, strategy: &Strategy, defeat: &[Trace]) -> Option<Choice> {
        let until = self.settled(strategy, defeat);
        for trace in defeat {
            for from in &strategy.traces {
                let mut both = trace.actions.iter().zip(&from.actions).take(until);
                if let Some(step) = both.position(|(own, other)| own != other)
                    && compares_actions(self.objective, from.path, trace.path)
                {
                    return Some(Choice::Replaced(trace.path, from.path, step));
                }
            }
        }
        let mut several =
            defeat.iter().filter(|trace| self.starts(trace.path, 2).is_some_and(|starts| starts == 2));
        several.next().and_then(|trace| Some(Choice::Start(trace.path, trace.states.first()?.clone())))
    }

    /// When it is settled that the strategy fails; what paths do from then on is chance.
    fn settled(&self, strategy: &Strategy, defeat: &[Trace]) -> usize {
        let mut all = strategy.clone();
        all.traces.extend_from_slice(defeat);
        if all.traces.len() < self.objective.paths.len() {
            return usize::MAX;
        }
        let settled = verify::settled(self.problem, self.objective, &all, &CHECK);
        settled.ok().flatten().map_or(usize::MAX, |(_, time)| time as usize)
    }

    /// In how many states, up to so many, a path of the other player may begin and still matter.
    fn starts(&self, path: PathId, most: usize) -> Option<usize> {
        let system = self.objective.paths[path].system;
        let all = verify::starts(self.problem, system, usize::MAX, &CHECK)?;
        Some(mattering(self.problem, self.objective, path, all, most)?.len())
    }

    /// Whether the other player can do without these choices.
    fn leaves_some(&self, spared: &[Choice]) -> bool {
        let block = self.objective.blocks().into_iter().nth(1).unwrap_or_default();
        block.into_iter().all(|path| {
            let begins =
                spared.iter().filter(|choice| matches!(choice, Choice::Start(own, _) if *own == path));
            match begins.count() {
                0 => true,
                spared => self.starts(path, spared + 1).is_some_and(|starts| starts > spared),
            }
        })
    }
}
