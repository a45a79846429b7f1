//! `plot` and what it writes.

mod common;

use common::{hyperplan, text};
use std::fs;

#[test]
fn figures_and_films_of_all_kinds() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let there = |name: &str| folder.path().join(name);
    let plan = there("plan.json");
    let solved = hyperplan(&["solve", "rooms.hp", "--objective", "isr", "--quiet", "--save", text(&plan)]);
    assert_eq!(solved.status, 0, "{}", solved.stderr);
    let kinds: [(&str, &[u8]); 5] = [
        ("a.svg", b"<svg"),
        ("a.png", b"\x89PNG"),
        ("a.pdf", b"%PDF"),
        ("a.gif", b"GIF89a"),
        ("a.html", b"<!DOCTYPE"),
    ];
    for (name, begins) in kinds {
        let run = hyperplan(&["plot", "rooms.hp", text(&plan), "-o", text(&there(name))]);
        assert_eq!((run.status, run.stdout.as_str(), run.stderr.as_str()), (0, "", ""), "{name}");
        let drawn = fs::read(there(name)).expect("it was drawn");
        assert!(drawn.starts_with(begins), "{name}");
        // The same again.
        hyperplan(&["plot", "rooms.hp", text(&plan), "-o", text(&there(name))]);
        assert!(drawn == fs::read(there(name)).expect("it was drawn"), "{name}");
    }
    let drawn = fs::read_to_string(there("a.svg")).expect("it was drawn");
    assert!(drawn.contains("q: ") && drawn.contains(", the worst of all"), "{drawn}");
    let run = hyperplan(&["plot", "rooms.hp", text(&plan), "-o", text(&there("b.svg")), "--animate"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(fs::read_to_string(there("b.svg")).expect("it was drawn").contains("<animateTransform"));
    let run = hyperplan(&["plot", "rooms.hp", text(&plan), "-o", text(&there("b.png")), "--animate"]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("--animate is for .svg files"), "{}", run.stderr);
    for (output, extension) in [(None, "png"), (Some("c.svg"), "svg")] {
        let frames = there(&format!("frames-{extension}"));
        let mut arguments = vec!["plot", "rooms.hp", text(&plan), "--frames", text(&frames)];
        let output = output.map(there);
        if let Some(output) = &output {
            arguments.extend(["-o", text(output)]);
        }
        let run = hyperplan(&arguments);
        assert_eq!((run.status, run.stdout.as_str(), run.stderr.as_str()), (0, "", ""));
        let count = fs::read_dir(&frames).expect("it was made").count();
        assert!(count >= 3 && frames.join(format!("0000.{extension}")).is_file(), "{count}");
    }
}

#[test]
fn paths_are_chosen() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let plan = folder.path().join("plan.json");
    let solved = hyperplan(&["solve", "rooms.hp", "--objective", "isr", "--quiet", "--save", text(&plan)]);
    assert_eq!(solved.status, 0, "{}", solved.stderr);
    let drawn = |path: &[&str]| hyperplan(&[&["plot", "rooms.hp", text(&plan)][..], path].concat());
    let all = drawn(&[]).stdout;
    assert!(all.starts_with("p (") && all.contains("\nq (") && all.contains("the worst of all"), "{all}");
    let p = drawn(&["--path", "p"]).stdout;
    assert!(p.starts_with("p (") && !p.contains("\nq ("), "{p}");
    let q = drawn(&["--path", "q"]).stdout;
    assert!(q.starts_with("q ("), "{q}");
    let none = drawn(&["--path", "r"]);
    assert_eq!(none.status, 2);
    assert!(none.stderr.contains("isr has no path r; it has p, q"), "{}", none.stderr);
    let bare = hyperplan(&["plot", "rooms.hp", "--path", "p"]);
    assert_eq!(bare.status, 2);
    assert!(bare.stderr.contains("give one"), "{}", bare.stderr);
    let still = hyperplan(&["plot", "rooms.hp", "-o", text(&folder.path().join("a.gif"))]);
    assert_eq!(still.status, 2);
    assert!(still.stderr.contains("nothing moves"), "{}", still.stderr);
}

/// A plan that fails is drawn with what defeats it.
#[test]
fn what_defeats_a_plan_is_drawn() {
    let run =
        hyperplan(&["plot", "rooms.hp", "--objective", "sp", "--actions", "p=up,down,up,right,right,right"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stdout.contains("defeats the strategy"), "{}", run.stdout);
}
