//! What lanes print, and what several of them come to.

use super::Stop;
use crate::failure::{Exit, Failure};
use hyperplan_compare::Finish;
use hyperplan_outlet::one_line;
use hyperplan_plan::{self as plan, Outcome};
use hyperplan_problem::answer::{Answer, CostValue, Failed, ReasonCode, Verdict, to_strategy};
use hyperplan_problem::{Objective, Problem};
use hyperplan_solver::{Identity, QuerySize};

/// The answer that a lane printed, or why it printed none.
pub(super) fn ended(finish: &Finish) -> Result<Answer, Stop> {
    let line = finish.stdout.lines().rfind(|line| !line.trim().is_empty()).unwrap_or_default();
    if let Ok(answer) = serde_json::from_str(line) {
        return Ok(answer);
    }
    let status = match finish.exit_code {
        Some(2) => Exit::Input,
        Some(3) => Exit::Undecided,
        Some(5) => Exit::Bug,
        _ => Exit::Solver,
    };
    if let Ok(Failed { reason, reason_code, .. }) = serde_json::from_str(line) {
        return Err((Failure::new(status, reason), reason_code));
    }
    let said = finish
        .stderr
        .lines()
        .rfind(|line| !line.trim().is_empty())
        .unwrap_or("a process ended without an answer");
    let said = one_line(said.trim_start_matches("error: ")).into_owned();
    Err((Failure::new(status, said), ReasonCode::SolverFailed))
}

/// An answer of another process as an outcome of this one.
pub(super) fn outcome(problem: &Problem, objective: &Objective, answer: &Answer) -> Result<Outcome, Stop> {
    let strategy = answer.witness.as_ref().map(|paths| to_strategy(problem, objective, paths));
    let strategy = strategy.transpose().map_err(|error| {
        let message = format!("a process of ours printed what is no strategy: {error}");
        (Failure::new(Exit::Bug, message), ReasonCode::Bug)
    })?;
    Ok(Outcome {
        verdict: answer.verdict,
        reason: None,
        horizons: objective
            .paths
            .iter()
            .map(|path| answer.horizon.get(&path.name).copied().flatten())
            .collect(),
        witness: strategy,
        verified: answer.verified,
        closest: None,
        solver: Identity { name: answer.solver.name.clone(), version: answer.solver.version.clone() },
        quantifiers: answer.quantifiers,
        because: None,
        states: answer.states,
        iterations: answer.iterations,
        size: QuerySize {
            clauses: answer.size.clauses,
            variables: answer.size.variables,
            bytes: answer.size.bytes.unwrap_or(0),
            logic: answer.logic.clone(),
        },
        seconds: plan::Seconds {
            encode: answer.seconds.encode,
            solve: answer.seconds.solve,
            verify: answer.seconds.verify,
        },
        notes: Vec::new(),
    })
}

/// Whether nothing is known to be open in an answer: its costs are the least.
pub(super) fn is_whole(answer: &Answer) -> bool {
    answer.verdict != Verdict::Unknown && answer.costs.iter().all(|cost| cost.least >= cost.value)
}

fn values(answer: &Answer) -> Vec<i64> {
    answer.costs.iter().map(|cost| cost.value).collect()
}

/// The cheapest of the answers of cases, and what its costs are at least in all of them; `floor` is no more than that, whatever those
/// without an answer have, if there are such.
pub(super) fn cheapest<'a>(
    answers: &[&'a Answer],
    floor: Option<&[i64]>,
) -> Option<(&'a Answer, Vec<CostValue>)> {
    let realizable: Vec<&Answer> =
        answers.iter().copied().filter(|answer| answer.verdict == Verdict::Realizable).collect();
    let best = realizable.iter().copied().min_by_key(|answer| values(answer))?;
    let costs = best.costs.iter().enumerate().map(|(at, cost)| {
        // A case that has more of what counts more says nothing of this.
        let may_be_better = |answer: &&&Answer| {
            let before = answer.costs[..at].iter().zip(&best.costs);
            before
                .map(|(other, cost)| other.least.cmp(&cost.value))
                .find(|order| order.is_ne())
                .is_none_or(|order| order.is_lt())
        };
        let least = realizable.iter().filter(may_be_better).map(|answer| answer.costs[at].least).min();
        let open = floor.and_then(|floor| floor.get(at).copied());
        let least = least.into_iter().chain(open).fold(cost.value, i64::min);
        CostValue { least, ..cost.clone() }
    });
    Some((best, costs.collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn answer(costs: &[(i64, i64)]) -> Answer {
        let cost = |(value, least): &(i64, i64)| json!({ "expression": "c", "value": value, "least": least });
        let costs: Vec<_> = costs.iter().map(cost).collect();
        serde_json::from_value(json!({
            "file": "a.hp", "objective": "o", "verdict": "realizable", "reason": null, "horizon": {}, "witness": null,
            "verified": null, "solver": { "name": "builtin", "version": "" }, "quantifiers": "cegis", "states": "onehot",
            "iterations": 1, "seconds": { "read": 0.0, "encode": 0.0, "solve": 0.0, "verify": 0.0, "total": 0.0 },
            "costs": costs,
        }))
        .expect("it is an answer")
    }

    /// What two costs of each case are, found and proved, as a search that may end anywhere knows them: what is said of all cases is
    /// never more than the least there is, and all that there is to know where every case knows its own.
    #[test]
    fn nothing_is_below_what_is_said_to_be_least() {
        for code in 0..3usize.pow(8) {
            let digit = |at: u32| (code / 3usize.pow(at) % 3) as i64;
            // By case what is least, and what is known.
            let cases = [[digit(0), digit(1)], [digit(2), digit(3)]];
            let known = [[digit(4), digit(5)], [digit(6), digit(7)]];
            let of = |case: usize| {
                let ([first, second], [more, less]) = (cases[case], known[case]);
                match more {
                    // All is known of the first, and something or all of the second.
                    0 => [(first, first), (second + (less + 1) / 2, (second - less / 2).max(0))],
                    // The first was not lowered to its least, and the second not looked at.
                    _ => [(first + more - 1, (first - 1 - less).max(0)), (second + less, 0)],
                }
            };
            let answers = [answer(&of(0)), answer(&of(1))];
            let least = cases.iter().min().expect("there are two");
            let all: Vec<&Answer> = answers.iter().collect();
            let (best, costs) = cheapest(&all, None).expect("both are realizable");
            let said = [costs[0].least, costs[1].least];
            assert!(values(best) >= least.to_vec() && said[0] <= least[0], "{cases:?} {known:?}");
            let exact = best.costs[0].value == least[0];
            assert!(!exact || said[1] <= least[1], "{cases:?} {known:?}: {said:?}");
            if answers.iter().all(is_whole) {
                assert_eq!(said, *least);
            }
            // Something that nobody knows may have less.
            let (_, open) = cheapest(&all[..1], Some(&[0, 0])).expect("one is realizable");
            assert!(open.iter().all(|cost| cost.least == 0));
        }
    }
}
