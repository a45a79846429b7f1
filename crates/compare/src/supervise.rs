//! One process and all that it starts: measured, limited, and gone at the end.
//!
//! Each run has a process of ours between the comparison and the program, the *supervisor*. On Linux it adopts whatever
//! in its tree loses its parent, so that the CPU time of everything that was started is in its own account when all of
//! it has ended, and nothing is left behind, however it detached itself. Its standard input is a lifeline: the
//! comparison writes one line, the [`Job`], and holds the pipe open; when that is closed, because the comparison was
//! interrupted or killed, the supervisor ends everything.
//!
//! What is measured: wall time from the start of the program to its own end; CPU time, user and system, of the
//! whole tree, from the kernel's account; memory as the largest sum of the resident memory of all processes seen at one
//! moment (looked at every 20 ms, pages that two share counted twice), and at least the peak of any one process.
//! Elsewhere than on Linux memory is the peak of the largest process only, and CPU time is known only at the end.

use std::fs::File;
use std::io::{self, BufRead as _, Read, Write as _};
use std::os::unix::process::CommandExt as _;
use std::process::{Command, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use nix::sys::resource::{UsageWho, getrusage};
use rustix::process::{Pid, WaitOptions, WaitStatus};
use serde::{Deserialize, Serialize};

use crate::record::Limit;
use crate::{machine, tree};

/// How often the tree is looked at; at first more often, since most runs are short.
const TICK: Duration = Duration::from_millis(20);
const FIRST_TICK: Duration = Duration::from_millis(1);
/// How much of standard output is kept, from its beginning.
const KEPT: usize = 64 << 20;
/// How much of standard error is kept, of its end.
const TAIL: usize = 4 << 10;
/// How long what was killed may take to end.
const PATIENCE: Duration = Duration::from_secs(10);

/// What to run, and within which limits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Job {
    /// The program.
    pub(crate) program: String,
    /// Its arguments.
    pub(crate) arguments: Vec<String>,
    /// Where it puts temporary files.
    pub(crate) temporary: String,
    /// The file that is its standard input.
    pub(crate) input: Option<String>,
    /// Its limits.
    pub(crate) limit: Limit,
    /// How long after its wall limit it is ended, in seconds: so that a program that knows the limit can end by itself.
    pub(crate) grace_s: f64,
    /// The only CPU that it may use.
    pub(crate) cpu: Option<usize>,
}

/// Which limit was exceeded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Exceeded {
    /// The wall or CPU time.
    Time,
    /// The memory.
    Memory,
}

/// What came of a job.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Measured {
    /// Why it could not be run.
    pub(crate) failure: Option<String>,
    /// Its exit code, if it had one.
    pub(crate) exit_code: Option<i32>,
    /// The signal that ended it.
    pub(crate) signal: Option<i32>,
    /// For which of its limits it was ended.
    pub(crate) exceeded: Option<Exceeded>,
    /// Wall time in seconds.
    pub(crate) wall_s: f64,
    /// CPU time in seconds, of everything.
    pub(crate) cpu_s: f64,
    /// Peak memory in MiB, of everything.
    pub(crate) memory_mib: f64,
    /// What it wrote to standard output.
    pub(crate) stdout: String,
    /// The end of what it wrote to standard error.
    pub(crate) stderr: String,
}

impl Measured {
    /// Whether it may have written more to standard output than was kept.
    pub(crate) fn is_cut(&self) -> bool {
        self.stdout.len() >= KEPT
    }

    /// Whether a signal ended it that was not ours.
    pub(crate) fn is_signalled(&self) -> bool {
        // As hyperplan and shells say it: 128 and the number of INT or TERM.
        let said = matches!(self.exit_code, Some(130 | 143));
        self.exceeded.is_none() && (self.signal.is_some() || said)
    }
}

enum Event {
    Ended(Pid, WaitStatus, Instant),
    /// Nothing is left of the tree.
    Gone,
    /// The comparison has gone.
    Stop,
}

/// Reads a job from standard input and does it; the outcome, a line of JSON, goes to standard output. Nothing is
/// written where the comparison has gone.
///
/// This is all that the process does: every child of it is taken for a part of the job.
///
/// # Errors
/// When there is no job, or nobody reads the outcome.
pub fn supervise() -> io::Result<()> {
    let mut line = String::new();
    io::stdin().lock().read_line(&mut line)?;
    let job: Job = serde_json::from_str(&line)?;
    let (sender, events) = mpsc::channel();
    let stop = sender.clone();
    thread::Builder::new().name("lifeline".into()).spawn(move || {
        // Nothing more is ever said.
        let _ = io::copy(&mut io::stdin().lock(), &mut io::sink());
        let _ = stop.send(Event::Stop);
    })?;
    let pinned = job.cpu.map_or(Ok(()), machine::pin);
    let measured = match pinned.and_then(|()| Supervised::start(&job, sender)) {
        Ok(supervised) => supervised.watch(&job, &events),
        Err(error) => Some(Measured {
            failure: Some(format!("cannot run {}: {error}", job.program)),
            ..Measured::default()
        }),
    };
    let Some(measured) = measured else { return Ok(()) };
    let mut line = serde_json::to_vec(&measured)?;
    line.push(b'\n');
    io::stdout().lock().write_all(&line)
}

struct Supervised {
    main: Pid,
    start: Instant,
    stdout: JoinHandle<Vec<u8>>,
    stderr: JoinHandle<Vec<u8>>,
    /// The most memory that this process had when it started the program, whose own account begins with that.
    inherited: u64,
    peak: u64,
}

impl Supervised {
    fn start(job: &Job, sender: Sender<Event>) -> io::Result<Supervised> {
        tree::adopt();
        let input = job.input.as_ref().map(File::open).transpose()?;
        let mut command = Command::new(&job.program);
        command.args(&job.arguments).env("TMPDIR", &job.temporary).process_group(0);
        command.stdin(input.map_or_else(Stdio::null, Stdio::from));
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        hyperplan_solver::end_with_parent(&mut command);
        let inherited = tree::own_peak();
        let start = Instant::now();
        let mut child = command.spawn()?;
        let pid = i32::try_from(child.id()).ok().and_then(Pid::from_raw);
        let main = pid.ok_or_else(|| io::Error::other("a process without a number"))?;
        // At once, for who has to end it if this process is killed.
        let _ = writeln!(io::stdout().lock(), "{}", main.as_raw_nonzero());
        let none = || io::Error::other("a process without its pipes");
        let stdout = child.stdout.take().ok_or_else(none)?;
        let stderr = child.stderr.take().ok_or_else(none)?;
        let stdout = thread::Builder::new().name("output".into()).spawn(move || head(stdout))?;
        let stderr = thread::Builder::new().name("errors".into()).spawn(move || tail(stderr))?;
        thread::Builder::new().name("reaper".into()).spawn(move || reap(&sender))?;
        Ok(Supervised { main, start, stdout, stderr, inherited, peak: 0 })
    }

    /// Waits for the end, and sees to it that it is one; `None` if the comparison went first.
    fn watch(mut self, job: &Job, events: &Receiver<Event>) -> Option<Measured> {
        let mut measured = Measured::default();
        let mut tick = FIRST_TICK;
        let (ended, stopped) = loop {
            match events.recv_timeout(tick) {
                Ok(Event::Ended(pid, status, at)) if pid == self.main => break (Some((status, at)), false),
                Ok(Event::Ended(..)) => continue,
                Ok(Event::Stop) => break (None, true),
                Err(RecvTimeoutError::Timeout) => {}
                Ok(Event::Gone) | Err(RecvTimeoutError::Disconnected) => break (None, false),
            }
            measured.exceeded = self.exceeded(job);
            if measured.exceeded.is_some() {
                break (None, false);
            }
            tick = (tick * 2).min(TICK);
        };
        let killed = Instant::now();
        let last = self.end(events);
        let (status, at) = ended.or(last).map_or((None, killed), |(status, at)| (Some(status), at));
        if stopped {
            return None;
        }
        measured.exit_code = status.and_then(|status| status.exit_status());
        measured.signal = status.and_then(|status| status.terminating_signal());
        measured.wall_s = at.saturating_duration_since(self.start).as_secs_f64();
        let (cpu_s, largest) = children();
        measured.cpu_s = cpu_s;
        // The account of a process begins with the memory of who started it: up to that it says nothing.
        if self.peak == 0 || largest > self.inherited {
            self.peak = self.peak.max(largest);
        }
        measured.memory_mib = self.peak as f64 / f64::from(1 << 20);
        measured.stdout = text(self.stdout);
        measured.stderr = text(self.stderr);
        Some(measured)
    }

    /// The limit that is exceeded now.
    fn exceeded(&mut self, job: &Job) -> Option<Exceeded> {
        let load = tree::load();
        self.peak = self.peak.max(load.memory).max(load.largest);
        let over = |limit: Option<f64>, now: f64| limit.is_some_and(|limit| now > limit);
        let wall = job.limit.wall_s.map(|limit| limit + job.grace_s);
        if job.limit.memory_mib.is_some_and(|mib| self.peak >> 20 >= mib) {
            Some(Exceeded::Memory)
        } else if over(wall, self.start.elapsed().as_secs_f64())
            || over(job.limit.cpu_s, children().0 + load.cpu_s)
        {
            Some(Exceeded::Time)
        } else {
            None
        }
    }

    /// Kills until nothing is left; gives the end of the program itself, if that comes now.
    fn end(&self, events: &Receiver<Event>) -> Option<(WaitStatus, Instant)> {
        let deadline = Instant::now() + PATIENCE;
        let mut last = None;
        while Instant::now() < deadline {
            tree::kill(self.main);
            match events.recv_timeout(TICK) {
                Ok(Event::Ended(pid, status, at)) if pid == self.main => last = Some((status, at)),
                Ok(Event::Gone) | Err(RecvTimeoutError::Disconnected) => return last,
                _ => {}
            }
        }
        last
    }
}

/// CPU time and the peak memory of the largest, of all processes that were waited for.
fn children() -> (f64, u64) {
    // It fails for wrong arguments only.
    let Ok(usage) = getrusage(UsageWho::RUSAGE_CHILDREN) else { return (0.0, 0) };
    let seconds = |time: nix::sys::time::TimeVal| time.tv_sec() as f64 + time.tv_usec() as f64 / 1e6;
    let unit = if cfg!(target_vendor = "apple") { 1 } else { 1 << 10 };
    let largest = u64::try_from(usage.max_rss()).unwrap_or(0) * unit;
    (seconds(usage.user_time()) + seconds(usage.system_time()), largest)
}

/// Waits for every process of the tree that has become a child of this one.
fn reap(sender: &Sender<Event>) {
    loop {
        let event = match rustix::process::wait(WaitOptions::empty()) {
            Ok(Some((pid, status))) => Event::Ended(pid, status, Instant::now()),
            Ok(None) | Err(rustix::io::Errno::INTR) => continue,
            // There is no child any more, and nobody left who could start one.
            Err(_) => Event::Gone,
        };
        let over = matches!(event, Event::Gone);
        if sender.send(event).is_err() || over {
            return;
        }
    }
}

/// The beginning of what comes; the rest is read and forgotten.
fn head(mut pipe: impl Read) -> Vec<u8> {
    let mut kept = Vec::new();
    let _ = pipe.by_ref().take(KEPT as u64).read_to_end(&mut kept);
    let _ = io::copy(&mut pipe, &mut io::sink());
    kept
}

/// The end of what comes.
fn tail(mut pipe: impl Read) -> Vec<u8> {
    let mut kept = Vec::new();
    let mut buffer = [0; TAIL];
    loop {
        match pipe.read(&mut buffer) {
            Ok(0) => return kept,
            Ok(count) => {
                kept.extend_from_slice(&buffer[..count]);
                let excess = kept.len().saturating_sub(TAIL);
                kept.drain(..excess);
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(_) => return kept,
        }
    }
}

/// What a reader has read. All writers have ended, or will never: then it is not waited for.
fn text(reader: JoinHandle<Vec<u8>>) -> String {
    let end = Instant::now() + Duration::from_secs(1);
    while !reader.is_finished() && Instant::now() < end {
        thread::sleep(FIRST_TICK);
    }
    let read = if reader.is_finished() { reader.join().unwrap_or_default() } else { Vec::new() };
    String::from_utf8_lossy(&read).into_owned()
}
