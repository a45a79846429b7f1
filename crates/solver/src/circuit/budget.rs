//! What a check may spend: time until its deadline, and memory.

use crate::deadline::Deadline;
use crate::error::{Error, Unknown};

/// The memory of this process must not pass a limit.
#[derive(Clone, Debug)]
pub(crate) struct Memory {
    mib: u64,
    /// Most bytes of the process.
    most: u64,
}

impl Memory {
    /// From now on the process may grow by so many MiB: what came before, such as a large map, is not the engine's.
    ///
    /// # Errors
    /// Where the system does not tell how much memory is in use.
    pub(crate) fn growing_by(mib: u64) -> Result<Memory, Error> {
        let Some(used) = used() else {
            let what = "this system does not tell how much memory is in use, so that the builtin solver cannot \
                        limit its own: leave out the limit, or use another solver";
            return Err(Error::Unsupported { what: what.to_owned() });
        };
        let most = used.saturating_add(mib.saturating_mul(1 << 20));
        Ok(Memory { mib, most })
    }

    fn spent(&self) -> bool {
        used().is_some_and(|used| used > self.most)
    }
}

/// Bytes of this process in physical memory.
fn used() -> Option<u64> {
    memory_stats::memory_stats().map(|usage| usage.physical_mem as u64)
}

/// The limits of one check.
#[derive(Clone, Debug)]
pub(crate) struct Budget {
    deadline: Deadline,
    memory: Option<Memory>,
    /// Of the SAT solver; see `Backend::solve`.
    pub(crate) effort: Option<u64>,
}

impl Budget {
    pub(crate) fn new(deadline: &Deadline, memory: Option<&Memory>, effort: Option<u64>) -> Budget {
        Budget { deadline: deadline.clone(), memory: memory.cloned(), effort }
    }

    /// Whether it is time to stop.
    pub(crate) fn spent(&self) -> bool {
        self.deadline.passed() || self.memory.as_ref().is_some_and(Memory::spent)
    }

    /// Why it was time to stop.
    pub(crate) fn reason(&self) -> Unknown {
        match &self.memory {
            Some(memory) if !self.deadline.passed() => Unknown::MemoryLimit { mib: memory.mib },
            _ => self.deadline.reason(),
        }
    }
}

/// Why there is no answer to a check.
#[derive(Debug)]
pub(crate) enum Halt {
    /// Time or memory is spent; the next check may go on.
    Spent,
    /// The effort is spent, and the next check goes on from there.
    Tired,
    /// A failure.
    Error(Error),
}

impl From<Error> for Halt {
    fn from(error: Error) -> Halt {
        Halt::Error(error)
    }
}
