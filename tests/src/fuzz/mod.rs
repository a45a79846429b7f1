//! What must not fail on any input: a body for each kind of input that comes from outside, which ordinary tests run on
//! damaged inputs of a corpus ([`run`]) and the fuzzers in `fuzz/` on what libFuzzer thinks of.

mod driver;
mod files;
mod meaning;
mod problem;
mod reply;
mod solve;
#[path = "../../../crates/syntax/tests/random/mod.rs"]
mod text;

pub use driver::run;

use hyperplan_random::Random;
use hyperplan_syntax::vocabulary;
use std::collections::BTreeSet;

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
    random: Option<fn(&mut Random) -> Vec<u8>>,
    /// Where an input is no text but what a generator chooses by, a byte each: what it makes. There is no corpus then,
    /// as the next change of the generator would make something else of it.
    made: Option<fn(&[u8]) -> String>,
}

const fn target(name: &'static str, body: fn(&[u8]), pieces: &'static [&'static str]) -> Target {
    Target { name, body, pieces, random: None, made: None }
}

const fn generated(name: &'static str, body: fn(&[u8]), made: fn(&[u8]) -> String) -> Target {
    Target { random: Some(some_choices), made: Some(made), ..target(name, body, &[]) }
}

/// A generator's choices.
fn choices(data: &[u8]) -> Random {
    Random::of(data.iter().map(|&byte| u32::from(byte)).collect())
}

/// Most bytes of random choices; generators rarely take more.
const CHOICES: usize = 600;

fn some_choices(random: &mut Random) -> Vec<u8> {
    (0..random.below(CHOICES)).map(|_| random.number().to_le_bytes()[0]).collect()
}

/// Problem files: read, formatted, and read again. The problem files of the repository belong to the corpus.
pub const PROBLEM: Target =
    Target { random: Some(problem::random), ..target("problem", problem::body, text::damage::PIECES) };
/// Whole problem files, made: what they mean, their queries, warnings and answers.
pub const MEANING: Target = generated("meaning", meaning::body, meaning::made);
/// Tiny problems, made: solved in every way, and by brute force.
pub const SOLVE: Target = generated("solve", solve::body, solve::made);
/// What a solver writes.
pub const REPLY: Target = target("reply", reply::body, reply::PIECES);
/// Maps: texts and those of the Moving AI benchmarks.
pub const MAP: Target = target("map", files::map, files::MAP_PIECES);
/// The descriptions of ROS maps.
pub const ROS: Target = target("ros", files::ros, files::ROS_PIECES);
/// The pictures of ROS maps.
pub const PGM: Target = target("pgm", files::pgm, files::PGM_PIECES);
/// Pictures in PNG: maps by their colours, and those of ROS maps.
pub const PNG: Target = target("png", files::png, &[]);
/// Scenarios of the Moving AI benchmarks.
pub const SCEN: Target = target("scen", files::scen, files::SCEN_PIECES);
/// Graphs.
pub const GRAPH: Target = target("graph", files::graph, files::JSON_PIECES);
/// Strategies.
pub const STRATEGY: Target = target("strategy", files::strategy, files::JSON_PIECES);

/// All of them.
pub const ALL: &[Target] = &[PROBLEM, MEANING, SOLVE, REPLY, MAP, ROS, PGM, PNG, SCEN, GRAPH, STRATEGY];

impl Target {
    /// What libFuzzer may put into inputs, in the format of its dictionaries; nothing where inputs are no text.
    #[must_use]
    pub fn dictionary(&self) -> String {
        let mut words: BTreeSet<&str> = self.pieces.iter().copied().collect();
        if self.name == PROBLEM.name {
            words.extend(vocabulary());
        }
        words.iter().map(|word| format!("\"{}\"\n", word.bytes().map(escaped).collect::<String>())).collect()
    }
}

fn escaped(byte: u8) -> String {
    match byte {
        b'"' | b'\\' => format!("\\{}", char::from(byte)),
        b' '..=b'~' => char::from(byte).to_string(),
        _ => format!("\\x{byte:02X}"),
    }
}
