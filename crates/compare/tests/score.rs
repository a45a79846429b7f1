//! Scores, with what is easily got wrong: ties, no instance solved, times of zero, repetitions, and many records.

#![allow(clippy::float_cmp, reason = "sums of numbers that binary fractions hold exactly")]

mod sample;

use std::time::{Duration, Instant};

use hyperplan_compare::contest::Contest;
use hyperplan_compare::score::{Score, Scores, scores};
use hyperplan_compare::{Answer, Record, RunStatus, judge};
use hyperplan_problem::answer::ReasonCode;
use sample::{run, sample};

fn score_all(records: &[Record]) -> Scores {
    scores(&Contest::new(records), |_| true)
}

fn of<'s>(scores: &'s Scores, who: &str) -> &'s Score {
    scores.scores.iter().find(|score| score.contestant == who).expect("the contestant takes part")
}

#[test]
fn par2_counts_timeouts_twice() {
    let all = score_all(&[run("z3", "a", RunStatus::Sat, 1.0), run("z3", "b", RunStatus::Timeout, 10.0)]);
    let z3 = of(&all, "z3");
    assert_eq!((z3.counted, z3.solved, z3.timeout, z3.par2), (2, 1, 1, 10.5));
    assert_eq!((z3.parallel.correct, z3.parallel.wall_s), (1, 1.0));
}

#[test]
fn unsupported_is_not_held_against_a_solver() {
    let all = score_all(&[run("z3", "a", RunStatus::Sat, 1.0), run("z3", "b", RunStatus::Unsupported, 0.0)]);
    let z3 = of(&all, "z3");
    assert_eq!((z3.counted, z3.unsupported, z3.par2), (1, 1, 1.0));
    let none = score_all(&[run("z3", "a", RunStatus::Unsupported, 1.0)]);
    assert_eq!((none.scores[0].counted, none.scores[0].par2, none.best.counted), (0, 0.0, 0));
}

#[test]
fn without_a_limit_the_longest_run_is_the_measure() {
    let mut records = [run("z3", "a", RunStatus::Sat, 3.0), run("z3", "b", RunStatus::Unknown, 1.0)];
    for record in &mut records {
        record.limit.wall_s = None;
    }
    assert_eq!(score_all(&records).scores[0].par2, f64::midpoint(3.0, 6.0));
}

#[test]
fn ties_share_a_place() {
    let all = score_all(&["z3", "cvc5", "yices"].map(|solver| {
        let wall = if solver == "yices" { 2.0 } else { 0.0 };
        run(solver, "a", RunStatus::Sat, wall)
    }));
    assert_eq!(["z3", "cvc5", "yices"].map(|who| of(&all, who).rank), [1, 1, 3]);
    assert_eq!(["z3", "cvc5", "yices"].map(|who| of(&all, who).fastest), [1, 1, 0]);
    assert!(all.scores.iter().all(|score| score.unique == 0));
}

#[test]
fn errors_come_before_everything() {
    let mut wrong = run("fast", "a", RunStatus::Unsat, 0.0);
    let right = run("slow", "a", RunStatus::Sat, 9.0);
    wrong.verified = None;
    let all = score_all(&[wrong, run("fast", "b", RunStatus::Sat, 0.0), right]);
    assert_eq!(of(&all, "fast").wrong, 1, "the other's witness was checked");
    assert_eq!((of(&all, "slow").rank, of(&all, "fast").rank), (1, 2));
    assert_eq!(all.best.wrong, 0);
}

#[test]
fn processors_do_not_help_the_sequential_score() {
    let mut parallel = run("many", "a", RunStatus::Sat, 5.0);
    parallel.cpu_s = 10.5;
    let all = score_all(&[parallel, run("one", "a", RunStatus::Sat, 8.0)]);
    assert_eq!((of(&all, "many").rank, of(&all, "one").rank), (1, 2));
    assert_eq!((of(&all, "many").sequential_rank, of(&all, "one").sequential_rank), (2, 1));
    assert_eq!(of(&all, "many").sequential.correct, 0);
}

#[test]
fn what_is_in_dispute_is_left_out() {
    let said = |solver: &str, status| Record { verified: None, ..run(solver, "a", status, 1.0) };
    let records = [said("z3", RunStatus::Sat), said("cvc5", RunStatus::Unsat)];
    let all = score_all(&records);
    assert_eq!((all.disputed, of(&all, "z3").counted, of(&all, "cvc5").wrong), (1, 0, 0));
    let known = records.map(|record| Record { expected: Some(Answer::Sat), ..record });
    let all = score_all(&known);
    assert_eq!((all.disputed, of(&all, "z3").solved, of(&all, "cvc5").wrong), (0, 1, 1));
}

#[test]
fn the_median_of_repetitions() {
    let repeated = |runs: &[(RunStatus, f64)]| -> Score {
        let records: Vec<Record> = (0..)
            .zip(runs)
            .map(|(repetition, &(status, wall))| Record { repetition, ..run("z3", "a", status, wall) })
            .collect();
        score_all(&records).scores[0].clone()
    };
    assert_eq!(repeated(&[(RunStatus::Sat, 4.0), (RunStatus::Sat, 1.0), (RunStatus::Sat, 2.0)]).par2, 2.0);
    let twice = [(RunStatus::Sat, 4.0), (RunStatus::Timeout, 10.0), (RunStatus::Sat, 2.0)];
    assert_eq!(repeated(&twice).par2, 4.0);
    assert_eq!(
        repeated(&[(RunStatus::Sat, 4.0), (RunStatus::Error, 0.0)]).solved,
        0,
        "every other time is not solved"
    );
}

#[test]
fn unique_and_virtual_best() {
    let all = score_all(&sample());
    assert_eq!((of(&all, "cvc5 auto").unique, of(&all, "z3 expand").unique), (1, 0));
    assert_eq!((all.best.counted, all.best.solved, all.best.wrong), (8, 8, 0));
    assert!(all.scores.iter().all(|score| score.solved <= all.best.solved));
    // Two configurations of z3 and nobody else.
    let keep = |record: Record| Record { quantifiers: Some("keep".to_owned()), ..record };
    let z3 = || run("z3", "a", RunStatus::Sat, 1.0);
    let all = score_all(&[z3(), keep(z3()), run("cvc5", "a", RunStatus::Timeout, 10.0)]);
    assert_eq!((of(&all, "z3 keep").unique, of(&all, "z3 keep").unique_solver), (0, 1));
}

/// A model that does not satisfy its query is no mere failure to answer.
#[test]
fn wrong_models_are_wrong() {
    let model = Record {
        reason_code: Some(ReasonCode::WrongModel),
        message: Some("solver z3 gave a wrong model: p is no path".to_owned()),
        ..run("z3", "a", RunStatus::Error, 1.0)
    };
    let crash = Record { message: Some("z3 ended".to_owned()), ..run("z3", "b", RunStatus::Error, 1.0) };
    let all = score_all(&[model, crash]);
    assert_eq!((of(&all, "z3").wrong, of(&all, "z3").error, of(&all, "z3").parallel.errors), (1, 1, 1));
}

#[test]
fn versions_tell_contestants_apart() {
    let version = |version: Option<&str>, instance| Record {
        version: version.map(str::to_owned),
        ..run("z3", instance, RunStatus::Sat, 1.0)
    };
    let labels = |records: &[Record]| -> Vec<String> {
        Contest::new(records).contestants.into_iter().map(|contestant| contestant.label).collect()
    };
    assert_eq!(labels(&[version(Some("1"), "a"), version(None, "b")]), ["z3"]);
    assert_eq!(labels(&[version(Some("1"), "a"), version(Some("1 (a build)"), "b")]), ["z3"]);
    assert_eq!(labels(&[version(Some("1"), "a"), version(Some("10"), "b")]), ["z3 1", "z3 10"]);
    let builds = ["1", "1 (a)", "1 (b)"].map(|text| version(Some(text), "a"));
    assert_eq!(labels(&builds), ["z3 1", "z3 1 (a)", "z3 1 (b)"]);
    assert_eq!(labels(&[version(Some("1"), "a"), version(Some("2"), "a")]), ["z3 1", "z3 2"]);
}

#[test]
fn random_contests_add_up() {
    let mut numbers = hyperplan_random::Random::new(1);
    let mut random = |below| numbers.below(below);
    for round in 0..300 {
        let statuses = [
            RunStatus::Sat,
            RunStatus::Unsat,
            RunStatus::Unknown,
            RunStatus::Timeout,
            RunStatus::Memout,
            RunStatus::Error,
            RunStatus::Unsupported,
        ];
        let walls = [0.0, 0.5, 1.0, 10.0];
        let records: Vec<Record> = (0..random(40))
            .map(|_| {
                let solver = ["z3", "cvc5", "builtin"][random(3)];
                let instance = ["a", "b", "c", "d"][random(4)];
                run(solver, instance, statuses[random(7)], walls[random(4)])
            })
            .collect();
        let all = score_all(&records);
        for score in all.scores.iter().chain([&all.best]) {
            assert_eq!(score.sat + score.unsat, score.solved, "round {round}");
            let not = score.unknown + score.timeout + score.memout + score.error + score.wrong;
            assert_eq!(score.solved + not, score.counted, "round {round}");
            assert!(score.par2 <= 20.0 && score.unique <= score.unique_solver, "round {round}");
            assert!(score.sequential.correct <= score.parallel.correct, "round {round}");
            assert!(score.counted == 0 || score.solved <= all.best.solved, "round {round}");
        }
        let wins: usize = all.scores.iter().map(|score| score.unique).sum();
        assert!(wins <= all.best.solved, "round {round}");
        // The order of the log means nothing.
        let mut reversed = records.clone();
        reversed.reverse();
        if records.iter().enumerate().all(|(i, a)| !records[..i].contains(a)) {
            assert_eq!(judge(&reversed).fault(), judge(&records).fault(), "round {round}");
        }
    }
}

#[test]
fn ten_thousand_records_are_fast() {
    let solvers = ["z3", "cvc5", "yices", "builtin"];
    let records: Vec<Record> = (0..10_000)
        .map(|i| run(solvers[i % 4], &format!("family-{}/file-{}.hp", i % 7, i / 4), RunStatus::Sat, 1.0))
        .collect();
    let start = Instant::now();
    let dir = tempfile::tempdir().expect("a temporary folder");
    hyperplan_compare::report::write_all(&records, dir.path()).expect("a folder that can be written");
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
}

#[test]
fn solvers_by_themselves_are_told_from_those_that_hyperplan_asks() {
    let problem = |solver: &str| run(solver, "a.hp#o", RunStatus::Sat, 1.0);
    let query = |solver: &str| Record {
        quantifiers: None,
        states: None,
        ..run(solver, "a.smt2", RunStatus::Sat, 1.0)
    };
    let names = |records: &[Record]| -> Vec<String> {
        Contest::new(records).contestants.into_iter().map(|contestant| contestant.label).collect()
    };
    assert_eq!(names(&[problem("z3"), query("z3")]), ["z3", "hyperplan z3"]);
    assert_eq!(names(&[problem("z3"), problem("cvc5")]), ["cvc5", "z3"]);
    assert_eq!(names(&[query("z3"), query("cvc5")]), ["cvc5", "z3"]);
    let keep = Record { quantifiers: Some("keep".to_owned()), ..problem("z3") };
    assert_eq!(names(&[problem("z3"), keep, query("z3")]), ["z3", "hyperplan z3 auto", "hyperplan z3 keep"]);
}

#[test]
fn the_virtual_best_is_never_wrong() {
    let known = |record: Record| Record { expected: Some(Answer::Unsat), verified: None, ..record };
    let all = score_all(&[
        known(run("liar", "a", RunStatus::Sat, 0.1)),
        known(run("z3", "a", RunStatus::Timeout, 10.0)),
        known(run("liar", "b", RunStatus::Sat, 0.1)),
    ]);
    // Of `b` there is nothing but a wrong answer.
    assert_eq!((all.best.counted, all.best.wrong, all.best.timeout, all.best.par2), (1, 0, 1, 20.0));
    assert_eq!((of(&all, "liar").counted, of(&all, "liar").wrong), (2, 2));
}

#[test]
fn a_checked_witness_counts_though_the_status_is_wrong() {
    let known = |record: Record| Record { expected: Some(Answer::Unsat), ..record };
    let all = score_all(&[
        known(run("z3", "a", RunStatus::Sat, 1.0)),
        known(Record { verified: None, ..run("liar", "a", RunStatus::Unsat, 0.1) }),
    ]);
    assert_eq!((of(&all, "z3").solved, of(&all, "z3").wrong), (1, 0));
    assert_eq!((of(&all, "liar").solved, of(&all, "liar").wrong), (0, 1));
}
