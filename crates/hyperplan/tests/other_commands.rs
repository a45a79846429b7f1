//! `horizon`, `check`, `plot`, `solvers`, `templates`, `new`, `completions`, `man`.

mod common;

use common::{hyperplan, text};

#[test]
fn horizon_explains_itself() {
    let run = hyperplan(&["horizon", "rooms.hp", "--objective", "sp"]);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    assert!(run.stdout.starts_with("sp\n  p  6 steps\n"), "{}", run.stdout);
    assert!(run.stdout.contains("q  5 steps (the paper's rules: 6)"), "{}", run.stdout);
    assert!(run.stdout.contains("!goal[q] U[0,T] goal[p]"), "{}", run.stdout);
}

#[test]
fn horizon_tells_the_semantics() {
    let run = |format: &str| {
        let objective = ["--objective", "late_hpes", "--format", format];
        hyperplan(&[&["horizon", "pass/semantics.hp"], &objective[..]].concat())
    };
    assert_eq!(run("text").stdout, "late_hpes\n  p  3 steps: within 3 semantics hpes\n");
    let json: serde_json::Value = serde_json::from_str(&run("json").stdout).expect("an object");
    assert_eq!(json["semantics"], "hpes");
    // The last that the objective itself reads, not whether the path has halted.
    assert_eq!(json["horizon"]["p"]["reads"], "x[p] == 3");
}

#[test]
fn check_counts() {
    // A small one, so that no question runs out of time on a busy machine.
    let run = hyperplan(&["check", "pass/template.hp"]);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    assert_eq!(run.stdout, "pass/template.hp: 1 system, 1 objective, no warnings\n");
}

#[test]
fn check_as_json() {
    let run = hyperplan(&["check", "fail/several-errors.hp", "--format", "json"]);
    assert_eq!((run.status, run.stderr.as_str()), (2, ""));
    let lines = run.json();
    assert_eq!(lines.len(), 4, "a line for each error");
    let error = &lines[1];
    let expected = serde_json::json!({
        "file": "fail/several-errors.hp", "severity": "error", "code": "unknown-name",
        "message": "no label or variable `gaol` in system Rooms",
        "span": error["span"], "label": null, "help": "did you mean `goal`?", "related": [],
    });
    assert_eq!(*error, expected);
    let span = &error["span"];
    let place = ["line", "column", "endLine", "endColumn"].map(|key| span[key].as_u64());
    assert_eq!(place, [14, 43, 14, 47].map(Some));
    let text = std::fs::read_to_string(common::specs().join("fail/several-errors.hp")).expect("readable");
    let offset = |key: &str| usize::try_from(span[key].as_u64().expect("a number")).expect("small");
    assert_eq!(&text[offset("start")..offset("end")], "gaol");
    let sound = hyperplan(&["check", "case-studies/iso-10.hp", "--format", "json"]);
    assert_eq!((sound.status, sound.stdout.as_str()), (0, ""));
}

#[test]
fn check_prints_the_file_formatted() {
    let run = hyperplan(&["check", "--print", "rooms.hp"]);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    assert!(run.stdout.starts_with("// The 3 x 2 rooms of the paper's Figure 5"), "{}", run.stdout);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("rooms.hp");
    std::fs::write(&file, &run.stdout).expect("written");
    assert_eq!(hyperplan(&["check", "--print", text(&file)]).stdout, run.stdout);
    let run = hyperplan(&["check", "--print", "fail/unknown-label.hp"]);
    assert_eq!((run.status, run.stdout.as_str()), (2, ""));
    assert!(run.stderr.contains("gaol"), "{}", run.stderr);
}

#[test]
fn check_denies_warnings_where_asked() {
    for (file, status) in [("pass/check-unused.hp", 2), ("case-studies/iso-10.hp", 0)] {
        assert_eq!(hyperplan(&["check", file]).status, 0, "{file}");
        assert_eq!(hyperplan(&["check", "--deny-warnings", file]).status, status, "{file}");
        assert_eq!(hyperplan(&["check", "-D", "--quiet", file]).status, status, "{file}");
    }
}

#[test]
fn check_says_what_it_had_no_time_for() {
    let hurried = ["check", "case-studies/iso-20.hp", "--timeout", "0.000001", "--format", "json"];
    let run = hyperplan(&hurried);
    assert_eq!((run.status, run.stdout.as_str()), (0, ""));
    assert!(run.stderr.contains("there was no time for it"), "{}", run.stderr);
    let run = hyperplan(&[&hurried[..], &["-v"]].concat());
    assert_eq!(run.json()[0]["code"], "undecided");
    // What was not decided is no reason to refuse.
    let run = hyperplan(&["check", "case-studies/iso-20.hp", "--timeout", "0.000001", "-D", "-v"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.contains("no time was left"), "{}", run.stderr);
    assert!(run.stdout.contains("undecided)"), "{}", run.stdout);
}

#[test]
fn check_as_json_has_the_warnings() {
    let run = hyperplan(&["check", "pass/check-demand.hp", "--format", "json"]);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    let warnings = run.json();
    assert_eq!(warnings.len(), 1);
    let warning = &warnings[0];
    assert_eq!((&warning["severity"], &warning["span"]["line"]), (&"warning".into(), &7.into()));
    assert_eq!(warning["code"], "demanded-of-every-path");
}

/// Every code that a warning of the fixtures has is on the page about them.
#[test]
fn every_warning_is_documented() {
    let page = std::fs::read_to_string(common::specs().join("../docs/checks.md")).expect("the page is there");
    let mut codes = Vec::new();
    for entry in std::fs::read_dir(common::specs().join("pass")).expect("the specs are there") {
        let path = entry.expect("readable").path();
        if path.extension().is_some_and(|e| e == "stderr") {
            let text = std::fs::read_to_string(path).expect("readable");
            let marked = |line: &str| Some(line.strip_prefix("warning[")?.strip_suffix(']')?.to_owned());
            codes.extend(text.lines().filter_map(marked));
        }
    }
    codes.sort_unstable();
    codes.dedup();
    assert!(codes.len() >= 15, "{codes:?}");
    for code in codes {
        assert!(page.contains(&format!("| `{code}` |")), "{code}");
    }
}

#[test]
fn plot_draws_the_bare_map() {
    let run = hyperplan(&["plot", "rooms.hp"]);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    assert!(run.stdout.starts_with("1  .  G  G\n0  S  s  .\n   0  1  2\ns starts\n"), "{}", run.stdout);
    let run = hyperplan(&["plot", "pass/enumerations.hp"]);
    assert_eq!((run.status, run.stdout.as_str()), (2, ""));
    assert!(run.stderr.contains("cannot be drawn"), "{}", run.stderr);
}

#[test]
fn solvers_lists_the_embedded_one() {
    let run = hyperplan(&["solvers"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    for name in ["builtin", "cadical", "batsat"] {
        assert!(run.stdout.lines().any(|line| line.starts_with(&format!("{name} "))), "{}", run.stdout);
    }
    let missing = "this build has no cadical: it takes the cargo feature cadical\n";
    assert_eq!(run.stdout.contains(missing), cfg!(not(feature = "cadical")), "{}", run.stdout);
}

#[test]
fn templates_shows_the_prelude() {
    let run = hyperplan(&["templates"]);
    assert_eq!(run.status, 0);
    for name in [
        "shortest_path",
        "longest_path",
        "initial_state_robust",
        "action_robust",
        "initial_state_opaque",
        "current_state_opaque",
    ] {
        assert!(run.stdout.contains(&format!("template {name}(")), "{name}");
        let one = hyperplan(&["templates", name]);
        assert_eq!(one.status, 0, "{}", one.stderr);
        assert_eq!(one.stdout.matches("template ").count(), 1, "{}", one.stdout);
        assert!(one.stdout.starts_with("//"), "{}", one.stdout);
    }
    assert_eq!(hyperplan(&["templates", "quickest_path"]).status, 2);
}

#[test]
fn a_file_to_begin_with() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("world.hp");
    let name = file.to_str().expect("a name in UTF-8");
    let run = hyperplan(&["new", name]);
    assert_eq!((run.status, run.stdout.as_str()), (0, ""), "{}", run.stderr);
    let written = std::fs::read_to_string(&file).expect("it was written");
    assert!(written.contains(&format!("hyperplan check {name} ")), "{written}");
    let run = hyperplan(&["check", "-D", name]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert_eq!(hyperplan(&["check", "--print", name]).stdout, written);
    for (question, status) in [(&[][..], 0), (&["--set", "T=6"], 1), (&["--minimize", "T"], 0)] {
        let run = hyperplan(&[&["solve", name], question].concat());
        assert_eq!(run.status, status, "{question:?}: {}{}", run.stdout, run.stderr);
    }
    // With the two objectives that stand in comments.
    let (active, others) = written.split_once("// Two more").expect("it has two more");
    let others = others.lines().skip(2).map(|line| line.strip_prefix("//").unwrap_or_default());
    let others = others.take_while(|line| !line.contains("The language"));
    let text = others.fold(active.to_owned(), |text, line| text + line + "\n");
    let all = folder.path().join("all.hp");
    std::fs::write(&all, text).expect("writable");
    let run = hyperplan(&["solve", all.to_str().expect("a name in UTF-8"), "--objective", "all"]);
    assert_eq!((run.status, run.stdout.matches(": realizable").count()), (0, 3), "{run:?}");
    // What somebody wrote meanwhile is not lost.
    let run = hyperplan(&["new", name]);
    assert_eq!((run.status, run.stderr), (2, format!("error: {name} is there already\n")));
    assert_eq!(hyperplan(&["new"]).stdout.replace("FILE", name), written);
}

#[test]
fn completions_and_manual_pages() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let run = hyperplan(&["completions", shell]);
        assert_eq!(run.status, 0, "{}", run.stderr);
        assert!(run.stdout.contains("minimize") && !run.stdout.contains("supervise"), "{shell}");
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let name = folder.path().to_str().expect("a name in UTF-8");
    let run = hyperplan(&["man", "-o", name]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    for (command, page) in [(None, "hyperplan.1"), (Some("solve"), "hyperplan-solve.1")] {
        let page = std::fs::read_to_string(folder.path().join(page)).expect("it was written");
        assert!(page.contains(".SH NAME") && page.contains("hyperplan"), "{page}");
        let run = hyperplan(&[&["man"][..], command.as_slice()].concat());
        assert!(run.status == 0 && run.stdout.contains(".SH SYNOPSIS"), "{}", run.stderr);
    }
    assert!(!folder.path().join("hyperplan-supervise.1").exists());
    assert_eq!(hyperplan(&["man", "nothing"]).status, 2);
}
