//! What `emit` writes, read back: by z3, cvc5 and pySMT, by the checker of the rules in `scripts/`, and by two solvers
//! whose answers have to be those of the embedded one.
//!
//! Rows of the table are options of `emit`; adding a kind of file is adding a row.

mod common;

use common::{hyperplan, specs, text};
use std::io::Write as _;
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
    &["--quantifiers", "keep", "--states", "onehot", "--no-pruning"],
    &["--quantifiers", "keep", "--states", "enum", "--no-pruning", "--no-comments"],
    &["--quantifiers", "expand", "--states", "onehot", "--no-pruning"],
    &["--track", "model", "--states", "onehot", "--quantifiers", "expand", "--pruning", "none"],
    &["--quantifiers", "cegis", "--states", "onehot"],
    &["--track", "incremental", "--states", "bitvec"],
    &["--track", "incremental", "--states", "enum", "--no-pruning"],
    &["--paths", "functions", "--states", "bitvec", "--quantifiers", "expand"],
    &["--paths", "functions", "--states", "bitvec", "--quantifiers", "keep"],
    &["--paths", "policies", "--states", "int", "--quantifiers", "expand"],
    &["--paths", "policies", "--states", "real", "--quantifiers", "expand"],
    &["--track", "incremental", "--quantifiers", "keep", "--states", "bitvec"],
    &["--track", "incremental", "--quantifiers", "keep", "--states", "enum"],
    &["--track", "model", "--states", "onehot", "--quantifiers", "expand"],
    &["--track", "model", "--states", "enum"],
    &["--track", "unsat-core", "--states", "onehot", "--quantifiers", "expand"],
    &["--track", "unsat-core", "--states", "bitvec"],
];

/// Problems, with an objective and settings each: of every quantifier prefix that the paper uses, realizable and not.
const PROBLEMS: &[&[&str]] = &[
    &["rooms.hp", "--objective", "sp"],
    &["rooms.hp", "--objective", "sp", "--set", "T=1"],
    &["rooms.hp", "--objective", "cso"],
    &["rooms.hp", "--objective", "isr"],
    &["rooms.hp", "--objective", "ar", "--set", "T=2"],
    &["rooms.hp", "--objective", "iso"],
    &["pass/forall-exists.hp", "--objective", "follow"],
    &["pass/forall-exists.hp", "--objective", "escape"],
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
        say(&format!("skipped: {missing:?} cannot be run"));
    }
    missing.is_empty()
}

/// Says something past the test's capture of output.
fn say(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

fn runs(command: &[&str]) -> bool {
    let mut command_line = Command::new(command[0]);
    command_line.args(&command[1..]).stdout(Stdio::null()).stderr(Stdio::null());
    command_line.status().is_ok_and(|status| status.success())
}

/// A file of the table, and what was asked for.
struct Emitted {
    asked: String,
    file: PathBuf,
}

/// Writes the whole table; what `emit` refuses has to be refused with a reason, and is left out.
fn emitted(folder: &Path) -> Vec<Emitted> {
    let mut files = Vec::new();
    for problem in PROBLEMS {
        for kind in KINDS {
            let file = folder.join(format!("{}.smt2", files.len()));
            let asked = [*problem, *kind].concat().join(" ");
            let run = hyperplan(&[&["emit", "--quiet", "-o", text(&file)], *problem, *kind].concat());
            if run.status == 2 && run.stderr.starts_with("error: ") {
                say(&format!("refused: {asked}: {}", run.stderr.trim()));
                continue;
            }
            assert_eq!(run.status, 0, "{asked}: {}", run.stderr);
            files.push(Emitted { asked, file });
        }
    }
    files
}

/// The answers that the embedded solver gave, from the file.
fn expected(file: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(file).expect("it was written");
    let status = |line: &str| Some(line.strip_prefix("(set-info :status ")?.strip_suffix(')')?.to_owned());
    text.lines().filter_map(status).collect()
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
    let (mut decided, mut asked_for) = (0, 0);
    for Emitted { asked, file } in emitted(folder.path()) {
        let expected = expected(&file);
        assert!(!expected.is_empty() && expected.iter().all(|status| status != "unknown"), "{asked}");
        for solver in [&["z3", "-T:10"][..], &["cvc5", "--incremental", "--tlimit=10000"]] {
            let run = Command::new(solver[0]).args(&solver[1..]).arg(&file).output().expect("it was found");
            let output = String::from_utf8_lossy(&run.stdout).into_owned();
            let answers = output.lines().filter(|line| ["sat", "unsat", "unknown"].contains(&line.trim()));
            for (answer, expected) in answers.zip(&expected) {
                // A solver may give up; none may contradict.
                assert!(answer == "unknown" || answer == expected, "{solver:?}: {asked}: {output}");
                decided += usize::from(answer != "unknown");
            }
            asked_for += expected.len();
        }
    }
    assert!(decided * 10 > asked_for * 8, "only {decided} of {asked_for} checks were decided");
}
