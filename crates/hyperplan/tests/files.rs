//! What is no problem file, and what is no usage.

mod common;

use common::{hyperplan, hyperplan_with, specs, text};

#[test]
fn files_that_are_no_problem() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).expect("writable");
        path
    };
    let binary = write("binary.hp", &[0x7f, b'E', b'L', b'F', 0, 0, 0xff, 0xfe]);
    let zeros = write("zeros.hp", &[0; 64]);
    let empty = write("empty.hp", b"");
    for command in ["solve", "check", "horizon", "emit", "plot"] {
        for (file, message) in [
            ("nowhere.hp", "there is no such file"),
            (text(folder.path()), "it is a directory"),
            (text(&binary), "it is not a text file"),
            (text(&zeros), "this is not a text file"),
            (text(&empty), "empty"),
        ] {
            let run = hyperplan(&[command, file]);
            assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{command} {file}: {}", run.stderr);
            assert!(run.stderr.contains(message) && run.stderr.contains(file), "{command}: {}", run.stderr);
        }
    }
}

/// What has no end, and what waits for a writer, is refused wherever a file is named.
#[cfg(unix)]
#[test]
fn devices_and_pipes_are_no_files() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (pipe, rooms) = (folder.path().join("pipe"), specs().join("rooms.hp"));
    let made = std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo is there");
    assert!(made.success());
    let map = folder.path().join("map.hp");
    let objective = "objective o { exists p. F[0,1] x[p] == 0 }";
    for special in [text(&pipe), "/dev/zero", "/dev/null"] {
        std::fs::write(&map, format!("system M = grid({special:?}) {{ }} {objective}")).expect("writable");
        for arguments in [
            &["solve", special][..],
            &["check", special],
            &["check", text(&map)],
            &["verify", text(&rooms), special],
            &["verify", text(&rooms), "--objective", "sp", "--model", special],
            &["plot", text(&rooms), special],
            &["compare", special],
        ] {
            let run = hyperplan(arguments);
            assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{arguments:?}: {}", run.stderr);
            assert!(run.stderr.contains("it is no regular file"), "{arguments:?}: {}", run.stderr);
        }
    }
}

#[test]
fn standard_input_is_a_file_and_byte_order_marks_are_left_out() {
    let rooms = std::fs::read_to_string(specs().join("rooms.hp")).expect("it is there");
    let marked = format!("\u{feff}{rooms}");
    for input in [&rooms, &marked] {
        let run = hyperplan_with(&["solve", "-", "--objective", "sp", "--format", "json"], input);
        assert_eq!(run.status, 0, "{}", run.stderr);
        let rooms = specs().join("rooms.hp");
        let verified = hyperplan_with(&["verify", text(&rooms), "-"], &run.stdout);
        assert_eq!(verified.status, 0, "{}", verified.stderr);
    }
    let run = hyperplan_with(&["check", "-"], "system");
    assert!(run.status == 2 && run.stderr.contains("-:1:"), "{}", run.stderr);
}

#[test]
fn bad_usage() {
    for arguments in [
        &["frobnicate"][..],
        &["solve"],
        &["solve", "rooms.hp", "--frobnicate"],
        &["solve", "rooms.hp", "--set", "T"],
        &["solve", "rooms.hp", "--states", "wild"],
        &["solve", "rooms.hp", "--timeout", "soon"],
        &["check", "rooms.hp", "--quiet", "-v"],
        &["verify", "rooms.hp"],
    ] {
        let run = hyperplan(arguments);
        assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{arguments:?}");
        assert!(run.stderr.starts_with("error: "), "{arguments:?}: {}", run.stderr);
    }
    assert_eq!(hyperplan(&[]).status, 2);
}

#[test]
fn help_and_version_are_no_failure() {
    let version = hyperplan(&["--version"]);
    assert_eq!((version.status, version.stderr.as_str()), (0, ""));
    assert_eq!(version.stdout, format!("hyperplan {}\n", env!("CARGO_PKG_VERSION")));
    let help = hyperplan(&["solve", "--help"]);
    assert_eq!((help.status, help.stderr.as_str()), (0, ""));
    assert!(help.stdout.contains("--quantifiers"));
}

#[test]
fn constants_can_be_set() {
    let horizon = |set: &str| {
        hyperplan(&["horizon", "rooms.hp", "--objective", "sp", "--format", "json", "--set", set])
    };
    assert_eq!(horizon("T=9").json()[0]["horizon"]["p"]["steps"], 9);
    let unknown = horizon("U=9");
    assert_eq!((unknown.status, unknown.stdout.as_str()), (2, ""), "{}", unknown.stderr);
    assert!(unknown.stderr.contains('U'), "{}", unknown.stderr);
    for bad in ["T=-1", "T=many", "T=1000000", "T=99999999999999999999"] {
        let run = horizon(bad);
        assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{bad}: {}", run.stderr);
    }
}
