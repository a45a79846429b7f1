//! Runs in shares of about the same length.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use crate::plan::Run;
use crate::record::{Limit, Record};

/// What a run without any limit is thought to take, in seconds.
const UNLIMITED: f64 = 60.0;
/// What any run takes at least: starting it.
const LEAST: f64 = 0.01;

/// How long each run will probably take, in seconds: as long as the same did before, or any on the same instance, or of
/// the same solver, or all; never longer than it may. Where nothing is known that is what it may take.
#[must_use]
pub fn expected(runs: &[Run], past: &[Record]) -> Vec<f64> {
    let (mut same, mut instances, mut solvers) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
    let mut all = Mean::default();
    for record in past {
        let Record { instance, set, solver, quantifiers, states, .. } = record;
        let way = (quantifiers.as_deref(), states.as_deref());
        for mean in [
            same.entry((instance.as_str(), set.as_slice(), solver.as_str(), way)).or_default(),
            instances.entry((instance.as_str(), set.as_slice())).or_default(),
            solvers.entry(solver.as_str()).or_default(),
            &mut all,
        ] {
            Mean::add(mean, record.wall_s);
        }
    }
    let each = runs.iter().map(|run| {
        let (instance, set) = (run.instance.name.as_str(), run.instance.set.as_slice());
        let solver = run.solver.name.as_str();
        let way = (run.quantifiers.as_deref(), run.states.as_deref());
        let known = same
            .get(&(instance, set, solver, way))
            .or_else(|| instances.get(&(instance, set)))
            .or_else(|| solvers.get(solver))
            .unwrap_or(&all);
        known.value().unwrap_or(f64::INFINITY).min(most(&run.limit)).max(LEAST)
    });
    each.collect()
}

/// What a run may take, in seconds.
#[must_use]
pub fn most(limit: &Limit) -> f64 {
    limit.wall_s.or(limit.cpu_s).unwrap_or(UNLIMITED)
}

#[derive(Clone, Copy, Default)]
struct Mean {
    sum: f64,
    count: f64,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1.0;
    }

    fn value(self) -> Option<f64> {
        (self.count > 0.0).then(|| self.sum / self.count)
    }
}

/// To which share, from 0, each of the runs belongs, given what they probably take: the longest first, each to the share
/// that has least by then (Graham's LPT rule: no share is longer than 4/3 of the best possible longest). The same numbers
/// give the same shares everywhere.
#[must_use]
pub fn shares(seconds: &[f64], shares: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..seconds.len()).collect();
    order.sort_by(|&a, &b| seconds[b].total_cmp(&seconds[a]).then(a.cmp(&b)));
    // In whole microseconds, which are ordered.
    let mut least: BinaryHeap<Reverse<(u64, usize)>> = (0..shares).map(|share| Reverse((0, share))).collect();
    let mut of = vec![0; seconds.len()];
    for run in order {
        let Some(Reverse((taken, share))) = least.pop() else { break };
        of[run] = share;
        least.push(Reverse((taken.saturating_add((seconds[run] * 1e6) as u64), share)));
    }
    of
}
