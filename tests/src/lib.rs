//! What the tests of the whole workspace share: random problems, and the semantics by brute force.
//!
//! Nothing here uses the parser, the typed problem, the encoder or the checker: a problem is an explicit table of
//! transitions and a tree of operators ([`model`]), made at random ([`random`]), printed as a problem file, and
//! decided by enumerating paths ([`brute`]).

use std::io::Write;

mod beyond;
pub mod brute;
pub mod model;
pub mod random;

/// Tells the person who runs the tests.
pub fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}
