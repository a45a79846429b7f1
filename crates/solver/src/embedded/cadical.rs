//! `CaDiCaL`, in a thread of its own while it searches.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use rustsat::solvers::{ControlSignal, Solve, SolveIncremental, SolverResult, Terminate};
use rustsat::types::{Cl, Lit, TernaryVal};
use rustsat_cadical::CaDiCaL;

use super::budget::{Budget, Halt};
use crate::error::Error;

type Sat = CaDiCaL<'static, 'static>;
/// What a search that ended sends back.
type Ended = (Sat, Result<SolverResult, Error>);

/// How often the budget is looked at while the solver searches.
const TICK: Duration = Duration::from_millis(10);
/// How long the solver has to stop by itself.
const GRACE: Duration = Duration::from_millis(30);
/// Most clauses of a solver that is freed at once; larger ones take long.
const SMALL: usize = 1 << 16;

/// An incremental SAT solver that stops when its budget is spent.
///
/// `CaDiCaL` asks in most loops whether to stop, but not in all: where there are millions of clauses, connecting
/// watches or one round of simplification takes a second. So it searches in a thread, which is left alone where it
/// does not stop soon enough. The next check, if there is one, waits for it.
pub(super) struct Backend {
    place: Place,
    signature: &'static str,
    clauses: usize,
    failure: Option<Error>,
}

/// Where the solver is.
enum Place {
    Here(Sat),
    /// With a thread that was told to stop.
    Away(Receiver<Ended>),
    /// Its thread died.
    Lost,
}

impl Backend {
    pub(super) fn new(seed: u64) -> Result<Backend, Error> {
        let sat = seeded(seed)?;
        Ok(Backend { signature: sat.signature(), place: Place::Here(sat), clauses: 0, failure: None })
    }

    /// Which solver this is: name and version.
    pub(super) fn signature(&self) -> &'static str {
        self.signature
    }

    /// How many clauses were added.
    pub(super) fn clauses(&self) -> usize {
        self.clauses
    }

    /// Gets the solver back from a search that was given up on; to be called before clauses are added.
    pub(super) fn ready(&mut self, budget: &Budget) -> Result<(), Halt> {
        if let Place::Away(receiver) = &self.place {
            let (sat, _) = wait(receiver, || budget.spent())?.ok_or(Halt::Spent)?;
            self.place = Place::Here(sat);
        }
        Ok(())
    }

    /// Adds a clause. A failure is kept until the next solve.
    pub(super) fn clause(&mut self, literals: &[Lit]) {
        self.clauses += 1;
        let result = match &mut self.place {
            Place::Here(sat) => sat.add_clause_ref(Cl::new(literals)).map_err(|error| engine_error(&error)),
            Place::Away(_) | Place::Lost => Err(lost()),
        };
        if let Err(error) = result {
            self.failure.get_or_insert(error);
        }
    }

    /// Whether the clauses are satisfiable under the assumptions.
    pub(super) fn solve(&mut self, assumptions: &[Lit], budget: &Budget) -> Result<bool, Halt> {
        if let Some(error) = self.failure.take() {
            return Err(error.into());
        }
        if budget.spent() {
            return Err(Halt::Spent);
        }
        let Place::Here(mut sat) = std::mem::replace(&mut self.place, Place::Lost) else {
            return Err(lost().into());
        };
        let stop = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&stop);
        sat.attach_terminator(move || {
            if flag.load(Ordering::Relaxed) { ControlSignal::Terminate } else { ControlSignal::Continue }
        });
        let receiver = search(sat, assumptions.to_vec())?;
        let mut told = None;
        let ended = wait(&receiver, || {
            if told.is_none() && budget.spent() {
                stop.store(true, Ordering::Relaxed);
                told = Some(Instant::now());
            }
            told.is_some_and(|told| told.elapsed() >= GRACE)
        })?;
        let Some((sat, result)) = ended else {
            self.place = Place::Away(receiver);
            return Err(Halt::Spent);
        };
        self.place = Place::Here(sat);
        match result? {
            SolverResult::Sat => Ok(true),
            SolverResult::Unsat => Ok(false),
            SolverResult::Interrupted => Err(Halt::Spent),
        }
    }

    /// The value of a literal in the last model; what does not matter is false.
    pub(super) fn is_true(&self, literal: Lit) -> Result<bool, Error> {
        let Place::Here(sat) = &self.place else { return Err(lost()) };
        let value = sat.var_val(literal.var()).map_err(|error| engine_error(&error))?;
        Ok((value == TernaryVal::True) == literal.is_pos())
    }
}

impl Drop for Backend {
    /// Millions of clauses take tenths of a second to free: nobody need wait for that.
    fn drop(&mut self) {
        if self.clauses > SMALL && matches!(self.place, Place::Here(_)) {
            let place = std::mem::replace(&mut self.place, Place::Lost);
            // Where no thread can be had, the closure is dropped here, and the solver with it.
            let _ = thread::Builder::new().spawn(move || drop(place));
        }
    }
}

/// Lets a thread solve, and gives where the solver will come back.
fn search(mut sat: Sat, assumptions: Vec<Lit>) -> Result<Receiver<Ended>, Error> {
    let (sender, receiver) = sync_channel(1);
    let run = move || {
        let result = sat.solve_assumps(&assumptions).map_err(|error| engine_error(&error));
        // Nobody may be waiting any more.
        let _ = sender.send((sat, result));
    };
    let name = "cadical".to_owned();
    match thread::Builder::new().name(name).spawn(run) {
        Ok(_) => Ok(receiver),
        Err(source) => {
            Err(Error::Io { what: "cannot start a thread for the builtin solver".to_owned(), source })
        }
    }
}

/// Waits for the solver, until told to give up.
fn wait(receiver: &Receiver<Ended>, mut give_up: impl FnMut() -> bool) -> Result<Option<Ended>, Error> {
    loop {
        match receiver.recv_timeout(TICK) {
            Ok(ended) => return Ok(Some(ended)),
            Err(RecvTimeoutError::Timeout) if give_up() => return Ok(None),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Err(lost()),
        }
    }
}

fn seeded(seed: u64) -> Result<Sat, Error> {
    let mut sat = Sat::default();
    // CaDiCaL takes seeds up to 2 * 10^9.
    let seed = i32::try_from(seed % 2_000_000_000).unwrap_or(0);
    // Of a hundred states a path is in one, so variables are false to begin with, and staying near a solution wins
    // more of these queries than restarts. Lucky phases and light preprocessing come with every check of a dialogue,
    // and cost more than they gain. Processor seconds of eight hard queries (action robustness at 10x10 and 20x20,
    // satisfiable and not, direct and counterexample-guided; opacity at 40x40), two seeds each, stopped after 12:
    // the first two options 56, all four 13, and no query more than a fifth slower; without random walks 15, without
    // walks but with lucky phases 55, without walks and simplification during search 19. In ten such queries
    // CaDiCaL's defaults took 65, its `sat` 66 and `unsat` 91 where the first two options took 48.
    let options = [("seed", seed), ("phase", 0), ("stabilizeonly", 1), ("preprocesslight", 0), ("lucky", 0)];
    // Little is left to chance in small queries; a seed asks for some random decisions.
    let random = [("randec", 1), ("randecstable", 1), ("randecinit", 2)];
    let random = random.into_iter().filter(|_| seed != 0);
    for (option, value) in options.into_iter().chain(random) {
        sat.set_option(option, value).map_err(|error| engine_error(&error))?;
    }
    Ok(sat)
}

fn engine_error(error: &impl std::fmt::Display) -> Error {
    Error::Engine { name: "builtin".to_owned(), message: error.to_string() }
}

fn lost() -> Error {
    engine_error(&"its thread ended without an answer")
}
