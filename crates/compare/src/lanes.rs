//! Runs of hyperplan side by side, each with all that it starts below a process that ends it: not to be measured, but for the
//! first that is good enough.

use std::collections::BTreeMap;
use std::io;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use crate::pool::{Lifelines, measure};
use crate::record::Limit;
use crate::supervise::{Job, Measured};

/// How often it is looked at whether all are to end.
const TICK: Duration = Duration::from_millis(20);

/// How lanes are run.
#[derive(Clone, Debug)]
pub struct Lanes {
    /// The `hyperplan` program.
    pub hyperplan: PathBuf,
    /// Its arguments that make it [`supervise`](crate::supervise()).
    pub supervisor: Vec<String>,
    /// Where lanes put temporary files.
    pub temporary: PathBuf,
    /// How many at a time.
    pub at_a_time: usize,
}

/// Who says what is run, one lane after the other.
pub trait Foreman {
    /// What ends all.
    type End;

    /// The arguments of the next lane; lanes are numbered from 0 as they are given. `None` where there is none, until another one
    /// has ended.
    fn next(&mut self) -> Option<Vec<String>>;

    /// Hears of a lane that has ended.
    fn ended(&mut self, finish: Finish) -> ControlFlow<Self::End>;

    /// The lanes that are of no use any more, of those that run.
    fn moot(&mut self) -> Vec<usize>;

    /// Whether all are to end.
    fn over(&mut self) -> bool;
}

/// What came of a lane.
#[derive(Clone, Debug)]
pub struct Finish {
    /// Its number.
    pub lane: usize,
    /// What it printed.
    pub stdout: String,
    /// The end of what it said besides.
    pub stderr: String,
    /// Its exit code, if it had one.
    pub exit_code: Option<i32>,
}

impl Lanes {
    /// Runs hyperplan as the foreman says, and tells it of each lane that ends, until that breaks, it says that all is over, or
    /// nothing runs any more: then all others end at once, with everything that they have started.
    ///
    /// # Errors
    /// When our own program cannot be started.
    pub fn run<F: Foreman>(&self, foreman: &mut F) -> io::Result<Option<F::End>> {
        let (sender, finishes) = mpsc::channel();
        thread::scope(|scope| {
            let mut running: BTreeMap<usize, Arc<Lifelines>> = BTreeMap::new();
            let mut begun = 0;
            let outcome = loop {
                while running.len() < self.at_a_time.max(1) {
                    let Some(arguments) = foreman.next() else { break };
                    let (lane, job, lifelines) = (begun, self.job(&arguments), Arc::<Lifelines>::default());
                    begun += 1;
                    running.insert(lane, Arc::clone(&lifelines));
                    let sender = sender.clone();
                    scope.spawn(move || {
                        let measured = measure(&job, &self.hyperplan, &self.supervisor, &lifelines);
                        // Nobody listens any more where that fails.
                        let _ = sender.send((lane, measured));
                    });
                }
                if running.is_empty() {
                    break Ok(None);
                }
                match finishes.recv_timeout(TICK) {
                    Ok((lane, measured)) => {
                        running.remove(&lane);
                        match measured {
                            Err(error) => break Err(error),
                            // It was of no use any more.
                            Ok(None) => {}
                            Ok(Some(measured)) => {
                                if let ControlFlow::Break(end) = foreman.ended(finish(lane, measured)) {
                                    break Ok(Some(end));
                                }
                            }
                        }
                    }
                    Err(RecvTimeoutError::Timeout) => {}
                    // We have a sender ourselves.
                    Err(RecvTimeoutError::Disconnected) => break Ok(None),
                }
                if foreman.over() {
                    break Ok(None);
                }
                foreman.moot().iter().filter_map(|lane| running.get(lane)).for_each(|line| line.cut());
            };
            running.values().for_each(|line| line.cut());
            outcome
        })
    }

    fn job(&self, arguments: &[String]) -> Job {
        Job {
            program: self.hyperplan.display().to_string(),
            arguments: arguments.to_vec(),
            temporary: self.temporary.display().to_string(),
            input: None,
            // Each keeps its own.
            limit: Limit::default(),
            grace_s: 0.0,
            cpu: None,
        }
    }
}

fn finish(lane: usize, measured: Measured) -> Finish {
    let stderr = measured.failure.unwrap_or(measured.stderr);
    Finish { lane, stdout: measured.stdout, stderr, exit_code: measured.exit_code }
}
