//! Comparisons in pieces: plans, shares, folders of work, and logs put together.
#![cfg(unix)]

mod common;

use common::compare::Comparison;
use common::fakes::Fake;
use common::{Run, command, specs, text};
use std::collections::BTreeMap;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, Instant};

/// Answers by the number of the query, so that statuses differ.
const ANSWER: &str = "input=$(cat)\ncase $input in *x*[02468]' '*) echo sat ;; *) echo unsat ;; esac";

fn solver(fake: &Fake) -> String {
    format!("--solver='{}'", fake.program().display())
}

/// The runs in the report of a folder by what they are about, with their status.
fn statuses(folder: &Path) -> BTreeMap<String, String> {
    let text = fs::read_to_string(folder.join("runs.json")).expect("it was written");
    let runs: Vec<serde_json::Value> = serde_json::from_str(&text).expect("it is JSON");
    let count = runs.len();
    let about = |run: &serde_json::Value| {
        format!("{} {} {} {}", run["instance"], run["set"], run["solver"], run["seed"])
    };
    let all: BTreeMap<String, String> =
        runs.iter().map(|run| (about(run), format!("{} {}", run["status"], run["verified"]))).collect();
    assert_eq!(all.len(), count, "each once");
    all
}

fn good(run: Run) -> Run {
    assert_eq!(run.status, 0, "{}", run.stderr);
    run
}

fn logs(folder: &Path) -> Vec<PathBuf> {
    let files = fs::read_dir(folder).expect("it is there").flatten().map(|file| file.path());
    let mut logs: Vec<_> = files.filter(|path| path.extension() == Some("jsonl".as_ref())).collect();
    logs.sort();
    logs
}

#[test]
fn shares_of_a_plan_put_together_are_the_whole() {
    let comparison = Comparison::new();
    let files = comparison.queries(7);
    let fake = Fake::new(ANSWER);
    let arguments = [text(&files), &solver(&fake), "--seed=0,1"];
    let plan = comparison.folder().join("plan.jsonl");
    let plan_option = format!("--plan={}", plan.display());
    good(comparison.run(&[&arguments[..], &[&plan_option]].concat()));
    let lines = fs::read_to_string(&plan).expect("it was written");
    assert_eq!(lines.lines().count(), 1 + 14);
    assert!(!comparison.out().join("runs.jsonl").exists() && fake.begun() == 0);
    let first: serde_json::Value = serde_json::from_str(lines.lines().nth(1).expect("a run")).expect("JSON");
    assert_eq!(first["key"].as_str().map(str::len), Some(32), "{first}");
    assert_eq!(first["sha256"].as_str().map(str::len), Some(64), "{first}");
    let mut counts = Vec::new();
    for share in ["1/3", "3/3", "2/3"] {
        let before = fake.begun();
        let run = good(comparison.run(&[&plan_option, "--shard", share]));
        assert!(run.stderr.contains("to put logs together"), "{}", run.stderr);
        counts.push(fake.begun() - before);
        // Nothing is done twice.
        good(comparison.run(&[&plan_option, "--shard", share]));
        assert_eq!(fake.begun(), counts.iter().sum::<usize>());
    }
    counts.sort_unstable();
    assert_eq!(counts, [4, 5, 5]);
    let out = comparison.folder().join("whole");
    good(Run::new(
        command(&[&["compare", "--out", text(&out)], &arguments[..]].concat()).output().expect("built"),
    ));
    // In any order, and more than once.
    let mut paths = logs(&comparison.out());
    assert_eq!(paths.len(), 3);
    paths.reverse();
    let paths: Vec<&str> = paths.iter().map(|path| text(path)).collect();
    for merged in [&paths[..1], &paths[1..], &paths[..]] {
        let run = comparison.run(&[&[&plan_option, "--merge"], merged].concat());
        let status = if merged.len() == 1 { 3 } else { 0 };
        assert_eq!(run.status, status, "{}", run.stderr);
        assert_eq!(run.stderr.contains("of 14 runs of the plan are missing"), status == 3, "{}", run.stderr);
    }
    assert_eq!(statuses(&comparison.out()), statuses(&out));
    // Without the plan it is the same, and the command on one machine finds all done.
    good(comparison.run(&["--merge", paths[0]]));
    assert_eq!(statuses(&comparison.out()), statuses(&out));
    let run = good(comparison.run(&arguments));
    assert!(run.stderr.contains("14 of 14 runs were done before"), "{}", run.stderr);
}

#[test]
fn shares_without_a_plan_come_from_the_same_command() {
    let comparison = Comparison::new();
    let rooms = specs().join("rooms.hp");
    let arguments = [text(&rooms), "--objective=sp,iso,cso", "--solver=builtin", "--set=T=1,6"];
    for share in ["--shard=1/2", "--shard=2/2"] {
        good(comparison.run(&[&arguments[..], &[share, "--pin"]].concat()));
    }
    let paths = logs(&comparison.out());
    good(comparison.run(&["--merge", text(&paths[0]), text(&paths[1])]));
    let whole = Comparison::new();
    good(whole.run(&arguments));
    assert_eq!(statuses(&comparison.out()), statuses(&whole.out()));
    let run: serde_json::Value =
        serde_json::from_str(comparison.log().lines().next().expect("a run")).expect("JSON");
    assert!(run["host"].is_string() && run["ended_ms"].is_u64(), "{run}");
    // A share of nothing.
    let run = good(comparison.run(&[&arguments[..], &["--shard=9/9"]].concat()));
    assert!(run.stderr.contains("0 runs were done here"), "{}", run.stderr);
}

#[test]
fn what_has_changed_since_the_plan_is_not_run() {
    let comparison = Comparison::new();
    let files = comparison.queries(2);
    let fake = Fake::new(ANSWER);
    let plan = comparison.folder().join("plan.jsonl");
    let plan_option = format!("--plan={}", plan.display());
    good(comparison.run(&[text(&files), &solver(&fake), &plan_option]));
    let refused = |words: &str, status: i32| {
        let run = comparison.run(&[&plan_option, "--shard=1/1"]);
        assert_eq!(run.status, status, "{}", run.stderr);
        assert!(run.stderr.contains(words), "{}", run.stderr);
    };
    let again = comparison.run(&[&plan_option, "--shard=1/1", "--timeout=5"]);
    assert_eq!(again.status, 2);
    assert!(again.stderr.contains("says what is run, and how"), "{}", again.stderr);
    fs::write(files.join("1.smt2"), "(assert false)(check-sat)").expect("the folder is ours");
    refused("1.smt2 is not what it was when the plan was written", 2);
    fs::remove_file(files.join("1.smt2")).expect("the folder is ours");
    refused("1.smt2: there is no such file", 2);
    let text = fs::read_to_string(&plan).expect("it was written");
    let lines: Vec<&str> = text.lines().collect();
    for (changed, words) in [
        (lines[1..].join("\n"), "plan.jsonl:1:"),
        (text.replace("\"hyperplan_plan\":1", "\"hyperplan_plan\":2"), "its format is 2"),
        (
            format!("{text}{}\n", lines[1]),
            "plan.jsonl:4:1: not a run of a plan: an earlier line is the same run",
        ),
        (text[..text.len() - 10].to_owned(), "plan.jsonl:3:"),
        (String::new(), "not the plan of a comparison"),
    ] {
        fs::write(&plan, changed).expect("the folder is ours");
        refused(words, 2);
    }
    assert_eq!(fake.begun(), 0);
    fs::remove_file(&plan).expect("the folder is ours");
    refused("there is no such file", 2);
    let run = comparison.run(&["--shard=1/2"]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("name files to run, or a plan"), "{}", run.stderr);
}

/// Waits until so many runs are in the logs of a folder.
fn wait_for(folder: &Path, runs: usize) {
    let end = Instant::now() + Duration::from_secs(60);
    loop {
        let paths = if folder.is_dir() { logs(folder) } else { Vec::new() };
        let lines = paths.iter().filter_map(|path| fs::read_to_string(path).ok());
        if lines.map(|text| text.lines().count()).sum::<usize>() >= runs {
            return;
        }
        assert!(Instant::now() < end, "{runs} runs have not ended");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn whoever_comes_takes_what_is_left() {
    const RUNS: usize = 10;
    let comparison = Comparison::new();
    let files = comparison.queries(RUNS);
    let fake = Fake::new(&format!("sleep 0.2\n{ANSWER}"));
    let solver = solver(&fake);
    let arguments = [text(&files), &solver, "--shard=next"];
    let start = || comparison.command(&arguments).stderr(Stdio::piped()).spawn().expect("it was built");
    let (mut killed, ended) = (start(), start());
    wait_for(&comparison.out(), 3);
    // One dies, another is told to stop, a third comes.
    killed.kill().and_then(|()| killed.wait()).expect("it was running");
    let term = std::process::Command::new("kill").args(["-s", "TERM", &ended.id().to_string()]).status();
    assert!(term.expect("every Unix has kill").success());
    let ended = ended.wait_with_output().expect("it ends");
    assert_eq!(ended.status.code(), Some(143));
    let third = good(Run::new(start().wait_with_output().expect("it ends")));
    // What the first had is with it as long as nobody knows that it has died.
    assert!(third.stderr.contains("the rest is with others"), "{}", third.stderr);
    let work = fs::read_dir(comparison.out()).expect("it is there").flatten().map(|file| file.path());
    let work = work.into_iter().find(|path| path.join("taken").is_dir()).expect("there is work");
    let taken: Vec<_> = fs::read_dir(work.join("taken")).expect("it is there").flatten().collect();
    assert_eq!(taken.len(), 1);
    let long_ago = std::time::SystemTime::now() - Duration::from_secs(3600);
    let file = fs::File::options().write(true).open(taken[0].path()).expect("it is there");
    file.set_modified(long_ago).expect("the file is ours");
    good(comparison.run(&arguments));
    let paths = logs(&comparison.out());
    let paths: Vec<&str> = paths.iter().map(|path| text(path)).collect();
    good(comparison.run(&[&["--merge"], &paths[..]].concat()));
    assert_eq!(statuses(&comparison.out()).len(), RUNS);
    // Two runs at most were cut off.
    assert!(fake.begun() <= RUNS + 2, "{}", fake.begun());
    fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
}

#[test]
fn contradictions_and_torn_lines_are_told() {
    let comparison = Comparison::new();
    let files = comparison.queries(2);
    let fake = Fake::new(ANSWER);
    good(comparison.run(&[text(&files), &solver(&fake), "--shard=1/1"]));
    let log = comparison.out().join("runs-1-of-1.jsonl");
    let lines = fs::read_to_string(&log).expect("it was written");
    let (first, second) = lines.split_once('\n').expect("two lines");
    let other = comparison.folder().join("other.jsonl");
    let mut turned: serde_json::Value = serde_json::from_str(first).expect("it is JSON");
    turned["host"] = "elsewhere".into();
    turned["processor"] = "another one".into();
    turned["status"] = if turned["status"] == "sat" { "unsat" } else { "sat" }.into();
    fs::write(&other, format!("{turned}\n{}", &second[..40])).expect("the folder is ours");
    let merged = comparison.run(&["--merge", text(&log), text(&other)]);
    assert_eq!(merged.status, 4, "{}", merged.stderr);
    for words in [
        "other.jsonl:2: the line is incomplete",
        "the same run is sat on ",
        "note: times of different processors do not compare",
    ] {
        assert!(merged.stderr.contains(words), "{words}: {}", merged.stderr);
    }
    let csv = fs::read_to_string(comparison.out().join("runs.csv")).expect("it was written");
    assert!(csv.contains("elsewhere,another one"), "{csv}");
    let missing = comparison.run(&["--merge", "nowhere.jsonl"]);
    assert_eq!(missing.status, 2);
    assert!(missing.stderr.contains("cannot read nowhere.jsonl"), "{}", missing.stderr);
}

/// Whether a program is there; a template without its program is not tried.
fn is_there(program: &str) -> bool {
    let there =
        std::process::Command::new(program).arg("--version").output().is_ok_and(|it| it.status.success());
    if !there {
        let _ = writeln!(std::io::stderr(), "{program} is missing: its template is not tried");
    }
    there
}

/// Runs a template of `docs/cluster` where there is a plan of some runs, and compares with one machine.
fn template(program: &str, arguments: &[&str], environment: &[(&str, &str)]) {
    if !is_there(program) {
        return;
    }
    let comparison = Comparison::new();
    comparison.queries(5);
    let fake = Fake::new(ANSWER);
    let binary = Path::new(env!("CARGO_BIN_EXE_hyperplan")).parent().expect("it is in a folder");
    let path = format!("{}:{}", binary.display(), std::env::var("PATH").expect("there is one"));
    let solver = format!("--solver={}", fake.program().display());
    let options = format!("{solver} --timeout 20");
    let here = |program: &str, arguments: &[&str]| {
        let mut command = std::process::Command::new(program);
        command.args(arguments).current_dir(comparison.folder()).env("PATH", &path).env("OPTIONS", &options);
        command.env("HOME", comparison.folder());
        good(Run::new(command.envs(environment.iter().copied()).output().expect("it is there")));
    };
    here("hyperplan", &["compare", "queries", &solver, "--timeout=20", "--plan=plan.jsonl"]);
    if program == "snakemake" {
        fs::remove_file(comparison.folder().join("plan.jsonl")).expect("the folder is ours");
        let options = format!("options={options}");
        here(program, &[arguments, &["--config", "files=queries", "shares=3", &options]].concat());
    } else {
        here("sh", arguments);
    }
    here("hyperplan", &["compare", "queries", &solver, "--timeout=20", "--out=whole"]);
    let [all, whole] = ["all", "whole"].map(|name| statuses(&comparison.folder().join(name)));
    assert_eq!(all, whole);
}

const TEMPLATES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/cluster");

#[test]
fn template_of_parallel() {
    let script = format!("{TEMPLATES}/parallel.sh");
    template("parallel", &[&script], &[("SHARES", "3"), ("JOBS", "2")]);
}

#[test]
fn template_of_snakemake() {
    let file = format!("{TEMPLATES}/Snakefile");
    template("snakemake", &["--snakefile", &file, "--cores", "2"], &[]);
}
