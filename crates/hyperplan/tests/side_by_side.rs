//! One objective on several cores: portfolios and cubes.
#![cfg(unix)]

mod common;

use common::fakes::Fake;
use common::{Run, command, hyperplan, text};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Objectives of every kind of leading block, with what is so.
const PROBLEM: &str = "
system Walk {
  state x: 0..6;
  init x == 0 | x == 3;
  action up, down, stay;
  on up when x < 6 { x' = x + 1; }
  on down when x > 0 { x' = x - 1; }
  on stay { }
}
objective there { exists p. F[0,6] x[p] == 6 & G[0,2] x[p] < 3 }
objective not_there { exists p. F[0,3] x[p] == 6 & G[0,1] x[p] < 3 }
objective low { forall p. G[0,2] x[p] < 6 }
objective lower { forall p. G[0,2] x[p] < 5 }
objective both { exists p, q. F[0,3] (x[p] == 6 & x[q] == 0) & X x[q] == 1 }
objective follow { exists p. forall q. x[p] == 0 & (G[0,3] action[p] == action[q] -> F[3,3] x[q] >= 3) }
objective answer { forall p. exists q. G[0,3] action[p] != action[q] | x[p] == 3 }
objective now { exists p. x[p] == 3 }
";

const VERDICTS: [(&str, &str); 8] = [
    ("there", "realizable"),
    ("not_there", "unrealizable"),
    ("low", "realizable"),
    ("lower", "unrealizable"),
    ("both", "realizable"),
    ("follow", "realizable"),
    ("answer", ""),
    ("now", "realizable"),
];

fn problem() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("walk.hp");
    std::fs::write(&file, PROBLEM).expect("the folder is ours");
    let name = text(&file).to_owned();
    (folder, name)
}

#[test]
fn cases_and_ways_decide_as_one_search_does() {
    let (_folder, file) = problem();
    for (objective, expected) in VERDICTS {
        let run = |more: &[&str]| {
            let base = ["solve", &file, "--objective", objective, "--format=json"];
            let run = hyperplan(&[&base, more].concat());
            assert_eq!(run.json().len(), 1, "{objective} {more:?}: {}", run.stderr);
            (run.status, run.json().remove(0), run.stderr)
        };
        let (status, alone, _) = run(&[]);
        if !expected.is_empty() {
            assert_eq!(alone["verdict"], expected, "{objective}");
        }
        for more in ["--cubes=2", "--cubes=20", "--portfolio=1", "--portfolio=3"] {
            let (other, answer, said) = run(&[more]);
            assert_eq!(
                (other, &answer["verdict"]),
                (status, &alone["verdict"]),
                "{objective} {more}: {said}"
            );
            assert_eq!(answer["horizon"], alone["horizon"], "{objective} {more}");
            assert_eq!(answer["witness"].is_null(), alone["witness"].is_null(), "{objective} {more}");
            assert_eq!(answer["verified"], alone["verified"], "{objective} {more}");
            let told = ["the first of ", "it was found in case ", "it is so in all of "];
            assert!(told.iter().any(|words| said.contains(words)), "{objective} {more}: {said}");
        }
    }
}

#[test]
fn what_was_found_is_printed_and_saved_as_always() {
    let (folder, file) = problem();
    let saved = folder.path().join("plan.json");
    let run = hyperplan(&["solve", &file, "--objective=both", "--cubes=4", "--save", text(&saved)]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(
        run.stdout.contains("both: realizable") && run.stdout.contains("verified by search"),
        "{}",
        run.stdout
    );
    let verified = hyperplan(&["verify", &file, text(&saved)]);
    assert_eq!(verified.status, 0, "{}", verified.stderr);
}

/// Each case alone is as the command with all of them has it, and says what it is about.
#[test]
fn cases_one_by_one_come_to_the_whole() {
    let (_folder, file) = problem();
    for (objective, expected) in VERDICTS.into_iter().filter(|(_, expected)| !expected.is_empty()) {
        let mut verdicts = Vec::new();
        for index in 1..=5 {
            let case = format!("--cube={index}/5");
            let run = hyperplan(&["solve", &file, "--objective", objective, &case, "--format=json"]);
            let answer = run.json().remove(0);
            assert_eq!((&answer["case"]["index"], &answer["case"]["of"]), (&index.into(), &5.into()));
            let decides = answer["case"]["decides"].as_str().map(str::to_owned);
            assert_eq!(
                answer["witness"].is_null(),
                decides.as_deref() != answer["verdict"].as_str(),
                "{answer}"
            );
            verdicts.push((answer["verdict"].as_str().map(str::to_owned), decides));
        }
        let decided = verdicts.iter().any(|(verdict, decides)| verdict == decides);
        let decides = verdicts[0].1.as_deref();
        assert_eq!(decided, decides == Some(expected), "{objective}: {verdicts:?}");
    }
    let run = hyperplan(&["solve", &file, "--objective=not_there", "--cube=2/5"]);
    assert!(run.status == 1 && run.stdout.contains("unrealizable in case 2 of 5"), "{}", run.stdout);
}

/// A constant and costs, over systems in which what is least can be told by hand.
const LEAST: &str = "
const T = 12;
system Walk {
  state x: 0..9;
  init x == 0 | x == 2;
  action up, jump, stay;
  on up when x < 9 { x' = x + 1; }
  on jump when x < 7 { x' = x + 3; }
  on stay { }
  cost fuel = if action == jump then 5 else if action == up then 2 else 0;
}
objective there { exists p. F[0,T] x[p] == 9 }
objective there_at { exists p. F[T,T] x[p] == 9 & G[0,T] (x[p] < 9 | F[0,T] x[p] == 9) }
objective never { exists p. F[0,T] x[p] == 9 & G[0,T] x[p] < 9 }
objective ahead { exists p. forall q. F[0,T] x[p] == 9 & (x[q] == 0 -> G[0,2] x[q] <= x[p] + 6) }
objective stays { forall p. G[0,T] x[p] < 9 | x[p] >= 0 & T > 4 }
objective cheap { exists p. F[0,T] x[p] == 9 minimize cost fuel[p]; }
objective cheap_two { exists p, q. F[0,T] x[p] == 9 & F[0,T] x[q] == 7 & x[p] == 0 minimize cost fuel[p] + cost fuel[q], cost fuel[q]; }
";

/// What is least, and that it is, does not depend on how many search.
#[test]
fn the_least_is_found_by_several_processes_too() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("least.hp");
    std::fs::write(&file, LEAST).expect("the folder is ours");
    let file = text(&file);
    let mut wishes: Vec<Vec<&str>> = Vec::new();
    for objective in ["there", "there_at", "never", "ahead", "stays"] {
        wishes.push(vec![objective, "--minimize=T"]);
        wishes.push(vec![objective, "--minimize=T=2..7"]);
    }
    wishes.push(vec!["cheap"]);
    wishes.push(vec!["cheap_two"]);
    wishes.push(vec!["cheap", "--minimize=T"]);
    wishes.push(vec!["there", "--minimize=cost fuel[p]"]);
    for wish in wishes {
        let run = |more: &[&str]| {
            let base = ["solve", file, "--format=json", "--objective"];
            let run = hyperplan(&[&base[..], &wish, more].concat());
            assert_eq!(run.json().len(), 1, "{wish:?} {more:?}: {}", run.stderr);
            (run.status, run.json().remove(0), run.stderr)
        };
        let (status, alone, _) = run(&[]);
        for more in ["--portfolio=3", "--cubes=2", "--cubes=5"] {
            let (other, answer, said) = run(&[more]);
            assert_eq!(other, status, "{wish:?} {more}: {said}");
            for field in ["verdict", "minimized", "costs", "horizon", "verified"] {
                assert_eq!(answer[field], alone[field], "{field} of {wish:?} {more}: {said}");
            }
        }
    }
}

/// A way that hangs loses, and is ended with all that it started.
#[test]
fn the_first_answer_ends_the_others() {
    let (_folder, file) = problem();
    let fake = Fake::new("trap '' TERM INT\nsetsid sleep 300 & note $!\nexec sleep 300");
    let solver = format!("--solver='{}'", fake.program().display());
    let start = Instant::now();
    let run = Run::new(
        command(&["solve", &file, "--objective=follow", &solver, "--portfolio=2"])
            .env("TMPDIR", fake.temporary())
            .output()
            .expect("it was built"),
    );
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.contains("the first of 2 was: --quantifiers=explicit"), "{}", run.stderr);
    assert!(start.elapsed() < Duration::from_secs(60));
    fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
}

#[test]
fn limits_and_signals_end_all() {
    let (_folder, file) = problem();
    let fake = Fake::new("trap '' TERM INT\nsetsid sleep 300 & note $!\nexec sleep 300");
    let solver = format!("--solver='{}'", fake.program().display());
    let arguments = ["solve", &file, "--objective=both", &solver, "--quantifiers=keep"];
    let start = Instant::now();
    let run = hyperplan(&[&arguments[..], &["--portfolio=2", "--timeout=1"]].concat());
    assert_eq!(run.status, 3, "{}", run.stderr);
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
    // Whose processes end when they are told has an answer.
    let plain = Fake::new("exec sleep 300");
    let solver = format!("--solver='{}'", plain.program().display());
    for more in ["--portfolio=2", "--cubes=3"] {
        let arguments = ["solve", &file, "--objective=both", &solver, "--quantifiers=keep", "--format=json"];
        let run = hyperplan(&[&arguments[..], &[more, "--timeout=3"]].concat());
        assert_eq!(run.status, 3, "{more}: {}", run.stderr);
        let answer = &run.json()[0];
        assert_eq!(
            (&answer["verdict"], &answer["reason_code"]),
            (&"unknown".into(), &"timeout".into()),
            "{answer}"
        );
    }
    plain.is_clean().unwrap_or_else(|left| panic!("{left}"));
    for signal in ["TERM", "KILL"] {
        let begun = fake.begun();
        let mut child = command(&[&arguments[..], &["--cubes=3"]].concat())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("it was built");
        let end = Instant::now() + Duration::from_secs(60);
        while fake.begun() == begun {
            assert!(Instant::now() < end, "it has not begun");
            std::thread::sleep(Duration::from_millis(10));
        }
        let killed = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status();
        assert!(killed.expect("every Unix has kill").success());
        let status = child.wait().expect("it ends");
        assert_eq!(status.code(), (signal == "TERM").then_some(143));
        fake.is_clean().unwrap_or_else(|left| panic!("{signal}: {left}"));
    }
}

#[test]
fn what_goes_wrong_in_all_is_told() {
    let (_folder, file) = problem();
    let fake = Fake::new("exit 7");
    let solver = format!("--solver='{}'", fake.program().display());
    for more in ["--portfolio=2", "--cubes=3"] {
        let run = hyperplan(&["solve", &file, "--objective=both", &solver, "--quantifiers=keep", more]);
        assert_eq!(run.status, 4, "{more}: {}", run.stderr);
        assert!(run.stderr.contains("error: "), "{}", run.stderr);
    }
    for (arguments, words) in [
        (&["--cubes=2", "--portfolio=2"][..], "cannot be used with"),
        (&["--cubes=2", "--cube=1/2"], "cannot be used with"),
        (&["--cube=1/2", "--minimize=T"], "--cube cannot be used with --minimize of a constant"),
        (&["--cube=3/2"], "from 1/N to N/N"),
        (&["--cube=1/2", "--proof=somewhere"], "cannot be used with"),
        (&["--cubes=20000"], "20000 is not in"),
        (&["--portfolio=2", "--queries=somewhere"], "--portfolio cannot be used with --queries"),
        (&["--portfolio=2", "--solver=batsat,z3"], "not a race"),
        (&["--portfolio=0"], "0 is not in"),
    ] {
        let run = hyperplan(&[&["solve", &file, "--objective=both"], arguments].concat());
        assert_eq!(run.status, 2, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(words), "{arguments:?}: {}", run.stderr);
    }
    let run = hyperplan(&["solve", "-", "--cubes=2"]);
    assert!(run.status == 2 && run.stderr.contains("takes a file"), "{}", run.stderr);
}
