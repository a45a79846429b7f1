//! What determines a path: where it starts and how it moves, in terms of other paths where possible.
//!
//! A counterexample is turned into inputs before it becomes an instance. Where the counterexample's action equals
//! that of a path quantified before it, and the objective compares the two, the instance says "the same action as
//! that path, whatever it is": then one instance defeats every candidate with the same weakness.

use hyperplan_problem::{ActionId, PathId};

/// Where a path starts. `S` is how a state is written: its index, or its values.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Start<S> {
    /// In this state.
    State(S),
    /// Where the other path starts.
    Same(PathId),
}

/// One step of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Move {
    /// The same action with the same outcome number as the other path, which another player chooses.
    Same(PathId),
    /// The same action as the other path, with this outcome (the last one, where there are fewer).
    SameAction(PathId, u32),
    /// This action, with this outcome (the last one, where there are fewer).
    Act(ActionId, u32),
}

/// Where a path starts and how it moves.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Inputs<S> {
    /// Its initial state.
    pub start: Start<S>,
    /// Its steps.
    pub moves: Vec<Move>,
    /// For each step, a state with the values of what its update leaves open; empty where a system has no such
    /// updates.
    pub values: Vec<S>,
}
