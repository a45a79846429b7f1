use super::*;

use std::io::Write as _;

const XML: &str = r#"<?xml version="1.0"?>
<!DOCTYPE result PUBLIC '+//IDN sosy-lab.org//DTD BenchExec result 3.0//EN' 'https://www.sosy-lab.org/benchexec/result-3.0.dtd'>
<result benchmarkname="bench" name="bench.z3" tool="z3" version="4.8" options="-smt2" timelimit="60s" walltimelimit="70s" memlimit="16000000000B">
  <systeminfo hostname="node1"/>
  <run name="QF_BV/one.smt2.yml" expectedVerdict="true">
    <column title="cputime" value="1.5s"/>
    <column title="memory" value="20971520B"/>
    <column title="status" value="true"/>
    <column title="walltime" value="1.25s"/>
  </run>
  <run name="QF_BV/two.smt2.yml" expectedVerdict="false">
    <column title="cputime" value="60.1s"/>
    <column title="status" value="TIMEOUT (true)"/>
    <column title="walltime" value="60.2s"/>
  </run>
  <run name="QF_BV/two.smt2.yml">
    <column title="cputime" value="3s"/>
    <column title="status" value="ERROR (parse)"/>
    <column title="walltime" value="3s"/>
  </run>
</result>
"#;

fn xml(text: &str) -> Result<Vec<Record>, ForeignError> {
    read(Path::new("a.results.xml"), text.as_bytes())
}

#[test]
fn results_of_benchexec_are_read() {
    let runs = xml(XML).expect("three runs");
    assert_eq!(runs.len(), 3);
    let first = &runs[0];
    assert_eq!(
        (first.instance.as_str(), first.family.as_str(), first.solver.as_str()),
        ("QF_BV/one.smt2", "QF_BV", "z3")
    );
    assert_eq!(
        (first.status, first.expected, first.logic.as_deref()),
        (RunStatus::Sat, Some(Answer::Sat), Some("QF_BV"))
    );
    assert_eq!((first.wall_s, first.cpu_s, first.memory_mib), (1.25, 1.5, 20.0));
    assert_eq!(
        (first.version.as_deref(), first.options.as_str(), first.host.as_str()),
        (Some("4.8"), "-smt2", "node1")
    );
    let limit = Limit { wall_s: Some(70.0), cpu_s: Some(60.0), memory_mib: Some(15258) };
    assert_eq!((first.limit, runs[1].status, runs[2].status), (limit, RunStatus::Timeout, RunStatus::Error));
    // Repetitions are runs of their own, and reading again gives the same ones.
    assert_eq!((runs[1].repetition, runs[2].repetition), (0, 1));
    let keys: BTreeSet<&str> = runs.iter().map(|run| run.key.as_str()).collect();
    assert_eq!(keys.len(), 3);
    assert_eq!(xml(XML).expect("three runs"), runs);
}

#[test]
fn statuses_are_those_of_the_competition() {
    for (status, reason, expected) in [
        ("false", None, RunStatus::Unsat),
        ("unknown", None, RunStatus::Unknown),
        ("TIMEOUT", None, RunStatus::Timeout),
        ("KILLED BY SIGNAL 9", Some("walltime"), RunStatus::Timeout),
        ("KILLED BY SIGNAL 9", None, RunStatus::Memout),
        ("OUT OF MEMORY (false)", Some("memory"), RunStatus::Memout),
        ("SEGMENTATION FAULT", None, RunStatus::Error),
        ("DONE", None, RunStatus::Error),
    ] {
        assert_eq!(verdict(status, reason), expected, "{status} {reason:?}");
    }
    let name = |text: &str| {
        let document = Document::parse(text).expect("it is XML");
        contestant(document.root_element())
    };
    assert_eq!(name(r#"<result name="cvc5,7,SingleQuery" tool="x"/>"#), "cvc5");
    assert_eq!(name(r#"<result tool="x"/>"#), "x");
    assert_eq!(name("<result/>"), "unnamed");
}

#[test]
fn what_the_competition_publishes_is_read() {
    let text = r#"{"results": [
        {"track": "SingleQuery", "solver": "cvc5", "result": "unsat", "cpu_time": 2.5, "wallclock_time": 2.0, "memory_usage": 1048576.0,
         "file": {"incremental": false, "logic": "UF", "family": ["20200101-a", "b"], "name": "c.smt2"}},
        {"track": "SingleQuery", "solver": "cvc5", "result": "Timeout", "cpu_time": 9, "wallclock_time": 9,
         "file": {"incremental": false, "logic": "UF", "family": ["20200101-a"], "name": "d.smt2"}}]}"#;
    let runs = read(Path::new("results.json"), text.as_bytes()).expect("two runs");
    assert_eq!(runs[0].instance, "non-incremental/UF/20200101-a/b/c.smt2");
    assert_eq!((runs[0].status, runs[1].status), (RunStatus::Unsat, RunStatus::Timeout));
    assert_eq!((runs[0].cpu_s, runs[0].wall_s, runs[0].memory_mib), (2.5, 2.0, 1.0));
}

#[test]
fn tables_of_starexec_are_read() {
    let text = "pair id,benchmark,solver,configuration,status,cpu time,wallclock time,memory usage,result,expected\n\
        1,QF_UF/a/b.smt2,yices,default,complete,1.0,1.5,2048,sat,sat\n\
        2,QF_UF/a/c.smt2,yices,default,timeout (wallclock),20,20,0,starexec-unknown,-\n\
        3,QF_UF/a/d.smt2,yices,default,complete,1,1,0,starexec-unknown,unsat\n\
        4,QF_UF/a/e.smt2,yices,default,complete,20,20,0,timeout,unknown\n";
    let runs = read(Path::new("job.csv"), text.as_bytes()).expect("four runs");
    let statuses: Vec<RunStatus> = runs.iter().map(|run| run.status).collect();
    assert_eq!(statuses, [RunStatus::Sat, RunStatus::Timeout, RunStatus::Unknown, RunStatus::Timeout]);
    let mut to = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    to.write_all(text.as_bytes()).expect("it is memory");
    let packed = to.finish().expect("it is memory");
    assert!(is_foreign(Path::new("a/job.CSV.gz")) && !is_foreign(Path::new("runs.jsonl.gz")));
    assert_eq!(read(Path::new("job.csv.gz"), &packed).expect("four runs"), runs);
    let cut = read(Path::new("job.csv.gz"), &packed[..packed.len() - 9]);
    assert!(matches!(cut, Err(ForeignError::Packed(_))), "{cut:?}");
    assert_eq!(
        (runs[0].memory_mib, runs[2].expected, runs[0].logic.as_deref()),
        (2.0, Some(Answer::Unsat), Some("QF_UF"))
    );
}

#[test]
fn what_is_damaged_is_refused_with_its_line() {
    let refused = |name: &str, text: &str| match read(Path::new(name), text.as_bytes()) {
        Ok(runs) => panic!("{name}: {} runs of {text}", runs.len()),
        Err(error) => error.to_string(),
    };
    assert!(refused("a.xml", &XML[..400]).starts_with("no XML"), "{}", refused("a.xml", &XML[..400]));
    assert!(refused("a.xml", "<graphml/>").contains("line 1: expected results of BenchExec"));
    assert_eq!(refused("a.xml", "<result/>"), "it has no runs");
    let without = XML.replace(r#"<column title="status" value="true"/>"#, "");
    assert_eq!(refused("a.xml", &without), "line 5: the run has no status");
    let without = XML.replace("1.25s", "soon");
    assert_eq!(refused("a.xml", &without), "line 5: the run has no walltime");
    assert!(refused("a.json", "{\"results\": [{}]}").contains("missing field"));
    let head = "benchmark,solver,status,cpu time,wallclock time,result\n";
    for time in ["nan", "-5", "inf"] {
        let said = refused("a.csv", &format!("{head}a,z3,complete,1,{time},sat\n"));
        assert!(said.contains("is no time, and no memory") && said.contains("line: 2"), "{said}");
        let said = refused("a.csv", &format!("{head}a,z3,complete,{time},1,sat\n"));
        assert!(said.contains("is no time, and no memory"), "{said}");
    }
    let run = r#"{"results": [{"solver": "z3", "result": "sat", "cpu_time": -1, "wallclock_time": 1,
        "file": {"logic": "UF", "name": "a"}}]}"#;
    assert!(refused("a.json", run).contains("-1 is no time, and no memory"));
    assert!(refused("a.csv", "a,b\n1,2\n").contains("missing field `benchmark`"));
    assert!(matches!(read(Path::new("a.csv"), b"\xff"), Err(ForeignError::Encoding)));
}

#[test]
fn runs_of_one_file_are_put_beside_each_other() {
    let ours = |instance: &str, sha256: &str| Record {
        sha256: sha256.to_owned(),
        family: "mine".to_owned(),
        ..run(instance.to_owned(), "z3".to_owned(), RunStatus::Sat)
    };
    let known = [
        ours("/home/me/lib/QF_BV/one.smt2", "1"),
        ours("x/QF_UF/two.smt2", "2"),
        ours("y/QF_UF/two.smt2", "3"),
    ];
    let theirs = |instance: &str| run(instance.to_owned(), "cvc5".to_owned(), RunStatus::Sat);
    let foreign = [
        theirs("QF_BV/one.smt2"),
        theirs("BV/one.smt2"),
        theirs("QF_UF/two.smt2"),
        theirs("a/x/QF_UF/two.smt2"),
    ];
    let all = beside([&foreign[..], &known].concat());
    let digests: Vec<&str> = all.iter().map(|record| record.sha256.as_str()).collect();
    assert_eq!(digests, ["1", "", "", "2", "1", "2", "3"]);
    assert_eq!(all[0].instance, "/home/me/lib/QF_BV/one.smt2");
}
