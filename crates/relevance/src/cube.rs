//! Cases of the leading block, for searches side by side (cube and conquer: Heule, Kullmann, Wieringa and Biere 2011): where some
//! of its paths are at some times.
//!
//! A case takes states out of where a path can be, as what a goal asks for does, so that all searches go on as they would: nothing
//! is added to the formula. Every run that can matter is in some case, since at each time it is in one state. What is found in a case
//! is right without it.

use hyperplan_problem::PathId;
use hyperplan_space::StateIx;

/// Where some paths of the leading block are at some times; without any, all of their runs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cube(Vec<Cut>);

/// What one of several cases is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Case {
    /// These runs.
    Of(Cube),
    /// None that can matter.
    Empty,
    /// There is nothing to cut: every case is all of it.
    Whole,
}

/// That a path is in one of these states at a time.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Cut {
    path: PathId,
    time: u32,
    /// Sorted.
    states: Vec<StateIx>,
}

impl Cube {
    /// What it says of a path: at which times it is in which states, sorted.
    pub fn of(&self, path: PathId) -> impl Iterator<Item = (u32, &[StateIx])> {
        self.0.iter().filter(move |cut| cut.path == path).map(|cut| (cut.time, &*cut.states))
    }

    pub(crate) fn with(&self, path: PathId, time: u32, states: Vec<StateIx>) -> Cube {
        let mut cuts = self.0.clone();
        cuts.push(Cut { path, time, states });
        Cube(cuts)
    }
}
