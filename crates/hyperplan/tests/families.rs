//! `emit --family`.

mod common;

use common::{Run, command, hyperplan, text};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A family that takes a second or two.
const SMALL: [&str; 10] = [
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

fn family(folder: &Path, options: &[&str]) -> Run {
    hyperplan(&[&["emit", "--family", text(folder)], &SMALL[..], options].concat())
}

/// All files of a folder but the log, whose order is that of the work.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(&next).expect("the folder is ours").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if !path.ends_with("log.jsonl") {
                let inner = path.strip_prefix(folder).expect("it is inside").to_owned();
                found.insert(inner, fs::read(&path).expect("the file is ours"));
            }
        }
    }
    found
}

fn manifest(folder: &Path) -> serde_json::Value {
    let text = fs::read_to_string(folder.join("manifest.json")).expect("there is a manifest");
    serde_json::from_str(&text).expect("it is JSON")
}

#[test]
fn the_same_parameters_give_the_same_bytes_whatever_the_number_of_jobs() {
    let (one, two) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    let run = family(one.path(), &["--jobs", "1"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    family(two.path(), &["--jobs", "3"]);
    let files = contents(one.path());
    assert!(files.len() > 20, "{:?}", files.keys());
    assert_eq!(files.keys().collect::<Vec<_>>(), contents(two.path()).keys().collect::<Vec<_>>());
    assert_eq!(files, contents(two.path()));
}

#[test]
fn the_manifest_lists_what_is_there_with_both_statuses() {
    let folder = tempfile::tempdir().expect("a folder");
    family(folder.path(), &[]);
    let manifest = manifest(folder.path());
    let benchmarks = manifest["benchmarks"].as_array().expect("a list");
    let mut listed: Vec<PathBuf> = Vec::new();
    for entry in benchmarks {
        let string = |name: &str| entry[name].as_str().expect("a string").to_owned();
        let bytes = fs::read(folder.path().join(string("file"))).expect("it is there");
        assert_eq!(entry["bytes"].as_u64(), Some(bytes.len() as u64));
        assert!(string("file").contains(&format!("/{}/20260228-random-maps-hyperplan/", string("logic"))));
        // The problem beside it has the answer that the status says.
        let solved = hyperplan(&["solve", "--quiet", text(&folder.path().join(string("problem")))]);
        let status = match string("status").as_str() {
            "sat" => 0,
            "unsat" => 1,
            other => panic!("{other}"),
        };
        assert_eq!(solved.status, status, "{entry}");
        listed.push(string("file").into());
    }
    listed.sort();
    let there = contents(folder.path());
    let there: Vec<PathBuf> =
        there.into_keys().filter(|path| path.extension().is_some_and(|end| end == "smt2")).collect();
    assert_eq!(listed, there);
    let statuses: Vec<&str> = benchmarks.iter().filter_map(|entry| entry["status"].as_str()).collect();
    assert!(statuses.contains(&"sat") && statuses.contains(&"unsat"), "{statuses:?}");
    let table = fs::read_to_string(folder.path().join("manifest.csv")).expect("there is a table");
    assert_eq!(table.lines().count(), benchmarks.len() + 1);
}

/// Of every source of difficulty there are benchmarks, whose statuses are those of their problems.
#[test]
fn all_sources_are_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let objectives = "sp,isr,ar,iso,cso,isrs,ar2,ars,drift,cso3,alibi,locks,roads";
    let options = [
        "--sizes",
        "5",
        "--densities",
        "10",
        "--seeds",
        "0",
        "--maps",
        "random,aisles",
        "--horizons",
        "below,least",
    ];
    let written =
        ["--objectives", objectives, "--states", "onehot", "--quantifiers", "keep", "--date", "2026-02-28"];
    let run = hyperplan(&[&["emit", "--family", text(folder.path())], &options[..], &written[..]].concat());
    assert_eq!(run.status, 0, "{}", run.stderr);
    let manifest = manifest(folder.path());
    let mut statuses: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for entry in manifest["benchmarks"].as_array().expect("a list") {
        let word = |name: &str| entry[name].as_str().expect("a word");
        let solved = hyperplan(&["solve", "--quiet", "--first", text(&folder.path().join(word("problem")))]);
        assert_eq!(solved.status, i32::from(word("status") == "unsat"), "{entry} {}", solved.stderr);
        statuses.entry(word("objective")).or_default().insert(word("status"));
    }
    assert_eq!(statuses.keys().copied().collect::<BTreeSet<_>>(), objectives.split(',').collect());
    // Against faults of which no two follow each other there is seldom a plan.
    let lone: Vec<_> = statuses.iter().filter(|(_, both)| both.len() < 2).map(|(name, _)| *name).collect();
    assert_eq!(lone, ["ars"]);
}

#[test]
fn the_less_is_pruned_the_larger_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let small = ["--sizes", "5", "--densities", "10", "--seeds", "0", "--objectives", "isrs,cso3"];
    let written = ["--pruning", "none,light,full", "--horizons", "least", "--states", "onehot"];
    let run = hyperplan(&[&["emit", "--family", text(folder.path())], &small[..], &written[..]].concat());
    assert_eq!(run.status, 0, "{}", run.stderr);
    let manifest = manifest(folder.path());
    let mut sizes: BTreeMap<String, BTreeMap<&str, u64>> = BTreeMap::new();
    for entry in manifest["benchmarks"].as_array().expect("a list") {
        let pruning = entry["pruning"].as_str().expect("a word");
        let name = entry["instance"].as_str().expect("a word").replace(&format!("-{pruning}"), "");
        sizes.entry(name).or_default().insert(pruning, entry["bytes"].as_u64().expect("a number"));
    }
    assert!(sizes.len() > 2, "{sizes:?}");
    for (name, sizes) in &sizes {
        assert!(sizes["none"] > sizes["light"] && sizes["light"] > sizes["full"], "{name}: {sizes:?}");
    }
}

#[test]
fn what_was_interrupted_goes_on_and_what_is_there_is_not_done_again() {
    let (whole, cut) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    family(whole.path(), &[]);
    family(cut.path(), &[]);
    // As if killed while writing a line, with a file lost, one damaged, and no manifest.
    let log = cut.path().join("log.jsonl");
    let lines = fs::read_to_string(&log).expect("there is a log");
    let lines: Vec<&str> = lines.lines().collect();
    let kept = lines.len() / 2;
    fs::write(&log, format!("{}\n{}", lines[..kept].join("\n"), &lines[kept][..20])).expect("it is ours");
    let files: Vec<&str> = lines[..kept].iter().filter_map(|line| line.split("\"file\":\"").nth(1)).collect();
    let files: Vec<&str> = files.iter().filter_map(|rest| rest.split('"').next()).collect();
    fs::remove_file(cut.path().join(files[0])).expect("it was written");
    fs::write(cut.path().join(files[1]), "(exit)\n").expect("it was written");
    fs::remove_file(cut.path().join("manifest.json")).expect("it was written");
    let kept_file = cut.path().join(files[2]);
    let before = fs::metadata(&kept_file).and_then(|data| data.modified()).expect("it is there");
    let run = family(cut.path(), &[]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert_eq!(contents(cut.path()), contents(whole.path()));
    let after = fs::metadata(&kept_file).and_then(|data| data.modified()).expect("it is there");
    assert_eq!(before, after);
}

#[test]
fn a_family_is_extended_by_more_of_the_same_and_not_mixed_with_another() {
    let folder = tempfile::tempdir().expect("a folder");
    family(folder.path(), &["--states", "onehot"]);
    let before = contents(folder.path());
    family(folder.path(), &[]);
    let after = contents(folder.path());
    assert!(after.len() > before.len());
    let run = family(folder.path(), &["--submitter", "other"]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("its submitter is hyperplan, not other"), "{}", run.stderr);
    assert_eq!(contents(folder.path()), after);
}

#[test]
fn time_that_is_up_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = family(folder.path(), &["--timeout", "0.001"]);
    assert_eq!(run.status, 3, "{}", run.stderr);
    assert!(run.stderr.contains("run it again to go on"), "{}", run.stderr);
    assert_eq!(family(folder.path(), &[]).status, 0);
}

#[test]
fn what_makes_no_family_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = |options: &[&str], why: &str| {
        let run = command(&[&["emit", "--family", text(folder.path())], options].concat()).output();
        let run = Run::new(run.expect("the command was built for this test"));
        assert_eq!(run.status, 2, "{options:?}");
        assert!(run.stderr.contains(why), "{options:?}: {}", run.stderr);
    };
    refused(&["--sizes", "1"], "3 to 256 cells");
    refused(&["--densities", "90"], "0 to 60 percent");
    refused(&["--seeds", "4..2"], "the range 4..2 is empty");
    refused(&["--seeds", "many"], "expected numbers or ranges");
    refused(&["--objectives", "fastest"], "expected one of sp, isr, ar, iso, cso");
    refused(&["--maps", "round"], "expected random, rooms, maze or aisles");
    refused(&["--horizons", "far"], "expected below, least, above or double");
    refused(&["--submitter", "A. Robot"], "expected letters, digits and hyphens");
    refused(&["--limit", "0"], "--limit 0 is not a time");
    refused(&["rooms.hp"], "cannot be used with");
    let run = hyperplan(&["emit", "rooms.hp", "--objective", "sp", "--sizes", "4"]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("cannot be used with"), "{}", run.stderr);
}

#[test]
fn the_checker_of_the_rules_accepts_a_family() {
    let python = Command::new("python3").arg("--version").output();
    if !python.is_ok_and(|run| run.status.success()) {
        assert!(std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_none(), "python3 cannot be run");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    family(folder.path(), &[]);
    let run = Command::new("python3")
        .arg(common::specs().join("../scripts/check-benchmarks.py"))
        .arg(folder.path())
        .output()
        .expect("python3 was found");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stdout));
}

#[test]
fn certificates_beside_benchmarks() {
    let folder = tempfile::tempdir().expect("a folder");
    let certified = || {
        let manifest = manifest(folder.path());
        let all = manifest["benchmarks"].as_array().expect("a list").clone();
        let unsat = all.iter().filter(|entry| entry["status"] == "unsat").count();
        (all.into_iter().filter(|entry| entry["certified"] == true).collect::<Vec<_>>(), unsat)
    };
    let run = family(folder.path(), &[]);
    assert_eq!((run.status, certified().0.len()), (0, 0), "{}", run.stderr);
    // What was there without is made again.
    let run = family(folder.path(), &["--certify"]);
    let (entries, unsat) = certified();
    assert!(run.status == 0 && entries.len() == unsat && unsat > 2, "{unsat} {}", run.stderr);
    let said = format!("{unsat} unsat of which {unsat} certified");
    assert!(run.stdout.contains(&said), "{}", run.stdout);
    for entry in entries {
        let word = |name: &str| folder.path().join(entry[name].as_str().expect("a word"));
        let name = word("file").with_extension("");
        let alone = tempfile::tempdir().expect("a folder");
        for ending in ["json", "lrat.gz"] {
            let file = name.with_added_extension(ending);
            let copy = alone.path().join(file.file_name().expect("it has one"));
            fs::copy(&file, copy).expect("it was written");
        }
        let run = hyperplan(&["certify", text(&word("problem")), text(alone.path())]);
        assert_eq!(run.status, 0, "{} {}", run.stdout, run.stderr);
    }
}
