//! What can matter when: the states that a path can be in at each time.
//!
//! For a path `q` and the goal of its player, the runs of `q` are explored together with the residual that the goal,
//! weakened to what is known of `q` alone, of fixed paths, and of declared ones, leaves to be met
//! ([`crate::residual`]). A state is kept at time `t` only if some run through it at `t` can go on as long as the mode
//! demands and never meets the residual `false`.
//!
//! Soundness. Let `R` be the set of runs kept. If a choice of all paths meets the goal, then the run of `q` in it is
//! in `R`, as the weakened goal is implied. So under `exists q`, with the formula wanted true, no satisfying choice is
//! lost; under `forall q`, with the formula wanted false, no violating choice is lost: for every `q` outside `R` the
//! rest of the formula holds whatever the other paths are. The latter
//! step needs that every other quantifier ranges over at least one path, which `hyperplan-plan` establishes
//! first. Keeping the states of `R` time by time keeps a superset of `R`, which is sound a fortiori.
//! Of a path declared before in the same query it is known that it is in its layers; where an atom over it has the
//! same value in all of a layer's states, that value counts, and the query speaks of no other choices.
//!
//! Two paths that the formula ties step by step (the same action, the same observation) are explored as a pair: what
//! one of them may do then depends on what the other does, and far fewer states remain. The argument is the same, with
//! the runs of one path that some run of the other, within its own layers, goes with.
//!
//! *Slack* keeps only runs that owe nothing but safety at most so many steps after the earliest run does. That loses
//! solutions, so it is used only for paths of the leading block, where what is found is a solution all the same. Where
//! the whole formula reads no other path than those explored, one run is enough.

mod atoms;
mod bound;
mod explore;
#[cfg(test)]
mod tests;

pub(crate) use explore::Exploration;

use crate::explicit::FixedPath;
use crate::goal::Goal;
use crate::graph::{Graph, LIVE, StateIx};
use crate::{Encoder, Error};
use hyperplan_problem::{ActionId, Mode, PathId};
use rustc_hash::FxHashMap;
use std::cell::Cell;
use std::rc::Rc;

/// The states that can matter at each time `0..=horizon`, sorted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layers {
    /// One sorted list of states a time.
    pub at: Vec<Vec<StateIx>>,
}

impl Layers {
    /// Whether a state can matter at a time.
    #[must_use]
    pub fn contains(&self, time: usize, state: StateIx) -> bool {
        self.at[time].binary_search(&state).is_ok()
    }

    /// Whether no run is left.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.at.iter().any(Vec::is_empty)
    }
}

/// A question about one path, or about two at once.
#[derive(Clone, Copy)]
pub(crate) struct Question<'a, const N: usize> {
    pub(crate) encoder: &'a Encoder<'a>,
    /// The paths explored.
    pub(crate) paths: [PathId; N],
    /// Where they may be, if that is known already.
    pub(crate) within: [Option<&'a Layers>; N],
    /// What their player wants.
    pub(crate) goal: &'a Goal,
    /// The paths whose states and actions are known, by path variable.
    pub(crate) fixed: &'a [Option<FixedPath>],
    /// The paths of which it is known where they can be.
    pub(crate) declared: &'a FxHashMap<PathId, Rc<Layers>>,
    /// How much later than the earliest run a run may owe nothing but safety.
    pub(crate) slack: Option<u32>,
    /// A time before which no choice of the paths does that, if one is known.
    pub(crate) least: u32,
    /// Whether one run is enough, of those that are there first.
    pub(crate) one_run: bool,
    /// Set where a run was lost that the goal does not exclude.
    pub(crate) lossy: &'a Cell<bool>,
    /// Joint states, over all times, beyond which to give up.
    pub(crate) budget: usize,
}

impl<'a, const N: usize> Question<'a, N> {
    /// The same question about another choice of paths.
    pub(crate) fn about<const M: usize>(&self, paths: [PathId; M]) -> Question<'a, M> {
        let Question { encoder, goal, fixed, declared, slack, least, one_run, lossy, budget, .. } = *self;
        let within = [None; M];
        Question { encoder, paths, within, goal, fixed, declared, slack, least, one_run, lossy, budget }
    }
}

/// The state of one explored path and the action that led there.
pub(crate) type Place = (StateIx, Option<ActionId>);

/// The states of an explored path that can matter at each time; those of one run, if that is enough and
/// it can be told.
///
/// # Errors
/// [`Error::TooLarge`] beyond the budget.
pub(crate) fn layers(question: &Question<'_, 1>) -> Result<Layers, Error> {
    let mut exploration = Exploration::bounded(question)?;
    let forward = exploration.forward()?;
    let [layers] = exploration.keep(&forward);
    Ok(layers)
}

/// The states of two paths, explored as a pair, that can matter at each time; one run of each, if asked for and there
/// is one.
///
/// # Errors
/// [`Error::TooLarge`] beyond the budget.
pub(crate) fn pair_layers(question: &Question<'_, 2>) -> Result<[Layers; 2], Error> {
    let mut exploration = Exploration::new(question)?;
    let forward = exploration.forward()?;
    Ok(exploration.keep(&forward))
}

/// A time before which no run of an explored path owes nothing but safety.
///
/// # Errors
/// Where states were not enumerated.
pub(crate) fn least(question: &Question<'_, 1>) -> Result<u32, Error> {
    Ok(Exploration::bounded(question)?.least())
}

/// Whether a state allows enough further steps at a time: any number in bounded mode, all that are left under
/// `within`.
pub(crate) fn lasts(mode: Mode, graph: &Graph, state: StateIx, time: u32) -> bool {
    let rank = graph.rank[state as usize];
    match mode {
        Mode::Bounded => rank == LIVE,
        Mode::Within(steps) => rank >= steps.saturating_sub(time),
    }
}
