//! Tables and CSV against golden files; `UPDATE=1` writes these anew.

mod sample;

use std::path::Path;
use std::{env, fs};

use hyperplan_compare::report::write_all;
use hyperplan_compare::{Record, Status, summary};
use sample::{run, sample};

fn golden(name: &str, actual: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    if env::var_os("UPDATE").is_some() {
        fs::write(&path, actual).expect("the golden file can be written");
    }
    let expected = fs::read_to_string(&path).expect("the golden file is there; UPDATE=1 writes it");
    assert_eq!(actual, expected, "{name}");
}

#[test]
fn files() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let written = write_all(&sample(), dir.path()).expect("a folder that can be written");
    for name in ["runs.csv", "table.md", "table.tex", "instances.md", "instances.tex", "scores.json"] {
        let path = dir.path().join(name);
        assert!(written.contains(&path), "{name}");
        golden(name, &fs::read_to_string(path).expect("what was written can be read"));
    }
    let json = fs::read(dir.path().join("runs.json")).expect("what was written can be read");
    let read: Vec<Record> = serde_json::from_slice(&json).expect("records");
    assert_eq!(read, sample());
}

#[test]
fn terminal() {
    golden("summary.txt", &summary(&sample()));
    assert_eq!(summary(&[]), "no runs\n");
}

/// Nothing to show is shown.
#[test]
fn odd_ones() {
    let none = [run("z3", "a", Status::Timeout, 0.0)];
    let unsupported = [run("z3", "a", Status::Unsupported, 0.0)];
    let mut infinite = [run("z3", "a", Status::Sat, f64::NAN), run("cvc5", "a", Status::Sat, f64::INFINITY)];
    infinite[0].limit.wall_s = Some(f64::NAN);
    for records in [&[] as &[Record], &none, &unsupported, &infinite] {
        let dir = tempfile::tempdir().expect("a temporary folder");
        write_all(records, dir.path()).expect("a folder that can be written");
        assert!(!summary(records).is_empty());
    }
}
