//! What the tests of the whole workspace share: random problems, the semantics by brute force, and fuzzing.
//!
//! A problem is an explicit table of transitions and a tree of operators ([`model`]), made at random ([`random`]),
//! printed as a problem file, and decided by enumerating paths ([`brute`]). None of these uses the parser, the typed
//! problem, the encoder or the checker. Of problems over several systems there are only texts ([`mixed`]). [`mod@fuzz`] tries the readers of files with damaged ones.

use std::io::Write;
use std::time::{Duration, Instant};

mod beyond;
pub mod brute;
mod conformant;
pub mod fuzz;
pub mod judge;
pub mod mixed;
pub mod model;
pub mod qbf;
pub mod random;
pub mod shrink;
pub mod whole;

/// Tells the person who runs the tests.
pub fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// The number that an environment variable gives, or the default.
///
/// # Panics
/// If its value is no number.
#[must_use]
pub fn number(variable: &str, default: u64) -> u64 {
    match std::env::var(variable) {
        Ok(text) => text.parse().unwrap_or_else(|_| panic!("{variable} must be a number, not {text:?}")),
        Err(_) => default,
    }
}

/// When to end, where `HYPERPLAN_FUZZ_SECONDS` says how long to try random inputs.
#[must_use]
pub fn deadline() -> Option<Instant> {
    std::env::var_os("HYPERPLAN_FUZZ_SECONDS")?;
    Some(Instant::now() + Duration::from_secs(number("HYPERPLAN_FUZZ_SECONDS", 0)))
}
