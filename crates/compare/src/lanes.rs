//! Runs of hyperplan side by side, each with all that it starts below a process that ends it: not to be measured, but for the
//! first that is good enough.

use std::io;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
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

/// What came of a lane.
#[derive(Clone, Debug)]
pub struct Finish {
    /// Its place among all.
    pub lane: usize,
    /// What it printed.
    pub stdout: String,
    /// The end of what it said besides.
    pub stderr: String,
    /// Its exit code, if it had one.
    pub exit_code: Option<i32>,
}

impl Lanes {
    /// Runs hyperplan with each of the arguments, in this order, and tells of each that ends, until that breaks, or
    /// `over` says so: then all others end at once, with everything that they have started.
    ///
    /// # Errors
    /// When our own program cannot be started.
    pub fn run<B>(
        &self,
        lanes: &[Vec<String>],
        over: impl Fn() -> bool,
        mut tell: impl FnMut(Finish) -> ControlFlow<B>,
    ) -> io::Result<Option<B>> {
        let next = AtomicUsize::new(0);
        let lifelines = Lifelines::default();
        let (sender, finishes) = mpsc::channel();
        thread::scope(|scope| {
            for _ in 0..self.at_a_time.clamp(1, lanes.len().max(1)) {
                let (sender, next, lifelines) = (sender.clone(), &next, &lifelines);
                scope.spawn(move || {
                    while !lifelines.are_cut() {
                        let lane = next.fetch_add(1, Ordering::Relaxed);
                        let Some(arguments) = lanes.get(lane) else { return };
                        let measured =
                            measure(&self.job(arguments), &self.hyperplan, &self.supervisor, lifelines);
                        // Nobody listens any more where that fails.
                        let _ = sender.send(measured.map(|measured| (lane, measured)));
                    }
                });
            }
            drop(sender);
            let outcome = loop {
                match finishes.recv_timeout(TICK) {
                    Ok(Ok((lane, Some(measured)))) => {
                        if let ControlFlow::Break(found) = tell(finish(lane, measured)) {
                            break Ok(Some(found));
                        }
                    }
                    Ok(Ok((_, None))) => {}
                    Ok(Err(error)) => break Err(error),
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => break Ok(None),
                }
                if over() {
                    break Ok(None);
                }
            };
            lifelines.cut();
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
