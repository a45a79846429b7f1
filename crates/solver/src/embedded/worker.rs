//! A SAT solver in a thread of its own.
//!
//! Solvers ask in most of their loops whether to stop, but not in all: where there are millions of clauses, connecting
//! watches or one round of simplification takes a second. So a thread that does not stop soon enough is left alone. The
//! next check, if there is one, waits for it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use super::backend::{Backend, Setup};
use crate::circuit::{Budget, Halt, Lit, Sink};
use crate::error::Error;

/// How often the budget is looked at while the solver searches.
const TICK: Duration = Duration::from_millis(10);
/// How long the solver has to stop by itself.
const GRACE: Duration = Duration::from_millis(30);
/// How many numbers of clauses are handed over at once.
const BATCH: usize = 1 << 14;
/// How many batches may be on their way: memory is counted where clauses are made.
const QUEUE: usize = 8;

/// What the thread is asked for.
pub(super) enum Ask {
    /// To take clauses, a 0 after each.
    Clauses(Vec<i32>),
    /// Whether they are satisfiable under assumptions, with so much effort at most, where it is limited.
    Solve(Vec<i32>, Option<u64>),
}

/// What came of a search.
pub(super) enum Reply {
    Sat(Vec<bool>),
    Unsat,
    Stopped,
    Failed(String),
}

/// What a thread does for a solver.
pub(super) type Serve = fn(&Setup, &Receiver<Ask>, &SyncSender<Reply>);

/// Does what is asked of one solver until nobody is left to ask. Freeing millions of clauses, at the end, keeps nobody
/// waiting either.
pub(super) fn serve<B: Backend>(setup: &Setup, asks: &Receiver<Ask>, replies: &SyncSender<Reply>) {
    // Whether anybody is still waiting makes no difference here.
    let reply = |reply| drop(replies.send(reply));
    let mut sat = match B::new(setup) {
        Ok(sat) => sat,
        Err(message) => return reply(Reply::Failed(message)),
    };
    for ask in asks {
        match ask {
            Ask::Clauses(batch) => {
                // What is behind the last 0 is no clause.
                let mut rest = batch.as_slice();
                while let Some(end) = rest.iter().position(|&number| number == 0) {
                    sat.clause(&rest[..end]);
                    rest = &rest[end + 1..];
                }
            }
            Ask::Solve(assumptions, effort) => reply(match sat.solve(&assumptions, effort) {
                Some(true) => Reply::Sat(sat.model()),
                Some(false) => Reply::Unsat,
                None => Reply::Stopped,
            }),
        }
    }
}

/// An incremental SAT solver that stops when its budget is spent.
pub(super) struct Worker {
    /// Of the engine.
    name: String,
    asks: SyncSender<Ask>,
    replies: Receiver<Reply>,
    stop: Arc<AtomicBool>,
    /// Clauses that were not handed over yet.
    batch: Vec<i32>,
    clauses: usize,
    /// The last search was told to stop, and had not done so when it was given up on.
    is_late: bool,
    /// The values of the variables in the last model.
    model: Vec<bool>,
}

impl Worker {
    /// Starts the thread of a solver, which does `serve`; `dialogue` if it will be asked more than once.
    pub(super) fn start(name: &str, serve: Serve, seed: u64, dialogue: bool) -> Result<Worker, Error> {
        let (asks, asked) = sync_channel(QUEUE);
        let (replier, replies) = sync_channel(1);
        let stop = Arc::new(AtomicBool::new(false));
        let setup = Setup { seed, dialogue, stop: Arc::clone(&stop) };
        thread::Builder::new()
            .name(name.to_owned())
            .spawn(move || serve(&setup, &asked, &replier))
            .map_err(|source| Error::Io { what: format!("cannot start a thread for {name}"), source })?;
        let (batch, model) = (Vec::with_capacity(BATCH), Vec::new());
        Ok(Worker { name: name.to_owned(), asks, replies, stop, batch, clauses: 0, is_late: false, model })
    }

    /// Waits for the end of a search that was given up on; to be called before clauses are added.
    pub(super) fn ready(&mut self, budget: &Budget) -> Result<(), Halt> {
        if self.is_late {
            self.wait(|| budget.spent())?.ok_or(Halt::Spent)?;
            self.is_late = false;
        }
        Ok(())
    }

    /// Whether the clauses are satisfiable under the assumptions.
    pub(super) fn solve(&mut self, assumptions: &[Lit], budget: &Budget) -> Result<bool, Halt> {
        if budget.spent() {
            return Err(Halt::Spent);
        }
        self.stop.store(false, Ordering::Relaxed);
        let batch = std::mem::take(&mut self.batch);
        self.ask(Ask::Clauses(batch));
        let assumptions = assumptions.iter().map(|literal| literal.number()).collect();
        self.ask(Ask::Solve(assumptions, budget.effort));
        let mut told = None;
        let reply = self.wait(|| {
            if told.is_none() && budget.spent() {
                self.stop.store(true, Ordering::Relaxed);
                told = Some(Instant::now());
            }
            told.is_some_and(|told| told.elapsed() >= GRACE)
        })?;
        match reply {
            Some(Reply::Sat(model)) => {
                self.model = model;
                Ok(true)
            }
            Some(Reply::Unsat) => Ok(false),
            Some(Reply::Stopped) => Err(if told.is_some() { Halt::Spent } else { Halt::Tired }),
            Some(Reply::Failed(message)) => Err(self.failed(message).into()),
            None => {
                self.is_late = true;
                Err(Halt::Spent)
            }
        }
    }

    /// Whether a literal is true in the last model.
    pub(super) fn is_true(&self, literal: Lit) -> bool {
        let value = self.model.get(literal.variable() as usize - 1).copied().unwrap_or_default();
        value == (literal.number() > 0)
    }

    /// A thread that has ended is noticed when its reply is waited for.
    fn ask(&self, ask: Ask) {
        drop(self.asks.send(ask));
    }

    /// Waits for the solver, until told to give up.
    fn wait(&self, mut give_up: impl FnMut() -> bool) -> Result<Option<Reply>, Error> {
        loop {
            match self.replies.recv_timeout(TICK) {
                Ok(reply) => return Ok(Some(reply)),
                Err(RecvTimeoutError::Timeout) if give_up() => return Ok(None),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(self.failed("its thread ended without an answer".to_owned()));
                }
            }
        }
    }

    fn failed(&self, message: String) -> Error {
        Error::Engine { name: self.name.clone(), message }
    }
}

impl Sink for Worker {
    const QUANTIFIERS: bool = false;

    fn unsupported(what: &str) -> Error {
        let what = format!("the builtin solver cannot handle {what}: use z3, cvc5 or yices");
        Error::Unsupported { what }
    }

    fn clause(&mut self, literals: &[Lit]) {
        self.clauses += 1;
        self.batch.extend(literals.iter().map(|literal| literal.number()));
        self.batch.push(0);
        if self.batch.len() >= BATCH {
            let batch = std::mem::replace(&mut self.batch, Vec::with_capacity(BATCH));
            self.ask(Ask::Clauses(batch));
        }
    }

    fn size(&self) -> usize {
        self.clauses
    }
}

impl Drop for Worker {
    /// What was given up on, and is still at it, ends.
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deadline::Deadline;

    /// Finds everything satisfiable by the first clause, but takes its time and does not stop before; has no place for
    /// an empty clause; and is not to be had with seed 13.
    struct Stubborn {
        model: Option<Vec<bool>>,
    }

    const LONG: Duration = Duration::from_millis(400);

    impl Backend for Stubborn {
        fn signature() -> String {
            "stubborn-1".to_owned()
        }

        fn new(setup: &Setup) -> Result<Stubborn, String> {
            if setup.seed == 13 { Err("bad luck".to_owned()) } else { Ok(Stubborn { model: None }) }
        }

        fn clause(&mut self, literals: &[i32]) {
            assert!(!literals.is_empty(), "an empty clause");
            self.model.get_or_insert_with(|| literals.iter().map(|&number| number > 0).collect());
        }

        fn solve(&mut self, _: &[i32], _: Option<u64>) -> Option<bool> {
            thread::sleep(LONG);
            Some(true)
        }

        fn model(&mut self) -> Vec<bool> {
            self.model.clone().unwrap_or_default()
        }
    }

    fn start(seed: u64) -> Worker {
        Worker::start("stubborn", serve::<Stubborn>, seed, true).expect("a thread")
    }

    fn after(milliseconds: u64) -> Budget {
        Budget::new(&Deadline::after(Duration::from_millis(milliseconds)), None, None)
    }

    fn message(halt: Result<bool, Halt>) -> String {
        match halt {
            Err(Halt::Error(error)) => error.to_string(),
            other => format!("{other:?}"),
        }
    }

    #[test]
    fn what_does_not_stop_is_left_alone_and_waited_for_later() {
        let mut worker = start(0);
        worker.clause(&[Lit::new(1), !Lit::new(2)]);
        let began = Instant::now();
        assert!(matches!(worker.solve(&[], &after(50)), Err(Halt::Spent)));
        assert!(began.elapsed() < LONG, "{:?}", began.elapsed());
        assert!(matches!(worker.ready(&after(1)), Err(Halt::Spent)));
        worker.ready(&after(60_000)).expect("it ends");
        // Many clauses, in several batches, in between.
        for _ in 0..4 * BATCH {
            worker.clause(&[Lit::new(3)]);
        }
        assert!(worker.solve(&[], &after(60_000)).expect("an answer"));
        let [a, b, c] = [1, 2, 3].map(|number| worker.is_true(Lit::new(number)));
        assert_eq!((a, b, c, worker.is_true(!Lit::new(2))), (true, false, false, true));
        assert_eq!(worker.size(), 4 * BATCH + 1);
    }

    #[test]
    fn a_solver_that_cannot_be_had_says_why() {
        assert_eq!(message(start(13).solve(&[], &after(60_000))), "solver stubborn failed: bad luck");
    }

    #[test]
    fn a_thread_that_dies_is_noticed() {
        let mut worker = start(0);
        worker.clause(&[]);
        for _ in 0..2 {
            let said = message(worker.solve(&[], &after(60_000)));
            assert_eq!(said, "solver stubborn failed: its thread ended without an answer");
        }
    }
}
