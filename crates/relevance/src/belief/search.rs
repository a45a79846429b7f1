//! Depth first over beliefs, learning nogoods.

use super::Belief;
use super::chances::{After, ChanceIx, Chances, LeadIx, LeadStep};
use crate::task::Error;
use hyperplan_space::Run;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// Without repetition, in no order that matters.
type Set = Vec<ChanceIx>;

/// Nogoods of one node that are kept; of more the last.
const KEPT: usize = 200;

/// Chances looked at between two questions whether to stop.
const STRIDE: usize = 10_000;

pub(super) struct Search<'a, const N: usize> {
    chances: Chances<'a, N>,
    budget: usize,
    asked: usize,
    nogoods: FxHashMap<(u32, LeadIx), Vec<Set>>,
    /// The last set in which each chance was, by number.
    stamps: Vec<u32>,
    stamp: u32,
}

/// A belief whose moves are being tried.
struct Frame<const N: usize> {
    lead: LeadIx,
    belief: Set,
    steps: Vec<Tried<N>>,
    next: usize,
    /// Chances by which the moves so far failed.
    conflict: BTreeSet<ChanceIx>,
}

struct Tried<const N: usize> {
    step: LeadStep<N>,
    belief: Set,
}

impl<'a, const N: usize> Search<'a, N> {
    pub(super) fn new(chances: Chances<'a, N>, budget: usize) -> Self {
        Search { chances, budget, asked: 0, nogoods: FxHashMap::default(), stamps: Vec::new(), stamp: 0 }
    }

    pub(super) fn run(mut self) -> Result<Belief<Vec<Run>>, Error> {
        for (lead, belief) in self.chances.starts() {
            let Some(belief) = belief else { continue };
            if let Some(answer) = self.from(lead, belief)? {
                return Ok(answer);
            }
        }
        Ok(Belief::Hopeless)
    }

    /// What comes of a start; `None` where it loses.
    fn from(&mut self, lead: LeadIx, belief: Set) -> Result<Option<Belief<Vec<Run>>>, Error> {
        if self.is_won(lead, &belief) {
            return Ok(Some(self.found(&[], lead)));
        }
        let Some(first) = self.frame(lead, belief, 0)? else { return Ok(Some(Belief::Open)) };
        let mut stack = vec![first];
        while let Some(frame) = stack.last_mut() {
            let Some(tried) = frame.steps.get(frame.next) else {
                let Some(frame) = stack.pop() else { break };
                self.fail(&mut stack, frame);
                continue;
            };
            let (step, belief) = (tried.step, tried.belief.clone());
            if self.is_won(step.to, &belief) {
                return Ok(Some(self.found(&stack, step.to)));
            }
            let time = stack.len() as u32;
            if time == self.chances.end {
                // All that was asked for is decided at the end of the horizon.
                return Ok(Some(Belief::Open));
            }
            if let Some(nogood) = self.known_nogood(time, step.to, &belief) {
                self.blame(&mut stack, &nogood);
                continue;
            }
            match self.frame(step.to, belief, time)? {
                Some(frame) => stack.push(frame),
                None => return Ok(Some(Belief::Open)),
            }
        }
        Ok(None)
    }

    fn is_won(&self, lead: LeadIx, belief: &Set) -> bool {
        belief.is_empty() && self.chances.owes_nothing(lead)
    }

    /// The moves of a belief at a time, those that leave least first; `None` beyond the budget.
    fn frame(&mut self, lead: LeadIx, mut belief: Set, time: u32) -> Result<Option<Frame<N>>, Error> {
        // Those known longest are blamed first.
        belief.sort_unstable();
        let mut frame = Frame { lead, belief, steps: Vec::new(), next: 0, conflict: BTreeSet::new() };
        for step in self.chances.lead_steps(lead, time + 1) {
            match self.after(step, &frame.belief) {
                Ok(belief) => frame.steps.push(Tried { step, belief }),
                Err(lost) => {
                    frame.conflict.insert(lost);
                }
            }
        }
        frame.steps.sort_by_key(|tried| tried.belief.len());
        if self.chances.work - self.asked > STRIDE {
            self.asked = self.chances.work;
            self.chances.question().arena.task.go_on()?;
        }
        Ok((self.chances.work <= self.budget).then_some(frame))
    }

    /// The belief after a step, or a chance that loses by it.
    fn after(&mut self, step: LeadStep<N>, belief: &Set) -> Result<Set, ChanceIx> {
        let mut next = Vec::new();
        self.stamp += 1;
        for &chance in belief {
            self.chances.work += 1;
            let After::Left(range) = self.chances.after(step, chance) else { return Err(chance) };
            for &left in self.chances.left(range) {
                if stamped(&mut self.stamps, left, self.stamp) {
                    next.push(left);
                }
            }
        }
        Ok(next)
    }

    /// A node of which every move fails: what is learnt, and whom the node before may blame.
    fn fail(&mut self, stack: &mut [Frame<N>], frame: Frame<N>) {
        let nogood: Set = frame.conflict.into_iter().collect();
        let kept = self.nogoods.entry((stack.len() as u32, frame.lead)).or_default();
        if kept.len() >= KEPT {
            kept.remove(0);
        }
        kept.push(nogood.clone());
        self.blame(stack, &nogood);
    }

    /// The move that the last node tried fails by these chances after it: traces them back to chances before it.
    fn blame(&mut self, stack: &mut [Frame<N>], nogood: &Set) {
        let Some(frame) = stack.last_mut() else { return };
        let step = frame.steps[frame.next].step;
        frame.next += 1;
        let mut left: BTreeSet<ChanceIx> = nogood.iter().copied().collect();
        // Those that are to blame already come first: the fewer, the more is excluded.
        let blamed = frame.belief.iter().filter(|chance| frame.conflict.contains(chance));
        let others = frame.belief.iter().filter(|chance| !frame.conflict.contains(chance));
        let mut new = Vec::new();
        for &chance in blamed.chain(others) {
            if left.is_empty() {
                break;
            }
            if let After::Left(range) = self.chances.after(step, chance) {
                let before = left.len();
                for chance in self.chances.left(range) {
                    left.remove(chance);
                }
                if left.len() < before {
                    new.push(chance);
                }
            }
        }
        frame.conflict.extend(new);
    }

    /// A nogood that a belief includes.
    fn known_nogood(&mut self, time: u32, lead: LeadIx, belief: &Set) -> Option<Set> {
        let nogoods = self.nogoods.get(&(time, lead))?;
        self.stamp += 1;
        for &chance in belief {
            stamped(&mut self.stamps, chance, self.stamp);
        }
        let (stamps, stamp) = (&self.stamps, self.stamp);
        let included = |nogood: &&Set| nogood.iter().all(|&c| stamps.get(c as usize) == Some(&stamp));
        nogoods.iter().rev().find(included).cloned()
    }

    /// The runs of the leading paths along the moves tried last, and on to where they are read.
    fn found(&self, stack: &[Frame<N>], last: LeadIx) -> Belief<Vec<Run>> {
        let task = &self.chances.question().arena.task;
        let first = stack.first().map_or(last, |frame| frame.lead);
        let runs = (0..self.chances.leading()).map(|at| {
            let path = self.chances.question().paths[at];
            let graph = &self.chances.question().arena.graphs[path];
            let mut letters: Vec<_> =
                stack.iter().map(|frame| frame.steps[frame.next].step.letters[at]).collect();
            let horizon = task.horizon(path) as usize;
            let mut here = self.chances.states(last)[at];
            while letters.len() < horizon {
                let time = letters.len() as u32 + 1;
                let mut all = graph.successors(here).iter();
                let &(letter, next) = all.find(|&&(_, next)| task.lasts(graph, next, time))?;
                letters.push(letter);
                here = next;
            }
            letters.truncate(horizon);
            Run::replay(graph, self.chances.states(first)[at], letters)
        });
        runs.collect::<Option<Vec<Run>>>().map_or(Belief::Open, Belief::Found)
    }
}

/// Marks a chance as one of the present set; whether it was not before.
fn stamped(stamps: &mut Vec<u32>, chance: ChanceIx, stamp: u32) -> bool {
    let at = chance as usize;
    if stamps.len() <= at {
        stamps.resize(at + 1, 0);
    }
    std::mem::replace(&mut stamps[at], stamp) != stamp
}
