//! `hyperplan solve`: verdicts, formats, exit statuses, files.

mod common;

use common::{command, hyperplan, hyperplan_with, solver_is_there, text};
use std::io::{BufRead, BufReader};
use std::process::Stdio;

#[test]
fn prints_a_verified_strategy() {
    let run = hyperplan(&["solve", "rooms.hp", "--objective", "sp"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stdout.starts_with("sp: realizable\nhorizon: p 6, q 5\n"), "{}", run.stdout);
    assert!(run.stdout.contains(", absorbed after 2 steps\n"), "{}", run.stdout);
    assert!(run.stdout.contains("\nverified by search\n"), "{}", run.stdout);
}

#[test]
fn prints_the_promised_json() {
    let run = hyperplan(&["solve", "rooms.hp", "--objective", "sp", "--format", "json"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    // The order of the fields is part of the promise.
    let fields =
        ["file", "objective", "verdict", "reason", "horizon", "witness", "verified", "solver", "quantifiers"];
    let places: Vec<Option<usize>> = fields.iter().map(|f| run.stdout.find(&format!("\"{f}\":"))).collect();
    assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{}", run.stdout);
    let [answer] = &run.json()[..] else { panic!("one objective, one line") };
    assert_eq!(answer["file"], "rooms.hp");
    assert_eq!(answer["objective"], "sp");
    assert_eq!(answer["verdict"], "realizable");
    assert_eq!(answer["reason"], serde_json::Value::Null);
    assert_eq!(answer["horizon"], serde_json::json!({"p": 6, "q": 5}));
    assert_eq!(answer["verified"], "by-search");
    assert_eq!(answer["solver"]["name"], "builtin");
    let [path] = answer["witness"].as_array().expect("a witness").as_slice() else { panic!("one path") };
    assert_eq!((&path["path"], &path["system"]), (&"p".into(), &"Rooms".into()));
    assert_eq!(path["actions"].as_array().map(Vec::len), Some(6));
    assert_eq!(path["states"].as_array().map(Vec::len), Some(7));
    assert_eq!(path["states"][0], serde_json::json!({"x": 0, "y": 0}));
    for stage in ["read", "encode", "solve", "verify", "total"] {
        assert!(answer["seconds"][stage].is_number(), "{stage}");
    }
    let size = |answer: &serde_json::Value| ["variables", "clauses"].map(|k| answer["size"][k].as_u64());
    let [Some(variables), Some(clauses)] = size(answer) else { panic!("the query has a size") };
    assert!(variables > 10 && clauses > variables / 2, "{variables} variables, {clauses} clauses");
    let run = hyperplan(&["solve", "rooms.hp", "--objective", "sp", "-v"]);
    let words = format!("largest query: {variables} variables, {clauses} clauses\n");
    assert!(run.stdout.ends_with(&words), "{}", run.stdout);
    // What was found without a query has a query of no size.
    let run = hyperplan(&["solve", "rooms.hp", "--objective", "ar", "--format", "json"]);
    let [answer] = &run.json()[..] else { panic!("one objective, one line") };
    assert_eq!((&answer["quantifiers"], size(answer)), (&"explicit".into(), [Some(0), Some(0)]));
}

#[test]
fn says_no_with_status_1() {
    let run = hyperplan(&["solve", "rooms.hp", "--objective", "sp", "--set", "T=1"]);
    assert_eq!((run.status, run.stderr.as_str()), (1, ""));
    assert!(run.stdout.starts_with("sp: unrealizable\n"), "{}", run.stdout);
}

#[test]
fn several_objectives_need_a_choice() {
    let run = hyperplan(&["solve", "rooms.hp"]);
    assert_eq!((run.status, run.stdout.as_str()), (2, ""));
    assert!(
        run.stderr.contains("choose one of sp, isr, ar, iso, cso with --objective NAME"),
        "{}",
        run.stderr
    );
    let run = hyperplan(&["solve", "rooms.hp", "--objective", "spp"]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("no objective `spp`"), "{}", run.stderr);
}

#[test]
fn an_objective_may_be_called_all() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("named.hp");
    let system = "system S { state x: 0..3; action go; init x == 0; on go when x < 3 { x' = x + 1; } on go when x == 3 {} }";
    let objectives =
        "objective all { exists p. F[0,3] x[p] == 3 } objective other { exists p. F[0,1] x[p] == 3 }";
    std::fs::write(&file, format!("{system}\n{objectives}")).expect("writable");
    let run = hyperplan(&["solve", text(&file), "--objective", "all", "--format", "json"]);
    let names: Vec<_> = run.json().iter().map(|answer| answer["objective"].clone()).collect();
    assert_eq!((run.status, names), (0, vec!["all".into()]), "{}", run.stderr);
    let out = folder.path().join("out");
    let run = hyperplan(&["compare", text(&file), "--solver", "builtin", "--out", text(&out)]);
    assert_eq!(run.status, 0, "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.contains("#all") && run.stdout.contains("#other"), "{}", run.stdout);
    assert!(!run.stdout.contains("error "), "{}", run.stdout);
}

#[test]
fn all_objectives_in_turn_and_the_largest_status() {
    let run = hyperplan(&["solve", "rooms.hp", "--objective", "all", "--format", "json", "--set", "T=3"]);
    let verdicts: Vec<_> =
        run.json().iter().map(|a| (a["objective"].clone(), a["verdict"].clone())).collect();
    let expected = [
        ("sp", "realizable"),
        ("isr", "realizable"),
        ("ar", "unrealizable"),
        ("iso", "realizable"),
        ("cso", "realizable"),
    ];
    assert_eq!(verdicts, expected.map(|(o, v)| (o.into(), v.into())));
    assert_eq!(run.status, 1);
}

#[test]
fn the_trap_of_a_longer_horizon() {
    let run = hyperplan(&["solve", "case-studies/sp-10.hp", "--set", "T=30", "--format", "json"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let answer = &run.json()[0];
    let states = answer["witness"][0]["states"].as_array().expect("states");
    let goal = serde_json::json!({"x": 7, "y": 5});
    assert_eq!(states.iter().position(|s| *s == goal), Some(16));
}

#[test]
fn every_quantifier_mode_and_representation() {
    for (objective, quantifiers) in [("isr", "auto"), ("isr", "cegis"), ("iso", "expand")] {
        for states in ["auto", "onehot", "bitvec", "enum"] {
            let options = ["--objective", objective, "--quantifiers", quantifiers, "--states", states];
            let run = hyperplan(&[&["solve", "rooms.hp", "--quiet"], &options[..]].concat());
            let expected = format!("{objective}: realizable\n");
            assert_eq!((run.stdout, run.status), (expected, 0), "{options:?} {}", run.stderr);
        }
    }
}

#[test]
fn what_is_not_supported_is_bad_usage() {
    let unbounded = ["pass/reals.hp", "--objective", "brake"];
    let numbers = ["rooms.hp", "--objective", "sp", "--states", "int"];
    let reals = ["rooms.hp", "--objective", "sp", "--states", "real"];
    let unbounded_reals = ["pass/unbounded-integers.hp", "--objective", "detour", "--states", "real"];
    let bits = ["pass/reals.hp", "--objective", "brake", "--states", "bitvec"];
    for (arguments, message) in [
        (&unbounded[..], "such as --solver z3, cvc5 or yices"),
        (&numbers, "such as --solver z3, cvc5 or yices"),
        (&reals, "--states real takes a solver for integers and reals"),
        (&unbounded_reals, "which reals cannot express; use --states int"),
        (&bits, "takes --states int"),
    ] {
        let run = hyperplan(&[&["solve"], arguments].concat());
        assert_eq!((run.status, run.stdout.as_str()), (2, ""));
        assert!(run.stderr.contains(message), "{}", run.stderr);
    }
}

#[test]
fn saves_and_draws() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (saved, drawn) = (folder.path().join("answer.json"), folder.path().join("map.svg"));
    let files = ["--save", text(&saved), "--plot", text(&drawn)];
    let run = hyperplan(&[&["solve", "case-studies/iso-10.hp"], &files[..]].concat());
    assert_eq!(run.status, 0, "{}", run.stderr);
    let saved = std::fs::read_to_string(saved).expect("saved");
    let answer: serde_json::Value = serde_json::from_str(&saved).expect("one JSON object");
    assert_eq!(answer["witness"].as_array().map(Vec::len), Some(2));
    let drawn = std::fs::read_to_string(drawn).expect("drawn");
    assert!(drawn.starts_with("<svg") && drawn.matches("class=\"path\"").count() == 2, "{drawn}");
}

#[test]
fn files_that_cannot_be_written_are_refused_before_the_work() {
    for option in ["--save", "--plot"] {
        let run = hyperplan(&["solve", "case-studies/ar-60.hp", option, "no/such/folder/file.svg"]);
        assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{option}");
        assert!(run.stderr.contains("there is no directory no/such/folder"), "{}", run.stderr);
    }
    let run = hyperplan(&["solve", "rooms.hp", "--objective", "sp", "--plot", "map.jpg"]);
    assert_eq!(run.status, 2);
    assert!(
        run.stderr.contains("only .svg, .png, .pdf, .gif, .html and .txt are supported"),
        "{}",
        run.stderr
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
    let output = command(&["solve", "rooms.hp", "--objective", "sp"]).stdout(full).output().expect("runs");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot write standard output"));
}

#[test]
fn a_closed_pipe_ends_quietly() {
    let mut child = command(&["solve", "rooms.hp", "--objective", "all"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("runs");
    let mut first = String::new();
    let pipe = child.stdout.take().expect("piped");
    BufReader::new(pipe).read_line(&mut first).expect("readable");
    assert_eq!(first, "sp: realizable\n");
    let output = child.wait_with_output().expect("ends");
    assert_eq!((output.status.code(), String::from_utf8_lossy(&output.stderr).as_ref()), (Some(0), ""));
}

#[test]
fn time_runs_out() {
    let slow = ["solve", "case-studies/ar-60.hp", "--quantifiers", "cegis", "--timeout", "0.02"];
    let run = hyperplan(&[&slow[..], &["--format", "json"]].concat());
    assert_eq!(run.status, 3, "{}", run.stderr);
    assert_eq!(run.json()[0]["verdict"], "unknown");
    let run = hyperplan(&["solve", "rooms.hp", "--timeout", "-1"]);
    assert_eq!(run.status, 2);
}

#[test]
fn memory_runs_out() {
    let arguments = ["case-studies/iso-60.hp", "--quantifiers", "expand", "--memory", "1"];
    let run = hyperplan(&[&["solve", "--format", "json"][..], &arguments[..]].concat());
    assert_eq!(run.status, 3, "{}", run.stderr);
    assert_eq!(run.json()[0]["reason"], "memory limit of 1 MiB reached");
}

#[test]
fn the_same_seed_gives_the_same_answer() {
    for objective in ["sp", "isr", "ar", "iso", "cso"] {
        for (quantifiers, seed) in [("auto", "0"), ("auto", "7"), ("cegis", "0"), ("cegis", "7")] {
            let file = format!("case-studies/{objective}-10.hp");
            let answer = |timeout: &str| {
                let run = hyperplan(&[
                    "solve",
                    &file,
                    "--format",
                    "json",
                    "--quantifiers",
                    quantifiers,
                    "--seed",
                    seed,
                    "--timeout",
                    timeout,
                ]);
                let mut answer = run.json().remove(0);
                answer.as_object_mut().expect("an object").remove("seconds").expect("the time it took");
                answer
            };
            let first = answer("600");
            assert_eq!(first["verdict"], "realizable", "{file}");
            assert_eq!(first, answer("1200"), "{file}, {quantifiers}, seed {seed}");
        }
    }
}

#[test]
fn a_missing_solver_is_named() {
    let run = hyperplan(&["solve", "rooms.hp", "--objective", "sp", "--solver", "/no/such/solver"]);
    assert_eq!((run.status, run.stdout.as_str()), (4, ""), "{}", run.stderr);
    assert!(run.stderr.contains("/no/such/solver"), "{}", run.stderr);
}

#[test]
fn keeps_queries() {
    for solver in ["builtin", "z3"] {
        if solver != "builtin" && !solver_is_there(solver) {
            continue;
        }
        let folder = tempfile::tempdir().expect("a temporary folder");
        let queries = folder.path().join("queries");
        let options = ["--objective", "sp", "--solver", solver, "--queries", text(&queries)];
        let run = hyperplan(&[&["solve", "rooms.hp"], &options[..]].concat());
        assert_eq!(run.status, 0, "{}", run.stderr);
        let first = std::fs::read_to_string(queries.join(format!("0001-{solver}.smt2"))).expect("kept");
        assert!(first.contains("(check-sat)") && first.ends_with("(exit)\n"), "{first}");
    }
}

#[test]
fn external_solvers_agree() {
    for solver in ["z3", "cvc5", "yices"] {
        if !solver_is_there(solver) {
            continue;
        }
        for (horizon, verdict, status) in [("T=2", "realizable", 0), ("T=1", "unrealizable", 1)] {
            let options = ["--objective", "sp", "--solver", solver, "--quiet", "--set", horizon];
            let run = hyperplan(&[&["solve", "rooms.hp"], &options[..]].concat());
            assert_eq!(
                (run.stdout, run.status),
                (format!("sp: {verdict}\n"), status),
                "{solver}: {}",
                run.stderr
            );
        }
    }
}

/// Plans that were proved for all outcomes of their actions rely on none.
#[test]
fn outcomes_are_mentioned_where_they_matter() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("lift.hp");
    let system = "system Lift { state at: 0..3; action up, slip; on up { at' = at + 1; } \
                  on slip { at' in {at, at + 1}; } init at == 0; absorb at == 3; }";
    let sure = "F[0,6] at[p] == 3 & (G[0,6] action[p] == action[q] -> F[0,6] at[q] == 3)";
    for (objective, relies) in [
        (format!("exists p. forall q. {sure}"), false),
        (format!("exists p. forall q. X action[p] == slip & {sure}"), false),
        (format!("exists p. forall q. X (action[p] == slip & at[p] == 1) & {sure}"), true),
        ("exists p. F[0,3] at[p] == 3 & G[1,3] action[p] == slip".to_owned(), true),
        // Where the outcome is another one, the action that follows is not possible.
        ("exists p. X action[p] == slip & X X (action[p] == up & at[p] >= 1)".to_owned(), false),
    ] {
        std::fs::write(&file, format!("{system}\nobjective o {{ {objective} }}\n")).expect("writable");
        let run = hyperplan(&["solve", text(&file)]);
        assert_eq!(run.status, 0, "{objective}: {run:?}");
        assert_eq!(run.stderr.contains("p relies on outcomes"), relies, "{objective}: {run:?}");
    }
}

#[test]
fn detours_are_left_out_unless_the_first_plan_is_wanted() {
    let text = "system Room = grid { \"....\" \"S...\" } { edge stay; moves up, down, left, right, stay; } \
                objective pair within 12 { exists p. exists q. start[p] & start[q] & F x[p] == 3 & F x[q] == 3 \
                & G (state[p] != state[q] | start[p]) }";
    let moved = |more: &[&str]| -> usize {
        let run = hyperplan_with(&[&["solve", "-", "--format", "json"], more].concat(), text);
        assert_eq!(run.status, 0, "{}", run.stderr);
        let answer = run.json().remove(0);
        assert_eq!(answer["verified"], "by-search");
        let paths = answer["witness"].as_array().expect("two paths").clone();
        let until = |path: &serde_json::Value| {
            let states = path["states"].as_array().expect("states").clone();
            states.iter().position(|state| state["x"] == 3).expect("it gets there")
        };
        paths.iter().map(until).sum()
    };
    let (first, printed) = (moved(&["--first"]), moved(&[]));
    assert!(printed <= first, "{printed} steps instead of {first}");
    // One goes straight, the other around it.
    assert!(printed >= 7, "{printed} steps are too few");
}
