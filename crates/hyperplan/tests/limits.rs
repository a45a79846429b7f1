//! Deadlines, signals and limits of memory hold whatever the problem is like: commands over giants.
#![cfg(unix)]

mod common;

use common::{command, text};
use std::fs;
use std::io::{BufRead as _, BufReader, Read as _};
use std::os::unix::process::ExitStatusExt as _;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A deadline far below what the giants take, and a time that no run needs that keeps it, on any machine.
const TIMEOUT: &str = "0.5";
const LONG: Duration = Duration::from_secs(30);

/// Problems that take more time or memory than there is, of the kinds that have no loop of their own to ask for the
/// time: many Booleans, wide ranges, labels that use labels, large maps, nested intervals.
fn giants() -> (TempDir, Vec<PathBuf>) {
    let booleans = |n: usize| {
        let each = |part: &dyn Fn(usize) -> String| (0..n).map(part).collect::<Vec<_>>().join(" ");
        let vars = each(&|i| format!("state v{i}: bool; action f{i};"));
        let clauses = each(&|i| format!("on f{i} {{ v{i}' = !v{i}; }}"));
        let objective = "objective o { exists p. forall q. F[0,40] (v3[p] & v5[p] & !v3[q]) }";
        format!("system S {{ {vars} {clauses} }}\n{objective}")
    };
    let labels = |n: usize| {
        let label = |i: usize| format!("label l{i} = l{0} & (l{0} | a == {1});", i - 1, i % 10);
        let labels: String = (1..n).map(label).collect();
        let start =
            "system S { state a: 0..9; action u; on u { a' = a + 1; } absorb a == 9; label l0 = a == 1;";
        format!("{start} {labels} }}\nobjective o {{ exists p. F[0,9] l{}[p] }}", n - 1)
    };
    let nested = |n: usize| {
        let open: String =
            (0..n).map(|i| format!("(a[p] != {} U[0,400] (a[q] == {} R[0,400] ", i % 10, i % 7)).collect();
        let start = "system S { state a: 0..9; action u, d; on u { a' = a + 1; } on d { a' = a - 1; } }";
        format!("{start}\nobjective o {{ exists p. forall q. {open} a[p] == a[q] {} }}", "))".repeat(n))
    };
    let wide = "system S { state a: 0..1000000; action u; on u { a' in 0..1000000; } init a == 0; }\n\
                objective o { exists p. forall q. F[0,4] a[p] == 1 & F[0,4] a[q] != a[p] }";
    let map = |n: usize| {
        let rows: String = (0..n).map(|_| format!("\"{}\" ", ".".repeat(n))).collect();
        format!(
            "system M = grid {{ {rows} }} {{ label start = x == 0 & y == 0; label goal = x == {0} & y == {0}; }}\n\
             objective o = action_robust(start, goal, goal, {1});",
            n - 1,
            2 * n
        )
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let texts = [
        ("booleans", booleans(30)),
        ("labels", labels(40)),
        ("nested", nested(20)),
        ("wide", wide.to_owned()),
        ("map", map(1000)),
    ];
    let files = texts.map(|(name, text)| {
        let file = folder.path().join(format!("{name}.hp"));
        fs::write(&file, text).expect("writable");
        file
    });
    (folder, files.to_vec())
}

fn start(arguments: &[&str]) -> Child {
    let mut command: Command = command(arguments);
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it was built")
}

/// How a command ends, and what it says; one that takes far too long is a failure.
fn end(mut child: Child, what: &str) -> (Option<i32>, Option<i32>, String) {
    let begin = Instant::now();
    let mut pipe = child.stderr.take().expect("piped");
    let reader = std::thread::spawn(move || {
        let mut said = String::new();
        pipe.read_to_string(&mut said).map(|_| said)
    });
    loop {
        if let Some(status) = child.try_wait().expect("ours") {
            let said = reader.join().expect("it reads").unwrap_or_default();
            return (status.code(), status.signal(), said);
        }
        if begin.elapsed() > LONG {
            let _ = child.kill();
            panic!("{what} goes on");
        }
        sleep(Duration::from_millis(10));
    }
}

#[test]
fn every_command_keeps_its_deadline() {
    let (_folder, files) = giants();
    for file in &files {
        for arguments in [
            &["solve"][..],
            &["check"],
            &["emit"],
            &["horizon"],
            &["plot"],
            &["verify", "--actions", "p=u,u,u"],
            &["solve", "--quantifiers", "cegis"],
            &["solve", "--quantifiers", "explicit"],
        ] {
            let all = [arguments, &[text(file), "--timeout", TIMEOUT]].concat();
            let (code, signal, said) = end(start(&all), &all.join(" "));
            assert!(signal.is_none() && matches!(code, Some(0..=3)), "{all:?}: {code:?} {signal:?} {said}");
        }
    }
}

#[test]
fn memory_that_is_spent_is_no_crash() {
    let (_folder, files) = giants();
    for file in &files {
        let all = ["solve", text(file), "--memory", "60", "--timeout", "5"];
        let (code, signal, said) = end(start(&all), &all.join(" "));
        assert!(signal.is_none() && matches!(code, Some(0..=3)), "{all:?}: {code:?} {signal:?} {said}");
    }
}

#[test]
fn signals_end_every_command_with_their_status() {
    let (_folder, files) = giants();
    for file in &files {
        for (command, signal, status) in [("solve", "INT", 130), ("check", "TERM", 143), ("emit", "INT", 130)]
        {
            let child = start(&[command, text(file), "--timeout", "60"]);
            sleep(Duration::from_millis(300));
            let sent = Command::new("kill").arg(format!("-{signal}")).arg(child.id().to_string()).status();
            let what = format!("{command} {}", file.display());
            let (code, killed, said) = end(child, &what);
            // One that was done before the signal came has an answer.
            let done = sent.is_ok_and(|sent| !sent.success()) || matches!(code, Some(0..=3));
            assert!(done || (code == Some(status) && killed.is_none()), "{what}: {code:?} {killed:?} {said}");
        }
    }
}

#[test]
fn a_long_search_says_how_far_it_is() {
    let (_folder, files) = giants();
    let nested = text(&files[2]);
    let (code, _, said) = end(start(&["solve", nested, "-v", "--timeout", "3"]), "solve");
    assert_eq!(code, Some(3), "{said}");
    for words in ["after 1 s: ", "after 2 s: "] {
        assert!(said.contains(words), "{said}");
    }
    let (code, _, said) = end(start(&["solve", nested, "--quiet", "--timeout", "2"]), "solve");
    assert_eq!((code, said.contains("after")), (Some(3), false), "{said}");
}

/// A first candidate wins but where q begins in 2; for that, 13 pigeons would have to fit into 12 holes, which takes long to
/// refute.
fn pigeons() -> String {
    let mut apart = Vec::new();
    for hole in 0..12 {
        for (first, second) in (0..13).flat_map(|second| (0..second).map(move |first| (first, second))) {
            apart.push(format!("!(F[{first},{first}] h[p] == {hole} & F[{second},{second}] h[p] == {hole})"));
        }
    }
    format!(
        "system Holes {{ state h: 0..11; action go; on go {{ h' in 0..11; }} }}
         system Other {{ state s: 0..3; action go; on go {{ }} }}
         objective o {{ exists p: Holes. forall q: Other.
           F[0,12] h[p] == 5 & (s[q] < 2 -> F[0,12] h[p] == 5) & (s[q] == 2 -> {}) }}",
        apart.join(" & ")
    )
}

#[test]
fn a_search_that_is_interrupted_tells_of_a_candidate_that_comes_close() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("pigeons.hp");
    fs::write(&file, pigeons()).expect("writable");
    for (format, words) in [
        ("text", "\na candidate for p: it wins against any but q that begins in (s = 2)\np: "),
        ("json", r#""spared":{"starts":[{"path":"q","state":{"s":2}}],"replaced":[]}"#),
    ] {
        let arguments =
            ["solve", text(&file), "-v", "--quantifiers", "cegis", "--timeout", "60", "--format", format];
        let mut child =
            command(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it was built");
        let lines = BufReader::new(child.stderr.take().expect("piped")).lines();
        let met = lines.map_while(Result::ok).find(|line| line.contains("candidates so far"));
        assert!(met.is_some(), "no candidate was met");
        let sent = Command::new("kill").arg("-INT").arg(child.id().to_string()).status();
        assert!(sent.is_ok_and(|sent| sent.success()));
        let mut said = String::new();
        child.stdout.take().expect("piped").read_to_string(&mut said).expect("it is text");
        assert_eq!(child.wait().expect("ours").code(), Some(130), "{said}");
        assert!(said.contains(words), "{said}");
    }
}
