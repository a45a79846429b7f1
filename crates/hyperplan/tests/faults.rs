//! Solvers that misbehave: a clear message that names the solver and what it said last, the right exit status in time,
//! and nothing left behind.
#![cfg(unix)]

mod common;

use common::fakes::{FALSE, Fake};
use common::{Run, command, text};
use std::time::{Duration, Instant};

/// Seconds for the whole command, and what a busy machine may take beyond.
const TIMEOUT: &str = "2";
const LATEST: Duration = Duration::from_secs(2 + 1 + 10);

/// Solves a small problem, in its folder for temporary files.
fn solve(fake: &Fake, solver: &str, options: &[&str]) -> Run {
    let base = ["solve", "rooms.hp", "--objective", "sp", "--timeout", TIMEOUT, "--solver", solver];
    let start = Instant::now();
    let mut command = command(&[&base[..], options].concat());
    let run = Run::new(command.env("TMPDIR", fake.temporary()).output().expect("the command was built"));
    assert!(start.elapsed() < LATEST, "it took {:?}: {}", start.elapsed(), run.stderr);
    run
}

/// The status and all words that a fake solver leads to.
fn with(fake: &Fake, options: &[&str]) -> (i32, String) {
    let run = solve(fake, &format!("'{}'", fake.program().display()), options);
    fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
    assert!(fake.begun() > 0, "the fake did not run: {}", run.stderr);
    (run.status, run.stdout + &run.stderr)
}

#[track_caller]
fn expect(body: &str, status: i32, words: &[&str]) {
    expect_of(&Fake::new(body), &[], status, words);
}

#[track_caller]
fn expect_of(fake: &Fake, options: &[&str], status: i32, words: &[&str]) {
    let (code, said) = with(fake, options);
    assert_eq!(code, status, "{said}");
    for words in words {
        assert!(said.contains(words), "{words}: {said}");
    }
}

#[test]
fn silence_ends_at_the_deadline() {
    expect("exec sleep 300", 3, &["sp: unknown: timeout"]);
    expect("trap '' TERM INT HUP\nsleep 300 & note $!\nsleep 300 & note $!\nwait", 3, &["timeout"]);
}

#[test]
fn drops_are_no_answer() {
    expect("while :; do printf s; sleep 0.1; done", 3, &["timeout"]);
    expect("while :; do echo; echo '; wait'; sleep 0.1; done", 3, &["timeout"]);
}

#[test]
fn a_closed_input() {
    expect("exec <&-; exec sleep 300", 3, &["timeout"]);
    let words = "solver fake ended without an answer (exit status: 3); it said: no input";
    expect("exec <&-; echo 'no input' >&2; exit 3", 4, &[words]);
}

#[test]
fn a_closed_output() {
    let words = "solver fake ended without an answer (it closed its output); it said: I am off";
    expect("echo 'I am off' >&2; exec sleep 300 >&-", 4, &[words]);
}

#[test]
fn floods() {
    expect("yes 'all sorts of complaints' >&2 & note $!; exec sleep 300", 3, &["timeout"]);
    expect("exec yes hello", 4, &["solver fake gave no proper reply to check-sat; it said: hello"]);
    // One reply without an end: it is given up when it is too long, or when the time is over.
    let (status, said) = with(&Fake::new("exec tr '\\0' '(' < /dev/zero"), &[]);
    match status {
        3 => assert!(said.contains("timeout"), "{said}"),
        _ => assert!(status == 4 && said.contains("solver fake gave no proper reply to check-sat"), "{said}"),
    }
}

#[test]
fn answers_before_it_was_asked() {
    let words = "solver fake answered before it was asked; it said: unsat";
    expect("printf 'sat\\nunsat\\n'; exec cat > /dev/null", 4, &[words]);
}

/// Whatever comes first: its replies have one order.
#[test]
fn early_answers_are_treated_alike_in_every_run() {
    let (early, twice) = (
        Fake::new("echo unsat; exec cat > /dev/null"),
        Fake::new("echo sat; echo unsat; exec cat > /dev/null"),
    );
    // A search without a solver would do.
    let asked = ["--quantifiers", "expand"];
    for _ in 0..10 {
        assert_eq!(with(&early, &asked).0, 1);
        let (status, said) = with(&twice, &asked);
        assert!(
            status == 4 && said.contains("answered before it was asked; it said: unsat"),
            "{status} {said}"
        );
    }
}

#[test]
fn answers_at_the_end_of_the_input() {
    let words = "sp: unknown: timeout: the solver answers only at the end of its input; describe it in hyperplan.toml, with \
                 `incremental = false`";
    let fake = Fake::new("cat > /dev/null; echo unsat");
    expect_of(&fake, &["--quantifiers", "expand"], 3, &[words]);
}

#[test]
fn garbage() {
    expect(
        "printf '\\001\\377 what\\n'; exec cat > /dev/null",
        4,
        &["no proper reply to check-sat; it said: "],
    );
    expect("echo 'sat?'; exec cat > /dev/null", 4, &["solver fake", "it said: sat?"]);
}

#[test]
fn half_a_reply_and_the_end() {
    expect("printf '(err'", 4, &["solver fake gave no proper reply to check-sat; it said: (err"]);
    expect("printf sa; echo 'I am tired' >&2", 4, &["it said: sa / I am tired"]);
    let cases = "*check-sat*) echo sat;; *get-value*) printf '((p.at'; exit 0;;";
    expect_of(&Fake::replying(cases), &[], 4, &["fake gave no proper reply to get-value; it said: ((p.at"]);
}

#[test]
fn crashes() {
    let words = ["solver fake ended without an answer (signal: 11 (SIGSEGV)", "it said: assertion failed"];
    expect("echo 'assertion failed' >&2; kill -SEGV $$", 4, &words);
    expect("exit 0", 4, &["solver fake ended without an answer (exit status: 0)"]);
    let cases = "*check-sat*) echo sat;; *get-value*) echo oh >&2; exit 9;;";
    expect_of(&Fake::replying(cases), &[], 4, &["(exit status: 9); it said: oh"]);
    expect(
        "echo '(error \"line 1: no\")'; exec cat > /dev/null",
        4,
        &["solver fake reported an error: line 1: no"],
    );
}

#[test]
fn it_does_not_know() {
    let cases = "*check-sat*) echo unknown;; *reason*) echo '(:reason-unknown \"incomplete\")';;";
    expect_of(&Fake::replying(cases), &[], 3, &["sp: unknown: incomplete"]);
    let cases = "*check-sat*) echo unknown;; *reason*) echo '(error \"no such info\")'; exit 1;;";
    expect_of(&Fake::replying(cases), &[], 3, &["sp: unknown: unknown"]);
    expect_of(&Fake::replying("*check-sat*) echo timeout;;"), &[], 3, &["sp: unknown: timeout"]);
}

/// The file with the query that is said to be kept.
fn kept(fake: &Fake, said: &str) -> String {
    let (_, rest) = said.split_once("which is kept in ").expect(said);
    let path = rest.split_whitespace().next().expect("a path");
    assert!(std::path::Path::new(path).starts_with(fake.folder()), "{path}");
    let text = std::fs::read_to_string(path).expect("it is there");
    assert!(text.contains("(set-logic ") && text.contains("(check-sat)"), "{text}");
    text
}

#[test]
fn wrong_models_are_kept() {
    // Both where there is a model, and where there is none.
    for horizon in ["T=2", "T=1"] {
        let fake = Fake::replying(&format!("*check-sat*) echo sat;; {FALSE}"));
        let queries = fake.folder().join("queries");
        // Left to itself, hyperplan guesses a strategy here that leaves nothing to get wrong.
        let arguments = ["--set", horizon, "--quantifiers", "expand", "--queries", text(&queries)];
        let (status, said) = with(&fake, &arguments);
        assert_eq!(status, 4, "{said}");
        assert!(said.contains("solver fake gave a wrong model: it does not satisfy the query"), "{said}");
        let kept = kept(&fake, &said);
        assert!(kept.contains("Answer of fake: sat") && kept.contains("It violates assertion "), "{kept}");
        // Without a strategy the query has no symbols.
        let model = kept.contains("; The model:\n; ") && kept.contains(" = false\n");
        assert_eq!(model, horizon == "T=2", "{kept}");
    }
    // Without --queries it is among the temporary files.
    let fake = Fake::replying(&format!("*check-sat*) echo sat;; {FALSE}"));
    let run = solve(&fake, &format!("'{}'", fake.program().display()), &["--quantifiers", "expand"]);
    kept(&fake, &run.stderr);
}

#[test]
fn a_wrong_unsat_is_caught_by_a_cross_check() {
    let fake = Fake::replying("*check-sat*) echo unsat;;");
    let queries = fake.folder().join("queries");
    let queries = ["--queries", text(&queries)];
    let (status, said) = with(&fake, &[&["--cross-check", "builtin"], &queries[..]].concat());
    assert_eq!(status, 4, "{said}");
    let words = "solvers fake and builtin disagree: fake says unsat, builtin says sat, and its model satisfies the query";
    assert!(said.contains(words), "{said}");
    assert!(kept(&fake, &said).contains("Answer of fake: unsat.\nAnswer of builtin 0.1.0"), "{said}");
    // Nobody else was asked.
    assert_eq!(with(&fake, &[]).0, 1);
    // Where it is right, that is confirmed.
    let (status, said) = with(&fake, &["--set", "T=1", "--cross-check", "builtin"]);
    assert_eq!((status, said.contains("confirmed")), (1, false), "{said}");
}

#[test]
fn a_cross_check_may_be_wrong_itself() {
    let check = |cases: &str| {
        let fake = Fake::replying(cases);
        let queries = fake.folder().join("queries");
        let program = format!("'{}'", fake.program().display());
        let options = ["--set", "T=1", "--queries", text(&queries), "--cross-check", &program];
        let run = solve(&fake, "builtin", &options);
        fake.is_clean().unwrap_or_else(|left| panic!("{left}"));
        (run.status, run.stdout + &run.stderr)
    };
    let (status, said) = check(&format!("*check-sat*) echo sat;; {FALSE}"));
    assert_eq!(status, 4, "{said}");
    assert!(
        said.contains("fake says sat, but its model does not satisfy the query, which is kept in "),
        "{said}"
    );
    let (status, said) = check("*check-sat*) echo unknown;; *reason*) echo '(:reason-unknown bored)';;");
    assert_eq!(status, 1, "{said}");
    assert!(
        said.contains("note: an unsat was not confirmed by ") && said.contains("/fake': bored"),
        "{said}"
    );
    let (status, said) = check("*check-sat*) exit 5;;");
    assert_eq!(status, 4, "{said}");
}

#[test]
fn a_huge_model() {
    let cases =
        "*check-sat*) echo sat;; *get-value*) printf '('; yes '(x true)' | head -n 2000000; echo ')';;";
    expect_of(&Fake::replying(cases), &[], 4, &["solver fake gave no proper reply to get-value; it said: "]);
}

#[test]
fn children_do_not_outlive_it() {
    // The child holds the output open, and would be waited for.
    let body = "(trap '' TERM INT HUP; exec sleep 300) & note $!\necho 'good bye' >&2; exit 3";
    expect(body, 4, &["solver fake ended without an answer (exit status: 3); it said: good bye"]);
    let cases = "*check-sat*) sleep 300 & note $!; echo sat;; *get-value*) echo '()';;";
    expect_of(&Fake::replying(cases), &[], 4, &["no proper reply to get-value"]);
}

#[cfg(target_os = "linux")]
#[test]
fn too_much_memory_is_undecided() {
    let memory = ["--memory", "100"];
    expect_of(&Fake::new("exec tail /dev/zero"), &memory, 3, &["sp: unknown: out of memory"]);
    let cases = "*check-sat*) echo sat;; *get-value*) exec tail /dev/zero;;";
    expect_of(&Fake::replying(cases), &memory, 3, &["sp: unknown: out of memory"]);
    expect("echo '(error \"out of memory\")'", 3, &["sp: unknown: out of memory"]);
}

/// What is called `minisat` says that all variables are true: of an enumeration, that is more than there are values.
#[test]
fn assignments_that_are_no_values_are_refused() {
    let all =
        "n=$(sed -n 's/^p cnf \\([0-9]*\\) .*/\\1/p' \"$1\"); { echo SAT; seq -s ' ' $n; echo 0; } > \"$2\"
        echo SATISFIABLE; echo v $(seq -s ' ' $n) 0; exit 10";
    let fake = Fake::called("minisat", all);
    let arguments = ["solve", "pass/costs.hp", "--objective", "none_cheaper", "--solver", "minisat"];
    let mut command = command(&[&arguments[..], &["--states", "enum", "--quantifiers", "expand"]].concat());
    command.env("HYPERPLAN_MINISAT", fake.program()).env("TMPDIR", fake.temporary());
    let run = Run::new(command.output().expect("the command was built"));
    assert_eq!(run.status, 4, "{}{}", run.stdout, run.stderr);
    assert!(run.stderr.contains("minisat"), "{}", run.stderr);
}
