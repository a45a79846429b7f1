//! What is written for BenchExec, read by BenchExec. Skipped where it is missing, unless `HYPERPLAN_REQUIRE_SOLVERS` is set.

#![allow(clippy::print_stderr, reason = "what is skipped is said")]
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

use hyperplan_compare::benchexec::{Configuration, Problem, write};
use hyperplan_compare::{Answer, Limit};

/// Stands for hyperplan: says how it was called, and answers what the objective's name wants.
const PRETENDER: &str = r#"#!/bin/sh
if [ "$1" = --version ]; then echo "hyperplan 7.8.9"; exit; fi
echo "$@" > called
echo '{"verdict": "realizable", "verified": "by-search", "seconds": {"solve": 0.25}}'
case "$*" in *"--objective yes "*) exit 0;; *"--objective no "*) exit 1;; *) exit 3;; esac
"#;

fn benchexec(dir: &Path, module: &str, arguments: &[&str]) -> Output {
    let path = std::env::var("PATH").unwrap_or_default();
    Command::new("python3")
        .args(["-m", module])
        .args(arguments)
        .current_dir(dir)
        .env("PYTHONPATH", dir)
        .env("PATH", format!("{}:{path}", dir.join("bin").display()))
        .output()
        .expect("python was there just now")
}

fn is_missing() -> bool {
    let probe = Command::new("python3").args(["-c", "import benchexec.test_tool_info"]).output();
    let missing = !probe.is_ok_and(|output| output.status.success());
    if missing {
        assert!(std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_none(), "BenchExec is missing");
        eprintln!("skipped: BenchExec is missing");
    }
    missing
}

fn written(dir: &Path) {
    fs::create_dir(dir.join("bin")).expect("a new folder");
    let pretender = dir.join("bin/hyperplan");
    fs::write(&pretender, PRETENDER).expect("a file that can be written");
    fs::set_permissions(&pretender, fs::Permissions::from_mode(0o755)).expect("our own file");
    let odd = dir.join("odd [1]* \"name\".hp");
    fs::write(&odd, "").expect("a file that can be written");
    let problem = |objective: &str, set: &[&str], expected| Problem {
        file: odd.clone(),
        objective: Some(objective.to_owned()),
        set: set.iter().copied().map(str::to_owned).collect(),
        expected,
    };
    let problems = [
        problem("yes", &[], Some(Answer::Sat)),
        problem("no", &["T=12", "K=\"1/2\""], Some(Answer::Unsat)),
        problem("perhaps", &[], None),
    ];
    let configuration = |name: &str, options: &[(&str, &str)]| Configuration {
        name: name.to_owned(),
        options: options.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect(),
    };
    let solvers = [
        configuration("z3 keep", &[("--solver", "z3"), ("--quantifiers", "keep")]),
        configuration("z3/keep", &[("--solver", "\"a <b> & c\"")]),
    ];
    let limit = Limit { wall_s: Some(9.5), cpu_s: Some(19.0), memory_mib: None };
    write(dir, &problems, &solvers, &limit).expect("a folder that can be written");
    // Again: what is there does not disturb.
    write(dir, &problems, &solvers, &limit).expect("a folder that can be written");
}

#[test]
fn the_checker_accepts_the_module() {
    if is_missing() {
        return;
    }
    let dir = tempfile::tempdir().expect("a temporary folder");
    written(dir.path());
    let task = fs::read_dir(dir.path().join("tasks"))
        .expect("tasks were written")
        .map(|entry| entry.expect("an entry").path())
        .find(|path| path.to_string_lossy().contains("2-"))
        .expect("the second task");
    let output = benchexec(
        dir.path(),
        "benchexec.test_tool_info",
        &["hyperplan_tool.hyperplan", "--no-container", "--task-definition", &task.display().to_string()],
    );
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    // The pretender is not on the system's path, one file is one task, and nobody solves motion planning in C.
    let expected =
        ["Path to executable is absolute", "ignores property file", "multiple input", "SV-Benchmarks"];
    let strange = |line: &&str| {
        line.contains("ERROR")
            || line.contains("WARNING") && !expected.iter().any(|warning| line.contains(warning))
    };
    assert_eq!(said.lines().find(strange), None, "{said}");
    for part in ["“7.8.9”", "--objective", "'no'", "T=12", "K=\"1/2\""] {
        assert!(said.contains(part), "{part} is missing: {said}");
    }
}

/// Not in a container and without limits, which need rights that are not everywhere.
#[test]
fn benchexec_runs_it() {
    if is_missing() {
        return;
    }
    let dir = tempfile::tempdir().expect("a temporary folder");
    written(dir.path());
    let limits = ["--timelimit", "-1", "--walltimelimit", "-1", "--memorylimit", "-1", "--numOfThreads", "1"];
    let mut arguments = vec!["hyperplan.xml", "--no-container", "--no-compress-results"];
    arguments.extend(limits);
    let output = benchexec(dir.path(), "benchexec.benchexec", &arguments);
    let said =
        format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{said}");
    let mut results: Vec<String> = Vec::new();
    for entry in fs::read_dir(dir.path().join("results")).expect("there are results") {
        let path = entry.expect("an entry").path();
        if path.to_string_lossy().ends_with(".xml") {
            results.push(fs::read_to_string(path).expect("what was written can be read"));
        }
    }
    assert_eq!(results.len(), 2, "{said}");
    for xml in results {
        for part in
            ["value=\"true\"", "value=\"false\"", "value=\"unknown\"", "value=\"correct\"", "value=\"0.25\""]
        {
            assert!(xml.contains(part), "{part} is missing: {xml}");
        }
        assert!(!xml.contains("value=\"wrong\""), "{xml}");
    }
}
