//! `solve --proof` and `hyperplan certify`: what is certified, what is refused, and what is said.

mod common;

use common::{Run, hyperplan, text};
use std::path::Path;
use tempfile::TempDir;

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn solve(file: &str, options: &[&str], proofs: &Path) -> Run {
    hyperplan(&[&["solve", file, "--proof", text(proofs)], options].concat())
}

fn certify(file: &str, proofs: &Path, options: &[&str]) -> Run {
    hyperplan(&[&["certify", file, text(proofs)], options].concat())
}

#[test]
fn a_horizon_that_is_too_short() {
    let folder = folder();
    let run = solve("case-studies/ar-10.hp", &["--set", "T=15", "--format", "json"], folder.path());
    assert_eq!((run.status, run.stderr.as_str()), (1, ""));
    let made = run.json()[0]["certificates"].clone();
    assert_eq!(made, serde_json::json!([folder.path().join("ar.json")]));
    let run = certify("case-studies/ar-10.hp", folder.path(), &["--format", "json"]);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    let report = &run.json()[0];
    assert_eq!((&report["verdict"], &report["claim"]), (&"certified".into(), &"no-strategy".into()));
    assert_eq!(report["set"], serde_json::json!(["T=15"]));
    assert!(report["instances"].as_u64() > Some(5) && report["steps"].as_u64() > Some(1000), "{report}");
    // For other checkers.
    let export = folder.path().join("export");
    let run = certify("case-studies/ar-10.hp", folder.path(), &["--export", text(&export)]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let read = |name: &str| std::fs::read_to_string(export.join(name)).expect("it was written");
    assert!(read("ar.cnf").starts_with("p cnf ") && read("ar.lrat").trim_end().ends_with(" 0"));
    assert!(read("ar.pbp").ends_with("end pseudo-Boolean proof ;\n"));
}

#[test]
fn all_smaller_values_of_a_constant() {
    let folder = folder();
    let run = solve("case-studies/cso-10.hp", &["--minimize", "T=6..12"], folder.path());
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    let run = certify("case-studies/cso-10.hp", folder.path(), &["--objective", "cso"]);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    let lines: Vec<&str> = run.stdout.lines().collect();
    assert_eq!(lines.len(), 4, "{}", run.stdout);
    assert!(
        lines
            .iter()
            .zip(6..)
            .all(|(line, t)| line.starts_with(&format!("cso with T={t}: unrealizable, certified: ")))
    );
}

const PROPERTY: &str = "
system Line {
  state x: 0..3;
  action go, back;
  on go   { x' = if x == 3 then 0 else x + 1; }
  on back { x' = if x == 0 then 3 else x - 1; }
  init x == 0;
}
// answered: realizable
objective answered within 3 { forall p. exists q. forall r. x[q] == x[p] & X action[q] != action[p] & G (x[r] + x[p]) < 7 }
objective found within 3 { exists p. F x[p] == 3 }
";

#[test]
fn a_property_that_holds_and_a_strategy_that_needs_none() {
    let folder = folder();
    let file = folder.path().join("line.hp");
    std::fs::write(&file, PROPERTY).expect("the folder is ours");
    let proofs = folder.path().join("proofs");
    let run = solve(text(&file), &["--objective", "all", "--quiet"], &proofs);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    let run = certify(text(&file), &proofs, &[]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(
        run.stdout.starts_with("answered: realizable, certified: ") && run.stdout.lines().count() == 1,
        "{}",
        run.stdout
    );
    let run = certify(text(&file), &proofs, &["--objective", "found"]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("has no certificate for objective found"), "{}", run.stderr);
}

#[test]
fn what_is_damaged_is_refused() {
    let folder = folder();
    let (file, proofs) = (folder.path().join("a.hp"), folder.path().join("proofs"));
    let text_of = |x: u32| {
        format!(
            "system L {{ state x: 0..9; action go; on go {{ x' = x + 1; }} init x == {x}; absorb x == 9; }}\nobjective o within 3 {{ exists p. F x[p] == 9 }}\n"
        )
    };
    std::fs::write(&file, text_of(1)).expect("the folder is ours");
    assert_eq!(solve(text(&file), &[], &proofs).status, 1);
    assert_eq!(certify(text(&file), &proofs, &[]).status, 0);
    // Another problem, even one of which the claim is true.
    for x in [2, 8] {
        std::fs::write(&file, text_of(x)).expect("the folder is ours");
        let run = certify(text(&file), &proofs, &[]);
        assert_eq!(run.status, 2, "{}", run.stdout);
        assert!(
            run.stdout.contains("is not certified: the certificate is for another problem"),
            "{}",
            run.stdout
        );
    }
    std::fs::write(&file, text_of(1)).expect("the folder is ours");
    let refutation = proofs.join("o.lrat.gz");
    let whole = std::fs::read(&refutation).expect("it was written");
    std::fs::write(&refutation, &whole[..whole.len() / 2]).expect("ours");
    let run = certify(text(&file), &proofs, &[]);
    assert!(
        [1, 2].contains(&run.status) && run.stdout.contains("is not certified: "),
        "{} {}",
        run.status,
        run.stdout
    );
    std::fs::remove_file(&refutation).expect("ours");
    assert_eq!(certify(text(&file), &proofs, &[]).status, 2);
    std::fs::write(&refutation, &whole).expect("ours");
    let description = proofs.join("o.json");
    let own = std::fs::read_to_string(&description).expect("it was written");
    for (old, new, expected) in [
        ("\"no-strategy\"", "\"no-counterexample\"", "another claim"),
        ("\"format\": 1", "\"format\": 7", "its form is 7"),
        ("\"instances\": []", "\"instances\": [{\"instances\": []}]", "other paths than its block"),
        ("\"o\"", "\"other\"", "objective other"),
    ] {
        assert!(own.contains(old), "{own}");
        std::fs::write(&description, own.replace(old, new)).expect("ours");
        let run = certify(text(&file), &proofs, &[]);
        assert_eq!(run.status, 2, "{new}: {}", run.stdout);
        assert!((run.stdout + &run.stderr).contains(expected), "{new}: {}", run.stderr);
    }
}

#[test]
fn what_is_not_certified_is_said() {
    let folder = folder();
    let file = folder.path().join("a.hp");
    let infinite = "system L { state x: int; action go; on go { x' = x + 1; } init x == 0; }\nobjective o within 2 { exists p. F x[p] > 5 }\n";
    std::fs::write(&file, infinite).expect("the folder is ours");
    if common::solver_is_there("z3") {
        let run = solve(text(&file), &["--solver", "z3"], &folder.path().join("proofs"));
        assert_eq!(run.status, 2, "{}", run.stderr);
        assert!(run.stdout.starts_with("o: unrealizable\n"), "{}", run.stdout);
        assert!(
            run.stderr.contains("not certified: system L has variables without bounds"),
            "{}",
            run.stderr
        );
    }
}

#[test]
fn that_nothing_is_cheaper() {
    let folder = folder();
    let (file, objective) = ("pass/costs.hp", ["--objective", "straight"]);
    let run = solve(file, &objective, folder.path());
    assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{}", run.stdout);
    let run = certify(file, folder.path(), &objective);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{}", run.stdout);
    let said: Vec<&str> =
        run.stdout.lines().map(|line| line.split(" unrealizable").next().unwrap_or("")).collect();
    assert_eq!(
        said,
        [
            "straight with cost turns[p] <= 1:",
            "straight with cost turns[p] <= 2, 2 * cost fuel[p] + 1 <= 28:"
        ],
        "{}",
        run.stdout
    );
    // Of the cheapest it is wrong, and of what is no cost.
    let description = folder.path().join("straight-cost-2.json");
    let own = std::fs::read_to_string(&description).expect("it was written");
    for (old, new) in [("\"most\": 28", "\"most\": 29"), ("cost turns[p]", "cost nothing[p]")] {
        assert!(own.contains(old), "{own}");
        std::fs::write(&description, own.replace(old, new)).expect("ours");
        let run = certify(file, folder.path(), &objective);
        assert_eq!(run.status, 2, "{}", run.stdout);
        assert!(run.stdout.contains(" is not certified: "), "{}", run.stdout);
    }
    // Of costs that the command line says.
    let proofs = folder.path().join("both");
    let run = solve(file, &["--objective", "way", "--minimize", "cost turns[p] + cost fuel[p]"], &proofs);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{}", run.stdout);
    let run = certify(file, &proofs, &["--objective", "way"]);
    assert!(run.status == 0 && run.stdout.starts_with("way with cost "), "{} {}", run.stdout, run.stderr);
}

#[test]
fn benchmarks_with_certificates() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let emit = |options: &[&str], to: &Path| {
        hyperplan(&[&["emit", "case-studies/cso-10.hp", "--certify", "-o", text(to)], options].concat())
    };
    // Two below the least T, and it.
    let run = emit(&["--each", "T=8..10"], &path("all"));
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    let made = |name: &str| path("all").join(name).is_file();
    assert!(made("cso-T-8.json") && made("cso-T-9.lrat.gz") && !made("cso-T-10.json"));
    let run = certify("case-studies/cso-10.hp", &path("all"), &[]);
    assert!(run.status == 0 && run.stdout.lines().count() == 2, "{} {}", run.stdout, run.stderr);
    // Standard output has nothing beside it, and a wrong status has no certificate.
    let run = hyperplan(&["emit", "case-studies/cso-10.hp", "--certify"]);
    assert!(run.status == 2 && run.stderr.contains("-o FILE"), "{}", run.stderr);
    let run = emit(&["--set", "T=10", "--status", "unsat"], &path("wrong.smt2"));
    assert!(run.status == 2 && run.stderr.contains("--status unsat: "), "{}", run.stderr);
    if !common::solver_is_there("z3") {
        return;
    }
    let compared = |out: &str, more: &[&str]| {
        let (all, out) = (path("all"), path(out));
        let known = ["compare", text(&all), "--solver", "z3", "--out", text(&out), "--certified"];
        hyperplan(&[&known, more].concat())
    };
    let run = compared("compared", &[]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.contains("2 of 3 known answers are certified"), "{}", run.stderr);
    // Another benchmark than the one that the certificate names.
    let benchmark = path("all").join("cso-T-8.smt2");
    let own = std::fs::read_to_string(&benchmark).expect("it was written");
    std::fs::write(&benchmark, own + "; changed\n").expect("ours");
    let run = compared("again", &[]);
    assert!(run.stderr.contains("1 of 3 known answers are certified"), "{}", run.stderr);
    assert!(run.stderr.contains("the certificate is for another benchmark"), "{}", run.stderr);
}
