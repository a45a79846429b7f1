//! Runs, several at a time.

use std::fs;
use std::io::{self, Read as _, Write as _};
use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use hyperplan_problem::answer::ReasonCode;
use rustix::process::{Pid, Signal, kill_process, kill_process_group};

use crate::folders::{self, Folders};
use crate::heard::Heard;
use crate::plan::{Kind, Run};
use crate::query::Query;
use crate::reading::{self, Reading};
use crate::record::{Record, RunStatus};
use crate::supervise::{Job, Measured};
use crate::witness;

/// How often the flag of an interruption is looked at.
const TICK: Duration = Duration::from_millis(100);
/// How much later than its limits a supervisor may end a run.
const LATE: Duration = Duration::from_secs(5);
/// How much later than others this process may learn that all are to end.
const LEARN: Duration = Duration::from_millis(400);
/// How long hyperplan may take to end by itself when its time is over.
const GRACE: f64 = 2.0;

/// How runs are done.
#[derive(Clone, Debug)]
pub struct Setting {
    /// How many at a time.
    pub jobs: usize,
    /// The `hyperplan` program.
    pub hyperplan: PathBuf,
    /// Its arguments that make it [`supervise`](crate::supervise()).
    pub supervisor: Vec<String>,
    /// The folder of the comparison.
    pub folder: PathBuf,
    /// Whether to keep the queries of each run.
    pub queries: bool,
    /// The machine.
    pub host: String,
    /// The model of its processors.
    pub processor: Option<String>,
    /// The CPUs on which runs are kept, for each of those at a time one; empty where they may go where they like.
    pub pinned: Vec<usize>,
}

/// What happens to a run.
#[derive(Debug)]
pub enum Event<'a> {
    /// It begins.
    Started(&'a Run),
    /// It has ended.
    Finished(Box<Record>),
}

/// Removes what runs leave for the next, where nothing is in it; nobody may be running there.
pub fn tidy(folder: &Path) {
    folders::remove_if_empty(folder);
}

/// Does the runs, and tells of each. Gives whether all were done; `cancelled` ends those that are going on, of which
/// nothing is told. So does a failure of `tell`.
///
/// # Errors
/// When our own program cannot be started, files cannot be written, or `tell` fails.
pub fn run_all<E: From<io::Error> + Send>(
    runs: &[Run],
    setting: &Setting,
    cancelled: &AtomicBool,
    mut tell: impl FnMut(Event<'_>) -> Result<(), E>,
) -> Result<bool, E> {
    let next = AtomicUsize::new(0);
    let lifelines = Lifelines::default();
    let (sender, events) = mpsc::channel();
    thread::scope(|scope| {
        for worker in 0..setting.jobs.clamp(1, runs.len().max(1)) {
            let (sender, next, lifelines) = (sender.clone(), &next, &lifelines);
            let cpu = setting.pinned.get(worker).copied();
            scope.spawn(move || {
                while let Some(run) = runs.get(next.fetch_add(1, Ordering::Relaxed)) {
                    // Nobody listens any more where that fails.
                    let going = sender.send(Ok(Event::Started(run))).is_ok() && !lifelines.are_cut();
                    let finished = going.then(|| one(run, setting, cpu, lifelines)).transpose();
                    match finished.map(Option::flatten).transpose() {
                        Some(finished) => {
                            let _ = sender.send(finished.map(|record| Event::Finished(Box::new(record))));
                        }
                        None => return,
                    }
                }
            });
        }
        drop(sender);
        let mut finished = 0;
        let outcome = loop {
            match events.recv_timeout(TICK) {
                Ok(event) => {
                    finished += usize::from(matches!(event, Ok(Event::Finished(_))));
                    if let Err(error) = event.map_err(E::from).and_then(&mut tell) {
                        break Err(error);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break Ok(finished == runs.len()),
            }
            if cancelled.load(Ordering::SeqCst) {
                lifelines.cut();
                // What has ended meanwhile was done.
                while let Ok(event) = events.recv() {
                    finished += usize::from(matches!(event, Ok(Event::Finished(_))));
                    if let Ok(event @ Event::Finished(_)) = event {
                        tell(event)?;
                    }
                }
                break Ok(finished == runs.len());
            }
        };
        lifelines.cut();
        outcome
    })
}

/// The inputs of all supervisors. When they are closed, these end everything.
#[derive(Default)]
pub(crate) struct Lifelines(Mutex<State>);

#[derive(Default)]
struct State {
    cut: bool,
    open: Vec<(u32, ChildStdin)>,
}

impl Lifelines {
    pub(crate) fn are_cut(&self) -> bool {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).cut
    }

    /// Holds the line to a supervisor; it is closed at once where all were cut.
    fn hold(&self, id: u32, line: ChildStdin) {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !state.cut {
            state.open.push((id, line));
        }
    }

    fn release(&self, id: u32) {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        state.open.retain(|(other, _)| *other != id);
    }

    /// Where a scheduler ends a job, all of its processes get a signal, and this one may learn last that all is to end.
    fn are_cut_soon(&self) -> bool {
        let end = Instant::now() + LEARN;
        while !self.are_cut() && Instant::now() < end {
            thread::sleep(TICK / 4);
        }
        self.are_cut()
    }

    pub(crate) fn cut(&self) {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        state.cut = true;
        state.open.clear();
    }
}

/// Does one run; `None` where it was interrupted.
fn one(
    run: &Run,
    setting: &Setting,
    cpu: Option<usize>,
    lifelines: &Lifelines,
) -> io::Result<Option<Record>> {
    let folders = Folders::new(run, &setting.folder, setting.queries)?;
    let measured = match &run.instance.kind {
        Kind::Query(query) => {
            let copy = folders.copy(run)?;
            let file = copy.as_deref().unwrap_or(&run.instance.file);
            let job = Job { cpu, ..query_job(run, query, file, &folders) };
            let measured = measure(&job, &setting.hyperplan, &setting.supervisor, lifelines);
            copy.as_deref().map(fs::remove_file).transpose()?;
            measured
        }
        Kind::Problem { objective } => {
            let job = Job { cpu, ..problem_job(run, objective, setting, &folders) };
            measure(&job, &setting.hyperplan, &setting.supervisor, lifelines)
        }
    };
    // The run that was interrupted is done again, and its queries with it.
    let keep = |measured: &Measured| measured.exit_code.is_some_and(|code| code >= 4);
    folders.tidy(measured.as_ref().is_ok_and(|measured| measured.as_ref().is_some_and(keep)))?;
    let Some(measured) = measured? else { return Ok(None) };
    Ok(Some(record(run, setting, &measured, &folders)))
}

/// Has a supervisor do the job.
pub(crate) fn measure(
    job: &Job,
    hyperplan: &Path,
    supervisor: &[String],
    lifelines: &Lifelines,
) -> io::Result<Option<Measured>> {
    let mut command = Command::new(hyperplan);
    // In a group of its own: what is typed at the terminal is for us.
    command.args(supervisor).process_group(0);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
    let mut child: Child = command.spawn()?;
    let mut line = serde_json::to_vec(job)?;
    line.push(b'\n');
    if let Some(mut stdin) = child.stdin.take() {
        // If it has ended, it gives no outcome either.
        let _ = stdin.write_all(&line);
        lifelines.hold(child.id(), stdin);
    }
    let heard = hear(&mut child, job, lifelines);
    let status = child.wait();
    lifelines.release(child.id());
    let heard = heard?;
    // The number of the program, if it was started, and what became of it.
    let measured: Option<Measured> = heard.lines().last().and_then(|line| serde_json::from_str(line).ok());
    let program = heard.lines().next().and_then(|line| line.parse().ok());
    if let (None, Some(group)) = (&measured, program.and_then(Pid::from_raw)) {
        // Nobody else ends it any more.
        let _ = kill_process_group(group, Signal::KILL);
    }
    if measured.as_ref().is_none_or(Measured::is_signalled) && lifelines.are_cut_soon() {
        return Ok(None);
    }
    if measured.is_some() {
        return Ok(measured);
    }
    let failure = Some(format!("the process that measures it ended: {}", status?));
    Ok(Some(Measured { failure, ..Measured::default() }))
}

/// What a supervisor says. One that was stopped, by the program perhaps, is told to go on, and ended if that is of no use.
fn hear(child: &mut Child, job: &Job, lifelines: &Lifelines) -> io::Result<String> {
    let Some(mut stdout) = child.stdout.take() else { return Ok(String::new()) };
    let (sender, heard) = mpsc::channel();
    thread::Builder::new().name("hear".into()).spawn(move || {
        let mut said = String::new();
        let read = stdout.read_to_string(&mut said).map(|_| said);
        // Somebody waits for it.
        let _ = sender.send(read);
    })?;
    let allowed = job.limit.wall_s.map(|seconds| Duration::try_from_secs_f64(seconds + job.grace_s));
    let mut due = allowed.and_then(Result::ok).and_then(|time| Instant::now().checked_add(time + LATE));
    let mut told = false;
    loop {
        match heard.recv_timeout(TICK) {
            Ok(said) => return said,
            Err(RecvTimeoutError::Disconnected) => return Ok(String::new()),
            Err(RecvTimeoutError::Timeout) => {}
        }
        let now = Instant::now();
        if lifelines.are_cut() {
            due = Some(due.map_or(now + LATE, |due| due.min(now + LATE)));
        }
        if due.is_some_and(|due| now >= due) {
            if told {
                child.kill()?;
            } else if let Some(pid) = i32::try_from(child.id()).ok().and_then(Pid::from_raw) {
                // It may have ended meanwhile.
                let _ = kill_process(pid, Signal::CONT);
            }
            (told, due) = (true, Some(now + LATE));
        }
    }
}

fn problem_job(run: &Run, objective: &str, setting: &Setting, folders: &Folders) -> Job {
    let mut arguments: Vec<String> =
        ["solve", &run.instance.file, "--objective", objective, "--failures"].map(str::to_owned).to_vec();
    let mut option = |name: &str, value: String| arguments.extend([name.to_owned(), value]);
    option("--solver", run.solver.name.clone());
    option("--seed", run.seed.to_string());
    option("--format", "json".to_owned());
    let encoding = [("--quantifiers", &run.quantifiers), ("--states", &run.states)];
    for (name, value) in encoding.into_iter().filter_map(|(name, value)| Some((name, value.clone()?))) {
        option(name, value);
    }
    run.instance.set.iter().for_each(|set| option("--set", set.clone()));
    if let Some(seconds) = run.limit.wall_s {
        option("--timeout", seconds.to_string());
    }
    if let Some(mib) = run.limit.memory_mib {
        option("--memory", mib.to_string());
    }
    if let Some(folder) = &folders.queries {
        option("--queries", folders.full(folder));
    }
    arguments.extend(run.options.iter().cloned());
    Job {
        program: setting.hyperplan.display().to_string(),
        arguments,
        temporary: folders.full(&folders.temporary),
        input: None,
        limit: run.limit,
        grace_s: GRACE,
        cpu: None,
    }
}

fn query_job(run: &Run, query: &Query, file: &str, folders: &Folders) -> Job {
    let standalone = run.solver.standalone.as_ref();
    let (arguments, from_input) =
        standalone.map_or_else(Default::default, |standalone| standalone.arguments(file, query.incremental));
    Job {
        program: standalone.map_or_else(String::new, |standalone| standalone.program.display().to_string()),
        arguments,
        temporary: folders.full(&folders.temporary),
        input: from_input.then(|| file.to_owned()),
        limit: run.limit,
        grace_s: 0.0,
        cpu: None,
    }
}

fn record(run: &Run, setting: &Setting, measured: &Measured, folders: &Folders) -> Record {
    let Run { instance, solver, limit, .. } = run;
    let past = |limit: Option<f64>, used: f64| limit.is_some_and(|limit| used > limit);
    let over = if past(limit.cpu_s, measured.cpu_s) {
        Some("CPU time")
    } else {
        past(limit.wall_s, measured.wall_s).then_some("wall time")
    };
    let reading: Reading = match &instance.kind {
        Kind::Query(query) => {
            let heard = Heard::new(query, &measured.stdout);
            let reading = reading::of_query(measured, query, &heard, over.is_some()).sized(query);
            witness::checked(reading, query, &heard, &instance.file, measured)
        }
        Kind::Problem { .. } => {
            let said = reading::of_problem(measured, over.is_some());
            // One that failed does not say what it asked.
            let kept = if said.variables.is_none() { folders.largest() } else { None };
            let said = kept.iter().fold(said, Reading::sized);
            Reading { expected: instance.expected, ..said }
        }
    };
    let message = match (reading.status, reading.message) {
        // Which time it was; that it was the time says no more than the status.
        (RunStatus::Timeout, message) => {
            let more = reading.reason_code != Some(ReasonCode::Timeout);
            message.filter(|_| more).or(over.map(str::to_owned))
        }
        (_, message) => message,
    };
    Record {
        instance: instance.name.clone(),
        family: instance.family.clone(),
        sha256: instance.sha256.clone(),
        logic: reading.logic,
        states: run.states.clone(),
        quantifiers: run.quantifiers.clone(),
        horizon: instance.horizon.or(reading.horizon),
        set: instance.set.clone(),
        solver: solver.name.clone(),
        version: reading.version.or_else(|| solver.version.clone()),
        options: run.options.join(" "),
        seed: run.seed,
        repetition: run.repetition,
        status: reading.status,
        expected: reading.expected,
        verified: reading.verified,
        wall_s: rounded(measured.wall_s),
        cpu_s: rounded(measured.cpu_s),
        memory_mib: rounded(measured.memory_mib),
        limit: *limit,
        exit_code: measured.exit_code,
        signal: measured.signal,
        host: setting.host.clone(),
        variables: reading.variables,
        assertions: reading.assertions,
        bytes: reading.bytes,
        message: measured.failure.clone().or(message),
        queries: folders.queries.clone(),
        key: run.key.clone(),
        states_used: reading.states,
        quantifiers_used: reading.quantifiers,
        solver_s: reading.solver_s,
        rounds: reading.rounds,
        reason_code: reading.reason_code,
        processor: setting.processor.clone(),
        ended_ms: now_ms(),
        case: reading.case,
    }
}

fn now_ms() -> Option<u64> {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).ok()?;
    u64::try_from(since.as_millis()).ok()
}

/// To what can be measured.
fn rounded(number: f64) -> f64 {
    (number * 1e6).round() / 1e6
}

/// The folder, made if need be, as a path that does not depend on the current folder.
///
/// # Errors
/// When it cannot be made.
pub fn prepare(folder: &Path) -> io::Result<PathBuf> {
    fs::create_dir_all(folder)?;
    folder.canonicalize()
}
