//! `hyperplan verify`: what `solve` found holds, what was tampered with does not.

mod common;

use common::{Run, hyperplan, text};
use std::path::PathBuf;

struct Saved {
    folder: tempfile::TempDir,
    answer: String,
}

impl Saved {
    fn new(objective: &str) -> Saved {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("answer.json");
        let run =
            hyperplan(&["solve", "rooms.hp", "--objective", objective, "--save", text(&path), "--quiet"]);
        assert_eq!(run.status, 0, "{}", run.stderr);
        Saved { answer: std::fs::read_to_string(path).expect("saved"), folder }
    }

    fn write(&self, answer: &str) -> PathBuf {
        let path = self.folder.path().join("given.json");
        std::fs::write(&path, answer).expect("writable");
        path
    }

    fn verify(&self, answer: &str) -> Run {
        hyperplan(&["verify", "rooms.hp", text(&self.write(answer))])
    }
}

#[test]
fn what_solve_finds_holds() {
    for objective in ["sp", "isr", "ar", "iso", "cso"] {
        let saved = Saved::new(objective);
        let run = saved.verify(&saved.answer);
        assert_eq!(
            run.stdout,
            format!("{objective}: the strategy holds, verified by search\n"),
            "{}",
            run.stderr
        );
        assert_eq!(run.status, 0);
    }
}

#[test]
fn no_more_than_a_witness_is_needed() {
    let witness = r#"{"witness": [{"path": "p", "actions": ["up", "right", "up", "up", "up", "up"], "states": [
        {"x": 0, "y": 0}, {"x": 0, "y": 1}, {"x": 1, "y": 1}, {"x": 1, "y": 1}, {"x": 1, "y": 1}, {"x": 1, "y": 1},
        {"x": 1, "y": 1}]}]}"#;
    let saved = Saved::new("sp");
    let path = saved.write(witness);
    let verify = |objective| {
        hyperplan(&["verify", "rooms.hp", text(&path), "--objective", objective, "--format", "json"])
    };
    let holds = verify("sp");
    assert_eq!((holds.status, &holds.json()[0]["verdict"]), (0, &"holds".into()), "{}", holds.stderr);
    let fails = verify("ar");
    assert_eq!((fails.status, &fails.json()[0]["verdict"]), (1, &"fails".into()), "{}", fails.stderr);
    assert_eq!(fails.json()[0]["defeat"][0]["path"], "q");
    // Without a name it is not clear which objective is meant.
    assert_eq!(hyperplan(&["verify", "rooms.hp", text(&path)]).status, 2);
}

#[test]
fn states_follow_from_actions() {
    let verify = |objective, actions: &[&str]| {
        let actions = actions.iter().flat_map(|path| ["--actions", path]);
        let arguments = ["verify", "rooms.hp", "--objective", objective].into_iter().chain(actions);
        hyperplan(&arguments.collect::<Vec<_>>())
    };
    let status = |objective, actions: &[&str]| verify(objective, actions).status;
    // Its start is the objective's, its end absorbs: the plan is as long as it has to be.
    assert_eq!(verify("sp", &["p=up,right"]).stdout, "sp: the strategy holds, verified by search\n");
    assert_eq!(status("ar", &["p=up,right"]), 1);
    assert_eq!(status("iso", &["p=up, right", "q=up,right"]), 2, "q may start in any other room");
    let open = verify("iso", &["p=up,right", "q=up,right"]).stderr;
    assert!(open.contains("path q can start in "), "{open}");
    assert!(open.contains("docs/strategies.md"), "{open}");
    // Not at its goal, the plan cannot be continued.
    assert!(verify("sp", &["p=up"]).stderr.contains("path p has 1 steps, but the objective needs 6"));
    assert!(verify("sp", &["p=up,rigth"]).stderr.contains("did you mean `right`?"));
    assert!(verify("sp", &["=up"]).stderr.contains("expected PATH=ACTION,ACTION,..."));
}

#[test]
fn open_choices_are_named() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let problem = folder.path().join("lift.hp");
    let system = "system Lift { state at: 0..3; action up, slip; on up { at' = at + 1; } \
                  on slip { at' in {at, at + 1}; } init at == 0; }";
    let objective = "objective high { exists p. F[0,4] at[p] == 3 }";
    std::fs::write(&problem, format!("{system}\n{objective}\n")).expect("writable");
    let verify = |actions| hyperplan(&["verify", text(&problem), "--actions", actions]);
    assert_eq!(verify("p=up,up,up,slip").status, 0);
    let slip = verify("p=up,slip,up,slip");
    assert_eq!(slip.status, 2);
    let message = "path p, action 1: it can lead to 2 states, such as (at = 1) and (at = 2); give the states";
    assert!(slip.stderr.contains(message), "{}", slip.stderr);
    // What comes after may decide it: three times up are only possible from the ground.
    assert_eq!(verify("p=slip,up,up,up").status, 0, "{}", verify("p=slip,up,up,up").stderr);
    let given = folder.path().join("given.json");
    let partial =
        r#"{"witness": [{"path": "p", "actions": ["up", "up", "slip", "slip"], "states": [{"at": 1}]}]}"#;
    std::fs::write(&given, partial).expect("writable");
    let run = hyperplan(&["verify", text(&problem), text(&given)]);
    assert_eq!((run.status, run.stdout.contains("does not start in an initial state")), (1, true), "{run:?}");
}

#[test]
fn a_detour_is_not_the_shortest_path() {
    let saved = Saved::new("sp");
    let detour = r#"{"objective": "sp", "witness": [{"path": "p", "actions": ["right", "right", "up", "up", "up", "up"],
        "states": [{"x": 0, "y": 0}, {"x": 1, "y": 0}, {"x": 2, "y": 0}, {"x": 2, "y": 1}, {"x": 2, "y": 1},
        {"x": 2, "y": 1}, {"x": 2, "y": 1}]}]}"#;
    let run = saved.verify(detour);
    assert_eq!(run.status, 1, "{}", run.stderr);
    assert!(run.stdout.starts_with("sp: the strategy fails: "), "{}", run.stdout);
    assert!(run.stdout.contains("\nq: "), "{}", run.stdout);
}

#[test]
fn a_tampered_strategy_fails() {
    let saved = Saved::new("sp");
    let tampered = |change: fn(&mut serde_json::Value)| {
        let mut answer = serde_json::from_str(&saved.answer).expect("saved as JSON");
        change(&mut answer);
        saved.verify(&answer.to_string())
    };
    let elsewhere =
        tampered(|answer| answer["witness"][0]["states"][0] = serde_json::json!({"x": 2, "y": 1}));
    assert_eq!(elsewhere.status, 1, "{}", elsewhere.stderr);
    let other = tampered(|answer| answer["witness"][0]["actions"][0] = "left".into());
    assert_eq!(other.status, 1, "{}", other.stderr);
    assert!(other.stdout.contains("no such transition at step 0"), "{}", other.stdout);
}

#[test]
fn what_is_no_strategy_is_bad_input() {
    let saved = Saved::new("sp");
    let cases = [
        ("", "it is empty"),
        ("{", "line 1"),
        ("[]", "is no strategy"),
        (r#"{"witness": null, "objective": "sp"}"#, "no witness"),
        (r#"{"witness": [], "objective": "sp"}"#, "path p is missing"),
        (r#"{"witness": [], "objective": "none"}"#, "no objective `none`"),
        (
            r#"{"witness": [{"path": "p", "actions": [], "states": [{"x": 0, "y": 0}, {"x": 0, "y": 1}]}], "objective": "sp"}"#,
            "one more state",
        ),
        (r#"{"witness": [{"path": "p", "actions": [], "states": []}], "objective": "sp"}"#, "needs 6"),
        (
            r#"{"witness": [{"path": "p", "actions": [], "states": [{"x": 7, "y": 0}]}], "objective": "sp"}"#,
            "0..2",
        ),
        (
            r#"{"witness": [{"path": "p", "actions": [], "states": [{"x": 0, "y": 0}]}], "objective": "sp"}"#,
            "steps",
        ),
    ];
    for (text, message) in cases {
        let run = saved.verify(text);
        assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{text}: {}", run.stderr);
        assert!(run.stderr.contains(message), "{text}: {}", run.stderr);
    }
}

#[test]
fn a_counterexample_holds_too() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("answer.json");
    let options = ["--objective", "escape", "--save", text(&path), "--quiet"];
    let run = hyperplan(&[&["solve", "pass/forall-exists.hp"], &options[..]].concat());
    assert_eq!(run.status, 1, "{}", run.stderr);
    let run = hyperplan(&["verify", "pass/forall-exists.hp", text(&path)]);
    assert_eq!(
        (run.status, run.stdout.as_str()),
        (0, "escape: the counterexample holds, verified by search\n")
    );
}

#[test]
fn plot_reads_strategies() {
    let saved = Saved::new("cso");
    let (given, drawn) = (saved.write(&saved.answer), saved.folder.path().join("map.svg"));
    let run = hyperplan(&["plot", "rooms.hp", text(&given)]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stdout.contains("p (") && run.stdout.contains("q ("), "{}", run.stdout);
    let run = hyperplan(&["plot", "rooms.hp", text(&given), "-o", text(&drawn)]);
    assert_eq!((run.status, run.stdout.as_str()), (0, ""), "{}", run.stderr);
    assert!(std::fs::read_to_string(drawn).expect("drawn").starts_with("<svg"));
}

/// Fractions are read and checked exactly, and no solver is needed for that.
#[test]
fn strategies_with_fractions_are_replayed() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let verify = |third: &str| {
        let states = [
            ("0", "0"),
            ("0", "1.5"),
            ("0.75", third),
            ("\"11/12\"", third),
            ("\"13/12\"", third),
            ("1.25", third),
            ("\"17/12\"", third),
            ("\"19/12\"", third),
        ];
        let states = states.map(|(x, v)| format!("{{\"x\": {x}, \"v\": {v}}}")).join(", ");
        let actions = ["thrust", "brake", "coast", "coast", "coast", "coast", "coast"];
        let witness = format!("[{{\"path\": \"p\", \"actions\": {actions:?}, \"states\": [{states}]}}]");
        let path = folder.path().join("given.json");
        std::fs::write(&path, format!("{{\"objective\": \"brake\", \"witness\": {witness}}}"))
            .expect("writable");
        hyperplan(&["verify", "pass/reals.hp", text(&path)])
    };
    let run = verify("\"1/3\"");
    assert_eq!(
        (run.status, run.stdout.as_str()),
        (0, "brake: the strategy holds, verified by search\n"),
        "{}",
        run.stderr
    );
    let run = verify("0.333333333");
    assert_eq!(run.status, 1, "{}", run.stderr);
    assert!(run.stdout.contains("no such transition at step 2"), "{}", run.stdout);
}
