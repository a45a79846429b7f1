//! Solvers that get files of bits and misbehave, or say little: fakes written as shell scripts.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::time::Duration;

use hyperplan_smt::{Script, Sort, Term, Value};
use hyperplan_solver::{Answer, Catalog, Deadline, Error, Options, Session, Unknown, open};
use tempfile::TempDir;

/// A session with a fake that reads QDIMACS in its first argument.
fn session(directory: &TempDir, body: &str, options: &Options) -> Box<dyn Session> {
    let path = directory.path().join("fake");
    fs::write(&path, format!("#!/bin/sh\n{body}\n")).expect("the directory is ours");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("the file is ours");
    let mut catalog = Catalog::default();
    let entry = format!(
        "[[solver]]\nname = \"fake\"\nprogram = '{}'\nformat = \"qdimacs\"\none-shot = [\"{{file}}\"]\n\
         version = []\ntheories = [\"bit-vectors\"]\n",
        path.display()
    );
    catalog.add(Path::new("/etc/hyperplan.toml"), &entry).expect("it is good");
    open(&catalog.spec("fake").expect("it was added"), options).expect("it was just written")
}

/// `x` is true, and `y` is not.
fn small() -> (Script, [Term; 2]) {
    let mut script = Script::new();
    let stem = script.terms.stem("x");
    let [x, y] = [0, 1].map(|i| script.terms.symbol(stem, Some(i), Sort::Bool));
    script.assert(x);
    script.assert(!y);
    (script, [x, y])
}

fn check(body: &str) -> Result<(Answer, Option<Vec<Value>>), Error> {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let mut session = session(&directory, body, &Options::default());
    let (script, symbols) = small();
    let answer = session.check(&script, &[], &Deadline::after(Duration::from_secs(20)))?;
    let values = session.values(&script, &symbols).ok();
    Ok((answer, values))
}

#[test]
fn answers_are_read_from_words_or_the_exit_status() {
    let model = Some(vec![Value::Bool(true), Value::Bool(false)]);
    let sat = |body| assert_eq!(check(body).expect(body), (Answer::Sat, model.clone()), "{body}");
    sat("echo 's cnf 1 3 3'; echo 'V 2 0'; echo 'V -3 0'; exit 10");
    sat("echo 'V +2 -3'; echo 's cnf 1'");
    sat("echo 'v 2 -3 0'; exit 10");
    let unsat = |body| assert_eq!(check(body).expect(body), (Answer::Unsat, None), "{body}");
    unsat("echo 's cnf 0 3 3'; exit 20");
    unsat("exit 20");
    let unknown = check("echo 's cnf -1 3 3'").expect("no error");
    assert_eq!(unknown, (Answer::Unknown(Unknown::Unsaid), None));
}

#[test]
fn what_they_get_is_qdimacs() {
    let same = "grep -v '^c' \"$1\" | tr '\\n' ';' | grep -q \
                '^p cnf 3 3;e 2 3 1 0;1 0;2 0;-3 0;$' && exit 20; grep -v '^c' \"$1\" >&2; exit 1";
    assert_eq!(check(same).expect("as expected").0, Answer::Unsat);
}

#[test]
fn faults_are_told() {
    let error = |body| check(body).expect_err(body).to_string();
    assert!(error("echo 's cnf 1 3 3'; echo 'V 2 0'; exit 20").contains("after another answer"));
    assert!(error("exit 10").contains("an assignment to the outermost block"));
    let crashed = error("echo 'unknown option --qdo'; exit 1");
    assert!(crashed.contains("ended without an answer (exit status: 1)"), "{crashed}");
    assert!(crashed.contains("unknown option --qdo"), "{crashed}");
    assert!(matches!(
        check("echo 'out of memory' >&2; exit 1"),
        Ok((Answer::Unknown(Unknown::Memory), None))
    ));
}

#[test]
fn a_line_of_any_length_is_one() {
    // 40,000 literals that are none of the query's, before those that are.
    let body =
        "printf v; i=0; while [ $i -lt 40000 ]; do printf ' -3'; i=$((i+1)); done; echo ' 2 0'; exit 10";
    assert_eq!(check(body).expect("no error").1, Some(vec![Value::Bool(true), Value::Bool(false)]));
}

#[test]
fn queries_are_kept_as_they_are_sent() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let kept = directory.path().join("kept");
    let options = Options { queries: Some(kept.clone()), ..Options::default() };
    let mut session = session(&directory, "cp \"$1\" \"$0.sent\"; exit 20", &options);
    let answer = session.check(&small().0, &[], &Deadline::never()).expect("no error");
    assert_eq!(answer, Answer::Unsat);
    let read = |path: &Path| fs::read_to_string(path).expect("it was written");
    let text = read(&kept.join("0001-fake.qdimacs"));
    assert_eq!(text, read(&directory.path().join("fake.sent")));
    assert!(text.contains("c 2 x@0\nc 3 x@1\n"), "{text}");
}

#[test]
fn the_deadline_ends_it_and_numbers_are_refused() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let mut slow = session(&directory, "exec sleep 300", &Options::default());
    let answer = slow.check(&small().0, &[], &Deadline::after(Duration::from_millis(300)));
    assert_eq!(answer.expect("no error"), Answer::Unknown(Unknown::Timeout));
    let mut script = Script::new();
    let stem = script.terms.stem("n");
    let n = script.terms.symbol(stem, None, Sort::Int);
    let zero = script.terms.constant(Value::Int(0));
    let claim = script.terms.eq(n, zero);
    script.assert(claim);
    let error = session(&directory, "exit 20", &Options::default()).check(&script, &[], &Deadline::never());
    let error = error.expect_err("there are no bits").to_string();
    assert_eq!(error, "the fake solver has no integers: use one of z3, cvc5, yices");
}
