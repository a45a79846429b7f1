//! Several solvers search at the same time: the first verified answer counts.

use crate::config::{Config, Outcome, Verdict};
use crate::fact::{Error, Fallen, Fault, Note, Reason};
use crate::search::search;
use hyperplan_problem::{Objective, Problem};
use hyperplan_solver::Unknown;
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver};
use std::thread;
use std::time::{Duration, Instant};

/// How long the losers may take to end their processes themselves. What they do besides, such as verifying an
/// answer that came late, nobody waits for.
const GRACE: Duration = Duration::from_millis(500);

/// What came of one search, with the name of its solver.
type Finish = (usize, Result<Outcome, Error>);

/// Decides an objective with one solver's search, or by a race of several.
pub(crate) fn search_or_race(
    problem: &Problem,
    objective: &Objective,
    config: &Config,
) -> Result<Outcome, Error> {
    if config.rivals.is_empty() {
        search(problem, objective, config)
    } else {
        race(problem, objective, config)
    }
}

/// Runs the whole search once with each solver. When one has an answer, the others are cancelled, which ends their
/// processes; that some failed before does not matter, but is told.
fn race(problem: &Problem, objective: &Objective, config: &Config) -> Result<Outcome, Error> {
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
        let lone = move || {
            let result = search(&question.0, &question.1, &own);
            // When there is a winner, nobody may listen any more.
            let _ = send.send((lane, result));
        };
        let started = thread::Builder::new().spawn(lone);
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
            winner.notes.push(Note::Lost { solver: names[lane].clone(), error: Arc::new(error) });
        }
    }
    winner
}

/// Without a winner: an undecided outcome with all reasons; without that, all failures.
fn undecided(names: &[String], losers: Vec<Finish>) -> Result<Outcome, Error> {
    let (mut undecided, mut errors, mut reasons) = (None::<Outcome>, Vec::new(), Vec::new());
    for (lane, result) in losers {
        let name = names[lane].clone();
        let fallen = match result {
            Ok(mut outcome) => {
                let reason = outcome.reason.take().unwrap_or(Reason::Solver(Unknown::Unsaid));
                undecided.get_or_insert(outcome);
                Fallen::Undecided(reason)
            }
            Err(error) => {
                let error = Arc::new(error);
                errors.push((name.clone(), Arc::clone(&error)));
                Fallen::Failed(error)
            }
        };
        reasons.push((name, fallen));
    }
    match undecided {
        // A bug of ours is not to be lost among what was undecided.
        Some(outcome) if errors.iter().all(|(_, error)| error.fault() < Fault::Ours) => {
            Ok(Outcome { reason: Some(together(reasons)), ..outcome })
        }
        _ => Err(Error::Race(errors)),
    }
}

/// One reason for all, where it reads the same.
fn together(mut reasons: Vec<(String, Fallen)>) -> Reason {
    let first = reasons.first().map(|(_, fallen)| fallen.to_string());
    let alike = |fallen: &Fallen| first.as_ref().is_some_and(|first| fallen.to_string() == *first);
    match reasons.iter().all(|(_, fallen)| matches!(fallen, Fallen::Undecided(_)) && alike(fallen)) {
        true => match reasons.pop() {
            Some((_, Fallen::Undecided(reason))) => reason,
            other => Reason::Several(other.into_iter().collect()),
        },
        false => Reason::Several(reasons),
    }
}
