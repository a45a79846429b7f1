//! Ctrl-C and termination: the flag that every search watches is set, children are ended on the way out, and the
//! exit status says which signal it was.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock};

/// 128 + the number of the signal that came, by the shell's convention; 0 while none has.
static STATUS: LazyLock<Arc<AtomicUsize>> = LazyLock::new(Arc::default);

/// Sets the flag when a signal comes. Without signals the command still works: it just cannot be stopped gently.
pub(crate) fn watch(cancelled: &Arc<AtomicBool>) {
    for (signal, status) in [(SIGINT, 130), (SIGTERM, 143)] {
        let _ = flag::register_usize(signal, Arc::clone(&STATUS), status);
        let _ = flag::register(signal, Arc::clone(cancelled));
    }
}

/// The exit status where a signal came.
pub(crate) fn status() -> Option<ExitCode> {
    match STATUS.load(Ordering::SeqCst) {
        0 => None,
        status => Some(ExitCode::from(u8::try_from(status).unwrap_or(130))),
    }
}
