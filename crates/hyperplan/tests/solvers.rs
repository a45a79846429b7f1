//! Solvers from configuration files, and races.
#![cfg(unix)]

mod common;

use common::fakes::Fake;
use common::{Run, command, specs, text};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const UNSAT: &str = "*check-sat*) echo unsat;;";

/// Runs the command in a folder, with a folder for the user's configuration.
fn run_in(folder: &Path, user: &Path, arguments: &[&str]) -> Run {
    let mut command = command(arguments);
    Run::new(
        command.current_dir(folder).env("XDG_CONFIG_HOME", user).output().expect("the command was built"),
    )
}

fn solve_in(folder: &Path, user: &Path, options: &[&str]) -> Run {
    let rooms = specs().join("rooms.hp");
    run_in(
        folder,
        user,
        &[&["solve", text(&rooms), "--objective", "sp", "--format", "json"], options].concat(),
    )
}

fn folders() -> (TempDir, TempDir) {
    (tempfile::tempdir().expect("a temporary folder"), tempfile::tempdir().expect("a temporary folder"))
}

/// Writes the project's configuration, which the user allows.
fn configure(project: &TempDir, user: &TempDir, text: &str) {
    fs::write(project.path().join("hyperplan.toml"), text).expect("ours");
    let run = run_in(project.path(), user.path(), &["solvers", "--trust"]);
    assert_eq!((run.status, run.stdout.as_str()), (0, ""), "{}", run.stderr);
}

fn entry(name: &str, fake: &Fake) -> String {
    format!("[[solver]]\nname = \"{name}\"\nprogram = \"{}\"\n", fake.program().display())
}

#[test]
fn a_solver_of_the_project_and_of_the_user() {
    let (project, user) = folders();
    let fake = Fake::replying(UNSAT);
    let inner = project.path().join("maps/small");
    fs::create_dir_all(&inner).expect("ours");
    fs::create_dir(user.path().join("hyperplan")).expect("ours");
    fs::write(user.path().join("hyperplan/hyperplan.toml"), entry("theirs", &fake)).expect("ours");
    configure(&project, &user, &entry("mine", &fake));
    for name in ["mine", "theirs"] {
        let run = solve_in(&inner, user.path(), &["--solver", name]);
        assert_eq!(run.status, 1, "{name}: {}", run.stderr);
        assert_eq!(run.json()[0]["solver"]["name"], name);
    }
    // The project has the last word.
    configure(&project, &user, "[[solver]]\nname = \"theirs\"\nprogram = \"/no/such\"\n");
    let run = solve_in(&inner, user.path(), &["--solver", "theirs"]);
    assert_eq!(run.status, 4, "{}", run.stderr);
    assert!(
        run.stderr.contains("solver theirs was not found (tried $HYPERPLAN_THEIRS, /no/such)"),
        "{}",
        run.stderr
    );
    assert!(run.stderr.contains("or set HYPERPLAN_THEIRS"), "{}", run.stderr);
    let list = run_in(&inner, user.path(), &["solvers", "--format", "json"]).json();
    let theirs = list.iter().find(|solver| solver["name"] == "theirs").expect("it is listed");
    assert!(
        theirs["path"].is_null()
            && theirs["origin"].as_str().is_some_and(|file| file.ends_with("hyperplan.toml"))
    );
}

#[test]
fn the_environment_says_where_a_solver_is() {
    let (project, user) = folders();
    let fake = Fake::replying(UNSAT);
    configure(&project, &user, "[[solver]]\nname = \"my-own.1\"\nprogram = \"/no\"\n");
    let rooms = specs().join("rooms.hp");
    let mut command = command(&["solve", text(&rooms), "--objective", "sp", "--solver", "my-own.1"]);
    command.current_dir(project.path()).env("XDG_CONFIG_HOME", user.path());
    let run = Run::new(command.env("HYPERPLAN_MY_OWN_1", fake.program()).output().expect("built"));
    assert_eq!(run.status, 1, "{}", run.stderr);
}

#[test]
fn bad_configuration_is_bad_input() {
    let (project, user) = folders();
    fs::write(project.path().join("hyperplan.toml"), "[[solver]]\nname = \"x\"\nquantifers = \"any\"\n")
        .expect("ours");
    let run = solve_in(project.path(), user.path(), &["--solver", "z3"]);
    assert_eq!((run.status, run.stdout.as_str()), (2, ""));
    let words = "hyperplan.toml:3: unknown field `quantifers`, expected one of `name`, `like`";
    assert!(run.stderr.contains(words), "{}", run.stderr);
    assert_eq!(run_in(project.path(), user.path(), &["solvers"]).status, 2);
    // The embedded solver has nothing to be configured.
    assert_eq!(solve_in(project.path(), user.path(), &[]).status, 0);
    assert_eq!(solve_in(project.path(), user.path(), &["--solver", "batsat"]).status, 0);
}

#[test]
fn back_ends_can_be_named() {
    let (project, user) = folders();
    for name in ["builtin", "cadical", "batsat"] {
        for quantifiers in ["auto", "cegis"] {
            let options = ["--solver", name, "--seed", "3", "--quantifiers", quantifiers];
            let run = solve_in(project.path(), user.path(), &options);
            if name == "cadical" && cfg!(not(feature = "cadical")) {
                assert_eq!((run.status, run.stdout.as_str()), (2, ""));
                let words = "this build has no cadical: it takes the cargo feature cadical";
                assert!(run.stderr.contains(words), "{}", run.stderr);
                continue;
            }
            assert_eq!(run.status, 0, "{}", run.stderr);
            let answer = &run.json()[0];
            assert_eq!((&answer["solver"]["name"], &answer["verified"]), (&name.into(), &"by-search".into()));
        }
    }
    let run = solve_in(project.path(), user.path(), &["--solver", "batsad"]);
    assert_eq!(run.status, 4, "{}", run.stderr);
    assert!(run.stderr.contains("did you mean batsat?"), "{}", run.stderr);
    let race = if cfg!(feature = "cadical") { "batsat,cadical" } else { "batsat,builtin" };
    assert_eq!(solve_in(project.path(), user.path(), &["--solver", race]).status, 0);
    let run = solve_in(project.path(), user.path(), &["--solver", "batsat", "--quantifiers", "keep"]);
    assert_eq!(run.status, 2, "{}", run.stderr);
}

#[test]
fn abilities_bound_what_is_asked() {
    let (project, user) = folders();
    let fake = Fake::replying(UNSAT);
    let limits = "theories = [\"bit-vectors\"]\nquantifiers = \"none\"\n";
    configure(&project, &user, &(entry("small", &fake) + limits));
    let refused = |options: &[&str]| {
        let run = solve_in(project.path(), user.path(), &[&["--solver", "small"], options].concat());
        assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{}", run.stderr);
        run.stderr
    };
    let message = refused(&["--states", "int"]);
    assert!(message.contains("the small solver has no integers: use one of z3, cvc5, yices"), "{message}");
    let message = refused(&["--quantifiers", "keep"]);
    assert!(message.contains("the small solver cannot handle quantifiers"), "{message}");
}

/// Who hands on a folder says what is run only if the user has allowed that, of that very file.
#[test]
fn strangers_name_no_programs() {
    let (project, user) = folders();
    let fake = Fake::replying(UNSAT);
    let file = project.path().join("hyperplan.toml");
    let inner = project.path().join("maps");
    fs::create_dir(&inner).expect("ours");
    let program = fake.program().display().to_string();
    let options = |name| ["--solver", name, "--quantifiers", "expand"];
    let solve = |name| solve_in(&inner, user.path(), &options(name));
    let run = |option: &str| run_in(&inner, user.path(), &["solvers", option]);
    for danger in [
        format!("name = \"z3\"\nprogram = \"{program}\""),
        "name = \"z3\"\narguments = [\"/etc/passwd\"]".to_owned(),
        "name = \"z3\"\none-shot = [\"-o\", \"x\", \"{file}\"]".to_owned(),
        "name = \"z3\"\nsetup = [\"(set-option :regular-output-channel \\\"x\\\")\"]".to_owned(),
        "name = \"z3\"\nlogic = \"ALL) (echo\"".to_owned(),
        "name = \"z3\"\nseed = \":x\"".to_owned(),
        "name = \"z3\"\nversion = [\"-x\"]".to_owned(),
    ] {
        fs::write(&file, format!("[[solver]]\n{danger}\n")).expect("ours");
        let found = run_in(&inner, user.path(), &["solvers", "--format", "json"]);
        let z3 = found.json().into_iter().find(|solver| solver["name"] == "z3").expect("it is known");
        assert!(z3["origin"].is_null(), "{danger}: {z3}");
        assert_eq!(found.stderr.lines().count(), 1, "{danger}: {}", found.stderr);
        for words in [text(&file), "is not used", "hyperplan solvers --trust"] {
            assert!(found.stderr.contains(words), "{danger}: {}", found.stderr);
        }
    }
    fs::write(&file, entry("mine", &fake)).expect("ours");
    assert_eq!((solve("mine").status, fake.begun()), (4, 0));
    assert_eq!(run("--trust").status, 0);
    assert_eq!(fake.begun(), 0, "to allow it is not to run it");
    assert_eq!(solve("mine").status, 1);
    // With a change it is another.
    fs::write(&file, entry("mine", &fake) + "\n").expect("ours");
    assert_eq!(solve("mine").status, 4);
    fs::write(&file, entry("mine", &fake)).expect("ours");
    assert_eq!(solve("mine").status, 1);
    for (option, words) in [("--no-trust", "no longer trusted"), ("--untrust", "is not trusted")] {
        let taken_back = run(option);
        assert!(taken_back.status == 0 && taken_back.stderr.contains(words), "{}", taken_back.stderr);
        assert_eq!(solve("mine").status, 4);
    }
    // The same in another folder is another, and nobody else has allowed anything.
    assert_eq!(run("--trust").status, 0);
    let other = tempfile::tempdir().expect("a temporary folder");
    fs::copy(&file, other.path().join("hyperplan.toml")).expect("ours");
    assert_eq!(solve_in(other.path(), user.path(), &options("mine")).status, 4);
    assert_eq!(solve_in(&inner, other.path(), &options("mine")).status, 4);
    assert_eq!(run_in(user.path(), user.path(), &["solvers", "--trust"]).status, 2);
}

#[test]
fn what_runs_nothing_needs_no_trust() {
    let (project, user) = folders();
    let harmless = "[[solver]]\nname = \"z3\"\naliases = [\"zed\"]\ntheories = []\nquantifiers = \"none\"\n\
                    incremental = true\nassumptions = \"push\"\ntells-version = true\ninstall = { see = \"here\" }\n";
    fs::write(project.path().join("hyperplan.toml"), harmless).expect("ours");
    let found = run_in(project.path(), user.path(), &["solvers", "--format", "json"]).json();
    let z3 = found.iter().find(|solver| solver["name"] == "z3").expect("it is known");
    assert!(z3["origin"].is_string(), "{z3}");
}

/// What is in the current folder is not run because `PATH` is empty, or leads there.
#[test]
fn the_current_folder_is_no_place_for_programs() {
    let (project, user) = folders();
    let (fake, shell) = (Fake::called("z3", "echo unsat"), Fake::called("sh", "exit 1"));
    for (fake, name) in [(&fake, "z3"), (&shell, "sh")] {
        fs::copy(fake.program(), project.path().join(name)).expect("ours");
    }
    let rooms = specs().join("rooms.hp");
    for path in ["", ":", ".", "./", ":/no/such:"] {
        for solver in ["z3", "z3 -in"] {
            let solve = ["solve", text(&rooms), "--objective", "sp", "--quantifiers", "expand"];
            let mut command = command(&[&solve[..], &["--solver", solver]].concat());
            command.current_dir(project.path()).env("XDG_CONFIG_HOME", user.path()).env("PATH", path);
            let run = Run::new(command.output().expect("built"));
            assert_eq!((run.status, fake.begun(), shell.begun()), (4, 0, 0), "{path:?}: {}", run.stderr);
            assert!(run.stderr.contains("solver z3 was not found"), "{path:?}: {}", run.stderr);
        }
    }
}

#[test]
fn a_solver_that_takes_files() {
    let (project, user) = folders();
    // It answers what it is told, and cannot be asked anything later.
    let body = "test -s \"$2\" && grep -q '^(check-sat)' \"$2\" || exit 1
case $2 in *.smt2) ;; *) exit 2;; esac
grep -q 'get-value' \"$2\" || exit 3
echo unsat; echo '(error \"no model\")'; exit 1";
    let fake = Fake::new(body);
    let lines = "incremental = false\none-shot = [\"-f\", \"{file}\"]\n";
    configure(&project, &user, &(entry("batch", &fake) + lines));
    let run = solve_in(project.path(), user.path(), &["--solver", "batch", "--quantifiers", "cegis"]);
    assert_eq!(run.status, 1, "{}", run.stderr);
    fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
}

#[test]
fn a_solver_that_answers_at_the_end_of_its_input() {
    let (project, user) = folders();
    let fake = Fake::new(
        "cat > \"$TMPDIR/query\"; grep -q '^(check-sat)' \"$TMPDIR/query\" && echo unsat; rm \"$TMPDIR/query\"",
    );
    configure(&project, &user, &(entry("batch", &fake) + "incremental = false\n"));
    for quantifiers in ["cegis", "expand", "keep"] {
        let run = solve_in(project.path(), user.path(), &["--solver", "batch", "--quantifiers", quantifiers]);
        assert_eq!(run.status, 1, "{}", run.stderr);
    }
}

#[test]
fn a_path_gets_what_the_name_gets() {
    let (project, user) = folders();
    // As z3 it gets a file, a seed and a question for its version.
    let body = "case $1 in -*) exit 3;; esac
grep -q '^(set-option :random-seed 5)' \"$1\" || exit 4
echo unsat; echo '(:version \"9.8.7\")'";
    for name in ["z3", "z3-9.8.7-linux", "Z3.exe"] {
        let fake = Fake::called(name, body);
        let options = ["--seed", "5", "--quantifiers", "expand", "--solver"];
        let program = format!("'{}'", fake.program().display());
        let run = solve_in(project.path(), user.path(), &[&options[..], &[&program]].concat());
        assert_eq!(run.status, 1, "{}", run.stderr);
        assert_eq!(run.json()[0]["solver"], serde_json::json!({"name": "z3", "version": "9.8.7"}));
        let run = solve_in(project.path(), user.path(), &["--solver", &program, "--states", "int"]);
        assert_ne!(run.status, 2, "{}", run.stderr);
    }
    // What is said of z3 in the configuration is said of it there too.
    let fake = Fake::called("z3", "echo unsat");
    fs::write(
        project.path().join("hyperplan.toml"),
        "[[solver]]\nname = \"z3\"\ntheories = [\"bit-vectors\"]\n",
    )
    .expect("ours");
    let program = format!("'{}'", fake.program().display());
    let run = solve_in(project.path(), user.path(), &["--solver", &program, "--states", "int"]);
    assert_eq!(run.status, 2, "{}", run.stderr);
    assert!(run.stderr.contains("the z3 solver has no integers"), "{}", run.stderr);
}

#[test]
fn all_questions_are_in_the_file() {
    let (project, user) = folders();
    // Values are no use where the answer is not known, and there are as many replies as questions.
    let body = "[ \"$1\" = --version ] && exit 1
grep -q '^(get-info :version)' \"$1\" || exit 2
echo unknown; echo '(:version \"9.8.7\")'
grep '^(get-value' \"$1\" | while read -r line; do echo '(error \"line 5: no model\")'; done
tail -n 2 \"$1\" | grep -q '^(get-info :reason-unknown)' && echo '(:reason-unknown \"too hard (for me)\")'";
    let fake = Fake::new(body);
    let lines = "one-shot = [\"{file}\"]\ntells-version = true\n";
    configure(&project, &user, &(entry("weak", &fake) + lines));
    let run = solve_in(project.path(), user.path(), &["--solver", "weak", "--quantifiers", "expand"]);
    assert_eq!(run.status, 3, "{}", run.stderr);
    let answer = &run.json()[0];
    assert_eq!(answer["reason"], "too hard (for me)");
    assert_eq!(answer["solver"], serde_json::json!({"name": "weak", "version": "9.8.7"}));
    fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
}

/// Real solvers give models through files as they do in a dialogue.
#[test]
fn real_solvers_take_files() {
    let (project, user) = folders();
    let found = run_in(project.path(), user.path(), &["solvers", "--format", "json"]).json();
    let there = |name: &str| found.iter().any(|solver| solver["name"] == name && solver["path"].is_string());
    for (name, line) in
        [("z3", "z3 {file}"), ("cvc5", "cvc5 --produce-models {file}"), ("yices", "yices-smt2 {file}")]
    {
        if !there(name) {
            assert!(std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_none(), "{name} is required");
            continue;
        }
        for (options, status) in
            [(&[][..], 0), (&["--set", "T=1"][..], 1), (&["--quantifiers", "cegis"][..], 0)]
        {
            let run = solve_in(project.path(), user.path(), &[&["--solver", line], options].concat());
            assert_eq!(run.status, status, "{line} {options:?}: {}", run.stderr);
        }
    }
}

#[test]
fn the_first_answer_wins_a_race() {
    let (project, user) = folders();
    let (silent, crash) = (Fake::new("exec sleep 300"), Fake::new("echo oh >&2; exit 7"));
    let racers = format!("'{}','{}',builtin", silent.program().display(), crash.program().display());
    let begin = Instant::now();
    let run = solve_in(project.path(), user.path(), &["--solver", &racers, "--timeout", "60"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(begin.elapsed() < Duration::from_secs(30), "{:?}", begin.elapsed());
    let answer = &run.json()[0];
    assert_eq!((&answer["solver"]["name"], &answer["verified"]), (&"builtin".into(), &"by-search".into()));
    for fake in [silent, crash] {
        fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
    }
}

#[test]
fn a_wrong_model_wins_no_race() {
    let (project, user) = folders();
    let wrong = Fake::replying(&format!("*check-sat*) echo sat;; {}", common::fakes::FALSE));
    let racers = format!("'{}','{}'", wrong.program().display(), wrong.program().display());
    let queries = wrong.folder().join("queries");
    let run = solve_in(project.path(), user.path(), &["--solver", &racers, "--queries", text(&queries)]);
    assert_eq!(run.status, 4, "{}", run.stderr);
    assert_eq!(run.stderr.matches("solver fake gave a wrong model").count(), 2, "{}", run.stderr);
}

#[test]
fn a_lost_race_tells_all_reasons() {
    let (project, user) = folders();
    let (crash, garbage) = (Fake::new("echo oh >&2; exit 7"), Fake::called("other", "echo no; sleep 300"));
    let silent = Fake::called("silent", "exec sleep 300");
    let program = |fake: &Fake| format!("'{}'", fake.program().display());
    let racers = format!("{},{}", program(&crash), program(&garbage));
    let run = solve_in(project.path(), user.path(), &["--solver", &racers]);
    assert_eq!((run.status, run.stdout.as_str()), (4, ""), "{}", run.stderr);
    for words in ["no solver gave an answer", "exit status: 7", "it said: oh", "check-sat; it said: no"] {
        assert!(run.stderr.contains(words), "{}", run.stderr);
    }
    let racers = format!("{},{}", program(&crash), program(&silent));
    let run = solve_in(project.path(), user.path(), &["--solver", &racers, "--timeout", "1"]);
    assert_eq!(run.status, 3, "{}", run.stderr);
    let reason = run.json()[0]["reason"].as_str().expect("a reason").to_owned();
    assert!(reason.contains("silent': timeout") && reason.contains("exit status: 7"), "{reason}");
    let racers = format!("{},{}", program(&silent), program(&silent));
    let run = solve_in(project.path(), user.path(), &["--solver", &racers, "--timeout", "1"]);
    assert_eq!((run.status, &run.json()[0]["reason"]), (3, &"timeout".into()));
    let run = solve_in(project.path(), user.path(), &["--solver", "/no/such,/nor/this"]);
    assert_eq!(run.status, 4, "{}", run.stderr);
    assert!(run.stderr.contains("/no/such") && run.stderr.contains("/nor/this"), "{}", run.stderr);
}

#[test]
fn real_solvers_race() {
    let (project, user) = folders();
    for (horizon, status) in [("T=2", 0), ("T=1", 1)] {
        let run =
            solve_in(project.path(), user.path(), &["--solver", "builtin,z3,cvc5,yices", "--set", horizon]);
        assert_eq!(run.status, status, "{}", run.stderr);
    }
    let least = ["--solver", "builtin,z3", "--minimize", "T"];
    let run = solve_in(project.path(), user.path(), &least);
    assert_eq!((run.status, &run.json()[0]["minimized"]["value"]), (0, &2.into()), "{}", run.stderr);
}
