//! Breadth first over beliefs, keeping the most promising at each time: a beam search.
//!
//! It finds a strategy soon where there are many; that it finds none means something only if nothing was left out. What is
//! promising is that no chance is left that is far from being gone, and few of those that are farthest
//! ([`Chances::urgency`]). How much time is left plays no part in that, so what is found does not owe its steps to a
//! horizon that is generous.

use super::Belief;
use super::chances::{ChanceIx, Chances, LeadIx, LeadStep};
use crate::task::Error;
use hyperplan_space::Run;
use rustc_hash::FxHashSet;

/// A belief that is kept, or may be.
struct Node<const N: usize> {
    lead: LeadIx,
    belief: Vec<ChanceIx>,
    urgency: f64,
    from: Option<Origin<N>>,
}

/// The node of the time before that another comes from, and by which step.
#[derive(Clone, Copy)]
struct Origin<const N: usize> {
    at: usize,
    step: LeadStep<N>,
}

/// The nodes of one time, as far as they have to be known in the end.
type Trail<const N: usize> = Vec<(LeadIx, Option<Origin<N>>)>;

/// Searches with at most `width` beliefs at a time, until more than `budget` chances were looked at in all.
pub(super) fn search<const N: usize>(
    chances: &mut Chances<'_, N>,
    width: usize,
    budget: usize,
) -> Result<Belief<Vec<Run>>, Error> {
    let mut layer = Vec::new();
    let Some(starts) = chances.starts(budget)? else { return Ok(Belief::Open) };
    for (lead, belief) in starts {
        if chances.is_won(lead, &belief) {
            return Ok(chances.found(lead, &[], lead));
        }
        let urgency = chances.urgency(lead, &belief);
        layer.push(Node { lead, belief, urgency, from: None });
    }
    let mut trails: Vec<Trail<N>> = Vec::new();
    let mut complete = true;
    while !layer.is_empty() {
        complete &= keep_best(&mut layer, width);
        trails.push(layer.iter().map(|node| (node.lead, node.from)).collect());
        let time = trails.len() as u32;
        if time > chances.end {
            return Ok(Belief::Open);
        }
        let mut next = Vec::new();
        let mut seen: FxHashSet<(LeadIx, Vec<ChanceIx>)> = FxHashSet::default();
        for (at, node) in layer.iter().enumerate() {
            for step in chances.lead_steps(node.lead, time) {
                let Ok(mut belief) = chances.after_all(step, &node.belief) else { continue };
                let origin = Origin { at, step };
                if chances.is_won(step.to, &belief) {
                    let (first, steps) = along(&trails, origin);
                    return Ok(chances.found(first, &steps, step.to));
                }
                belief.sort_unstable();
                if seen.insert((step.to, belief.clone())) {
                    let urgency = chances.urgency(step.to, &belief);
                    next.push(Node { lead: step.to, belief, urgency, from: Some(origin) });
                }
            }
            chances.go_on()?;
            if chances.work > budget {
                return Ok(Belief::Open);
            }
        }
        layer = next;
    }
    Ok(if complete { Belief::Hopeless } else { Belief::Open })
}

/// Drops all but the most promising; whether that is all.
fn keep_best<const N: usize>(layer: &mut Vec<Node<N>>, width: usize) -> bool {
    // Sorting keeps the order of equals, so that the choice is the same on every machine.
    layer.sort_by(|a, b| a.urgency.total_cmp(&b.urgency));
    let all = layer.len() <= width;
    layer.truncate(width);
    all
}

/// The steps that lead to where this one does, and where they begin.
fn along<const N: usize>(trails: &[Trail<N>], last: Origin<N>) -> (LeadIx, Vec<LeadStep<N>>) {
    let mut steps = vec![last.step];
    let mut at = last.at;
    let mut first = 0;
    for trail in trails.iter().rev() {
        let (lead, from) = trail[at];
        first = lead;
        if let Some(origin) = from {
            steps.push(origin.step);
            at = origin.at;
        }
    }
    steps.reverse();
    (first, steps)
}
