//! The scripts around `hyperplan compare`, with something that stands for it. Skipped where Python is missing.

#![allow(clippy::print_stderr, reason = "what is skipped is said")]
#![cfg(unix)]

mod sample;

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

use hyperplan_compare::{Record, RunStatus};
use sample::run;

/// Stands for hyperplan: its report is there already, its exit status in a file.
const PRETENDER: &str = r#"#!/bin/sh
here=$(dirname "$0")
echo "$@" > "$here/called"
while [ "$1" != --out ]; do shift; done
mkdir -p "$2"
cp "$here/runs.json" "$2/runs.json"
exit "$(cat "$here/status")"
"#;

fn is_missing() -> bool {
    let probe = Command::new("python3").arg("--version").output();
    let missing = !probe.is_ok_and(|output| output.status.success());
    if missing {
        eprintln!("skipped: Python is missing");
    }
    missing
}

/// What a script prints and how it ends, where a comparison has these records.
fn script(dir: &Path, name: &str, options: &[&str], records: &[Record], status: u8) -> (String, Option<i32>) {
    let pretender = dir.join("hyperplan");
    fs::write(&pretender, PRETENDER).expect("a file that can be written");
    fs::set_permissions(&pretender, fs::Permissions::from_mode(0o755)).expect("our own file");
    fs::write(dir.join("runs.json"), serde_json::to_string(records).expect("records are JSON"))
        .expect("a file that can be written");
    fs::write(dir.join("status"), status.to_string()).expect("a file that can be written");
    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scripts");
    let Output { status, stdout, stderr } = Command::new("python3")
        .arg("-B")
        .arg(scripts.join(name))
        .arg("--hyperplan")
        .arg(&pretender)
        .arg("--out")
        .arg(dir.join("out"))
        .args(options)
        .output()
        .expect("python was there just now");
    assert_eq!(String::from_utf8_lossy(&stderr), "", "{name}");
    (String::from_utf8_lossy(&stdout).into_owned(), status.code())
}

fn called(dir: &Path) -> String {
    fs::read_to_string(dir.join("called")).expect("the pretender was called")
}

#[test]
fn table_1() {
    if is_missing() {
        return;
    }
    let dir = tempfile::tempdir().expect("a temporary folder");
    let case = |solver: &str, name: &str, status, wall| {
        run(solver, &format!("specs/case-studies/{name}-10.hp#{name}"), status, wall)
    };
    let records = [
        case("z3", "iso", RunStatus::Sat, 1.0),
        case("z3", "iso", RunStatus::Sat, 3.0),
        case("z3", "iso", RunStatus::Sat, 2.0),
        case("builtin", "sp", RunStatus::Timeout, 9.0),
    ];
    let options = ["--sizes", "10", "--jobs", "2"];
    let (text, status) = script(dir.path(), "table-1.py", &options, &records, 0);
    assert_eq!(status, Some(0));
    assert!(text.contains("| map | objective | T | paper | builtin | z3 |\n"), "{text}");
    assert!(text.contains("| 10 x 10 | ISO | 20 | 0.14 |  | 2.000 |\n"), "{text}");
    assert!(text.contains("| 10 x 10 | SP | 20 | 0.15 | timeout |  |\n"), "{text}");
    let called = called(dir.path());
    assert!(called.starts_with("compare specs/case-studies/iso-10.hp "), "{called}");
    assert!(called.contains(" --jobs 2 --timeout 400 --out "), "{called}");
}

#[test]
fn formula_16() {
    if is_missing() {
        return;
    }
    let dir = tempfile::tempdir().expect("a temporary folder");
    let how = |quantifiers: &str, status, wall| Record {
        quantifiers: Some(quantifiers.to_owned()),
        ..run("z3", "specs/rooms.hp#sp", status, wall)
    };
    let both = |keep| [how("keep", keep, 6.0), how("auto", RunStatus::Sat, 0.5)];
    let (text, _) = script(dir.path(), "formula-16.py", &[], &both(RunStatus::Sat), 0);
    assert!(text.contains("| rooms.hp#sp | z3 | 6.000 | 0.500 | 12.0 |\n"), "{text}");
    let (text, status) =
        script(dir.path(), "formula-16.py", &["--timeout", "6"], &both(RunStatus::Timeout), 4);
    assert!(text.contains("| rooms.hp#sp | z3 | timeout | 0.500 | > 12 |\n"), "{text}");
    assert_eq!(status, Some(4), "wrong answers are not hidden");
    assert!(called(dir.path()).contains(" --quantifiers keep,auto "));
}

#[test]
fn nightly() {
    if is_missing() {
        return;
    }
    let dir = tempfile::tempdir().expect("a temporary folder");
    let night = |day: &str, records: &[Record], status| {
        script(dir.path(), "nightly.py", &["--day", day], records, status)
    };
    let before = ["a", "b", "c", "d"].map(|name| run("z3", name, RunStatus::Sat, 1.0));
    assert_eq!(night("2026-01-01", &before, 0), ("nothing to compare with\n".to_owned(), Some(0)));
    assert_eq!(
        night("2026-01-02", &before, 0),
        ("0 of 4 runs are worse than on 2026-01-01; 0 are new, 0 gone\n".to_owned(), Some(0))
    );
    let after = [
        run("z3", "a", RunStatus::Unsat, 1.0),
        run("z3", "b", RunStatus::Sat, 3.5),
        run("z3", "c", RunStatus::Sat, 1.9),
        run("z3", "e", RunStatus::Timeout, 10.0),
    ];
    let (text, status) = night("2026-01-03", &after, 0);
    let expected = "\
2 of 3 runs are worse than on 2026-01-02; 1 are new, 1 gone
  a z3 auto onehot: sat, now unsat
  b z3 auto onehot: 1.000 s, now 3.500 s
";
    assert_eq!((text.as_str(), status), (expected, Some(1)));
    let judgement = r#"{"judgement": {"findings": [{"instance": "a", "kind": "disagreement", "truth": "sat",
        "claims": [{"who": "z3", "answer": "unsat", "message": null}, {"who": "cvc5", "answer": "sat"}]}]}}"#;
    let folder = dir.path().join("out/2026-01-04");
    fs::create_dir_all(&folder).expect("ours");
    fs::write(folder.join("scores.json"), judgement).expect("ours");
    let (text, status) = night("2026-01-04", &after, 5);
    let wrong = "answers are wrong: hyperplan compare ends with 5\n  a: disagreement: z3 unsat; cvc5 sat (known: sat)\n";
    assert!(text.starts_with(wrong) && text.contains("0 of 4 runs are worse"), "{text}");
    assert_eq!(status, Some(5));
    // The same day again is not compared with itself.
    assert!(night("2026-01-02", &after, 0).0.contains("worse than on 2026-01-01"));
}

#[test]
fn programs_that_are_missing_or_interrupted() {
    if is_missing() {
        return;
    }
    let dir = tempfile::tempdir().expect("a temporary folder");
    // Stands for Ctrl-C, which goes to everyone: here to the script, its parent.
    let program = dir.path().join("hyperplan");
    fs::write(&program, "#!/bin/sh\nsleep 0.5; kill -INT $PPID\necho 'interrupted: hint' >&2\nexit 130\n")
        .expect("ours");
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).expect("our own file");
    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scripts");
    for name in ["table-1.py", "formula-16.py", "nightly.py"] {
        let run = |program: &Path| {
            let mut command = Command::new("python3");
            command.arg("-B").arg(scripts.join(name)).arg("--hyperplan").arg(program);
            let output = command.arg("--out").arg(dir.path().join("out")).output();
            let output = output.expect("python was there just now");
            (String::from_utf8_lossy(&output.stderr).into_owned(), output.status.code())
        };
        assert_eq!(run(&program), ("interrupted: hint\n".to_owned(), Some(130)), "{name}");
        let (said, status) = run(&dir.path().join("nothing"));
        assert!(said.starts_with("cannot run ") && said.contains("cargo build --release"), "{said}");
        assert_eq!((said.lines().count(), status), (1, Some(2)), "{said}");
    }
}
