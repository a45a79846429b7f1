//! What the engine wants of a SAT solver.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A SAT solver that takes more clauses after each answer. Literals are numbers as in DIMACS. It is made, asked and
/// freed in a thread of its own, so that it need not be fit for more than one.
pub(super) trait Backend: Sized {
    /// Its name and version.
    fn signature() -> String;

    /// A solver without clauses, or what is wrong.
    fn new(setup: &Setup) -> Result<Self, String>;

    /// Adds a clause.
    fn clause(&mut self, literals: &[i32]);

    /// Whether the clauses are satisfiable under the assumptions; `None` if it was told to stop, or has spent about so much
    /// effort, where that is limited: memory accesses in propagation, the same in every run.
    fn solve(&mut self, assumptions: &[i32], effort: Option<u64>) -> Option<bool>;

    /// After `Some(true)`: the values of the variables from 1 on; what does not matter is false.
    fn model(&mut self) -> Vec<bool>;
}

/// How a solver is to work.
pub(super) struct Setup {
    /// Of its random choices; 0 is as it would by itself.
    pub(super) seed: u64,
    /// It will be asked more than once, which makes no difference to `BatSat`.
    #[cfg_attr(not(feature = "cadical"), expect(dead_code))]
    pub(super) dialogue: bool,
    /// Set when it is to stop: to be looked at every few milliseconds while it solves.
    pub(super) stop: Arc<AtomicBool>,
}
