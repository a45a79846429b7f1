use super::*;
use hyperplan_smt::Request;

fn ended(code: i32, stdout: &str, stderr: &str) -> Measured {
    Measured {
        exit_code: Some(code),
        stdout: stdout.to_owned(),
        stderr: stderr.to_owned(),
        ..Measured::default()
    }
}

fn said(verdict: &str, code: Option<&str>) -> String {
    let code = serde_json::to_string(&code).expect("it is a text");
    format!(
        r#"{{"file": "a.hp", "objective": "sp", "verdict": "{verdict}", "reason": {code},
        "reason_code": {code}, "witness": null, "horizon": {{"p": 6, "q": null}},
        "verified": "by-search", "solver": {{"name": "z3", "version": "4.8"}}, "quantifiers": "expand", "states": "onehot",
        "logic": "QF_BV", "size": {{"variables": 3, "clauses": 4, "bytes": 56}},
        "iterations": 2, "seconds": {{"read": 0, "encode": 0, "solve": 0.25, "verify": 0, "total": 0.5}}}}"#
    )
    .replace('\n', " ")
}

#[test]
fn answers_to_problems() {
    let reading = of_problem(&ended(0, &said("realizable", None), ""), false);
    let expected = Reading {
        status: RunStatus::Sat,
        expected: None,
        verified: Some("by-search".to_owned()),
        version: Some("4.8".to_owned()),
        states: Some("onehot".to_owned()),
        quantifiers: Some("expand".to_owned()),
        horizon: Some(6),
        variables: Some(3),
        assertions: Some(4),
        bytes: Some(56),
        logic: Some("QF_BV".to_owned()),
        solver_s: Some(0.25),
        rounds: Some(2),
        reason_code: None,
        message: None,
        case: None,
    };
    assert_eq!(reading, expected);
    let status = |code, verdict, reason| of_problem(&ended(code, &said(verdict, reason), ""), false).status;
    assert_eq!(status(1, "unrealizable", None), RunStatus::Unsat);
    assert_eq!(status(3, "unknown", Some("timeout")), RunStatus::Timeout);
    assert_eq!(status(3, "unknown", Some("out-of-memory")), RunStatus::Memout);
    assert_eq!(status(3, "unknown", Some("incomplete")), RunStatus::Unknown);
    // A status that does not go with what was said is not to be believed.
    assert_eq!(status(1, "realizable", None), RunStatus::Error);
    assert_eq!(of_problem(&ended(0, &said("realizable", None), ""), true).status, RunStatus::Timeout);
}

#[test]
fn failures_on_problems() {
    let reading = of_problem(&ended(2, "", "error: sp: no quantifiers\n"), false);
    assert_eq!(
        (reading.status, reading.message.as_deref()),
        (RunStatus::Unsupported, Some("sp: no quantifiers"))
    );
    let wrong = "warning: x\nerror: sp: solver fake gave a wrong model: it does not satisfy the query\n";
    for over in [false, true] {
        let failed = r#"{"objective": "sp", "reason": "x", "reason_code": "wrong-model"}"#;
        let reading = of_problem(&ended(4, failed, wrong), over);
        assert_eq!((reading.status, reading.verified.as_deref()), (RunStatus::Error, Some("refuted")));
    }
    let reading = of_problem(&ended(4, "", "error: sp: solver fake ended without an answer\n"), false);
    assert_eq!((reading.status, reading.verified), (RunStatus::Error, None));
    assert_eq!(of_problem(&ended(5, "", "error: x"), false).verified.as_deref(), Some("refuted"));
    let killed = Measured { signal: Some(11), ..Measured::default() };
    let reading = of_problem(&killed, false);
    assert_eq!((reading.status, reading.message.as_deref()), (RunStatus::Error, Some("ended by signal 11")));
    let killed = Measured { signal: Some(9), exceeded: Some(Exceeded::Memory), ..Measured::default() };
    assert_eq!(of_problem(&killed, false).status, RunStatus::Memout);
    let long = of_problem(&ended(4, "", &"ä".repeat(2000)), false).message.expect("there is one");
    assert_eq!(long.chars().count(), MESSAGE + 3);
}

fn query(checks: &[Option<Answer>]) -> Query {
    Query { checks: checks.to_vec(), requests: vec![Request::Check; checks.len()], ..Query::default() }
}

fn of_query(measured: &Measured, query: &Query, over: bool) -> Reading {
    super::of_query(measured, query, &Heard::new(query, &measured.stdout), over)
}

#[test]
fn answers_to_queries() {
    let of = |stdout: &str, checks: &[Option<Answer>]| {
        let reading = of_query(&ended(0, stdout, ""), &query(checks), false);
        (reading.status, reading.expected, reading.message)
    };
    let sat = Some(Answer::Sat);
    assert_eq!(of("sat\n((define-fun x () Bool\n true))\n", &[None]), (RunStatus::Sat, None, None));
    assert_eq!(of("success\n unsat \r\n", &[sat]), (RunStatus::Unsat, sat, None));
    assert_eq!(of("unknown\n", &[sat]), (RunStatus::Unknown, sat, None));
    assert_eq!(of("timeout\n", &[sat]), (RunStatus::Timeout, sat, None));
    assert_eq!(of("unsat\n(error \"no model\")\n", &[None]).0, RunStatus::Unsat);
    // What is answered after a complaint is not the query.
    let complaint = "(error \"line 2: unknown constant y\")";
    assert_eq!(
        of(&format!("{complaint}\nsat\n"), &[sat]),
        (RunStatus::Error, sat, Some(complaint.to_owned()))
    );
    assert_eq!(of("(error \"logic not supported\")\nunknown\n", &[None]).0, RunStatus::Unsupported);
}

/// Of several answers none stands for all, but a wrong one is wrong.
#[test]
fn several_checks() {
    let of = |stdout: &str, checks: &[Option<Answer>]| {
        let reading = of_query(&ended(0, stdout, ""), &query(checks), false);
        (reading.status, reading.expected, reading.message.expect("it says why"))
    };
    let (sat, unsat) = (Some(Answer::Sat), Some(Answer::Unsat));
    let why = "2 checks in one file; only answers against a known status count".to_owned();
    assert_eq!(of("sat\nunsat\n", &[sat, unsat]), (RunStatus::Unsupported, None, why.clone()));
    assert_eq!(of("sat\n", &[None, None]), (RunStatus::Unsupported, None, why.clone()));
    assert_eq!(of("sat\nunsat\n", &[unsat, unsat]), (RunStatus::Sat, unsat, "check 1 of 2".to_owned()));
    assert_eq!(of("sat\nsat\n", &[None, unsat]), (RunStatus::Sat, unsat, "check 2 of 2".to_owned()));
    assert_eq!(of("(error \"x\")\nsat\nsat\n", &[None, unsat]), (RunStatus::Unsupported, None, why));
}

#[test]
fn failures_on_queries() {
    let of = |code, stdout: &str, stderr: &str| {
        let reading = of_query(&ended(code, stdout, stderr), &query(&[None]), false);
        (reading.status, reading.message.expect("it says why"))
    };
    assert_eq!(
        of(1, "(error \"line 1: no\")\n", ""),
        (RunStatus::Error, "(error \"line 1: no\")".to_owned())
    );
    assert_eq!(of(1, "(error \"logic not supported\")\n", "").0, RunStatus::Unsupported);
    for refusal in ["unknown logic: QF_DT", "invalid quantifier nesting (not an exists/forall problem)"] {
        assert_eq!(of(0, &format!("(error \"{refusal}\")\n"), "").0, RunStatus::Unsupported);
    }
    assert_eq!(of(1, "", "terminate called: std::bad_alloc\n").0, RunStatus::Memout);
    assert_eq!(of(0, "satisfiable", ""), (RunStatus::Error, "no answer, exit status 0".to_owned()));
    assert_eq!(of(0, "", "").0, RunStatus::Error);
    let crash = Measured { signal: Some(6), stdout: "sat\n".to_owned(), ..Measured::default() };
    assert_eq!(of_query(&crash, &query(&[None]), false).status, RunStatus::Error);
    let late = Measured { exceeded: Some(Exceeded::Time), stdout: "sat\n".to_owned(), ..Measured::default() };
    assert_eq!(of_query(&late, &query(&[None]), false).status, RunStatus::Timeout);
    // A file without a check asks nothing.
    assert_eq!(of_query(&ended(0, "", ""), &query(&[]), false).status, RunStatus::Error);
}

#[test]
fn several_answers_to_one_check_are_none() {
    let query = query(&[None]);
    let of = |stdout: &str| of_query(&ended(0, stdout, ""), &query, false);
    assert_eq!(of("sat\nsat\n").status, RunStatus::Sat);
    let reading = of("sat\nunsat\n");
    assert_eq!(reading.status, RunStatus::Error);
    assert_eq!(reading.message.as_deref(), Some("it gave several answers to one check"));
}

#[test]
fn the_answer_is_that_of_the_check() {
    let of = |text: &str, stdout: &str| {
        let reading = of_query(&ended(0, stdout, ""), &Query::scan(text), false);
        (reading.status, reading.message)
    };
    let echo = "(echo \"sat\")(check-sat)(echo \"unsat\")";
    assert_eq!(of(echo, "sat\nunsat\nunsat\n"), (RunStatus::Unsat, None));
    assert_eq!(of(echo, "\"sat\"\nunknown\n\"unsat\"\n"), (RunStatus::Unknown, None));
    assert_eq!(of(echo, "sat\n(error \"no products\")\n").0, RunStatus::Error);
    assert_eq!(of(echo, "sat\n").0, RunStatus::Error);
    assert_eq!(of("(check-sat)", "(error \"line 1:\nsat\n\")\n").0, RunStatus::Error);
    // What is said of the model is told; what is said of anything else is not.
    let all = "(check-sat)(get-unsat-core)(get-model)";
    let disowned = "after its answer the solver reported an error: an invalid model".to_owned();
    assert_eq!(of(all, "sat\n(error \"no core\")\n()\n"), (RunStatus::Sat, None));
    assert_eq!(
        of(all, "sat\n(error \"no core\")\n(error \"an invalid model\")\n"),
        (RunStatus::Sat, Some(disowned.clone()))
    );
    assert_eq!(of("(check-sat)", "sat\n(error \"an invalid model\")\n"), (RunStatus::Sat, Some(disowned)));
    assert_eq!(of(all, "unsat\n(p q)\n(error \"no model\")\n"), (RunStatus::Unsat, None));
}
