//! Comparisons: what is run, what is not run again, and what is said of it.
#![cfg(unix)]

mod common;

use common::compare::Comparison;
use common::fakes::{FALSE, Fake};
use common::{Run, specs, text};
use std::fs;
use std::io::Write as _;

const ANSWER: &str = "cat > /dev/null; echo";

#[test]
fn solvers_and_encodings_over_a_problem() {
    let comparison = Comparison::new();
    let rooms = specs().join("rooms.hp");
    let run = comparison.run(&[
        text(&rooms),
        "--objective=sp,iso",
        "--solver=builtin",
        "--quantifiers=cegis,expand,cegis",
        "--set=T=1,6",
        "--seed=0,1",
    ]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let records = comparison.records();
    assert_eq!(records.len(), 2 * 2 * 2 * 2);
    for record in &records {
        // One step is not enough to reach the goal.
        let status = if record["set"][0] == "T=1" { "unsat" } else { "sat" };
        assert_eq!(record["status"], status, "{record}");
        assert_eq!(record["verified"].as_str(), (status == "sat").then_some("by-search"), "{record}");
        // What has no alternation is one query either way.
        assert!(
            ["cegis", "expand"].contains(&record["quantifiers_used"].as_str().expect("it says so")),
            "{record}"
        );
        assert_eq!(
            (&record["states"], &record["states_used"]),
            (&"auto".into(), &"onehot".into()),
            "{record}"
        );
        let measured = ["wall_s", "cpu_s", "memory_mib"].map(|name| record[name].as_f64().expect("a number"));
        assert!(measured[0] > 0.0 && measured[2] > 1.0, "{record}");
        assert_eq!(record["limit"]["wall_s"], 60.0);
        assert!(record["version"].as_str().is_some_and(|version| {
            let version = version.to_lowercase();
            version.contains("batsat") || version.contains("cadical")
        }));
    }
    assert!(run.stderr.contains("[16/16] "), "{}", run.stderr);
    assert!(run.stdout.contains("builtin"), "{}", run.stdout);
    for name in ["runs.csv", "runs.json", "report.html"] {
        assert!(comparison.out().join(name).is_file(), "{name}");
    }
    // What went well leaves nothing.
    assert!(!comparison.out().join("evidence").exists());
    // The same from the log alone, with other runs in it.
    comparison.run(&[text(&rooms), "--objective=sp", "--solver=builtin", "--repeat=2"]);
    let again = comparison.run(&[]);
    assert_eq!(again.status, 0, "{}", again.stderr);
    let all: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(comparison.out().join("runs.json")).expect("it is there"))
            .expect("it is JSON");
    assert_eq!(all.as_array().map(Vec::len), Some(16 + 2));
}

#[test]
fn what_is_done_is_not_done_again() {
    let comparison = Comparison::new();
    let files = comparison.queries(3);
    let fake = Fake::new(&format!("{ANSWER} sat"));
    let solver = format!("--solver='{}'", fake.program().display());
    let run = |options: &[&str]| {
        let run = comparison.run(&[&[text(&files), &solver], options].concat());
        assert_eq!(run.status, 0, "{}", run.stderr);
        (fake.begun(), run.stderr)
    };
    assert_eq!(run(&[]).0, 3);
    let (begun, said) = run(&[]);
    assert!(begun == 3 && said.contains("note: 3 of 3 runs were done before"), "{said}");
    // A file that has changed.
    let log = comparison.log();
    fs::write(files.join("1.smt2"), "(set-info :status sat)(check-sat)").expect("ours");
    assert_eq!(run(&[]).0, 4);
    assert_eq!(comparison.records()[3]["expected"], "sat");
    // What was written before stays as it was.
    assert!(comparison.log().starts_with(&log));
    // Other limits, seeds, repetitions.
    assert_eq!(run(&["--timeout=50"]).0, 7);
    assert_eq!(run(&["--seed=1"]).0, 10);
    assert_eq!(run(&["--repeat=2", "--jobs=2"]).0, 13);
    assert_eq!(run(&["--repeat=2"]).0, 13);
    // A line that was torn.
    let log = comparison.log();
    fs::write(comparison.out().join("runs.jsonl"), &log[..log.len() - 100]).expect("ours");
    let (begun, said) = run(&["--repeat=2"]);
    assert!(
        begun == 14 && said.contains("runs.jsonl:13: the line is incomplete; its run is done again"),
        "{said}"
    );
    assert_eq!(run(&["--repeat=2"]).0, 14);
    assert_eq!(comparison.records().len(), 13);
    // Another build of a solver that has no version; the same program of another time is none.
    let mut program = fs::OpenOptions::new().append(true).open(fake.program()).expect("ours");
    program.set_modified(std::time::SystemTime::UNIX_EPOCH).expect("ours");
    assert_eq!(run(&[]).0, 14);
    program.write_all(b"# another build\n").expect("ours");
    drop(program);
    assert_eq!(run(&[]).0, 17);
}

#[test]
fn a_map_that_changes_is_read_again() {
    let comparison = Comparison::new();
    let maps = specs().join("case-studies/maps");
    let files = comparison.folder().join("problems");
    fs::create_dir_all(files.join("maps")).expect("ours");
    fs::copy(specs().join("case-studies/sp-10.hp"), files.join("sp-10.hp")).expect("it is there");
    for map in fs::read_dir(maps).expect("it is there").flatten() {
        fs::copy(map.path(), files.join("maps").join(map.file_name())).expect("ours");
    }
    let arguments = [text(&files), "--solver=builtin"];
    comparison.run(&arguments);
    assert_eq!(comparison.records().len(), 1, "{}", comparison.run(&arguments).stderr);
    for map in fs::read_dir(files.join("maps")).expect("ours").flatten() {
        let map = map.path();
        let changed = fs::read_to_string(&map).expect("ours") + "\n";
        fs::write(map, changed).expect("ours");
    }
    comparison.run(&arguments);
    let records = comparison.records();
    assert_eq!(records.len(), 2);
    assert_eq!(records[0]["sha256"], records[1]["sha256"]);
}

#[test]
fn a_file_is_run_once_whatever_it_is_called() {
    let comparison = Comparison::new();
    let files = comparison.queries(2);
    let fake = Fake::new(&format!("{ANSWER} unknown"));
    let solver = format!("--solver='{}'", fake.program().display());
    let (first, pattern) = (files.join("../queries/0.smt2"), files.join("*.smt2"));
    let run = comparison.run(&[text(&first), text(&files), text(&pattern), text(&first), &solver]);
    assert_eq!((run.status, fake.begun()), (0, 2), "{}", run.stderr);
    // Once under the name that came first.
    assert!(comparison.records()[0]["instance"].as_str().is_some_and(|name| name.contains("..")));
    let twice = format!("{solver},'{}'", fake.program().display());
    assert_eq!(comparison.run(&[text(&first), text(&files), &twice]).status, 0);
    assert_eq!(fake.begun(), 2);
}

#[test]
fn disagreements_come_first() {
    let comparison = Comparison::new();
    let files = comparison.queries(2);
    let (sat, unsat) =
        (Fake::called("good", &format!("{ANSWER} sat")), Fake::called("bad", &format!("{ANSWER} unsat")));
    let solvers = format!("--solver='{}','{}'", sat.program().display(), unsat.program().display());
    let run = comparison.run(&[text(&files), &solvers]);
    assert_eq!(run.status, 4, "{}", run.stderr);
    let first = run.stdout.lines().next().expect("there is output");
    assert!(first.contains("0.smt2: solvers disagree"), "{}", run.stdout);
    // Nothing is run again, and the judgement is the same.
    let again = comparison.run(&[text(&files), &solvers]);
    assert_eq!((again.status, again.stdout), (4, run.stdout));
    assert_eq!(sat.begun(), 2);
}

#[test]
fn solvers_get_files_with_the_seed_and_without_the_status() {
    let comparison = Comparison::new();
    let files = comparison.queries(0);
    let query = "(set-info :status sat) (declare-const x Bool)\n(assert x) (check-sat)\n";
    fs::write(files.join("a.smt2"), query).expect("ours");
    let kept = comparison.folder().join("got");
    // z3 gets its query as a file, yices on its standard input.
    let solver = |name: &str, file: &str| {
        let kept = kept.display();
        let body =
            format!("[ \"$1\" = --version ] && echo {name} 1.0 || {{ cat {file} >> '{kept}'; echo sat; }}");
        Fake::called(name, &body)
    };
    let (z3, yices) = (solver("z3", "\"$1\""), solver("yices-smt2", ""));
    let mut command = comparison.command(&[text(&files), "--solver=z3,yices", "--seed=0,7"]);
    command.env("HYPERPLAN_Z3", z3.program()).env("HYPERPLAN_YICES", yices.program());
    let run = Run::new(command.output().expect("the command was built for this test"));
    assert_eq!(run.status, 0, "{}", run.stderr);
    let without = query.replace("(set-info :status sat)", &" ".repeat("(set-info :status sat)".len()));
    let seeded = format!("(set-option :random-seed 7)\n{without}");
    assert_eq!(
        fs::read_to_string(&kept).expect("it was written"),
        [&without[..], &without, &seeded, &seeded].concat()
    );
    assert_eq!(fs::read_to_string(files.join("a.smt2")).expect("ours"), query);
    assert!(!comparison.out().join("evidence").exists());
}

#[test]
fn what_a_problem_file_says_of_its_objectives() {
    let comparison = Comparison::new();
    let files = comparison.queries(0);
    let rooms = fs::read_to_string(specs().join("rooms.hp")).expect("it is there");
    let sp = "// sp: realizable\n";
    assert!(rooms.contains(sp));
    let wrong = rooms.replace(sp, "// sp: realizable\n// sp T=1: realizable\n");
    let file = files.join("rooms.hp");
    fs::write(&file, &wrong).expect("ours");
    let run = comparison.run(&[text(&file), "--objective=sp", "--set=T=1,2,6", "--solver=builtin"]);
    assert_eq!(run.status, 5, "{}", run.stderr);
    // Of an absolute path what follows the folder that all have in common.
    assert!(run.stdout.starts_with("rooms.hp#sp T=1: against the known status"), "{}", run.stdout);
    let expected: Vec<_> = comparison.records().iter().map(|record| record["expected"].clone()).collect();
    // 6 is what T is in the file.
    assert_eq!(expected, ["sat".into(), serde_json::Value::Null, "sat".into()]);
    let run = comparison.run(&[text(&file), "--objective=sp,iso", "--solver=builtin"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert_eq!(comparison.records()[3]["expected"], "sat");
    // Both cannot be.
    fs::write(&file, wrong.replace(sp, "// sp: realizable\n// sp: unrealizable\n")).expect("ours");
    let run = comparison.run(&[text(&file), "--objective=sp", "--solver=builtin"]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("its comments call sp both realizable and unrealizable"), "{}", run.stderr);
}

#[test]
fn what_solvers_got_of_a_problem() {
    let comparison = Comparison::new();
    let rooms = specs().join("rooms.hp");
    let fake = Fake::replying("*check-sat*) echo unsat;;");
    let solver = format!("--solver=builtin,'{}'", fake.program().display());
    let run = comparison.run(&[text(&rooms), "--objective=sp", "--set=T=2", "--quantifiers=expand", &solver]);
    let records = comparison.records();
    assert_eq!(records.len(), 2, "{}", run.stderr);
    for record in records {
        assert!(
            record["variables"].as_u64() > Some(1) && record["assertions"].as_u64() > Some(1),
            "{record}"
        );
        if record["solver"] == "builtin" {
            assert!(record["logic"].is_null() && record["bytes"].is_null(), "{record}");
        } else {
            assert_eq!(record["logic"], "QF_BV", "{record}");
            assert!(record["bytes"].as_u64() > Some(100), "{record}");
        }
    }
}

#[test]
fn answers_against_the_known_status() {
    let comparison = Comparison::new();
    let files = comparison.queries(0);
    fs::write(files.join("a.smt2"), "(set-logic QF_UF)\n(set-info :status unsat)\n(check-sat)\n")
        .expect("ours");
    let fake = Fake::new(&format!("{ANSWER} sat"));
    let solver = format!("--solver='{}'", fake.program().display());
    let run = comparison.run(&[text(&files), &solver]);
    assert_eq!(run.status, 4, "{}", run.stderr);
    assert!(run.stdout.contains("a.smt2: against the known status"), "{}", run.stdout);
    let record = &comparison.records()[0];
    assert_eq!((&record["expected"], &record["logic"]), (&"unsat".into(), &"QF_UF".into()));
}

#[test]
fn wrong_models_are_found_and_kept() {
    let comparison = Comparison::new();
    let rooms = specs().join("rooms.hp");
    let fake = Fake::replying(&format!("*check-sat*) echo sat;; {FALSE}"));
    let solver = format!("--solver='{}'", fake.program().display());
    let arguments = [text(&rooms), "--objective=sp", "--set=T=2", "--quantifiers=expand", &solver];
    let run = comparison.run(&arguments);
    assert_eq!(run.status, 4, "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.lines().next().is_some_and(|line| line.contains("a model fails")), "{}", run.stdout);
    let record = &comparison.records()[0];
    assert_eq!((&record["status"], &record["verified"]), (&"error".into(), &"refuted".into()), "{record}");
    let message = record["message"].as_str().expect("it says why");
    let (_, file) = message.split_once("which is kept in ").expect(message);
    let file = file.split_whitespace().next().expect("a path");
    assert!(fs::read_to_string(file).is_ok_and(|text| text.contains("It violates assertion ")), "{message}");
    // With the queries of every run kept, it is among them.
    let run = comparison.run(&[&arguments[..], &["--queries", "--repeat=2"]].concat());
    assert_eq!(run.status, 4);
    let record = &comparison.records()[1];
    let folder = comparison.out().join(record["queries"].as_str().expect("they are kept"));
    assert!(fs::read_dir(folder).expect("it is there").count() > 0);
    assert!(record["logic"].is_string() && record["bytes"].as_u64() > Some(100), "{record}");
}

#[test]
fn what_a_solver_does_not_support_is_not_held_against_it() {
    let comparison = Comparison::new();
    let problem = specs().join("case-studies/sp-10.hp");
    let run = comparison.run(&[text(&problem), "--solver=builtin", "--quantifiers=keep"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let record = &comparison.records()[0];
    assert_eq!((&record["status"], &record["exit_code"]), (&"unsupported".into(), &2.into()), "{record}");
    assert!(record["message"].as_str().is_some_and(|message| message.contains("quantifiers")), "{record}");
}

#[test]
fn requests_that_cannot_be_met() {
    let comparison = Comparison::new();
    let files = comparison.queries(1);
    let fake = Fake::new(&format!("{ANSWER} sat"));
    let solver = format!("--solver='{}'", fake.program().display());
    let refused = |arguments: &[&str], status: i32, words: &str| {
        let run = comparison.run(arguments);
        assert_eq!(run.status, status, "{}", run.stderr);
        assert!(run.stderr.contains(words), "{}", run.stderr);
        assert_eq!(run.stdout, "");
    };
    refused(&[], 2, "name files to run; there is no ");
    refused(&[text(&files), "--solver=no-such-solver"], 4, "solver no-such-solver was not found");
    refused(&[text(&files), "--solver=z4"], 4, "; did you mean z3? give the name of a known solver");
    refused(
        &["fail/empty-range.hp", "--skip-bad", &solver],
        2,
        "1 of 1 files cannot be used; nothing was run\n",
    );
    refused(&[text(&files), "--solver=builtin"], 2, "the builtin solver reads no SMT-LIB files");
    refused(&["no-such-file.hp", &solver], 2, "cannot read no-such-file.hp: there is no such file");
    refused(&["no-such-*.hp", &solver], 2, "no-such-*.hp has no .hp or .smt2 file");
    refused(
        &["fail/empty-range.hp", text(&files), &solver],
        2,
        "1 of 2 files cannot be used; nothing was run: correct them, or leave them out with --skip-bad",
    );
    refused(&["rooms.hp", "--objective=sp,nobody", &solver], 2, "no file has an objective `nobody`");
    refused(
        &[text(&files), &solver, "--repeat=4000000000"],
        2,
        "these would be 4000000000 runs, of at most 1000000",
    );
    refused(&[text(&files), &solver, "--timeout=0"], 2, "--timeout 0 is not a time to work in");
    refused(&["rooms.hp", &solver, "--set=T=3..1"], 2, "the range 3..1 is empty");
    let empty = files.join("empty.smt2");
    fs::write(&empty, "(assert true)").expect("ours");
    refused(&[text(&empty), &solver], 2, "it has no (check-sat)");
    fs::remove_file(empty).expect("ours");
    // The folder cannot be made, or not written.
    let beneath = files.join("0.smt2/out");
    let run = common::hyperplan(&["compare", text(&files), &solver, "--out", text(&beneath)]);
    assert!(run.status == 2 && run.stderr.contains("cannot write "), "{}", run.stderr);
    assert_eq!(fake.begun(), 0);
    let run = common::hyperplan(&["compare", text(&files), &solver, "--out=/proc"]);
    assert!(run.status == 2 && run.stderr.contains("cannot write /proc"), "{}", run.stderr);
    assert_eq!(fake.begun(), 0);
}

#[test]
fn what_cannot_be_used_may_be_left_out() {
    let comparison = Comparison::new();
    let files = comparison.queries(2);
    fs::write(files.join("3.smt2"), "(assert true)").expect("ours");
    let fake = Fake::new(&format!("{ANSWER} sat"));
    let solver = format!("--solver='{}'", fake.program().display());
    let bad = specs().join("fail/empty-range.hp");
    let run = comparison.run(&[text(&bad), text(&files), "--skip-bad", &solver]);
    assert_eq!((run.status, comparison.records().len()), (0, 2), "{}", run.stderr);
    let left_out: Vec<&str> = run.stderr.lines().filter(|line| line.starts_with("left out: ")).collect();
    assert_eq!(left_out.len(), 2, "{}", run.stderr);
    assert!(left_out[0].contains("empty-range.hp:"), "{}", run.stderr);
    assert!(left_out[1].ends_with("3.smt2: it has no (check-sat)"), "{}", run.stderr);
    // No more is said of them.
    assert!(run.stderr.lines().all(|line| line.starts_with(['l', '[', 'n'])), "{}", run.stderr);
}

#[test]
fn more_of_each_run() {
    let comparison = Comparison::new();
    let files = comparison.queries(1);
    let fake = Fake::new("cat > /dev/null; echo oh >&2; exit 7");
    let below = |arguments: &[&str], what: &str| -> Vec<String> {
        let run = comparison.run(&[arguments, &["-v"]].concat());
        let lines: Vec<&str> = run.stderr.lines().collect();
        let at = lines.iter().position(|line| line.contains(what)).expect(&run.stderr);
        lines[at + 1..]
            .iter()
            .take_while(|line| line.starts_with("    "))
            .map(|line| (*line).to_owned())
            .collect()
    };
    let failed = below(&[text(&files), &format!("--solver='{}'", fake.program().display())], "0.smt2");
    assert!(failed[0].starts_with("    CPU 0.") && failed[0].ends_with(" MiB"), "{failed:?}");
    assert_eq!(failed[1..], ["    oh"]);
    let rooms = specs().join("rooms.hp");
    let solved = below(&[text(&rooms), "--objective=sp", "--solver=builtin"], "builtin auto/auto: sat");
    assert!(solved[0].starts_with("    verified by-search; CPU "), "{solved:?}");
    assert_eq!(solved.len(), 1);
}

/// A file may be called anything.
#[test]
fn names_that_break_lines() {
    let comparison = Comparison::new();
    let files = comparison.queries(0);
    fs::write(files.join("a\nb.smt2"), "(check-sat)").expect("ours");
    let fake = Fake::new(&format!("{ANSWER} sat"));
    let run = comparison.run(&[text(&files), &format!("--solver='{}'", fake.program().display())]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.contains(r"a\nb.smt2 ") && run.stdout.contains(r"a\nb.smt2 "), "{}", run.stderr);
    let page = fs::read_to_string(comparison.out().join("report.html")).expect("it was written");
    assert!(page.contains("href=\"./../queries/a%0Ab.smt2\""), "{page}");
}

#[test]
fn the_same_for_benchexec() {
    let comparison = Comparison::new();
    let folder = comparison.folder().join("bench");
    let option = format!("--benchexec={}", folder.display());
    let run = comparison.run(&["rooms.hp", "--solver=builtin", "--quantifiers=cegis,expand", &option]);
    assert_eq!((run.status, run.stdout.as_str()), (0, ""), "{}", run.stderr);
    let definition = fs::read_to_string(folder.join("hyperplan.xml")).expect("it is there");
    assert!(
        definition.contains("builtin-cegis-auto") && definition.contains("builtin-expand-auto"),
        "{definition}"
    );
    assert_eq!(fs::read_dir(folder.join("tasks")).expect("it is there").count(), 5);
    assert!(!comparison.out().exists());
    assert!(run.stderr.contains("note: 5 tasks and 2 run definitions in "), "{}", run.stderr);
    assert!(run.stderr.contains("PYTHONPATH=. benchexec hyperplan.xml"), "{}", run.stderr);
    // Queries are none of it.
    let files = comparison.queries(1);
    let run = comparison.run(&["rooms.hp", text(&files), "--solver=builtin", &option]);
    assert!(run.status == 0 && run.stderr.contains("note: 1 SMT-LIB file left out"), "{}", run.stderr);
    let run = comparison.run(&[text(&files), "--solver=builtin", &option]);
    assert!(run.status == 2 && run.stderr.contains("without 1 SMT-LIB file"), "{}", run.stderr);
}

/// Neither in a file nor on standard input.
#[test]
fn solvers_do_not_see_the_status() {
    let comparison = Comparison::new();
    let files = comparison.queries(0);
    let query = "(declare-const x Bool)\n(set-info :status unsat)\n(assert x)\n(check-sat)\n";
    fs::write(files.join("a.smt2"), query).expect("ours");
    let fake = Fake::new("case \"$(cat $1)\" in *status*) echo unsat;; *assert*) echo sat;; esac");
    for solver in ["", " {file}"] {
        let run = comparison.run(&[text(&files), &format!("--solver={}{solver}", fake.program().display())]);
        assert_eq!(run.status, 4, "{}{}", run.stdout, run.stderr);
    }
    assert!(!comparison.out().join("evidence").exists());
    assert!(fs::read_to_string(files.join("a.smt2")).is_ok_and(|text| text == query));
    // An answer after a complaint is none.
    let fake = Fake::new("cat > /dev/null; echo '(error \"line 1\")'; echo sat");
    let run = comparison.run(&[text(&files), &format!("--solver='{}'", fake.program().display())]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let record = comparison.records().pop().expect("it is the last");
    assert_eq!((&record["status"], &record["message"]), (&"error".into(), &"(error \"line 1\")".into()));
}
