//! `compare --merge` with results of others.

mod common;

use common::{hyperplan, text};
use std::fs;

const XML: &str = r#"<result benchmarkname="bench" name="bench.theirs" tool="theirs" timelimit="60s" walltimelimit="60s">
  <run name="QF_UF/set/a.smt2" expectedVerdict="true">
    <column title="cputime" value="1.5s"/><column title="walltime" value="1.5s"/><column title="status" value="true"/>
  </run>
  <run name="QF_UF/set/b.smt2" expectedVerdict="false">
    <column title="cputime" value="60s"/><column title="walltime" value="60s"/><column title="status" value="TIMEOUT"/>
  </run>
</result>
"#;

#[test]
fn results_of_others_stand_beside_ours() {
    let folder = tempfile::tempdir().expect("a folder");
    let (set, out) = (folder.path().join("lib/QF_UF/set"), folder.path().join("out"));
    fs::create_dir_all(&set).expect("the folder is ours");
    for (name, status) in [("a", "sat"), ("b", "unsat")] {
        let text =
            format!("(set-logic QF_UF)\n(set-info :status {status})\n; {name}\n(assert true)\n(check-sat)\n");
        fs::write(set.join(name).with_extension("smt2"), text).expect("the folder is ours");
    }
    let ours = folder.path().join("ours");
    fs::write(&ours, "#!/bin/sh\ncat > /dev/null\necho sat\n").expect("the folder is ours");
    use std::os::unix::fs::PermissionsExt as _;
    fs::set_permissions(&ours, fs::Permissions::from_mode(0o755)).expect("the file is ours");
    let run =
        hyperplan(&["compare", text(&set), "--solver", text(&ours), "--timeout", "5", "--out", text(&out)]);
    assert_eq!(run.status, 4, "{}", run.stderr);
    let xml = folder.path().join("bench.results.xml");
    fs::write(&xml, XML).expect("the folder is ours");
    let merge = ["compare", "--out", text(&out), "--merge", text(&xml)];
    let run = hyperplan(&merge);
    assert_eq!(run.status, 4, "{} {}", run.stdout, run.stderr);
    assert!(run.stderr.contains("2 of 2 runs are new"), "{}", run.stderr);
    // One row for each file, by the name that is left of a path below the common folder.
    let table = fs::read_to_string(out.join("instances.md")).expect("it was written");
    let rows: Vec<&str> = table.lines().skip(2).collect();
    assert!(rows.len() == 2 && rows[0].starts_with("| a.smt2 | sat |"), "{table}");
    let divisions = fs::read_to_string(out.join("divisions.md")).expect("it was written");
    assert!(
        divisions.starts_with("### QF\\_Equality: 2 instances")
            || divisions.starts_with("### QF_Equality: 2 instances")
    );
    assert!(divisions.contains("| theirs | 1 (1) | 1 (1) | 1 (2) | 0 (1) | 1 (1) |"), "{divisions}");
    let difficulty = fs::read_to_string(out.join("difficulty.md")).expect("it was written");
    assert!(difficulty.contains("| not solved | 1 |"), "{difficulty}");
    // Twice is as good as once.
    let run = hyperplan(&merge);
    assert!(run.stderr.contains("0 of 2 runs are new"), "{}", run.stderr);
    // What is damaged is refused, and nothing of it is taken.
    fs::write(&xml, XML.replace("walltime\" value=\"60s\"", "walltime\"")).expect("the folder is ours");
    let log = fs::read(out.join("runs.jsonl")).expect("there is a log");
    let run = hyperplan(&merge);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("line 5: the run has no walltime"), "{}", run.stderr);
    assert_eq!(fs::read(out.join("runs.jsonl")).expect("there is a log"), log);
}

/// Two runs of one shape, by two solvers, with more CPU time than wall time, in a table that says no limit.
#[test]
fn a_limit_that_is_not_said_can_be_given() {
    let folder = tempfile::tempdir().expect("a folder");
    let (csv, out) = (folder.path().join("job.csv"), folder.path().join("out"));
    let rows = "benchmark,solver,status,cpu time,wallclock time,result,expected\n\
        UF/a/b.smt2,wide,complete,30,10,sat,sat\nUF/a/b.smt2,narrow,complete,15,15,sat,sat\n";
    fs::write(&csv, rows).expect("the folder is ours");
    let divisions = |options: &[&str]| {
        let merge = ["compare", "--out", text(&out), "--merge", text(&csv)];
        let run = hyperplan(&[&merge[..], options].concat());
        assert_eq!(run.status, 0, "{}", run.stderr);
        let divisions = fs::read_to_string(out.join("divisions.md")).expect("it was written");
        fs::remove_dir_all(&out).expect("the folder is ours");
        divisions
    };
    let plain = divisions(&[]);
    assert!(
        plain.contains("| wide | 1 (1) | 1 (2) |") && plain.contains("| narrow | 1 (2) | 1 (1) |"),
        "{plain}"
    );
    // By parallel score wide is first; by the sequential one its answer came too late.
    let limited = divisions(&["--limit", "20"]);
    assert!(limited.contains("| wide | 1 (1) | 0 (2) |"), "{limited}");
    assert!(limited.contains("| narrow | 1 (2) | 1 (1) |"), "{limited}");
    for wrong in ["0", "-1", "nan", "inf", "soon"] {
        let limit = format!("--limit={wrong}");
        let run = hyperplan(&["compare", "--out", text(&out), "--merge", text(&csv), &limit]);
        assert_eq!(run.status, 2, "{wrong}");
    }
}
