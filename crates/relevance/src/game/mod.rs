//! The game of two tied paths.
//!
//! Let `p` be all of the leading block and `q` all of the other, and let the formula tie them step by step (the same
//! action, the same state). A *node* at a time is what is left of the goal of `q`'s player, a state of `p` and one of
//! `q`; as there are no other paths, every atom is known there. The nodes that some two runs can be in are explored,
//! with `p` kept to its layers.
//!
//! *Losing.* A node is losing if `q` has met its goal there, or if for every move that `p` may make `q` has an answer
//! that leads to a losing node. Were `p` allowed to see what `q` does, it would still be defeated from there. So a
//! run of `p` that wins against every `q` goes through no losing node together with any `q`.
//!
//! *Certain.* A node with the state `s` of `p` is certain if every run of `p` into `s` has a run of `q` with which it
//! is there: all nodes at the start are, and after it those that are answers to a move from certain nodes, whatever
//! state and move led to `s`. So `p` must not make a move in `s` to which `q` has an answer from a certain node to a losing
//! one. Such moves are *closed*, and states without an open move are given up. With fewer moves more nodes are losing
//! and more are certain, so this is repeated until nothing changes.
//!
//! What remains of `p` are the states and moves that a winning run can have, and they serve as its layers, like those of
//! [`crate::reach`], if `p` is declared for its player's whole goal. Where all runs of `q` are followed
//! (a sweep), `p` is told for each other node which moves have an answer to a losing node. Runs of `q` are then
//! followed only through nodes that are not losing, as others are not entered, and from which `q`, with the help of `p`,
//! can still come to one: none is reached from the others, whatever happens.
//!
//! *Slack.* The value of a node is the time by which `p`, seeing what `q` does, can have made sure that `q` fails. With
//! slack, nodes whose value is more than that later than the value at the start count as losing. That loses solutions,
//! as it does in [`crate::reach`].

mod explore;
mod play;
#[cfg(test)]
mod tests;

use crate::goal::Goal;
use crate::layers::Layers;
use crate::reach::Question;
use crate::residual::Residuals;
use explore::Stage;
pub use explore::{MAX_RESIDUALS, Pair, Turn};
use hyperplan_problem::PathId;
use hyperplan_space::StateIx;
use rustc_hash::FxHashSet;

/// A game that was played.
#[derive(Debug)]
pub struct Game {
    /// The path of the leading block and that of the other.
    pub paths: [PathId; 2],
    /// What the other player wants.
    pub goal: Goal,
    /// The residuals of that goal, for all atoms of the formula in their order.
    pub residuals: Residuals,
    /// The times that a path is read at.
    horizons: [u32; 2],
    /// Whether slack lost runs.
    pub lossy: bool,
    stages: Vec<Stage>,
}

/// A losing move: it defeats the leading path where a run of the other may be in a node with it.
pub struct LosingMove {
    /// Where the leading path is.
    pub state: StateIx,
    /// Where the other may be; wherever it is, if there is none.
    pub pair: Option<Pair>,
    /// What the leading path must not do then.
    pub turn: Turn,
}

impl Game {
    /// Explores and plays the game of a question about the leading path and the other, whose goal is that of the
    /// other's player. `None` where there are atoms or nodes beyond the budgets.
    pub(crate) fn new(question: &Question<'_, 2>) -> Option<Game> {
        let (mut stages, residuals) = explore::stages(question)?;
        let lossy = play::play(&mut stages, question.slack);
        Some(Game {
            paths: question.paths,
            goal: question.goal.clone(),
            residuals,
            horizons: question.paths.map(|path| question.arena.task.horizon(path)),
            lossy,
            stages,
        })
    }

    /// The time by which the leading path can have won if it sees what the other does; `None` if it cannot.
    #[cfg(test)]
    fn value(&self) -> Option<u32> {
        play::value(&self.stages)
    }

    /// What can matter of the leading path.
    pub fn layers(&self) -> Layers {
        let times = self.stages.iter().take(self.horizons[0] as usize + 1);
        Layers { at: times.map(|stage| stage.living().map(|s| stage.states[s]).collect()).collect() }
    }

    /// What can matter of the other path to where [`Game::losing_moves`] are ruled out.
    pub fn other_layers(&self) -> Layers {
        let states = |stage: &Stage| {
            let mut states: Vec<StateIx> = stage.open_nodes().map(|n| stage.nodes[n].other).collect();
            states.sort_unstable();
            states.dedup();
            states
        };
        Layers { at: self.stages.iter().take(self.horizons[1] as usize + 1).map(states).collect() }
    }

    /// The pairs that matter at a time.
    pub fn pairs(&self, time: u32) -> FxHashSet<Pair> {
        let stage = &self.stages[time as usize];
        stage.open_nodes().map(|n| stage.nodes[n].pair()).collect()
    }

    /// What the leading path must not do at a time, whatever the other does.
    pub fn closed(&self, time: u32) -> Vec<LosingMove> {
        let Some(next) = self.stages.get(time as usize + 1) else { return Vec::new() };
        let stage = &self.stages[time as usize];
        let mut found = Vec::new();
        for state in stage.living() {
            for turn in stage.turns(state) {
                if !turn.open && next.alive[turn.to as usize] {
                    found.push(LosingMove { state: stage.states[state], pair: None, turn: *turn });
                }
            }
        }
        found
    }

    /// What the leading path must not do at a time where the other may be in a node.
    pub fn losing_moves(&self, time: u32) -> Vec<LosingMove> {
        let Some(next) = self.stages.get(time as usize + 1) else { return Vec::new() };
        let stage = &self.stages[time as usize];
        let mut found = Vec::new();
        for at in stage.open_nodes() {
            let node = &stage.nodes[at];
            for (k, turn) in stage.turns(node.state as usize).iter().enumerate() {
                if turn.open && stage.answers(at, k).iter().any(|&a| next.loses(a)) {
                    let state = stage.states[node.state as usize];
                    found.push(LosingMove { state, pair: Some(node.pair()), turn: *turn });
                }
            }
        }
        found
    }
}
