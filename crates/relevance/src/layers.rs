//! The states of one path that can matter, time by time.

use hyperplan_space::StateIx;

/// The states that can matter at each time `0..=horizon`, sorted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layers {
    /// One sorted list of states a time.
    pub at: Vec<Vec<StateIx>>,
}

impl Layers {
    /// Whether a state can matter at a time.
    pub fn contains(&self, time: usize, state: StateIx) -> bool {
        self.at[time].binary_search(&state).is_ok()
    }

    /// Whether no run is left.
    pub fn is_empty(&self) -> bool {
        self.at.iter().any(Vec::is_empty)
    }
}
