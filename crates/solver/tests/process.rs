//! Solvers that misbehave: fakes written as shell scripts.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use hyperplan_smt::{Script, Sort, Term, Value};
use hyperplan_solver::{Answer, Catalog, Deadline, Error, Options, Session, Spec, Unknown, open};
use tempfile::TempDir;

/// A fake solver.
fn fake(directory: &TempDir, body: &str) -> PathBuf {
    let path = directory.path().join("fake");
    fs::write(&path, format!("#!/bin/sh\n{body}\n")).expect("the directory is ours");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("the file is ours");
    path
}

fn session(program: &Path, options: &Options) -> Box<dyn Session> {
    let spec = Spec::Command(format!("'{}'", program.display()));
    open(&spec, options).expect("it was just written")
}

fn small() -> (Script, Term) {
    let mut script = Script::new();
    let stem = script.terms.stem("x");
    let x = script.terms.symbol(stem, Some(0), Sort::Bool);
    script.clause(&[x]);
    (script, x)
}

fn check(body: &str) -> Result<Answer, Error> {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let mut session = session(&fake(&directory, body), &Options::default());
    session.check(&small().0, &[], &Deadline::after(Duration::from_secs(20)))
}

fn is_running(pid: &str) -> bool {
    let status = fs::read_to_string(format!("/proc/{}/stat", pid.trim())).unwrap_or_default();
    // A zombie has ended.
    !status.is_empty() && !status.contains(") Z ")
}

#[cfg(target_os = "linux")]
#[test]
fn the_whole_group_is_killed_at_the_deadline() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let pids = directory.path().join("pids");
    let body = format!(
        "trap '' TERM INT HUP\n(trap '' TERM INT HUP; sleep 300) &\necho $! $$ > '{}'\nsleep 300",
        pids.display()
    );
    let mut session = session(&fake(&directory, &body), &Options::default());
    let start = Instant::now();
    let answer = session.check(&small().0, &[], &Deadline::after(Duration::from_millis(700)));
    assert_eq!(answer.expect("no error"), Answer::Unknown(Unknown::Timeout));
    assert!(start.elapsed() < Duration::from_secs(10));
    let pids = fs::read_to_string(pids).expect("the fake wrote it");
    assert_eq!(pids.split_whitespace().count(), 2);
    for pid in pids.split_whitespace() {
        // The kernel may take a moment.
        let gone = (0..200).any(|_| {
            std::thread::sleep(Duration::from_millis(5));
            !is_running(pid)
        });
        assert!(gone, "process {pid} is still there");
    }
}

#[test]
fn cancelling_ends_the_wait() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let mut session = session(&fake(&directory, "exec sleep 300"), &Options::default());
    let deadline = Deadline::never();
    let flag = deadline.cancel_flag();
    let canceller = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(200));
        flag.store(true, std::sync::atomic::Ordering::Relaxed);
    });
    let answer = session.check(&small().0, &[], &deadline).expect("no error");
    assert_eq!(answer, Answer::Unknown(Unknown::Interrupted));
    canceller.join().expect("it only sleeps");
}

#[test]
fn garbage_is_a_protocol_error() {
    let error = check("cat > /dev/null & echo hello world; sleep 300").expect_err("no answer");
    assert!(matches!(&error, Error::Protocol { said, .. } if said.contains("hello world")), "{error}");
    let error = check("head -c 200000 /dev/zero; sleep 300").expect_err("no answer");
    assert!(matches!(error, Error::Protocol { .. }), "{error}");
    let error = check("echo ')))'; sleep 300").expect_err("no answer");
    assert!(matches!(error, Error::Protocol { .. }), "{error}");
}

#[test]
fn a_crash_tells_the_last_words_and_the_status() {
    let error = check("echo 'out of luck' >&2; exit 7").expect_err("no answer");
    let text = error.to_string();
    assert!(matches!(error, Error::Crashed { .. }), "{text}");
    assert!(text.contains("out of luck") && text.contains('7') && text.contains("fake"), "{text}");
    let error = check("printf '(error \"lin'; exit 0").expect_err("no answer");
    assert!(matches!(error, Error::Protocol { .. } | Error::Crashed { .. }), "{error}");
}

#[test]
fn errors_are_reported_even_if_an_answer_follows() {
    // Once it was asked: an answer before that is another fault.
    let wait = "grep -m1 check-sat > /dev/null";
    let error = check(&format!("{wait}; echo '(error \"line 3: no (such) thing\")'; echo sat; sleep 300"))
        .expect_err("an error");
    assert!(
        matches!(&error, Error::Reported { message, .. } if message == "line 3: no (such) thing"),
        "{error}"
    );
}

/// One that answers before it reads cannot be told from one that is fast: the order of its replies decides, in every run.
#[test]
fn answers_before_questions_are_treated_alike_in_every_run() {
    let deadline = Deadline::after(Duration::from_secs(60));
    let (script, x) = small();
    let mut long = Script::new();
    let stem = long.terms.stem("a rather long name of a symbol");
    for i in 0..10_000 {
        let x = long.terms.symbol(stem, Some(i), Sort::Bool);
        long.clause(&[x]);
    }
    let directory = tempfile::tempdir().expect("a temporary directory");
    for _ in 0..20 {
        let unsat = fake(&directory, "echo unsat; exec cat > /dev/null");
        for script in [&script, &long] {
            let answer = session(&unsat, &Options::default()).check(script, &[], &deadline);
            assert_eq!(answer.expect("an answer"), Answer::Unsat);
        }
        let both = fake(&directory, "echo sat; echo unsat; exec cat > /dev/null");
        let mut session = session(&both, &Options::default());
        assert_eq!(session.check(&script, &[], &deadline).expect("an answer"), Answer::Sat);
        let error = session.values(&script, &[x]).expect_err("no values");
        assert!(matches!(&error, Error::Early { said, .. } if said == "unsat"), "{error}");
    }
}

/// A solver that reads everything before it says anything, and gives values.
const BATCH: &str = "cat > \"$0.in\"; echo sat; grep -q get-value \"$0.in\" && echo '((x@0 true))'";

#[test]
fn a_solver_that_waits_for_the_end_of_its_input() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let program = fake(&directory, BATCH);
    let (script, x) = small();
    let soon = || Deadline::after(Duration::from_millis(300));
    let answer = session(&program, &Options::default()).check(&script, &[], &soon());
    assert_eq!(answer.expect("no error"), Answer::Unknown(Unknown::WaitsForEnd));
    // That one only sleeps.
    let sleeper = tempfile::tempdir().expect("a temporary directory");
    let mut other = session(&fake(&sleeper, "exec sleep 300"), &Options::default());
    assert_eq!(other.check(&script, &[], &soon()).expect("no error"), Answer::Unknown(Unknown::Timeout));
    // Once that is known, it is served.
    let entry =
        format!("[[solver]]\nname = \"batch\"\nprogram = \"{}\"\nincremental = false\n", program.display());
    let mut catalog = Catalog::default();
    catalog.add(Path::new("hyperplan.toml"), &entry).expect("it is good");
    let options = Options { incremental: true, ..Options::default() };
    let mut session = open(&catalog.spec("batch").expect("it is there"), &options).expect("it was written");
    for _ in 0..2 {
        let deadline = Deadline::after(Duration::from_secs(20));
        assert_eq!(session.check(&script, &[], &deadline).expect("an answer"), Answer::Sat);
        assert_eq!(session.values(&script, &[x]).expect("values"), [Value::Bool(true)]);
    }
}

#[test]
fn numbers_without_room_are_not_the_solvers_fault() {
    let mut script = Script::new();
    let stem = script.terms.stem("n");
    let n = script.terms.symbol(stem, Some(0), Sort::Int);
    let zero = script.terms.int(0);
    let positive = script.terms.le(zero, n);
    script.assert(positive);
    let digits = "9".repeat(60);
    for (value, fits) in [("7", true), (&digits[..], false), (&format!("(- {digits})"), false)] {
        let directory = tempfile::tempdir().expect("a temporary directory");
        let replies = format!("*check-sat*) echo sat;; *get-value*) echo '((n@0 {value}))';;");
        let program = fake(
            &directory,
            &format!("while read -r line; do case $line in {replies} esac; done < ${{1:-/dev/stdin}}"),
        );
        for line in ["", " {file}"] {
            let spec = Spec::Command(format!("'{}'{line}", program.display()));
            let mut session = open(&spec, &Options::default()).expect("it was just written");
            let deadline = Deadline::after(Duration::from_secs(20));
            assert_eq!(session.check(&script, &[], &deadline).expect("an answer"), Answer::Sat);
            match session.values(&script, &[n]) {
                Ok(values) => assert!(fits && values == [Value::Int(7)], "{values:?}"),
                Err(error) => assert!(!fits && matches!(error, Error::LargeNumber { .. }), "{error}"),
            }
        }
    }
}

#[test]
fn programs_are_known_by_their_names() {
    for (line, name) in [("/usr/bin/z3", "z3"), ("./cvc5-1.2.0", "cvc5"), ("/opt/yices_smt2", "yices")] {
        let spec: Spec = line.parse().expect("any command line will do");
        assert_eq!((spec.name(), spec.profile().expect("it is known").name()), (line, name));
    }
    for line in ["/usr/bin/z3 -in", "/usr/bin/yices", "./z3-wrapper"] {
        assert_eq!(line.parse::<Spec>().expect("any command line will do"), Spec::Command(line.to_owned()));
    }
    // It is sought where it is said to be, whatever else is there.
    let Err(error) = open(&"/no/such/z3".parse().expect("good"), &Options::default()) else {
        panic!("it does not exist")
    };
    assert!(matches!(&error, Error::Missing { tried, .. } if *tried == ["/no/such/z3"]), "{error}");
    // The kind of a configured solver is that of its entry.
    let mut catalog = Catalog::default();
    let entry = "[[solver]]\nname = \"mine\"\nprogram = \"/opt/opensmt\"\nquantifiers = \"none\"\n";
    catalog.add(Path::new("hyperplan.toml"), entry).expect("it is good");
    let spec = catalog.spec("/usr/bin/opensmt-2.5").expect("good");
    assert_eq!(spec.profile().expect("it is known").name(), "mine");
}

#[test]
fn what_may_come_before_an_answer_is_skipped() {
    let answer =
        check("printf '\\r\\n; hello\\nunsupported\\n; ignored\\nWARNING: old\\nunsat\\r\\n'; sleep 300");
    assert_eq!(answer.expect("an answer"), Answer::Unsat);
}

#[test]
fn a_solver_that_reads_nothing_and_floods_cannot_hang_us() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let body = "exec yes '(error \"no\")'";
    let mut session = session(&fake(&directory, body), &Options::default());
    let mut script = Script::new();
    let stem = script.terms.stem("a rather long name of a symbol");
    for i in 0..200_000 {
        let x = script.terms.symbol(stem, Some(i), Sort::Bool);
        script.clause(&[x]);
    }
    let start = Instant::now();
    let error = session.check(&script, &[], &Deadline::after(Duration::from_secs(60))).expect_err("an error");
    assert!(matches!(error, Error::Reported { .. }), "{error}");
    assert!(start.elapsed() < Duration::from_secs(30));
}

#[test]
fn a_solver_that_closes_its_input_may_still_answer() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let mut session =
        session(&fake(&directory, "exec <&-; sleep 0.2; echo unsat; sleep 300"), &Options::default());
    let mut script = Script::new();
    let stem = script.terms.stem("x");
    for i in 0..200_000 {
        let x = script.terms.symbol(stem, Some(i), Sort::Bool);
        script.clause(&[x]);
    }
    let answer = session.check(&script, &[], &Deadline::after(Duration::from_secs(60)));
    assert_eq!(answer.expect("an answer"), Answer::Unsat);
}

#[test]
fn values_must_be_as_many_and_of_the_right_sort() {
    for reply in ["((x true) (y true))", "((x 5))", "()", "((x", "nothing", "((x (as @f Bool)))"] {
        let directory = tempfile::tempdir().expect("a temporary directory");
        let body = format!(
            "while read line; do case $line in\n*check-sat*) echo sat;;\n*get-value*) echo '{reply}'; exit;;\nesac; done"
        );
        let mut session = session(&fake(&directory, &body), &Options::default());
        let (script, x) = small();
        let deadline = Deadline::after(Duration::from_secs(20));
        assert_eq!(session.check(&script, &[], &deadline).expect("an answer"), Answer::Sat);
        let error = session.values(&script, &[x]).expect_err(reply);
        assert!(matches!(error, Error::Protocol { .. } | Error::Crashed { .. }), "{reply}: {error}");
        // The session is over; it has no model any more.
        assert!(matches!(session.values(&script, &[x]), Err(Error::NoModel { .. })));
    }
}

#[test]
fn queries_are_kept_and_can_be_replayed() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let queries = directory.path().join("queries");
    let options = Options { queries: Some(queries.clone()), ..Options::default() };
    let body = "while read line; do case $line in *check-sat*) echo sat;; *get-value*) echo '((x@0 true))';; esac; done";
    let (script, x) = small();
    let mut session = session(&fake(&directory, body), &options);
    session.check(&script, &[], &Deadline::never()).expect("an answer");
    session.values(&script, &[x]).expect("values");
    drop(session);
    let kept = fs::read_to_string(queries.join("0001-fake.smt2")).expect("a file");
    assert!(kept.starts_with("(set-option"), "{kept}");
    // What came back are comments, so that it can still be replayed.
    let dialogue = "(assert x@0)\n(check-sat)\n; sat\n(get-value ( x@0))\n; ((x@0 true))\n(exit)\n";
    assert!(kept.ends_with(dialogue), "{kept}");
}

#[test]
fn every_check_of_the_embedded_solver_is_kept() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let queries = directory.path().join("a/b");
    let options = Options { queries: Some(queries.clone()), incremental: true, ..Options::default() };
    let (mut script, x) = small();
    let stem = script.terms.stem("y");
    let y = script.terms.symbol(stem, None, Sort::Bool);
    let mut session = open(&Spec::Builtin, &options).expect("it is built in");
    let mut check = |script: &Script, assumptions: &[Term]| {
        session.check(script, assumptions, &Deadline::never()).expect("an answer")
    };
    assert_eq!(check(&script, &[]), Answer::Sat);
    script.clause(&[!x, y]);
    assert_eq!(check(&script, &[!y]), Answer::Unsat);
    assert_eq!(check(&script, &[]), Answer::Sat);
    let asserted = |number: &str| -> Vec<String> {
        let text = fs::read_to_string(queries.join(format!("{number}-builtin.smt2"))).expect("a file");
        assert!(text.ends_with("(check-sat)\n(exit)\n"), "{text}");
        text.lines().filter(|line| line.starts_with("(assert")).map(str::to_owned).collect()
    };
    assert_eq!(asserted("0001"), ["(assert x@0)"]);
    assert_eq!(asserted("0002"), ["(assert x@0)", "(assert (or (not x@0) y))", "(assert (not y))"]);
    assert_eq!(asserted("0003"), ["(assert x@0)", "(assert (or (not x@0) y))"]);
    assert_eq!(fs::read_dir(&queries).expect("it exists").count(), 3);
}

#[test]
fn queries_that_cannot_be_kept_are_an_error() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let file = directory.path().join("file");
    fs::write(&file, "").expect("the directory is ours");
    let options = Options { queries: Some(file), ..Options::default() };
    let mut session = open(&Spec::Builtin, &options).expect("it is built in");
    let error = session.check(&small().0, &[], &Deadline::never()).expect_err("a file is no directory");
    assert!(matches!(error, Error::Keep { .. }), "{error}");
}

#[test]
fn quantifiers_beyond_a_solver_are_refused() {
    let refused = |spec: Spec, quantified, nested| {
        let options = Options { quantified, nested, ..Options::default() };
        match open(&spec, &options) {
            Err(Error::Unsupported { what }) => Some(what),
            _ => None,
        }
    };
    let profile = |name: &str| Spec::Profile(name.to_owned());
    let what = refused(profile("yices"), true, true);
    let start = "the yices solver cannot handle quantifiers inside quantifiers: use one of";
    assert_eq!(what, Some(format!("{start} z3, cvc5, bitwuzla, depqbf, caqe, qute, rareqs")));
    assert_eq!(refused(profile("yices"), true, false), None);
    assert_eq!(refused(profile("yices"), false, false), None);
    for name in ["z3", "cvc5", "bitwuzla"] {
        assert_eq!(refused(profile(name), true, true), None, "{name}");
    }
    // What a command can do is not known.
    assert_eq!(refused(Spec::Command("no-such-solver".to_owned()), true, true), None);
}

#[test]
fn the_embedded_solver_names_solvers_that_take_the_quantifiers() {
    let what = |nested| {
        let options = Options { quantified: true, nested, ..Options::default() };
        open(&Spec::Builtin, &options).err().map(|error| error.to_string())
    };
    let start = "the builtin solver cannot handle quantifiers: use one of";
    assert_eq!(what(false), Some(format!("{start} z3, cvc5, yices, bitwuzla, depqbf, caqe, qute, rareqs")));
    assert_eq!(what(true), Some(format!("{start} z3, cvc5, bitwuzla, depqbf, caqe, qute, rareqs")));
}

#[test]
fn missing_solvers_say_where_they_were_sought() {
    let spec: Spec = "no-such-solver --flag".parse().expect("any command line will do");
    let Err(error) = open(&spec, &Options::default()) else { panic!("it does not exist") };
    assert!(
        matches!(&error, Error::Missing { name, tried, .. } if name == "no-such-solver" && !tried.is_empty())
    );
    assert!("z3,cvc5".parse::<Spec>().is_err());
    assert_eq!("yices-smt2".parse::<Spec>().expect("known"), Spec::Profile("yices".to_owned()));
    assert_eq!("builtin".parse::<Spec>().expect("known"), Spec::Builtin);
}

#[test]
fn back_ends_have_names() {
    // BatSat is in every build.
    let built = if cfg!(feature = "cadical") { vec!["cadical", "batsat"] } else { vec!["batsat"] };
    assert_eq!(Spec::backends().iter().map(Spec::name).collect::<Vec<_>>(), built);
    for name in ["cadical", "batsat"] {
        let identity = name.parse::<Spec>().and_then(|spec| Ok(open(&spec, &Options::default())?.identity()));
        match identity {
            Ok(identity) => {
                assert_eq!(identity.name, name);
                assert!(
                    built.contains(&name) && identity.version.contains(&format!("({name}-")),
                    "{identity:?}"
                );
            }
            Err(error) => assert_eq!(
                (built.contains(&name), error.is_unsupported(), error.to_string()),
                (false, true, format!("this build has no {name}: it takes the cargo feature {name}"))
            ),
        }
    }
    let best = open(&Spec::Builtin, &Options::default()).expect("it is built in").identity();
    assert!(best.name == "builtin" && best.version.contains(built[0]), "{best:?}");
    let unknown = open(&Spec::Backend("kissat"), &Options::default()).err().map(|error| error.to_string());
    assert_eq!(unknown.as_deref(), Some("no solver kissat is known"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_panic_ends_the_solver() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let pids = directory.path().join("pids");
    let cases = "*check-sat*) sleep 300 & echo $! $$ > ";
    let body =
        format!("while read line; do case $line in {cases} '{}'; echo sat;; esac; done", pids.display());
    let program = fake(&directory, &body);
    let thread = std::thread::spawn(move || {
        let mut session = session(&program, &Options::default());
        let answer = session.check(&small().0, &[], &Deadline::never());
        assert_eq!(answer.expect("an answer"), Answer::Unsat, "this is to fail");
    });
    assert!(thread.join().is_err());
    let pids = fs::read_to_string(pids).expect("the fake wrote it");
    assert_eq!(pids.split_whitespace().count(), 2);
    for pid in pids.split_whitespace() {
        let gone = (0..400).any(|_| {
            std::thread::sleep(Duration::from_millis(5));
            !is_running(pid)
        });
        assert!(gone, "process {pid} is still there");
    }
}

#[test]
fn a_solver_that_ends_after_an_error_is_started_again() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    // The first process fails, the second answers once and ends, the third answers.
    let count = directory.path().join("count");
    let body = format!(
        "echo >> '{0}'; case $(wc -l < '{0}') in *1) echo '(error \"no\")'; exit 1;; *2) echo sat; exit;; esac\n\
         while read line; do case $line in *check-sat*) echo unsat;; esac; done",
        count.display()
    );
    let options = Options { incremental: true, ..Options::default() };
    let mut session = session(&fake(&directory, &body), &options);
    let (mut script, x) = small();
    let deadline = Deadline::after(Duration::from_secs(20));
    assert!(matches!(session.check(&script, &[], &deadline), Err(Error::Reported { .. })));
    assert_eq!(session.check(&script, &[], &deadline).expect("an answer"), Answer::Sat);
    script.clause(&[!x]);
    assert_eq!(session.check(&script, &[], &deadline).expect("an answer"), Answer::Unsat);
    assert_eq!(fs::read_to_string(count).expect("the fake wrote it").len(), 3);
}

#[test]
fn a_part_is_cancelled_with_the_whole_and_not_the_other_way() {
    let whole = Deadline::never();
    let (one, other) = (whole.part(), whole.part().within(Duration::from_secs(100)));
    one.cancel();
    assert!(one.passed() && !other.passed() && !whole.passed());
    whole.cancel();
    assert!(other.part().cancelled() && other.passed());
}
