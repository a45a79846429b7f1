//! `BatSat`: all Rust, and so in every build.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use ::batsat::{BasicCallbacks, Lit, Solver, SolverInterface as _, SolverOpts, lbool};

use super::backend::{Backend, Setup};

/// A solver, and a clause on its way there.
pub(super) struct BatSat {
    sat: Solver<BasicCallbacks>,
    clause: Vec<Lit>,
    /// Steps until it is to stop.
    left: Arc<AtomicU64>,
}

/// Effort of the steps between two questions whether to stop, on average.
const EFFORT_PER_STEP: u64 = 100;

impl BatSat {
    fn literal(&mut self, number: i32) -> Lit {
        Lit::new(self.sat.var_of_int(number.unsigned_abs() - 1), number > 0)
    }
}

impl Backend for BatSat {
    fn signature() -> String {
        // The crate does not tell; a test compares this with what is locked.
        "batsat-0.6.0".to_owned()
    }

    fn new(setup: &Setup) -> Result<BatSat, String> {
        let mut options = SolverOpts::default();
        // It makes no random choices by itself; a seed gives the variables slightly different weights to begin with.
        if setup.seed != 0 {
            // Its generator takes numbers between 0 and 2^31 - 1, exclusive.
            options.random_seed = (1 + setup.seed % 2_000_000_000) as f64;
            options.rnd_init_act = true;
        }
        let stop = setup.stop.clone();
        let left = Arc::new(AtomicU64::new(u64::MAX));
        let mut callbacks = BasicCallbacks::new();
        // It asks at every conflict and decision.
        let counter = left.clone();
        callbacks.set_stop(move || {
            let left = counter.load(Ordering::Relaxed);
            counter.store(left.saturating_sub(1), Ordering::Relaxed);
            left == 0 || stop.load(Ordering::Relaxed)
        });
        Ok(BatSat { sat: Solver::new(options, callbacks), clause: Vec::new(), left })
    }

    fn clause(&mut self, literals: &[i32]) {
        let mut clause = std::mem::take(&mut self.clause);
        clause.clear();
        clause.extend(literals.iter().map(|&number| self.literal(number)));
        self.sat.add_clause_reuse(&mut clause);
        self.clause = clause;
    }

    fn solve(&mut self, assumptions: &[i32], effort: Option<u64>) -> Option<bool> {
        self.left.store(effort.map_or(u64::MAX, |effort| effort / EFFORT_PER_STEP), Ordering::Relaxed);
        let assumptions: Vec<Lit> = assumptions.iter().map(|&number| self.literal(number)).collect();
        let answer = self.sat.solve_limited(&assumptions);
        (answer != lbool::UNDEF).then_some(answer == lbool::TRUE)
    }

    fn model(&mut self) -> Vec<bool> {
        self.sat.get_model().iter().map(|&value| value == lbool::TRUE).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{Backend as _, BatSat};

    #[test]
    fn the_version_is_that_which_is_locked() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../Cargo.lock");
        let locked = std::fs::read_to_string(file).expect("it is committed");
        let (_, after) = locked.split_once("name = \"batsat\"\nversion = \"").expect("it is a dependency");
        assert_eq!(
            Some(BatSat::signature().as_str()),
            after.split_once('"').map(|(version, _)| format!("batsat-{version}")).as_deref()
        );
    }
}
