//! The processes of a comparison: measured, limited, and gone when it is.
#![cfg(target_os = "linux")]

mod common;

use common::compare::Comparison;
use common::fakes::Fake;
use common::{specs, text};
use std::collections::BTreeSet;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Far more than anything here takes on an idle machine.
const PATIENCE: Duration = Duration::from_secs(60);

fn solver(fake: &Fake) -> String {
    format!("--solver='{}'", fake.program().display())
}

/// The only run of a fake on a query.
fn one(fake: &Fake, options: &[&str]) -> serde_json::Value {
    let comparison = Comparison::new();
    let files = comparison.queries(1);
    let start = Instant::now();
    let run = comparison.run(&[&[text(&files), &solver(fake)], options].concat());
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(start.elapsed() < PATIENCE, "it took {:?}", start.elapsed());
    fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
    let [record] = comparison.records().try_into().expect("one run");
    record
}

fn number(record: &serde_json::Value, name: &str) -> f64 {
    record[name].as_f64().expect("it is a number")
}

#[test]
fn wall_time() {
    // Whoever ignores signals ends as well, with all that it has started.
    let fake =
        Fake::new("trap '' TERM INT HUP\nsetsid sh -c 'sleep 300' & note $!\nsleep 300 & note $!\nwait");
    let record = one(&fake, &["--timeout=0.5"]);
    assert_eq!((&record["status"], &record["message"]), (&"timeout".into(), &"wall time".into()), "{record}");
    assert!(number(&record, "wall_s") >= 0.5, "{record}");
    // An answer that comes too late is none.
    let late = Fake::new("echo sat; exec sleep 300");
    assert_eq!(one(&late, &["--timeout=0.5"])["status"], "timeout");
}

#[test]
fn cpu_time_of_everything() {
    let spin = "i=0; while :; do i=$((i+1)); done";
    let fake =
        Fake::new(&format!("sh -c '{spin}' & note $!\nsetsid sh -c '{spin}' & note $!\nexec sleep 300"));
    let record = one(&fake, &["--timeout=50", "--cpu=1"]);
    assert_eq!((&record["status"], &record["message"]), (&"timeout".into(), &"CPU time".into()), "{record}");
    assert!(number(&record, "cpu_s") >= 1.0 && number(&record, "wall_s") < 50.0, "{record}");
}

#[test]
fn cpu_time_of_what_nobody_waited_for() {
    // Enough to be counted, by a process that has left the group; its parent goes, and so does the solver.
    let fake = Fake::new(
        "if [ \"$1\" = spin ]; then
  i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done
  echo > \"$TMPDIR/done\"; exec sleep 300
fi
mkfifo \"$TMPDIR/done\"
sh -c \"setsid '$0' spin &\"
cat \"$TMPDIR/done\"; echo sat",
    );
    let record = one(&fake, &[]);
    assert_eq!(record["status"], "sat", "{record}");
    assert!(number(&record, "cpu_s") > 0.02, "{record}");
}

#[test]
fn memory_of_everything() {
    // Each of them has less than the limit.
    let grow = "head -c 60000000 /dev/zero | tail -c 60000000 | sleep 300";
    let fake = Fake::new(&format!("for i in 1 2 3; do ({grow}) & note $!; done\nwait"));
    let record = one(&fake, &["--timeout=50", "--memory=120"]);
    assert_eq!(record["status"], "memout", "{record}");
    assert!(number(&record, "memory_mib") >= 120.0, "{record}");
}

#[test]
fn children_are_not_left_by_a_good_answer_either() {
    let fake =
        Fake::new("setsid sleep 300 & note $!\n(setsid sleep 300 & note $!) \ncat > /dev/null; echo unsat");
    assert_eq!(one(&fake, &[])["status"], "unsat");
}

#[test]
fn crashes() {
    let record = one(&Fake::new("echo 'assertion failed' >&2; kill -SEGV $$"), &[]);
    let expected = (&"error".into(), &11.into(), &serde_json::Value::Null, &"assertion failed".into());
    assert_eq!((&record["status"], &record["signal"], &record["exit_code"], &record["message"]), expected);
    let record = one(&Fake::new("exit 7"), &[]);
    assert_eq!((&record["status"], &record["exit_code"]), (&"error".into(), &7.into()));
    assert_eq!(one(&Fake::new("exec <&-; echo sat"), &[])["status"], "sat");
}

#[test]
fn limits_of_hyperplan_itself() {
    let comparison = Comparison::new();
    let rooms = specs().join("rooms.hp");
    let fake = Fake::new("trap '' TERM\nsetsid sleep 300 & note $!\nexec sleep 300");
    let arguments = [text(&rooms), "--objective=sp", &solver(&fake), "--timeout=1"];
    let run = comparison.run(&arguments);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let record = &comparison.records()[0];
    // It ended by itself, and could say what it knows.
    assert_eq!((&record["status"], &record["exit_code"]), (&"timeout".into(), &3.into()), "{record}");
    assert_eq!(record["horizon"], 6);
    fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
}

/// Waits until so many lines are in the log.
fn wait_for(comparison: &Comparison, lines: usize) {
    let end = Instant::now() + PATIENCE;
    while comparison.log().lines().count() < lines {
        assert!(Instant::now() < end, "only {} runs have ended", comparison.log().lines().count());
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn signal(child: &Child, name: &str) {
    let status = Command::new("kill").args(["-s", name, &child.id().to_string()]).status();
    assert!(status.expect("every Unix has kill").success());
}

#[test]
fn interrupted_at_any_time_nothing_is_lost_or_repeated() {
    const RUNS: usize = 8;
    for (name, status, jobs) in [("KILL", None, 1), ("INT", Some(130), 2), ("TERM", Some(143), 2)] {
        let comparison = Comparison::new();
        let files = comparison.queries(RUNS);
        let fake = Fake::new("setsid sleep 300 & note $!\ncat > /dev/null; sleep 0.3; echo sat");
        let (solver, jobs_option) = (solver(&fake), format!("--jobs={jobs}"));
        let arguments = [text(&files), &solver, &jobs_option];
        let child = comparison.command(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
        let child = child.expect("the command was built");
        wait_for(&comparison, 3);
        signal(&child, name);
        let ended = child.wait_with_output().expect("it ends");
        assert_eq!(ended.status.code(), status, "{name}");
        fake.is_clean().unwrap_or_else(|left| panic!("{name}: {left}"));
        let before = comparison.log();
        let done = before.lines().count();
        assert!((3..RUNS).contains(&done), "{name}: {done}");
        let said = String::from_utf8_lossy(&ended.stderr).into_owned();
        if status.is_some() {
            assert!(said.contains(&format!("interrupted: {done} of {RUNS} runs are done")), "{said}");
            assert_eq!(ended.stdout, b"");
        }
        let run = comparison.run(&arguments);
        assert_eq!(run.status, 0, "{}", run.stderr);
        assert!(
            run.stderr.contains(&format!("note: {done} of {RUNS} runs were done before")),
            "{}",
            run.stderr
        );
        assert!(comparison.log().starts_with(&before), "{name}");
        let records = comparison.records();
        let keys: BTreeSet<String> = records.iter().map(|record| record["key"].to_string()).collect();
        assert_eq!((records.len(), keys.len()), (RUNS, RUNS), "{name}");
        assert!(records.iter().all(|record| record["status"] == "sat"), "{name}");
        // Each run is two processes. No more were begun twice than were going on.
        assert!(fake.begun() <= 2 * (RUNS + jobs), "{name}: {}", fake.begun());
        assert!(!comparison.out().join("evidence").exists(), "{name}");
    }
}

#[test]
fn two_comparisons_do_not_write_one_log() {
    let comparison = Comparison::new();
    let files = comparison.queries(1);
    let fake = Fake::new("exec sleep 300");
    let solver = solver(&fake);
    let mut child =
        comparison.command(&[text(&files), &solver]).stderr(Stdio::null()).spawn().expect("it was built");
    let end = Instant::now() + PATIENCE;
    while fake.begun() == 0 {
        assert!(Instant::now() < end, "it has not begun");
        std::thread::sleep(Duration::from_millis(5));
    }
    let run = comparison.run(&[text(&files), &solver]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("runs.jsonl is in use by another comparison"), "{}", run.stderr);
    signal(&child, "INT");
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
    assert_eq!(fake.begun(), 1);
}

#[test]
fn several_at_a_time() {
    let comparison = Comparison::new();
    let files = comparison.queries(4);
    // Each waits until another is there.
    let fake = Fake::new(
        "cat > /dev/null\nfolder=$(dirname $0)\nwhile [ $(wc -l < $folder/pids) -lt 2 ]; do sleep 0.05; done\necho sat",
    );
    let run = comparison.run(&[text(&files), &solver(&fake), "--jobs=2", "--timeout=50"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(comparison.records().iter().all(|record| record["status"] == "sat"));
    assert_eq!(fake.begun(), 4);
}

/// The run fails, and the others go on.
#[test]
fn the_process_that_measures_is_killed() {
    let comparison = Comparison::new();
    let files = comparison.queries(2);
    let fake = Fake::new("sleep 300 & note $!\nsleep 0.3\nkill -KILL $PPID\nexec sleep 300");
    let other = Fake::called("other", "cat > /dev/null; echo sat");
    let solvers = format!("{},'{}'", solver(&fake), other.program().display());
    let run = comparison.run(&[text(&files), &solvers]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let mut records = comparison.records();
    records.sort_by_key(|record| record["status"].to_string());
    let statuses: Vec<_> = records.iter().map(|record| &record["status"]).collect();
    assert_eq!(statuses, ["error", "error", "sat", "sat"]);
    let message = records[0]["message"].as_str().expect("it says why");
    assert!(message.contains("the process that measures it ended: signal: 9"), "{message}");
    fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
}

/// The time limit holds all the same.
#[test]
fn the_process_that_measures_is_stopped() {
    let fake = Fake::new("kill -STOP $PPID\nexec sleep 300");
    let record = one(&fake, &["--timeout=0.5"]);
    assert_eq!(record["status"], "timeout", "{record}");
}
