//! The last resort: a command ends soon after its deadline, a signal, or its limit of memory, whatever it is doing.
//!
//! As a rule what takes long asks its [`Deadline`] now and then whether to stop, says what it has found out, and ends in
//! the usual way. Where it has not within [`GRACE`], a thread says what was being done and ends the process. Solvers end
//! with it: their watchdog sees that we are gone, as after any other death.

use crate::failure::Exit;
use crate::signals;
use hyperplan_plan::Watch;
use hyperplan_solver::Deadline;
use memory_stats::memory_stats;
use std::io::{self, Write as _};
use std::process;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// How often the guard looks.
const TICK: Duration = Duration::from_millis(10);

/// How long a command may take to end by itself: with what it takes to end the process, less than a second.
const GRACE: Duration = Duration::from_millis(700);

/// By how much memory may grow beyond its limit before the process is ended at once, in percent; small limits are
/// passed by more in the time that it takes to notice.
const EXCESS: u64 = 8;
const LEAST_EXCESS: u64 = 24 << 20;

/// What the command is doing, for the message.
static DOING: Mutex<&str> = Mutex::new("reading the problem");

/// Where the search tells how far it is, for the message.
static WATCH: Mutex<Option<Watch>> = Mutex::new(None);

/// Tells of which search the message should say how far it was.
pub(crate) fn watching(watch: &Watch) {
    *WATCH.lock().unwrap_or_else(PoisonError::into_inner) = Some(watch.clone());
}

/// Tells what the command is about to do, as it goes on "while ...".
pub(crate) fn doing(what: &'static str) {
    *DOING.lock().unwrap_or_else(PoisonError::into_inner) = what;
}

/// Watches over the rest of the command: its deadline, signals, and how much this process grows from now on.
pub(crate) fn begin(deadline: &Deadline, memory_mib: Option<u64>) {
    let limit = memory_mib.and_then(Limit::growing_by);
    let guard = Guard { deadline: deadline.clone(), limit };
    // Without it the command ends as soon as it notices by itself.
    let _ = thread::Builder::new().name("guard".to_owned()).spawn(move || guard.watch());
}

struct Guard {
    deadline: Deadline,
    limit: Option<Limit>,
}

/// A limit of memory, and the bytes of the process at which it is reached.
struct Limit {
    mib: u64,
    bytes: u64,
    /// When there is no time left to end in an orderly way.
    most: u64,
}

impl Limit {
    /// What the process has before is not counted; `None` where the system does not tell.
    fn growing_by(mib: u64) -> Option<Limit> {
        let before = memory_stats()?.physical_mem as u64;
        let growth = mib.saturating_mul(1 << 20);
        let excess = (growth / 100 * EXCESS).max(LEAST_EXCESS);
        let bytes = before.saturating_add(growth);
        Some(Limit { mib, bytes, most: bytes.saturating_add(excess) })
    }
}

impl Guard {
    fn watch(self) {
        let mut since: Option<Instant> = None;
        loop {
            thread::sleep(TICK);
            let used =
                self.limit.as_ref().and_then(|_| memory_stats()).map_or(0, |used| used.physical_mem as u64);
            if let Some(limit) = self.limit.as_ref().filter(|limit| used > limit.bytes) {
                self.deadline.exhaust(limit.mib);
                if used > limit.most {
                    self.end();
                }
            }
            if self.deadline.passed() && since.get_or_insert_with(Instant::now).elapsed() > GRACE {
                self.end();
            }
        }
    }

    fn end(&self) -> ! {
        let doing = *DOING.lock().unwrap_or_else(PoisonError::into_inner);
        let far = WATCH.lock().unwrap_or_else(PoisonError::into_inner).as_ref().map(Watch::standing);
        let far = far.map(|standing| format!("; it was {standing}")).unwrap_or_default();
        // There is nothing left to do if it cannot be written.
        let _ = writeln!(io::stderr(), "error: stopped while {doing} ({}){far}", self.deadline.reason());
        process::exit(signals::number().unwrap_or(Exit::Undecided as i32));
    }
}
