//! Hand-made records.

use hyperplan_compare::{Answer, Limit, Record, RunStatus};
use hyperplan_problem::answer::ReasonCode;

/// A run that ended with a status after some seconds, under a limit of 10.
pub(crate) fn run(solver: &str, instance: &str, status: RunStatus, wall_s: f64) -> Record {
    Record {
        instance: instance.to_owned(),
        family: "specs".to_owned(),
        sha256: "5f3a90c1b2d4e6f708192a3b4c5d6e7f".to_owned(),
        logic: Some("QF_UF".to_owned()),
        states: Some("onehot".to_owned()),
        quantifiers: Some("auto".to_owned()),
        horizon: Some(6),
        set: Vec::new(),
        solver: solver.to_owned(),
        version: Some("1.0".to_owned()),
        options: String::new(),
        seed: 0,
        repetition: 0,
        status,
        expected: None,
        verified: (status == RunStatus::Sat).then(|| "by-search".to_owned()),
        wall_s,
        cpu_s: wall_s,
        memory_mib: 12.5,
        limit: Limit { wall_s: Some(10.0), cpu_s: None, memory_mib: Some(1024) },
        exit_code: Some(match status {
            RunStatus::Sat => 0,
            RunStatus::Unsat => 1,
            RunStatus::Unsupported => 2,
            RunStatus::Unknown | RunStatus::Timeout | RunStatus::Memout => 3,
            RunStatus::Error => 4,
        }),
        signal: None,
        host: "here".to_owned(),
        variables: Some(100),
        assertions: Some(20),
        bytes: Some(4096),
        message: None,
        queries: None,
        key: String::new(),
        states_used: None,
        quantifiers_used: None,
        solver_s: Some(wall_s / 2.0),
        rounds: Some(1),
        reason_code: None,
        processor: Some("a processor".to_owned()),
        case: None,
        ended_ms: None,
    }
}

/// A comparison with something of everything: two families, two configurations of a solver, all kinds of status, a
/// wrong model, an answer against the known status, names that want to be escaped.
#[allow(dead_code, reason = "not every test wants all of it")]
pub(crate) fn sample() -> Vec<Record> {
    let mut records = Vec::new();
    let mut add = |instance: &str, runs: [(RunStatus, f64); 4]| {
        let who = [("builtin", "auto"), ("cvc5", "auto"), ("z3", "expand"), ("z3", "keep")];
        for ((solver, quantifiers), (status, wall)) in who.into_iter().zip(runs) {
            let mut record = run(solver, instance, status, wall);
            record.quantifiers = Some(quantifiers.to_owned());
            record.family = if instance.starts_with("maps") { "maps" } else { "specs" }.to_owned();
            records.push(record);
        }
    };
    use RunStatus::{Error, Memout, Sat, Timeout, Unknown, Unsat, Unsupported};
    add("maps/ar-10.hp#ar", [(Sat, 0.02), (Sat, 0.4), (Sat, 0.3), (Sat, 2.5)]);
    add("maps/ar-20.hp#ar", [(Sat, 0.1), (Sat, 3.0), (Sat, 1.5), (Timeout, 10.0)]);
    add("maps/iso-10.hp#iso", [(Sat, 0.01), (Timeout, 10.0), (Sat, 0.5), (Memout, 4.0)]);
    add("specs/rooms.hp#<script>", [(Unsat, 0.01), (Unsat, 0.1), (Unsat, 0.05), (Unsat, 0.06)]);
    add("specs/100%_ok.hp#a|b", [(Unsat, 0.0), (Unsat, 0.2), (Unsat, 0.2), (Unknown, 1.0)]);
    add("specs/reals.hp#r", [(Unsupported, 0.0), (Sat, 0.3), (Unsupported, 0.0), (Unsupported, 0.0)]);
    add("specs/model.hp#m", [(Sat, 0.2), (Error, 0.3), (Sat, 0.2), (Sat, 0.4)]);
    add("specs/known.hp#k", [(Unsat, 0.2), (Unsat, 0.3), (Unsat, 0.2), (Sat, 0.4)]);
    for record in &mut records {
        match (record.instance.as_str(), record.status) {
            ("specs/model.hp#m", Error) => {
                record.message =
                    Some("solver cvc5 gave a wrong model: it does not satisfy the query".to_owned());
                record.reason_code = Some(ReasonCode::WrongModel);
                record.queries = Some("queries/model/cvc5".to_owned());
            }
            ("specs/known.hp#k", status) => {
                record.expected = Some(Answer::Unsat);
                record.verified = None;
                record.message = (status == Sat).then(|| "said \"sat\", </script> and more".to_owned());
            }
            _ => {}
        }
    }
    records
}
