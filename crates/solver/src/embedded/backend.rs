//! The SAT solvers behind rustsat: CaDiCaL, or batsat where there is only Rust.

use rustsat::solvers::{Solve, SolveIncremental, SolverResult};
use rustsat::types::{Cl, Lit, TernaryVal};

use crate::deadline::Deadline;
use crate::error::Error;

#[cfg(feature = "cadical")]
type Sat = rustsat_cadical::CaDiCaL<'static, 'static>;
#[cfg(not(feature = "cadical"))]
type Sat = rustsat_batsat::BasicSolver;

/// An incremental SAT solver that stops at a deadline.
pub(super) struct Backend {
    sat: Sat,
    /// How many clauses were added; what the solver makes of them is its own affair.
    pub(super) clauses: usize,
    failure: Option<Error>,
}

impl Backend {
    pub(super) fn new(seed: u64) -> Result<Backend, Error> {
        Ok(Backend { sat: seeded(seed)?, clauses: 0, failure: None })
    }

    /// Which solver this is: name and version.
    pub(super) fn signature(&self) -> &'static str {
        self.sat.signature()
    }

    /// Adds a clause. A failure is kept until the next solve.
    pub(super) fn clause(&mut self, literals: &[Lit]) {
        self.clauses += 1;
        if let Err(error) = self.sat.add_clause_ref(Cl::new(literals)) {
            self.failure.get_or_insert(engine_error(&error));
        }
    }

    /// Solves; `None` if the deadline came first.
    pub(super) fn solve(&mut self, assumptions: &[Lit], deadline: &Deadline) -> Result<Option<bool>, Error> {
        if let Some(error) = self.failure.take() {
            return Err(error);
        }
        if deadline.passed() {
            return Ok(None);
        }
        watch(&mut self.sat, deadline);
        match self.sat.solve_assumps(assumptions).map_err(|error| engine_error(&error))? {
            SolverResult::Sat => Ok(Some(true)),
            SolverResult::Unsat => Ok(Some(false)),
            SolverResult::Interrupted => Ok(None),
        }
    }

    /// The value of a literal in the last model; what does not matter is false.
    pub(super) fn is_true(&self, literal: Lit) -> Result<bool, Error> {
        let value = self.sat.var_val(literal.var()).map_err(|error| engine_error(&error))?;
        Ok((value == TernaryVal::True) == literal.is_pos())
    }
}

#[cfg(feature = "cadical")]
fn seeded(seed: u64) -> Result<Sat, Error> {
    let mut sat = Sat::default();
    // CaDiCaL takes seeds up to 2 * 10^9.
    let seed = i32::try_from(seed % 2_000_000_000).unwrap_or(0);
    // Of a hundred states a path is in one, so variables are false to begin with; and these queries are won by
    // staying near a solution rather than by restarts. One run each on the slowest case studies at 40x40: action
    // robustness 2.7 s without, 3.3 s with the two; current-state opacity 4.4 s without, 1.7 s with them.
    for (option, value) in [("seed", seed), ("phase", 0), ("stabilizeonly", 1)] {
        sat.set_option(option, value).map_err(|error| engine_error(&error))?;
    }
    Ok(sat)
}

/// CaDiCaL calls the terminator at every conflict and regularly while it simplifies.
#[cfg(feature = "cadical")]
fn watch(sat: &mut Sat, deadline: &Deadline) {
    use rustsat::solvers::{ControlSignal, Terminate};
    let deadline = deadline.clone();
    sat.attach_terminator(
        move || {
            if deadline.passed() { ControlSignal::Terminate } else { ControlSignal::Continue }
        },
    );
}

/// batsat makes no random choices by default, so that the seed changes nothing.
#[cfg(not(feature = "cadical"))]
fn seeded(_: u64) -> Result<Sat, Error> {
    Ok(Sat::default())
}

/// batsat asks at every conflict and decision whether to stop.
#[cfg(not(feature = "cadical"))]
fn watch(sat: &mut Sat, deadline: &Deadline) {
    let deadline = deadline.clone();
    sat.batsat_mut().cb_mut().set_stop(move || deadline.passed());
}

fn engine_error(error: &impl std::fmt::Display) -> Error {
    Error::Engine { name: "builtin".to_owned(), message: error.to_string() }
}
