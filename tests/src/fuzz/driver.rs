//! Runs a target on its corpus and on damaged inputs of it.

use super::Target;
use super::text::damage::damaged;
use crate::{deadline, number, say};
use hyperplan_random::Random;
use std::fs;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// An input that takes longer is a fault.
const PATIENCE: Duration = Duration::from_secs(30);

/// Problem files that are longer, such as large maps, would take most of the time.
const LONGEST: usize = 20_000;

/// Runs the body on each input of the corpus as it is, and then on damaged or random ones, for a second or as many as
/// `HYPERPLAN_FUZZ_SECONDS` says. `HYPERPLAN_FUZZ_INPUT` names a file that is the only input instead.
///
/// # Panics
/// If the body does: with the input, and the seed that makes it the first one (`HYPERPLAN_SEED`). A body that takes the
/// whole process with it leaves no message; `HYPERPLAN_FUZZ_TRACE=1` prints every seed first.
pub fn run(target: Target) {
    if let Some(path) = std::env::var_os("HYPERPLAN_FUZZ_INPUT") {
        let input = fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        say(&shown(target, &input));
        return guarded(target, &input, &path.display().to_string());
    }
    let corpus = if target.made.is_some() { Vec::new() } else { corpus(target.name) };
    for (path, input) in &corpus {
        guarded(target, input, &path.display().to_string());
    }
    let first = number("HYPERPLAN_SEED", 20_260_101);
    let trace = std::env::var_os("HYPERPLAN_FUZZ_TRACE").is_some();
    let end = deadline().unwrap_or_else(|| Instant::now() + Duration::from_secs(1));
    let mut seed = first;
    while seed.wrapping_sub(first) < 50 || Instant::now() < end {
        if trace {
            say(&format!("{}: HYPERPLAN_SEED={seed}", target.name));
        }
        let input = mutated(&mut Random::new(seed), &corpus, target);
        guarded(target, &input, &format!("HYPERPLAN_SEED={seed}"));
        seed = seed.wrapping_add(1);
    }
    let count = seed.wrapping_sub(first);
    say(&format!("{}: {} inputs, and {count} from seed {first} on", target.name, corpus.len()));
}

/// Runs the body; a failure shows the input, ready to become a part of the corpus.
fn guarded(target: Target, input: &[u8], origin: &str) {
    let start = Instant::now();
    let survived = catch_unwind(|| (target.body)(input)).is_ok();
    let time = start.elapsed();
    assert!(
        survived && time < PATIENCE,
        "{}, {origin}: fails after {time:?} on\n{}",
        target.name,
        shown(target, input)
    );
}

fn shown(target: Target, input: &[u8]) -> String {
    match (target.made, str::from_utf8(input)) {
        (Some(made), _) => made(input),
        (None, Ok(text)) => text.to_owned(),
        (None, Err(_)) => format!("b\"{}\"", input.escape_ascii()),
    }
}

/// The inputs that are kept, each with its file.
fn corpus(name: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    collect(&tests.join("corpus").join(name), &mut files);
    if name == "problem" {
        let own = files.len();
        collect(&tests.join("../specs"), &mut files);
        let mut keep = 0..files.len();
        files.retain(|(path, text)| {
            let is_problem = path.extension().is_some_and(|end| end == "hp") && text.len() < LONGEST;
            keep.next().is_some_and(|i| i < own) || is_problem
        });
    }
    assert!(files.len() > 2, "the corpus of {name} is part of the repository");
    files
}

fn collect(folder: &Path, files: &mut Vec<(PathBuf, Vec<u8>)>) {
    let entries = fs::read_dir(folder).expect("the corpus is part of the repository");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            collect(&path, files);
        } else {
            let input = fs::read(&path).expect("readable");
            files.push((path, input));
        }
    }
}

/// An input of the corpus, damaged as a text where it is one, and sometimes byte by byte.
fn mutated(random: &mut Random, corpus: &[(PathBuf, Vec<u8>)], target: Target) -> Vec<u8> {
    let one = |random: &mut Random| match target.random {
        Some(input) if corpus.is_empty() || random.below(8) == 0 => input(random),
        _ => corpus[random.below(corpus.len())].1.clone(),
    };
    if target.made.is_some() {
        return one(random);
    }
    let (input, other) = (one(random), one(random));
    let mut input = match (str::from_utf8(&input), str::from_utf8(&other)) {
        (Ok(text), Ok(other)) => damaged(random, text, other, target.pieces).into_bytes(),
        (Ok(text), Err(_)) => damaged(random, text, text, target.pieces).into_bytes(),
        (Err(_), _) => damaged_bytes(random, input),
    };
    if random.below(8) == 0 {
        input = damaged_bytes(random, input);
    }
    input
}

/// A few bytes changed, put in or lost.
fn damaged_bytes(random: &mut Random, mut input: Vec<u8>) -> Vec<u8> {
    for _ in 0..=random.below(3) {
        let at = random.below(input.len() + 1);
        let byte = u8::try_from(random.below(256)).unwrap_or(0);
        match random.below(4) {
            0 => input.insert(at, byte),
            1 => input.truncate(at),
            2 if at < input.len() => drop(input.remove(at)),
            _ => {
                if let Some(old) = input.get_mut(at) {
                    *old = byte;
                }
            }
        }
    }
    input
}
