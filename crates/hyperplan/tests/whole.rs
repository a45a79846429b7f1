//! What is written is there whole or as it was before, and a full disk is told of. As a disk that is full there is the limit
//! of a file's size: a write beyond it fails like one to a full disk.
#![cfg(unix)]

mod common;

use common::fakes::Fake;
use common::{Run, command, specs, text};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// Runs the command where no file may have more than so many blocks of 512 bytes.
fn limited(blocks: u32, arguments: &[&str]) -> Run {
    let wanted = command(arguments);
    let mut shell = Command::new("sh");
    // A signal would end it.
    shell.args(["-c", &format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"")]);
    shell.arg(wanted.get_program()).args(wanted.get_args()).stdin(Stdio::null()).current_dir(specs());
    shell.envs(wanted.get_envs().filter_map(|(name, value)| Some((name, value?))));
    Run::new(shell.output().expect("every Unix has sh"))
}

fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder is ours").flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        files.push((name, fs::read(entry.path()).expect("a file")));
    }
    files.sort();
    files
}

const SP: [&str; 2] = ["--objective", "sp"];

#[test]
fn a_full_disk_leaves_the_old_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let there = |name: &str| folder.path().join(name);
    for name in ["s.json", "p.svg", "e.smt2"] {
        fs::write(there(name), "old").expect("ours");
    }
    let before = files(folder.path());
    let rooms = specs().join("rooms.hp");
    for (name, arguments) in [
        ("s.json", &["solve", text(&rooms), "--save"][..]),
        ("p.svg", &["solve", text(&rooms), "--plot"]),
        ("p.svg", &["plot", text(&rooms), "-o"]),
        ("e.smt2", &["emit", text(&rooms), "-o"]),
    ] {
        let run = limited(0, &[arguments, &[text(&there(name))], &SP].concat());
        assert_eq!(run.status, 2, "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(&format!("cannot write {}", text(&there(name)))), "{}", run.stderr);
        assert_eq!(files(folder.path()), before, "{arguments:?}");
    }
    // What was found is told all the same.
    let run = limited(0, &[&["solve", text(&rooms), "--save", text(&there("s.json"))][..], &SP].concat());
    assert!(run.stdout.contains("sp: realizable"), "{}", run.stdout);
    for (folder, arguments) in [
        (there("new.hp"), &["new"][..]),
        (there("pages"), &["man", "--output"]),
        (there("bench"), &["emit", "--family"]),
    ] {
        let run = limited(0, &[arguments, &[text(&folder)]].concat());
        assert_eq!(run.status, 2, "{arguments:?}: {}", run.stderr);
    }
    assert_eq!(files(&there("pages")), []);
    fs::remove_dir(there("pages")).expect("it is empty");
    fs::remove_dir_all(there("bench")).expect("ours");
    assert_eq!(files(folder.path()), before);
}

#[test]
fn queries_are_kept_or_it_is_an_error() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let queries = folder.path().join("queries");
    let z3 = Fake::replying("*check-sat*) echo unsat;;");
    let file = Fake::new("[ -s \"$1\" ] && echo unsat");
    let one_shot = format!("{} {{file}}", file.program().display());
    // More than the buffer, and less.
    for steps in ["T=2", "T=40"] {
        for solver in ["builtin", text(&z3.program())] {
            for quantifiers in ["expand", "cegis"] {
                let options = ["--solver", solver, "--quantifiers", quantifiers, "--set", steps];
                let queries = ["solve", "rooms.hp", "--queries", text(&queries)];
                let run = limited(0, &[&queries[..], &SP, &options].concat());
                assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{options:?}: {}", run.stderr);
                assert!(run.stderr.contains("cannot keep queries in"), "{options:?}: {}", run.stderr);
            }
        }
    }
    assert_eq!(files(&queries), []);
    // Not what the program gets, which is larger than what is said of it: so the limit is that of the query.
    let run = limited(
        0,
        &[&["solve", "rooms.hp", "--quantifiers", "expand", "--solver", &one_shot][..], &SP].concat(),
    );
    assert_eq!(run.status, 4, "{}", run.stderr);
}

#[test]
fn reports_are_whole() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("out");
    let compare = ["compare", "rooms.hp", "--objective", "sp", "--solver", "builtin", "--out", text(&out)];
    let run = limited(u32::MAX, &compare);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let before = files(&out);
    let tampered: Vec<_> = before.iter().map(|(name, _)| name.clone()).collect();
    // The log fits, and the page does not.
    let run = limited(8, &["compare", "--out", text(&out)]);
    assert_eq!(run.status, 2, "{}", run.stderr);
    assert!(run.stderr.contains("cannot write the reports in"), "{}", run.stderr);
    let after = files(&out);
    assert_eq!(after.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>(), tampered);
    assert_eq!(after, before);
    // A run that cannot be noted is no run.
    let new = folder.path().join("new");
    let run = limited(0, &[&compare[..7], &[text(&new)]].concat());
    assert_eq!(run.status, 2, "{}", run.stderr);
    let exec = folder.path().join("exec");
    let run = limited(0, &[&compare[..6], &["--benchexec", text(&exec)]].concat());
    assert_eq!(run.status, 2, "{}", run.stderr);
    assert!(!exec.join("hyperplan.xml").exists());
}

/// Two robots, of which one has no place in the plane.
const MIXED: &str = "system W = grid { \"S.G\" } { }
system L { state on: bool; action push, wait; on push { on' = !on; } on wait {} init !on; }
objective both { exists p: W, q: L. start[p] & F[0,3] goal[p] & F[0,3] on[q] }
objective neither { exists q: L. F[0,3] on[q] }
";

#[test]
fn what_can_be_drawn_is_drawn() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let there = |name: &str| folder.path().join(name);
    fs::write(there("m.hp"), MIXED).expect("ours");
    let (file, saved) = (there("m.hp"), there("s.json"));
    let run = |arguments: &[&str]| Run::new(command(arguments).output().expect("the command was built"));
    let solve = |objective: &str, options: &[&str]| {
        run(&[&["solve", text(&file), "--save", text(&saved), "--objective", objective], options].concat())
    };
    for (picture, map) in [("p.svg", "class=\"path\""), ("p.txt", "→")] {
        let solved = solve("both", &["--plot", text(&there(picture))]);
        assert_eq!(solved.status, 0, "{}", solved.stderr);
        let drawn = fs::read_to_string(there(picture)).expect("it was drawn");
        let said = if map == "→" { ["q (3 steps)", "time  action"] } else { ["q: 3 steps", "timeline"] };
        for words in [map, said[0], said[1], "push", "true"] {
            assert!(drawn.contains(words), "{words} in {drawn}");
        }
        let plotted = run(&["plot", text(&file), text(&saved), "-o", text(&there("again"))]);
        assert_eq!(plotted.status, 2, "{}", plotted.stderr);
        // The text of `solve` has the same.
        assert!(solved.stdout.contains("→") && solved.stdout.contains("time  action"), "{}", solved.stdout);
    }
    let plotted = run(&["plot", text(&file), text(&saved)]);
    assert!(plotted.stdout.contains('→') && plotted.stdout.contains("time  action"), "{}", plotted.stdout);
    let before = files(folder.path());
    // What cannot be is refused before anything is found.
    let refused = |picture: &Path| {
        let run = solve("neither", &["--plot", text(picture)]);
        assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{}", run.stderr);
        run.stderr
    };
    assert!(refused(&there("n.jpg")).contains("only .svg, .png"));
    assert!(refused(&there("none/n.svg")).contains("there is no directory"));
    assert!(refused(folder.path()).contains("cannot"));
    assert_eq!(files(folder.path()), before);
    // Of several objectives each has a file.
    let all = solve("all", &["--plot", text(&there("a.svg"))]);
    assert_eq!(all.status, 0, "{}", all.stderr);
    assert!(there("a-both.svg").is_file() && there("a-neither.svg").is_file());
}
