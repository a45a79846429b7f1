//! The bodies of the fuzzers on damaged and random inputs, about a second each. `HYPERPLAN_FUZZ_SECONDS` makes it longer, and
//! `HYPERPLAN_SEED` begins elsewhere.

use hyperplan_tests::fuzz::{self, run};
use std::fs;
use std::path::Path;

#[test]
fn problem() {
    run(fuzz::PROBLEM);
}

#[test]
fn meaning() {
    run(fuzz::MEANING);
}

#[test]
fn solve() {
    run(fuzz::SOLVE);
}

#[test]
fn reply() {
    run(fuzz::REPLY);
}

#[test]
fn map() {
    run(fuzz::MAP);
}

#[test]
fn ros() {
    run(fuzz::ROS);
}

#[test]
fn pgm() {
    run(fuzz::PGM);
}

#[test]
fn png() {
    run(fuzz::PNG);
}

#[test]
fn scen() {
    run(fuzz::SCEN);
}

#[test]
fn graph() {
    run(fuzz::GRAPH);
}

#[test]
fn strategy() {
    run(fuzz::STRATEGY);
}

/// libFuzzer's dictionaries are made of the words that damage puts in, and for problems of those that the lexer and the
/// table of operators have. `UPDATE=1` writes them.
#[test]
fn dictionaries_have_all_words() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz");
    for target in fuzz::ALL {
        let (path, words) = (folder.join(format!("{}.dict", target.name)), target.dictionary());
        if words.is_empty() {
            assert!(!path.exists(), "{} is of no use", path.display());
            continue;
        }
        if std::env::var_os("UPDATE").is_some() {
            fs::write(&path, &words).expect("the folder is part of the repository");
        }
        let hint = "UPDATE=1 cargo test -p hyperplan-tests --test fuzz dictionaries writes it anew";
        assert_eq!(fs::read_to_string(&path).unwrap_or_default(), words, "{}: {hint}", path.display());
    }
    let problem = fuzz::PROBLEM.dictionary();
    for word in
        ["\"exists\"", "\"objective\"", "\"legend\"", "\"<->\"", "\"W\"", "\"\\xE2\\x88\\x83\"", "\"\\\"\""]
    {
        assert!(problem.lines().any(|line| line == word), "{word}");
    }
}
