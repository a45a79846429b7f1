//! What `emit` writes, read back: by z3, cvc5 and pySMT, by the checker of the rules in `scripts/`, and by two solvers
//! whose answers have to be those of the embedded one.
//!
//! Rows of the table are options of `emit`; adding a kind of file is adding a row.

mod common;

use common::{hyperplan, specs, text};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Options of `emit`; each is applied to each problem.
const KINDS: &[&[&str]] = &[
    &["--quantifiers", "expand", "--states", "onehot"],
    &["--quantifiers", "expand", "--states", "bitvec"],
    &["--quantifiers", "expand", "--states", "int"],
    &["--quantifiers", "expand", "--states", "enum"],
    &["--quantifiers", "expand", "--states", "real"],
    &["--quantifiers", "keep", "--states", "onehot"],
    &["--quantifiers", "keep", "--states", "bitvec"],
    &["--quantifiers", "keep", "--states", "int"],
    &["--quantifiers", "keep", "--states", "enum"],
    &["--quantifiers", "keep", "--states", "real"],
];

/// Problems, with an objective and settings each: of every quantifier prefix that the paper uses, realizable and not.
const PROBLEMS: &[&[&str]] = &[
    &["rooms.hp", "--objective", "sp"],
    &["rooms.hp", "--objective", "sp", "--set", "T=1"],
    &["rooms.hp", "--objective", "cso"],
    &["rooms.hp", "--objective", "isr"],
];

/// What reads the files, and how it is asked whether it is there.
const TOOLS: [&[&str]; 4] = [
    &["z3", "--version"],
    &["cvc5", "--version"],
    &["python3", "--version"],
    &["python3", "-c", "import pysmt"],
];

/// Whether all tools are here. Where they are demanded, one that is missing is a failure.
fn tools() -> bool {
    let missing: Vec<&[&str]> = TOOLS.into_iter().filter(|tool| !runs(tool)).collect();
    let demanded = std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_some_and(|value| value == "1");
    assert!(missing.is_empty() || !demanded, "{missing:?} cannot be run");
    if !missing.is_empty() {
        eprintln!("skipped: {missing:?} cannot be run");
    }
    missing.is_empty()
}

fn runs(command: &[&str]) -> bool {
    let status = Command::new(command[0]).args(&command[1..]).stdout(Stdio::null()).stderr(Stdio::null());
    status.status().is_ok_and(|status| status.success())
}

/// A file of the table: what was asked for, and what the embedded solver says.
struct Emitted {
    asked: String,
    file: PathBuf,
    verdict: &'static str,
}

/// Writes the whole table; what `emit` refuses has to be refused with a reason, and is left out.
fn emitted(folder: &Path) -> Vec<Emitted> {
    let mut files = Vec::new();
    for problem in PROBLEMS {
        let solved = hyperplan(&[&["solve", "--quiet"], *problem].concat());
        let verdict = match solved.status {
            0 => "sat",
            1 => "unsat",
            status => panic!("{problem:?}: {status}\n{}", solved.stderr),
        };
        for kind in KINDS {
            let file = folder.join(format!("{}.smt2", files.len()));
            let asked = [*problem, *kind].concat().join(" ");
            let run = hyperplan(&[&["emit", "--quiet", "-o", text(&file)], *problem, *kind].concat());
            if run.status == 2 && run.stderr.starts_with("error: ") {
                eprintln!("refused: {asked}: {}", run.stderr.trim());
                continue;
            }
            assert_eq!(run.status, 0, "{asked}: {}", run.stderr);
            files.push(Emitted { asked, file, verdict });
        }
    }
    files
}

#[test]
fn files_follow_the_rules_and_everyone_can_read_them() {
    if !tools() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let files = emitted(folder.path());
    assert!(files.len() > PROBLEMS.len() * KINDS.len() / 2, "most are refused");
    let checker = specs().join("../scripts/check-benchmarks.py");
    let run = Command::new("python3")
        .arg(checker)
        .args(["--external", "--require"])
        .args(files.iter().map(|emitted| &emitted.file))
        .output()
        .expect("python3 was found");
    let findings = String::from_utf8_lossy(&run.stdout).into_owned();
    let names: Vec<String> =
        files.iter().map(|emitted| format!("{}: {}", emitted.file.display(), emitted.asked)).collect();
    assert!(run.status.success(), "{findings}\n{}", names.join("\n"));
}

#[test]
fn solvers_agree_on_the_files() {
    if !tools() {
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    for Emitted { asked, file, verdict } in emitted(folder.path()) {
        for solver in [&["z3", "-T:60"][..], &["cvc5", "--tlimit=60000"]] {
            let run = Command::new(solver[0]).args(&solver[1..]).arg(&file).output().expect("it was found");
            let answer = String::from_utf8_lossy(&run.stdout).into_owned();
            assert_eq!(answer.lines().next(), Some(verdict), "{solver:?}: {asked}: {answer}");
        }
    }
}
