//! `CaDiCaL`, by a crate that compiles it with nothing but a C++ compiler.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use cadical_sys::{CaDiCal, Status, Terminator};

use super::backend::{Backend, Setup};

/// A solver.
pub(super) struct Cadical(CaDiCal);

/// Tells the solver to stop; it asks in most loops.
struct Stop(Arc<AtomicBool>);

impl Terminator for Stop {
    fn terminated(&mut self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl Backend for Cadical {
    fn signature() -> String {
        CaDiCal::signature()
    }

    fn new(setup: &Setup) -> Result<Cadical, String> {
        let mut sat = CaDiCal::new();
        for (option, value) in options(setup) {
            if !sat.set(option, value) {
                return Err(format!("it has no option {option}"));
            }
        }
        sat.connect_terminator(Stop(Arc::clone(&setup.stop)));
        Ok(Cadical(sat))
    }

    fn clause(&mut self, literals: &[i32]) {
        self.0.clause6(literals);
    }

    fn solve(&mut self, assumptions: &[i32], effort: Option<u64>) -> Option<bool> {
        if let Some(effort) = effort {
            // It counts what it calls ticks. A limit is for the next search only.
            let ticks = i32::try_from(effort).unwrap_or(i32::MAX);
            self.0.limit("ticks", ticks);
        }
        for &literal in assumptions {
            self.0.assume(literal);
        }
        match self.0.solve() {
            Status::SATISFIABLE => Some(true),
            Status::UNSATISFIABLE => Some(false),
            Status::UNKNOWN => None,
        }
    }

    fn model(&mut self) -> Vec<bool> {
        (1..=self.0.vars()).map(|variable| self.0.val(variable) > 0).collect()
    }
}

/// The options that differ from the defaults.
fn options(setup: &Setup) -> impl Iterator<Item = (&'static str, i32)> {
    // CaDiCaL takes seeds up to 2 * 10^9.
    let seed = i32::try_from(setup.seed % 2_000_000_000).unwrap_or(0);
    // Of a hundred states a path is in one, so variables are false to begin with, and staying near a solution wins
    // more of these queries than restarts. Lucky phases come with every check of a dialogue, and cost more than they
    // gain, but decide single queries that leave little to choose: the shortest path at 100x100 takes 0.2 s with them
    // and 5 s without. Processor seconds of eight hard queries (action robustness at 10x10 and 20x20, satisfiable and
    // not, direct and counterexample-guided; opacity at 40x40), two seeds each, stopped after 12, by CaDiCaL 2.2.1: the
    // first two options 56, with fewer lucky phases and without light preprocessing, which is off by default now, 13;
    // without random walks 15, without walks but with lucky phases 55, without walks and simplification during search
    // 19. In ten such queries CaDiCaL's defaults took 65, its `sat` 66 and `unsat` 91 where the first two options took
    // 48. Six queries in bit-vectors, three seeds each, took 109 with 2.2.1 and 113 with 3.0.1.
    let lucky = i32::from(!setup.dialogue);
    let usual = [("seed", seed), ("phase", 0), ("stabilizeonly", 1), ("lucky", lucky)];
    // Little is left to chance in small queries; a seed asks for some random decisions.
    let random = [("randec", 1), ("randecstable", 1), ("randecinit", 2)];
    usual.into_iter().chain(random.into_iter().filter(move |_| seed != 0))
}
