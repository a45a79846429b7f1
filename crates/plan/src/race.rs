//! Several solvers search at the same time: the first verified answer counts.

use crate::config::{Config, Error, Outcome, Verdict};
use crate::solve::solve;
use hyperplan_problem::{Objective, Problem};
use std::sync::mpsc;
use std::thread;

/// What recurses, recurses over the nesting of a formula: as much stack as the command gives its own thread.
const STACK: usize = 256 << 20;

/// The exit code of a bug of ours.
const BUG: u8 = 5;

/// Runs the whole search once with each solver. When one has an answer, the others are cancelled, which ends their
/// processes; that some failed before does not matter, but is told.
pub(crate) fn race(problem: &Problem, objective: &Objective, config: &Config) -> Result<Outcome, Error> {
    let deadline = config.deadline.part();
    let (send, receive) = mpsc::channel();
    let mut winner = None;
    let mut losers = Vec::new();
    thread::scope(|scope| {
        let mut searches = Vec::new();
        for solver in std::iter::once(&config.solver).chain(&config.rivals) {
            let own = Config {
                solver: solver.clone(),
                rivals: Vec::new(),
                deadline: deadline.clone(),
                ..config.clone()
            };
            let send = send.clone();
            let search = move || {
                let result = solve(problem, objective, &own);
                // The receiver outlives the scope.
                let _ = send.send((own.solver.name().to_owned(), result));
            };
            let started = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, search);
            match started {
                Ok(search) => searches.push((solver, search)),
                Err(error) => losers.push((solver.name().to_owned(), Err(cannot_start(error)))),
            }
        }
        drop(send);
        for (name, result) in &receive {
            match result {
                Ok(outcome) if outcome.verdict != Verdict::Unknown && winner.is_none() => {
                    deadline.cancel();
                    winner = Some(outcome);
                }
                // What the others say when they are cancelled means nothing.
                result if winner.is_none() => losers.push((name, result)),
                _ => {}
            }
        }
        for (solver, search) in searches {
            if search.join().is_err() && winner.is_none() {
                losers.push((solver.name().to_owned(), Err(Error::Bug("the search panicked".to_owned()))));
            }
        }
    });
    conclude(winner, losers)
}

fn cannot_start(source: std::io::Error) -> Error {
    Error::Solver(hyperplan_solver::Error::Io { what: "cannot start a thread".to_owned(), source })
}

type Losers = Vec<(String, Result<Outcome, Error>)>;

/// The winner's answer; without one, an undecided outcome with all reasons; without that, all failures.
fn conclude(winner: Option<Outcome>, losers: Losers) -> Result<Outcome, Error> {
    if let Some(mut winner) = winner {
        for (name, result) in losers {
            if let Err(error) = result {
                winner.notes.push(format!("{name} gave no answer: {error}"));
            }
        }
        return Ok(winner);
    }
    let (mut undecided, mut errors, mut reasons) = (None::<Outcome>, Vec::new(), Vec::new());
    let mut alike = true;
    for (name, result) in losers {
        match result {
            Ok(outcome) => {
                reasons.push(format!("{name}: {}", outcome.reason.as_deref().unwrap_or("unknown")));
                let first = undecided.get_or_insert_with(|| outcome.clone());
                alike &= first.reason == outcome.reason;
            }
            Err(error) => {
                reasons.push(format!("{name}: {error}"));
                errors.push((name, error));
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
