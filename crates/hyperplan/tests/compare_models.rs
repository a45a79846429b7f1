//! Comparisons on files that ask for the model: it is checked.
#![cfg(unix)]

mod common;

use common::compare::Comparison;
use common::fakes::Fake;
use common::{hyperplan, solver_is_there, text};
use serde_json::Value;
use std::fs;

const QUERY: &str = "(set-option :produce-models true)\n(declare-const x Int)\n(declare-const p Bool)\n\
                     (assert (or p (< x 3)))\n(assert (not (= x 2)))\n(check-sat)\n(get-model)\n";

/// What comes of a query and what a solver prints after `sat`: the exit status, standard output, and the run.
fn run(query: &str, printed: &str) -> (i32, String, Value) {
    let comparison = Comparison::new();
    let files = comparison.queries(0);
    fs::write(files.join("a.smt2"), query).expect("ours");
    let fake = Fake::new(&format!("cat > /dev/null; echo sat; echo '{printed}'"));
    let run = comparison.run(&[text(&files), &format!("--solver='{}'", fake.program().display())]);
    let record = comparison.records().pop().expect("it was run");
    assert_eq!(record["status"], "sat", "{record}");
    (run.status, run.stdout, record)
}

fn model(x: &str, p: &str) -> String {
    format!("(\n  (define-fun x () Int {x})\n  (define-fun p () Bool {p}))")
}

#[test]
fn a_model_that_holds() {
    let (status, stdout, record) = run(QUERY, &model("(- 7)", "false"));
    assert_eq!(
        (status, &record["verified"], &record["message"]),
        (0, &"model".into(), &Value::Null),
        "{stdout}"
    );
    // It settles what is right.
    let comparison = Comparison::new();
    let files = comparison.queries(0);
    fs::write(files.join("a.smt2"), QUERY).expect("ours");
    let right = Fake::called("right", &format!("cat > /dev/null; echo sat; echo '{}'", model("0", "true")));
    let wrong = Fake::called("wrong", "cat > /dev/null; echo unsat; echo '(error \"no model\")'");
    let solvers = format!("--solver='{}','{}'", right.program().display(), wrong.program().display());
    let run = comparison.run(&[text(&files), &solvers]);
    assert_eq!(run.status, 4, "{}", run.stdout);
    let first = run.stdout.lines().next();
    assert!(
        first.is_some_and(|line| line.ends_with("solvers disagree, a solver's fault; known: sat")),
        "{}",
        run.stdout
    );
    assert!(run.stdout.contains("right' says sat, model checked"), "{}", run.stdout);
}

#[test]
fn a_model_that_fails() {
    for (query, printed) in [
        (QUERY.to_owned(), model("2", "true")),
        (QUERY.replace("(get-model)", "(get-value (x))"), "((x 2))".to_owned()),
        // Whatever p is.
        (QUERY.to_owned(), "((define-fun x () Int 2))".to_owned()),
    ] {
        let (status, stdout, record) = run(&query, &printed);
        assert_eq!((status, &record["verified"]), (4, &"refuted".into()), "{stdout}");
        let mut lines = stdout.lines();
        assert!(
            lines.next().is_some_and(|line| line.ends_with("a model fails, a solver's fault")),
            "{stdout}"
        );
        assert!(lines.next().is_some_and(|line| line.ends_with("says sat, refuted")), "{stdout}");
        assert_eq!(lines.next(), Some("    wrong model: assertion 2 of 2 (line 5) is false"), "{stdout}");
    }
}

#[test]
fn what_is_not_checked_is_no_finding() {
    let product = QUERY.replace("(< x 3)", "(< (* x x) 3)");
    let part = QUERY.replace("(get-model)", "(get-value (p))");
    for (query, printed, why) in [
        (&product[..], &model("2", "false")[..], "a product of variables on line 4"),
        (QUERY, "", "none was printed"),
        (QUERY, "(error \"not now\")", "the solver reported an error: not now"),
        (QUERY, "((define-fun p () Bool true))", "no value for x"),
        (QUERY, &model("(+ 1 1)", "true"), "the value of x cannot be read: (+ 1 1)"),
        (&part, "((p true))", "no value for x"),
    ] {
        let (status, stdout, record) = run(query, printed);
        assert_eq!((status, &record["verified"]), (0, &Value::Null), "{stdout}");
        assert_eq!(record["message"], format!("model not checked: {why}"));
        assert!(!stdout.contains("a model fails"), "{stdout}");
    }
    // Nobody asked.
    let (status, _, record) = run(&QUERY.replace("(get-model)", ""), &model("2", "true"));
    assert_eq!((status, &record["verified"], &record["message"]), (0, &Value::Null, &Value::Null));
}

/// What is emitted for the model track, however states are written, and what solvers print for it.
#[test]
fn models_of_solvers() {
    let comparison = Comparison::new();
    let files = comparison.queries(0);
    for states in ["onehot", "bitvec", "int", "enum"] {
        let file = files.join(format!("{states}.smt2"));
        let emitted =
            ["emit", "rooms.hp", "--objective=iso", "--track=model", "--states", states, "-o", text(&file)];
        let run = hyperplan(&emitted);
        assert_eq!(run.status, 0, "{}", run.stderr);
    }
    for solver in ["z3", "cvc5"] {
        if !solver_is_there(solver) {
            continue;
        }
        let run = comparison.run(&[text(&files), "--solver", solver]);
        assert_eq!(run.status, 0, "{}{}", run.stdout, run.stderr);
        let records: Vec<Value> =
            comparison.records().into_iter().filter(|record| record["solver"] == solver).collect();
        assert_eq!(records.len(), 4);
        for record in records {
            assert_eq!(
                (&record["status"], &record["verified"]),
                (&"sat".into(), &"model".into()),
                "{record}"
            );
        }
    }
}

/// The only run of a solver that prints this for a query.
fn record(query: &str, printed: &str) -> Value {
    let comparison = Comparison::new();
    let files = comparison.queries(0);
    fs::write(files.join("a.smt2"), query).expect("ours");
    let fake = Fake::new(&format!("cat > /dev/null; cat <<'END'\n{printed}\nEND"));
    let run = comparison.run(&[text(&files), &format!("--solver='{}'", fake.program().display())]);
    assert_eq!(run.status, 0, "{}{}", run.stdout, run.stderr);
    comparison.records().pop().expect("it was run")
}

#[test]
fn the_answer_is_what_the_check_was_answered() {
    let query = format!("(set-info :status sat)\n(echo \"unsat\")\n{QUERY}(echo \"unsat\")\n");
    let model = model("1", "true");
    for printed in [
        format!("unsat\nsat\n{model}\nunsat"),
        format!("\"unsat\"\nsat\n{model}\n\"unsat\""),
        // One that does not echo.
        format!("sat\n{model}"),
    ] {
        let record = record(&query, &printed);
        assert_eq!((&record["status"], &record["verified"]), (&"sat".into(), &"model".into()), "{record}");
    }
    // It refused the query, and is not blamed for what it echoed or quoted.
    for printed in ["unsat\n(error \"no such sort\")", "unsat\n(error \"line 2:\nunsat\n\")\nunsat"] {
        let record = record(&query, printed);
        assert_eq!(record["status"], "error", "{record}");
        assert!(record["message"].as_str().is_some_and(|said| said.starts_with("(error ")), "{record}");
    }
}

#[test]
fn what_is_printed_besides_a_model() {
    let asked = "(declare-fun f (Int) Int)\n(assert (! (> (f 1) 3) :named big))\n(check-sat)\n(get-model)\n";
    let function = record(asked, "sat\n(\n (define-fun f ((x!0 Int)) Int\n 4))");
    assert_eq!((&function["status"], &function["verified"]), (&"sat".into(), &"model".into()), "{function}");
    let named = format!(
        "{}(get-assignment)\n",
        QUERY.replace("(assert (not (= x 2)))", "(assert (! (not (= x 2)) :named n))")
    );
    for printed in [
        "sat\n(\n (define-fun x () Int 1)\n (define-fun p () Bool true)\n (define-fun n () Bool\n (not (= x 2))))\n((n true))",
        "sat\n(= x 1)\n(= p true)\n((n true))",
    ] {
        let record = record(&named, printed);
        assert_eq!((&record["verified"], &record["message"]), (&"model".into(), &Value::Null), "{record}");
    }
    // Whatever was printed, the solver does not stand by it.
    let disowned = record(QUERY, &format!("sat\n(error \"an invalid model\")\n{}", model("2", "true")));
    let expected = "model not checked: the solver reported an error: an invalid model";
    assert_eq!((&disowned["verified"], &disowned["message"]), (&Value::Null, &expected.into()), "{disowned}");
    let told = record(&QUERY.replace("(get-model)", ""), "sat\n(error \"an invalid model\")");
    let expected = "after its answer the solver reported an error: an invalid model";
    assert_eq!((&told["status"], &told["message"]), (&"sat".into(), &expected.into()), "{told}");
    // Of no symbols nothing may be printed.
    let empty = record("(assert true)\n(check-sat)\n(get-model)\n", "sat\n");
    assert_eq!(empty["verified"], "model", "{empty}");
}

#[test]
fn files_whose_names_look_like_options() {
    for solver in ["z3", "cvc5", "yices"] {
        if !solver_is_there(solver) {
            continue;
        }
        let comparison = Comparison::new();
        let files = comparison.queries(0).join("a=b");
        fs::create_dir(&files).expect("ours");
        for name in ["T=5.smt2", "plain.smt2"] {
            let query = QUERY.replacen('\n', "\n(set-logic QF_LIA)\n", 1);
            fs::write(files.join(name), query).expect("ours");
        }
        let run = comparison.run(&[text(&files), "--solver", solver]);
        assert_eq!(run.status, 0, "{}{}", run.stdout, run.stderr);
        let verified = comparison.records().into_iter().filter(|record| record["verified"] == "model");
        assert_eq!(verified.count(), 2, "{}", comparison.log());
    }
}
