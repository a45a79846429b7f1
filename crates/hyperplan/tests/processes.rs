//! What becomes of solvers when the command ends before they do.
#![cfg(unix)]

mod common;

use common::fakes::Fake;
use common::{command, hyperplan};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Ignores all that can be ignored, and so do its children, one of them in the background of another.
const STUBBORN: &str = "trap '' TERM INT HUP QUIT PIPE
(trap '' TERM INT HUP; sh -c 'sleep 300 & echo $!; wait' | while read -r pid; do note $pid; done; sleep 300) & note $!
sleep 300 & note $!
sleep 300";

/// Starts the command with that fake, and waits until so many processes are there.
fn start(fake: &Fake, arguments: &str, processes: usize) -> Child {
    let solver = format!("'{}' {arguments}", fake.program().display());
    let child = command(&["solve", "rooms.hp", "--objective", "sp", "--solver", &solver])
        .env("TMPDIR", fake.temporary())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the command was built");
    let end = Instant::now() + Duration::from_secs(20);
    while fake.begun() < processes {
        assert!(Instant::now() < end, "only {} processes have begun", fake.begun());
        std::thread::sleep(Duration::from_millis(10));
    }
    child
}

fn signal(child: &Child, name: &str) {
    let status = Command::new("kill").args(["-s", name, &child.id().to_string()]).status();
    assert!(status.expect("every Unix has kill").success());
}

#[test]
fn signals_end_all_solvers() {
    for (name, status) in [("INT", Some(130)), ("TERM", Some(143)), ("KILL", None)] {
        let fake = Fake::new(STUBBORN);
        let mut child = start(&fake, "", 4);
        let begin = Instant::now();
        signal(&child, name);
        assert_eq!(child.wait().expect("it ends").code(), status, "{name}");
        assert!(begin.elapsed() < Duration::from_secs(11), "{name} took {:?}", begin.elapsed());
        fake.is_clean().unwrap_or_else(|left| panic!("{name}: {left}"));
    }
}

#[test]
fn the_file_of_a_query_is_removed() {
    for name in ["TERM", "KILL"] {
        let fake = Fake::new(&format!("test -s \"$1\" || exit 1\n{STUBBORN}"));
        let mut child = start(&fake, "{file}", 4);
        let files = std::fs::read_dir(fake.temporary()).expect("ours").count();
        assert_eq!(files, 1);
        signal(&child, name);
        child.wait().expect("it ends");
        fake.is_clean().unwrap_or_else(|left| panic!("{name}: {left}"));
    }
}

#[test]
fn a_watchdog_is_not_left_running() {
    let fake = Fake::new("exec sleep 300");
    let watchdogs = || {
        let output = Command::new("ps").args(["-Ao", "pgid=,args="]).output().expect("every Unix has ps");
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        text.lines().filter(|line| line.contains("hyperplan-watchdog")).map(str::to_owned).collect::<Vec<_>>()
    };
    let before = watchdogs();
    let mut child = start(&fake, "", 1);
    // Other tests run beside this one, and the solver may be there first.
    let end = Instant::now() + Duration::from_secs(60);
    let ours: Vec<String> = loop {
        let ours: Vec<String> = watchdogs().into_iter().filter(|line| !before.contains(line)).collect();
        if !ours.is_empty() {
            break ours;
        }
        assert!(Instant::now() < end, "there is no watchdog");
        std::thread::sleep(Duration::from_millis(50));
    };
    signal(&child, "KILL");
    child.wait().expect("it ends");
    let end = Instant::now() + Duration::from_secs(60);
    while watchdogs().iter().any(|line| ours.contains(line)) {
        assert!(Instant::now() < end, "{ours:?} are left");
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[test]
fn what_was_sent_is_in_the_file_before_the_answer() {
    let fake = Fake::new("exec sleep 300");
    let queries = fake.folder().join("queries");
    let solver = fake.program().display().to_string();
    let options = ["solve", "rooms.hp", "--objective", "sp", "--solver", &solver, "--queries"];
    let mut child = command(&options)
        .arg(&queries)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the command was built");
    let end = Instant::now() + Duration::from_secs(60);
    let asked = || {
        let files = std::fs::read_dir(&queries).into_iter().flatten().flatten();
        let mut texts = files.map(|file| std::fs::read_to_string(file.path()).unwrap_or_default());
        texts.any(|text| text.ends_with("(check-sat)\n"))
    };
    let mut kept = asked();
    while !kept && Instant::now() < end {
        std::thread::sleep(Duration::from_millis(20));
        kept = asked();
    }
    signal(&child, "KILL");
    child.wait().expect("it ends");
    assert!(kept, "what was sent was not kept while the solver was thinking");
    fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
}

#[test]
fn asking_for_abilities_leaves_nothing() {
    let fake = Fake::called("z3", "sleep 300 & note $!\nexec sleep 300");
    let begin = Instant::now();
    let output = command(&["solvers", "--format", "json"]).env("HYPERPLAN_Z3", fake.program()).output();
    let output = output.expect("the command was built");
    assert!(begin.elapsed() < Duration::from_secs(30));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let z3 = text.lines().find(|line| line.contains("\"name\":\"z3\"")).expect("it is listed");
    assert!(z3.contains("\"version\":null,\"abilities\":[]"), "{z3}");
    fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
    assert!(hyperplan(&["solvers"]).stdout.contains("builtin"));
}
