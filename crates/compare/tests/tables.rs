//! Tables and CSV against golden files; `UPDATE=1` writes these anew.

mod sample;

use std::collections::BTreeMap;
use std::path::Path;
use std::{env, fs};

use hyperplan_compare::contest::Contest;
use hyperplan_compare::latex::latex;
use hyperplan_compare::report::write_all;
use hyperplan_compare::table::{Sheet, sheets};
use hyperplan_compare::{Record, RunStatus, summary};
use sample::{run, sample};

fn golden(name: &str, actual: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    if env::var_os("UPDATE").is_some() {
        fs::write(&path, actual).expect("the golden file can be written");
    }
    let expected = fs::read_to_string(&path).expect("the golden file is there; UPDATE=1 writes it");
    assert_eq!(actual, expected, "{name}");
}

#[test]
fn files() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let written = write_all(&sample(), dir.path()).expect("a folder that can be written");
    for name in ["runs.csv", "table.md", "table.tex", "instances.md", "instances.tex", "scores.json"] {
        let path = dir.path().join(name);
        assert!(written.contains(&path), "{name}");
        golden(name, &fs::read_to_string(path).expect("what was written can be read"));
    }
    let json = fs::read(dir.path().join("runs.json")).expect("what was written can be read");
    let read: Vec<Record> = serde_json::from_slice(&json).expect("records");
    assert_eq!(read, sample());
}

#[test]
fn terminal() {
    golden("summary.txt", &summary(&sample(), None));
    assert_eq!(summary(&[], None), "no runs\n");
}

/// Tables fit, and what is not shown is said; only where the terminal is too narrow for anything do lines get longer.
#[test]
fn narrow_terminals() {
    let records: Vec<Record> = (0..12)
        .flat_map(|c| (0..5).map(move |i| (c, i)))
        .map(|(c, i)| run(&format!("solver-{c}"), &format!("specs/{i}.hp#o"), RunStatus::Sat, 1.0))
        .collect();
    let longest = |text: &str| {
        let tables = text.split("Order:").next().unwrap_or_default();
        tables.lines().map(|line| line.chars().count()).max().unwrap_or(0)
    };
    let whole = summary(&records, None);
    assert_eq!(summary(&records, Some(1000)), whole);
    assert!(longest(&whole) > 130 && !whole.contains("report.html"), "{whole}");
    let narrow = summary(&records, Some(80));
    assert!(narrow.contains("\nand 7 more; report.html has all\n"), "{narrow}");
    assert!(longest(&narrow) <= 80 && longest(&narrow) > 70, "{narrow}");
    let narrower = summary(&records, Some(50));
    assert!(
        narrower.contains("Not shown here, but in report.html: fastest, counted, CPU, unique.\n"),
        "{narrower}"
    );
    assert!(longest(&narrower) <= 50 + 20, "{narrower}");
    assert!(summary(&records, Some(0)).contains("and 11 more; report.html has all"));
}

#[test]
fn names_that_break_lines() {
    let nasty = "a\nb\u{1b}[31m\r|c";
    let mut records = [run(nasty, nasty, RunStatus::Sat, 1.0), run("z3", nasty, RunStatus::Unsat, 1.0)];
    for (record, family) in records.iter_mut().zip([nasty, "b\nc"]) {
        record.set = vec![nasty.to_owned()];
        record.family = family.to_owned();
        record.message = Some("first\nsec\rond".to_owned());
        record.queries = Some(nasty.to_owned());
    }
    let dir = tempfile::tempdir().expect("a temporary folder");
    write_all(&records, dir.path()).expect("a folder that can be written");
    let read = |name: &str| fs::read_to_string(dir.path().join(name)).expect("it was written");
    assert_eq!(read("runs.csv").lines().count(), 3);
    for text in
        [read("runs.csv"), read("table.md"), read("instances.md"), read("table.tex"), summary(&records, None)]
    {
        assert!(!text.contains(['\r', '\u{1b}']), "{text}");
        assert!(!text.lines().any(|line| line.starts_with(['b', '[']) || line.starts_with("sec")), "{text}");
    }
    assert_eq!(read("instances.md").lines().count(), 4);
    assert!(read("runs.csv").contains(r"a\nb\u{1b}[31m\r|c"));
    // What is for programs is as it was.
    let same: Vec<Record> = serde_json::from_str(&read("runs.json")).expect("records");
    assert_eq!(same, records);
}

/// A spreadsheet takes no text for a formula, and numbers for numbers.
#[test]
fn text_is_no_formula() {
    let cells = |record: &Record| {
        let mut csv = Vec::new();
        hyperplan_compare::table::csv(std::slice::from_ref(record), &mut csv).expect("in memory");
        let text = String::from_utf8(csv).expect("it is text");
        let (head, row) = text.split_once('\n').expect("two lines");
        head.split(',')
            .map(str::to_owned)
            .zip(row.trim_end().split(',').map(str::to_owned))
            .collect::<BTreeMap<_, _>>()
    };
    for begin in ["=", "+", "-", "@", "＝", "＋", "－", "＠", "\t=", "\r=", "\n=", "'="] {
        let mut record = run(&format!("{begin}solver"), &format!("{begin}1"), RunStatus::Error, 1.0);
        record.family = format!("{begin}cmd|' /C calc'!A0");
        record.message = Some(format!("{begin}2"));
        record.version = Some(format!("{begin}3"));
        record.options = format!("{begin}o");
        record.set = vec![format!("{begin}T=1"), "U=2".to_owned()];
        record.exit_code = Some(-7);
        record.wall_s = -0.5;
        let cells = cells(&record);
        for name in ["instance", "solver", "family", "message", "version", "options", "set"] {
            let safe = |c: char| c.is_ascii_alphanumeric() || c == '\'' || c == '\\';
            assert!(cells[name].starts_with(safe), "{name}: {}", cells[name]);
            let begin = hyperplan_outlet::one_line(begin);
            assert!(
                cells[name].trim_start_matches('\'').starts_with(begin.trim_start_matches('\'')),
                "{}",
                cells[name]
            );
        }
        assert_eq!((cells["exit_code"].as_str(), cells["wall_s"].as_str()), ("-7", "-0.5"));
    }
}

/// Nothing to show is shown.
#[test]
fn odd_ones() {
    let none = [run("z3", "a", RunStatus::Timeout, 0.0)];
    let unsupported = [run("z3", "a", RunStatus::Unsupported, 0.0)];
    let mut infinite =
        [run("z3", "a", RunStatus::Sat, f64::NAN), run("cvc5", "a", RunStatus::Sat, f64::INFINITY)];
    infinite[0].limit.wall_s = Some(f64::NAN);
    for records in [&[] as &[Record], &none, &unsupported, &infinite] {
        let dir = tempfile::tempdir().expect("a temporary folder");
        write_all(records, dir.path()).expect("a folder that can be written");
        assert!(!summary(records, None).is_empty());
    }
}

/// Contestants that count on nothing have no place in a family, nor do they push others back.
#[test]
fn families_without_what_does_not_count() {
    let mut wrong = run("z3", "a/x", RunStatus::Unsat, 1.0);
    wrong.family = "a".to_owned();
    wrong.expected = Some(hyperplan_compare::Answer::Sat);
    let other = |solver: &str, status| Record { family: "b".to_owned(), ..run(solver, "b/x", status, 1.0) };
    let absent = Record { family: "a".to_owned(), ..run("builtin", "a/x", RunStatus::Unsupported, 0.0) };
    let records = [wrong, absent, other("z3", RunStatus::Sat), other("builtin", RunStatus::Sat)];
    let sheets = sheets(&Contest::new(&records));
    let places = |i: usize| -> Vec<String> {
        sheets[i].rows.iter().map(|row| format!("{} {}", row[0], row[1])).collect()
    };
    assert_eq!((sheets[1].caption.as_str(), places(1)), ("a", vec!["1 z3".to_owned()]));
    assert_eq!(places(2), ["1 builtin", "1 z3", " virtual best"]);
}

#[test]
fn brackets_are_no_argument_of_a_line_end() {
    let row = |name: &str| vec![name.to_owned(), "1".to_owned()];
    let head = row("instance");
    let sheet = Sheet { head, text: vec![true, false], rows: vec![row("[a]"), row("*")], ..Sheet::default() };
    let text = latex(&sheet);
    assert!(text.contains("  {}[a] & 1 \\\\\n  {}* & 1 \\\\\n"), "{text}");
}

#[test]
fn plots_of_an_earlier_report_go() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let names = || -> Vec<String> {
        let entries = fs::read_dir(dir.path()).expect("ours").flatten();
        let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        names.filter(|name| name.starts_with("scatter") || name.starts_with('.')).collect()
    };
    fs::write(dir.path().join("scatter.svg"), "somebody's").expect("ours");
    let of = ["z3", "cvc5"].map(|solver| run(solver, "a", RunStatus::Sat, 1.0));
    write_all(&of, dir.path()).expect("a folder that can be written");
    assert_eq!(names().len(), 2);
    write_all(&of[..1], dir.path()).expect("a folder that can be written");
    assert_eq!(names(), ["scatter.svg"]);
}
