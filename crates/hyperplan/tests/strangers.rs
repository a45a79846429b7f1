//! Names and words of others do nothing but be read, whichever command shows them.
#![cfg(unix)]

mod common;

use common::fakes::Fake;
use common::{Run, command, hyperplan, specs, text};
use hyperplan_outlet::is_harmless;
use std::fs;
use std::path::Path;

/// It colors, begins a line, goes back, deletes, and turns the direction around.
const NASTY: &str =
    "a\u{1b}[31m\nFORGED\r\t\u{8}\u{7f}\u{85}\u{9b}2J\u{202e}\u{2066}\u{200f}\u{61c}\u{2028}z";
/// As much of it as names in problems may have.
const TURNED: &str = "a\u{202e}\u{2066}\u{200f}\u{61c}\u{2028}\u{2029}z";

/// Fails where something reached the terminal.
fn is_quiet(what: &str, run: &Run) {
    for output in [&run.stdout, &run.stderr] {
        let bad = output.chars().find(|c| !(is_harmless(*c) || *c == '\n'));
        assert!(bad.is_none(), "{what}: U+{:04X} in {output:?}", bad.map_or(0, u32::from));
        assert!(!output.lines().any(|line| line.starts_with("FORGED")), "{what}: {output:?}");
    }
}

/// Runs it, with the status that is due.
fn quiet(status: i32, arguments: &[&str]) -> Run {
    let run = hyperplan(arguments);
    assert_eq!(run.status, status, "{arguments:?}: {}", run.stderr);
    is_quiet(&format!("{arguments:?}"), &run);
    run
}

#[test]
fn names_of_files() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let nasty = |end: &str| folder.path().join(format!("{NASTY}{end}"));
    let (good, bad, map) = (nasty(".hp"), nasty("bad.hp"), nasty("map.hp"));
    fs::copy(specs().join("rooms.hp"), &good).expect("ours");
    fs::write(&bad, "system W { state x: 0..; }").expect("ours");
    fs::write(&map, format!("system W = grid(\"{TURNED}.map\") {{ }}")).expect("ours");
    let (strategy, folder_name) = (nasty(".json"), nasty("d"));
    let sp = ["--objective", "sp"];
    let with = |arguments: &[&str]| quiet(0, &[arguments, &sp].concat());
    let solved = with(&["solve", text(&good), "--save", text(&strategy), "--format", "json"]);
    assert_eq!(solved.json()[0]["file"], text(&good));
    with(&["solve", text(&good), "-v"]);
    with(&["emit", text(&good)]);
    with(&["emit", text(&good), "-o", text(&nasty(".smt2"))]);
    with(&["verify", text(&good), text(&strategy)]);
    with(&["verify", text(&good), text(&strategy), "--format", "json"]);
    with(&["plot", text(&good), text(&strategy)]);
    with(&["horizon", text(&good), "--format", "json"]);
    quiet(0, &["check", text(&good), "--format", "json"]);
    quiet(0, &["check", text(&good)]);
    quiet(0, &["new", text(&nasty("new.hp"))]);
    quiet(2, &["new", text(&nasty("new.hp"))]);
    quiet(2, &["solve", text(&good)]);
    for file in [&bad, &map, &nasty("none.hp"), &strategy] {
        for command in ["solve", "check", "horizon", "emit", "plot"] {
            let color = ["--color", if command == "check" { "never" } else { "auto" }];
            quiet(2, &[&[command, text(file)][..], &color].concat());
        }
    }
    quiet(2, &["check", text(&map), "--format", "json"]);
    quiet(2, &["verify", text(&good), text(&bad)]);
    quiet(2, &["verify", text(&good), "--model", text(&bad), "--objective", "sp"]);
    quiet(2, &["solve", text(&good), "--objective", "sp", "--plot", text(&folder_name)]);
    quiet(2, &["solve", text(&good), "--objective", "sp", "--save", text(&folder_name.join("x"))]);
    quiet(2, &["solve", text(&good), "--objective", "sp", "--queries", text(&good)]);
    quiet(2, &["man", "--output", text(&good)]);
    quiet(2, &["compare", text(&bad), "--out", text(&folder_name)]);
    quiet(2, &["compare", text(&nasty("*?")), "--out", text(&folder_name)]);
    quiet(2, &["compare", "--out", text(&folder_name)]);
    quiet(2, &["emit", "--family", text(folder.path())]);
    let compared = ["compare", text(&good), "--objective", "sp", "--solver", "builtin", "--out"];
    quiet(0, &[&compared[..], &[text(&folder_name)]].concat());
    quiet(0, &[&compared[..], &[text(&folder_name)]].concat());
}

#[test]
fn words_on_the_command_line() {
    for arguments in [
        &[NASTY][..],
        &["solve", "rooms.hp", NASTY],
        &["solve", "rooms.hp", &format!("--{NASTY}")],
        &["solve", "rooms.hp", "--states", NASTY],
        &["solve", "rooms.hp", "--objective", NASTY],
        &["solve", "rooms.hp", "--set", &format!("{NASTY}=3")],
        &["solve", "rooms.hp", "--set", &format!("T={NASTY}")],
        &["solve", "rooms.hp", "--minimize", NASTY],
        &["solve", "rooms.hp", "--minimize", &format!("T=1..{NASTY}")],
        &["emit", "rooms.hp", "--date", NASTY],
        &["emit", "rooms.hp", "--author", NASTY],
        &["templates", NASTY],
        &["man", NASTY],
        &["verify", "rooms.hp", "--objective", "sp", "--actions", &format!("p={NASTY}")],
        &["verify", "rooms.hp", "--objective", "sp", "--actions", &format!("{NASTY}=up")],
        &["compare", "rooms.hp", "--objective", NASTY],
        &["compare", NASTY],
    ] {
        quiet(2, arguments);
    }
    quiet(4, &["solve", "rooms.hp", "--objective", "sp", "--quantifiers", "expand", "--solver", NASTY]);
}

/// A graph may call its states and actions anything that is text.
const GRAPH: &str = r#"{"states": ["A", "B"], "actions": ["NAME", "stay"], "initial": ["A"],
    "transitions": [["A", "NAME", "B"], ["B", "stay", "B"]], "labels": {"start": ["A"], "goal": ["B"]}}"#;

#[test]
fn names_in_problems() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let graph = GRAPH.replace("\"A\"", "\"NAME1\"").replace("\"B\"", "\"NAME2\"").replace("NAME", TURNED);
    fs::write(folder.path().join("graph.json"), graph).expect("ours");
    let (file, strategy) = (folder.path().join("p.hp"), folder.path().join("s.json"));
    let problem = format!(
        "system M = graph(\"graph.json\") {{ }}\nsystem W = grid {{ \"S.G\" }} {{ }}\n\
         objective o {{ exists p: M, q: W. start[p] & F[0,2] goal[p] & start[q] & F[0,2] goal[q] }}\n\
         objective no {{ forall p: M. X (action[p] != \"{TURNED}\" & node[p] != \"{TURNED}2\") }}\n"
    );
    fs::write(&file, problem).expect("ours");
    let file = text(&file);
    let table = quiet(0, &["solve", file, "--objective", "o", "--save", text(&strategy)]);
    assert!(table.stdout.contains(r"a\u{202e}\u{2066}\u{200f}\u{61c}\u{2028}\u{2029}z2"), "{}", table.stdout);
    quiet(0, &["solve", file, "--objective", "o", "--format", "json"]);
    quiet(1, &["solve", file, "--objective", "no", "-v"]);
    quiet(0, &["horizon", file]);
    quiet(0, &["check", file]);
    quiet(0, &["check", file, "--format", "json"]);
    quiet(0, &["verify", file, text(&strategy)]);
    for states in ["onehot", "enum", "bitvec"] {
        quiet(0, &["emit", file, "--objective", "no", "--states", states, "--quantifiers", "expand"]);
    }
    quiet(0, &["plot", file, text(&strategy)]);
    let picture = folder.path().join("p.svg");
    quiet(0, &["plot", file, text(&strategy), "-o", text(&picture)]);
    let drawn = fs::read_to_string(picture).expect("it was drawn");
    assert!(drawn.contains(r"\u{202e}") && drawn.chars().all(|c| is_harmless(c) || c == '\n'), "{drawn}");
    // What is saved has the names as they are.
    let saved = fs::read_to_string(&strategy).expect("it was saved");
    assert!(saved.chars().all(|c| is_harmless(c) || c == '\n'), "{saved}");
    let saved: serde_json::Value = serde_json::from_str(&saved).expect("it is JSON");
    assert_eq!(saved["witness"][0]["actions"][0], TURNED);
}

#[test]
fn names_in_strategies() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let strategy = folder.path().join("s.json");
    let solved = hyperplan(&["solve", "rooms.hp", "--objective", "sp", "--format", "json"]);
    let good = &solved.json()[0];
    for place in [
        "/objective",
        "/witness/0/path",
        "/witness/0/system",
        "/witness/0/actions/0",
        "/witness/0/states/0/x",
    ] {
        let mut bad = good.clone();
        *bad.pointer_mut(place).expect("it is there") = NASTY.into();
        fs::write(&strategy, bad.to_string()).expect("ours");
        for command in ["verify", "plot"] {
            let run = hyperplan(&[command, "rooms.hp", text(&strategy), "--objective", "sp"]);
            is_quiet(&format!("{command} {place}"), &run);
            assert!(run.status == 2 || place == "/objective", "{command} {place}: {}", run.stderr);
        }
        quiet(2, &["verify", "rooms.hp", text(&strategy)]);
    }
    fs::write(&strategy, format!("{{\"{NASTY}\": ")).expect("ours");
    quiet(2, &["verify", "rooms.hp", text(&strategy)]);
}

/// Whatever a solver says, wherever it says it.
#[test]
fn words_of_solvers() {
    let echo = |reply: &str| format!("echo '{}'; ", NASTY.replace('\n', "'; echo '").replace('a', reply));
    let user = tempfile::tempdir().expect("a temporary folder");
    fs::create_dir(user.path().join("hyperplan")).expect("ours");
    for body in [
        format!("{}exit 3", echo("")),
        format!("{{ {}}} >&2; exit 3", echo("")),
        format!("[ \"$1\" = --version ] && {{ {}exit; }}; exit 3", echo("version 1.2.3")),
        format!(
            "while read -r line; do case $line in *check-sat*) {};; esac; done",
            echo("(error \"") + "echo '\")'"
        ),
        format!(
            "while read -r line; do case $line in *check-sat*) echo unknown;; *reason*) {};; esac; done",
            echo("(:reason-unknown \"") + "echo '\")'"
        ),
    ] {
        let fake = Fake::new(&body);
        let entry = format!("[[solver]]\nname = \"fake\"\nprogram = \"{}\"\n", fake.program().display());
        fs::write(user.path().join("hyperplan/hyperplan.toml"), entry).expect("ours");
        let out = user.path().join("out");
        for line in [
            "solvers",
            "solvers --format json",
            "solve rooms.hp --objective sp --solver fake",
            "solve rooms.hp --objective sp --solver fake --format json",
            "solve rooms.hp --objective sp --solver fake,builtin",
            "solve rooms.hp --objective sp --cross-check fake --set T=1",
            "compare rooms.hp --objective sp --solver fake -v --out",
        ] {
            let to = line.ends_with("--out").then_some(text(&out));
            let arguments: Vec<&str> = line.split(' ').chain(to).collect();
            let mut command = command(&arguments);
            command.env("XDG_CONFIG_HOME", user.path());
            let run = Run::new(command.output().expect("the command was built for this test"));
            is_quiet(&format!("{arguments:?} with {body:?}"), &run);
        }
        fs::remove_dir_all(&out).expect("ours");
    }
}

/// Names have no longest length: whatever shows them in columns has room.
#[test]
fn long_names() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (file, strategy) = (folder.path().join("p.hp"), folder.path().join("s.json"));
    let name = format!("n{}", "x".repeat(66_000));
    let problem = format!(
        "system {name} {{ state {name}_v: {{{name}_a, {name}_b}}; action {name}_go; label {name}_l = {name}_v == {name}_b;\n\
         on {name}_go {{ {name}_v' = {name}_b; }} }}\n\
         objective {name}_o {{ exists {name}_p. F[0,2] {name}_l[{name}_p] }}\n"
    );
    fs::write(&file, problem).expect("ours");
    let out = folder.path().join("out");
    for arguments in [
        &["solve", text(&file), "--save", text(&strategy)][..],
        &["verify", text(&file), text(&strategy)],
        &["horizon", text(&file)],
        &["check", text(&file)],
        &["emit", text(&file)],
        &["compare", text(&file), "--solver", "builtin", "--out", text(&out)],
    ] {
        quiet(0, arguments);
    }
    quiet(0, &["plot", text(&file), text(&strategy)]);
    for picture in ["p.svg", "p.png", "p.gif", "p.html"] {
        quiet(0, &["plot", text(&file), text(&strategy), "-o", text(&folder.path().join(picture))]);
    }
    quiet(2, &["solve", text(&file), "--objective", &name]);
}

/// A board may be wider than the widths of `format!`.
#[test]
fn wide_boards() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("p.hp");
    fs::write(&file, "system W { state x: 0..70000, y: 0..1; }").expect("ours");
    let drawn = quiet(0, &["plot", text(&file)]);
    assert!(drawn.stdout.contains(" 69990"), "the axis has no end");
}

/// A map may have any sign for what it shows.
#[test]
fn letters_of_maps() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (file, picture) = (folder.path().join("p.hp"), folder.path().join("p.svg"));
    for letter in TURNED.chars() {
        let map = format!("system W = grid {{ \"S{letter}G\" }} {{ legend '{letter}' = wet; }}");
        fs::write(&file, map + "\nobjective o { exists p. start[p] & F[0,2] goal[p] }").expect("ours");
        for arguments in [
            &["plot", text(&file)][..],
            &["solve", text(&file), "--plot", text(&picture)],
            &["emit", text(&file)],
            &["check", text(&file)],
        ] {
            quiet(0, arguments);
        }
        let drawn = fs::read_to_string(&picture).expect("it was drawn");
        assert!(drawn.chars().all(|c| is_harmless(c) || c == '\n'), "{drawn}");
    }
    fs::write(&file, format!("system W = grid {{ \"{TURNED}\" }} {{ }}")).expect("ours");
    quiet(2, &["check", text(&file)]);
}

/// The helper tells harm from none.
#[test]
#[should_panic(expected = "U+001B")]
fn harm_is_found() {
    let stdout = format!("{}\n", Path::new("a\u{1b}").display());
    is_quiet("this", &Run { status: 0, stdout, stderr: String::new() });
}
