//! When to stop.

use crate::error::Unknown;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// A point in time, if any, and a flag that cancels earlier. Clones share the flag.
#[derive(Clone, Debug)]
pub struct Deadline {
    at: Option<Instant>,
    cancel: Arc<AtomicBool>,
    /// The flags of those that this is a part of.
    wider: Vec<Arc<AtomicBool>>,
    /// The limit of memory that was reached, in MiB; 0 while none is. All parts share it.
    exhausted: Arc<AtomicU64>,
}

impl Deadline {
    /// No point in time; still cancellable.
    #[must_use]
    pub fn never() -> Deadline {
        Deadline { at: None, cancel: Arc::default(), wider: Vec::new(), exhausted: Arc::default() }
    }

    /// So long from now. A duration that the clock cannot hold means never.
    #[must_use]
    pub fn after(duration: Duration) -> Deadline {
        Deadline { at: Instant::now().checked_add(duration), ..Deadline::never() }
    }

    /// This deadline or that long from now, whichever is first; the flag is shared.
    #[must_use]
    pub fn within(&self, duration: Duration) -> Deadline {
        let other = Instant::now().checked_add(duration);
        let at = match (self.at, other) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
        Deadline { at, ..self.clone() }
    }

    /// The same point in time, and a flag of its own besides this one's: what is cancelled by it is only a part.
    #[must_use]
    pub fn part(&self) -> Deadline {
        let mut wider = self.wider.clone();
        wider.push(Arc::clone(&self.cancel));
        Deadline { at: self.at, cancel: Arc::default(), wider, exhausted: Arc::clone(&self.exhausted) }
    }

    /// Cancels.
    pub fn cancel(&self) {
        self.cancel.store(true, Ordering::Relaxed);
    }

    /// Ends everything, as memory has reached its limit, in MiB.
    pub fn exhaust(&self, mib: u64) {
        self.exhausted.store(mib, Ordering::Relaxed);
    }

    /// The limit of memory that was reached, in MiB.
    fn exhausted(&self) -> Option<u64> {
        Some(self.exhausted.load(Ordering::Relaxed)).filter(|mib| *mib > 0)
    }

    /// Whether it has passed, was cancelled, or memory has reached its limit.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.cancelled() || self.exhausted().is_some() || self.at.is_some_and(|at| Instant::now() >= at)
    }

    /// Whether it was cancelled.
    #[must_use]
    pub fn cancelled(&self) -> bool {
        std::iter::once(&self.cancel).chain(&self.wider).any(|flag| flag.load(Ordering::Relaxed))
    }

    /// The flag that cancels when it is set: for signal handlers and other threads.
    #[must_use]
    pub fn cancel_flag(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.cancel)
    }

    /// How long from now; `None` if there is no point in time, zero if it has passed.
    #[must_use]
    pub fn remaining(&self) -> Option<Duration> {
        if self.cancelled() || self.exhausted().is_some() {
            return Some(Duration::ZERO);
        }
        self.at.map(|at| at.saturating_duration_since(Instant::now()))
    }

    /// Why it stopped: [`Unknown::Timeout`], [`Unknown::Interrupted`] or [`Unknown::MemoryLimit`].
    #[must_use]
    pub fn reason(&self) -> Unknown {
        match self.exhausted() {
            _ if self.cancelled() => Unknown::Interrupted,
            Some(mib) => Unknown::MemoryLimit { mib },
            None => Unknown::Timeout,
        }
    }
}
