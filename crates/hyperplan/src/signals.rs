//! Ctrl-C and termination: the flag that every search watches is set, children are ended on the way out, and the
//! exit status says which signal it was. A second signal ends the process at once.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock};

/// 128 + the number of the signal that came, by the shell's convention; 0 while none has.
static STATUS: LazyLock<Arc<AtomicUsize>> = LazyLock::new(Arc::default);

/// Sets the flag when a signal comes. Without signals the command still works: it just cannot be stopped gently.
pub(crate) fn watch(cancelled: &Arc<AtomicBool>) {
    let before = Arc::new(AtomicBool::new(false));
    for (signal, status) in [(SIGINT, 130), (SIGTERM, 143)] {
        // In this order: at the first signal nothing has come before.
        let _ = flag::register_conditional_shutdown(signal, status, Arc::clone(&before));
        let _ = flag::register(signal, Arc::clone(&before));
        let _ = flag::register_usize(signal, Arc::clone(&STATUS), status as usize);
        let _ = flag::register(signal, Arc::clone(cancelled));
    }
}

/// The exit status where a signal came.
pub(crate) fn number() -> Option<i32> {
    i32::try_from(STATUS.load(Ordering::SeqCst)).ok().filter(|status| *status != 0)
}

/// The same, for the end of `main`.
pub(crate) fn status() -> Option<ExitCode> {
    number().map(|status| ExitCode::from(u8::try_from(status).unwrap_or(130)))
}
