//! Comparisons on a real Slurm cluster, which `scripts/small-cluster` starts on this machine.
//!
//! Without Slurm's programs they are skipped; with `HYPERPLAN_REQUIRE_SLURM` set that is a failure.
#![cfg(target_os = "linux")]

mod common;

use common::compare::Comparison;
use common::fakes::Fake;
use common::{Run, command, text};
use std::collections::BTreeMap;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A node that is lost is noticed after half a minute.
const PATIENCE: Duration = Duration::from_secs(240);

/// A cluster that ends with the test.
struct Cluster {
    folder: TempDir,
}

impl Cluster {
    /// With three nodes of two cores; `None` where there are no programs for it.
    fn start() -> Option<Cluster> {
        let there = |program: &&str| {
            let folders = ["/usr/sbin", "/usr/bin", "/sbin", "/bin", "/usr/local/sbin", "/usr/local/bin"];
            folders.iter().any(|folder| Path::new(folder).join(program).exists())
        };
        let wanted = ["munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel"];
        if let Some(missing) = wanted.iter().find(|program| !there(program)) {
            assert!(std::env::var_os("HYPERPLAN_REQUIRE_SLURM").is_none(), "{missing} is required");
            let _ = writeln!(std::io::stderr(), "{missing} is missing: skipped");
            return None;
        }
        let cluster = Cluster { folder: tempfile::tempdir().expect("a temporary folder") };
        cluster.script(&["start"], &["3"]);
        Some(cluster)
    }

    fn folder(&self) -> PathBuf {
        self.folder.path().join("cluster")
    }

    fn script(&self, before: &[&str], behind: &[&str]) {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scripts/small-cluster");
        // What it starts goes on, and must not keep a pipe of ours open.
        let status = Command::new(script)
            .args(before)
            .arg(self.folder())
            .args(behind)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .status();
        assert!(status.expect("bash is there").success(), "{before:?} {behind:?}");
    }

    fn here(&self, command: &mut Command) {
        command.env("SLURM_CONF", self.folder().join("slurm.conf"));
    }

    fn scontrol(&self, words: &[&str]) {
        let mut command = Command::new("scontrol");
        self.here(command.args(words));
        assert!(command.status().expect("it is there").success(), "{words:?}");
    }

    fn queue(&self) -> String {
        let mut command = Command::new("squeue");
        self.here(command.args(["--noheader", "--array"]));
        String::from_utf8(command.output().expect("it is there").stdout).expect("it is text")
    }
}

impl Drop for Cluster {
    fn drop(&mut self) {
        self.script(&["stop"], &[]);
    }
}

/// Answers by the number of the query.
fn solver() -> Fake {
    Fake::new("input=$(cat)\nsleep 0.8\ncase $input in *x*[02468]' '*) echo sat ;; *) echo unsat ;; esac")
}

fn statuses(folder: &Path) -> BTreeMap<String, String> {
    let text = fs::read_to_string(folder.join("runs.json")).expect("it was written");
    let runs: Vec<serde_json::Value> = serde_json::from_str(&text).expect("it is JSON");
    let each =
        runs.iter().map(|run| (format!("{} {}", run["instance"], run["seed"]), run["status"].to_string()));
    let all: BTreeMap<String, String> = each.collect();
    assert_eq!(all.len(), runs.len(), "each once");
    all
}

/// Waits until so many runs are in the logs of tasks.
fn wait_for(comparison: &Comparison, runs: usize) {
    let end = Instant::now() + PATIENCE;
    loop {
        let files = fs::read_dir(comparison.out()).into_iter().flatten().flatten().map(|file| file.path());
        let logs =
            files.filter(|path| path.extension() == Some("jsonl".as_ref()) && !path.ends_with("runs.jsonl"));
        let done: usize =
            logs.filter_map(|log| fs::read_to_string(log).ok()).map(|log| log.lines().count()).sum();
        if done >= runs {
            return;
        }
        assert!(Instant::now() < end, "{runs} runs have not ended: {done}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn ended(child: Child) -> Run {
    Run::new(child.wait_with_output().expect("it ends"))
}

#[test]
fn nodes_may_die_and_jobs_be_cancelled() {
    let Some(cluster) = Cluster::start() else { return };
    let comparison = Comparison::new();
    let files = comparison.queries(20);
    let fake = solver();
    let solver = format!("--solver='{}'", fake.program().display());
    let what = [text(&files), &solver, "--seed=0..2", "--memory=200", "--timeout=20"];
    let what = what.map(|word| if word == "--seed=0..2" { "--seed=0,1,2" } else { word });
    let start = || {
        let mut command = comparison.command(&[&what[..], &["--engine=slurm", "--tasks=12"]].concat());
        cluster.here(&mut command);
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it was built")
    };
    let first = start();
    wait_for(&comparison, 8);
    cluster.script(&["kill"], &["node2"]);
    cluster.scontrol(&["update", "nodename=node3", "state=drain", "reason=test"]);
    wait_for(&comparison, 20);
    let term = Command::new("kill").args(["-s", "TERM", &first.id().to_string()]).status();
    assert!(term.expect("every Unix has kill").success());
    let first = ended(first);
    assert_eq!(first.status, 143, "{}", first.stderr);
    assert!(first.stderr.contains("of 60 runs are done"), "{}", first.stderr);
    assert_eq!(cluster.queue(), "");
    fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
    let done = comparison.log().lines().count();
    assert!((20..60).contains(&done), "{done}");
    // Another call goes on. What a node has that dies is submitted again.
    cluster.scontrol(&["update", "nodename=node3", "state=resume"]);
    let second = start();
    wait_for(&comparison, done + 2);
    cluster.script(&["kill"], &["node1"]);
    cluster.script(&["node"], &["node2"]);
    let second = ended(second);
    assert_eq!(second.status, 0, "{}", second.stderr);
    assert!(
        second.stderr.contains(&format!("note: {done} of 60 runs were done before")),
        "{}",
        second.stderr
    );
    assert!(second.stderr.contains("runs were lost, and are submitted again"), "{}", second.stderr);
    assert_eq!(cluster.queue(), "");
    // Nothing was done that was done: what was cut off is all that was begun twice, by four tasks twice and two.
    assert!(fake.begun() <= 60 + 10, "{}", fake.begun());
    let whole = comparison.folder().join("whole");
    let jobs = ["--jobs=4"];
    let run = Run::new(
        command(&[&["compare", "--out", text(&whole)], &what[..], &jobs].concat()).output().expect("built"),
    );
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert_eq!(statuses(&comparison.out()), statuses(&whole));
    let script = fs::read_dir(comparison.out().join("slurm")).expect("it is there").flatten();
    let mut script = script.map(|file| file.path()).filter(|path| path.extension() == Some("sh".as_ref()));
    let script = fs::read_to_string(script.next().expect("there is one")).expect("it is text");
    assert!(script.contains("\n#SBATCH --mem=481M\n"), "{script}");
}

#[test]
fn runs_come_back_with_what_is_printed() {
    let Some(cluster) = Cluster::start() else { return };
    let comparison = Comparison::new();
    let files = comparison.queries(6);
    let fake = solver();
    let solver = format!("--solver='{}'", fake.program().display());
    let engine = ["--engine=slurm", "--unshared", "--tasks=3", "--jobs=2", "--submit=--comment=a comparison"];
    let mut command = comparison.command(&[&[text(&files), &solver][..], &engine].concat());
    cluster.here(&mut command);
    let run = Run::new(command.output().expect("it was built"));
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert_eq!(statuses(&comparison.out()).len(), 6);
    // There is no log but the one that was gathered.
    let logs = fs::read_dir(comparison.out()).expect("it is there").flatten();
    let logs = logs.filter(|file| file.path().extension() == Some("jsonl".as_ref()));
    assert_eq!(logs.count(), 1);
    // What Slurm refuses is told.
    let broken = Comparison::new();
    let call = |words: &[&str]| {
        let mut command =
            broken.command(&[&["rooms.hp", "--objective=sp,iso", "--engine=slurm"], words].concat());
        cluster.here(&mut command);
        Run::new(command.output().expect("it was built"))
    };
    let run = call(&["--solver=builtin", "--submit=--time=no"]);
    assert_eq!(run.status, 2, "{}", run.stderr);
    assert!(
        run.stderr.contains("sbatch failed: ") && run.stderr.contains("0 of 2 runs are done"),
        "{}",
        run.stderr
    );
    // Elsewhere there is no such file: no task can do anything, and that is given up with what one of them said.
    let run = call(&["--solver=builtin", "--submit=--chdir=/"]);
    assert_eq!(run.status, 3, "{}", run.stderr);
    assert!(run.stderr.contains("2 runs get lost again and again"), "{}", run.stderr);
    assert!(run.stderr.contains("rooms.hp: there is no such file"), "{}", run.stderr);
    assert_eq!(cluster.queue(), "");
    let run = call(&["--solver=builtin", "--pin", "--exclusive"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
}

/// Cases of hard problems are runs like others: what they come to together is what one machine finds.
#[test]
fn cases_are_spread_over_a_cluster() {
    let Some(cluster) = Cluster::start() else { return };
    let comparison = Comparison::new();
    let what = ["rooms.hp", "--objective=sp,iso", "--solver=builtin", "--set=T=1,6"];
    let mut command =
        comparison.command(&[&what[..], &["--cubes=3", "--engine=slurm", "--tasks=4"]].concat());
    cluster.here(&mut command);
    let run = Run::new(command.output().expect("it was built"));
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert_eq!(comparison.log().lines().count(), 2 * 2 * 3);
    let whole = Comparison::new();
    assert_eq!(whole.run(&what).status, 0);
    let verdicts = |folder: &Path| {
        let text = fs::read_to_string(folder.join("runs.json")).expect("it was written");
        let runs: Vec<serde_json::Value> = serde_json::from_str(&text).expect("it is JSON");
        runs.iter()
            .map(|run| format!("{} {} {}", run["instance"], run["set"], run["status"]))
            .collect::<Vec<_>>()
    };
    assert_eq!(verdicts(&comparison.out()), verdicts(&whole.out()));
}

#[test]
fn without_slurm_that_is_said() {
    let comparison = Comparison::new();
    let files = comparison.queries(1);
    let fake = solver();
    let solver = format!("--solver='{}'", fake.program().display());
    let mut command = comparison.command(&[text(&files), &solver, "--engine=slurm"]);
    let run = Run::new(command.env("PATH", "/nowhere").output().expect("it was built"));
    assert_eq!(run.status, 2, "{}", run.stderr);
    assert!(run.stderr.contains("cannot run squeue"), "{}", run.stderr);
}
