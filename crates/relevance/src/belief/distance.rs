//! How far it is until nothing more can be asked for: which of two beliefs is nearer to being empty.
//!
//! The number is a guess, by which beliefs are tried in order; nothing is dropped for it. It is the number of steps to where
//! the residual is `true` if the paths in question could do as they please, without deadlines, and without any atom that
//! reads other paths ever coming to help: such an atom's literals count as false.

use super::joint::{Numbers, States, joint};
use crate::reach::{Place, Product};
use crate::residual::{FALSE, Residual, TRUE};
use hyperplan_space::{Letter, StateIx};
use rustc_hash::{FxHashMap, FxHashSet};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

/// Steps that are looked at for guesses, in all.
const MOST_STEPS: usize = 1_000_000;

/// Relaxed residuals beyond which there is no guess: without deadlines there is no end to them.
const MOST_RESIDUALS: usize = 64;

/// The number of steps where there is no way.
const NEVER: u32 = u32::MAX;

/// States of the paths in question, with what is left there, relaxed.
type Node<const N: usize> = (States<N>, Residual);

/// Distances of one player's paths.
pub(super) struct Distances<const N: usize> {
    paths: Range<usize>,
    /// The atoms that read other paths.
    others: u64,
    nodes: Numbers<Node<N>>,
    /// By node.
    steps: Vec<u32>,
    relaxed: FxHashMap<Residual, Residual>,
    /// Those that nodes have.
    residuals: FxHashSet<Residual>,
    looked: usize,
}

impl<const N: usize> Distances<N> {
    pub(super) fn new(product: &Product<'_, N>, paths: Range<usize>) -> Self {
        Distances {
            others: product.reading_beside(&paths),
            paths,
            nodes: Numbers::new(),
            steps: Vec::new(),
            relaxed: FxHashMap::default(),
            residuals: FxHashSet::default(),
            looked: 0,
        }
    }

    /// The number of steps from these states with what is left, if there is a way.
    pub(super) fn of(
        &mut self,
        product: &mut Product<'_, N>,
        states: States<N>,
        left: Residual,
    ) -> Option<u32> {
        let others = self.others;
        let relaxed = *self.relaxed.entry(left).or_insert_with(|| {
            let relaxed = product.residuals.relax(left, None);
            product.residuals.without(relaxed, others)
        });
        if !self.admits(relaxed) {
            return None;
        }
        let node = self.nodes.of((states, relaxed)) as usize;
        if node >= self.steps.len() {
            self.explore(product);
        }
        Some(self.steps[node]).filter(|&steps| steps != NEVER)
    }

    fn admits(&mut self, relaxed: Residual) -> bool {
        if relaxed != FALSE && self.residuals.len() < MOST_RESIDUALS {
            self.residuals.insert(relaxed);
        }
        self.residuals.contains(&relaxed)
    }

    /// All that can be reached from the newest node, and how far each is.
    fn explore(&mut self, product: &mut Product<'_, N>) {
        let first = self.steps.len();
        let mut back: Vec<(u32, u32)> = Vec::new();
        while self.steps.len() < self.nodes.len() {
            let at = self.steps.len() as u32;
            let (states, before) = self.nodes.get(at);
            self.steps.push(if before == TRUE { 0 } else { NEVER });
            if before == TRUE || self.looked > MOST_STEPS {
                continue;
            }
            let moves =
                joint(self.paths.clone(), |path| product.graphs[path].successors(states[path]).to_vec());
            self.looked += moves.len();
            for step in moves {
                let after = self.after(product, before, &step);
                if self.admits(after) {
                    let to = self.nodes.of((step.map(|s| s.1), after));
                    back.push((to, at));
                }
            }
        }
        self.measure(first, back);
    }

    fn after(
        &self,
        product: &mut Product<'_, N>,
        before: Residual,
        step: &[(Letter, StateIx); N],
    ) -> Residual {
        let place = |at: usize| -> Place {
            let (letter, to) = step[at];
            (to, self.paths.contains(&at).then(|| product.graphs[at].letters[letter as usize].0))
        };
        let places = std::array::from_fn(place);
        let bits = product.own_bits(&places);
        product.relaxed(before, bits)
    }

    /// Distances of the nodes from `first` on, whose steps are these, each from its end to its beginning.
    fn measure(&mut self, first: usize, mut back: Vec<(u32, u32)>) {
        back.sort_unstable();
        let mut queue: BinaryHeap<Reverse<(u32, u32)>> = BinaryHeap::new();
        // What was known before has no steps to what is new.
        let known = |&to: &u32| (to as usize) < first || self.steps[to as usize] == 0;
        let ends: Vec<u32> = back.iter().map(|edge| edge.0).filter(known).collect();
        queue.extend(ends.into_iter().map(|to| Reverse((self.steps[to as usize], to))));
        while let Some(Reverse((steps, to))) = queue.pop() {
            if steps == NEVER || steps > self.steps[to as usize] {
                continue;
            }
            let from = back.partition_point(|edge| edge.0 < to);
            for &(_, at) in back[from..].iter().take_while(|edge| edge.0 == to) {
                if steps + 1 < self.steps[at as usize] {
                    self.steps[at as usize] = steps + 1;
                    queue.push(Reverse((steps + 1, at)));
                }
            }
        }
    }
}
