//! Cases of the leading block, for searches side by side (cube and conquer: Heule, Kullmann, Wieringa and Biere 2011): where some
//! of its paths are at some times.
//!
//! A case takes states out of where a path can be, as what a goal asks for does, so that all searches go on as they would: nothing
//! is added to the formula. Every run that can matter is in some case, since at each time it is in one state. What is found in a case
//! is right without it.
//!
//! The cuts are chosen by lookahead. A case is as heavy as there are states that can matter over time, of all paths of the block. The
//! heaviest is cut in two, at the start or at one of a few times on the way of one of its paths, by which of two states that are far apart is
//! nearer; of these cuts that one which takes most from both halves.

use crate::goal::Goal;
use crate::layers::Layers;
use crate::reach::{self, Explored};
use crate::relevant::{Relevance, Relevant};
use crate::task::{Arena, Error};
use hyperplan_problem::PathId;
use hyperplan_space::{Graph, StateIx, sources};

/// Where some paths of the leading block are at some times; without any, all of their runs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cube(Vec<Cut>);

/// That a path is in one of these states at a time.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Cut {
    path: PathId,
    time: u32,
    /// Sorted.
    states: Vec<StateIx>,
}

impl Cube {
    /// Whether nothing is left out.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.0.is_empty()
    }

    /// What it says of a path: at which times it is in which states, sorted.
    pub fn of(&self, path: PathId) -> impl Iterator<Item = (u32, &[StateIx])> {
        self.0.iter().filter(move |cut| cut.path == path).map(|cut| (cut.time, &*cut.states))
    }

    fn with(&self, path: PathId, time: u32, states: Vec<StateIx>) -> Cube {
        let mut cuts = self.0.clone();
        cuts.push(Cut { path, time, states });
        Cube(cuts)
    }
}

/// Places on the way of a path at which it may be cut, besides its start.
const PLACES: usize = 8;

/// So many cases, or fewer where no more can be made, that together have all runs of the leading block that can matter for its player
/// to reach the goal.
///
/// # Errors
/// [`Error::TooLarge`] where too much can matter, and [`Error::Interrupted`].
pub fn cubes(arena: &Arena<'_>, block: &[PathId], goal: &Goal, number: usize) -> Result<Vec<Cube>, Error> {
    let mut all = vec![Piece::new(arena, block, goal, Cube::default())?];
    let mut whole = Vec::new();
    while whole.len() + all.len() < number {
        arena.task.go_on()?;
        // Of equally heavy ones the first.
        let heaviest = (0..all.len()).rev().max_by_key(|&at| all[at].weight());
        let Some(piece) = heaviest.map(|at| all.remove(at)) else { break };
        match piece.cut(arena, block) {
            Some(halves) => {
                for half in halves {
                    all.push(Piece::new(arena, block, goal, half)?);
                }
            }
            None => whole.push(piece),
        }
    }
    Ok(whole.into_iter().chain(all).map(|piece| piece.cube).collect())
}

/// A case, and where each path of the block can be in it.
struct Piece {
    cube: Cube,
    layers: Vec<Layers>,
}

/// The states of some layers.
fn weight(layers: &Layers) -> usize {
    layers.at.iter().map(Vec::len).sum()
}

impl Piece {
    fn new(arena: &Arena<'_>, block: &[PathId], goal: &Goal, cube: Cube) -> Result<Piece, Error> {
        let arena = Arena { cube: cube.clone(), ..arena.clone() };
        let nothing = Relevant::default();
        let relevance = Relevance::new(&arena, vec![None; arena.graphs.len()], nothing);
        let unpruned = Goal::nothing();
        let goal = if arena.task.limits.prune { goal } else { &unpruned };
        let layers = |&path: &PathId| {
            let found = reach::layers(&relevance.question([path], goal, &relevance.fixed));
            found.map(|Explored { layers: [layers], .. }| layers)
        };
        let layers = block.iter().map(layers).collect::<Result<_, _>>()?;
        Ok(Piece { cube, layers })
    }

    fn weight(&self) -> usize {
        self.layers.iter().map(weight).sum()
    }

    /// The best cut, if there is one.
    fn cut(&self, arena: &Arena<'_>, block: &[PathId]) -> Option<[Cube; 2]> {
        let mut best: Option<(u128, [Cube; 2])> = None;
        for (&path, layers) in block.iter().zip(&self.layers) {
            let graph = &arena.graphs[path];
            let end = layers.at.len().saturating_sub(1);
            let mut times: Vec<usize> = (0..=PLACES).map(|place| place * end / PLACES).collect();
            times.dedup();
            for time in times.into_iter().filter(|&time| layers.at[time].len() > 1) {
                let halves = halves(graph, &layers.at[time]);
                let left = halves.each_ref().map(|half| weight(&through(graph, layers, time, half)));
                let less = left.map(|left| (weight(layers) - left.min(weight(layers))) as u128 + 1);
                let gain = less[0] * less[1];
                if best.as_ref().is_none_or(|(most, _)| gain > *most) {
                    let time = time as u32;
                    best = Some((gain, halves.map(|half| self.cube.with(path, time, half))));
                }
            }
        }
        best.map(|(_, halves)| halves)
    }
}

/// Several states in two halves, by how far they are from one that is far from others, in steps either way.
fn halves(graph: &Graph, states: &[StateIx]) -> [Vec<StateIx>; 2] {
    let around = Around::new(graph);
    let first = around.far(states[0]);
    let corner = states.iter().copied().max_by_key(|&state| first[state as usize]).unwrap_or(states[0]);
    let far = around.far(corner);
    let mut near = states.to_vec();
    near.sort_unstable_by_key(|&state| (far[state as usize], state));
    let mut rest = near.split_off(states.len() / 2);
    near.sort_unstable();
    rest.sort_unstable();
    [near, rest]
}

/// The edges of a graph, either way.
struct Around<'g> {
    graph: &'g Graph,
    starts: Vec<u32>,
    sources: Vec<u32>,
}

impl<'g> Around<'g> {
    fn new(graph: &'g Graph) -> Self {
        let of = |from: StateIx| graph.successors(from).iter().map(move |&(_, to)| (from, to));
        let edges = (0..graph.len() as StateIx).flat_map(of);
        let (starts, sources) = sources(graph.len(), edges);
        Around { graph, starts, sources }
    }

    /// How many edges each state is from one.
    fn far(&self, from: StateIx) -> Vec<u32> {
        let mut far = vec![u32::MAX; self.graph.len()];
        far[from as usize] = 0;
        let mut now = vec![from];
        let mut distance = 0;
        while !now.is_empty() {
            distance += 1;
            let mut next = Vec::new();
            for state in now {
                let at = state as usize;
                let before = &self.sources[self.starts[at] as usize..self.starts[at + 1] as usize];
                let after = self.graph.successors(state).iter().map(|&(_, to)| to);
                for other in before.iter().copied().chain(after) {
                    if far[other as usize] == u32::MAX {
                        far[other as usize] = distance;
                        next.push(other);
                    }
                }
            }
            now = next;
        }
        far
    }
}

/// What is left of layers where a path is in one of these states at a time.
fn through(graph: &Graph, layers: &Layers, time: usize, states: &[StateIx]) -> Layers {
    let mut at = layers.at.clone();
    at[time] = states.to_vec();
    let mut marks = vec![false; graph.len()];
    for later in time + 1..at.len() {
        let (before, after) = at.split_at_mut(later);
        let reached = before[later - 1].iter().flat_map(|&state| graph.successors(state));
        reached.for_each(|&(_, to)| marks[to as usize] = true);
        after[0].retain(|&state| marks[state as usize]);
        marks.fill(false);
    }
    for earlier in (0..time).rev() {
        let (before, after) = at.split_at_mut(earlier + 1);
        after[0].iter().for_each(|&state| marks[state as usize] = true);
        before[earlier].retain(|&state| graph.successors(state).iter().any(|&(_, to)| marks[to as usize]));
        marks.fill(false);
    }
    Layers { at }
}
