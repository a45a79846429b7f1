//! `minimize` and `solve --minimize EXPR`: the cheapest strategy, and what is said of it.

mod common;

use common::{hyperplan, text};
use serde_json::json;

const COSTS: &str = "pass/costs.hp";

fn solve(options: &[&str]) -> common::Run {
    hyperplan(&[&["solve", COSTS, "--objective"], options].concat())
}

#[test]
fn the_cheapest_strategy_and_its_proof() {
    let run = solve(&["way"]);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    let start = "way: realizable with cost fuel[p] = 8, the least\nhorizon: p 10\n";
    assert!(run.stdout.starts_with(start) && run.stdout.contains("\nverified by search\n"), "{}", run.stdout);
    let run = solve(&["way", "--format", "json"]);
    let answer = &run.json()[0];
    assert_eq!(answer["costs"], json!([{"expression": "cost fuel[p]", "value": 8, "least": 8}]));
    assert_eq!(answer["witness"][0]["actions"].as_array().map(Vec::len), Some(10));
    // Where nothing is minimized, answers have no such part.
    let run = solve(&["cheap", "--format", "json"]);
    assert!(run.json()[0].get("costs").is_none(), "{}", run.stdout);
}

#[test]
fn what_counts_most_comes_first() {
    for (wish, expected) in [
        (None, [2, 29]),
        (Some("cost turns[p], 2 * cost fuel[p] + 1"), [2, 29]),
        (Some("cost fuel[p] * 2 + 1, cost turns[p]"), [17, 4]),
    ] {
        let options: Vec<&str> = wish.iter().flat_map(|wish| ["--minimize", *wish]).collect();
        let run = solve(&[&["straight", "--format", "json"], options.as_slice()].concat());
        let costs = run.json()[0]["costs"].clone();
        assert_eq!([&costs[0]["value"], &costs[1]["value"]], [&json!(expected[0]), &json!(expected[1])]);
        assert_eq!([&costs[0]["least"], &costs[1]["least"]], [&json!(expected[0]), &json!(expected[1])]);
    }
}

/// However states are written, and whoever decides quantifiers.
#[test]
fn all_ways_find_the_same() {
    for way in [
        &["--states", "bitvec"][..],
        &["--states", "enum", "--quantifiers", "expand"],
        &["--quantifiers", "cegis"],
        &["--solver", "batsat"],
    ] {
        let run = solve(&[&["both", "--format", "json"], way].concat());
        let expected = json!([{"expression": "cost fuel[p] + cost ticks[q]", "value": 20, "least": 20}]);
        assert_eq!((run.status, &run.json()[0]["costs"]), (0, &expected), "{way:?} {}", run.stderr);
    }
    let run = solve(&["none_cheaper", "--minimize", "cost fuel[p]", "--quiet"]);
    assert_eq!(run.stdout, "none_cheaper: realizable with cost fuel[p] = 8, the least\n");
}

#[test]
fn there_may_be_none() {
    let run = solve(&["cheaper", "--minimize", "cost fuel[p]", "--format", "json"]);
    assert_eq!((run.status, &run.json()[0]["verdict"]), (1, &"unrealizable".into()));
    assert!(run.json()[0].get("costs").is_none());
}

#[test]
fn what_is_not_proved_is_said() {
    // By variable, the bounds of such a map take far longer than finding some way does.
    let file = tempfile::NamedTempFile::with_suffix(".hp").expect("a temporary file");
    let problem =
        "system M { state x: 0..19, y: 0..19; action r, l, u, d; on r { x' = x + 1; } on l { x' = x - 1; }
        on u { y' = y + 1; } on d { y' = y - 1; } init x == 0 & y == 0; absorb x == 19 & y == 19;
        cost w = 1 + (7 * x + 11 * y) % 9; }
        objective o { exists p. F[0,44] (x[p] == 19 & y[p] == 19) minimize cost w[p]; }";
    std::fs::write(file.path(), problem).expect("written");
    let run =
        hyperplan(&["solve", text(file.path()), "--states", "bitvec", "--timeout", "5", "--format", "json"]);
    if run.stdout.is_empty() {
        // Not even some way was found, on a slow machine.
        assert!(run.status == 3 && run.stderr.contains("stopped"), "{}", run.stderr);
        return;
    }
    let answer = &run.json()[0];
    let cost = &answer["costs"][0];
    let (least, value) = (cost["least"].as_i64(), cost["value"].as_i64());
    assert!(least <= value, "{}", run.stdout);
    let proved = answer["verdict"] == "realizable" && least == value;
    assert_eq!(run.status, if proved { 0 } else { 3 }, "{}", run.stdout);
    assert_eq!(answer["reason"].is_null(), proved, "{}", run.stdout);
}

/// Sums are no part of a strategy: they follow from its steps.
#[test]
fn saved_strategies_are_checked() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let saved = folder.path().join("answer.json");
    let run = solve(&["cheap", "--save", text(&saved)]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let kept = std::fs::read_to_string(&saved).expect("saved");
    assert!(!kept.contains("cost fuel"), "{kept}");
    let run = hyperplan(&["verify", COSTS, text(&saved), "--objective", "cheap"]);
    assert_eq!(run.status, 0, "{} {}", run.stdout, run.stderr);
    let actions = "p=down,right,right,right,right,up,up,up";
    let run = hyperplan(&["verify", COSTS, "--objective", "cheap", "--actions", actions]);
    assert_eq!(run.status, 0, "{} {}", run.stdout, run.stderr);
    // It costs too much for another objective.
    let run = hyperplan(&["verify", COSTS, "--objective", "cheaper", "--actions", actions]);
    assert_eq!(run.status, 1, "{} {}", run.stdout, run.stderr);
}

#[test]
fn wishes_that_make_no_sense() {
    for (wish, why) in [
        ("cost fule[p]", "did you mean `fuel`?"),
        ("cost fuel[q]", "the path `q` is not quantified"),
        ("cost fuel[p] +", "expected an expression"),
        ("cost fuel[p]; cost fuel[p]", "expected an operator, `,` or the end"),
        ("x[p]", "--minimize"),
        ("-cost fuel[p]", "must not fall"),
    ] {
        let run = solve(&["way", &format!("--minimize={wish}")]);
        assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{wish}");
        assert!(run.stderr.contains(why), "{wish}: {}", run.stderr);
    }
    let run = solve(&["way", "--minimize", "T"]);
    assert!(run.stdout.starts_with("way: realizable with T = 6, unrealizable with 0..5\n"), "{}", run.stdout);
    assert!(run.stderr.contains("note: way: its own `minimize` is left aside"), "{}", run.stderr);
}
