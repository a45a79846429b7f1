//! A comparison on a cluster: an array job does the runs, and this process watches it and gathers what it has done.
//!
//! Each task does a share of a plan, with a log of its own (`super::shard`). Nothing has to be remembered of a job but its name,
//! which comes from the folder of the comparison: who calls the same command again, after whatever has happened, finds a
//! job that still runs, and the logs of all tasks that there were.

use super::comparison::Comparison;
use super::doing::cancelled;
use super::gather::Gathered;
use super::{in_order, open, report, told_before};
use crate::args;
use crate::failure::{Exit, Failure, Result};
use crate::files::{cannot_write, write_bytes};
use crate::output::Output;
use crate::progress::Progress;
use hyperplan_compare::plan::{Run, sha256};
use hyperplan_compare::share::{expected, most, shares};
use hyperplan_compare::slurm::{self, Order, SlurmError, quoted};
use hyperplan_compare::{Record, prepare, tidy};
use hyperplan_outlet::one_line;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// What a task is to take, by what is expected, in seconds: long enough that starting it does not matter.
const TASK: f64 = 600.0;
/// Clusters take arrays up to 1000 if nobody has changed it.
const MOST_TASKS: usize = 1000;
/// What a task may take besides its runs: to start, to read its files, and to end each run.
const START: f64 = 60.0;
const END: f64 = 5.0;
/// What a task may need besides its runs, in MiB.
const OWN_MEMORY: u64 = 256;
/// How often Slurm is asked: at first more often.
const FIRST_LOOK: Duration = Duration::from_millis(500);
const LOOK: Duration = Duration::from_secs(5);
/// How long Slurm may give no answer.
const PATIENCE: Duration = Duration::from_secs(300);
/// How long cancelled tasks may take to end.
const ENDING: Duration = Duration::from_secs(60);
/// How many jobs in a row may bring nothing.
const IN_VAIN: usize = 2;

pub(super) fn run(args: &args::Compare, comparison: &Comparison, verbose: bool, out: &mut Output) -> Result {
    let runs = comparison.runs(out)?;
    let folder = prepare(&args.out).map_err(|error| cannot_write(&args.out, &error))?;
    let (log, past) = open(&args.out, out)?;
    let mut gathered = Gathered::new(&folder, args.cluster.unshared, log, past);
    gathered.all(&mut |_| ())?;
    let name = format!("hyperplan-{}", &sha256(folder.display().to_string().as_bytes())[..12]);
    let all = gathered.missing(&runs).len();
    told_before(runs.len() - all, runs.len(), out);
    let mut watch = Watch {
        args,
        comparison,
        runs: &runs,
        folder,
        name,
        cancelled: cancelled(),
        progress: Progress::new(all, verbose, out),
        out,
        told: BTreeSet::new(),
    };
    let ended = watch.jobs(&mut gathered);
    let folder = watch.folder.clone();
    drop(watch);
    let missing = gathered.missing(&runs).len();
    let kept = format!(
        "{} of {} runs are done, and kept in {}; the same command does the others",
        runs.len() - missing,
        runs.len(),
        args.out.display()
    );
    match ended {
        Ok(true) => {
            tidy(&folder);
            report(args, &in_order(gathered.about(&runs), &runs, out), out)
        }
        Ok(false) => {
            out.error(format_args!("interrupted: {kept}"));
            Ok(Exit::Undecided)
        }
        Err(failure) => Err(Failure::new(failure.status, format_args!("{}; {kept}", failure.message))),
    }
}

struct Watch<'a> {
    args: &'a args::Compare,
    comparison: &'a Comparison,
    runs: &'a [Run],
    folder: PathBuf,
    name: String,
    cancelled: Arc<AtomicBool>,
    progress: Progress<'a>,
    out: &'a Output,
    /// What was said once.
    told: BTreeSet<String>,
}

impl Watch<'_> {
    /// Has jobs do what is missing until nothing is; whether it was not interrupted.
    fn jobs(&mut self, gathered: &mut Gathered) -> Result<bool> {
        let mut in_vain = 0;
        // One that an earlier call left.
        let mut job = None;
        let mut goes_on = !self.tasks()?.is_empty();
        if goes_on {
            self.out.remark(format_args!("note: job {} still runs, and is watched", self.name));
        }
        loop {
            let missing = gathered.missing(self.runs);
            if missing.is_empty() {
                return Ok(true);
            }
            if !goes_on {
                job = Some(self.submit(&missing, gathered.records())?);
            }
            if !self.wait(gathered)? {
                return Ok(false);
            }
            goes_on = false;
            let left = gathered.missing(self.runs).len();
            in_vain = if left < missing.len() { 0 } else { in_vain + 1 };
            if left == 0 {
                continue;
            }
            let mut ends = job.as_deref().map(slurm::failures).unwrap_or_default();
            ends.truncate(5);
            let why = if ends.is_empty() { String::new() } else { format!(" ({})", ends.join("; ")) };
            if in_vain >= IN_VAIN {
                let said = self.last_words();
                return Err(Failure::new(
                    Exit::Undecided,
                    format_args!("{left} runs get lost again and again{why}{said}"),
                ));
            }
            self.out.remark(format_args!("note: {left} runs were lost, and are submitted again{why}"));
        }
    }

    /// Submits a job for some runs; gives its number.
    fn submit(&self, missing: &[Run], past: &[Record]) -> Result<String> {
        let folder = self.folder.join("slurm");
        std::fs::create_dir_all(&folder).map_err(|error| cannot_write(&folder, &error))?;
        let seconds = expected(missing, past);
        let wanted = (seconds.iter().sum::<f64>() / TASK).ceil() as usize;
        let tasks =
            self.args.cluster.tasks.map_or(wanted, usize::from).clamp(1, missing.len().min(MOST_TASKS));
        let text = self.comparison.text(missing, &seconds)?;
        let id = &sha256(text.as_bytes())[..8];
        let plan = folder.join(format!("plan-{id}.jsonl"));
        write_bytes(&plan, text.as_bytes())?;
        let limit = &self.comparison.ways.limit;
        let jobs = self.args.jobs;
        let mut longest = vec![0.0; tasks];
        for (run, share) in missing.iter().zip(shares(&seconds, tasks)) {
            longest[share] += most(&run.limit) + END;
        }
        let longest = longest.into_iter().fold(0.0, f64::max) / f64::from(jobs) + most(limit);
        let memory = limit.memory_mib.map(|mib| (mib + mib / 8) * u64::from(jobs) + OWN_MEMORY);
        let current = std::env::current_dir().map_err(Failure::input)?;
        let order = Order {
            name: &self.name,
            current: &current,
            output: &folder.join(format!("{id}-%A-%a.out")),
            tasks,
            cores: jobs,
            memory_mib: memory,
            seconds: longest + START,
            exclusive: self.args.cluster.exclusive,
            options: &self.args.cluster.submit,
            body: &self.body(tasks, &plan, &text)?,
        };
        let script = folder.join(format!("job-{id}.sh"));
        let job = order.submit(&script).map_err(Failure::input)?;
        self.out.remark(format_args!("note: job {job} does {} runs in {tasks} tasks", missing.len()));
        Ok(job)
    }

    /// What a task does.
    fn body(&self, tasks: usize, plan: &Path, text: &str) -> Result<String> {
        let program = std::env::current_exe().map_err(Failure::input)?;
        let word = |path: &Path| quoted(&path.display().to_string());
        let mut command = format!(
            "{} compare --shard \"$SLURM_ARRAY_TASK_ID/{tasks}\" --jobs {} --log \
             \"runs-$SLURM_ARRAY_JOB_ID-$SLURM_ARRAY_TASK_ID-${{SLURM_RESTART_COUNT:-0}}.jsonl\"",
            word(&program),
            self.args.jobs
        );
        for (wanted, option) in [(self.args.pin, " --pin"), (self.args.queries, " --queries")] {
            command += if wanted { option } else { "" };
        }
        if !self.args.cluster.unshared {
            return Ok(format!("exec {command} --plan {} --out {}\n", word(plan), word(&self.folder)));
        }
        // The plan comes with the script, and the log goes with what is printed.
        Ok(format!(
            "out=$(mktemp -d) || exit\ntrap 'rm -rf \"$out\"' EXIT\n\
             {command} --quiet --echo --plan - --out \"$out\" <<'END-OF-PLAN' &\n{text}END-OF-PLAN\n\
             trap 'kill $!; wait $!' TERM INT\nwait $!\n"
        ))
    }

    /// Waits until no task is left, or nothing is missing; whether it was not interrupted.
    fn wait(&mut self, gathered: &mut Gathered) -> Result<bool> {
        let (mut look, mut heard) = (FIRST_LOOK, Instant::now());
        loop {
            let tasks = self.tasks();
            gathered.all(&mut |record| self.progress.finished(&label(record), record))?;
            if gathered.missing(self.runs).is_empty() || self.cancelled.load(Ordering::SeqCst) {
                // What is left has nothing to do, or is to end.
                return self.cancel(gathered);
            }
            match tasks {
                Ok(tasks) if tasks.is_empty() => {
                    // What was written last may take a moment to be seen here.
                    thread::sleep(FIRST_LOOK);
                    gathered.all(&mut |record| self.progress.finished(&label(record), record))?;
                    return Ok(true);
                }
                Ok(tasks) => {
                    heard = Instant::now();
                    for task in tasks.iter().filter(|task| task.is_stuck()) {
                        if self.told.insert(task.reason.clone()) {
                            self.out.remark(format_args!("note: tasks wait: {}", task.reason));
                        }
                    }
                }
                Err(failure) if heard.elapsed() > PATIENCE => return Err(failure),
                Err(_) => {}
            }
            let until = Instant::now() + look;
            while Instant::now() < until && !self.cancelled.load(Ordering::SeqCst) {
                thread::sleep(FIRST_LOOK / 5);
            }
            look = (look * 3 / 2).min(LOOK);
        }
    }

    fn tasks(&self) -> Result<Vec<slurm::Task>> {
        slurm::tasks(&self.name).map_err(cannot)
    }

    /// Ends what is left, and gathers the rest; whether it was not interrupted.
    fn cancel(&mut self, gathered: &mut Gathered) -> Result<bool> {
        let interrupted = self.cancelled.load(Ordering::SeqCst);
        let end = Instant::now() + ENDING;
        let mut asked = false;
        while Instant::now() < end {
            asked = asked || slurm::cancel(&self.name).is_ok();
            if asked && self.tasks().is_ok_and(|tasks| tasks.is_empty()) {
                break;
            }
            thread::sleep(FIRST_LOOK);
        }
        if !asked {
            self.out
                .error(format_args!("Slurm does not answer; to end the job: scancel --name {}", self.name));
        }
        gathered.all(&mut |record| self.progress.finished(&label(record), record))?;
        Ok(!interrupted || gathered.missing(self.runs).is_empty())
    }

    /// What the last task complained of that did.
    fn last_words(&self) -> String {
        for path in super::gather::outputs(&self.folder).unwrap_or_default().iter().rev() {
            let text = std::fs::read_to_string(path).unwrap_or_default();
            let errors: Vec<&str> = text.lines().filter(|line| line.starts_with("error")).take(3).collect();
            if !errors.is_empty() {
                return format!("; a task said: {}", errors.join("; "));
            }
        }
        String::new()
    }
}

/// What a run is called.
fn label(record: &Record) -> String {
    let words = [&record.instance].into_iter().chain(&record.set).chain([&record.solver]);
    one_line(&words.map(String::as_str).collect::<Vec<_>>().join(" ")).into_owned()
}

fn cannot(error: SlurmError) -> Failure {
    Failure::input(error)
}
