//! How the leading block is cut into cases: by lookahead.
//!
//! A case is as heavy as there are states that can matter over time, of all paths of the block. It is cut in two, at the start or at
//! one of a few times on the way of one of its paths, by which of two states that are far apart is nearer; of these cuts that one which
//! takes most from both halves. Each half is cut into as many cases as it is heavy. So that many can each have one case, the way to
//! one is as many cuts as it takes to halve their number, not all of them.

use crate::cube::{Case, Cube};
use crate::goal::Goal;
use crate::layers::Layers;
use crate::reach::{self, Explored};
use crate::relevant::{Relevance, Relevant};
use crate::task::{Arena, Error};
use hyperplan_problem::PathId;
use hyperplan_space::{Graph, StateIx, sources};

/// Places on the way of a path at which it may be cut, besides its start.
const PLACES: usize = 8;

/// One of so many cases, by its number from 0, that together have all runs of the leading block that can matter for its player to reach
/// the goal.
///
/// # Errors
/// [`Error::TooLarge`] where too much can matter, and [`Error::Interrupted`].
pub fn case(
    arena: &Arena<'_>,
    block: &[PathId],
    goal: &Goal,
    (mut index, mut number): (usize, usize),
) -> Result<Case, Error> {
    let mut piece = Piece::whole(arena, block, goal)?;
    let mut is_whole = true;
    while number > 1 {
        arena.task.go_on()?;
        let Some([near, far]) = piece.cut(arena, block) else {
            return Ok(match index {
                _ if is_whole => Case::Whole,
                0 => Case::Of(piece.cube),
                _ => Case::Empty,
            });
        };
        let (weight, all) = (near.weight() as u128, (near.weight() + far.weight()).max(1) as u128);
        let own = (number as u128 * weight / all).clamp(1, number as u128 - 1) as usize;
        (piece, index, number) =
            if index < own { (near, index, own) } else { (far, index - own, number - own) };
        is_whole = false;
    }
    Ok(if is_whole { Case::Whole } else { Case::Of(piece.cube) })
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
    fn whole(arena: &Arena<'_>, block: &[PathId], goal: &Goal) -> Result<Piece, Error> {
        let relevance = Relevance::new(arena, vec![None; arena.graphs.len()], Relevant::default());
        let unpruned = Goal::nothing();
        let goal = if arena.task.limits.prunes() { goal } else { &unpruned };
        let layers = |&path: &PathId| {
            let found = reach::layers(&relevance.question([path], goal, &relevance.fixed));
            found.map(|Explored { layers: [layers], .. }| layers)
        };
        let layers = block.iter().map(layers).collect::<Result<_, _>>()?;
        Ok(Piece { cube: Cube::default(), layers })
    }

    fn weight(&self) -> usize {
        self.layers.iter().map(weight).sum()
    }

    /// The halves of the best cut, if there is one.
    fn cut(&self, arena: &Arena<'_>, block: &[PathId]) -> Option<[Piece; 2]> {
        let mut best: Option<(u128, [Piece; 2])> = None;
        for (at, (&path, layers)) in block.iter().zip(&self.layers).enumerate() {
            let graph = &arena.graphs[path];
            let around = Around::new(graph);
            let end = layers.at.len().saturating_sub(1);
            let mut times: Vec<usize> = (0..=PLACES).map(|place| place * end / PLACES).collect();
            times.dedup();
            for time in times.into_iter().filter(|&time| layers.at[time].len() > 1) {
                let halves = around.halves(&layers.at[time]);
                let left = halves.each_ref().map(|half| through(graph, layers, time, half));
                let less = left.each_ref().map(|left| (weight(layers) - weight(left)) as u128 + 1);
                let gain = less[0] * less[1];
                if best.as_ref().is_none_or(|(most, _)| gain > *most) {
                    let [near, far] = halves.map(|half| self.cube.with(path, time as u32, half));
                    let [first, second] = left.map(|left| {
                        let mut layers = self.layers.clone();
                        layers[at] = left;
                        layers
                    });
                    let halves = [Piece { cube: near, layers: first }, Piece { cube: far, layers: second }];
                    best = Some((gain, halves));
                }
            }
        }
        best.map(|(_, halves)| halves)
    }
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

    /// Several states in two halves, by how far they are from one that is far from others.
    fn halves(&self, states: &[StateIx]) -> [Vec<StateIx>; 2] {
        let first = self.far(states[0]);
        let corner = states.iter().copied().max_by_key(|&state| first[state as usize]).unwrap_or(states[0]);
        let far = self.far(corner);
        let mut near = states.to_vec();
        near.sort_unstable_by_key(|&state| (far[state as usize], state));
        let mut rest = near.split_off(states.len() / 2);
        near.sort_unstable();
        rest.sort_unstable();
        [near, rest]
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
