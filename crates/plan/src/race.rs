//! Several solvers search at the same time: the first verified answer counts.

use crate::config::{Config, Error, Outcome, Verdict};
use crate::solve::solve;
use hyperplan_problem::{Objective, Problem};
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver};
use std::thread;
use std::time::{Duration, Instant};

/// What recurses, recurses over the nesting of a formula: as much stack as the command gives its own thread.
const STACK: usize = 256 << 20;

/// How long the losers may take to end their processes themselves. What they do besides, such as verifying an
/// answer that came late, nobody waits for.
const GRACE: Duration = Duration::from_millis(500);

/// The exit code of a bug of ours.
const BUG: u8 = 5;

/// What came of one search, with the name of its solver.
type Finish = (usize, Result<Outcome, Error>);

/// Runs the whole search once with each solver. When one has an answer, the others are cancelled, which ends their
/// processes; that some failed before does not matter, but is told.
pub(crate) fn race(problem: &Problem, objective: &Objective, config: &Config) -> Result<Outcome, Error> {
    let deadline = config.deadline.part();
    let question = Arc::new((problem.clone(), objective.clone()));
    let (send, receive) = mpsc::channel();
    let mut names = Vec::new();
    for solver in std::iter::once(&config.solver).chain(&config.rivals) {
        let lane = names.len();
        names.push(solver.name().to_owned());
        let own = Config {
            solver: solver.clone(),
            rivals: Vec::new(),
            deadline: deadline.clone(),
            ..config.clone()
        };
        let (send, question) = (send.clone(), Arc::clone(&question));
        let search = move || {
            let result = solve(&question.0, &question.1, &own);
            // When there is a winner, nobody may listen any more.
            let _ = send.send((lane, result));
        };
        let started = thread::Builder::new().stack_size(STACK).spawn(search);
        started.map_err(|source| {
            deadline.cancel();
            Error::Solver(hyperplan_solver::Error::Io { what: "cannot start a thread".to_owned(), source })
        })?;
    }
    drop(send);
    let mut losers = Vec::new();
    // The end of all: who has sent nothing has panicked, and said so.
    while let Ok((lane, result)) = receive.recv() {
        match result {
            Ok(outcome) if outcome.verdict != Verdict::Unknown => {
                deadline.cancel();
                wait(&receive);
                return Ok(with_failures(outcome, &names, losers));
            }
            result => losers.push((lane, result)),
        }
    }
    for lane in 0..names.len() {
        if losers.iter().all(|(other, _)| *other != lane) {
            losers.push((lane, Err(Error::Bug("the search panicked".to_owned()))));
        }
    }
    undecided(&names, losers)
}

/// Waits for the cancelled searches, but not long.
fn wait(receive: &Receiver<Finish>) {
    let end = Instant::now() + GRACE;
    while receive.recv_timeout(end.saturating_duration_since(Instant::now())).is_ok() {}
}

/// The winner's answer, with notes about those that had failed by then.
fn with_failures(mut winner: Outcome, names: &[String], losers: Vec<Finish>) -> Outcome {
    for (lane, result) in losers {
        if let Err(error) = result {
            winner.notes.push(format!("{} gave no answer: {error}", names[lane]));
        }
    }
    winner
}

/// Without a winner: an undecided outcome with all reasons; without that, all failures.
fn undecided(names: &[String], losers: Vec<Finish>) -> Result<Outcome, Error> {
    let (mut undecided, mut errors, mut reasons) = (None::<Outcome>, Vec::new(), Vec::new());
    let mut alike = true;
    for (lane, result) in losers {
        let name = &names[lane];
        match result {
            Ok(outcome) => {
                reasons.push(format!("{name}: {}", outcome.reason.as_deref().unwrap_or("unknown")));
                let first = undecided.get_or_insert_with(|| outcome.clone());
                alike &= first.reason == outcome.reason;
            }
            Err(error) => {
                reasons.push(format!("{name}: {error}"));
                errors.push((name.clone(), error));
            }
        }
    }
    match undecided {
        // A bug of ours is not to be lost among what was undecided.
        Some(mut outcome) if errors.iter().all(|(_, error)| error.exit_code() < BUG) => {
            if !errors.is_empty() || !alike {
                outcome.reason = Some(reasons.join("; "));
            }
            Ok(outcome)
        }
        _ => Err(Error::Race(errors)),
    }
}
