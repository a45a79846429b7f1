//! How many steps a state is at least from where nothing more is owed.
//!
//! Exploring time by time costs as many steps as there are states that can be reached, times the horizon, although
//! most of them are too far from the goal to matter. So the states are first explored once without time, together
//! with the *relaxed* residual, which has no deadlines ([`Residuals::relax`]). Relaxing only weakens: a run that
//! meets the residual takes at least as many steps as the relaxed one does
//!
//! - to owe nothing but safety, which a run that meets its goal does by the last time that the formula reads;
//! - to where what is left can be met once the settling atoms are known (atoms of other paths that are the same
//!   wherever those paths can be from some time on), which it does before that time. "No faster path than p", say,
//!   leaves those that are near the goal when p is there at the latest.

use super::product::Product;
use super::question::Place;
use crate::residual::{FALSE, Residual, Residuals};
use hyperplan_problem::Mode;
use hyperplan_space::{Graph, LIVE, StateIx, sources};
use rustc_hash::FxHashMap;

/// Relaxed residuals beyond which there is no bound.
const MAX_RESIDUALS: usize = 48;

/// The number of steps where there is no way.
const NEVER: u32 = u32::MAX;

/// Lower bounds for one path.
pub(crate) struct Bound {
    /// From when on the settling atoms are known.
    settled: u32,
    /// The relaxed residuals, and the position of each.
    residuals: Vec<Residual>,
    rows: FxHashMap<Residual, usize>,
    /// Steps to where nothing is owed, and to where the settling atoms do no harm; by residual and state. Zero where
    /// nothing is known.
    steps: Vec<Vec<[u32; 2]>>,
    /// The states that can be reached, each with a row.
    nodes: Vec<Node>,
    /// The rows of residuals met along the exploration, by position after a time. The time matters only before the
    /// settling atoms have settled.
    met: FxHashMap<(Residual, u32), Option<usize>>,
    /// The fewest steps from the start.
    pub(crate) least: u32,
    /// The last time that the formula reads.
    pub(crate) end: u32,
}

/// A state with a row.
type Node = (usize, StateIx);

impl Bound {
    /// `None` where there are too many relaxed residuals.
    pub(crate) fn new(product: &mut Product<'_, 1>) -> Option<Bound> {
        let mut bound = Bound {
            settled: product.atoms.settling.from.unwrap_or(0),
            residuals: Vec::new(),
            rows: FxHashMap::default(),
            steps: Vec::new(),
            nodes: Vec::new(),
            met: FxHashMap::default(),
            least: NEVER,
            end: product.question.arena.task.end(),
        };
        let graph = product.graphs[0];
        let mut search = Search { graph, bound: &mut bound, nodes: Vec::new(), edges: Vec::new() };
        let starts = search.explore(product).ok()?;
        search.measure(&product.residuals);
        let nodes = search.nodes;
        bound.nodes = nodes;
        bound.least =
            starts.iter().map(|&(row, state)| bound.steps[row][state as usize][0]).min().unwrap_or(0);
        Some(bound)
    }

    fn row(&mut self, residual: Residual, states: usize) -> Result<usize, TooMany> {
        let next = self.steps.len();
        let row = *self.rows.entry(residual).or_insert(next);
        if row == next {
            if next >= MAX_RESIDUALS {
                return Err(TooMany);
            }
            self.residuals.push(residual);
            self.steps.push(vec![[0, 0]; states]);
        }
        Ok(row)
    }

    /// The row of what is left after a time, if something is known of it.
    pub(crate) fn met(&mut self, residuals: &mut Residuals, residual: Residual, time: u32) -> Option<usize> {
        let time = time.min(self.settled);
        if let Some(&row) = self.met.get(&(residual, time)) {
            return row;
        }
        let relaxed = residuals.relax(residual, Some(time + 1));
        let row = self.rows.get(&relaxed).copied();
        self.met.insert((residual, time), row);
        row
    }

    /// By state, the first time from which on it cannot matter any more, whatever is left to be met.
    pub(crate) fn until(&self, states: usize) -> Vec<u32> {
        let mut until = vec![0; states];
        for &(row, state) in &self.nodes {
            let last = match self.steps[row][state as usize][0] {
                NEVER => continue,
                0 => u32::MAX,
                owed => (self.end + 1).saturating_sub(owed),
            };
            let known = &mut until[state as usize];
            *known = last.max(*known);
        }
        until
    }

    /// Whether a state with a row can matter at a time, where something more is owed at most up to `last`.
    pub(crate) fn admits(&self, row: usize, state: StateIx, time: u32, last: u32) -> bool {
        let [owed, harmed] = self.steps[row][state as usize];
        let known = self.settled.saturating_sub(1).max(time);
        time.saturating_add(owed) <= last.max(time) && time.saturating_add(harmed) <= known
    }
}

/// There are more residuals than are worth measuring.
struct TooMany;

struct Search<'s> {
    graph: &'s Graph,
    bound: &'s mut Bound,
    nodes: Vec<Node>,
    /// From node to node, by position in `nodes`.
    edges: Vec<(u32, u32)>,
}

impl Search<'_> {
    /// All states with what is left there, relaxed; the initial ones.
    fn explore(&mut self, product: &mut Product<'_, 1>) -> Result<Vec<Node>, TooMany> {
        let relaxed = product.residuals.relax(product.initial, Some(0));
        let mut index: Vec<Vec<u32>> = Vec::new();
        let initial = &self.graph.initial;
        for &state in initial {
            self.enter(product, relaxed, (state, None), &mut index)?;
        }
        let starts = self.nodes.clone();
        let mut at = 0;
        while at < self.nodes.len() {
            let (row, state) = self.nodes[at];
            let before = self.bound.residuals[row];
            for &(letter, next) in self.graph.successors(state) {
                let action = self.graph.letters[letter as usize].0;
                let entered = self.enter(product, before, (next, Some(action)), &mut index)?;
                self.edges.extend(entered.map(|to| (at as u32, to)));
            }
            at += 1;
        }
        Ok(starts)
    }

    /// The node after a place is entered; `None` where it cannot matter.
    fn enter(
        &mut self,
        product: &mut Product<'_, 1>,
        before: Residual,
        place: Place,
        index: &mut Vec<Vec<u32>>,
    ) -> Result<Option<u32>, TooMany> {
        let state = place.0;
        let live = self.graph.rank[state as usize] == LIVE;
        if product.question.arena.task.objective.mode == Mode::Bounded && !live {
            return Ok(None);
        }
        let bits = product.own_bits(&[place]);
        let after = product.relaxed(before, bits);
        if after == FALSE {
            return Ok(None);
        }
        let row = self.bound.row(after, self.graph.len())?;
        if index.len() <= row {
            index.resize(row + 1, vec![u32::MAX; self.graph.len()]);
        }
        let known = &mut index[row][state as usize];
        if *known == u32::MAX {
            *known = self.nodes.len() as u32;
            self.nodes.push((row, state));
        }
        Ok(Some(*known))
    }

    /// Breadth-first searches backwards from where nothing is owed, and from where no harm is done.
    fn measure(&mut self, residuals: &Residuals) {
        let arrived: Vec<[bool; 2]> = (self.bound.residuals.iter())
            .map(|&r| [residuals.owes_nothing(r), residuals.can_hold(r)])
            .collect();
        let (starts, sources) = sources(self.nodes.len(), self.edges.iter().copied());
        for which in 0..2 {
            let mut queue: Vec<u32> = Vec::new();
            for (at, &(row, state)) in self.nodes.iter().enumerate() {
                let arrived = arrived[row][which];
                self.bound.steps[row][state as usize][which] = if arrived { 0 } else { NEVER };
                queue.extend(arrived.then_some(at as u32));
            }
            let mut next = 0;
            while next < queue.len() {
                let to = queue[next] as usize;
                next += 1;
                let steps = self.steps(to, which) + 1;
                for &from in &sources[starts[to] as usize..starts[to + 1] as usize] {
                    if self.steps(from as usize, which) == NEVER {
                        let (row, state) = self.nodes[from as usize];
                        self.bound.steps[row][state as usize][which] = steps;
                        queue.push(from);
                    }
                }
            }
        }
    }

    fn steps(&self, node: usize, which: usize) -> u32 {
        let (row, state) = self.nodes[node];
        self.bound.steps[row][state as usize][which]
    }
}
