//! What is found wrong, and whose fault it is.

mod sample;

use hyperplan_compare::{Answer, Fault, Kind, Record, RunStatus, judge};
use sample::{run, sample};

fn kinds(records: &[Record]) -> Vec<(Kind, Fault)> {
    judge(records).findings.iter().map(|finding| (finding.kind, finding.fault)).collect()
}

/// A run whose answer nothing vouches for.
fn said(solver: &str, status: RunStatus) -> Record {
    Record { verified: None, ..run(solver, "f.hp#o", status, 1.0) }
}

fn mode(solver: &str, quantifiers: &str, status: RunStatus) -> Record {
    Record { quantifiers: Some(quantifiers.to_owned()), ..said(solver, status) }
}

fn query(solver: &str, status: RunStatus) -> Record {
    Record { quantifiers: None, states: None, ..said(solver, status) }
}

#[test]
fn agreement_is_clean() {
    let records =
        [said("z3", RunStatus::Sat), said("cvc5", RunStatus::Sat), said("yices", RunStatus::Timeout)];
    let judgement = judge(&records);
    assert!(judgement.is_clean());
    assert_eq!(judgement.fault(), None);
    assert_eq!(judgement.to_string(), "");
    assert!(judge(&[]).is_clean());
}

#[test]
fn solvers_that_got_the_same_blame_themselves() {
    let records = [said("z3", RunStatus::Sat), said("cvc5", RunStatus::Unsat)];
    assert_eq!(kinds(&records), [(Kind::Disagreement, Fault::Solver)]);
    assert_eq!(judge(&records).fault(), Some(Fault::Solver));
    let queries = [query("z3", RunStatus::Sat), query("cvc5", RunStatus::Unsat)];
    assert_eq!(kinds(&queries), [(Kind::Disagreement, Fault::Solver)]);
}

#[test]
fn different_encodings_that_disagree_blame_us() {
    let records = [mode("z3", "keep", RunStatus::Sat), mode("z3", "expand", RunStatus::Unsat)];
    assert_eq!(kinds(&records), [(Kind::SelfContradiction, Fault::Ours)]);
    assert_eq!(judge(&records).fault(), Some(Fault::Ours));
    let records = [mode("z3", "keep", RunStatus::Sat), mode("cvc5", "expand", RunStatus::Unsat)];
    assert_eq!(kinds(&records), [(Kind::Disagreement, Fault::Ours)]);
    // All that were asked one way say the same, and are wrong.
    let records = [
        Record { verified: Some("by-search".to_owned()), ..mode("z3", "keep", RunStatus::Sat) },
        mode("z3", "expand", RunStatus::Unsat),
        mode("cvc5", "expand", RunStatus::Unsat),
    ];
    assert_eq!(kinds(&records), [(Kind::SelfContradiction, Fault::Ours)]);
}

/// What `auto` became is what was asked.
#[test]
fn the_encodings_that_were_used() {
    let used =
        |quantifiers: &str, record| Record { quantifiers_used: Some(quantifiers.to_owned()), ..record };
    let records = [used("keep", said("z3", RunStatus::Sat)), used("expand", said("cvc5", RunStatus::Unsat))];
    assert_eq!(kinds(&records), [(Kind::Disagreement, Fault::Ours)]);
    let records =
        [used("keep", said("z3", RunStatus::Sat)), used("keep", mode("cvc5", "keep", RunStatus::Unsat))];
    assert_eq!(kinds(&records), [(Kind::Disagreement, Fault::Solver)]);
}

#[test]
fn one_solver_and_two_seeds() {
    let records = [said("z3", RunStatus::Sat), Record { seed: 1, ..said("z3", RunStatus::Unsat) }];
    assert_eq!(kinds(&records), [(Kind::SelfContradiction, Fault::Solver)]);
    // Whoever else took part, and whatever they said.
    for status in [RunStatus::Sat, RunStatus::Unsat, RunStatus::Timeout] {
        let records = [&[said("cvc5", status)], &records[..]].concat();
        assert_eq!(kinds(&records), [(Kind::SelfContradiction, Fault::Solver)]);
    }
    let others = [said("cvc5", RunStatus::Sat), said("cvc5", RunStatus::Sat), said("z3", RunStatus::Unsat)];
    assert_eq!(kinds(&others), [(Kind::Disagreement, Fault::Solver)]);
}

#[test]
fn a_checked_witness_tells_who_is_wrong() {
    let right = Record { verified: Some("by-search".to_owned()), ..said("z3", RunStatus::Sat) };
    let records = [right.clone(), said("builtin", RunStatus::Unsat)];
    assert_eq!(kinds(&records), [(Kind::Disagreement, Fault::Ours)], "the embedded engine is ours");
    assert_eq!(judge(&records).findings[0].truth, Some(Answer::Sat));
    assert_eq!(kinds(&[right, said("cvc5", RunStatus::Unsat)]), [(Kind::Disagreement, Fault::Solver)]);
}

#[test]
fn other_constants_and_other_files_are_other_instances() {
    let sat = said("z3", RunStatus::Sat);
    let set = Record { set: vec!["T=1".to_owned()], ..said("z3", RunStatus::Unsat) };
    let edited = Record { sha256: "0".to_owned(), ..said("z3", RunStatus::Unsat) };
    assert!(judge(&[sat, set, edited]).is_clean());
}

#[test]
fn against_the_known_status() {
    let known = |record| Record { expected: Some(Answer::Unsat), ..record };
    assert_eq!(kinds(&[known(said("z3", RunStatus::Sat))]), [(Kind::Expected, Fault::Ours)]);
    assert_eq!(kinds(&[known(query("z3", RunStatus::Sat))]), [(Kind::Expected, Fault::Solver)]);
    let both = [known(said("z3", RunStatus::Sat)), known(said("cvc5", RunStatus::Unsat))];
    assert_eq!(kinds(&both), [(Kind::Expected, Fault::Solver)], "once");
    assert_eq!(judge(&both).findings[0].claims.len(), 2);
    // All that answered say otherwise.
    let all = [known(query("z3", RunStatus::Sat)), known(query("cvc5", RunStatus::Sat))];
    assert_eq!(kinds(&all), [(Kind::Expected, Fault::Status)]);
    assert_eq!(judge(&all).fault(), Some(Fault::Status));
    let doubt = "against the known status, but all agree: the status may be wrong; known: unsat";
    assert!(judge(&all).to_string().contains(doubt), "{}", judge(&all));
    let yices = known(query("yices", RunStatus::Unsat));
    assert_eq!(kinds(&[&all[..], &[yices]].concat()), [(Kind::Expected, Fault::Solver)]);
}

#[test]
fn witnesses_that_fail() {
    let refuted = |record| Record { verified: Some("refuted".to_owned()), ..record };
    assert_eq!(kinds(&[refuted(query("z3", RunStatus::Sat))]), [(Kind::WrongModel, Fault::Solver)]);
    assert_eq!(kinds(&[refuted(said("z3", RunStatus::Sat))]), [(Kind::RefutedStrategy, Fault::Ours)]);
    let bug = Record { exit_code: Some(5), ..said("z3", RunStatus::Error) };
    assert_eq!(kinds(&[bug]), [(Kind::RefutedStrategy, Fault::Ours)]);
    let missing = Record { message: Some("no such solver".to_owned()), ..said("z3", RunStatus::Error) };
    assert!(judge(&[missing]).is_clean());
    // What is refuted contradicts nobody.
    let records = [refuted(query("z3", RunStatus::Sat)), query("cvc5", RunStatus::Unsat)];
    assert_eq!(kinds(&records), [(Kind::WrongModel, Fault::Solver)]);
}

#[test]
fn what_is_printed() {
    let expected = "\
specs/known.hp#k: against the known status, a bug of hyperplan's until shown otherwise; known: unsat
  z3 keep says sat
    said \"sat\", </script> and more
  builtin auto says unsat
  cvc5 auto says unsat
  z3 expand says unsat
specs/model.hp#m: a model fails, a solver's fault; known: sat
  cvc5 auto
    solver cvc5 gave a wrong model: it does not satisfy the query
    queries: queries/model/cvc5
";
    assert_eq!(judge(&sample()).to_string(), expected);
    assert_eq!(judge(&sample()).fault(), Some(Fault::Ours));
}

/// A witness says more than what somebody once wrote.
#[test]
fn a_checked_witness_refutes_a_status() {
    let known = |record: Record| Record { expected: Some(Answer::Unsat), ..record };
    let checked =
        |solver| Record { verified: Some("model".to_owned()), ..known(query(solver, RunStatus::Sat)) };
    assert_eq!(kinds(&[checked("z3")]), [(Kind::WrongStatus, Fault::Status)]);
    let records = [checked("z3"), checked("yices"), known(query("liar", RunStatus::Unsat))];
    let judgement = judge(&records);
    assert_eq!(kinds(&records), [(Kind::WrongStatus, Fault::Status), (Kind::Disagreement, Fault::Solver)]);
    assert!(judgement.findings.iter().all(|finding| finding.truth == Some(Answer::Sat)));
    let first = judgement.to_string().lines().next().map(str::to_owned);
    let expected = "f.hp#o: the known status is wrong, for a checked witness contradicts it; known: sat";
    assert_eq!(first.as_deref(), Some(expected));
    assert_eq!(judgement.fault(), Some(Fault::Status));
    // Without the witness it is the other way round.
    let records = [known(query("z3", RunStatus::Sat)), known(query("liar", RunStatus::Unsat))];
    assert_eq!(kinds(&records), [(Kind::Expected, Fault::Solver)]);
}
