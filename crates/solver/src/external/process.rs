//! A solver process: its pipes never block us, and it and its children do not outlive us.
//!
//! A keeper thread starts the process and writes to it, two threads read its outputs. Sending waits
//! for a full pipe only while it drains what the solver says, so that a solver that answers early,
//! floods us or closes its input cannot hang us. The process leads a group of its own, which is
//! killed whole. On Linux the kernel also kills it when the keeper dies with us; the keeper lives as
//! long as the session, since that signal follows the thread that started the process. For the rest
//! of the group there is the [`watchdog`](super::watchdog).

use std::io::{self, Read, Write};
use std::path::Path;
use std::process::{ChildStderr, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, SyncSender, TrySendError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use process_wrap::std::{ChildWrapper, CommandWrap, ProcessGroup};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};

use super::reply::{Reply, Splitter};
use super::watchdog::{self, Watched};
use crate::deadline::Deadline;

/// How often to look at the clock and the cancel flag while waiting.
const TICK: Duration = Duration::from_millis(20);
/// How long output may still come after the process has exited.
const ABANDONED: Duration = Duration::from_millis(300);
/// How much of standard error is remembered.
const TAIL: usize = 4096;
/// Unread replies while we are still sending: more than this is no dialogue.
const UNREAD: usize = 10_000;

/// What came of waiting.
pub(super) enum Next {
    Reply(Reply),
    /// The solver closed its output.
    Ended,
    /// The deadline came first.
    Deadline,
}

/// A running solver process.
pub(super) struct Process {
    child: Box<dyn ChildWrapper>,
    input: SyncSender<Vec<u8>>,
    output: Receiver<Vec<u8>>,
    errors: Arc<Mutex<Vec<u8>>>,
    error_reader: JoinHandle<()>,
    splitter: Splitter,
    ended: bool,
    cut: bool,
    watched: Option<Watched>,
    status: Option<String>,
    /// Since when it is known to have exited, though something holds its output open.
    exited: Option<Instant>,
}

impl Process {
    pub(super) fn spawn(
        program: &Path,
        arguments: &[String],
        memory_mib: Option<u64>,
    ) -> io::Result<Process> {
        let mut command = Command::new(program);
        command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        prepare(&mut command, memory_mib);
        let (input, chunks) = mpsc::sync_channel::<Vec<u8>>(16);
        let (started, start) = mpsc::channel();
        thread::Builder::new().name("solver input".into()).spawn(move || keep(command, &started, &chunks))?;
        // Meanwhile: it takes as long as starting the solver.
        watchdog::begin();
        let ended = || io::Error::other("the thread that starts solvers ended");
        let mut child = start.recv().map_err(|_| ended())??;
        let watched = Some(Watched::group(child.id()));
        let stdout = child.stdout().take().ok_or_else(ended)?;
        let stderr = child.stderr().take().ok_or_else(ended)?;
        let (sender, output) = mpsc::sync_channel(16);
        thread::Builder::new().name("solver output".into()).spawn(move || read_output(stdout, &sender))?;
        let errors = Arc::new(Mutex::new(Vec::new()));
        let tail = Arc::clone(&errors);
        let error_reader = thread::Builder::new().name("solver errors".into());
        let error_reader = error_reader.spawn(move || read_errors(stderr, &tail))?;
        Ok(Process {
            child,
            input,
            output,
            errors,
            error_reader,
            splitter: Splitter::default(),
            ended: false,
            cut: false,
            watched,
            status: None,
            exited: None,
        })
    }

    /// Sends a piece, or stops early: when the solver reports an error, floods us, or the deadline
    /// passes. What comes next then tells.
    pub(super) fn send(&mut self, mut piece: Vec<u8>, deadline: &Deadline) {
        while !self.cut {
            match self.input.try_send(piece) {
                Ok(()) | Err(TrySendError::Disconnected(_)) => return,
                Err(TrySendError::Full(back)) => piece = back,
            }
            if self.stuck() || deadline.passed() {
                self.cut = true;
                return;
            }
            self.drain(if self.ended { TICK } else { Duration::from_millis(1) });
            if self.ended {
                return;
            }
        }
    }

    /// Lines may be as long as other replies.
    pub(super) fn take_long_lines(&mut self) {
        self.splitter.take_long_lines();
    }

    /// There is no more to send.
    pub(super) fn close_input(&mut self) {
        // The keeper takes an empty piece for the end.
        let _ = self.input.try_send(Vec::new());
    }

    /// Whether it can say nothing more.
    pub(super) fn has_ended(&self) -> bool {
        self.ended
    }

    fn stuck(&self) -> bool {
        self.splitter.has_error() || self.splitter.unread() > UNREAD
    }

    /// Whether something that was to be sent was not: an answer would not be about all of it.
    pub(super) fn is_cut(&self) -> bool {
        self.cut
    }

    /// Whether to send no more: the solver has reported an error that was not read yet, or floods us.
    pub(super) fn must_stop(&mut self) -> bool {
        // A solver that floods us may write as fast as we read.
        while !self.stuck() {
            match self.output.try_recv() {
                Ok(chunk) => self.splitter.feed(&chunk),
                Err(_) => return false,
            }
        }
        self.cut = true;
        true
    }

    /// The next reply.
    pub(super) fn next(&mut self, deadline: &Deadline) -> Next {
        loop {
            if let Some(reply) = self.splitter.next() {
                return Next::Reply(reply);
            }
            if self.ended {
                return Next::Ended;
            }
            if deadline.passed() {
                return Next::Deadline;
            }
            self.drain(deadline.remaining().map_or(TICK, |remaining| remaining.min(TICK)));
        }
    }

    /// Takes what the solver has said, waiting at most so long for the first piece.
    fn drain(&mut self, wait: Duration) {
        match self.output.recv_timeout(wait) {
            Ok(chunk) => self.splitter.feed(&chunk),
            Err(RecvTimeoutError::Timeout) if self.is_abandoned() => self.end(),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => self.end(),
        }
    }

    fn end(&mut self) {
        self.ended = true;
        self.splitter.finish();
    }

    /// Whether the process has exited a while ago: a child of its own that holds the output open has nothing to say.
    fn is_abandoned(&mut self) -> bool {
        if self.exited.is_none() && self.pid().is_none_or(has_exited) {
            self.exited = Some(Instant::now());
        }
        self.exited.is_some_and(|exited| exited.elapsed() > ABANDONED)
    }

    fn pid(&self) -> Option<Pid> {
        i32::try_from(self.child.id()).ok().and_then(Pid::from_raw)
    }

    /// The end of what it wrote to standard error.
    pub(super) fn last_errors(&self) -> String {
        let tail = self.errors.lock().unwrap_or_else(PoisonError::into_inner);
        String::from_utf8_lossy(&tail).trim().to_owned()
    }

    /// Kills the whole group and gives the exit status: the process's own, if it had ended before.
    pub(super) fn kill(&mut self) -> String {
        if let Some(status) = &self.status {
            return status.clone();
        }
        // Output is closed: it is probably about to end by itself, with a status worth showing.
        let patience = Duration::from_millis(if self.ended { 200 } else { 0 });
        let pid = self.pid();
        let own_end = wait_until(patience, || pid.is_none_or(has_exited).then_some(())).is_some();
        // Fails only if nothing is left of the group. Nobody has waited for the process yet, so the number is its own.
        let _ = self.child.start_kill();
        self.watched = None;
        let status = wait_until(Duration::from_secs(2), || self.child.try_wait().ok().flatten());
        // What it said last may be on its way yet. Only a process that left the group can keep the pipe open.
        wait_until(Duration::from_millis(200), || self.error_reader.is_finished().then_some(()));
        let status = match status {
            Some(status) if own_end => ExitStatus::to_string(&status),
            _ if self.ended => "it closed its output".to_owned(),
            _ => "killed".to_owned(),
        };
        self.status = Some(status.clone());
        status
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.kill();
    }
}

fn wait_until<T>(at_most: Duration, mut done: impl FnMut() -> Option<T>) -> Option<T> {
    let end = Instant::now() + at_most;
    loop {
        if let Some(result) = done() {
            return Some(result);
        }
        if Instant::now() >= end {
            return None;
        }
        thread::sleep(Duration::from_millis(1));
    }
}

/// Whether the process has ended; it stays to be waited for.
fn has_exited(pid: Pid) -> bool {
    let options = WaitIdOptions::EXITED | WaitIdOptions::NOWAIT | WaitIdOptions::NOHANG;
    !matches!(waitid(WaitId::Pid(pid), options), Ok(None))
}

/// Starts the process, then writes to it until the session ends.
fn keep(
    command: Command,
    started: &mpsc::Sender<io::Result<Box<dyn ChildWrapper>>>,
    chunks: &Receiver<Vec<u8>>,
) {
    let child = CommandWrap::from(command).wrap(ProcessGroup::leader()).spawn();
    let mut stdin = None;
    let child = child.map(|mut child| {
        stdin = child.stdin().take();
        child
    });
    if let Some(pipe) = &stdin {
        enlarge(pipe);
    }
    // If nobody waits for it, the session was given up; on Linux the child dies with this thread.
    if started.send(child).is_err() {
        return;
    }
    while let Ok(chunk) = chunks.recv() {
        if chunk.is_empty() {
            stdin = None;
        }
        let written =
            stdin.as_mut().map_or(Ok(()), |pipe| pipe.write_all(&chunk).and_then(|()| pipe.flush()));
        if written.is_err() {
            // The solver reads no more. What it said last is for the readers.
            stdin = None;
        }
    }
}

/// A larger pipe, so that the solver and we need not take turns. Where that is not allowed the usual one does.
#[cfg(target_os = "linux")]
fn enlarge(pipe: &ChildStdin) {
    let _ = rustix::pipe::fcntl_setpipe_size(pipe, 1 << 20);
}

#[cfg(not(target_os = "linux"))]
fn enlarge(_: &ChildStdin) {}

/// Passes on what it says. Some solvers write every word by itself: what ends where no reply does waits a moment for
/// more.
fn read_output(mut stdout: ChildStdout, sender: &SyncSender<Vec<u8>>) {
    let mut buffer = vec![0; 1 << 16];
    let mut filled = 0;
    loop {
        let ended = match stdout.read(&mut buffer[filled..]) {
            Ok(count) => {
                filled += count;
                count == 0
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(_) => true,
        };
        let heard = &buffer[..filled];
        let whole = ended || filled == buffer.len() || heard.ends_with(b"\n") || heard.ends_with(b")");
        if !heard.is_empty() && (whole || !says_more(&stdout)) {
            if sender.send(heard.to_vec()).is_err() {
                return;
            }
            filled = 0;
        }
        if ended {
            return;
        }
    }
}

/// Whether it says something, or ends, within a moment.
fn says_more(stdout: &ChildStdout) -> bool {
    let moment = Timespec { tv_sec: 0, tv_nsec: 1_000_000 };
    poll(&mut [PollFd::new(stdout, PollFlags::IN)], Some(&moment)).is_ok_and(|ready| ready > 0)
}

fn read_errors(mut stderr: ChildStderr, tail: &Mutex<Vec<u8>>) {
    let mut buffer = vec![0; 4096];
    loop {
        match stderr.read(&mut buffer) {
            Ok(0) => return,
            Ok(count) => {
                let mut tail = tail.lock().unwrap_or_else(PoisonError::into_inner);
                tail.extend_from_slice(&buffer[..count]);
                let excess = tail.len().saturating_sub(TAIL);
                tail.drain(..excess);
            }
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(_) => return,
        }
    }
}

/// Has the kernel kill a process when the thread that starts it ends, where the kernel can: on Linux.
pub fn end_with_parent(command: &mut Command) {
    prepare(command, None);
}

/// Sets the limits that the process gives itself before it becomes the solver.
#[cfg(target_os = "linux")]
#[allow(unsafe_code)]
fn prepare(command: &mut Command, memory_mib: Option<u64>) {
    use std::os::unix::process::CommandExt as _;

    use rustix::process::{Resource, Rlimit, Signal, getppid, set_parent_process_death_signal, setrlimit};

    let parent = i32::try_from(std::process::id()).ok();
    let limit = move || -> io::Result<()> {
        set_parent_process_death_signal(Some(Signal::KILL))?;
        // If we died between fork and here, no signal will come.
        if getppid().map(|pid| pid.as_raw_nonzero().get()) != parent {
            return Err(io::ErrorKind::BrokenPipe.into());
        }
        if let Some(bytes) = memory_mib.and_then(|mib| mib.checked_mul(1 << 20)) {
            setrlimit(Resource::As, Rlimit { current: Some(bytes), maximum: Some(bytes) })?;
        }
        Ok(())
    };
    // SAFETY: between fork and exec only async-signal-safe work is allowed. The closure makes three
    // plain system calls through rustix, allocates nothing and takes no locks.
    unsafe {
        command.pre_exec(limit);
    }
}

/// Elsewhere the process has no limits and is killed only by us.
#[cfg(not(target_os = "linux"))]
fn prepare(_: &mut Command, _: Option<u64>) {}
