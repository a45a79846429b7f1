//! `BatSat`: all Rust, for builds without a C++ compiler.

use batsat::SolverOpts;
use rustsat::solvers::{Solve, SolveIncremental, SolverResult};
use rustsat::types::{Cl, Lit, TernaryVal};
use rustsat_batsat::BasicSolver;

use super::budget::{Budget, Halt};
use crate::error::Error;

/// An incremental SAT solver that stops when its budget is spent.
pub(super) struct Backend {
    sat: BasicSolver,
    clauses: usize,
    failure: Option<Error>,
}

impl Backend {
    // The other backend can fail here.
    #[allow(clippy::unnecessary_wraps)]
    pub(super) fn new(seed: u64) -> Result<Backend, Error> {
        Ok(Backend { sat: seeded(seed), clauses: 0, failure: None })
    }

    /// Which solver this is: name and version.
    pub(super) fn signature(&self) -> &'static str {
        self.sat.signature()
    }

    /// How many clauses were added.
    pub(super) fn clauses(&self) -> usize {
        self.clauses
    }

    /// Readies the solver for clauses.
    // The other backend may have to wait.
    #[allow(clippy::unnecessary_wraps, clippy::unused_self)]
    pub(super) fn ready(&mut self, _: &Budget) -> Result<(), Halt> {
        Ok(())
    }

    /// Adds a clause. A failure is kept until the next solve.
    pub(super) fn clause(&mut self, literals: &[Lit]) {
        self.clauses += 1;
        if let Err(error) = self.sat.add_clause_ref(Cl::new(literals)) {
            self.failure.get_or_insert(engine_error(&error));
        }
    }

    /// Whether the clauses are satisfiable under the assumptions. `BatSat` asks at every conflict and decision
    /// whether to stop.
    pub(super) fn solve(&mut self, assumptions: &[Lit], budget: &Budget) -> Result<bool, Halt> {
        if let Some(error) = self.failure.take() {
            return Err(error.into());
        }
        if budget.spent() {
            return Err(Halt::Spent);
        }
        let watched = budget.clone();
        self.sat.batsat_mut().cb_mut().set_stop(move || watched.spent());
        match self.sat.solve_assumps(assumptions).map_err(|error| engine_error(&error))? {
            SolverResult::Sat => Ok(true),
            SolverResult::Unsat => Ok(false),
            SolverResult::Interrupted => Err(Halt::Spent),
        }
    }

    /// The value of a literal in the last model; what does not matter is false.
    pub(super) fn is_true(&self, literal: Lit) -> Result<bool, Error> {
        let value = self.sat.var_val(literal.var()).map_err(|error| engine_error(&error))?;
        Ok((value == TernaryVal::True) == literal.is_pos())
    }
}

/// `BatSat` makes no random choices by default; a seed other than 0 gives the variables slightly different weights to
/// begin with.
fn seeded(seed: u64) -> BasicSolver {
    let mut sat = BasicSolver::default();
    if seed != 0 {
        // Its generator takes numbers between 0 and 2^31 - 1, exclusive.
        let random_seed = (1 + seed % 2_000_000_000) as f64;
        let options = SolverOpts { random_seed, rnd_init_act: true, ..SolverOpts::default() };
        *sat.batsat_mut() = batsat::Solver::new(options, batsat::BasicCallbacks::new());
    }
    sat
}

fn engine_error(error: &impl std::fmt::Display) -> Error {
    Error::Engine { name: "builtin".to_owned(), message: error.to_string() }
}
