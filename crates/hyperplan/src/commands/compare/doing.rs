//! Doing runs, with a log.

use crate::args;
use crate::failure::{Failure, Result};
use crate::files::cannot_write;
use crate::output::Output;
use crate::progress::Progress;
use crate::signals;
use hyperplan_compare::plan::Run;
use hyperplan_compare::{Event, Log, LogError, Record, Setting, cores, prepare, processor, run_all};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write as _};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// How runs are done on this machine, until a signal comes.
pub(super) struct Doing {
    setting: Setting,
    /// Whether runs are printed too.
    echo: bool,
    cancelled: Arc<AtomicBool>,
}

/// Why runs cannot go on.
#[derive(Debug, thiserror::Error)]
enum Stop {
    #[error("cannot go on: {0}")]
    Io(#[from] io::Error),
    #[error(transparent)]
    Log(#[from] LogError),
}

impl Doing {
    /// As the arguments say; makes the folder.
    pub(super) fn new(args: &args::Compare) -> Result<Doing> {
        let folder = prepare(&args.out).map_err(|error| cannot_write(&args.out, &error))?;
        let setting = Setting {
            jobs: args.jobs.into(),
            hyperplan: std::env::current_exe().map_err(Failure::input)?,
            supervisor: vec!["supervise".to_owned()],
            folder,
            queries: args.queries,
            host: host(),
            processor: processor(),
            pinned: if args.pin { pinned(args.jobs.into())? } else { Vec::new() },
        };
        Ok(Doing { setting, echo: args.cluster.echo, cancelled: cancelled() })
    }

    pub(super) fn folder(&self) -> &Path {
        &self.setting.folder
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::SeqCst)
    }

    pub(super) fn progress<'a>(&self, runs: usize, verbose: bool, out: &'a Output) -> Progress<'a> {
        Progress::new(runs, verbose, out)
    }

    /// Does the runs, writes each into the log, and tells of it; whether all were done.
    pub(super) fn all(
        &self,
        runs: &[Run],
        log: &mut Log,
        progress: &mut Progress<'_>,
        mut done: impl FnMut(Record),
    ) -> Result<bool> {
        let labels: BTreeMap<&str, String> = runs.iter().map(|run| (run.key.as_str(), run.label())).collect();
        let tell = |event: Event<'_>| -> Result<(), Stop> {
            match event {
                Event::Started(run) => progress.started(&run.label()),
                Event::Finished(record) => {
                    log.append(&record)?;
                    if self.echo {
                        // By one call, and whatever others have begun to write there.
                        let line =
                            format!("\n{}\n", serde_json::to_string(&record).map_err(io::Error::from)?);
                        io::stdout().lock().write_all(line.as_bytes())?;
                    }
                    progress.finished(labels.get(record.key.as_str()).map_or("", String::as_str), &record);
                    done(*record);
                }
            }
            Ok(())
        };
        run_all(runs, &self.setting, &self.cancelled, tell).map_err(Failure::input)
    }
}

/// A flag that is set when a signal comes.
pub(super) fn cancelled() -> Arc<AtomicBool> {
    let cancelled = Arc::new(AtomicBool::new(false));
    signals::watch(&cancelled);
    cancelled
}

/// The name of this machine.
pub(super) fn host() -> String {
    rustix::system::uname().nodename().to_string_lossy().into_owned()
}

/// The keys of some runs.
pub(super) fn keys(records: &[Record]) -> BTreeSet<String> {
    records.iter().map(|record| record.key.clone()).collect()
}

/// A core for each of so many runs at a time.
fn pinned(jobs: usize) -> Result<Vec<usize>> {
    let mut cores =
        cores().map_err(|error| Failure::input(format_args!("--pin cannot be had here: {error}")))?;
    if cores.len() < jobs {
        return Err(Failure::input(format_args!(
            "--pin with --jobs {jobs} takes {jobs} cores, and there are {}",
            cores.len()
        )));
    }
    cores.truncate(jobs);
    Ok(cores)
}
