//! What is looked for once there is an answer: the one that is preferred, and others that differ.

use super::lanes::Team;
use super::{Costs, Solved};
use crate::args;
use crate::explain::Explain;
use crate::failure::Failure;
use crate::load::Loaded;
use crate::wish::Wish;
use hyperplan::search::cost_values;
use hyperplan_plan::{self as plan, Another, Reason, Wanted};
use hyperplan_problem::answer::{Answer, More, Other, ReasonCode, Several, to_witness};
use hyperplan_problem::{Objective, Strategy, Target};

type Stop = (Failure, ReasonCode);

/// The problem and objective that an answer is about.
fn about<'a>(
    (loaded, objective): (&'a Loaded, &'a Objective),
    solved: &'a Solved,
) -> (&'a Loaded, &'a Objective, Option<i64>) {
    let Some(searched) = &solved.searched else { return (loaded, objective, None) };
    let own = searched.loaded.problem.objective(&objective.name);
    (&searched.loaded, own.unwrap_or(objective), searched.minimized.value)
}

fn unsupported(failure: Failure) -> Stop {
    (failure, ReasonCode::Unsupported)
}

/// Of the strategies for the least value of a constant, finds the one that is preferred. Elsewhere it was found at once.
pub(super) fn prefer(
    given: (&Loaded, &Objective),
    wish: &Wish<'_>,
    team: &Team<'_>,
    explain: Explain<'_>,
    solved: &mut Solved,
) -> Result<(), Stop> {
    if solved.searched.is_none() {
        return Ok(());
    }
    let (loaded, objective, value) = about(given, solved);
    let targets = wish.preferred(loaded, objective, value).map_err(unsupported)?;
    if targets.is_empty() || value.is_none() || solved.outcome.witness.is_none() {
        return Ok(());
    }
    let found = plan::cheapest(&loaded.problem, objective, &targets, team.config);
    let plan::Cheapest { outcome, values, undecided } =
        found.map_err(|error| (explain.failure(&objective.name, &error), error.code()))?;
    if outcome.witness.is_none() {
        // The time was up before it had what is known already.
        solved.open = Costs { costs: Vec::new(), undecided: outcome.reason };
        return Ok(());
    }
    let costs = cost_values((&loaded.problem, objective), &targets, &values);
    let both = plan::Outcome { iterations: outcome.iterations + solved.outcome.iterations, ..outcome };
    (solved.outcome, solved.open) = (both, Costs { costs, undecided });
    Ok(())
}

/// Finds others that differ, if some are wanted.
pub(super) fn others(
    given: (&Loaded, &Objective),
    wish: &Wish<'_>,
    team: &Team<'_>,
    explain: Explain<'_>,
    solved: &mut Solved,
) -> Result<(), Stop> {
    let Some(number) = team.args.all.filter(|_| solved.outcome.witness.is_some()) else { return Ok(()) };
    if let Some(reason) = &solved.open.undecided {
        let more = plan::More::Unknown(reason.clone());
        solved.several = Some(plan::Several { others: Vec::new(), more });
        return Ok(());
    }
    let (loaded, objective, value) = about(given, solved);
    let kept = wish.kept(loaded, objective).map_err(unsupported)?;
    let values = solved.open.costs.iter().map(|cost| cost.value);
    let kept: Vec<(Target, i64)> = kept.into_iter().zip(values).collect();
    let preferred = wish.preferred(loaded, objective, value).map_err(unsupported)?;
    let wanted = Wanted {
        number: number.into(),
        difference: team.args.differ,
        kept: &kept,
        preferred: &preferred,
        straight: !team.args.first,
    };
    let several = plan::several(&loaded.problem, objective, &solved.outcome, &wanted, team.config);
    let several = several.map_err(|error| (explain.failure(&objective.name, &error), error.code()))?;
    for Another { outcome, .. } in &several.others {
        solved.outcome.iterations += outcome.iterations;
        solved.outcome.seconds.encode += outcome.seconds.encode;
        solved.outcome.seconds.solve += outcome.seconds.solve;
        solved.outcome.seconds.verify += outcome.seconds.verify;
    }
    solved.several = Some(several);
    Ok(())
}

/// The others as answers tell them, and as they are; and why it is not known whether there are more.
pub(super) fn told(
    (loaded, objective): (&Loaded, &Objective),
    args: &args::Solve,
    answer: &Answer,
    several: Option<plan::Several>,
) -> (Option<Several>, Vec<Strategy>, Option<Reason>) {
    let Some(plan::Several { others, more }) = several else { return (None, Vec::new(), None) };
    let mut strategies = Vec::new();
    let mut told = Vec::new();
    for Another { outcome, values } in others {
        let Some(strategy) = outcome.witness else { continue };
        let mut costs = answer.costs.clone();
        // What is preferred comes last.
        let preferred = costs.len().saturating_sub(values.len());
        for (cost, value) in costs[preferred..].iter_mut().zip(&values) {
            (cost.value, cost.least) = (value.found, value.least);
        }
        let witness = to_witness(&loaded.problem, objective, &strategy);
        told.push(Other { witness, verified: outcome.verified, costs });
        strategies.push(strategy);
    }
    let (more, why) = match more {
        plan::More::None => (More::None, None),
        plan::More::Unasked => (More::Unasked, None),
        plan::More::Unknown(reason) => (More::Unknown, Some(reason)),
    };
    let wanted = args.all.unwrap_or(1).into();
    (Some(Several { differ: args.differ, wanted, more, others: told }), strategies, why)
}
