//! Comparisons in pieces: plans, shares, folders of work, and logs put together.
#![cfg(unix)]

mod common;

use common::compare::Comparison;
use common::fakes::Fake;
use common::{Run, command, specs, text};
use std::collections::{BTreeMap, BTreeSet};
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

/// What is asked for is what the plan lists, whatever the option.
#[test]
fn every_option_changes_what_is_listed() {
    let comparison = Comparison::new();
    let rooms = specs().join("rooms.hp");
    let plan = comparison.folder().join("plan.jsonl");
    let plan_option = format!("--plan={}", plan.display());
    let keys = |more: &[&str]| {
        let what = [text(&rooms), "--solver=builtin", &plan_option];
        good(comparison.run(&[&what[..], more].concat()));
        let lines = fs::read_to_string(&plan).expect("it was written");
        let key =
            |line: &str| serde_json::from_str::<serde_json::Value>(line).expect("JSON")["key"].to_string();
        lines.lines().skip(1).map(key).collect::<BTreeSet<String>>()
    };
    let usual = keys(&["--objective=sp"]);
    assert_eq!(usual.len(), 1);
    for option in [
        "--objective=iso",
        "--quantifiers=cegis",
        "--states=bitvec",
        "--set=T=3",
        "--seed=5",
        "--repeat=2",
        "--timeout=5",
        "--cpu=5",
        "--memory=1000",
        "--no-verify",
        "--cubes=3",
    ] {
        let objective = if option.starts_with("--objective") { None } else { Some("--objective=sp") };
        let with = keys(&objective.into_iter().chain([option]).collect::<Vec<_>>());
        assert!(!with.is_subset(&usual), "{option} changes nothing");
    }
    assert_eq!(keys(&["--objective=sp", "--cubes=3"]).len(), 3);
    // Where the plan says it already, it is refused.
    for option in ["--bound=5", "--dialect=hyperqb1", "--cubes=2"] {
        let run = comparison.run(&[&plan_option, "--shard=1/1", option]);
        assert_eq!(run.status, 2, "{option}");
        assert!(run.stderr.contains("says what is run, and how"), "{option}: {}", run.stderr);
    }
}

/// The bound of models and formulas is in what a plan lists.
#[test]
fn bounds_are_part_of_a_plan() {
    let comparison = Comparison::new();
    let folder = comparison.folder().to_owned();
    let model =
        "MODULE main\nVAR x : 0..9;\nASSIGN init(x) := 0; next(x) := case x < 9 : x + 1; TRUE : x; esac;\n";
    fs::write(folder.join("m.smv"), model).expect("the folder is ours");
    fs::write(folder.join("f.hq"), "exists A. F (x[A] = 5)\n").expect("the folder is ours");
    let [model, formula] = ["m.smv", "f.hq"].map(|name| folder.join(name));
    let plan = folder.join("plan.jsonl");
    let plan_option = format!("--plan={}", plan.display());
    for (bound, status) in [("--bound=3", "unsat"), ("--bound=7", "sat")] {
        let files = [text(&model), text(&formula), "--solver=builtin"];
        good(comparison.run(&[&files[..], &[bound, &plan_option]].concat()));
        good(comparison.run(&[&plan_option]));
        let statuses = statuses(&comparison.out());
        assert!(
            statuses.len() == 1 && statuses.values().all(|found| found.contains(status)),
            "{bound}: {statuses:?}"
        );
    }
}

/// Cases of an objective, anywhere, in any order, come to what the objective does.
#[test]
fn cases_are_runs_and_reported_together() {
    let comparison = Comparison::new();
    let rooms = specs().join("rooms.hp");
    let what = [text(&rooms), "--objective=sp,iso,cso", "--solver=builtin", "--set=T=1,6"];
    let plan = comparison.folder().join("plan.jsonl");
    let plan_option = format!("--plan={}", plan.display());
    good(comparison.run(&[&what[..], &["--cubes=4", &plan_option]].concat()));
    let listed = fs::read_to_string(&plan).expect("it was written").lines().count();
    assert_eq!(listed, 1 + 3 * 2 * 4);
    for share in ["--shard=2/2", "--shard=1/2"] {
        good(comparison.run(&[&plan_option, share]));
    }
    let whole = Comparison::new();
    good(whole.run(&what));
    let paths = logs(&comparison.out());
    let paths: Vec<&str> = paths.iter().map(|path| text(path)).collect();
    // With half of the cases something is open, and nothing is wrong.
    let half = comparison.run(&[&[plan_option.as_str(), "--merge"], &paths[..1]].concat());
    assert_eq!(half.status, 3, "{}", half.stderr);
    good(comparison.run(&[&[plan_option.as_str(), "--merge"], &paths[..]].concat()));
    let verdicts = |folder: &Path| -> BTreeMap<String, String> {
        let first = |status: &String| status.split(' ').next().unwrap_or_default().to_owned();
        statuses(folder).iter().map(|(about, status)| (about.clone(), first(status))).collect()
    };
    assert_eq!(verdicts(&comparison.out()), verdicts(&whole.out()));
    let csv = fs::read_to_string(comparison.out().join("runs.csv")).expect("it was written");
    assert!(csv.contains("--cubes=4") && !csv.contains("--cube="), "{csv}");
}

/// Each run is on a core of its own, with all that it starts.
#[cfg(target_os = "linux")]
#[test]
fn pinned_runs_have_one_core_each() {
    let comparison = Comparison::new();
    let files = comparison.queries(6);
    let allowed = comparison.folder().join("allowed");
    let look = "grep Cpus_allowed_list /proc/self/status | cut -f2";
    let body = format!(
        "a=$({look})\nb=$(sh -c '{look}')\nstart=$(date +%s%N)\nsleep 0.3\necho $a $b $start $(date +%s%N) >> '{}'\n{ANSWER}",
        allowed.display()
    );
    let fake = Fake::new(&body);
    let cores = std::thread::available_parallelism().expect("there are some").get().min(2);
    let jobs = format!("--jobs={cores}");
    let run = |more: &[&str]| {
        good(comparison.run(&[&[text(&files), &solver(&fake), &jobs, "--pin"][..], more].concat()))
    };
    run(&[]);
    let seen = fs::read_to_string(&allowed).expect("it was written");
    let runs: Vec<Vec<u64>> = seen
        .lines()
        .map(|line| line.split(' ').map(|word| word.parse().expect("one core, not a list")).collect())
        .collect();
    assert_eq!(runs.len(), 6);
    for (at, one) in runs.iter().enumerate() {
        let [core, inner, start, end] = one[..] else { panic!("{one:?}") };
        assert_eq!(core, inner, "{seen}");
        for other in &runs[..at] {
            let together = other[2] < end && start < other[3];
            assert!(!together || other[0] != core, "two at a time on one core: {seen}");
        }
    }
    // More at a time than there are cores cannot be had.
    let many = format!("--jobs={}", 60_000);
    let refused = comparison.run(&[text(&files), &solver(&fake), &many, "--pin", "--seed=1"]);
    assert!(refused.status == 2 && refused.stderr.contains("cores, and there are"), "{}", refused.stderr);
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
