//! `solve --all`, `--differ` and `--prefer`: several answers, and the best among equals.

mod common;

#[cfg(unix)]
use common::fakes::Fake;
use common::{hyperplan, text};
use serde_json::{Value, json};
use std::collections::BTreeSet;

const WAYS: &str = "pass/preferred.hp";

fn solve(options: &[&str]) -> common::Run {
    hyperplan(&[&["solve", WAYS, "--objective"], options].concat())
}

fn witnesses(answer: &Value) -> Vec<Value> {
    let others = answer["several"]["others"].as_array().expect("there are several");
    std::iter::once(&answer["witness"]).chain(others.iter().map(|other| &other["witness"])).cloned().collect()
}

#[test]
fn there_are_no_others() {
    let run = solve(&["way", "--all", "40", "--format", "json"]);
    let answer = &run.json()[0];
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    let several = &answer["several"];
    assert_eq!(
        [&several["differ"], &several["wanted"], &several["more"]],
        [&json!("cells"), &json!(40), &json!("none")]
    );
    let all = witnesses(answer);
    let cells = |witness: &Value| -> Vec<(i64, i64)> {
        let states = witness[0]["states"].as_array().expect("states");
        let number = |state: &Value, name: &str| state[name].as_i64().expect("a number");
        states.iter().map(|state| (number(state, "x"), number(state, "y"))).collect()
    };
    let different: BTreeSet<Vec<(i64, i64)>> = all.iter().map(cells).collect();
    assert_eq!((all.len(), different.len()), (34, 34));
    assert!(several["others"].as_array().is_some_and(|o| o.iter().all(|o| o["verified"] == "by-search")));
    // A way on a map is what is done there.
    let run = solve(&["way", "--all", "40", "--differ", "actions", "--quiet"]);
    let said = "way: realizable; 34 strategies that differ in actions, and there are no others\n";
    assert_eq!((run.status, run.stdout.as_str()), (0, said));
}

#[test]
fn as_many_as_are_wanted() {
    let run = solve(&["way", "--all", "2"]);
    assert_eq!(run.status, 0);
    let begin = "way: realizable; 2 strategies that differ in cells\nhorizon: p 8\nstrategy 1:\np: ";
    assert!(run.stdout.starts_with(begin), "{}", run.stdout);
    assert!(
        run.stdout.contains("\nstrategy 2:\np: ") && !run.stdout.contains("strategy 3"),
        "{}",
        run.stdout
    );
    assert_eq!(run.stdout.matches("verified by search").count(), 1, "{}", run.stdout);
    let run = solve(&["way", "--all", "1", "--format", "json"]);
    assert_eq!(run.json()[0]["several"]["others"], json!([]));
    // Nobody asked.
    assert!(solve(&["way", "--format", "json"]).json()[0].get("several").is_none());
}

#[test]
fn what_is_preferred_comes_first() {
    let run = solve(&["way", "--prefer", "cost turns[p]", "--all", "3", "--format", "json"]);
    let answer = &run.json()[0];
    let cost = |value: i64| json!([{"expression": "cost turns[p]", "value": value, "least": value}]);
    // Facing any way at first, there are two without a turn but one; then those with two.
    assert_eq!(answer["costs"], cost(1), "{}", run.stdout);
    let others: Vec<&Value> =
        answer["several"]["others"].as_array().expect("others").iter().map(|other| &other["costs"]).collect();
    assert_eq!(others, [&cost(1), &cost(2)], "{}", run.stdout);
    let run = solve(&["way", "--prefer", "cost near[p], cost turns[p]", "--quiet"]);
    assert_eq!(
        run.stdout,
        "way: realizable with cost near[p] = 0, the least; cost turns[p] = 1, the least\n"
    );
}

/// What is to be minimized stays as small as it can be.
#[test]
fn among_equals() {
    let options = ["wide", "--prefer", "cost turns[p]", "--all", "9", "--format", "json"];
    let run = solve(&options);
    let answer = &run.json()[0];
    assert_eq!(answer["costs"][0]["expression"], "cost sideways[p]");
    assert_eq!(answer["several"]["more"], "none", "{}", run.stdout);
    let least = &answer["costs"][0]["value"];
    let others = answer["several"]["others"].as_array().expect("others");
    assert!(others.iter().all(|other| other["costs"][0]["value"] == *least), "{}", run.stdout);
    // Of a constant, the least value comes first.
    let run = solve(&["way", "--minimize", "T", "--prefer", "cost turns[p]", "--quiet"]);
    let said = "way: realizable with T = 8, unrealizable with 0..7; with cost turns[p] = 1, the least\n";
    assert_eq!((run.status, run.stdout.as_str()), (0, said));
    for lanes in ["--portfolio=2", "--cubes=2"] {
        let run = solve(&["way", lanes, "--prefer", "cost turns[p]", "--all", "2", "--format", "json"]);
        let answer = &run.json()[0];
        assert_eq!((run.status, &answer["costs"][0]["least"]), (0, &json!(1)), "{lanes}: {}", run.stderr);
        assert_eq!(witnesses(answer).len(), 2, "{lanes}");
    }
}

#[test]
fn others_are_verified_saved_and_drawn() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = |name: &str| folder.path().join(name);
    let (json, csv, svg) = (file("all.json"), file("plan.csv"), file("plan.svg"));
    let run = solve(&["way", "--all", "3", "--save", text(&json), "--plot", text(&svg), "--quiet"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let run = hyperplan(&["verify", WAYS, text(&json)]);
    assert_eq!(run.stdout.matches("way: the strategy holds").count(), 3, "{}{}", run.stdout, run.stderr);
    assert!((1..=3).all(|n| file(&format!("plan-{n}.svg")).exists()) && !file("plan-4.svg").exists());
    let run = solve(&["way", "--all", "2", "--save", text(&csv)]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    for number in 1..=2 {
        let run = hyperplan(&["verify", WAYS, "--objective=way", text(&file(&format!("plan-{number}.csv")))]);
        assert_eq!(run.status, 0, "{}", run.stderr);
    }
    // One of them is drawn, which has to be said.
    let run = hyperplan(&["plot", WAYS, text(&json)]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("--number"), "{}", run.stderr);
    let second = hyperplan(&["plot", WAYS, text(&json), "--number", "2"]);
    let first = hyperplan(&["plot", WAYS, text(&json), "--number", "1"]);
    assert_eq!((first.status, second.status), (0, 0), "{}{}", first.stderr, second.stderr);
    assert_ne!(first.stdout, second.stdout);
    assert_eq!(hyperplan(&["plot", WAYS, text(&json), "--number", "4"]).status, 2);
}

#[test]
fn time_may_end_before_there_are_enough() {
    let file = tempfile::NamedTempFile::with_suffix(".hp").expect("a temporary file");
    let problem =
        "system M { state x: 0..30, y: 0..30; action r, l, u, d; on r { x' = x + 1; } on l { x' = x - 1; }
        on u { y' = y + 1; } on d { y' = y - 1; } init x == 0 & y == 0; absorb x == 30 & y == 30; }
        objective o { exists p. F[0,70] (x[p] == 30 & y[p] == 30) }";
    std::fs::write(file.path(), problem).expect("written");
    let run = hyperplan(&["solve", text(file.path()), "--all", "9999", "--timeout", "3", "--format", "json"]);
    let answer = &run.json()[0];
    let several = &answer["several"];
    assert_eq!((run.status, &several["more"]), (3, &json!("unknown")), "{}", run.stderr);
    assert!(several["others"].as_array().is_some_and(|others| others.len() < 9998));
}

/// Of a property that does not hold, counterexamples.
#[test]
fn several_counterexamples() {
    let file = tempfile::NamedTempFile::with_suffix(".hp").expect("a temporary file");
    let problem =
        "system M { state x: 0..2; action r, s; on r { x' = x + 1; } on s {} init x == 0; absorb x == 2; }
        objective o { forall p. F[0,2] x[p] == 2 }";
    std::fs::write(file.path(), problem).expect("written");
    let run = hyperplan(&["solve", text(file.path()), "--all", "9", "--quiet"]);
    let said = "o: unrealizable; 3 counterexamples that differ in cells, and there are no others\n";
    assert_eq!((run.status, run.stdout.as_str()), (1, said));
}

#[test]
fn what_is_refused() {
    for (options, said) in [
        (&["way", "--all", "0"][..], "0"),
        (&["way", "--differ", "actions"], "--all"),
        (&["way", "--all", "2", "--cube", "1/2"], "--cube"),
        (&["way", "--all", "2", "--format", "csv"], "--save"),
        (&["way", "--prefer", "turns"], "cost turns[p]"),
        (&["way", "--prefer", "cost bends[p]"], "no cost `bends`"),
        (&["way", "--prefer", "3 - cost turns[p]"], "must not fall"),
    ] {
        let run = solve(options);
        assert_eq!(run.status, 2, "{options:?}");
        assert!(run.stderr.contains(said), "{options:?}: {}", run.stderr);
    }
}

/// Costs, the least value, what is preferred, and that there are no others, have certificates.
#[test]
fn certificates() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let proof = text(folder.path());
    let run = solve(&["way", "--minimize", "T", "--prefer", "cost turns[p]", "--proof", proof, "--quiet"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let run = hyperplan(&["certify", WAYS, proof]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stdout.contains("T=8, cost turns[p] <= 0"), "{}", run.stdout);
    for (differ, options) in [
        ("cells", &["way"][..]),
        ("actions", &["way"]),
        ("cells", &["wide"]),
        ("actions", &["way", "--minimize", "T", "--prefer", "cost near[p]"]),
    ] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let proof = text(folder.path());
        let run =
            solve(&[options, &["--all", "40", "--differ", differ, "--proof", proof, "--quiet"]].concat());
        assert_eq!(run.status, 0, "{}", run.stderr);
        let others = std::fs::read_dir(folder.path()).expect("it is there");
        let mut names: Vec<String> =
            others.map(|file| file.expect("a file").file_name().to_string_lossy().into_owned()).collect();
        names.retain(|name| name.contains("-others") && name.ends_with(".json"));
        assert_eq!(names.len(), 1, "{options:?}");
        let run = hyperplan(&["certify", WAYS, proof]);
        assert_eq!(run.status, 0, "{options:?}: {}{}", run.stdout, run.stderr);
        assert!(run.stdout.contains(&format!("known that differ in {differ}")), "{}", run.stdout);
        // With one strategy less, the claim is wrong.
        let file = folder.path().join(&names[0]);
        let mut certificate: Value =
            serde_json::from_str(&std::fs::read_to_string(&file).expect("readable")).expect("JSON");
        certificate["apart"]["from"].as_array_mut().expect("strategies").pop();
        std::fs::write(&file, certificate.to_string()).expect("written");
        assert_eq!(hyperplan(&["certify", WAYS, proof]).status, 2, "{options:?}");
    }
}

/// A solver that works, and then does not.
#[test]
#[cfg(unix)]
fn what_was_found_stays_if_others_cannot_be_looked_for() {
    if std::process::Command::new("z3").arg("-version").output().is_err() {
        return;
    }
    let fake = Fake::new(r#"[ "$(wc -l < "$(dirname "$0")/pids")" -gt 1 ] && exit 3; exec z3 -in"#);
    let solver = format!("'{}'", fake.program().display());
    let saved = fake.folder().join("saved.json");
    let run =
        solve(&["way", "--first", "--all", "3", "--solver", &solver, "--save", text(&saved), "--quiet"]);
    assert_eq!(run.status, 4, "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.starts_with("way: realizable"), "{}", run.stdout);
    assert!(run.stderr.contains("ended without an answer"), "{}", run.stderr);
    assert!(saved.exists(), "it is saved");
}

#[test]
fn why_it_is_not_known_whether_there_are_others_is_said() {
    let run = solve(&["way", "--all", "40", "--timeout", "0.000001", "--format", "json"]);
    let answer = &run.json()[0];
    assert_eq!(run.status, 3, "{}", run.stderr);
    assert_eq!(answer["reason_code"], "timeout", "{answer}");
}
