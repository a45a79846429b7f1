//! Several answers: strategies that differ, one after the other, until there are as many as are wanted or there is no other.
//!
//! Each is an answer to the same question with one more demand: that the strategy is none of those before ([`Distinction`]). So
//! each is verified as every answer is, and that there is no other is proved as everything is that is impossible. What is to be
//! as small as possible stays what it was at first; what is preferred says which comes next.

use crate::cheapest::{Value, cheapest_with, to_the_end};
use crate::config::{Config, Outcome, Verdict};
use crate::detour::{straightened_among, time_for};
use crate::fact::{Error, Reason};
use crate::prepare::is_existential;
use hyperplan_problem::{Difference, Distinction, Objective, Problem, Strategy, Target};
use hyperplan_solver::Unknown;

/// What is wanted.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// How many in all.
    pub number: usize,
    /// In what they differ.
    pub difference: Difference,
    /// What none has more of than the first, and it has so much.
    pub kept: &'a [(Target, i64)],
    /// What is preferred.
    pub preferred: &'a [Target],
    /// Whether detours are taken out.
    pub straight: bool,
}

/// Answers besides the first.
#[derive(Debug)]
pub struct Several {
    /// Each with its strategy, or counterexample.
    pub others: Vec<Another>,
    /// What is known of others still.
    pub more: More,
}

/// One more answer.
#[derive(Debug)]
pub struct Another {
    /// The answer.
    pub outcome: Outcome,
    /// What is preferred comes to so much.
    pub values: Vec<Value>,
}

/// What is known of answers that differ from those found.
#[derive(Clone, Debug)]
pub enum More {
    /// There are none.
    None,
    /// Nobody asked, since there are as many as were wanted.
    Unasked,
    /// It is not known whether there are.
    Unknown(Reason),
}

/// Answers that differ from one that was found, and from each other. An answer without a strategy or counterexample has none.
///
/// # Errors
/// Those of [`crate::solve()`].
pub fn several(
    problem: &Problem,
    objective: &Objective,
    first: &Outcome,
    wanted: &Wanted<'_>,
    config: &Config,
) -> Result<Several, Error> {
    let mut others: Vec<Another> = Vec::new();
    let Some(witness) = &first.witness else { return Ok(Several { others, more: More::None }) };
    let mut found: Vec<Strategy> = vec![witness.clone()];
    let targets: Vec<Target> =
        wanted.kept.iter().map(|(target, _)| target).chain(wanted.preferred).cloned().collect();
    let (whole, _) = to_the_end(problem, objective, &targets);
    let distinction = Distinction::new(problem, objective, wanted.difference);
    while found.len() < wanted.number {
        config.watch.tell(|standing| standing.strategies = found.len());
        let apart = distinction.apart(&whole, &found);
        let (outcome, values, undecided) = if targets.is_empty() {
            let outcome = crate::solve(problem, &apart, config)?;
            (straight(problem, (&apart, objective), outcome, wanted, config), Vec::new(), None)
        } else {
            let asked = (wanted.kept, wanted.preferred);
            let cheapest = cheapest_with(problem, &apart, asked, config, first)?;
            (cheapest.outcome, cheapest.values, cheapest.undecided)
        };
        let Some(strategy) = outcome.witness.clone() else {
            let more = match outcome.verdict {
                Verdict::Unknown => More::Unknown(outcome.reason.unwrap_or(Reason::Solver(Unknown::Unsaid))),
                Verdict::Realizable | Verdict::Unrealizable => More::None,
            };
            return Ok(Several { others, more });
        };
        if found.iter().any(|other| distinction.is_same(other, &strategy)) {
            return Err(Error::Bug("a strategy was found twice".into()));
        }
        found.push(strategy);
        others.push(Another { outcome, values });
        if let Some(reason) = undecided {
            return Ok(Several { others, more: More::Unknown(reason) });
        }
    }
    Ok(Several { others, more: More::Unasked })
}

/// The answer without detours.
fn straight(
    problem: &Problem,
    (apart, objective): (&Objective, &Objective),
    outcome: Outcome,
    wanted: &Wanted<'_>,
    config: &Config,
) -> Outcome {
    if !wanted.straight || !is_existential(objective) {
        return outcome;
    }
    let deadline = config.deadline.within(time_for(problem, objective, &outcome));
    straightened_among(problem, (apart, objective), outcome, config, &deadline).outcome
}
