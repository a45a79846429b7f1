//! What must not fail on any input: a body for each kind of input that comes from outside, which ordinary tests run on
//! damaged inputs of a corpus ([`run`]) and the fuzzers in `fuzz/` on what libFuzzer thinks of.

mod driver;
mod files;
mod problem;
mod reply;
#[path = "../../../crates/syntax/tests/random/mod.rs"]
mod text;

pub use driver::run;

/// A kind of input, and what has to hold of any.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name, which is also that of its folder in the corpus and of its fuzzer.
    pub name: &'static str,
    /// Panics where what has to hold does not.
    pub body: fn(&[u8]),
    /// Pieces of text that matter in such inputs.
    pieces: &'static [&'static str],
    /// Where not all inputs come from the corpus: a random one.
    random: Option<fn(&mut hyperplan_random::Random) -> String>,
}

const fn target(name: &'static str, body: fn(&[u8]), pieces: &'static [&'static str]) -> Target {
    Target { name, body, pieces, random: None }
}

/// Problem files: read, formatted, and read again. The problem files of the repository belong to the corpus.
pub const PROBLEM: Target =
    Target { random: Some(problem::random), ..target("problem", problem::body, text::damage::PIECES) };
/// What a solver writes.
pub const REPLY: Target = target("reply", reply::body, reply::PIECES);
/// Maps: texts and those of the Moving AI benchmarks.
pub const MAP: Target = target("map", files::map, files::MAP_PIECES);
/// The descriptions of ROS maps.
pub const ROS: Target = target("ros", files::ros, files::ROS_PIECES);
/// The pictures of ROS maps.
pub const PGM: Target = target("pgm", files::pgm, files::PGM_PIECES);
/// Graphs.
pub const GRAPH: Target = target("graph", files::graph, files::JSON_PIECES);
/// Strategies.
pub const STRATEGY: Target = target("strategy", files::strategy, files::JSON_PIECES);
