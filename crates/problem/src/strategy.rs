//! Paths as found or given: what a strategy consists of.

use crate::expr::State;
use crate::ids::{ActionId, PathId};

/// A finite path: `states.len() == actions.len() + 1`, and `actions[t]` leads from `states[t]` to `states[t + 1]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trace {
    /// The path variable that it stands for.
    pub path: PathId,
    /// The states, from time 0.
    pub states: Vec<State>,
    /// The actions between them.
    pub actions: Vec<ActionId>,
}

/// One trace for each path variable of an objective's leading block, in order: a plan for a realizable objective
/// that begins with `exists`, a counterexample for an unrealizable one that begins with `forall`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Strategy {
    /// The traces.
    pub traces: Vec<Trace>,
}
