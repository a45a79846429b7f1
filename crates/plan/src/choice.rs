//! What the other player may choose, and a candidate that loses to few choices: data.

use hyperplan_problem::{PathId, State, Strategy};

/// What the other player may choose.
#[derive(Clone, Debug, PartialEq)]
pub enum Choice {
    /// That a path begins in a state.
    Start(PathId, State),
    /// That a path does in a step, from 0, something else than another path.
    Replaced(PathId, PathId, usize),
}

/// A candidate that loses to few choices only.
#[derive(Clone, Debug)]
pub struct Closest {
    /// Its paths.
    pub strategy: Strategy,
    /// The choices of the other player to which it loses, not all that there are; none where it is a strategy.
    pub spared: Vec<Choice>,
}
