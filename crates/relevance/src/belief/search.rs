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

pub(super) struct Search<'s, 'a, const N: usize> {
    chances: &'s mut Chances<'a, N>,
    budget: usize,
    nogoods: FxHashMap<(u32, LeadIx), Vec<Set>>,
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

impl<'s, 'a, const N: usize> Search<'s, 'a, N> {
    /// A search that ends when more than `budget` chances were looked at in all.
    pub(super) fn new(chances: &'s mut Chances<'a, N>, budget: usize) -> Self {
        Search { chances, budget, nogoods: FxHashMap::default() }
    }

    pub(super) fn run(mut self) -> Result<Belief<Vec<Run>>, Error> {
        let Some(starts) = self.chances.starts(self.budget)? else { return Ok(Belief::Open) };
        for (lead, belief) in starts {
            if let Some(answer) = self.from(lead, belief)? {
                return Ok(answer);
            }
        }
        Ok(Belief::Hopeless)
    }

    /// What comes of a start; `None` where it loses.
    fn from(&mut self, lead: LeadIx, belief: Set) -> Result<Option<Belief<Vec<Run>>>, Error> {
        if self.chances.is_won(lead, &belief) {
            return Ok(Some(self.chances.found(lead, &[], lead)));
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
            if self.chances.is_won(step.to, &belief) {
                let steps: Vec<_> = stack.iter().map(|frame| frame.steps[frame.next].step).collect();
                return Ok(Some(self.chances.found(lead, &steps, step.to)));
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

    /// The moves of a belief at a time, those that leave least first; `None` beyond the budget.
    fn frame(&mut self, lead: LeadIx, mut belief: Set, time: u32) -> Result<Option<Frame<N>>, Error> {
        // Those known longest are blamed first.
        belief.sort_unstable();
        let mut frame = Frame { lead, belief, steps: Vec::new(), next: 0, conflict: BTreeSet::new() };
        for step in self.chances.lead_steps(lead, time + 1) {
            match self.chances.after_all(step, &frame.belief) {
                Ok(belief) => frame.steps.push(Tried { step, belief }),
                Err(lost) => {
                    frame.conflict.insert(lost);
                }
            }
        }
        frame.steps.sort_by_key(|tried| tried.belief.len());
        self.chances.go_on()?;
        Ok((self.chances.work <= self.budget).then_some(frame))
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
        let among = self.chances.marked(belief);
        let included = |nogood: &&Set| nogood.iter().all(|&chance| among(chance));
        nogoods.iter().rev().find(included).cloned()
    }
}
