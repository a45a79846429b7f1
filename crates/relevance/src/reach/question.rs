//! What is asked about one path, or about two at once.

use crate::ceiling::Ceiling;
use crate::goal::Goal;
use crate::layers::Layers;
use crate::task::Arena;
use hyperplan_problem::{ActionId, PathId};
use hyperplan_space::{Run, StateIx};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// A question about one path, or about two at once.
#[derive(Clone, Copy)]
pub(crate) struct Question<'a, const N: usize> {
    /// The task, and the states of its systems.
    pub(crate) arena: &'a Arena<'a>,
    /// The paths explored.
    pub(crate) paths: [PathId; N],
    /// Where they may be, if that is known already.
    pub(crate) within: [Option<&'a Layers>; N],
    /// What their player wants.
    pub(crate) goal: &'a Goal,
    /// The paths whose states and actions are known, by path variable.
    pub(crate) fixed: &'a [Option<Run>],
    /// The paths of which it is known where they can be.
    pub(crate) declared: &'a FxHashMap<PathId, Arc<Layers>>,
    /// How much later than the earliest run a run may owe nothing but safety.
    pub(crate) slack: Option<u32>,
    /// A time before which no choice of the paths does that, if one is known.
    pub(crate) least: u32,
    /// Whether one run is enough, of those that are there first.
    pub(crate) one_run: bool,
    /// What the paths may cost: the one run is then a cheapest.
    pub(crate) ceiling: Option<&'a Ceiling>,
    /// Joint states, over all times, beyond which to give up.
    pub(crate) budget: usize,
}

impl<'a, const N: usize> Question<'a, N> {
    /// The same question about another choice of paths.
    pub(crate) fn about<const M: usize>(&self, paths: [PathId; M]) -> Question<'a, M> {
        let Question { arena, goal, fixed, declared, slack, least, one_run, budget, .. } = *self;
        let within = [None; M];
        let ceiling = None;
        Question { arena, paths, within, goal, fixed, declared, slack, least, one_run, ceiling, budget }
    }
}

/// The state of one explored path and the action that led there.
pub(crate) type Place = (StateIx, Option<ActionId>);

/// What was found out about some paths.
#[derive(Clone, Debug)]
pub(crate) struct Explored<const N: usize> {
    /// Where each can matter.
    pub(crate) layers: [Layers; N],
    /// Whether runs were lost that the goal does not exclude.
    pub(crate) lossy: bool,
}
