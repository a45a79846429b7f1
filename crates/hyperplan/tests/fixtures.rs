//! One test for each file of `specs/`: `fail/NAME.hp` is refused with exactly the messages of `fail/NAME.stderr`;
//! `pass/NAME.hp` is accepted, with the warnings of `pass/NAME.stderr` where that file exists, and every comment
//! line `// OBJECTIVE: VERDICT` of it, as `KnownStatus` reads it, is what `solve` says, or where it goes on `by SOLVERS`,
//! what each of those solvers says; one that is missing is skipped, unless `HYPERPLAN_REQUIRE_SOLVERS` is set. `explain/NAME.hp` is
//! explained by the words of `explain/NAME.txt`. `UPDATE=1` writes the `.stderr` and `.txt` files.

use hyperplan_problem::KnownStatus;
use libtest_mimic::{Arguments, Failed, Trial};
use std::ffi::OsStr;
use std::fmt;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn main() {
    let arguments = Arguments::from_args();
    let mut trials = Vec::new();
    for path in problems("fail") {
        trials.push(Trial::test(name("fail", &path), move || refused(&path)));
    }
    for path in problems("pass").into_iter().chain(problems(".")) {
        let checked = path.clone();
        trials.push(Trial::test(name("pass", &path), move || accepted(&checked)));
        trials.extend(solutions(&path));
    }
    for path in problems("case-studies") {
        // `check` looks for what is doubtful, which takes some seconds on the larger maps.
        let large = ["-40", "-60"].iter().any(|size| stem(&path).ends_with(size));
        if stem(&path).ends_with("-10") {
            trials.extend(solutions(&path));
        }
        let name = name("case-studies", &path);
        let test = move || if large { understood(&path) } else { accepted(&path) };
        trials.push(Trial::test(name, test));
    }
    for path in problems("explain") {
        trials.push(Trial::test(name("explain", &path), move || explained(&path)));
    }
    libtest_mimic::run(&arguments, trials).exit();
}

/// A test for each answer that a file says.
fn solutions(path: &Path) -> Vec<Trial> {
    let trial = |expected: Expected| {
        let Expected { objective, set, solver, .. } = &expected;
        let question = [std::slice::from_ref(objective), set].concat().join(" ");
        let name = format!("solve::{}::{question}::{solver}", stem(path));
        let path = path.to_owned();
        Trial::test(name, move || solved(&path, &expected))
    };
    expectations(path).into_iter().map(trial).collect()
}

fn specs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs")
}

/// The problem files of a folder, named relative to `specs/`, sorted.
fn problems(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(specs().join(folder)).expect("the specs are part of the repository");
    let files = entries.map(|entry| PathBuf::from(entry.expect("readable").file_name()));
    let mut found: Vec<PathBuf> = files
        .filter(|file| file.extension() == Some(OsStr::new("hp")))
        .map(|file| if folder == "." { file } else { Path::new(folder).join(file) })
        .collect();
    found.sort();
    found
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn name(folder: &str, path: &Path) -> String {
    format!("{folder}::{}", stem(path))
}

/// Runs the command in `specs/`, so that messages name files as they are named here.
fn hyperplan(arguments: &[&OsStr]) -> Result<Output, Failed> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hyperplan"));
    command.current_dir(specs()).args(arguments).env_remove("NO_COLOR");
    // Of a user who has configured nothing.
    command.env("XDG_CONFIG_HOME", concat!(env!("CARGO_TARGET_TMPDIR"), "/no-configuration"));
    command.output().map_err(|e| format!("cannot run hyperplan: {e}").into())
}

fn refused(path: &Path) -> Result<(), Failed> {
    let output = hyperplan(&["check".as_ref(), path.as_os_str()])?;
    let messages = String::from_utf8(output.stderr)?;
    if output.status.code() != Some(2) {
        return Err(format!("{} instead of exit status 2\n{messages}", output.status).into());
    }
    compare(path, &messages)
}

fn accepted(path: &Path) -> Result<(), Failed> {
    // What `check` can say of integers and reals depends on there being a solver for them.
    let by_others = expectations(path).iter().any(|expected| expected.solver != "builtin");
    if by_others && !is_required() && !has_external_solver()? {
        say(format_args!("no solver for {}: skipped", path.display()));
        return Ok(());
    }
    let output = hyperplan(&["check".as_ref(), path.as_os_str()])?;
    let messages = String::from_utf8(output.stderr)?;
    if output.status.code() != Some(0) {
        return Err(format!("{}\n{messages}", output.status).into());
    }
    compare(path, &messages)
}

fn explained(path: &Path) -> Result<(), Failed> {
    let output = hyperplan(&["explain".as_ref(), path.as_os_str(), "--objective".as_ref(), "all".as_ref()])?;
    let messages = String::from_utf8(output.stderr)?;
    if output.status.code() != Some(1) || !messages.is_empty() {
        return Err(format!("{} instead of exit status 1\n{messages}", output.status).into());
    }
    compare_with(path, "txt", &String::from_utf8(output.stdout)?)
}

fn understood(path: &Path) -> Result<(), Failed> {
    let output = hyperplan(&["horizon".as_ref(), path.as_os_str()])?;
    if output.status.code() == Some(0) && output.stderr.is_empty() {
        return Ok(());
    }
    Err(format!("{}\n{}", output.status, String::from_utf8_lossy(&output.stderr)).into())
}

/// Compares messages with the file beside the problem; no file stands for no message.
fn compare(path: &Path, messages: &str) -> Result<(), Failed> {
    compare_with(path, "stderr", messages)
}

fn compare_with(path: &Path, ending: &str, messages: &str) -> Result<(), Failed> {
    let expected_path = specs().join(path).with_extension(ending);
    let expected = std::fs::read_to_string(&expected_path).unwrap_or_default();
    if messages == expected {
        return Ok(());
    }
    if std::env::var_os("UPDATE").is_some() {
        if messages.is_empty() {
            std::fs::remove_file(&expected_path)?;
        } else {
            std::fs::write(&expected_path, messages)?;
        }
        return Ok(());
    }
    let hint = "UPDATE=1 cargo test --package hyperplan --test fixtures accepts what is new";
    Err(format!("expected:\n{expected}\nfound:\n{messages}\n{hint}").into())
}

/// What a comment line says that `solve` answers.
struct Expected {
    objective: String,
    /// Constants, as `--set` takes them.
    set: Vec<String>,
    verdict: String,
    solver: String,
}

fn expectations(path: &Path) -> Vec<Expected> {
    let text = std::fs::read_to_string(specs().join(path)).unwrap_or_default();
    let mut expected = Vec::new();
    for KnownStatus { objective, set, realizable, by } in KnownStatus::of_text(&text) {
        let verdict = if realizable { "realizable" } else { "unrealizable" };
        let one = |solver: &str| Expected {
            objective: objective.clone(),
            set: set.iter().map(|(name, value)| format!("{name}={value}")).collect(),
            verdict: verdict.to_owned(),
            solver: solver.to_owned(),
        };
        expected.extend(by.iter().map(|solver| one(solver)));
        if by.is_empty() {
            expected.push(one("builtin"));
        }
    }
    expected
}

fn say(words: fmt::Arguments<'_>) {
    let _ = writeln!(std::io::stderr(), "{words}");
}

/// Whether a missing solver is a failure.
fn is_required() -> bool {
    std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_some()
}

fn has_external_solver() -> Result<bool, Failed> {
    let output = hyperplan(&["solvers".as_ref(), "--format".as_ref(), "json".as_ref()])?;
    for line in String::from_utf8(output.stdout)?.lines() {
        let solver: serde_json::Value = serde_json::from_str(line)?;
        if solver["embedded"] == false && solver["path"].is_string() {
            return Ok(true);
        }
    }
    Ok(false)
}

fn solved(path: &Path, expected: &Expected) -> Result<(), Failed> {
    let Expected { objective, set, verdict, solver } = expected;
    let mut arguments =
        ["solve", "--quiet", "--objective", objective, "--solver", solver].map(OsStr::new).to_vec();
    arguments.extend(set.iter().flat_map(|value| ["--set", value]).map(OsStr::new));
    let output = hyperplan(&[&arguments[..], &[path.as_os_str()]].concat())?;
    let found = String::from_utf8(output.stdout)?;
    let messages = String::from_utf8_lossy(&output.stderr).into_owned();
    if solver != "builtin"
        && !is_required()
        && output.status.code() == Some(4)
        && messages.contains("not found")
    {
        say(format_args!("{solver} is missing: skipped"));
        return Ok(());
    }
    let status = if verdict == "realizable" { 0 } else { 1 };
    // What a cheapest strategy costs stands behind the verdict.
    let told = found.trim_end().split_once(" with ").map_or(found.trim_end(), |(told, _)| told);
    if told == format!("{objective}: {verdict}") && output.status.code() == Some(status) {
        return Ok(());
    }
    Err(format!("expected {verdict}, found {found}{}\n{messages}", output.status).into())
}
