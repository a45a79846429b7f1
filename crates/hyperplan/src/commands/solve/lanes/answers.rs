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
