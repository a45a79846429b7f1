//! Ends solvers and removes temporary files when hyperplan is killed outright.
//!
//! On Linux the kernel kills a solver whose starter dies, but not the processes that the solver has started, and other
//! systems have nothing like it. So a small shell process reads from us which process groups there are; when we are
//! gone, however that came about, it reads the end of the file, kills what is left, and ends itself. It is in a
//! group of its own, which signals to ours do not reach. It is started with the first solver; without a
//! shell there is no watchdog, and everything else works.

use std::io::Write as _;
use std::os::unix::process::CommandExt as _;
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::{Mutex, PoisonError};

/// The watchdog of this process.
static WATCHDOG: Mutex<Watchdog> = Mutex::new(Watchdog::NotStarted);

enum Watchdog {
    /// No solver was started yet.
    NotStarted,
    /// It listens.
    Listening {
        pipe: ChildStdin,
        /// Never waited for: it ends after us.
        _shell: Child,
    },
    /// There is no shell, or it was ended by others.
    Unavailable,
}

/// Starts the watchdog, unless it was. Who is about to make what it has to see to waits before rather than after.
pub(super) fn begin() {
    WATCHDOG.lock().unwrap_or_else(PoisonError::into_inner).begin();
}

/// A group to be killed with us, as long as this lives.
pub(super) struct Watched(u32);

impl Watched {
    pub(super) fn group(id: u32) -> Watched {
        tell(format!("+{id}\n").as_bytes());
        Watched(id)
    }
}

impl Drop for Watched {
    fn drop(&mut self) {
        tell(format!("-{}\n", self.0).as_bytes());
    }
}

/// A temporary file, to be removed with us.
pub(super) fn watch_file(path: &Path) {
    use std::os::unix::ffi::OsStrExt as _;
    let path = path.as_os_str().as_bytes();
    // Its paths begin with a slash and end with the line.
    if path.starts_with(b"/") && !path.contains(&b'\n') {
        tell(&[path, b"\n"].concat());
    }
}

fn tell(line: &[u8]) {
    let mut watchdog = WATCHDOG.lock().unwrap_or_else(PoisonError::into_inner);
    watchdog.begin();
    if let Watchdog::Listening { pipe, .. } = &mut *watchdog
        // One write: lines are short enough to be whole.
        && pipe.write_all(line).is_err()
    {
        *watchdog = Watchdog::Unavailable;
    }
}

impl Watchdog {
    fn begin(&mut self) {
        if let Watchdog::NotStarted = self {
            *self = start().unwrap_or(Watchdog::Unavailable);
        }
    }
}

fn start() -> Option<Watchdog> {
    let mut command = Command::new("/bin/sh");
    command.args(["-c", include_str!("watchdog.sh"), "hyperplan-watchdog"]).process_group(0).current_dir("/");
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null());
    let mut shell = command.spawn().ok()?;
    Some(Watchdog::Listening { pipe: shell.stdin.take()?, _shell: shell })
}
