//! `hyperplan solve --minimize`: the least value of a constant, and what is said of the smaller ones.

mod common;

use common::{hyperplan, text};

/// Runs `solve` on a file of the specs' folder, or elsewhere; its status and standard output.
fn solve(options: &[&str]) -> (i32, String) {
    let run = hyperplan(&[&["solve", "--quiet"], options].concat());
    assert_eq!(run.stderr, "", "{options:?}");
    (run.status, run.stdout)
}

/// The message of a run that fails with status 2.
fn refused(options: &[&str]) -> String {
    let run = hyperplan(&[&["solve"], options].concat());
    assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{options:?} {}", run.stderr);
    run.stderr
}

/// A problem file with this text.
fn file(text: &str) -> tempfile::NamedTempFile {
    let file = tempfile::NamedTempFile::with_suffix(".hp").expect("a temporary file");
    std::fs::write(file.path(), text).expect("written");
    file
}

#[test]
fn the_least_horizons_of_the_case_studies() {
    for (objective, least) in [("sp", 16), ("isr", 15), ("ar", 16), ("iso", 14), ("cso", 10)] {
        let name = format!("case-studies/{objective}-10.hp");
        let run = hyperplan(&["solve", &name, "--minimize", "T", "--format", "json"]);
        assert_eq!(run.status, 0, "{}", run.stderr);
        let answer = &run.json()[0];
        let expected =
            serde_json::json!({"constant": "T", "range": [0, 20], "value": least, "below": "unrealizable"});
        assert_eq!(answer["minimized"], expected, "{objective}");
        assert_eq!((&answer["verdict"], &answer["verified"]), (&"realizable".into(), &"by-search".into()));
        assert_eq!(answer["witness"][0]["actions"].as_array().map(Vec::len), Some(least), "{objective}");
    }
}

#[test]
fn the_answer_is_that_of_the_value_found() {
    let run = hyperplan(&["solve", "rooms.hp", "--objective", "ar", "--minimize", "T"]);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    let start = "ar: realizable with T = 4, unrealizable with 0..3\nhorizon: p 4, q 4\n";
    assert!(run.stdout.starts_with(start), "{}", run.stdout);
    assert!(run.stdout.contains("\nverified by search\n"), "{}", run.stdout);
    // Without the option, answers have no such part.
    let run = hyperplan(&["solve", "rooms.hp", "--objective", "ar", "--format", "json"]);
    assert!(run.json()[0].get("minimized").is_none(), "{}", run.stdout);
}

#[test]
fn a_saved_strategy_is_checked_with_its_value() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let saved = folder.path().join("answer.json");
    let sp = ["rooms.hp", "--objective", "sp"];
    solve(&[&sp[..], &["--minimize", "T", "--save", text(&saved)]].concat());
    let run = hyperplan(&["verify", "rooms.hp", text(&saved), "--set", "T=2"]);
    assert_eq!(run.status, 0, "{}{}", run.stdout, run.stderr);
}

#[test]
fn the_range_is_said_or_taken_from_the_file() {
    let sp = ["rooms.hp", "--objective", "sp"];
    for (options, status, line) in [
        (&["--minimize", "T=0..1"][..], 1, "unrealizable with T = 0..1"),
        (&["--minimize", "T=1..1"], 1, "unrealizable with T = 1"),
        (&["--minimize", "T=2..9"], 0, "realizable with T = 2, the first of the range"),
        (&["--minimize", "T = 1 .. 9"], 0, "realizable with T = 2, unrealizable with 1"),
        (&["--minimize", "T", "--set", "T=1"], 1, "unrealizable with T = 0..1"),
        (&["--minimize", "T", "--set", "T=0"], 1, "unrealizable with T = 0"),
    ] {
        let expected = (status, format!("sp: {line}\n"));
        assert_eq!(solve(&[&sp[..], options].concat()), expected, "{options:?}");
    }
    let run =
        hyperplan(&["solve", "rooms.hp", "--objective", "sp", "--minimize", "T=0..1", "--format", "json"]);
    let expected =
        serde_json::json!({"constant": "T", "range": [0, 1], "value": null, "below": "unrealizable"});
    assert_eq!(run.json()[0]["minimized"], expected);
}

#[test]
fn all_objectives_in_turn() {
    let (status, lines) = solve(&["rooms.hp", "--objective", "all", "--minimize", "T=0..3"]);
    let expected = "sp: realizable with T = 2, unrealizable with 0..1\n\
                    isr: realizable with T = 2, unrealizable with 0..1\n\
                    ar: unrealizable with T = 0..3\n\
                    iso: realizable with T = 2, unrealizable with 0..1\n\
                    cso: realizable with T = 3, unrealizable with 0..2\n";
    assert_eq!((status, lines.as_str()), (1, expected));
}

/// A line of `CELLS` cells with a goal where `T` says, which is no bound: more is not always better.
const LINE: &str = "
    const CELLS = 6; const T = 9;
    system Line {
      state x: 0..CELLS - 1; action go, wait;
      on go { x' = x + 1; }
      on wait {}
      init x == 0;
    }
    objective exactly { exists p. F[T,T] x[p] == 4 & G[0,T] x[p] <= T - 4 }
    objective late { exists p. F[1,T] x[p] == CELLS - 2 }
    objective never { forall p. G[0,T] x[p] != 3 }
    objective small within T { exists p. forall q. x[p] == 0 & G x[q] <= 2 & F x[q] >= 0 }
";

#[test]
fn a_constant_may_stand_anywhere() {
    let file = file(LINE);
    let name = text(file.path());
    for (objective, constant, line) in [
        // T = 0 is not asked: [1,0] is empty. Only from T = 8 on may x be 4.
        ("exactly", "T", "realizable with T = 8, unrealizable with 1..7"),
        ("late", "T", "realizable with T = 4, unrealizable with 1..3"),
        // A line of one cell has no room for x == -1; with two cells the start will do.
        ("late", "CELLS", "realizable with CELLS = 2, unrealizable with 1"),
        ("never", "T", "realizable with T = 1, the first of the range"),
        ("never", "CELLS=1..5", "realizable with CELLS = 1, the first of the range"),
        ("never", "T=3..9", "unrealizable with T = 3..9"),
        ("small", "T=1..9", "realizable with T = 1, the first of the range"),
        ("small", "T=3..9", "unrealizable with T = 3..9"),
    ] {
        let (_, lines) = solve(&[name, "--objective", objective, "--minimize", constant]);
        assert_eq!(lines, format!("{objective}: {line}\n"), "{constant}");
    }
}

#[test]
fn an_unrealizable_property_shows_the_counterexample_of_the_last_value() {
    let file = file(LINE);
    let options = ["--objective", "never", "--minimize", "T=3..5", "--format", "json"];
    let run = hyperplan(&[&["solve", text(file.path())], &options[..]].concat());
    let answer = &run.json()[0];
    assert_eq!((run.status, &answer["verdict"]), (1, &"unrealizable".into()), "{}", run.stderr);
    assert_eq!(answer["witness"][0]["actions"].as_array().map(Vec::len), Some(5));
    assert_eq!(answer["horizon"], serde_json::json!({"p": 5}));
}

#[test]
fn constants_that_cannot_be_minimized() {
    let missing = refused(&["rooms.hp", "--objective", "sp", "--minimize", "N"]);
    assert_eq!(missing, "error: rooms.hp has no constant `N` to minimize; it has T\n");
    let systems = "system W { state x: 0..1; on step {} } objective o { exists p. F[0,1] x[p] == 1 }";
    for (text_of_file, message) in [
        (systems.to_owned(), "has no constant `T` to minimize"),
        (format!("const T = 3; {systems}"), "never uses the constant `T`"),
        (format!("const T = 1 / 2; const D = 2 * T; {systems}"), "gives `T` a fraction; only integers"),
        (
            format!("const T = -3; const D = T; {systems}"),
            "has T = -3, so the range must be said: --minimize T=LO..HI",
        ),
    ] {
        let file = file(&text_of_file);
        let found = refused(&[text(file.path()), "--minimize", "T"]);
        assert!(found.contains(message), "{found}");
    }
}

#[test]
fn a_value_for_which_the_file_has_errors_is_named() {
    let file = file(
        "const T = 3; system W { state x: 0..1; on step {} }
        objective o { exists p. F[0,3 - T] x[p] == 2 }",
    );
    let found = refused(&[text(file.path()), "--minimize", "T=0..5"]);
    assert!(found.contains("has errors for T = 4\n"), "{found}");
    assert!(found.contains("the bound is negative: -1"), "{found}");
    // The first value is that of the messages about the file.
    let found = refused(&[text(file.path()), "--minimize", "T=4..5"]);
    assert!(found.contains("the bound is negative: -1") && !found.contains("has errors for"), "{found}");
}

#[test]
fn ranges_that_are_none() {
    for (range, message) in [
        ("T=5..3", "the range 5..3 is empty"),
        ("T=5", "expected a range of integers after `T=`, such as T=4..20"),
        ("T=a..b", "expected a range of integers"),
        ("T=0..9223372036854775807", "expected a range of integers"),
        ("=1..2", "expected CONST or CONST=LO..HI"),
    ] {
        let found = refused(&["rooms.hp", "--objective", "sp", "--minimize", range]);
        assert!(found.contains(message), "{found}");
    }
}

#[test]
fn no_minimum_is_claimed_when_time_runs_out() {
    let name = "case-studies/ar-60.hp";
    let run = hyperplan(&["solve", name, "--minimize", "T=95..120", "--timeout", "0.03", "--format", "json"]);
    assert_eq!(run.status, 3, "{}", run.stderr);
    let answer = &run.json()[0];
    assert_eq!(answer["reason"], "timeout");
    // What was found by then is told.
    let minimized = &answer["minimized"];
    let claimed = !minimized["value"].is_null() && minimized["below"] != "unknown";
    assert!(answer["verdict"] != "unrealizable" && !claimed, "{}", run.stdout);
}

#[test]
fn what_more_time_hurts_is_not_skipped() {
    let system =
        "const T = 20; system W { state x: 0..40; on step { x' = x + 1; } init x == 0; absorb x == 40; }";
    // The path is at 3 at time 3 and nowhere else, so only T = 3 will do.
    for part in ["G[0,T] x[p] <= 3", "(x[p] > 50) R[0,T] x[p] <= 3", "!F[0,T] x[p] > 3", "F[T,T] x[p] == 3"] {
        let file = file(&format!("{system} objective o {{ exists p. F[0,T] x[p] == 3 & {part} }}"));
        let found = solve(&[text(file.path()), "--minimize", "T"]);
        assert_eq!(found, (0, "o: realizable with T = 3, unrealizable with 0..2\n".to_owned()), "{part}");
    }
}

#[test]
fn values_with_which_the_file_has_errors_are_left_out() {
    let problem = |interval: &str| {
        file(&format!(
            "const T = 5; system S {{ state x: 0..9; action up; on up {{ x' = x + 1; }} absorb x == 9; init x == 0; }} \
             objective o {{ exists p. F{interval} x[p] == 3 }}"
        ))
    };
    for (interval, left_out) in [("[1,T]", "T = 0 is"), ("[2,T]", "T = 0..1 is"), ("[0,T]", "")] {
        let problem = problem(interval);
        let run = hyperplan(&["solve", text(problem.path()), "--minimize", "T=0..9"]);
        assert_eq!(run.status, 0, "{run:?}");
        assert!(run.stdout.starts_with("o: realizable with T = 3, unrealizable with "), "{run:?}");
        assert!(run.stderr.contains(left_out), "{run:?}");
        assert_eq!(run.stderr.is_empty(), left_out.is_empty(), "{run:?}");
    }
    // There is none: the message says for which value it is.
    let problem = problem("[9,T]");
    let message = refused(&[text(problem.path()), "--minimize", "T=0..4"]);
    assert!(message.starts_with("note: with T = 0:\n") && message.contains("[9,0] is empty"), "{message}");
}
