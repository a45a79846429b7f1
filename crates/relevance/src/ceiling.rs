//! Bounds on what paths of the leading block cost together, and what they exclude.
//!
//! A run through layers that is at a state at some time has cost at least what the cheapest way there does, and will cost at
//! least what the cheapest way on does. Where the two are too much, the state cannot matter. What is left to pay from each
//! state, at least, is its *rest*; by how much a step costs more than the rest falls is its *surplus*. Rests are those of
//! the layers at hand, so that no surplus is negative; and the surpluses of a run add up to what it costs more than the
//! cheapest one does. So a bound on costs is one on surpluses, which are few and small where the bound is near.

use crate::layers::Layers;
use hyperplan_problem::{PathId, System, Target};
use hyperplan_space::{Graph, StateIx, step_costs};
use std::sync::Arc;
use typed_index_collections::TiVec;

/// A cost that no run has: there is no way on.
pub const NO_WAY: i64 = i64::MAX / 4;

/// A bound on a sum of costs.
#[derive(Clone, Debug)]
pub struct Ceiling {
    /// The sum is at most this.
    pub most: i64,
    /// For each path that the sum speaks of what its transitions count, in the order of its graph.
    pub weights: Vec<(PathId, Arc<[i64]>)>,
}

impl Ceiling {
    /// The bound that a target be at most so much.
    #[must_use]
    pub fn new<'s>(
        system_of: impl Fn(PathId) -> &'s System,
        graphs: &TiVec<PathId, Arc<Graph>>,
        target: &Target,
        most: i64,
    ) -> Ceiling {
        let mut weights: Vec<(PathId, Vec<i64>)> = Vec::new();
        for &(factor, path, cost) in &target.terms {
            let system = system_of(path);
            let own = step_costs(system, &graphs[path], &system.costs[cost]);
            let own = own.into_iter().map(|cost| cost.saturating_mul(factor).min(NO_WAY));
            match weights.iter_mut().find(|(known, _)| *known == path) {
                Some((_, sum)) => {
                    sum.iter_mut().zip(own).for_each(|(sum, own)| *sum = (*sum + own).min(NO_WAY));
                }
                None => weights.push((path, own.collect())),
            }
        }
        let most = most.saturating_sub(target.constant);
        Ceiling { most, weights: weights.into_iter().map(|(path, all)| (path, all.into())).collect() }
    }

    /// What the transitions of a path count.
    #[must_use]
    pub fn of(&self, path: PathId) -> Option<&[i64]> {
        self.weights.iter().find(|(known, _)| *known == path).map(|(_, weights)| &**weights)
    }
}

/// The least that is still to be paid from each state of each layer on; [`NO_WAY`] where the last layer is out of reach.
#[must_use]
pub fn rests(graph: &Graph, layers: &[impl AsRef<[StateIx]>], weights: &[i64]) -> Vec<Vec<i64>> {
    let mut rests: Vec<Vec<i64>> = Vec::with_capacity(layers.len());
    for (time, layer) in layers.iter().enumerate().rev() {
        let Some(later) = rests.last() else {
            rests.push(vec![0; layer.as_ref().len()]);
            continue;
        };
        let next = layers[time + 1].as_ref();
        let rest = |&state: &StateIx| {
            let ways = transitions(graph, weights, state).filter_map(|(_, to, weight)| {
                let at = next.binary_search(&to).ok()?;
                Some(weight.saturating_add(later[at]))
            });
            ways.min().unwrap_or(NO_WAY).min(NO_WAY)
        };
        let rest = layer.as_ref().iter().map(rest).collect();
        rests.push(rest);
    }
    rests.reverse();
    rests
}

/// The transitions of a state with what they count: letter, successor, weight.
pub fn transitions<'g>(
    graph: &'g Graph,
    weights: &'g [i64],
    state: StateIx,
) -> impl Iterator<Item = (u32, StateIx, i64)> + 'g {
    let first = graph.first_transition(state);
    graph.successors(state).iter().zip(&weights[first..]).map(|(&(letter, to), &weight)| (letter, to, weight))
}

/// The layers without the states through which every run costs more than the ceiling.
pub(crate) fn lowered(graph: &Graph, mut layers: Layers, weights: &[i64], most: i64) -> Layers {
    let rests = rests(graph, &layers.at, weights);
    let mut paid: Vec<i64> = vec![0; layers.at.first().map_or(0, Vec::len)];
    for (time, rests) in rests.iter().enumerate() {
        let mut onward = vec![NO_WAY; layers.at.get(time + 1).map_or(0, Vec::len)];
        if let Some(next) = layers.at.get(time + 1) {
            for (&state, &paid) in layers.at[time].iter().zip(&paid) {
                for (_, to, weight) in transitions(graph, weights, state) {
                    if let Ok(at) = next.binary_search(&to) {
                        onward[at] = onward[at].min(paid.saturating_add(weight));
                    }
                }
            }
        }
        let mut costs = paid.iter().zip(rests).map(|(paid, rest)| paid.saturating_add(*rest));
        layers.at[time].retain(|_| costs.next().is_some_and(|cost| cost <= most && cost < NO_WAY));
        // What was dropped leads nowhere that is kept.
        paid = onward;
    }
    layers
}
