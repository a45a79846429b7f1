//! `emit --family --select`.

mod common;

use common::{Run, hyperplan, text};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// A family that takes a second.
fn family(folder: &Path, options: &[&str]) -> Run {
    let small = [
        "--sizes",
        "4",
        "--densities",
        "10",
        "--seeds",
        "0..1",
        "--objectives",
        "sp,cso",
        "--date",
        "2026-02-28",
    ];
    hyperplan(&[&["emit", "--family", text(folder)], &small[..], options].concat())
}

/// A program that reads a benchmark from its standard input and runs a line of shell.
fn solver(folder: &Path, name: &str, line: &str) -> String {
    let path = folder.join(name);
    fs::write(&path, format!("#!/bin/sh\ncat > /dev/null\n{line}\n")).expect("the folder is ours");
    use std::os::unix::fs::PermissionsExt as _;
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("the file is ours");
    text(&path).to_owned()
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_slice(&fs::read(path).expect("it was written")).expect("it is JSON")
}

/// All files of a folder.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(&next).expect("the folder is ours").flatten() {
            let path = entry.path();
            match path.is_dir() {
                true => folders.push(path),
                false => {
                    let inner = path.strip_prefix(folder).expect("it is inside").to_owned();
                    found.insert(inner, fs::read(&path).expect("the file is ours"));
                }
            }
        }
    }
    found
}

#[test]
fn solvers_are_measured_and_what_they_got_wrong_is_in_the_header() {
    let (folder, programs) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    let liar = solver(programs.path(), "liar", "echo unsat");
    let lost = solver(programs.path(), "lost", "echo unknown");
    let solvers = format!("{liar},{lost}");
    let options = ["--select", "6", "--measure-by", &solvers, "--measure-limit", "5"];
    let run = family(folder.path(), &options);
    assert_eq!(run.status, 0, "{} {}", run.stdout, run.stderr);
    assert!(run.stdout.contains("selected: 6 benchmarks chosen"), "{}", run.stdout);
    let selected = folder.path().join("selected");
    let manifest = json(&selected.join("manifest.json"));
    let benchmarks = manifest["benchmarks"].as_array().expect("a list");
    assert_eq!(benchmarks.len(), 6);
    for entry in benchmarks {
        let file =
            fs::read_to_string(selected.join(entry["file"].as_str().expect("a path"))).expect("it is there");
        let wrong = format!("Measured: {liar} says unsat, which is wrong.");
        assert_eq!(file.contains(&wrong), entry["status"] == "sat", "{entry}");
        assert_eq!(entry["runs"][&lost]["outcome"], "unsolved");
        assert_eq!(entry["bin"], "over 5 s");
        assert!(selected.join(entry["problem"].as_str().expect("a path")).is_file());
    }
    let statuses = benchmarks.iter().filter(|entry| entry["status"] == "sat").count();
    assert_eq!(statuses, 3);
    let table = fs::read_to_string(selected.join("manifest.csv")).expect("it was written");
    assert!(table.lines().next().is_some_and(|line| line.ends_with(&format!("{liar},{lost}"))), "{table}");
    // What was run is not run again, and what was chosen is chosen again, by that log alone too.
    let before = contents(&selected);
    let log = folder.path().join("measured/runs.jsonl");
    let runs = fs::read(&log).expect("there is a log");
    assert_eq!(family(folder.path(), &options).status, 0);
    assert_eq!(fs::read(&log).expect("there is a log"), runs);
    assert!(contents(&selected) == before);
    let run =
        hyperplan(&["emit", "--family", text(folder.path()), "--select", "6", "--measured", text(&log)]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(contents(&selected) == before);
    // A kill in the middle of a line, and lines in another order, lose no more than that line's run.
    let lines = String::from_utf8(runs).expect("text");
    let mut lines: Vec<&str> = lines.lines().collect();
    lines.reverse();
    fs::write(&log, lines.join("\n") + "\n{\"instance\":\"a").expect("the folder is ours");
    let run =
        hyperplan(&["emit", "--family", text(folder.path()), "--select", "6", "--measured", text(&log)]);
    assert!(run.status == 0 && run.stderr.contains("the line is incomplete"), "{}", run.stderr);
    assert!(contents(&selected) == before);
}

#[test]
fn only_solvers_that_are_asked_now_count() {
    let (folder, programs) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    let quick = solver(programs.path(), "quick", "echo unknown");
    let slow = solver(programs.path(), "slow", "sleep 0.1; echo unknown");
    let select = |by: &str| {
        let options = ["--select", "4", "--measure-by", by, "--measure-limit", "5"];
        let run = family(folder.path(), &options);
        assert_eq!(run.status, 0, "{}", run.stderr);
        json(&folder.path().join("selected/manifest.json"))
    };
    let names = |manifest: &serde_json::Value| -> Vec<String> {
        manifest["solvers"].as_object().expect("a table").keys().cloned().collect()
    };
    let both = select(&format!("{quick},{slow}"));
    assert_eq!(names(&both), [quick.clone(), slow]);
    let one = select(&quick);
    assert_eq!(names(&one), std::slice::from_ref(&quick));
    for entry in one["benchmarks"].as_array().expect("a list") {
        assert_eq!(
            entry["runs"].as_object().expect("a table").keys().collect::<Vec<_>>(),
            [&quick],
            "{entry}"
        );
    }
    // A log that is named counts as it is.
    let log = folder.path().join("measured/runs.jsonl");
    let run =
        hyperplan(&["emit", "--family", text(folder.path()), "--select", "4", "--measured", text(&log)]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert_eq!(names(&json(&folder.path().join("selected/manifest.json"))), names(&both));
}

#[test]
fn what_makes_no_selection_is_refused_and_loses_nothing() {
    let (folder, programs) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    let lost = solver(programs.path(), "lost", "echo unknown");
    let measure = ["--measure-by", &lost, "--measure-limit", "5"];
    assert_eq!(family(folder.path(), &[&["--select", "4"], &measure[..]].concat()).status, 0);
    let before = contents(folder.path());
    let refused = |options: &[&str], why: &str| {
        let run = family(folder.path(), options);
        assert!(run.status == 2 || run.status == 4, "{options:?}: {}", run.status);
        assert!(run.stderr.contains(why), "{options:?}: {}", run.stderr);
        let after = contents(folder.path());
        let changed: Vec<_> = before.iter().filter(|&(path, bytes)| after.get(path) != Some(bytes)).collect();
        assert!(changed.is_empty(), "{options:?}: {changed:?}");
    };
    refused(&[&["--select", "1000"], &measure[..]].concat(), "benchmarks to choose from; make more");
    // Each question once: the encodings are alike to a solver that solves none.
    refused(&[&["--select", "23"], &measure[..]].concat(), "benchmarks can be chosen; take --select");
    refused(&["--select", "4", "--measure-by", "nosuchsolver"], "nosuchsolver");
    refused(&["--select", "4", "--measure-limit", "0"], "--measure-limit 0 is not a time");
    refused(&["--select", "4", "--easy", "0"], "--easy 0 is not a time");
    refused(&["--select", "4", "--track", "model"], "--select measures single queries");
    refused(&["--select", "4", "--measured", "nosuch.jsonl"], "there is no log nosuch.jsonl");
    refused(&["--measured", "nosuch.jsonl"], "--select");
    let other = programs.path().join("other.jsonl");
    fs::write(&other, "hello\n").expect("the folder is ours");
    refused(&["--select", "4", "--measured", text(&other)], "no run in these logs is about a benchmark");
    // Of runs with several limits it has to be said which ones count.
    let log = folder.path().join("measured/runs.jsonl");
    let runs = fs::read_to_string(&log).expect("there is a log");
    let line = runs.lines().next().expect("there are runs").replace("\"wall_s\":5.0", "\"wall_s\":7.0");
    fs::write(&other, format!("{runs}{line}\n").replacen("\"key\":\"", "\"key\":\"x", 1))
        .expect("the folder is ours");
    let both = format!("{},{}", text(&log), text(&other));
    refused(&["--select", "4", "--measured", &both], "limits of 5, 7 s; say by --measure-limit");
}

#[test]
fn a_full_disk_leaves_the_selection_as_it_was() {
    let (folder, programs) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    let lost = solver(programs.path(), "lost", "echo unknown");
    let options = ["--measure-by", &lost, "--measure-limit", "5"];
    assert_eq!(family(folder.path(), &[&["--select", "4"], &options[..]].concat()).status, 0);
    let selected = folder.path().join("selected");
    let before = contents(&selected);
    // A benchmark that is gone cannot be copied, as one that there is no room for.
    let entry = json(&selected.join("manifest.json"))["benchmarks"][0].clone();
    let problem = folder.path().join(entry["problem"].as_str().expect("a path"));
    fs::remove_file(&problem).expect("it was written");
    let log = folder.path().join("measured/runs.jsonl");
    let chosen = ["emit", "--family", text(folder.path()), "--select", "4", "--measured", text(&log)];
    let run = hyperplan(&chosen);
    assert!(run.status == 2 && run.stderr.contains("cannot read"), "{}", run.stderr);
    assert!(contents(&selected) == before);
    // What such a run left does not matter to the next.
    fs::write(&problem, "").expect("the folder is ours");
    assert_eq!(hyperplan(&chosen).status, 0);
    assert!(!folder.path().join("selected.new").exists() && !folder.path().join("selected.old").exists());
}

#[test]
fn headers_with_remarks_follow_the_rules() {
    let python = std::process::Command::new("python3").arg("--version").output();
    if !python.is_ok_and(|run| run.status.success()) {
        assert!(std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_none(), "python3 cannot be run");
        return;
    }
    let (folder, programs) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    let liar = solver(programs.path(), "liar", "echo sat");
    let broken = solver(programs.path(), "broken", "exit 3");
    let solvers = format!("{liar},{broken}");
    let options = ["--select", "3", "--measure-by", &solvers, "--measure-limit", "5", "--easy", "0.000001"];
    let run = family(folder.path(), &options);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let run = std::process::Command::new("python3")
        .arg(common::specs().join("../scripts/check-benchmarks.py"))
        .arg(folder.path().join("selected"))
        .output()
        .expect("python3 was found");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stdout));
}
